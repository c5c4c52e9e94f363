//! Triangulates shapes with known area and boundary, among them many that touch themselves or have straight
//! corners.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::{triangulate, triangulate_by_sweep, Error, Planar};
use crate::arith::Sign;

type Edges = Vec<(u32, u32)>;

#[derive(Clone, Debug, Default)]
struct Lattice(Vec<[i64; 2]>);

impl Lattice {
    fn at(&self, id: u32) -> [i128; 2] {
        self.0[id as usize].map(i128::from)
    }

    fn doubled_area(&self, a: u32, b: u32, c: u32) -> i128 {
        let ([ax, ay], [bx, by], [cx, cy]) = (self.at(a), self.at(b), self.at(c));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    }

    fn push_loop(&mut self, edges: &mut Edges, points: &[[i64; 2]]) {
        let base = u32::try_from(self.0.len()).unwrap();
        let count = u32::try_from(points.len()).unwrap();
        self.0.extend(points);
        edges.extend((0..count).map(|k| (base + k, base + (k + 1) % count)));
    }

    fn mapped(&self, map: impl Fn([i64; 2]) -> [i64; 2]) -> Self {
        Self(self.0.iter().map(|&p| map(p)).collect())
    }
}

impl Planar for Lattice {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        self.0[a as usize].cmp(&self.0[b as usize])
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> Sign {
        Sign::of(self.doubled_area(a, b, c))
    }

    fn opposite_angles(&self, ends: [u32; 2], apexes: [u32; 2]) -> Ordering {
        let [[a, b], [c, d]] = [ends, apexes].map(|pair| pair.map(|p| self.at(p)));
        let angle = |apex: [i128; 2], p: [i128; 2], q: [i128; 2]| {
            let [u, v] = [p, q].map(|p| [p[0] - apex[0], p[1] - apex[1]]);
            [u[0] * v[0] + u[1] * v[1], u[0] * v[1] - u[1] * v[0]]
        };
        let ([cos_c, sin_c], [cos_d, sin_d]) = (angle(c, a, b), angle(d, b, a));
        0.cmp(&(cos_c * sin_d + cos_d * sin_c))
    }

    #[allow(clippy::cast_precision_loss)]
    fn approx(&self, a: u32) -> [f64; 2] {
        self.0[a as usize].map(|x| x as f64)
    }
}

/// Checks the triangles of `triangulate` and of the sweep alone; returns the former.
fn check(points: &Lattice, edges: &Edges) -> Vec<[u32; 3]> {
    let triangles =
        triangulate(points, edges).unwrap_or_else(|error| panic!("{error}\n{points:?}\n{edges:?}"));
    check_cover(points, edges, &triangles);
    assert_eq!(triangles, triangulate(points, edges).unwrap());
    check_cover(points, edges, &triangulate_by_sweep(points, edges).unwrap());
    triangles
}

/// Checks that triangles turn left and have the region's boundary and area: so they cover it exactly once.
fn check_cover(points: &Lattice, edges: &Edges, triangles: &[[u32; 3]]) {
    let mut halves = BTreeSet::new();
    let mut area = 0;
    for &[a, b, c] in triangles {
        let doubled = points.doubled_area(a, b, c);
        assert!(doubled > 0, "{points:?} {edges:?}");
        area += doubled;
        for half in [(a, b), (b, c), (c, a)] {
            assert!(
                halves.insert(half),
                "edge {half:?} twice: {points:?} {edges:?}"
            );
        }
    }
    let outline = edges.iter().map(|&(a, b)| {
        let ([ax, ay], [bx, by]) = (points.at(a), points.at(b));
        ax * by - ay * bx
    });
    assert_eq!(area, outline.sum::<i128>(), "{points:?} {edges:?}");
    let unpaired: BTreeSet<_> = halves
        .iter()
        .copied()
        .filter(|&(a, b)| !halves.contains(&(b, a)))
        .collect();
    assert_eq!(
        unpaired,
        edges.iter().copied().collect(),
        "{points:?} {edges:?}"
    );
}

/// Checks a shape, and its images rotated, sheared and mirrored, so that corners of all kinds are met.
fn check_all_ways(points: &Lattice, edges: &Edges) {
    check(points, edges);
    check(&points.mapped(|[x, y]| [-y, x]), edges);
    check(&points.mapped(|[x, y]| [3 * x + y, 2 * y - x]), edges);
    let mirrored: Edges = edges.iter().rev().map(|&(a, b)| (b, a)).collect();
    check(&points.mapped(|[x, y]| [-x, y]), &mirrored);
}

