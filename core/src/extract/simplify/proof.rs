//! Proves exactly that changes make no crossings, and undoes those that do.

use rustc_hash::FxHashMap as HashMap;

use super::edit::{Act, Edit};
use super::shells::Shells;
use crate::extract::rounding::crossings::faults;
use crate::geometry::doubles::Point;
use crate::mesh::faces::Faces;
use crate::mesh::handle::VertexId;

/// Makes changes; returns the edits that stay, and the changes that were undone because surfaces crossed.
///
/// Only triangles that just changed can cross another one, so only these are checked. Each pass of the loop
/// undoes at least one change.
pub fn proved(
    vertices: &[Point],
    triangles: &mut [[VertexId; 3]],
    edits: Vec<Edit>,
    shells: &Shells,
) -> (Vec<Edit>, Vec<Act>) {
    let swept = shells.are_swept(vertices, triangles, &edits);
    let certain = |(edit, swept): (&Edit, bool)| !swept && shells.is_certain(edit);
    let stays = edits.iter().zip(swept).map(certain).collect();
    let mut trial = Trial::of(vertices, triangles, &edits, stays);
    let mut suspects = trial.apply();
    while !suspects.is_empty() {
        let mut guilty = trial.crossing(&suspects);
        if guilty.is_empty() {
            guilty = trial.turning(shells);
        }
        suspects = trial.take_back(&guilty);
    }
    let stays = trial.stays;
    let (kept, gone): (Vec<_>, Vec<_>) = edits.into_iter().zip(stays).partition(|(_, s)| *s);
    let acts = gone.into_iter().map(|(edit, _)| edit.act).collect();
    (kept.into_iter().map(|(edit, _)| edit).collect(), acts)
}

/// Changes that are tried together, with the triangles before them, so that they can be undone.
struct Trial<'a> {
    vertices: &'a [Point],
    triangles: &'a mut [[VertexId; 3]],
    edits: &'a [Edit],
    /// For each change, the corners of its triangles before it.
    before: Vec<Vec<[VertexId; 3]>>,
    /// The index of the change that each triangle is part of.
    owners: HashMap<u32, usize>,
    stays: Vec<bool>,
}

impl<'a> Trial<'a> {
    fn of(
        vertices: &'a [Point],
        triangles: &'a mut [[VertexId; 3]],
        edits: &'a [Edit],
        stays: Vec<bool>,
    ) -> Self {
        let old = |edit: &Edit| {
            let numbers = edit.changes.iter().map(|c| c.0);
            numbers.map(|t| triangles[t as usize]).collect()
        };
        let before = edits.iter().map(old).collect();
        let owned = |(k, edit): (usize, &'a Edit)| edit.changes.iter().map(move |c| (c.0, k));
        Self {
            before,
            owners: edits.iter().enumerate().flat_map(owned).collect(),
            vertices,
            triangles,
            edits,
            stays,
        }
    }

    /// Makes the changes that stay; returns the changed triangles, ascending.
    fn apply(&mut self) -> Vec<u32> {
        let mut changed = Vec::new();
        let staying = self.edits.iter().zip(&self.stays).filter(|e| *e.1);
        for &(t, corners) in staying.flat_map(|(edit, _)| &edit.changes) {
            self.triangles[t as usize] = corners;
            if corners[0] != corners[1] {
                changed.push(t);
            }
        }
        changed.sort_unstable();
        changed
    }

    /// Returns the changes that make one of the triangles `some` cross another or have no area, ascending.
    fn crossing(&self, some: &[u32]) -> Vec<usize> {
        let faces = Faces {
            vertices: self.vertices,
            triangles: self.triangles,
        };
        let found = faults(&faces, some, |_| 0);
        let faulty = found.crossings.iter().flatten().chain(&found.flat);
        let owners = faulty.filter_map(|t| self.owners.get(t).copied());
        let mut guilty: Vec<usize> = owners.filter(|k| self.stays[*k]).collect();
        guilty.sort_unstable();
        guilty.dedup();
        guilty
    }

    /// Returns the changes to shells that are now inside out.
    fn turning(&self, shells: &Shells) -> Vec<usize> {
        let turned = shells.turned(self.vertices, self.triangles);
        let is_turning = |k: &usize| self.stays[*k] && turned[shells.of_edit(&self.edits[*k])];
        (0..self.edits.len()).filter(is_turning).collect()
    }

    /// Undoes changes; returns the restored triangles, ascending.
    fn take_back(&mut self, some: &[usize]) -> Vec<u32> {
        let mut restored = Vec::new();
        for k in some {
            self.stays[*k] = false;
            for ((t, _), corners) in self.edits[*k].changes.iter().zip(&self.before[*k]) {
                self.triangles[*t as usize] = *corners;
                restored.push(*t);
            }
        }
        restored.sort_unstable();
        restored
    }
}

#[cfg(test)]
mod tests {
    use super::super::drift::Drift;
    use super::super::edit::tests::PLACES;
    use super::super::edit::Limits;
    use super::super::surface::Surface;
    use super::*;

    /// Collapses an edge of an octahedron beside a tiny tetrahedron; returns the number of changes that stay
    /// and the number of those that are undone.
    fn kept_beside(tiny: impl Fn(&Edit) -> Point) -> [usize; 2] {
        let around = [[2, 3], [3, 4], [4, 5], [5, 2]];
        let mut triangles = VertexId::rows(around.map(|[a, b]| [[0, a, b], [1, b, a]]).concat());
        let mut vertices = PLACES.to_vec();
        let edit = |vertices: &[Point], triangles: &[[VertexId; 3]]| {
            let limits = Limits {
                surface: &Surface::of(vertices, triangles),
                drift: &Drift::new(vertices),
                tolerance: 9.0,
            };
            let edit = limits.edit(Act::Collapse([0, 2].map(VertexId)), |_| false);
            edit.expect("the link condition holds")
        };
        let at = tiny(&edit(&vertices, &triangles));
        let size = 1e-3;
        let corners = [
            [0.0; 3],
            [size, 0.0, 0.0],
            [0.0, size, 0.0],
            [0.0, 0.0, size],
        ];
        vertices.extend(corners.map(|c| [0, 1, 2].map(|i| at[i] + c[i])));
        triangles.extend(VertexId::rows([[6, 8, 7], [6, 7, 9], [6, 9, 8], [7, 8, 9]]));
        let edits = vec![edit(&vertices, &triangles)];
        let shells = Shells::of(&vertices, &triangles);
        let before = triangles.clone();
        let (kept, gone) = proved(&vertices, &mut triangles, edits, &shells);
        assert_eq!(before == triangles, kept.is_empty());
        [kept.len(), gone.len()]
    }

    #[test]
    fn a_change_that_sweeps_over_another_shell_is_taken_back() {
        assert_eq!(kept_beside(|_| [9.0; 3]), [1, 0]);
        let inside = |edit: &Edit| {
            let body = edit.bodies()[0].map(|v| PLACES[v.index()]);
            [0, 1, 2].map(|i| body.iter().map(|p| p[i]).sum::<f64>() / 4.0)
        };
        assert_eq!(kept_beside(inside), [0, 1]);
    }
}
