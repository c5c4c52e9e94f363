//! Points renumbered from zero, so that they can index tables.

use std::cmp::Ordering;

use super::{Error, Planar};
use crate::arith::Sign;

/// The points at which edges end, numbered 0, 1, ... in the order of their ids, with cached floats.
pub(super) struct Relabelled<'a, P> {
    points: &'a P,
    /// The id of each new number, increasing.
    ids: Vec<u32>,
    places: Vec<[f64; 2]>,
}

impl<'a, P: Planar> Relabelled<'a, P> {
    /// Renumbers the ends of `edges`; returns an error if an edge ends where no edge begins.
    pub(super) fn new(
        points: &'a P,
        edges: &[(u32, u32)],
    ) -> Result<(Self, Vec<(u32, u32)>), Error> {
        let mut ids: Vec<u32> = edges.iter().map(|edge| edge.0).collect();
        ids.sort_unstable();
        ids.dedup();
        let number = |vertex: u32| {
            let found = ids.binary_search(&vertex).ok();
            found
                .and_then(|k| u32::try_from(k).ok())
                .ok_or(Error::Open { vertex })
        };
        let renumbered = edges
            .iter()
            .map(|&(a, b)| Ok((number(a)?, number(b)?)))
            .collect::<Result<_, _>>()?;
        let places = ids.iter().map(|&id| points.approx(id)).collect();
        Ok((
            Self {
                points,
                ids,
                places,
            },
            renumbered,
        ))
    }

    fn id(&self, number: u32) -> u32 {
        self.ids[number as usize]
    }

    /// Returns triangles with the original ids.
    pub(super) fn restore(&self, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        triangles
            .iter()
            .map(|corners| corners.map(|v| self.id(v)))
            .collect()
    }

    /// Returns an error with the original id of its vertex.
    pub(super) fn restore_error(&self, error: Error) -> Error {
        match error {
            Error::Open { vertex } => Error::Open {
                vertex: self.id(vertex),
            },
            Error::Overlap { vertex } => Error::Overlap {
                vertex: self.id(vertex),
            },
            Error::Crossing { vertex } => Error::Crossing {
                vertex: self.id(vertex),
            },
        }
    }
}

impl<P: Planar> Planar for Relabelled<'_, P> {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        self.points.compare(self.id(a), self.id(b))
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> Sign {
        self.points.orient(self.id(a), self.id(b), self.id(c))
    }

    fn opposite_angles(&self, ends: [u32; 2], apexes: [u32; 2]) -> Ordering {
        let [ends, apexes] = [ends, apexes].map(|pair| pair.map(|p| self.id(p)));
        self.points.opposite_angles(ends, apexes)
    }

    fn approx(&self, a: u32) -> [f64; 2] {
        self.places[a as usize]
    }
}
