//! Outlines of sets of polygons in a plane: the edges that remain after opposite ones cancel.

use std::cmp::Ordering;
use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;
use smallvec::SmallVec;

use super::line::{LineKey, PlaneResidues};
use super::plane::Plane;
use super::polygon::{Carrier, Corner, Polygon, PolygonSplit};
use super::side::Side;
use super::vertex::Vertex;

/// A directed edge in a plane, with the region it bounds on its left and the key of its line.
#[derive(Clone, Debug)]
pub struct OutlineEdge {
    /// The start of the edge.
    pub from: Arc<Vertex>,
    /// The end of the edge.
    pub to: Arc<Vertex>,
    /// The lattice edge or the plane that contains the edge; the edge lies where it meets the region's plane.
    pub carrier: Carrier,
    /// The key of the line through the edge.
    pub line: LineKey,
}

/// A directed edge in a plane, with the region it bounds on its left; without the key of its line, to save
/// memory.
#[derive(Clone, Debug)]
pub struct BareEdge {
    /// The start of the edge.
    pub from: Arc<Vertex>,
    /// The end of the edge.
    pub to: Arc<Vertex>,
    /// The lattice edge or the plane that contains the edge; the edge lies where it meets the region's plane.
    pub carrier: Carrier,
}

impl From<OutlineEdge> for BareEdge {
    fn from(edge: OutlineEdge) -> Self {
        Self {
            from: edge.from,
            to: edge.to,
            carrier: edge.carrier,
        }
    }
}

impl BareEdge {
    /// The edges of a polygon, counterclockwise.
    pub fn edges_of(polygon: &Polygon) -> impl Iterator<Item = Self> + '_ {
        polygon.edges().map(|(from, to, carrier)| Self {
            from: Arc::clone(from),
            to: Arc::clone(to),
            carrier: carrier.clone(),
        })
    }

    fn keyed(self, line: LineKey) -> OutlineEdge {
        OutlineEdge {
            from: self.from,
            to: self.to,
            carrier: self.carrier,
            line,
        }
    }
}

impl OutlineEdge {
    /// The edges of a polygon, counterclockwise, with the keys of their lines.
    pub fn edges_of(polygon: &Polygon) -> impl Iterator<Item = Self> + '_ {
        let lines = lines(
            polygon.edges().map(|e| e.2),
            &PlaneResidues::of(polygon.support()),
        );
        let bare = BareEdge::edges_of(polygon).zip(lines);
        bare.map(|(edge, line)| edge.keyed(line))
    }

    /// Edges in the plane `support`, with the keys of their lines added.
    pub fn keyed(edges: Vec<BareEdge>, support: &PlaneResidues) -> Vec<Self> {
        let lines = lines(edges.iter().map(|e| &e.carrier), support);
        let bare = edges.into_iter().zip(lines);
        bare.map(|(edge, line)| edge.keyed(line)).collect()
    }

    /// The same edge in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            from: Arc::clone(&self.to),
            to: Arc::clone(&self.from),
            ..self.clone()
        }
    }

    fn is_forward(&self) -> bool {
        order_along(&self.from, &self.to, self.line.axis()) == Ordering::Less
    }
}

/// The directed edges that bound a region of a plane; no two of them overlap, or continue each other on one
/// line. Caches the keys of their lines.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    edges: Box<[BareEdge]>,
    /// The key of each edge's line; empty before the first use.
    lines: Box<[LineKey]>,
}

impl Outline {
    /// The outline of edges that neither overlap nor continue each other.
    pub fn of_bare(edges: &[BareEdge]) -> Self {
        Self {
            edges: edges.into(),
            lines: Box::default(),
        }
    }

    /// Return the outline of any edges: overlapping opposite edges cancel, and edges that continue each other
    /// are joined.
    pub fn of(edges: Vec<OutlineEdge>) -> Self {
        let edges = maximal_edges(edges);
        let lines = edges.iter().map(|e| e.line).collect();
        let edges = edges.into_iter().map(BareEdge::from).collect();
        Self { edges, lines }
    }

    /// The edges of the outline.
    pub fn edges(&self) -> &[BareEdge] {
        &self.edges
    }

    /// The keys of the lines of the outline's edges, in their order; all edges lie in `plane`.
    pub fn lines(&mut self, plane: &PlaneResidues) -> &[LineKey] {
        if self.lines.is_empty() {
            let carriers = self.edges.iter().map(|e| &e.carrier);
            self.lines = lines(carriers, plane).into_boxed_slice();
        }
        &self.lines
    }

