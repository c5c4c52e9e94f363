//! Compares the leaf kernel, which labels pieces of boundary, with the merging of whole trees.
//!
//! Both must make the same set: `merge::kernels::trees` pushes each operand's fragments through the other
//! operands' local trees; `merge::merge` splits one tree by the other's cuts and reads the boundary off the
//! result. They share predicates and polygons, and nothing else.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use bspcsg::geometry::cell::{Cell, Cut};
use bspcsg::geometry::plane::{Lattice, Plane};
use bspcsg::geometry::polygon::Polygon;
use bspcsg::geometry::side::{Half, Orientation};
use bspcsg::geometry::spaces::dim3::Dim3;
use bspcsg::geometry::vertex::Vertex;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::kernels::general::GeneralPosition;
use bspcsg::merge::kernels::problem::{CellProblem, Kernel, ListedOperand};
use bspcsg::merge::kernels::trees::{LeafTree, LocalTrees};
use bspcsg::merge::lists::list::{List, Sources};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::{merge, SetOp};
use bspcsg::mesh::handle::{FaceId, Slot};
use bspcsg::mesh::source::Source;
use bspcsg::query::classify::Location;
use bspcsg::tree::node::{Branch, Node};
use bspcsg::tree::partition::{self, autopartition, winding_tree, Facet, Label, PivotPolicy};
use bspcsg::tree::solid::Solid;

use super::support::{applied, located, normalized, sixfold_volume, volume, Numbers, Ratio, Shape};

type Tree = partition::PartitionTree<Dim3>;

/// All coordinates of shapes here are in `0..REACH`; one cell contains them all.
const REACH: i64 = 16;

fn everything() -> Cell {
    Cell::around(&[0; 3], &[REACH - 1; 3])
}

/// A random tetrahedron or box, or a union of shapes that may overlap or be inverted in part.
fn any_shape(numbers: &mut Numbers, reach: i64) -> Shape {
    let one = |numbers: &mut Numbers| match numbers.below(2) {
        0 => Shape::any_tetrahedron(numbers, reach),
        _ => Shape::any_cuboid(numbers, reach),
    };
    let first = one(numbers);
    match numbers.below(4) {
        0 | 1 => first,
        2 => first.with(one(numbers)).with(one(numbers)),
        _ => first.with(one(numbers)).with(one(numbers).inverted()),
    }
}

fn reference(cell: &Cell) -> impl Fn(&Arc<Plane>) -> Half {
    let corner = cell.corner();
    move |cut| cut.side_of_corner(&corner)
}

/// The tree of a source inside a cell, with facets numbered from `first`; `number` is the winding number at
/// the cell's low corner.
fn tree_in(source: &Source, cell: &Cell, number: i32, first: u64, seed: u64) -> Tree {
    let facets = source.face_ids().filter_map(|face| {
        let fragment = source.clip(face, cell)?;
        let source = first + u64::from(face.0);
        Some(Facet { fragment, source })
    });
    let policy = PivotPolicy::Random(seed);
    let built = autopartition(facets.collect(), *cell, Label::Out, policy).expect("built");
    let labelled = winding_tree(&built.tree, reference(cell), number, |w| w > 0);
    labelled.expect("a closed surface").tree
}

/// A sum over pieces of boundary: for each face and orientation, the exact volume of the cones over its
/// pieces.
///
/// Cones are additive over pieces; the volume is zero only for planes through the origin.
type Flux = HashMap<(u64, bool), Ratio>;

fn add_flux(flux: &mut Flux, key: (u64, bool), polygon: &Polygon) {
    let corners: Vec<_> = polygon
        .corners()
        .iter()
        .map(|c| c.at.coordinates())
        .collect();
    let sum = flux.entry(key).or_insert_with(|| Ratio::whole(0));
    for pair in corners[1..].windows(2) {
        *sum = sum.plus(&sixfold_volume([&corners[0], &pair[0], &pair[1]]));
    }
}

