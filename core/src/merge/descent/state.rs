//! The form in which the descent stores one operand in a cell.

use std::borrow::Cow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::Arc;

use crate::geometry::axes::each_axis;
use crate::geometry::cell::{Cell, Cut};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::merge::lists::bins::Bins;
use crate::merge::lists::list::{FaceRecord, List, PartRecord, Sources};
use crate::mesh::tasks::WorkSize;
use crate::tree::node::{Branch, Node};

/// The least number of elements (faces or parts of faces) of a cell that is worth a task of its own: a kernel
/// takes about 20 µs for half as many, and a task costs less than 1 µs.
const MIN_ELEMENTS_PER_TASK: usize = 64;

/// The least number of elements (faces or parts of faces) of a cell that is worth waking the thread pool,
/// which takes about 50 µs: kernels alone take ten times as long.
const MIN_ELEMENTS_FOR_POOL: usize = 256;

/// Returns how far the work in a cell with this number of elements (faces or parts of faces) is worth sharing
/// among threads.
pub const fn work_size(elements: usize) -> WorkSize {
    match elements {
        ..MIN_ELEMENTS_PER_TASK => WorkSize::Nothing,
        MIN_ELEMENTS_PER_TASK..MIN_ELEMENTS_FOR_POOL => WorkSize::Task,
        MIN_ELEMENTS_FOR_POOL.. => WorkSize::Pool,
    }
}

/// The number of faces from which a deferred leaf is sorted into bins instead of being halved.
pub const BINS_FROM: usize = 1024;

/// The largest number of faces in a cell, as counted by bins, for which a list replaces the bins.
const MAX_ENTRIES_LISTED: usize = 64;

/// The form in which the descent stores one operand in a cell.
#[derive(Clone, Debug)]
pub enum State {
    /// One winding number in the whole cell: no surface.
    Constant(i32),
    /// A subtree of the solid whose cell equals the cell or lies in it.
    Tree(Branch),
    /// A list of the elements (faces and parts of faces) that meet the cell.
    List(List),
    /// Many faces, sorted into small cells.
    Bins(Arc<Bins>),
}

/// The operands that matter in a cell, with ascending indices.
pub type States = Vec<(u32, State)>;

/// Returns the state of the operand with this index; `None` if it does not matter in the cell.
pub fn find(states: &States, operand: u32) -> Option<&State> {
    let at = states.binary_search_by_key(&operand, |s| s.0).ok()?;
    Some(&states[at].1)
}

/// Returns the smallest cell around all operands' boundaries, if it is smaller than `cell`; `None` if it is
/// not, or if an operand's boundary is not known to lie in a smaller cell. Lists are examined, element by
/// element, only if `lists` is true.
pub fn smaller_cell(cell: &Cell, states: &States, lists: bool) -> Option<Cell> {
    let mut inner: Option<Cell> = None;
    for (_, state) in states {
        let home = match state {
            State::Tree(branch) if branch.cell != *cell => branch.cell,
            State::List(list) if lists => {
                let [low, high] = clipped_to_cell(cell, list.bounds());
                Cell::around(&low, &high)
            }
            _ => return None,
        };
        inner = Some(inner.map_or(home, |c| c.join(&home)));
    }
    inner.filter(|c| c != cell)
}

/// Returns the intersection of a box with a cell, as low and high corner.
pub fn clipped_to_cell(cell: &Cell, [low, high]: [Lattice; 2]) -> [Lattice; 2] {
    let (least, most) = (cell.low(), cell.high());
    let low = each_axis(|i| low[i].max(least[i]));
    [low, each_axis(|i| high[i].min(most[i]))]
}

/// Returns true if an operand is constant in the cell.
pub fn has_constant(states: &States) -> bool {
    states.iter().any(|s| matches!(s.1, State::Constant(_)))
}

/// Returns true if an operand may have boundary in the cell: it is not known to be constant.
pub fn has_surface(states: &States) -> bool {
    states.iter().any(|s| s.1.has_surface())
}