    /// The outline's edges with the keys of their lines; all edges lie in `plane`.
    pub fn keyed(mut self, plane: &PlaneResidues) -> Vec<OutlineEdge> {
        self.lines(plane);
        let keyed = self.edges.into_vec().into_iter().zip(self.lines);
        keyed.map(|(edge, line)| edge.keyed(line)).collect()
    }

    /// The outline of the same region seen from the other side: each edge reversed.
    #[must_use]
    pub fn flipped(mut self) -> Self {
        for edge in &mut self.edges {
            std::mem::swap(&mut edge.from, &mut edge.to);
        }
        self
    }
}

fn lines<'a>(
    carriers: impl Iterator<Item = &'a Carrier>,
    support: &PlaneResidues,
) -> SmallVec<[LineKey; 8]> {
    LineKey::of_all(carriers.map(|carrier| carrier.line(support)))
}

/// The exact order of two points of one line by their coordinate along an axis.
pub fn order_along(a: &Arc<Vertex>, b: &Arc<Vertex>, axis: usize) -> Ordering {
    if Arc::ptr_eq(a, b) {
        Ordering::Equal
    } else {
        a.compare_along(b, axis)
    }
}

/// The maximal edges that remain when opposite ones cancel as in [`cancel`], without spare capacity.
pub fn maximal_edges(edges: Vec<OutlineEdge>) -> Vec<OutlineEdge> {
    if edges.is_sorted_by(|a, b| a.line < b.line) {
        return edges;
    }
    let mut kept = cancel(edges);
    kept.shrink_to_fit();
    kept
}

/// The given edges in their order if none of them cancel or continue each other, else the edges that remain.
pub fn cancelled_if_needed(edges: Vec<OutlineEdge>) -> Vec<OutlineEdge> {
    let ends = |e: &OutlineEdge| (Arc::as_ptr(&e.from), Arc::as_ptr(&e.to));
    let mut kept = cancel(edges.clone());
    let given: HashSet<_> = edges.iter().map(ends).collect();
    if kept.len() == edges.len() && kept.iter().all(|e| given.contains(&ends(e))) {
        return edges;
    }
    kept.shrink_to_fit();
    kept
}

/// Cancels opposite edges and joins the remaining parts into maximal edges, line by line.
///
/// # Order
/// By line key, then along the line.
pub fn cancel(mut edges: Vec<OutlineEdge>) -> Vec<OutlineEdge> {
    let order = by_line(&edges);
    let mut alone: SmallVec<[bool; 64]> = SmallVec::from_elem(false, edges.len());
    let mut joined = Vec::new();
    let line = |entry: &EdgeByLine| &edges[entry.edge as usize].line;
    for run in order.chunk_by(|a, b| a.line_hash == b.line_hash && line(a) == line(b)) {
        match run {
            [single] => alone[single.edge as usize] = true,
            _ => cancel_line(&edges, run, &mut joined),
        }
    }
    let mut alone = alone.iter();
    edges.retain(|_| alone.next().is_some_and(|a| *a));
    edges.append(&mut joined);
    edges.sort_by_key(|e| e.line);
    edges
}

/// An edge's index, with the sort key of its line.
struct EdgeByLine {
    /// A hash of the line's key, faster to compare than the key itself.
    line_hash: u64,
    edge: u32,
}

/// Indices of the edges, grouped by line; within a line in the given order.
fn by_line(edges: &[OutlineEdge]) -> SmallVec<[EdgeByLine; 32]> {
    let entries = (0..).zip(edges).map(|(edge, e)| EdgeByLine {
        line_hash: e.line.line_hash(),
        edge,
    });
    let mut order: SmallVec<[EdgeByLine; 32]> = entries.collect();
    order.sort_unstable_by(|a, b| {
        let line = |entry: &EdgeByLine| &edges[entry.edge as usize].line;
        let by_key = || line(a).cmp(line(b)).then(a.edge.cmp(&b.edge));
        a.line_hash.cmp(&b.line_hash).then_with(by_key)
    });
    order
}

struct Event<'a> {
    at: &'a Arc<Vertex>,
    change: i32,
}

/// Cancels opposite edges among the edges `run`, which lie on one line, and appends the remaining maximal
/// edges to `kept`.
fn cancel_line(edges: &[OutlineEdge], run: &[EdgeByLine], kept: &mut Vec<OutlineEdge>) {
    let run: SmallVec<[&OutlineEdge; 16]> = run.iter().map(|p| &edges[p.edge as usize]).collect();
    let axis = run[0].line.axis();
    if let [a, b] = run[..]
        && is_opposite(a, b, axis)
    {
        return;
    }
    let mut events: SmallVec<[Event; 32]> = SmallVec::with_capacity(2 * run.len());
    for edge in &run {
        events.push(Event {
            at: &edge.from,
            change: 1,
        });
        events.push(Event {
            at: &edge.to,
            change: -1,
        });
    }
    each_segment(&mut events, axis, |sum, low, high| {
        push_copies(&run, sum, low, high, kept);
    });
}