fn without_zeros(mut flux: Flux) -> Flux {
    flux.retain(|_, sum| *sum != Ratio::whole(0));
    flux
}

/// The flux of a set, computed from the owners of its boundary.
fn flux_of_tree(tree: &Tree, plane_of: impl Fn(u64) -> Arc<Plane>) -> Flux {
    let mut flux = Flux::new();
    for facet in partition::owned_boundary(tree).expect("a boundary") {
        let turned = *plane_of(facet.source) != **facet.fragment.support();
        add_flux(&mut flux, (facet.source, turned), &facet.fragment);
    }
    without_zeros(flux)
}

/// The flux of a deferred leaf; `first` gives the number of each source's first face.
fn flux_of_node(node: &Node, cell: &Cell, first: impl Fn(&Source) -> u64) -> Flux {
    let mut flux = Flux::new();
    let Node::Deferred(leaf) = node else {
        return flux;
    };
    let mut add = |source: &Source, face: FaceId, turned: Orientation, polygon: &Polygon| {
        let key = (first(source) + u64::from(face.0), turned.is_opposite());
        if turned.is_opposite() {
            add_flux(&mut flux, key, &polygon.flipped());
        } else {
            add_flux(&mut flux, key, polygon);
        }
    };
    for group in &leaf.groups {
        for face in &group.faces {
            let whole = group.source.clip(*face, cell).expect("a face in its cell");
            add(&group.source, *face, group.orientation, &whole);
        }
    }
    for element in &leaf.parts {
        let part = &element.part;
        for piece in &part.pieces() {
            add(&part.source, part.face, element.orientation, piece);
        }
    }
    without_zeros(flux)
}

/// The list of a solid in a cell below its root, found by repeated halving.
fn list_in(solid: &Solid, cell: &Cell, sources: &Sources) -> Option<List> {
    let root = solid.root();
    let Node::Deferred(leaf) = &*root.node else {
        return None;
    };
    let mut at = root.cell;
    let mut list = List::open(leaf, root, sources);
    while at.contains(cell) && at != *cell {
        let cut = at.cut()?;
        let half = half_of(cut, cell.low());
        let (minus, plus) = list.divide(&at, cut, sources);
        list = match half {
            Half::Minus => minus,
            Half::Plus => plus,
        };
        at = at.half(cut, half);
    }
    (at == *cell).then_some(list)
}

/// The half of a cell that contains a point of the cell.
fn half_of(cut: Cut, point: &Lattice) -> Half {
    if point[cut.axis] < cut.at {
        Half::Minus
    } else {
        Half::Plus
    }
}

/// A random cell that a few halvings of `everything` lead to.
fn any_cell(numbers: &mut Numbers) -> Cell {
    let point = numbers.point(REACH);
    let mut cell = everything();
    for _ in 0..numbers.below(9) {
        let Some(cut) = cell.cut() else { break };
        cell = cell.half(cut, half_of(cut, &point));
    }
    cell
}

fn lattice_points(cell: &Cell) -> Vec<Lattice> {
    let (low, high) = (*cell.low(), cell.high());
    let along = |i: usize| low[i]..=high[i];
    let plane = move |x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z]));
    along(0).flat_map(plane).collect()
}

fn location_in(tree: &Tree, point: &Lattice) -> Location {
    match partition::classify(tree, &Vertex::lattice(*point)) {
        partition::Location::In => Location::Inside,
        partition::Location::On => Location::Boundary,
        partition::Location::Out => Location::Outside,
    }
}

fn assert_same_points(tree: &Tree, solid: &Solid, points: &[Lattice], context: &str) {
    for (point, found) in points.iter().zip(located(solid, points)) {
        assert_eq!(location_in(tree, point), found, "{context} at {point:?}");
    }
}

