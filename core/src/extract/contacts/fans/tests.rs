//! Splits surfaces that touch themselves, and compares the number of separate bodies with the expected one.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::{split_fans, Error, Radial, Split};
use crate::arith::Sign;
use crate::mesh::handle::VertexId;

#[derive(Clone, Debug, Default)]
struct Surface {
    points: Vec<[i64; 3]>,
    triangles: Vec<[VertexId; 3]>,
}

impl Radial for Surface {
    fn normal(&self, triangle: u32) -> [i128; 3] {
        let [a, b, c] =
            self.triangles[triangle as usize].map(|v| self.points[v.index()].map(i128::from));
        let (u, v) = (
            [0, 1, 2].map(|k| b[k] - a[k]),
            [0, 1, 2].map(|k| c[k] - a[k]),
        );
        // A large factor takes the products to the full width.
        [(1, 2), (2, 0), (0, 1)].map(|(j, k)| (u[j] * v[k] - u[k] * v[j]) << 100)
    }

    fn direction(&self, a: VertexId, b: VertexId) -> [Sign; 3] {
        let (p, q) = (self.points[a.index()], self.points[b.index()]);
        [0, 1, 2].map(|k| Sign::of(q[k] - p[k]))
    }
}

impl Surface {
    fn vertex(&mut self, point: [i64; 3]) -> VertexId {
        let known = self.points.iter().position(|&other| other == point);
        VertexId::of(known.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        }))
    }

    fn push_polygon(&mut self, corners: &[[i64; 3]]) {
        let ids: Vec<VertexId> = corners.iter().map(|&point| self.vertex(point)).collect();
        self.triangles
            .extend(ids[1..].windows(2).map(|pair| [ids[0], pair[0], pair[1]]));
    }

    /// A tetrahedron whose corners a, b, c, d turn left seen from outside when d is below abc.
    fn push_tetrahedron(&mut self, [a, b, c, d]: [[i64; 3]; 4]) {
        for face in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
            self.push_polygon(&face);
        }
    }

    fn reversed(mut self) -> Self {
        self.triangles
            .iter_mut()
            .for_each(|corners| corners.swap(1, 2));
        self
    }

    /// Splits the surface, and checks all invariants of the result.
    fn split(&self) -> Split {
        let count = u32::try_from(self.points.len()).unwrap();
        let split = split_fans(&self.triangles, count, self).unwrap();
        check_manifold(&split.corners);
        let old = |corners: [VertexId; 3]| corners.map(|v| split.origin[v.index()]);
        assert!(split
            .corners
            .iter()
            .map(|&c| old(c))
            .eq(self.triangles.iter().copied()));
        assert!(split
            .origin
            .iter()
            .copied()
            .take(self.points.len())
            .eq((0..count).map(VertexId)));
        let copied: BTreeSet<VertexId> =
            split.origin[self.points.len()..].iter().copied().collect();
        assert!(split.split_vertices.iter().copied().eq(copied));
        assert!(split.split_edges.is_sorted() && split.split_edges.iter().all(|[a, b]| a < b));
        split
    }
}

fn check_manifold(triangles: &[[VertexId; 3]]) {
    let mut next_around = BTreeMap::new();
    let mut halves = BTreeSet::new();
    for &[a, b, c] in triangles {
        for [v, w, x] in [[a, b, c], [b, c, a], [c, a, b]] {
            assert!(halves.insert((v, w)), "edge {v} {w} twice");
            next_around.insert((v, w), x);
        }
    }
    assert!(halves.iter().all(|&(v, w)| halves.contains(&(w, v))));
    let mut fans = BTreeSet::new();
    while let Some((&(vertex, start), _)) = next_around.first_key_value() {
        assert!(fans.insert(vertex), "two fans at {vertex}");
        let mut spoke = start;
        while let Some(next) = next_around.remove(&(vertex, spoke)) {
            spoke = next;
        }
    }
}

/// The number of connected surfaces of a split.
fn bodies(split: &Split) -> usize {
    let mut body: Vec<usize> = (0..split.origin.len()).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for corners in &split.corners {
            let lowest = corners.iter().map(|&v| body[v.index()]).min().unwrap();
            for &v in corners {
                changed |= body[v.index()] != lowest;
                body[v.index()] = lowest;
            }
        }
    }
    split
        .corners
        .iter()
        .map(|corners| body[corners[0].index()])
        .collect::<BTreeSet<_>>()
        .len()
}