/// Calls `emit` for each interval of a line on which the running sum of the changes at its points is constant
/// and not zero; the arguments are the sum and both ends.
fn each_segment<'a>(
    events: &mut [Event<'a>],
    axis: usize,
    mut emit: impl FnMut(i32, &'a Arc<Vertex>, &'a Arc<Vertex>),
) {
    events.sort_by(|a, b| order_along(a.at, b.at, axis));
    let mut sum = 0;
    let mut start: Option<&Arc<Vertex>> = None;
    for group in events.chunk_by(|a, b| order_along(a.at, b.at, axis) == Ordering::Equal) {
        let next = sum + group.iter().map(|e| e.change).sum::<i32>();
        if next != sum {
            if let (Some(from), true) = (start, sum != 0) {
                emit(sum, from, group[0].at);
            }
            start = Some(group[0].at);
            sum = next;
        }
    }
}

/// Return whether two edges of one line are each other's reverse.
fn is_opposite(a: &OutlineEdge, b: &OutlineEdge, axis: usize) -> bool {
    let same = |p, q| order_along(p, q, axis) == Ordering::Equal;
    same(&a.from, &b.to) && same(&a.to, &b.from)
}

/// Appends |sum| copies of the edge between two points of a line; it runs from `low` to `high` if `sum` is
/// positive, else from `high` to `low`.
fn push_copies(
    run: &[&OutlineEdge],
    sum: i32,
    low: &Arc<Vertex>,
    high: &Arc<Vertex>,
    kept: &mut Vec<OutlineEdge>,
) {
    let forward = sum > 0;
    let like = run
        .iter()
        .find(|e| e.is_forward() == forward)
        .unwrap_or(&run[0]);
    let (from, to) = if forward { (low, high) } else { (high, low) };
    for _ in 0..sum.unsigned_abs() {
        kept.push(OutlineEdge {
            from: Arc::clone(from),
            to: Arc::clone(to),
            carrier: like.carrier.clone(),
            line: like.line,
        });
    }
}

/// The polygon that an outline bounds, or `None` if it is not one convex loop.
///
/// The outline bounds a part of a convex face, so an outline edge that lies on an edge of the face needs no
/// test for convexity.
pub fn convex_loop(support: &Arc<Plane>, edges: &[BareEdge]) -> Option<Polygon> {
    let start = edges.first()?;
    let mut at = start;
    let mut ring = Vec::with_capacity(edges.len());
    for _ in edges {
        ring.push(Corner {
            at: Arc::clone(&at.from),
            edge: at.carrier.clone(),
        });
        let next = edges.iter().find(|e| Arc::ptr_eq(&e.from, &at.to))?;
        if continues(&at.carrier, &next.carrier) {
            return None;
        }
        at = next;
    }
    let closed = std::ptr::eq(at, start) && ring.len() >= 3;
    (closed && edges.iter().all(|e| bounds(&e.carrier, edges)))
        .then(|| Polygon::of_corners(ring, Arc::clone(support)))
}

/// Return whether two adjoining edges, both carried by edges of a face, lie on one line.
fn continues(first: &Carrier, second: &Carrier) -> bool {
    match (first, second) {
        (Carrier::Edge(first), Carrier::Edge(second)) => first.is_parallel(second),
        _ => false,
    }
}

/// Return whether a carrier (a plane or lattice edge that contains an outline edge) has no corner of the
/// outline on its outer side, and exactly two corners on it; always true for a lattice edge of the face.
fn bounds(carrier: &Carrier, edges: &[BareEdge]) -> bool {
    let Carrier::Cut(plane, plus) = carrier else {
        return true;
    };
    let beyond = if *plus { Side::Minus } else { Side::Plus };
    let mut ends = 0;
    for edge in edges {
        match edge.from.side_of(plane) {
            Side::On => ends += 1,
            side if side == beyond => return false,
            _ => {}
        }
    }
    ends == 2
}

