//! Stores trees that rays have grown as bytes.

use crate::error::Result;
use crate::query::stab::record::Record;
use crate::store::sealed::{seal, unseal, Kind};

/// Encodes the record of a stab tree (its counters and cuts) as bytes.
pub fn to_bytes(record: &Record) -> Result<Vec<u8>> {
    seal(Kind::Rays, record)
}

/// Decodes the record of a stab tree (its counters and cuts) from bytes.
///
/// # Errors
/// `BadSnapshot`.
pub fn from_bytes(bytes: &[u8]) -> Result<Record> {
    unseal(Kind::Rays, bytes)
}