fn expression(op: SetOp) -> Expression {
    let mut terms = vec![Term::Operand(0), Term::Operand(1)];
    terms.extend(match op {
        SetOp::Union => vec![Term::Or(vec![0, 1])],
        SetOp::Intersection => vec![Term::And(vec![0, 1])],
        SetOp::Difference => vec![Term::Not(1), Term::And(vec![0, 2])],
        SetOp::SymmetricDifference => vec![Term::Xor(vec![0, 1])],
    });
    Expression::new(terms).expect("well formed")
}

/// Two operands in one small cell, as lists for the kernel and as local trees for merging.
struct Pair {
    cell: Cell,
    shapes: [Shape; 2],
    sources: Sources,
    lists: [List; 2],
    trees: [Tree; 2],
}

impl Pair {
    fn new(shapes: [Shape; 2], cell: Cell, seed: u64) -> Option<Self> {
        let solids = shapes.each_ref().map(Shape::unchecked);
        let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
        let [a, b] = solids.each_ref().map(|s| list_in(s, &cell, &sources));
        let lists = [a?, b?];
        let count = sources.get(Slot(0)).face_count() as u64;
        let tree = |i: usize| {
            let first = if i == 0 { 0 } else { count };
            tree_in(
                sources.get(Slot::of(i)),
                &cell,
                lists[i].corner,
                first,
                seed,
            )
        };
        let trees = [tree(0), tree(1)];
        Some(Self {
            cell,
            shapes,
            sources,
            lists,
            trees,
        })
    }

    fn first_of(&self, source: &Source) -> u64 {
        let slot = self.sources.slot(source);
        Slot::all()
            .take_while(|before| *before < slot)
            .map(|before| self.sources.get(before).face_count() as u64)
            .sum()
    }

    fn plane_of(&self, number: u64) -> Arc<Plane> {
        let count = self.sources.get(Slot(0)).face_count() as u64;
        let (slot, face) = if number < count {
            (Slot(0), number)
        } else {
            (Slot(1), number - count)
        };
        self.sources
            .get(slot)
            .plane(FaceId(u32::try_from(face).expect("small")))
    }

    fn compare(&self, op: SetOp) -> bool {
        let listed = |(number, list)| {
            let list = Cow::Borrowed(list);
            ListedOperand { number, list }
        };
        let problem = CellProblem {
            cell: &self.cell,
            expression: &expression(op),
            rule: Rule::Positive,
            operands: (0..).zip(&self.lists).map(listed).collect(),
            sources: &self.sources,
        };
        let seen = &mut Vec::new();
        let answer = LocalTrees.solve(&problem, seen);
        self.check(op, "trees", answer.expect("trees take every cell"));
        // Faces that the kernel of general position uses are used by the kernel of trees, too.
        let also = &mut Vec::new();
        let answer = GeneralPosition.solve(&problem, also).ok();
        assert!(also.iter().all(|k| seen.contains(k)), "{:?}", self.shapes);
        match answer.filter(|_| self.is_simple()) {
            Some(answer) => {
                self.check(op, "general position", answer);
                true
            }
            None => false,
        }
    }

    /// Returns true if no operand overlaps itself in this cell: only then the shortcut promises the reduced
    /// boundary.
    fn is_simple(&self) -> bool {
        let simple = |l: &List| LeafTree::new(l, &self.cell, &self.sources).is_simple();
        self.lists.iter().all(simple)
    }

    fn check(&self, op: SetOp, kernel: &str, node: Node) {
        let context = || format!("{op:?} by {kernel} in {:?} of {:?}", self.cell, self.shapes);
        let merged = merge(&self.trees[0], &self.trees[1], op).expect("merged");
        let expected = flux_of_tree(&merged, |number| self.plane_of(number));
        let found = flux_of_node(&node, &self.cell, |source| self.first_of(source));
        assert_eq!(
            by_plane(&expected, self),
            by_plane(&found, self),
            "{}",
            context()
        );
        if self.shapes.iter().all(|s| s.faces.len() <= 12) {
            assert_eq!(expected, found, "owners: {}", context());
        }
        assert_same_points(
            &merged,
            &self.solid(node),
            &lattice_points(&self.cell),
            &context(),
        );
    }