/// The convex pieces of the part of a convex polygon that an outline bounds.
///
/// The polygon is divided along the lines of the outline's edges (a planar autopartition); at each edge the
/// region lies on the minus side.
///
/// # Source
/// Thibault, Naylor 1987 (autopartition).
pub fn pieces(polygon: Polygon, edges: &[BareEdge]) -> Vec<Polygon> {
    let mut inside = Vec::new();
    let mut open = vec![(polygon, edges.to_vec())];
    while let Some((polygon, mut edges)) = open.pop() {
        let Some(pivot) = edges.pop() else {
            inside.push(polygon);
            continue;
        };
        let cut = Arc::new(pivot.carrier.plane(polygon.support()));
        let (minus_edges, plus_edges) = divide_edges(edges, polygon.support(), &cut);
        let (minus, plus) = match polygon.split(&cut) {
            PolygonSplit::Minus => (Some(polygon), None),
            PolygonSplit::Plus => (None, Some(polygon)),
            PolygonSplit::Both(minus, plus) => (Some(minus), Some(plus)),
            PolygonSplit::Coplanar => (None, None),
        };
        if let (Some(plus), false) = (plus, plus_edges.is_empty()) {
            open.push((plus, plus_edges));
        }
        if let Some(minus) = minus {
            open.push((minus, minus_edges));
        }
    }
    inside
}

/// The outlines of a region's parts on the minus and on the plus side of a plane that crosses it.
///
/// New edges in the crossing plane close the two outlines.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::geometry::outline::{halves, BareEdge};
/// use bspcsg::geometry::plane::Plane;
/// use bspcsg::geometry::polygon::Polygon;
///
/// let corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];
/// let [a, b, c] = &corners;
/// let floor = Arc::new(Plane::through(a, b, c).expect("not on a line"));
/// let triangle = Polygon::triangle(&corners, Arc::clone(&floor));
/// let cut = Arc::new(Plane::through(&[1, 0, 0], &[1, 1, 0], &[1, 0, 1]).expect("a plane"));
/// let parts = halves(BareEdge::edges_of(&triangle).collect(), &floor, &cut);
/// assert_eq!(parts.map(|edges| edges.len()), [4, 3]);
/// ```
pub fn halves(edges: Vec<BareEdge>, support: &Arc<Plane>, cut: &Arc<Plane>) -> [Vec<BareEdge>; 2] {
    let axis = LineKey::of_planes(support, cut).axis();
    let (mut minus, mut plus) = divide_edges(edges, support, cut);
    minus.extend(chords(
        &minus,
        &Carrier::Cut(Arc::clone(cut), false),
        cut,
        axis,
    ));
    plus.extend(chords(
        &plus,
        &Carrier::Cut(Arc::clone(cut), true),
        cut,
        axis,
    ));
    [minus, plus]
}

/// The edges in the plane `cut` that close a part of an outline whose other edges start or end in this plane.
fn chords(edges: &[BareEdge], carrier: &Carrier, cut: &Plane, axis: usize) -> Vec<BareEdge> {
    let ends = edges.iter().flat_map(|e| [(&e.to, 1), (&e.from, -1)]);
    let met = ends.filter(|(at, _)| at.side_of(cut) == Side::On);
    let mut events: Vec<Event> = met.map(|(at, change)| Event { at, change }).collect();
    let mut chords = Vec::new();
    each_segment(&mut events, axis, |sum, low, high| {
        let (from, to) = if sum > 0 { (low, high) } else { (high, low) };
        let chord = BareEdge {
            from: Arc::clone(from),
            to: Arc::clone(to),
            carrier: carrier.clone(),
        };
        chords.extend(std::iter::repeat_n(chord, sum.unsigned_abs() as usize));
    });
    chords
}

fn divide_edges(
    edges: Vec<BareEdge>,
    support: &Arc<Plane>,
    cut: &Arc<Plane>,
) -> (Vec<BareEdge>, Vec<BareEdge>) {
    let (mut minus, mut plus) = (Vec::new(), Vec::new());
    for edge in edges {
        match (edge.from.side_of(cut), edge.to.side_of(cut)) {
            (Side::On, Side::On) => {}
            (Side::Minus | Side::On, Side::Minus | Side::On) => minus.push(edge),
            (Side::Plus | Side::On, Side::Plus | Side::On) => plus.push(edge),
            (from, _) => {
                let meet = edge.carrier.meet(support, cut);
                let at = Arc::new(meet.expect("an edge with ends on both sides meets the plane"));
                let (first, second) = cut_edge(&edge, &at);
                let (low, high) = if from == Side::Minus {
                    (first, second)
                } else {
                    (second, first)
                };
                minus.push(low);
                plus.push(high);
            }
        }
    }
    (minus, plus)
}

fn cut_edge(edge: &BareEdge, at: &Arc<Vertex>) -> (BareEdge, BareEdge) {
    let first = BareEdge {
        to: Arc::clone(at),
        ..edge.clone()
    };
    let second = BareEdge {
        from: Arc::clone(at),
        ..edge.clone()
    };
    (first, second)
}
