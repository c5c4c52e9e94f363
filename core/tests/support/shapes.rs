//! Random numbers and closed surfaces on the lattice, for tests.

use std::collections::HashMap;
use std::sync::Arc;

use bspcsg::geometry::plane::{Lattice, Plane};
use bspcsg::geometry::side::Side;
use bspcsg::merge::rule::Rule;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::import::import;
use bspcsg::mesh::source::Source;
use bspcsg::tree::solid::Solid;

use super::normalized;

/// The largest lattice coordinate.
pub const LIMIT: i64 = (1 << 53) - 1;

/// A deterministic generator of random integers.
pub struct Numbers(u64);

impl Numbers {
    /// Starts the sequence of a seed.
    pub fn new(seed: u64) -> Self {
        let mut numbers = Self(seed ^ 0x9e37_79b9_7f4a_7c15);
        numbers.below(2);
        numbers
    }

    /// Returns a random integer in `0..bound`.
    pub fn below(&mut self, bound: i64) -> i64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        i64::try_from(self.0 >> 9).expect("55 bits") % bound
    }

    /// Returns a random index in `0..bound`.
    pub fn index(&mut self, bound: usize) -> usize {
        usize::try_from(self.below(i64::try_from(bound).expect("small"))).expect("not negative")
    }

    /// Returns a random lattice point with coordinates in `0..bound`.
    pub fn point(&mut self, bound: i64) -> Lattice {
        [0; 3].map(|_| self.below(bound))
    }

    /// Returns a random entry of a list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.index(list.len())]
    }
}

/// A closed surface of lattice triangles, which turn counterclockwise as seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    pub vertices: Vec<Lattice>,
    pub faces: Vec<[i64; 3]>,
}

impl Shape {
    /// A tetrahedron with its faces oriented outwards; `None` if it is flat.
    pub fn tetrahedron(corners: [Lattice; 4]) -> Option<Self> {
        let [a, b, c, d] = &corners;
        let mut faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        match Plane::through(a, b, c)?.side_of_lattice(d) {
            Side::On => return None,
            Side::Plus => faces.iter_mut().for_each(|f| f.swap(1, 2)),
            Side::Minus => {}
        }
        let vertices = corners.to_vec();
        Some(Self { vertices, faces })
    }

    /// A random tetrahedron with coordinates in `0..bound`.
    pub fn any_tetrahedron(numbers: &mut Numbers, bound: i64) -> Self {
        loop {
            let corners = [0; 4].map(|_| numbers.point(bound));
            if let Some(shape) = Self::tetrahedron(corners) {
                return shape;
            }
        }
    }

    /// The box between two lattice points.
    pub fn cuboid(low: Lattice, high: Lattice) -> Self {
        let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = |[a, b, c, d]: [i64; 4]| [[a, b, c], [a, c, d]];
        Self {
            vertices: (0..8).map(corner).collect(),
            faces: quads.into_iter().flat_map(halves).collect(),
        }
    }

    /// A random box with coordinates in `0..bound`.
    pub fn any_cuboid(numbers: &mut Numbers, bound: i64) -> Self {
        let mut low = [0; 3];
        let mut high = [0; 3];
        for i in 0..3 {
            low[i] = numbers.below(bound - 1);
            high[i] = low[i] + 1 + numbers.below(bound - 1 - low[i]);
        }
        Self::cuboid(low, high)
    }

    /// A sphere: an icosahedron with each face divided in four `levels` times.
    pub fn sphere(center: Lattice, radius: f64, levels: u32) -> Self {
        let mut ball = Ball::icosahedron();
        (0..levels).for_each(|_| ball.divide());
        let place = |p: &[f64; 3]| [0, 1, 2].map(|i| center[i] + rounded(p[i] * radius));
        Self {
            vertices: ball.points.iter().map(place).collect(),
            faces: ball.faces,
        }
    }

