//! Findings about a mesh: notes and warnings, as data.

/// How serious a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Worth knowing; the result is as requested.
    Note,
    /// Probably not what the author of the mesh meant.
    Warning,
}

impl Severity {
    /// The name of the severity in reports: "note" or "warning".
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
        }
    }
}

/// A note or warning about a mesh: a stable code, a count, locations and a sentence.
#[derive(Clone, Debug)]
pub struct Finding {
    /// A stable name of the kind of finding, for programs.
    pub code: &'static str,
    /// How serious the finding is.
    pub severity: Severity,
    /// The number of faces or vertices concerned.
    pub count: u64,
    /// The numbers of the first faces or vertices concerned, as the message says.
    pub place: Vec<u64>,
    /// The description of the finding, for people.
    pub message: String,
}

/// The largest number of faces or vertices that a finding names.
const MAX_PLACES_NAMED: usize = 8;

impl Finding {
    /// A finding about faces or vertices, given by their numbers; stores their count, and the first few
    /// numbers.
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
