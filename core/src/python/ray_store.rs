//! Trees that rays have grown as bytes.

use serde::{Deserialize, Serialize};

use crate::error::{Error, ErrorKind, Result};
use crate::query::stab::record::Record;

/// The format's number; readers refuse others.
const FORMAT: u32 = 1;

#[derive(Serialize, Deserialize)]
struct Stored {
    format: u32,
    record: Record,
}

/// A record as bytes.
pub fn to_bytes(record: Record) -> Result<Vec<u8>> {
    let format = FORMAT;
    postcard::to_stdvec(&Stored { format, record }).map_err(|e| Error::internal(e.to_string()))
}

/// The record of bytes.
///
/// # Errors
/// `BadSnapshot`.
pub fn from_bytes(bytes: &[u8]) -> Result<Record> {
    match postcard::from_bytes::<Stored>(bytes) {
        Ok(stored) if stored.format == FORMAT => Ok(stored.record),
        _ => {
            let text = "the bytes are not a stored tree of rays";
            Err(Error::new(ErrorKind::BadSnapshot, text))
        }
    }
}