impl State {
    /// Returns true if the operand may have boundary in the cell: it is not known to be constant.
    pub fn has_surface(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Tree(branch) => branch.constant().is_none(),
            Self::List(list) => !list.is_empty(),
            Self::Bins(_) => true,
        }
    }

    /// Returns the approximate number of the operand's elements (faces and parts of faces) in the cell.
    pub fn len_in(&self, cell: &Cell) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Tree(branch) => match &*branch.node {
                Node::Deferred(leaf) => leaf.len(),
                Node::Cut(_) => MIN_ELEMENTS_PER_TASK,
                Node::Leaf(_) => 0,
            },
            Self::List(list) => list.len(),
            Self::Bins(bins) => bins.len_in(cell),
        }
    }

    /// Returns a box around the operand's boundary in the cell, as low and high corner.
    pub fn bounds(&self, cell: &Cell) -> [Lattice; 2] {
        match self {
            Self::List(list) => list.bounds(),
            Self::Tree(branch) => bounds_below(branch),
            Self::Bins(_) | Self::Constant(_) => [*cell.low(), cell.high()],
        }
    }

    /// Returns true if the operand's elements (faces or parts of faces) in the cell are listed, and no kernel
    /// made them.
    pub fn is_given(&self) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Tree(branch) => match &*branch.node {
                Node::Deferred(leaf) => !leaf.by_kernel,
                Node::Leaf(_) | Node::Cut(_) => false,
            },
            Self::List(list) => !list.is_by_kernel(),
            Self::Bins(bins) => !bins.is_by_kernel(),
        }
    }

    /// Returns true if all of the operand's boundary in the cell is in one list or one deferred leaf.
    pub fn is_undivided(&self) -> bool {
        match self {
            Self::List(_) => true,
            Self::Tree(branch) => matches!(&*branch.node, Node::Deferred(_)),
            Self::Constant(_) | Self::Bins(_) => false,
        }
    }

    /// Returns the number of elements (faces or parts of faces) of the operand's deferred leaf, if that has
    /// exactly this cell; otherwise 0.
    pub fn len_to_open(&self, cell: &Cell) -> usize {
        match self {
            Self::Tree(branch) if branch.cell == *cell => match &*branch.node {
                Node::Deferred(leaf) => leaf.len(),
                Node::Cut(_) | Node::Leaf(_) => 0,
            },
            Self::Constant(_) | Self::Tree(_) | Self::List(_) | Self::Bins(_) => 0,
        }
    }

    /// Returns the number of listed elements (faces or parts of faces), each of which a halving of the cell
    /// visits.
    pub fn listed_len(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Constant(_) | Self::Tree(_) | Self::Bins(_) => 0,
        }
    }

    /// Returns true if all of the operand's elements (faces or parts of faces) are listed, and their planes
    /// are perpendicular to axes.
    pub fn is_orthogonal(&self, sources: &Sources) -> bool {
        match self {
            Self::List(list) => {
                let flat = |r: &FaceRecord| sources.get(r.slot()).is_orthogonal(r.face);
                let part =
                    |p: &PartRecord| p.element.part.source.is_orthogonal(p.element.part.face);
                list.records.iter().all(flat) && list.parts.iter().all(part)
            }
            Self::Tree(branch) => match &*branch.node {
                Node::Deferred(leaf) => leaf.is_orthogonal(),
                Node::Leaf(_) | Node::Cut(_) => false,
            },
            Self::Constant(_) | Self::Bins(_) => false,
        }
    }

    /// Returns the operand's elements (faces or parts of faces) as a list of the cell; `None` if they cannot
    /// be listed, or if one extends out of the smaller cell in which it is known to be surface.
    pub fn list_in(&self, cell: &Cell, sources: &Sources) -> Option<Cow<'_, List>> {
        match self {
            Self::List(list) => Some(Cow::Borrowed(list)),
            Self::Tree(branch) => List::of_larger_cell(branch, cell, sources).map(Cow::Owned),
            Self::Bins(bins) => {
                List::of_larger_cell(&bins.branch_in(cell), cell, sources).map(Cow::Owned)
            }
            Self::Constant(_) => None,
        }
    }

    /// Makes the operand a constant if it has no boundary in the cell.
    pub fn settle(&mut self, cell: &Cell) {
        let constant = match self {
            Self::Constant(_) => None,
            Self::Tree(branch) => match (branch.constant(), &*branch.node) {
                (Some(w), _) => Some(w),
                (None, Node::Leaf(w)) if branch.cell == *cell => Some(branch.oriented(*w)),
                (None, _) => None,
            },
            Self::List(list) => list.is_empty().then_some(list.corner),
            Self::Bins(bins) => (bins.len_in(cell) == 0).then(|| bins.corner_of(cell)),
        };
        if let Some(w) = constant {
            *self = Self::Constant(w);
        }
    }

    /// Opens a deferred leaf of exactly this cell as a list or as bins, and replaces bins by a list if few
    /// faces are left; adds the number of faces sorted to `binned`.
    pub fn opened(self, cell: &Cell, sources: &Sources, binned: &AtomicU64) -> Self {
        match self {
            Self::Tree(branch) if branch.cell == *cell => opened_leaf(branch, sources, binned),
            Self::Bins(bins) if !bins.divide(cell) || bins.len_in(cell) <= MAX_ENTRIES_LISTED => {
                opened_leaf(bins.branch_in(cell), sources, binned)
            }
            other => other,
        }
    }

    /// Returns the states of the operand in the minus and the plus half of the cell.
    pub fn divided(self, cell: &Cell, cut: Cut, sources: &Sources) -> (Self, Self) {
        match self {
            Self::Constant(w) => (Self::Constant(w), Self::Constant(w)),
            Self::List(list) => {
                let (minus, plus) = list.divide(cell, cut, sources);
                (Self::List(minus), Self::List(plus))
            }
            Self::Tree(branch) => divide_tree(branch, cell, cut),
            Self::Bins(bins) => (Self::Bins(Arc::clone(&bins)), Self::Bins(bins)),
        }
    }

    /// Restricts the state to a smaller cell; none of the operand's boundary may meet the rest of the larger
    /// cell.
    pub fn shrink(&mut self, inner: &Cell, sources: &Sources) {
        if let Self::List(list) = self {
            list.shrink(inner, sources);
        }
    }

    /// Returns the operand itself as the result in the cell, complemented if `negate` is true.
    pub fn shared(self, cell: Cell, negate: bool, sources: &Sources) -> Branch {
        match self {
            Self::Constant(w) => Branch::uniform(cell, if negate { 1 - w } else { w }),
            Self::Tree(branch) if negate => branch.complemented(),
            Self::Tree(branch) => branch,
            Self::Bins(bins) => Self::Tree(bins.branch_in(&cell)).shared(cell, negate, sources),
            Self::List(list) => Branch::of_node(cell, list.close(negate, sources)),
        }
    }
}

