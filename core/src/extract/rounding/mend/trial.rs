//! Makes and undoes changes of a mesh, and finds the faults that are left.

use super::part::{Edit, Mending, Star, BOXES_PER_TRIANGLE_TEST};
use crate::geometry::doubles::extent::Extent;
use crate::geometry::doubles::meeting::{has_no_area, meeting, Meeting};
use crate::geometry::doubles::sheets::{Sheet, Sheets};
use crate::mesh::crossing_edges::crosses_at;
use crate::mesh::faces::edges;
use crate::mesh::handle::VertexId;

impl Mending {
    /// Makes a change; returns the change that undoes it.
    pub(super) fn apply(&mut self, edit: &Edit) -> Edit {
        let mut undo = Edit::default();
        for &v in &edit.copies {
            self.vertices.push(self.vertices[v.index()]);
            self.fixed.push(self.fixed[v.index()]);
            self.given.push(self.given[v.index()]);
            self.drifts.push(self.drifts[v.index()]);
            self.stars.push(Star::new());
        }
        for &(v, place) in &edit.moves {
            undo.moves.push((v, self.vertices[v.index()]));
            self.vertices[v.index()] = place;
        }
        self.exchange(&edit.triangles, &mut undo);
        let moved: Vec<u32> = edit.moves.iter().flat_map(|m| self.star(m.0)).collect();
        for t in moved {
            self.measure(t);
        }
        undo
    }

    pub(super) fn revert(&mut self, edit: &Edit, undo: &Edit) {
        let mut nothing = Edit::default();
        for &(v, place) in undo.moves.iter().rev() {
            self.vertices[v.index()] = place;
        }
        self.exchange(&undo.triangles, &mut nothing);
        let moved: Vec<u32> = edit.moves.iter().flat_map(|m| self.star(m.0)).collect();
        for t in moved {
            self.measure(t);
        }
        let count = self.vertices.len() - edit.copies.len();
        self.vertices.truncate(count);
        self.fixed.truncate(count);
        self.given.truncate(count);
        self.drifts.truncate(count);
        self.stars.truncate(count);
    }

    fn exchange(&mut self, triangles: &[(u32, Option<[VertexId; 3]>)], undo: &mut Edit) {
        for (t, _) in triangles {
            let old = self.triangles[*t as usize].take();
            undo.triangles.push((*t, old));
            for edge in old.into_iter().flat_map(edges) {
                self.halves.remove(&edge);
            }
            for v in old.into_iter().flatten() {
                self.stars[v.index()].retain(|other| *other != *t);
            }
        }
        for &(t, corners) in triangles {
            self.triangles[t as usize] = corners;
            for edge in corners.into_iter().flat_map(edges) {
                self.halves.insert(edge, t);
            }
            for v in corners.into_iter().flatten() {
                let star = &mut self.stars[v.index()];
                star.insert(star.partition_point(|other| *other < t), t);
            }
            self.measure(t);
        }
    }

    fn measure(&mut self, t: u32) {
        if let Some(corners) = self.corners(t) {
            self.extents[t as usize] = Extent::of(&corners);
            self.blocks.grow(t, &self.extents[t as usize]);
        }
    }

    /// Returns the crossings and the flat triangles among `some`, which ascends; `None` if there are at least
    /// `most` of them.
    pub(super) fn faults_of(
        &mut self,
        some: &[u32],
        most: usize,
    ) -> Option<(Vec<[u32; 2]>, Vec<u32>)> {
        let left = some.iter().copied().filter(|t| self.corners(*t).is_some());
        let area = |t: &u32| self.corners(*t).is_some_and(|c| !has_no_area(&c));
        let (solid, flat): (Vec<u32>, Vec<u32>) = left.partition(area);
        let mut crossings = Vec::new();
        if flat.len() >= most {
            return None;
        }
        for t in solid {
            let extent = self.extents[t as usize];
            let mut near: Vec<u32> = self.blocks.near(&extent).collect();
            self.work = self.work.saturating_sub(self.blocks.count() + near.len());
            near.retain(|u| !extent.misses(&self.extents[*u as usize]));
            near.retain(|u| *u > t || *u < t && some.binary_search(u).is_err());
            self.work = self
                .work
                .saturating_sub(BOXES_PER_TRIANGLE_TEST * near.len());
            for u in near {
                if self.cross(t, u, &flat) {
                    crossings.push([t.min(u), t.max(u)]);
                    if crossings.len() + flat.len() >= most {
                        return None;
                    }
                }
            }
        }
        Some((crossings, flat))
    }

    fn cross(&self, t: u32, u: u32, flat: &[u32]) -> bool {
        let pair = [t.min(u), t.max(u)];
        let is_flat = |t: &u32| self.flat.contains(t) || flat.contains(t);
        let (Some(p), Some(q)) = (self.corners(pair[0]), self.corners(pair[1])) else {
            return false;
        };
        if is_flat(&u) && has_no_area(if u == pair[0] { &p } else { &q }) {
            return false;
        }
        let met = meeting(&p, &q);
        if let Meeting::Edges(i, j) = met
            && self.ends(pair[0], i) == self.ends(pair[1], j).map(|[a, b]| [b, a])
        {
            return false;
        }
        let mate = |which: usize, edge: usize| {
            let [a, b] = self.ends(pair[which], edge)?;
            let mate = self.triangles[*self.halves.get(&[b, a])? as usize]?;
            let apex = mate.iter().find(|v| **v != a && **v != b)?;
            Some(self.vertices[apex.index()])
        };
        let sheets = |which: usize, edge: usize| {
            let own = [&p, &q][which][(edge + 2) % 3];
            let both = [(Some(own), true), (mate(which, edge), false)];
            let sheet = |(apex, is_along)| Option::map(apex, |apex| Sheet { apex, is_along });
            both.into_iter().filter_map(sheet).collect::<Sheets>()
        };
        crosses_at(met, &[p, q], sheets)
    }

    fn ends(&self, t: u32, edge: usize) -> Option<[VertexId; 2]> {
        let corners = self.triangles[t as usize]?;
        Some([corners[edge], corners[(edge + 1) % 3]])
    }
}