/// Boundary of a union of unit cells, with a vertex at every lattice point on it.
fn cells_outline(filled: impl Fn(i64, i64) -> bool, width: i64, height: i64) -> (Lattice, Edges) {
    let mut ids = BTreeMap::new();
    let (mut points, mut edges) = (Lattice::default(), Edges::new());
    for (x, y) in (0..width)
        .flat_map(|x| (0..height).map(move |y| (x, y)))
        .filter(|&(x, y)| filled(x, y))
    {
        let sides = [
            ([0, -1], [0, 0], [1, 0]),
            ([1, 0], [1, 0], [1, 1]),
            ([0, 1], [1, 1], [0, 1]),
            ([-1, 0], [0, 1], [0, 0]),
        ];
        for ([dx, dy], from, to) in sides {
            let (nx, ny) = (x + dx, y + dy);
            if (0..width).contains(&nx) && (0..height).contains(&ny) && filled(nx, ny) {
                continue;
            }
            let [a, b] = [from, to].map(|[cx, cy]| {
                *ids.entry([x + cx, y + cy]).or_insert_with(|| {
                    points.0.push([x + cx, y + cy]);
                    u32::try_from(points.0.len() - 1).unwrap()
                })
            });
            edges.push((a, b));
        }
    }
    (points, edges)
}

/// Removes the vertices between collinear edges for which `drop` is true.
fn straightened(points: &Lattice, edges: &Edges, drop: impl Fn(u32) -> bool) -> Edges {
    let mut edges = edges.clone();
    for vertex in 0..u32::try_from(points.0.len()).unwrap() {
        let touching: Vec<usize> = (0..edges.len())
            .filter(|&e| edges[e].0 == vertex || edges[e].1 == vertex)
            .collect();
        let &[e, f] = &touching[..] else { continue };
        let (into, out) = if edges[e].1 == vertex { (e, f) } else { (f, e) };
        if drop(vertex) && points.orient(edges[into].0, vertex, edges[out].1) == Sign::Zero {
            edges[into].1 = edges[out].1;
            edges.swap_remove(out);
        }
    }
    edges
}

/// A loop around the origin through the given points, sorted by direction; `None` if they do not surround
/// it.
fn star(mut spokes: Vec<[i64; 2]>) -> Option<Vec<[i64; 2]>> {
    let is_lower = |[x, y]: [i64; 2]| y < 0 || (y == 0 && x < 0);
    let cross = |[a, b]: [i64; 2], [c, d]: [i64; 2]| a * d - b * c;
    spokes.retain(|&spoke| spoke != [0, 0]);
    spokes.sort_by(|&p, &q| is_lower(p).cmp(&is_lower(q)).then(0.cmp(&cross(p, q))));
    spokes.dedup_by(|p, q| cross(*p, *q) == 0 && is_lower(*p) == is_lower(*q));
    let around = (0..spokes.len()).all(|k| cross(spokes[k], spokes[(k + 1) % spokes.len()]) > 0);
    (spokes.len() >= 3 && around).then_some(spokes)
}

fn scaled(points: &[[i64; 2]], factor: i64) -> Vec<[i64; 2]> {
    points
        .iter()
        .map(|&[x, y]| [factor * x, factor * y])
        .collect()
}

fn reversed(points: &[[i64; 2]]) -> Vec<[i64; 2]> {
    points.iter().rev().copied().collect()
}

fn bits(width: i64, seed: &[bool]) -> impl Fn(i64, i64) -> bool + '_ {
    move |x, y| seed[usize::try_from(x + width * y).unwrap()]
}

#[test]
fn one_triangle_keeps_its_corners() {
    let points = Lattice(vec![[0, 0], [4, 0], [0, 3]]);
    assert_eq!(
        triangulate(&points, &[(0, 1), (1, 2), (2, 0)]),
        Ok(vec![[0, 1, 2]])
    );
    assert_eq!(
        triangulate(&points, &[(1, 0), (0, 2), (2, 1)]),
        Err(Error::Crossing { vertex: 1 })
    );
    assert_eq!(triangulate(&points, &[]), Ok(vec![]));
}

#[test]
fn straight_corners_stay_corners() {
    for k in 1..12 {
        for sides in 1..8 {
            let corners = [[0, 0], [12, 0], [0, 12]];
            let mut outline = Vec::new();
            for side in 0..3 {
                let (p, q): ([i64; 2], [i64; 2]) = (corners[side], corners[(side + 1) % 3]);
                let runs = if sides >> side & 1 == 1 { k } else { 0 };
                outline.extend(
                    (0..=runs)
                        .map(|j| [p[0] * 12 + (q[0] - p[0]) * j, p[1] * 12 + (q[1] - p[1]) * j]),
                );
            }
            let (mut points, mut edges) = (Lattice::default(), Edges::new());
            points.push_loop(&mut edges, &outline);
            check_all_ways(&points, &edges);
        }
    }
}

