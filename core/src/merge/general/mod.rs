//! The leaf kernel for operands in general position.
//!
//! Only faces that truly cross are cut, by each other. Everything else keeps its winding numbers
//! over the whole cell: they are counted once along a path from the cell's corner, for all faces
//! that hang together at vertices. Whatever is special — faces in one plane, edges in faces,
//! contacts, operands that overlap themselves — is left to the local trees of `leaf`.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::cutting::{contact, cut_up, Contact, Cutter, Cutting, Face};
use super::expression::Expression;
use super::kept::Kept;
use super::list::{List, Sources};
use super::sweep::{pairs, Swept};
use crate::geometry::apart::are_apart;
use crate::geometry::cell::Cell;
use crate::geometry::path::triangle_on_path;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::vertex::Vertex;
use crate::mesh::source::{Shape, Source};
use crate::tree::node::Part;

/// More operands than this do not meet in one small cell, or are left to the local trees.
const MOST: usize = 64;

/// For each operand of the cell whether a region is inside it, as bits.
type Labels = u64;

/// What stays of the operands' boundaries in a cell, and the winding number at its corner; `None`
/// if their position is special.
pub fn evaluate(
    cell: &Cell,
    expression: &Expression,
    lists: &[(u32, &List)],
    sources: &Sources,
) -> Option<(Vec<Kept>, i32)> {
    let simple = lists.iter().all(|(_, list)| (0..=1).contains(&list.corner));
    if !simple || lists.len() < 2 || lists.len() > MOST {
        return None;
    }
    let scene = Scene::new(cell, lists, sources);
    let fates = scene.fates()?;
    let labels = scene.labels(&fates)?;
    let place = |number: u32| lists.partition_point(|l| l.0 < number);
    let scratch = &mut Vec::new();
    let mut value = |bits: Labels| expression.value(|k| bits >> place(k) & 1 == 1, scratch);
    let corner = i32::from(value(scene.at_corner()));
    let kept = scene.keep(fates, &labels, &mut value);
    Some((kept, corner))
}

/// A whole face or a convex piece of a part.
struct Element<'a> {
    operand: usize,
    weight: i32,
    place: Place<'a>,
    low: Lattice,
    high: Lattice,
}

