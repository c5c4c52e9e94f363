//! Seals stored bytes with their kind, their version, and a checksum.
//!
//! The bytes are a mark of eight bytes, the payload, and the CRC-32 of both (zlib's, which other languages
//! have, too). The checksum detects bursts of up to 32 damaged bits always, other damage except with
//! probability 2⁻³². Forgeries are found when the payload is checked.

use serde::de::DeserializeOwned;
use serde::Serialize;

use crate::error::{Error, ErrorKind, Result};

/// The kind of object that the bytes describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The boundary of a solid.
    Solid,
    /// A partition tree of a set.
    Set,
    /// A stab tree that rays have grown.
    Rays,
}

const MARK: [u8; 6] = *b"bspcsg";

/// The version of the format that is written.
const VERSION: u8 = 3;

/// The oldest version with a mark. Of whole faces it stores only whether they are turned around.
const OLDEST_VERSION: u8 = 2;

/// The first byte of version 1, which had neither mark nor checksum.
const VERSION_ONE: u8 = 1;

const HEAD_BYTES: usize = MARK.len() + 2;
const CHECKSUM_BYTES: usize = 4;

impl Kind {
    fn letter(self) -> u8 {
        match self {
            Self::Solid => b's',
            Self::Set => b't',
            Self::Rays => b'r',
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Solid => "a solid",
            Self::Set => "a partition tree",
            Self::Rays => "a ray tree",
        }
    }

    fn refusal(self, why: &str) -> Error {
        let text = format!("the bytes are not a snapshot of {}: {why}", self.name());
        Error::new(ErrorKind::BadSnapshot, text)
    }

    /// Returns the error for a payload that contradicts itself.
    pub fn contradiction(self) -> Error {
        self.refusal("their contents are inconsistent")
    }
}

/// Encodes a value as sealed bytes.
///
/// # Errors
/// `Internal` if encoding fails.
pub fn seal(kind: Kind, value: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes = MARK.to_vec();
    bytes.extend([kind.letter(), VERSION]);
    let mut bytes =
        postcard::to_extend(value, bytes).map_err(|e| Error::internal(e.to_string()))?;
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    Ok(bytes)
}

/// Decodes a value from sealed bytes, also from those of earlier versions.
///
/// # Errors
/// `BadSnapshot`.
pub fn unseal<T: DeserializeOwned>(kind: Kind, bytes: &[u8]) -> Result<T> {
    let payload = payload(kind, bytes)?;
    match postcard::take_from_bytes(payload) {
        Ok((value, [])) => Ok(value),
        _ => Err(kind.contradiction()),
    }
}

fn payload(kind: Kind, bytes: &[u8]) -> Result<&[u8]> {
    if let Some((&VERSION_ONE, payload)) = bytes.split_first() {
        return Ok(payload);
    }
    let head = [&MARK[..], &[kind.letter()]].concat();
    let Some((version, _)) = bytes.strip_prefix(&*head).and_then(<[u8]>::split_first) else {
        return Err(kind.refusal("they do not start with its header"));
    };
    if !(OLDEST_VERSION..=VERSION).contains(version) {
        let why = format!("version {version} is not known; a newer bspcsg may have written it");
        return Err(kind.refusal(&why));
    }
    let (sealed, checksum) = bytes
        .split_last_chunk::<CHECKSUM_BYTES>()
        .filter(|(sealed, _)| sealed.len() >= HEAD_BYTES)
        .ok_or_else(|| kind.refusal("they are incomplete"))?;
    if crc32fast::hash(sealed) != u32::from_le_bytes(*checksum) {
        return Err(kind.refusal("the checksum does not match, so they are damaged"));
    }
    Ok(&sealed[HEAD_BYTES..])
}
