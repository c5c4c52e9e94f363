//! The checks that several targets share.

use bspcsg::error::ErrorKind;
use bspcsg::extract::rounding::round;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::solid::Solid;

use super::super::support::{applied, is_empty, manifold_mesh, normalized};

/// The solid that is read from what was stored; stored again it gives the same bytes.
pub fn kept(solid: &Solid, context: &str) -> Solid {
    let stored = |solid: &Solid| Snapshot::of(solid).to_bytes().expect("bytes");
    let read = |bytes: &[u8]| Snapshot::solid_from_bytes(bytes);
    let again = read(&stored(solid)).expect("what was written is read");
    let bytes = stored(&again);
    let third = read(&bytes).expect("what was written is read");
    assert_eq!(stored(&third), bytes, "stored twice: {context}");
    again
}

/// The mesh is closed with one fan at each vertex, if there can be one.
pub fn manifold_or_unbounded(solid: &Solid, context: &str) -> bool {
    if let Err(error) = round::mesh(solid) {
        assert_eq!(error.kind(), ErrorKind::Unbounded, "{error} in {context}");
        return false;
    }
    manifold_mesh(solid, context);
    true
}

/// No point is in one set and not in the other.
pub fn assert_same(a: &Solid, b: &Solid, context: &str) {
    let differs = applied(SetOp::SymmetricDifference, a, b);
    assert!(is_empty(&normalized(&differs, Rule::Positive)), "{context}");
}