enum Place<'a> {
    Face(Triangle<'a>),
    /// The face of a half-space: its slot, and its part in the cell.
    Plane(u32, Face<'a>),
    /// A piece of a part: the part's number in the scene.
    Piece(usize, Face<'a>),
}

/// A whole face.
struct Triangle<'a> {
    source: &'a Source,
    slot: u32,
    face: u32,
    vertices: [u32; 3],
    corners: [Lattice; 3],
    shape: OnceCell<Face<'a>>,
}

struct Scene<'a> {
    cell: &'a Cell,
    corner: Lattice,
    corners: Vec<i32>,
    elements: Vec<Element<'a>>,
    /// For each operand where its elements end.
    ends: Vec<usize>,
    parts: Vec<(&'a Arc<Part>, u32)>,
}

/// What became of an element.
enum Fate {
    /// It does not meet the cell.
    Absent,
    /// Nothing crosses it, and it has these anchors, at least one.
    Uncut(Anchors),
    /// It was cut up; it has these anchors, and this corner if it has none.
    Cut(Cutting, Arc<Vertex>, Anchors),
}

/// What stays of an element on one side.
enum Stays {
    Nothing,
    All,
    Pieces(Vec<Polygon>),
}

impl<'a> Scene<'a> {
    fn new(cell: &'a Cell, lists: &[(u32, &'a List)], sources: &'a Sources) -> Self {
        let mut scene = Self {
            cell,
            corner: cell.corner(),
            corners: lists.iter().map(|l| l.1.corner).collect(),
            elements: Vec::with_capacity(lists.iter().map(|l| l.1.len()).sum()),
            ends: Vec::with_capacity(lists.len()),
            parts: Vec::new(),
        };
        for (operand, (_, list)) in lists.iter().enumerate() {
            scene.add_faces(operand, list, sources);
            scene.add_parts(operand, list, sources);
            scene.ends.push(scene.elements.len());
        }
        scene
    }

    fn add_faces(&mut self, operand: usize, list: &List, sources: &'a Sources) {
        for r in &list.records {
            let source = sources.get(r.slot());
            let slot = r.slot() as u32;
            let weight = if r.flip() { -1 } else { 1 };
            let place = match source.shape() {
                Shape::Mesh(mesh) => Place::Face(Triangle {
                    source,
                    slot,
                    face: r.face,
                    vertices: mesh.faces[r.face as usize],
                    corners: mesh.corners(r.face),
                    shape: OnceCell::new(),
                }),
                Shape::HalfSpace(plane) => match Polygon::span(plane, self.cell) {
                    Some(polygon) => Place::Plane(slot, Face::new(Cow::Owned(polygon))),
                    None => continue,
                },
            };
            let (low, high) = source.face_box(r.face);
            self.elements.push(Element {
                operand,
                weight,
                place,
                low,
                high,
            });
        }
    }

    fn add_parts(&mut self, operand: usize, list: &'a List, sources: &Sources) {
        for p in &list.parts {
            let part = self.parts.len();
            let slot = sources.slot(&p.element.part.source) as u32;
            self.parts.push((&p.element.part, slot));
            for piece in p.pieces.iter() {
                let (low, high) = piece.bounds();
                self.elements.push(Element {
                    operand,
                    weight: if p.element.flip { -1 } else { 1 },
                    place: Place::Piece(part, Face::new(Cow::Borrowed(piece))),
                    low: low.map(|x| x.floor() as i64),
                    high: high.map(|x| x.ceil() as i64),
                });
            }
        }
    }

    fn at_corner(&self) -> Labels {
        bits(self.corners.iter().map(|w| *w > 0))
    }

    fn of_operand(&self, operand: usize) -> &[Element<'a>] {
        let start = if operand == 0 {
            0
        } else {
            self.ends[operand - 1]
        };
        &self.elements[start..self.ends[operand]]
    }

    /// For each element those of other operands that may meet it inside the cell; `None` if they
    /// are too many to be found by a sweep.
    fn neighbours(&self) -> Option<Vec<Vec<u32>>> {
        let swept: Vec<Swept> = self.elements.iter().map(|e| e.swept(self.cell)).collect();
        let mut found = vec![Vec::new(); self.elements.len()];
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

    fn fates(&self) -> Option<Vec<Fate>> {
        let neighbours = self.neighbours()?;
        (0..self.elements.len())
            .map(|i| self.fate(i, &neighbours[i]))
            .collect()
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

    /// For each element the labels of the other operands on its pieces.
    ///
    /// They spread from piece to piece and, at anchors, from element to element; only where nothing
    /// is known yet they are counted.
    fn labels(&self, fates: &[Fate]) -> Option<Vec<Vec<Labels>>> {
        let mut known = Known::new(self, fates);
        let mut labels: Vec<Vec<Labels>> = vec![Vec::new(); fates.len()];
        for (i, fate) in fates.iter().enumerate() {
            if let (Fate::Cut(cutting, base, anchors), true) = (fate, labels[i].is_empty()) {
                let operand = self.elements[i].operand;
                let (piece, start) = match anchors.first() {
                    Some(anchor) => (anchor.piece(cutting)?, known.label(self, operand, anchor)?),
                    None => (
                        piece_with(cutting, |at| Arc::ptr_eq(at, base))?,
                        self.count(operand, base)?,
                    ),
                };
                self.flood(fates, (i, piece, start), &mut known, &mut labels)?;
            }
        }
        for ((element, fate), labels) in self.elements.iter().zip(fates).zip(&mut labels) {
            if let Fate::Uncut(anchors) = fate {
                labels.push(known.label(self, element.operand, &anchors[0])?);
            }
        }
        Some(labels)
    }

    /// Labels the pieces of a cut element from one of them, and of all cut elements that share
    /// anchors with it.
    fn flood(
        &self,
        fates: &[Fate],
        start: (usize, usize, Labels),
        known: &mut Known,
        labels: &mut [Vec<Labels>],
    ) -> Option<()> {
        let mut open = vec![start];
        while let Some((i, piece, start)) = open.pop() {
            let (Fate::Cut(cutting, _, anchors), true) = (&fates[i], labels[i].is_empty()) else {
                continue;
            };
            labels[i] = spread(cutting, piece, start)?;
            for anchor in anchors {
                let label = labels[i][anchor.piece(cutting)?];
                let root = known.root(self.elements[i].operand, anchor) as usize;
                match known.labels[root].replace(label) {
                    Some(other) if other != label => return None,
                    Some(_) => {}
                    None => open.extend(known.cut_at(root, fates, label)?),
                }
            }
        }
        Some(())
    }

    /// The labels of all operands but one at an exact point of that one's boundary.
    fn count(&self, own: usize, point: &Vertex) -> Option<Labels> {
        let across = |e: &Element| e.shape().on_path(&self.corner, point);
        let near = point.approx();
        let (low, high) = (
            near.map(|x| x.floor() as i64),
            near.map(|x| x.ceil() as i64),
        );
        self.count_by(own, &low, &high, across)
    }

    /// The labels of all operands but one at a lattice vertex of that one.
    fn count_at_lattice(&self, own: usize, point: &Lattice) -> Option<Labels> {
        let exact = Vertex::lattice(*point);
        let across = |e: &Element| match &e.place {
            Place::Face(t) => triangle_on_path(&t.corners, &self.corner, point),
            _ => e.shape().on_path(&self.corner, &exact),
        };
        self.count_by(own, point, point, across)
    }

    fn count_by(
        &self,
        own: usize,
        low: &Lattice,
        high: &Lattice,
        across: impl Fn(&Element) -> Option<i32>,
    ) -> Option<Labels> {
        let start = self.cell.low();
        let from = [0, 1, 2].map(|i| low[i].min(start[i]) - 1);
        let to = [0, 1, 2].map(|i| high[i].max(start[i]) + 1);
        let near = |e: &&Element| (0..3).all(|i| e.low[i] <= to[i] && e.high[i] >= from[i]);
        let mut labels = 0;
        for operand in (0..self.corners.len()).filter(|k| *k != own) {
            let mut w = self.corners[operand];
            for element in self.of_operand(operand).iter().filter(near) {
                w += element.weight * across(element)?;
            }
            if !(0..=1).contains(&w) {
                return None;
            }
            labels |= Labels::from(w == 1) << operand;
        }
        Some(labels)
    }

    fn keep(
        &self,
        fates: Vec<Fate>,
        labels: &[Vec<Labels>],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> Vec<Kept> {
        let mut kept = Vec::new();
        let mut parts: Vec<Vec<(usize, [Stays; 2])>> = Vec::new();
        parts.resize_with(self.parts.len(), Vec::new);
        for (i, fate) in fates.into_iter().enumerate() {
            if matches!(fate, Fate::Absent) {
                continue;
            }
            let element = &self.elements[i];
            let stays = element.stays(fate, &labels[i], value);
            let face = match &element.place {
                Place::Face(t) => (t.slot, t.face),
                Place::Plane(slot, _) => (*slot, 0),
                Place::Piece(part, _) => {
                    parts[*part].push((i, stays));
                    continue;
                }
            };
            for (stays, flip) in stays.into_iter().zip([false, true]) {
                match stays {
                    Stays::Nothing => {}
                    Stays::All => kept.push(Kept::whole(face, flip)),
                    Stays::Pieces(polygons) => kept.push(Kept::pieces(face, flip, polygons)),
                }
            }
        }
        for (part, pieces) in parts.into_iter().enumerate() {
            self.keep_part(part, pieces, &mut kept);
        }
        kept
    }

    /// Keeps a part as it is if all its pieces stay alike, else what stays of its pieces.
    fn keep_part(&self, part: usize, pieces: Vec<(usize, [Stays; 2])>, kept: &mut Vec<Kept>) {
        let (part, slot) = self.parts[part];
        let face = (slot, part.face);
        let mut sides = [Vec::new(), Vec::new()];
        for (i, [same, turned]) in pieces {
            sides[0].push((i, same));
            sides[1].push((i, turned));
        }
        for (pieces, flip) in sides.into_iter().zip([false, true]) {
            if !pieces.is_empty() && pieces.iter().all(|p| matches!(p.1, Stays::All)) {
                kept.push(Kept::part(face, flip, Arc::clone(part)));
                continue;
            }
            let polygons: Vec<Polygon> = pieces
                .into_iter()
                .flat_map(|(i, stays)| match stays {
                    Stays::Nothing => Vec::new(),
                    Stays::All => self.elements[i].polygon_in(self.cell).into_iter().collect(),
                    Stays::Pieces(polygons) => polygons,
                })
                .collect();
            if !polygons.is_empty() {
                kept.push(Kept::pieces(face, flip, polygons));
            }
        }
    }
}

impl<'a> Element<'a> {
    fn swept(&self, cell: &Cell) -> Swept {
        let (low, high) = (cell.low(), cell.high());
        let relative = |p: &Lattice| [0, 1, 2].map(|i| (p[i] - low[i]) as f64);
        Swept {
            operand: self.operand,
            low: [0, 1, 2].map(|i| self.low[i].max(low[i] - 1)),
            high: [0, 1, 2].map(|i| self.high[i].min(high[i] + 1)),
            corners: match &self.place {
                Place::Face(t) => Some([0, 1, 2].map(|i| relative(&t.corners[i]))),
                Place::Plane(..) | Place::Piece(..) => None,
            },
        }
    }

    fn shape(&self) -> &Face<'a> {
        match &self.place {
            Place::Face(t) => t.shape.get_or_init(|| {
                let plane = t.source.plane(t.face);
                Face::new(Cow::Owned(Polygon::triangle(&t.corners, plane)))
            }),
            Place::Plane(_, shape) | Place::Piece(_, shape) => shape,
        }
    }

    fn polygon(&self) -> &Polygon {
        &self.shape().polygon
    }

    fn polygon_in(&self, cell: &Cell) -> Option<Polygon> {
        self.polygon().clone().clipped(cell)
    }

    /// The corners inside the cell that other elements of the operand may share.
    fn anchors(&self, cell: &Cell) -> Anchors {
        match &self.place {
            Place::Face(t) => (0..3)
                .filter(|i| cell.holds_box(&t.corners[*i], &t.corners[*i]))
                .map(|i| Anchor {
                    name: Name::Vertex(t.slot, t.vertices[i]),
                    place: Spot::Lattice(t.corners[i]),
                })
                .collect(),
            Place::Piece(_, shape) => {
                let corners = shape.polygon.corners().iter().map(|c| &c.at);
                corners
                    .filter(|v| is_well_inside(v, cell))
                    .map(Anchor::of_corner)
                    .collect()
            }
            Place::Plane(..) => SmallVec::new(),
        }
    }

    /// The points in which a face's own edges leave the cell: its neighbours share them.
    fn anchors_at_walls(&self, clipped: &Polygon) -> Anchors {
        let Place::Face(triangle) = &self.place else {
            return SmallVec::new();
        };
        let corners = clipped.corners();
        let n = corners.len();
        (0..n)
            .filter_map(|i| {
                let (edge, wall) = match (&corners[(i + n - 1) % n].edge, &corners[i].edge) {
                    (Carrier::Edge(a, b), Carrier::Cut(wall, _))
                    | (Carrier::Cut(wall, _), Carrier::Edge(a, b)) => ((*a, *b), wall),
                    _ => return None,
                };
                let axis = wall.only_axis()?;
                let wall = (axis, wall.normal()[axis] > 0);
                let ends = (edge.0.min(edge.1), edge.0.max(edge.1));
                Some(Anchor {
                    name: Name::Crossing(triangle.slot, ends, wall),
                    place: Spot::Exact(Arc::clone(&corners[i].at)),
                })
            })
            .collect()
    }

    /// What stays in the element's own orientation, and what stays turned.
    fn stays(
        &self,
        fate: Fate,
        labels: &[Labels],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> [Stays; 2] {
        let own: Labels = 1 << self.operand;
        let sides: SmallVec<[Option<usize>; 4]> = labels
            .iter()
            .map(|others| {
                let (inside, outside) = (value(others | own), value(others & !own));
                let turned = outside != (self.weight < 0);
                (inside != outside).then_some(usize::from(turned))
            })
            .collect();
        let mut stays = [Stays::Nothing, Stays::Nothing];
        let Some(first) = sides[0] else {
            return stays_of_pieces(fate, &sides);
        };
        if sides.iter().all(|s| *s == Some(first)) {
            stays[first] = Stays::All;
            return stays;
        }
        stays_of_pieces(fate, &sides)
    }
}

/// The pieces by the sides on which they stay.
fn stays_of_pieces(fate: Fate, sides: &[Option<usize>]) -> [Stays; 2] {
    let mut found = [Vec::new(), Vec::new()];
    if let Fate::Cut(cutting, ..) = fate {
        for (piece, side) in cutting.pieces.into_iter().zip(sides) {
            if let Some(side) = side {
                found[*side].push(piece);
            }
        }
    }
    found.map(|pieces| {
        if pieces.is_empty() {
            Stays::Nothing
        } else {
            Stays::Pieces(pieces)
        }
    })
}

/// A point of an operand's boundary inside the cell.
#[derive(Clone)]
struct Anchor {
    name: Name,
    place: Spot,
}

type Anchors = SmallVec<[Anchor; 3]>;

/// What tells points apart that several elements may have in common.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Name {
    /// A vertex of a source.
    Vertex(u32, u32),
    /// A corner of a part: pieces that share the corner share the object at this address.
    Corner(usize),
    /// The point in which an edge of a source leaves the cell: the axis of the wall, and whether
    /// it is the upper one.
    Crossing(u32, (Lattice, Lattice), (usize, bool)),
}

#[derive(Clone)]
enum Spot {
    Lattice(Lattice),
    Exact(Arc<Vertex>),
}

impl Anchor {
    fn of_corner(vertex: &Arc<Vertex>) -> Self {
        Self {
            name: Name::Corner(Arc::as_ptr(vertex) as usize),
            place: Spot::Exact(Arc::clone(vertex)),
        }
    }

    /// A piece that has the anchor as a corner.
    fn piece(&self, cutting: &Cutting) -> Option<usize> {
        piece_with(cutting, |corner| self.is_at(corner))
    }

    fn is_at(&self, corner: &Arc<Vertex>) -> bool {
        match &self.place {
            Spot::Lattice(p) => corner.as_lattice() == Some(p),
            Spot::Exact(vertex) => Arc::ptr_eq(vertex, corner),
        }
    }
}

/// Whether a point certainly lies in a cell.
fn is_well_inside(vertex: &Vertex, cell: &Cell) -> bool {
    let (p, low, high) = (vertex.approx(), cell.low(), cell.high());
    (0..3).all(|i| {
        let slack = p[i].abs() * 4.0 * f64::EPSILON;
        p[i] - slack >= low[i] as f64 && p[i] + slack <= high[i] as f64
    })
}

fn piece_with(cutting: &Cutting, is_it: impl Fn(&Arc<Vertex>) -> bool) -> Option<usize> {
    let has = |piece: &Polygon| piece.corners().iter().any(|c| is_it(&c.at));
    cutting.pieces.iter().position(has)
}

/// Anchors with what is known of the other operands there. Those of an element that nothing
/// crosses have the same labels.
struct Known {
    numbers: HashMap<(usize, Name), u32>,
    parents: Vec<u32>,
    labels: Vec<Option<Labels>>,
    /// The cut elements at the anchors that stand for others: the anchor, the element, and the
    /// anchor's place among the element's.
    cuts: Vec<(u32, u32, u8)>,
}

impl Known {
    fn new(scene: &Scene, fates: &[Fate]) -> Self {
        let mut known = Self {
            numbers: HashMap::default(),
            parents: Vec::new(),
            labels: Vec::new(),
            cuts: Vec::new(),
        };
        for (element, fate) in scene.elements.iter().zip(fates) {
            if let Fate::Uncut(anchors) = fate {
                let first = known.root(element.operand, &anchors[0]);
                anchors[1..].iter().fold(first, |a, other| {
                    let b = known.root(element.operand, other);
                    known.parents[b.max(a) as usize] = a.min(b);
                    a.min(b)
                });
            }
        }
        for (i, (element, fate)) in scene.elements.iter().zip(fates).enumerate() {
            if let Fate::Cut(_, _, anchors) = fate {
                for (place, anchor) in anchors.iter().enumerate() {
                    let root = known.root(element.operand, anchor);
                    known.cuts.push((root, i as u32, place as u8));
                }
            }
        }
        known.cuts.sort_unstable();
        known
    }

    /// The cut elements at an anchor, with the piece there and its labels.
    fn cut_at(
        &self,
        root: usize,
        fates: &[Fate],
        label: Labels,
    ) -> Option<Vec<(usize, usize, Labels)>> {
        let start = self.cuts.partition_point(|c| (c.0 as usize) < root);
        let here = self.cuts[start..]
            .iter()
            .take_while(|c| c.0 as usize == root);
        here.map(|(_, i, place)| {
            let Fate::Cut(cutting, _, anchors) = &fates[*i as usize] else {
                return None;
            };
            let piece = anchors[usize::from(*place)].piece(cutting)?;
            Some((*i as usize, piece, label))
        })
        .collect()
    }

    fn root(&mut self, operand: usize, anchor: &Anchor) -> u32 {
        let next = self.parents.len() as u32;
        let mut at = *self.numbers.entry((operand, anchor.name)).or_insert(next);
        if at == next {
            self.parents.push(next);
            self.labels.push(None);
        }
        while self.parents[at as usize] != at {
            let above = self.parents[self.parents[at as usize] as usize];
            self.parents[at as usize] = above;
            at = above;
        }
        at
    }

    /// The labels of all operands but one at an anchor of that one.
    fn label(&mut self, scene: &Scene, operand: usize, anchor: &Anchor) -> Option<Labels> {
        let root = self.root(operand, anchor) as usize;
        if self.labels[root].is_none() {
            self.labels[root] = Some(match &anchor.place {
                Spot::Lattice(point) => scene.count_at_lattice(operand, point)?,
                Spot::Exact(point) => scene.count(operand, point)?,
            });
        }
        self.labels[root]
    }
}

/// The labels of all pieces from those of one; `None` if the ties contradict each other, or a
/// number is neither 0 nor 1.
fn spread(cutting: &Cutting, first: usize, start: Labels) -> Option<Vec<Labels>> {
    let mut labels: Vec<Option<Labels>> = vec![None; cutting.pieces.len()];
    labels[first] = Some(start);
    let mut changed = true;
    while changed {
        changed = false;
        for tie in &cutting.ties {
            let (minus, plus) = (tie.minus as usize, tie.plus as usize);
            let bit: Labels = 1 << tie.operand;
            let higher = |w: Labels| (w & bit == 0).then_some(w | bit);
            let lower = |w: Labels| (w & bit != 0).then_some(w & !bit);
            match (labels[minus], labels[plus], tie.change > 0) {
                (Some(w), None, up) => labels[plus] = Some(if up { higher(w) } else { lower(w) }?),
                (None, Some(w), up) => labels[minus] = Some(if up { lower(w) } else { higher(w) }?),
                (Some(v), Some(w), up) => {
                    if (if up { higher(v) } else { lower(v) }) != Some(w) {
                        return None;
                    }
                    continue;
                }
                (None, None, _) => continue,
            }
            changed = true;
        }
    }
    labels.into_iter().collect()
}

fn bits(values: impl Iterator<Item = bool>) -> Labels {
    values
        .enumerate()
        .fold(0, |all, (i, v)| all | Labels::from(v) << i)
}
