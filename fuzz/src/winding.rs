//! The location of a point, from winding numbers in whole numbers: no tree, no plane, no cell of
//! the core.
//!
//! A place is a point and up to three steps, each infinitely smaller than the one before. All
//! predicates are linear in the place, so each is decided by its first value that is not zero.

use bspcsg::geometry::plane::Lattice;
use bspcsg::query::classify::Location;

/// A vector of whole numbers.
pub type Wide = [i128; 3];

/// The largest distance for which the steps around a point of the boundary stay below 2¹²⁷: a
/// normal is below 8·M², two crossed 2⁷·M⁴, three 2¹¹·M⁶, and its product with a normal 2¹⁶·M⁸.
pub const NEAR: i64 = 1 << 13;

/// Directions of rays: whole numbers without a common factor, in no plane of small normals.
const RAYS: [Wide; 8] = [
    [61, 37, 23],
    [-53, 29, 41],
    [17, -59, 43],
    [31, 47, -13],
    [-19, -61, 29],
    [59, -11, -37],
    [-7, 53, 59],
    [43, 13, 61],
];

/// A set whose membership is known without the core.
#[derive(Clone, Debug)]
pub enum Known {
    /// The points around which these triangles wind a positive number of times.
    Mesh(Vec<[Lattice; 3]>),
    /// The points x with normal·x ≤ offset.
    HalfSpace([i64; 3], i64),
}

/// A point and ever smaller steps from it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    point: Lattice,
    steps: [Wide; 3],
}

impl Place {
    /// The point itself.
    #[must_use]
    pub fn at(point: &Lattice) -> Self {
        Self::beside(point, [[0; 3]; 3])
    }

    /// The point with steps.
    #[must_use]
    pub fn beside(point: &Lattice, steps: [Wide; 3]) -> Self {
        let point = *point;
        Self { point, steps }
    }

    /// The way from the point to a corner.
    fn arm(&self, corner: &Lattice) -> Wide {
        less(&wide(corner), &wide(&self.point))
    }

    /// The sign of a linear form that has this value at the point and this gradient.
    fn sign(&self, value: i128, gradient: &Wide) -> i128 {
        let changes = self.steps.iter().map(|step| dot(gradient, step));
        let values = [value].into_iter().chain(changes);
        values.map(i128::signum).find(|s| *s != 0).unwrap_or(0)
    }
}

impl Known {
    /// Return whether a place is inside; `None` if it lies on the boundary, or all rays meet an
    /// edge.
    #[must_use]
    pub fn holds(&self, place: &Place) -> Option<bool> {
        match self {
            Self::Mesh(faces) => winding(faces, place).map(|w| w > 0),
            Self::HalfSpace(normal, offset) => {
                let normal = wide(normal);
                let side = place.sign(above(&normal, *offset, &place.point), &normal);
                (side != 0).then_some(side < 0)
            }
        }
    }

    /// Return whether all corners are near enough to a point for steps around it.
    fn is_near(&self, point: &Lattice) -> bool {
        let near = |corner: &Lattice| (0..3).all(|i| (corner[i] - point[i]).abs() <= NEAR);
        match self {
            Self::Mesh(faces) => faces.iter().flatten().all(near),
            Self::HalfSpace(..) => true,
        }
    }

    /// The normals of the faces that a point lies on.
    fn normals_at(&self, point: &Lattice) -> Vec<Wide> {
        match self {
            Self::Mesh(faces) => {
                let met = faces.iter().filter(|face| touches(face, point));
                met.map(normal).collect()
            }
            Self::HalfSpace(normal, offset) => {
                let normal = wide(normal);
                let on = above(&normal, *offset, point) == 0;
                on.then_some(normal).into_iter().collect()
            }
        }
    }
}

/// Count how often triangles wind around a place; `None` if it lies on one, or all rays meet an
/// edge.
#[must_use]
pub fn winding(faces: &[[Lattice; 3]], place: &Place) -> Option<i32> {
    RAYS.iter().find_map(|ray| {
        let crossings = faces.iter().map(|face| crossing(face, place, ray));
        crossings.sum::<Option<i32>>()
    })
}