/// The surface of the union of unit cells.
fn cells(filled: &BTreeSet<[i64; 3]>) -> Surface {
    let mut surface = Surface::default();
    for &cell in filled {
        for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let mut across = cell;
            across[axis] += if up { 1 } else { -1 };
            if !filled.contains(&across) {
                surface.push_polygon(&side(cell, axis, up));
            }
        }
    }
    surface
}

fn side(cell: [i64; 3], axis: usize, up: bool) -> [[i64; 3]; 4] {
    let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| {
        let mut corner = cell;
        corner[axis] += i64::from(up);
        corner[(axis + 1) % 3] += s;
        corner[(axis + 2) % 3] += t;
        corner
    });
    if !up {
        corners.reverse();
    }
    corners
}

/// The unit cells, in a cube of `size` cells along each axis, for whose number `is_set` is true.
fn pattern(size: i64, is_set: impl Fn(usize) -> bool) -> BTreeSet<[i64; 3]> {
    let places =
        (0..size).flat_map(|x| (0..size).flat_map(move |y| (0..size).map(move |z| [x, y, z])));
    places
        .enumerate()
        .filter(|&(k, _)| is_set(k))
        .map(|(_, cell)| cell)
        .collect()
}

/// The number of components into which cells fall, if cells are connected by common sides.
fn side_connected(cells: &BTreeSet<[i64; 3]>) -> usize {
    let (mut rest, mut count) = (cells.clone(), 0);
    while let Some(first) = rest.pop_first() {
        let mut reached = vec![first];
        while let Some(cell) = reached.pop() {
            for (axis, step) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
                let mut across = cell;
                across[axis] += step;
                reached.extend(rest.take(&across));
            }
        }
        count += 1;
    }
    count
}

/// The cells of a block, one cell larger on every side than a cube of `size` cells, without the given cells.
fn cavity(cells: &BTreeSet<[i64; 3]>, size: i64) -> BTreeSet<[i64; 3]> {
    let block = pattern(size + 2, |_| true)
        .into_iter()
        .map(|cell| cell.map(|x| x - 1));
    block.filter(|cell| !cells.contains(cell)).collect()
}

/// The surface of wedges around the z axis, each between the directions of a pair, in `steps` pieces along
/// z.
fn wedges(directions: &[[i64; 2]], steps: i64) -> Surface {
    let mut surface = Surface::default();
    for pair in directions.chunks_exact(2) {
        let [p, q] = [pair[0], pair[1]].map(|[x, y]| [x, y, 0]);
        for z in 0..steps {
            surface.push_polygon(&[[0, 0, z + 1], [0, 0, z], p]);
            surface.push_polygon(&[[0, 0, z], [0, 0, z + 1], q]);
        }
        surface.push_polygon(&[[0, 0, steps], p, q]);
        surface.push_polygon(&[[0, 0, 0], q, p]);
    }
    surface
}

const HEXAGON: [[i64; 2]; 6] = [[2, 0], [1, 2], [-1, 2], [-2, 0], [-1, -2], [1, -2]];

#[test]
fn a_cube_passes_unchanged() {
    let cube = cells(&BTreeSet::from([[0, 0, 0]]));
    let split = cube.split();
    assert_eq!(split.corners, cube.triangles);
    assert!(split.split_edges.is_empty() && split.split_vertices.is_empty());
    assert_eq!(
        split_fans(&[], 3, &cube).unwrap().origin,
        [0, 1, 2].map(VertexId)
    );
}

#[test]
fn cubes_that_share_an_edge_or_a_vertex_part() {
    let at_edge = cells(&BTreeSet::from([[0, 0, 0], [1, 1, 0]])).split();
    assert_eq!(
        (
            bodies(&at_edge),
            at_edge.split_edges.len(),
            at_edge.split_vertices.len()
        ),
        (2, 1, 2)
    );
    let at_vertex = cells(&BTreeSet::from([[0, 0, 0], [1, 1, 1]])).split();
    assert_eq!(
        (
            bodies(&at_vertex),
            at_vertex.split_edges.len(),
            at_vertex.split_vertices.len()
        ),
        (2, 0, 1)
    );
}

#[test]
fn cavities_that_share_an_edge_join() {
    let long = BTreeSet::from([[0, 0, 0], [0, 0, 1], [1, 1, 0], [1, 1, 1]]);
    let joined = cells(&cavity(&long, 2)).split();
    assert_eq!(
        (
            bodies(&joined),
            joined.split_edges.len(),
            joined.split_vertices.len()
        ),
        (2, 2, 1)
    );
    // Joined along one edge, both copies of it would have the same two vertices.
    let short = BTreeSet::from([[0, 0, 0], [1, 1, 0]]);
    let parted = cells(&cavity(&short, 2)).split();
    assert_eq!(
        (
            bodies(&parted),
            parted.split_edges.len(),
            parted.split_vertices.len()
        ),
        (3, 1, 2)
    );
}