    /// The union of this surface and another one, as one list of triangles.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        let offset = i64::try_from(self.vertices.len()).expect("small");
        self.vertices.extend(other.vertices);
        let shifted = other.faces.into_iter().map(|f| f.map(|v| v + offset));
        self.faces.extend(shifted);
        self
    }

    /// The same surface with its faces turned inside out.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.faces.iter_mut().for_each(|f| f.swap(1, 2));
        self
    }

    /// The image of the surface under a map of its vertices.
    #[must_use]
    pub fn mapped(mut self, map: impl Fn(Lattice) -> Lattice) -> Self {
        for vertex in &mut self.vertices {
            *vertex = map(*vertex);
        }
        self
    }

    /// The corners of a face.
    pub fn corners(&self, face: usize) -> [Lattice; 3] {
        self.faces[face].map(|v| self.vertices[usize::try_from(v).expect("an index")])
    }

    /// The surface as a source on the lattice of whole units.
    pub fn source(&self) -> Arc<Source> {
        let exact = |p: &Lattice| p.map(double);
        let vertices: Vec<[f64; 3]> = self.vertices.iter().map(exact).collect();
        let pitch = Pitch::new(0).expect("a pitch");
        Arc::new(import(&vertices, &self.faces, Some(pitch)).expect("a closed surface"))
    }

    /// The solid that the surface bounds; the surface is trusted to be its reduced boundary.
    pub fn solid(&self) -> Solid {
        Solid::of_source(self.source(), true)
    }

    /// The solid of a surface that may overlap itself.
    pub fn unchecked(&self) -> Solid {
        Solid::of_source(self.source(), false)
    }

    /// The reduced solid of a surface that may overlap itself.
    pub fn united(&self) -> Solid {
        normalized(&self.unchecked(), Rule::Positive)
    }
}

/// The double equal to a lattice coordinate.
#[allow(
    clippy::cast_precision_loss,
    reason = "lattice coordinates are below 2^53"
)]
pub fn double(k: i64) -> f64 {
    k as f64
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "lattice coordinates are small"
)]
fn rounded(x: f64) -> i64 {
    x.round() as i64
}

/// A triangulated unit sphere in doubles.
struct Ball {
    points: Vec<[f64; 3]>,
    faces: Vec<[i64; 3]>,
}

impl Ball {
    fn icosahedron() -> Self {
        let t = f64::midpoint(1.0, 5f64.sqrt());
        let mut points = Vec::new();
        for (s, u) in [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)] {
            points.extend([[s, u, 0.0], [0.0, s, u], [u, 0.0, s]].map(unit));
        }
        let faces = Self::hull(&points);
        Self { points, faces }
    }

    /// The triangles of neighbouring points of an icosahedron, counterclockwise as seen from outside.
    fn hull(points: &[[f64; 3]]) -> Vec<[i64; 3]> {
        let near = |i: usize, j: usize| dot(&points[i], &points[j]) > 0.4;
        let mut faces = Vec::new();
        for (i, j, k) in (0..12)
            .flat_map(|i| (i + 1..12).map(move |j| (i, j)))
            .flat_map(|(i, j)| (j + 1..12).map(move |k| (i, j, k)))
        {
            if near(i, j) && near(j, k) && near(k, i) {
                let (a, b, c) = (points[i], points[j], points[k]);
                let outwards = dot(&cross(&a, &b), &c) > 0.0;
                let face = if outwards { [i, j, k] } else { [i, k, j] };
                faces.push(face.map(|v| i64::try_from(v).expect("small")));
            }
        }
        faces
    }

    fn divide(&mut self) {
        let mut middles: HashMap<(i64, i64), i64> = HashMap::new();
        let points = &mut self.points;
        let mut middle = |a: i64, b: i64| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let [p, q] = [a, b].map(|v| points[usize::try_from(v).expect("an index")]);
                points.push(unit([0, 1, 2].map(|i| p[i] + q[i])));
                i64::try_from(points.len() - 1).expect("small")
            })
        };
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        for &[a, b, c] in &self.faces {
            let (p, q, r) = (middle(a, b), middle(b, c), middle(c, a));
            faces.extend([[a, p, r], [p, b, q], [r, q, c], [p, q, r]]);
        }
        self.faces = faces;
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn unit(p: [f64; 3]) -> [f64; 3] {
    let length = dot(&p, &p).sqrt();
    p.map(|c| c / length)
}

/// A rotation of the lattice, three times as large, after which no axis is parallel to an axis.
pub fn turned(p: Lattice) -> Lattice {
    let [x, y, z] = p;
    [
        2 * x + y + 2 * z + 20,
        x + 2 * y - 2 * z + 20,
        -2 * x + 2 * y + z + 20,
    ]
}

/// The identity map of the lattice.
pub fn straight(p: Lattice) -> Lattice {
    p
}
