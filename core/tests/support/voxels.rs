//! Unions of unit cubes as bits.

use std::collections::HashMap;

use bspcsg::geometry::plane::Lattice;
use bspcsg::mesh::grid::Pitch;
use bspcsg::tree::solid::Solid;

use super::{Numbers, Shape};

/// Unit cubes of an n×n×n lattice as bits, x fastest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Voxels {
    pub side: i64,
    pub bits: u32,
}

impl Voxels {
    pub fn any(numbers: &mut Numbers, side: i64) -> Self {
        let cubes = u32::try_from(side * side * side).expect("small");
        let bits = u32::try_from(numbers.below(1 << cubes)).expect("at most 27 cubes");
        Self { side, bits }
    }

    /// The lattice indices of all cubes.
    pub fn places(side: i64) -> impl Iterator<Item = Lattice> {
        let cubes = side * side * side;
        (0..cubes).map(move |i| [i % side, i / side % side, i / side / side])
    }

    pub fn has(&self, at: Lattice) -> bool {
        let [x, y, z] = at;
        let inside = at.iter().all(|c| (0..self.side).contains(c));
        inside && self.bits >> (x + self.side * (y + self.side * z)) & 1 == 1
    }

    /// The boundary of the cubes, each of side 2, with welded vertices.
    pub fn shape(&self) -> Shape {
        let mut shape = Shape::default();
        let mut numbers: HashMap<Lattice, i64> = HashMap::new();
        for at in Self::places(self.side).filter(|at| self.has(*at)) {
            for (axis, sign) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
                let mut beyond = at;
                beyond[axis] += sign;
                if self.has(beyond) {
                    continue;
                }
                let [a, b, c, d] = square(at, axis, sign).map(|p| {
                    *numbers.entry(p).or_insert_with(|| {
                        shape.vertices.push(p);
                        i64::try_from(shape.vertices.len() - 1).expect("small")
                    })
                });
                shape.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
        shape
    }

    /// The solid of the cubes, moved by a map of the lattice; the empty solid if there are no cubes.
    pub fn solid(&self, map: impl Fn(Lattice) -> Lattice) -> Solid {
        if self.bits == 0 {
            return Solid::uniform(Pitch::new(0).expect("a pitch"), false);
        }
        self.shape().mapped(map).solid()
    }
}

/// The corners of a face of the cube at an index, counterclockwise as seen from outside.
pub fn square(at: Lattice, axis: usize, sign: i64) -> [Lattice; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |s: i64, t: i64| {
        let mut p = at.map(|c| 2 * c);
        p[axis] += 1 + sign;
        p[u] += 2 * s;
        p[v] += 2 * t;
        p
    };
    let mut ring = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    if sign < 0 {
        ring.reverse();
    }
    ring
}
