//! What becomes of the elements: those that others of another operand cross are cut up.

use std::sync::Arc;

use smallvec::SmallVec;

use super::super::cutting::{contact, cut_up, Contact, Cutter, Cutting};
use super::super::sweep::{pairs, Swept};
use super::anchors::Anchors;
use super::scene::{Place, Scene};
use crate::geometry::apart::are_apart;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;

/// Elements that may meet another one, by number: rarely more than six.
type Neighbours = SmallVec<[u32; 6]>;

/// What became of an element.
pub(super) enum Fate {
    /// It does not meet the cell.
    Absent,
    /// Nothing crosses it, and it has these anchors, at least one.
    Uncut(Anchors),
    /// It was cut up; it has these anchors, and this corner if it has none.
    Cut(Cutting, Arc<Vertex>, Anchors),
}

impl Scene<'_> {
    /// The fates of all elements; `None` if two meet in a special way.
    pub(super) fn fates(&self) -> Option<Vec<Fate>> {
        let neighbours = self.neighbours()?;
        (0..self.elements.len())
            .map(|i| self.fate(i, &neighbours[i]))
            .collect()
    }

    /// For each element those of other operands that may meet it inside the cell; `None` if they
    /// are too many to be found by a sweep.
    fn neighbours(&self) -> Option<Vec<Neighbours>> {
        let swept: Vec<Swept> = self.elements.iter().map(|e| e.swept(self.cell)).collect();
        let mut found = vec![Neighbours::new(); self.elements.len()];
        pairs(&swept, |i, j| {
            if !self.separated(i, j) {
                found[i].push(j as u32);
                found[j].push(i as u32);
            }
        })?;
        // The sweep's order is not that of the elements.
        for list in &mut found {
            list.sort_unstable();
        }
        Some(found)
    }

    /// Whether two elements certainly do not touch.
    fn separated(&self, i: usize, j: usize) -> bool {
        match (&self.elements[i].place, &self.elements[j].place) {
            (Place::Face(a), Place::Face(b)) => are_apart(&a.corners, &b.corners),
            _ => false,
        }
    }

    fn fate(&self, i: usize, neighbours: &[u32]) -> Option<Fate> {
        let element = &self.elements[i];
        let anchors = element.anchors(self.cell);
        if !anchors.is_empty() && neighbours.is_empty() {
            return Some(Fate::Uncut(anchors));
        }
        let Some(polygon) = element.polygon_in(self.cell) else {
            return Some(Fate::Absent);
        };
        let anchors = if anchors.is_empty() {
            element.anchors_at_walls(&polygon)
        } else {
            anchors
        };
        let cutters = self.cutters(&polygon, neighbours)?;
        if !anchors.is_empty() && cutters.is_empty() {
            return Some(Fate::Uncut(anchors));
        }
        let base = Arc::clone(&polygon.corners()[0].at);
        Some(Fate::Cut(cut_up(polygon, &cutters)?, base, anchors))
    }

    /// Those neighbours that may cross a polygon; `None` if one touches it in a special way.
    fn cutters(&self, polygon: &Polygon, neighbours: &[u32]) -> Option<Vec<Cutter<'_>>> {
        let mut cutters = Vec::with_capacity(neighbours.len());
        for j in neighbours {
            let other = &self.elements[*j as usize];
            match contact(polygon, other.shape()) {
                Contact::Special => return None,
                Contact::None => {}
                Contact::Crossing => cutters.push(Cutter {
                    face: other.shape(),
                    operand: other.operand,
                    weight: other.weight,
                }),
            }
        }
        Some(cutters)
    }
}