/// Locate a point relative to the set that an expression makes of others.
///
/// All planes that meet at the point divide its neighbourhood; it is on the boundary if the
/// expression holds in some of these parts and not in others. `None` if that cannot be told.
#[must_use]
pub fn location(
    sets: &[Known],
    value: impl Fn(&[bool]) -> bool,
    point: &Lattice,
) -> Option<Location> {
    let mut normals: Vec<Wide> = sets.iter().flat_map(|s| s.normals_at(point)).collect();
    normals.sort_unstable();
    normals.dedup();
    if !normals.is_empty() && !sets.iter().all(|s| s.is_near(point)) {
        return None;
    }
    let (mut some, mut all) = (false, true);
    for place in around(point, &normals) {
        let known: Option<Vec<bool>> = sets.iter().map(|s| s.holds(&place)).collect();
        let inside = value(&known?);
        some |= inside;
        all &= inside;
    }
    Some(match (some, all) {
        (true, true) => Location::Inside,
        (true, false) => Location::Boundary,
        _ => Location::Outside,
    })
}

/// A place in each part of a point's neighbourhood that planes with these normals make.
///
/// Each part but those of parallel planes has a ray in which two planes meet on its border: around
/// each such ray the parts lie between planes that contain it.
fn around(point: &Lattice, normals: &[Wide]) -> Vec<Place> {
    let mut places = Vec::new();
    for (i, first) in normals.iter().enumerate() {
        for second in &normals[i + 1..] {
            let line = cross(first, second);
            if line == [0; 3] {
                continue;
            }
            for along in [line, minus(&line)] {
                let through = normals.iter().filter(|n| dot(n, &along) == 0);
                places.extend(through.flat_map(|n| beside_plane(point, &along, n)));
            }
        }
    }
    if let (true, Some(n)) = (places.is_empty(), normals.first()) {
        let nowhere = [[0; 3]; 2];
        let sides = [*n, minus(n)];
        places.extend(sides.map(|n| Place::beside(point, [n, nowhere[0], nowhere[1]])));
    }
    if places.is_empty() {
        places.push(Place::at(point));
    }
    places
}

/// The four places along a ray that are next to a plane through it.
fn beside_plane(point: &Lattice, along: &Wide, normal: &Wide) -> Vec<Place> {
    let across = cross(normal, along);
    let mut places = Vec::new();
    for aside in [across, minus(&across)] {
        for off in [*normal, minus(normal)] {
            places.push(Place::beside(point, [*along, aside, off]));
        }
    }
    places
}

/// Return how a ray from a place crosses a triangle: +1 if it leaves, −1 if it enters, 0 if it
/// misses.
fn crossing(face: &[Lattice; 3], place: &Place, ray: &Wide) -> Option<i32> {
    let [a, b, c] = face.each_ref().map(|corner| place.arm(corner));
    let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let lever = cross(&less(&from, &to), ray);
        place.sign(dot(ray, &cross(&from, &to)), &lever)
    });
    if turns.contains(&1) && turns.contains(&-1) {
        return Some(0);
    }
    let n = normal(face);
    let (side, slope) = (place.sign(-dot(&n, &a), &n), dot(&n, ray).signum());
    if side == 0 || (turns.contains(&0) && slope != 0) {
        return None;
    }
    let ahead = side * slope < 0;
    Some(if ahead {
        i32::from(slope > 0) * 2 - 1
    } else {
        0
    })
}

/// Return whether a point lies on a triangle or its border.
fn touches(face: &[Lattice; 3], point: &Lattice) -> bool {
    let n = normal(face);
    let arm = |corner: &Lattice| less(&wide(corner), &wide(point));
    let [a, b, c] = face.each_ref().map(arm);
    let turns = [(a, b), (b, c), (c, a)].map(|(p, q)| dot(&n, &cross(&p, &q)));
    n != [0; 3] && dot(&n, &a) == 0 && turns.iter().all(|t| *t >= 0)
}

/// Return the height of a point above a plane, in units of the normal.
fn above(normal: &Wide, offset: i64, point: &Lattice) -> i128 {
    dot(normal, &wide(point)) - i128::from(offset)
}

fn normal([a, b, c]: &[Lattice; 3]) -> Wide {
    let [u, v] = [b, c].map(|end| less(&wide(end), &wide(a)));
    cross(&u, &v)
}

fn wide(p: &Lattice) -> Wide {
    p.map(i128::from)
}

fn minus(a: &Wide) -> Wide {
    a.map(|x| -x)
}

fn less(a: &Wide, b: &Wide) -> Wide {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: &Wide, b: &Wide) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Wide, b: &Wide) -> Wide {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}
