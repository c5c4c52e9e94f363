//! Makes coplanar fragments of one operand disjoint and adds up their weights.

use std::sync::Arc;

use super::coverage::partitioned;
use super::fragment::Fragment;
use super::local_tree::extent;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::plane::Plane;
use crate::interrupt::poll;

/// Makes fragments disjoint: where some overlap, the first one stays, with the sum of the weights.
///
/// Pieces with the sum 0 bound nothing and are dropped. Also returns whether any fragments overlapped.
pub fn disjoint(fragments: Vec<Fragment>) -> (Vec<Fragment>, bool) {
    let mut overlap = false;
    let mut all = Vec::with_capacity(fragments.len());
    for group in by_planes(fragments) {
        if some_overlap(&group) {
            overlap = true;
            all.extend(partitioned(&group));
        } else {
            all.extend(group);
        }
    }
    all.retain(|f: &Fragment| f.weight != 0);
    all.sort_by_key(|f| f.face);
    (all, overlap)
}

/// The fragments in groups of one plane each.
fn by_planes(fragments: Vec<Fragment>) -> Vec<Vec<Fragment>> {
    let mut groups: Vec<Vec<Fragment>> = Vec::new();
    let mut names: Vec<Arc<Plane>> = Vec::new();
    for fragment in fragments {
        poll();
        let support = fragment.polygon.support();
        let known = names.iter().position(|p| p.coincides(support).is_some());
        let at = known.unwrap_or_else(|| {
            names.push(Arc::clone(support));
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[at].push(fragment);
    }
    groups
}

/// Return whether two fragments of one plane have an area in common.
fn some_overlap(group: &[Fragment]) -> bool {
    let extents: Vec<Extent> = group.iter().map(|f| extent(&f.polygon)).collect();
    let lie_beside = |i: usize, j: usize| {
        poll();
        extents[i].misses(&extents[j]) || group[i].polygon.lies_beside(&group[j].polygon)
    };
    (1..group.len()).any(|i| !(0..i).all(|j| lie_beside(i, j)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::Polygon;
    use crate::merge::scenes::triangle;
    use crate::mesh::handle::SourceFace;

    fn fragment(polygon: Polygon) -> Fragment {
        Fragment {
            polygon,
            weight: 1,
            face: SourceFace::default(),
            intact: true,
        }
    }

    fn weights(polygons: [Polygon; 2]) -> (Vec<i32>, bool) {
        let (fragments, overlap) = disjoint(polygons.map(fragment).into());
        let mut weights: Vec<i32> = fragments.iter().map(|f| f.weight).collect();
        weights.sort_unstable();
        (weights, overlap)
    }

    #[test]
    fn multiplicities_add_up_where_fragments_overlap() {
        let one = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let beside = triangle([[8, 8, 0], [8, 0, 0], [0, 8, 0]]).flipped();
        let moved = triangle([[2, 0, 0], [10, 0, 0], [2, 8, 0]]);
        assert_eq!(weights([one.clone(), beside]), (vec![1, 1], false));
        assert_eq!(weights([one.clone(), one.clone()]), (vec![2], true));
        assert_eq!(weights([one.clone(), one.flipped()]), (vec![], true));
        let (weights, overlap) = weights([one, moved]);
        assert!(overlap && weights.contains(&1) && weights.last() == Some(&2));
    }
}