#[test]
fn counts_do_not_depend_on_where_an_edge_is_divided() {
    let counted = |surface: &Surface| {
        let split = surface.split();
        let euler_number = split.counts.euler_number(split.corners.len());
        (split.counts.surfaces, euler_number)
    };
    for steps in 1..4 {
        let bodies = wedges(&HEXAGON, steps);
        assert_eq!(counted(&bodies), (3, 6));
        // The cavities have one common wall, because three wedges of the inside lie between them.
        assert_eq!(counted(&bodies.reversed()), (1, 2));
    }
}

#[test]
fn three_wedges_at_an_edge() {
    let parted = wedges(&HEXAGON, 1).split();
    assert_eq!(
        (
            bodies(&parted),
            parted.split_edges.len(),
            parted.split_vertices.len()
        ),
        (3, 1, 2)
    );
    let parted = wedges(&HEXAGON, 2).split();
    assert_eq!(
        (
            bodies(&parted),
            parted.split_edges.len(),
            parted.split_vertices.len()
        ),
        (3, 2, 3)
    );
    let joined = wedges(&HEXAGON, 2).reversed().split();
    assert_eq!(
        (
            bodies(&joined),
            joined.split_edges.len(),
            joined.split_vertices.len()
        ),
        (1, 2, 1)
    );
    wedges(&HEXAGON, 1).reversed().split();
}

#[test]
fn doubled_walls_separate() {
    let mut touching = cells(&BTreeSet::from([[0, 0, 0]]));
    for corners in cells(&BTreeSet::from([[1, 0, 0]])).triangles {
        let other = cells(&BTreeSet::from([[1, 0, 0]]));
        touching.push_polygon(&corners.map(|v| other.points[v.index()]));
    }
    assert_eq!(bodies(&touching.split()), 2);
    let mut sheet = Surface::default();
    sheet.push_polygon(&[[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
    sheet.push_polygon(&[[0, 0, 0], [0, 1, 0], [1, 0, 0]]);
    assert_eq!(sheet.split().corners, sheet.triangles);
    let mut twice = cells(&BTreeSet::from([[0, 0, 0]]));
    twice.triangles.extend(twice.triangles.clone());
    twice.split();
}

#[test]
fn all_patterns_of_eight_cells() {
    for bits in 0..256_usize {
        let filled = pattern(2, |k| bits >> k & 1 == 1);
        assert_eq!(
            bodies(&cells(&filled).split()),
            side_connected(&filled),
            "{filled:?}"
        );
        cells(&cavity(&filled, 2)).split();
    }
}

#[test]
fn bad_triangles_are_named() {
    let cube = cells(&BTreeSet::from([[0, 0, 0]]));
    let count = u32::try_from(cube.points.len()).unwrap();
    let [a, b] = {
        let [a, b, _] = cube.triangles[11];
        [a.min(b), a.max(b)]
    };
    let open = split_fans(&cube.triangles[..11], count, &cube);
    assert!(matches!(open, Err(Error::Open { edge }) if edge.iter().any(|v| [a, b].contains(v))));
    assert_eq!(
        split_fans(&VertexId::rows([[0, 1, 1]]), count, &cube),
        Err(Error::BadTriangle { triangle: 0 })
    );
    assert_eq!(
        split_fans(&VertexId::rows([[0, 1, count]]), count, &cube),
        Err(Error::BadTriangle { triangle: 0 })
    );
}

proptest! {
    #[test]
    fn random_cells(bits in prop::collection::vec(prop::bool::weighted(0.5), 64)) {
        let filled = pattern(4, |k| bits[k]);
        cells(&filled).split();
        cells(&cavity(&filled, 4)).split();
    }

    /// Bodies that overlap, turn inside out or have no volume.
    #[test]
    fn random_tetrahedra(corners in prop::collection::vec([0_i64..3, 0_i64..3, 0_i64..2], 4..60)) {
        let mut surface = Surface::default();
        for corners in corners.chunks_exact(4) {
            let corners = [corners[0], corners[1], corners[2], corners[3]];
            if corners.iter().collect::<BTreeSet<_>>().len() == 4 {
                surface.push_tetrahedron(corners);
            }
        }
        surface.split();
    }
}
