//! The error type of the crate.

pub mod panics;

use std::fmt;

/// The kinds of errors, each with a stable name for programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The faces do not bound a set: some edge is not matched by its opposite.
    NotClosed,
    /// A coordinate is NaN or infinite.
    NonFinite,
    /// A face names a vertex that does not exist.
    IndexOutOfRange,
    /// An array does not have the shape that the call needs.
    Shape,
    /// A coordinate or coefficient does not fit the lattice.
    TooLarge,
    /// A limit of the program is exceeded: too many facets for an exhaustive search, an exact result of more
    /// bits than the caller allows, or more threads than the system starts.
    TooMany,
    /// A mesh without faces of positive area.
    EmptyMesh,
    /// The caller asked for a mesh or a measure of an unbounded solid.
    Unbounded,
    /// The caller asked to stop.
    Cancelled,
    /// The normal of a half-space, or the direction of a ray, is zero or not finite.
    BadNormal,
    /// The operands are on lattices with different steps.
    PitchMismatch,
    /// A facet without extent: a segment of zero length, a polygon of zero area.
    Degenerate,
    /// The corners of a polygon do not lie in one plane.
    NonPlanar,
    /// The outline of a polygon crosses or touches itself.
    NotSimple,
    /// A mesh that was declared to bound a set without overlaps overlaps itself.
    NotReduced,
    /// Stored bytes are damaged or contradict themselves.
    BadSnapshot,
    /// Another thread was using the object when the process was forked.
    Forked,
    /// An invariant is broken: a defect of this library.
    Internal,
}

impl ErrorKind {
    /// The stable name of the kind, used as `code` in Python.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::NotClosed => "not_closed",
            Self::NonFinite => "non_finite",
            Self::IndexOutOfRange => "index_out_of_range",
            Self::Shape => "shape",
            Self::TooLarge => "too_large",
            Self::TooMany => "too_many",
            Self::EmptyMesh => "empty_mesh",
            Self::Unbounded => "unbounded",
            Self::Cancelled => "cancelled",
            Self::BadNormal => "bad_normal",
            Self::PitchMismatch => "pitch_mismatch",
            Self::Degenerate => "degenerate",
            Self::NonPlanar => "non_planar",
            Self::NotSimple => "not_simple",
            Self::NotReduced => "not_reduced",
            Self::BadSnapshot => "bad_snapshot",
            Self::Forked => "forked",
            Self::Internal => "internal",
        }
    }
}

/// An error: its kind, the numbers of the faces, vertices or rows concerned, and a message with a remedy.
///
/// # Example
/// ```
/// use bspcsg::error::{Error, ErrorKind};
///
/// let error = Error::at(ErrorKind::NotClosed, vec![3], "face 3 has an open edge");
/// assert_eq!((error.kind().code(), error.place()), ("not_closed", &[3][..]));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    kind: ErrorKind,
    place: Vec<u64>,
    message: String,
}

impl Error {
    /// Makes an error that concerns no particular face, vertex or row.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self::at(kind, Vec::new(), message)
    }

    /// Makes an error about numbered faces, vertices or rows, as the message says.
    pub fn at(kind: ErrorKind, place: Vec<u64>, message: impl Into<String>) -> Self {
        Self {
            kind,
            place,
            message: message.into(),
        }
    }

    /// Makes an internal error: an invariant is broken.
    pub fn internal(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Internal, message)
    }

    /// Return the kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The numbers of the faces, vertices or rows concerned.
    pub fn place(&self) -> &[u64] {
        &self.place
    }

    /// The message, a sentence for people.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// The crate's result type.
pub type Result<T, E = Error> = std::result::Result<T, E>;
