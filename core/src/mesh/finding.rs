//! Findings about a mesh, as data.

/// The weight of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Worth knowing; the result is what was asked for.
    Note,
    /// Probably not what the author of the mesh meant.
    Warning,
}

impl Severity {
    /// The name used in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
        }
    }
}

/// Something noticed: a stable code, how often, where, and a sentence.
#[derive(Clone, Debug)]
pub struct Finding {
    /// A stable name for programs.
    pub code: &'static str,
    /// The weight of the finding.
    pub severity: Severity,
    /// The number of times that it was found.
    pub count: u64,
    /// The first few places: faces or vertices, as the message says.
    pub place: Vec<u64>,
    /// The sentence for a person.
    pub message: String,
}

/// The number of places that a finding names.
const MAX_PLACES_NAMED: usize = 8;

impl Finding {
    /// A finding about numbered places; keeps the first few.
    pub fn about(
        code: &'static str,
        severity: Severity,
        places: &[u64],
        message: impl Into<String>,
    ) -> Self {
        Self {
            code,
            severity,
            count: places.len() as u64,
            place: places.iter().copied().take(MAX_PLACES_NAMED).collect(),
            message: message.into(),
        }
    }
}
