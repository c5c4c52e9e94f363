//! What a ray cost.

/// Counts of one ray's way through a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// Nodes visited, leaves among them.
    pub nodes: u32,
    /// Leaves visited: the stabbed ones.
    pub leaves: u32,
    /// Facets tested, in leaves and in cuts.
    pub tests: u32,
}
