//! Makes coplanar fragments (pieces of faces) of one operand disjoint, and adds up their weights.

use std::sync::Arc;

use super::coverage::partitioned;
use super::fragment::Fragment;
use super::local_tree::extent;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::plane::Plane;
use crate::interrupt::poll;

/// Makes fragments of an operand's boundary disjoint: where fragments overlap, a piece of the first one
/// stays, with the sum of the weights.
///
/// Pieces with the sum 0 bound nothing and are dropped. The returned flag is true if any fragments
/// overlapped.
pub fn disjoint(fragments: Vec<Fragment>) -> (Vec<Fragment>, bool) {
    let mut overlap = false;
    let mut all = Vec::with_capacity(fragments.len());
    for group in by_planes(fragments) {
        let overlaps = overlapping(&group);
        let (some, others): (Vec<_>, Vec<_>) =
            group.into_iter().zip(overlaps).partition(|one| one.1);
        all.extend(others.into_iter().map(|one| one.0));
        if !some.is_empty() {
            overlap = true;
            let some: Vec<Fragment> = some.into_iter().map(|one| one.0).collect();
            all.extend(partitioned(&some));
        }
    }
    all.retain(|f: &Fragment| f.weight != 0);
    all.sort_by_key(|f| f.face);
    (all, overlap)
}

/// Groups fragments of an operand's boundary by their planes.
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

/// Returns for each fragment of a list of coplanar ones whether it has an area in common with another one.
fn overlapping(group: &[Fragment]) -> Vec<bool> {
    let extents: Vec<Extent> = group.iter().map(|f| extent(&f.polygon)).collect();
    let lie_beside = |i: usize, j: usize| {
        extents[i].misses(&extents[j]) || group[i].polygon.is_separated_from(&group[j].polygon)
    };
    let mut overlaps = vec![false; group.len()];
    for i in 1..group.len() {
        for j in 0..i {
            poll();
            if !(overlaps[i] && overlaps[j] || lie_beside(i, j)) {
                (overlaps[i], overlaps[j]) = (true, true);
            }
        }
    }
    overlaps
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

    #[test]
    fn fragments_beside_those_that_overlap_stay_whole() {
        let one = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let moved = triangle([[2, 0, 0], [10, 0, 0], [2, 8, 0]]);
        let beside = triangle([[-9, -9, 0], [9, -9, 0], [9, -1, 0]]);
        let (fragments, _) = disjoint([one, moved, beside].map(fragment).into());
        let whole = fragments.iter().filter(|f| f.intact).count();
        assert_eq!(whole, 1);
    }
}