#[test]
fn all_small_cell_patterns() {
    for pattern in 0..1 << 9 {
        let filled = |x: i64, y: i64| pattern >> (x + 3 * y) & 1 == 1;
        let (points, edges) = cells_outline(filled, 3, 3);
        check_all_ways(&points, &edges);
        check_all_ways(&points, &straightened(&points, &edges, |_| true));
    }
}

#[test]
fn chessboards_touch_at_every_corner() {
    let (points, edges) = cells_outline(|x, y| (x + y) % 2 == 0, 20, 20);
    assert_eq!(check(&points, &edges).len(), 400);
    check_all_ways(&points, &edges);
    let (points, edges) = cells_outline(|x, y| x % 2 == 0 || y % 2 == 0, 41, 41);
    check_all_ways(&points, &edges);
    check_all_ways(&points, &straightened(&points, &edges, |v| v % 3 != 0));
}

#[test]
fn many_wedges_meet_at_one_vertex() {
    let spokes = (-6..=6)
        .flat_map(|x| (-6..=6).map(move |y| [x, y]))
        .collect();
    let rim = star(spokes).unwrap();
    let (mut points, mut edges) = (Lattice(vec![[0, 0]]), Edges::new());
    for pair in scaled(&rim, 10).chunks_exact(2) {
        let first = u32::try_from(points.0.len()).unwrap();
        points.0.extend(pair);
        edges.extend([(0, first), (first, first + 1), (first + 1, 0)]);
    }
    check_all_ways(&points, &edges);
    let mut holes: Edges = edges.iter().map(|&(a, b)| (b, a)).collect();
    points.push_loop(
        &mut holes,
        &[[-100, -100], [100, -100], [100, 100], [-100, 100]],
    );
    check_all_ways(&points, &holes);
}

#[test]
fn combs_and_spirals() {
    let mut comb = vec![[0, 0], [400, 0]];
    comb.extend(
        (0..400)
            .rev()
            .map(|k| [k, if k % 2 == 0 { 1 } else { 300 + k % 7 }]),
    );
    let turn = |k: usize, radius: i64| {
        [
            [radius, -radius],
            [radius, radius],
            [-radius, radius],
            [-radius, -radius],
        ][k % 4]
    };
    let radius = |k: usize| 4 * i64::try_from(k + 1).unwrap();
    let mut spiral: Vec<[i64; 2]> = (0..101).map(|k| turn(k, radius(k))).collect();
    spiral.extend((0..101).rev().map(|k| turn(k, radius(k) - 1)));
    for outline in [comb, spiral] {
        let (mut points, mut edges) = (Lattice::default(), Edges::new());
        points.push_loop(&mut edges, &outline);
        check_all_ways(&points, &edges);
    }
}

#[test]
fn plate_with_400_holes() {
    let (mut points, mut edges) = (Lattice::default(), Edges::new());
    points.push_loop(&mut edges, &[[0, 0], [4000, 0], [4000, 4000], [0, 4000]]);
    for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
        let ring: [[i64; 2]; 8] = [
            [30, 0],
            [21, 21],
            [0, 30],
            [-21, 21],
            [-30, 0],
            [-21, -21],
            [0, -30],
            [21, -21],
        ];
        points.push_loop(
            &mut edges,
            &reversed(&ring.map(|[x, y]| [200 * i + 100 + x, 200 * j + 100 + y])),
        );
    }
    assert_eq!(check(&points, &edges).len(), edges.len() + 2 * 400 - 2);
    check_all_ways(&points, &edges);
}

#[test]
fn flips_find_the_short_diagonal() {
    let (mut points, mut edges) = (Lattice::default(), Edges::new());
    points.push_loop(&mut edges, &[[0, 0], [100, -1], [200, 0], [100, 1]]);
    let triangles = check(&points, &edges);
    assert!(triangles
        .iter()
        .all(|corners| corners.contains(&1) && corners.contains(&3)));
}

/// The triangles by the coordinates of their corners, each from its least corner on.
fn by_place(points: &Lattice, triangles: &[[u32; 3]]) -> BTreeSet<[[i64; 2]; 3]> {
    let placed = |corners: &[u32; 3]| {
        let mut places = corners.map(|v| points.0[v as usize]);
        let least = (0..3).min_by_key(|k| places[*k]).unwrap();
        places.rotate_left(least);
        places
    };
    triangles.iter().map(placed).collect()
}