/// Returns a box around the boundary of a branch: around its faces if they are few, otherwise its cell.
fn bounds_below(branch: &Branch) -> [Lattice; 2] {
    let whole = [*branch.cell.low(), branch.cell.high()];
    let Node::Deferred(leaf) = &*branch.node else {
        return whole;
    };
    match leaf.groups.as_slice() {
        [group] if leaf.len() <= MAX_ENTRIES_LISTED && leaf.parts.is_empty() => {
            let around = group.source.box_around(&group.faces);
            around.map_or(whole, <[Lattice; 2]>::from)
        }
        _ => whole,
    }
}

/// Opens a branch: a deferred leaf becomes bins or a list, and other nodes stay a tree.
fn opened_leaf(branch: Branch, sources: &Sources, binned: &AtomicU64) -> State {
    let Node::Deferred(leaf) = &*branch.node else {
        return State::Tree(branch);
    };
    let bins = if leaf.len() >= BINS_FROM {
        Bins::new(&branch)
    } else {
        None
    };
    if let Some(bins) = bins {
        binned.fetch_add(leaf.len() as u64, Ordering::Relaxed);
        return State::Bins(Arc::new(bins));
    }
    State::List(List::open(leaf, &branch, sources))
}

fn divide_tree(branch: Branch, cell: &Cell, cut: Cut) -> (State, State) {
    if branch.cell == *cell
        && let Node::Cut(halves) = &*branch.node
    {
        let [minus, plus] = &halves.children;
        return (
            State::Tree(branch.child(minus)),
            State::Tree(branch.child(plus)),
        );
    }
    let around = State::Constant(branch.outside);
    if cell.half(cut, Half::Minus).contains(&branch.cell) {
        (State::Tree(branch), around)
    } else {
        (around, State::Tree(branch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{crossing, cuboid};

    #[test]
    fn a_tree_in_one_half_leaves_the_other_uniform() {
        let solid = cuboid([1; 3], [3; 3]);
        let sources = Sources::new(solid.sources().clone());
        let cell = Cell::around(&[0; 3], &[15; 3]);
        let cut = cell.cut().expect("more than one point");
        let state = State::Tree(solid.root().clone());
        let (minus, plus) = state.divided(&cell, cut, &sources);
        assert!(matches!(minus, State::Tree(_)));
        assert!(matches!(plus, State::Constant(0)));
    }

    #[test]
    fn constants_and_empty_lists_have_no_surface() {
        let scene = crossing();
        let mut list = scene.lists[0].clone();
        let states = |list| vec![(0, State::Constant(1)), (1, State::List(list))];
        assert!(has_surface(&states(list.clone())));
        list.records.clear();
        assert!(!has_surface(&states(list)));
    }

    #[test]
    fn a_list_without_elements_settles_to_its_corner() {
        let scene = crossing();
        let mut list = scene.lists[0].clone();
        list.records.clear();
        list.corner = 1;
        let mut state = State::List(list);
        state.settle(&scene.cell);
        assert!(matches!(state, State::Constant(1)));
    }

    #[test]
    fn the_descent_starts_around_the_boundaries() {
        let solids = [cuboid([1; 3], [3; 3]), cuboid([9; 3], [11; 3])];
        let tree = |s: &crate::tree::solid::Solid| State::Tree(s.root().clone());
        let states: States = (0..).zip(solids.iter().map(tree)).collect();
        assert!(find(&states, 1).is_some() && find(&states, 2).is_none());
        let inner = smaller_cell(&Cell::UNIVERSE, &states, false);
        assert_eq!(inner, Some(Cell::around(&[0; 3], &[15; 3])));
    }
}
