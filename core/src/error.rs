//! The one error type of the crate.

pub mod panics;

use std::fmt;

/// The kinds of errors, as stable names for programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The faces do not bound a set: some edge is not matched by its opposite.
    NotClosed,
    /// A coordinate is NaN or infinite.
    NonFinite,
    /// A face names a vertex that does not exist.
    IndexOutOfRange,
    /// An array does not have the shape it should.
    Shape,
    /// Coordinates do not fit the lattice.
    TooLarge,
    /// More facets than an exhaustive search takes.
    TooMany,
    /// A mesh without faces of positive area.
    EmptyMesh,
    /// A mesh or a measure of an unbounded solid was asked for.
    Unbounded,
    /// The caller asked to stop.
    Cancelled,
    /// A half-space needs a finite normal that is not zero.
    BadNormal,
    /// Operands live on lattices of different pitch.
    PitchMismatch,
    /// A facet without extent: a segment of zero length, a polygon of zero area.
    Degenerate,
    /// The corners of a polygon do not lie in one plane.
    NonPlanar,
    /// The outline of a polygon crosses or touches itself.
    NotSimple,
    /// A mesh that was declared to bound a set without overlaps has some.
    NotReduced,
    /// Stored data is not what it claims to be.
    BadSnapshot,
    /// Another thread was using the object when the process was forked.
    Forked,
    /// A broken invariant: a defect of this library.
    Internal,
}

impl ErrorKind {
    /// The stable name used as `code` in Python.
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

/// An error: what, where, and what to do about it.
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
    /// An error without a place.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self::at(kind, Vec::new(), message)
    }

    /// An error at numbered places (faces, vertices or rows, as the message says).
    pub fn at(kind: ErrorKind, place: Vec<u64>, message: impl Into<String>) -> Self {
        Self {
            kind,
            place,
            message: message.into(),
        }
    }

    /// A broken invariant.
    pub fn internal(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Internal, message)
    }

    /// Return the kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The faces, vertices or rows concerned.
    pub fn place(&self) -> &[u64] {
        &self.place
    }

    /// The sentence for a person.
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