/// A shape with its points and edges numbered in another order.
fn renumbered(points: &Lattice, edges: &Edges, step: usize) -> (Lattice, Edges) {
    let count = points.0.len();
    let image = |v: u32| (v as usize * step + 1) % count;
    let mut places = points.0.clone();
    for v in 0..u32::try_from(count).unwrap() {
        places[image(v)] = points.0[v as usize];
    }
    let number = |v: u32| u32::try_from(image(v)).unwrap();
    let mut edges: Edges = edges.iter().map(|&(a, b)| (number(a), number(b))).collect();
    let turn = step % edges.len();
    edges.rotate_left(turn);
    (Lattice(places), edges)
}

#[test]
fn numbers_do_not_choose_the_triangles() {
    let far = (1 << 53) - 40;
    for corners in [
        vec![[0, 0], [9, 0], [9, 5], [0, 5]],
        vec![
            [far, far],
            [far + 30, far],
            [far + 30, far + 1],
            [far, far + 1],
        ],
        vec![[3, 0], [4, 0], [7, 3], [7, 4], [4, 7], [3, 7], [0, 4]],
        vec![
            [5, 0],
            [4, 3],
            [3, 4],
            [0, 5],
            [-3, 4],
            [-4, 3],
            [-5, 0],
            [-4, -3],
            [0, -5],
            [4, -3],
        ],
    ] {
        let (mut points, mut edges) = (Lattice::default(), Edges::new());
        points.push_loop(&mut edges, &corners);
        let expected = by_place(&points, &check(&points, &edges));
        let swept = triangulate_by_sweep(&points, &edges).unwrap();
        assert_eq!(by_place(&points, &swept), expected);
        for step in (1..corners.len()).filter(|k| gcd(*k, corners.len()) == 1) {
            let (points, edges) = renumbered(&points, &edges, step);
            assert_eq!(by_place(&points, &check(&points, &edges)), expected);
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        gcd(b, a % b)
    }
}

#[test]
fn malformed_boundaries_are_named() {
    let square = Lattice(vec![[0, 0], [4, 0], [4, 4], [0, 4], [2, 2]]);
    let open = [(0, 1), (1, 2), (2, 3)];
    assert_eq!(triangulate(&square, &open), Err(Error::Open { vertex: 3 }));
    let slit = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 0)];
    assert!(matches!(
        triangulate(&square, &slit),
        Err(Error::Overlap { .. })
    ));
    let doubled = [(0, 1), (1, 2), (2, 0), (0, 1), (1, 2), (2, 0)];
    assert!(matches!(
        triangulate(&square, &doubled),
        Err(Error::Overlap { .. })
    ));
    let no_length = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 4)];
    assert!(matches!(
        triangulate(&square, &no_length),
        Err(Error::Overlap { .. } | Error::Crossing { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn random_cells(seed in prop::collection::vec(any::<bool>(), 100), dense in any::<bool>(), drop in any::<u32>()) {
        let filled = |x: i64, y: i64| bits(10, &seed)(x, y) || dense && (x * 7 + y * 3) % 4 != 0;
        let (points, edges) = cells_outline(filled, 10, 10);
        check_all_ways(&points, &edges);
        check_all_ways(&points, &straightened(&points, &edges, |v| drop >> (v % 32) & 1 == 1));
    }

    #[test]
    fn random_stars(spokes in prop::collection::vec([-40_i64..40, -40_i64..40], 3..80)) {
        let Some(outline) = star(spokes) else { return Ok(()) };
        let (mut points, mut edges) = (Lattice::default(), Edges::new());
        points.push_loop(&mut edges, &scaled(&outline, 3));
        check_all_ways(&points, &edges);
        points.push_loop(&mut edges, &scaled(&reversed(&outline), 2));
        check_all_ways(&points, &edges);
        points.push_loop(&mut edges, &outline);
        check_all_ways(&points, &edges);
    }

    #[test]
    fn small_stars(spokes in prop::collection::vec([-3_i64..4, -3_i64..4], 3..10)) {
        let Some(outline) = star(spokes) else { return Ok(()) };
        let (mut points, mut edges) = (Lattice::default(), Edges::new());
        points.push_loop(&mut edges, &outline);
        check_all_ways(&points, &edges);
    }

    #[test]
    fn nonsense_never_panics(
        places in prop::collection::vec([-3_i64..4, -3_i64..4], 12),
        edges in prop::collection::vec((0_u32..12, 0_u32..12), 0..30),
    ) {
        let _ = triangulate(&Lattice(places), &edges);
    }

    #[test]
    fn tangled_loops_never_panic(
        places in prop::collection::vec([-20_i64..20, -20_i64..20], 12),
        walk in prop::collection::vec(0_u32..12, 3..40),
    ) {
        let edges: Edges = (0..walk.len()).map(|k| (walk[k], walk[(k + 1) % walk.len()])).collect();
        let _ = triangulate(&Lattice(places), &edges);
    }
}