    fn solid(&self, node: Node) -> Solid {
        let root = Branch {
            cell: self.cell,
            outside: 0,
            complement: false,
            node: Arc::new(node),
        };
        let sources = self.sources.table().clone();
        Solid::new(root, self.sources.get(Slot(0)).pitch(), sources, true)
    }
}

/// The flux by oriented planes, for operands whose own faces overlap, so that owners are not unique.
fn by_plane(flux: &Flux, pair: &Pair) -> HashMap<Plane, Ratio> {
    let mut sums: HashMap<Plane, Ratio> = HashMap::new();
    for ((number, turned), value) in flux {
        let plane = pair.plane_of(*number);
        let plane = if *turned {
            plane.flipped()
        } else {
            (*plane).clone()
        };
        let sum = sums.entry(plane).or_insert_with(|| Ratio::whole(0));
        *sum = sum.plus(value);
    }
    sums.retain(|_, sum| *sum != Ratio::whole(0));
    sums
}

#[test]
fn the_kernel_agrees_with_merged_trees_in_small_cells() {
    let mut numbers = Numbers::new(1);
    let (mut compared, mut general) = (0, 0);
    for round in 0..400 {
        let shapes = [0; 2].map(|_| any_shape(&mut numbers, REACH));
        let cell = any_cell(&mut numbers);
        if let Some(pair) = Pair::new(shapes, cell, round) {
            for op in SetOp::ALL {
                general += usize::from(pair.compare(op));
            }
            compared += 1;
        }
    }
    assert!(compared > 100, "only {compared} pairs met");
    assert!(general > 100, "only {general} times in general position");
}

/// The tree of a solid that consists of one source, inside the cell of all shapes.
fn whole_tree(solid: &Solid, seed: u64) -> Tree {
    tree_in(solid.sources().get(Slot(0)), &everything(), 0, 0, seed)
}

fn assert_same_solid(tree: &Tree, solid: &Solid, context: &str) {
    let mut sum = Ratio::whole(0);
    for wall in partition::boundary(tree).expect("a boundary") {
        let mut flux = Flux::new();
        add_flux(&mut flux, (0, false), &wall);
        sum = sum.plus(&flux[&(0, false)]);
    }
    assert_eq!(volume(solid).times(6), sum, "{context}");
    assert_same_points(tree, solid, &lattice_points(&everything()), context);
}

#[test]
fn whole_solids_agree_with_merged_trees() {
    let mut numbers = Numbers::new(2);
    for round in 0..40 {
        let shapes = [0; 2].map(|_| any_shape(&mut numbers, 8));
        let raw = shapes.each_ref().map(Shape::unchecked);
        let [a, b] = raw.each_ref().map(|s| normalized(s, Rule::Positive));
        let trees = raw.each_ref().map(|s| whole_tree(s, round));
        for op in SetOp::ALL {
            let context = format!("{op:?} of {shapes:?}");
            let merged = merge(&trees[0], &trees[1], op).expect("merged");
            assert_same_solid(&merged, &applied(op, &a, &b), &context);
            let late = normalized(&applied(op, &raw[0], &raw[1]), Rule::Positive);
            assert_same_solid(&merged, &late, &format!("normalized {context}"));
        }
    }
}

/// Chains of operations: results are operands, and trees grow by merging.
#[test]
fn chains_agree_with_merged_trees() {
    let mut numbers = Numbers::new(3);
    for round in 0..6 {
        let first = any_shape(&mut numbers, 8).unchecked();
        let mut tree = whole_tree(&first, round);
        let mut solid = normalized(&first, Rule::Positive);
        for _ in 0..8 {
            let op = numbers.pick(&SetOp::ALL);
            let next = Shape::any_tetrahedron(&mut numbers, 8).solid();
            tree = merge(&tree, &whole_tree(&next, round), op).expect("merged");
            solid = applied(op, &solid, &next);
            assert_same_solid(&tree, &solid, &format!("{op:?} in round {round}"));
        }
    }
}
