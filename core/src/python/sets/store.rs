//! Sets as nodes in preorder: as arrays for inspection, and as bytes for storage.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use super::each::Set;
use crate::arith::bounds::{normal, offset, COORDINATE_BITS};
use crate::arith::Int;
use crate::error::{Error, Result};
use crate::geometry::plane::Plane;
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::dim1::{Direction, Point1};
use crate::geometry::spaces::dim2::Line2;
use crate::mesh::grid::Pitch;
use crate::python::calls::errors::to_python;
use crate::store::sealed::{seal, unseal, Kind};
use crate::tree::partition::{from_preorder, preorder, Entry, Label, PartitionTree};

/// The largest number of bits of a component of a stored plane's normal.
const NORMAL: u32 = normal(COORDINATE_BITS);
const OFFSET: u32 = offset(COORDINATE_BITS);

/// The hyperplanes (n, d + 1), minus children (n,) and plus children (n,) of n nodes.
pub type Nodes<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<i64>>,
);

#[derive(Serialize, Deserialize)]
struct Stored {
    pitch: i64,
    dimension: u8,
    nodes: Vec<StoredNode>,
}

#[derive(Serialize, Deserialize)]
enum StoredNode {
    Leaf(bool),
    Cut([i128; 3], [u64; 3]),
}

impl Set {
    /// Encodes the set as bytes, without coplanar sets.
    pub fn to_bytes(&self, pitch: Pitch) -> Result<Vec<u8>> {
        let nodes = match self {
            Self::Line(tree) => stored(tree, |p| {
                StoredNode::Cut([sign(p), 0, 0], limbs(p.at().into()))
            }),
            Self::Plane(set) => stored(set.tree()?, |line| {
                let ([a, b], c) = line.coefficients();
                StoredNode::Cut([a.into(), b.into(), 0], limbs(c))
            }),
            Self::Space(tree) => {
                stored(tree, |p| StoredNode::Cut(*p.normal(), *p.offset().limbs()))
            }
        };
        let stored = Stored {
            pitch: pitch.exponent(),
            dimension: self.dimension() as u8,
            nodes,
        };
        seal(Kind::Set, &stored)
    }

    /// Decodes a set and its pitch from bytes.
    ///
    /// # Errors
    /// `BadSnapshot`.
    pub fn from_bytes(bytes: &[u8]) -> Result<(Self, Pitch)> {
        let stored: Stored = unseal(Kind::Set, bytes)?;
        let set = match stored.dimension {
            1 => Self::Line(restored(&stored.nodes, |n, d| {
                let at = i64::try_from(d.to_i128()?).ok()?;
                let far = at.unsigned_abs() > 1 << 53;
                let inside = if n[0] > 0 {
                    Direction::Below
                } else {
                    Direction::Above
                };
                (!far).then(|| Point1::new(at, inside))
            })?),
            2 => {
                let tree = restored(&stored.nodes, |n, d| {
                    let narrow = |c: i128| i64::try_from(c).ok();
                    Line2::new(narrow(n[0])?, narrow(n[1])?, d.to_i128()?)
                })?;
                Self::Plane(tree.into())
            }
            3 => Self::Space(restored(&stored.nodes, |n, d| {
                let narrow = n.iter().all(|c| c.unsigned_abs() < 1 << NORMAL);
                let near = d.bit_length() <= OFFSET;
                let plane = (narrow && near).then(|| Plane::new(n, d))??;
                Some(std::sync::Arc::new(plane))
            })?),
            _ => return Err(bad_bytes()),
        };
        let pitch = Pitch::new(stored.pitch).map_err(|_| bad_bytes())?;
        Ok((set, pitch))
    }

    /// Returns the inner nodes in preorder: hyperplanes normal·x = offset with normals of length 1, in model
    /// units, and the numbers of the children, −1 for an Out leaf and −2 for an In leaf.
    pub fn nodes<'py>(&self, py: Python<'py>, pitch: Pitch) -> PyResult<Nodes<'py>> {
        let unit = pitch.coordinate(1);
        let (rows, children) = match self {
            Self::Line(tree) => listed(tree, |p| {
                let n = sign(p) as f64;
                vec![n, n * pitch.coordinate(p.at())]
            }),
            Self::Plane(set) => listed(set.tree().map_err(|e| to_python(py, &e))?, |line| {
                let ([a, b], c) = line.coefficients();
                scaled(&[a as f64, b as f64], c as f64, unit)
            }),
            Self::Space(tree) => listed(tree, |plane| {
                let n = plane.normal().map(|c| c as f64);
                scaled(&n, plane.offset().to_f64(), unit)
            }),
        };
        let shape = [children.len(), self.dimension() + 1];
        let rows = PyArray1::from_vec(py, rows).reshape(shape)?;
        let [minus, plus] = [0, 1].map(|i| {
            let column = children.iter().map(|pair: &[i64; 2]| pair[i]).collect();
            PyArray1::from_vec(py, column)
        });
        Ok((rows, minus, plus))
    }
}

fn bad_bytes() -> Error {
    Kind::Set.contradiction()
}

fn sign(point: &Point1) -> i128 {
    match point.inside() {
        Direction::Below => 1,
        Direction::Above => -1,
    }
}

fn limbs(value: i128) -> [u64; 3] {
    *Int::<3>::from_i128(value).limbs()
}

fn stored<S: AxisSpace>(
    tree: &PartitionTree<S>,
    cut: impl Fn(&S::Hyperplane) -> StoredNode,
) -> Vec<StoredNode> {
    let node = |entry: &Entry<S::Hyperplane>| match entry {
        Entry::Leaf(label) => StoredNode::Leaf(*label == Label::In),
        Entry::Cut(h) => cut(h),
    };
    preorder(tree).iter().map(node).collect()
}

fn restored<S: AxisSpace>(
    nodes: &[StoredNode],
    cut: impl Fn([i128; 3], Int<3>) -> Option<S::Hyperplane>,
) -> Result<PartitionTree<S>> {
    let entry = |node: &StoredNode| match node {
        StoredNode::Leaf(inside) => Ok(Entry::Leaf(Label::from_inside(*inside))),
        StoredNode::Cut(n, d) => cut(*n, Int::from_limbs(*d))
            .map(Entry::Cut)
            .ok_or_else(bad_bytes),
    };
    let entries = nodes.iter().map(entry).collect::<Result<Vec<_>>>()?;
    from_preorder(&entries, S::universe()).map_err(|_| bad_bytes())
}

fn scaled(normal: &[f64], constant: f64, unit: f64) -> Vec<f64> {
    let largest = normal.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    let length = normal
        .iter()
        .map(|c| (c / largest).powi(2))
        .sum::<f64>()
        .sqrt()
        * largest;
    let mut row: Vec<f64> = normal.iter().map(|c| c / length).collect();
    row.push(0.0 - constant / length * unit);
    row
}

/// Returns the rows of the inner nodes, one after another, and the numbers of their children.
fn listed<S: AxisSpace>(
    tree: &PartitionTree<S>,
    row: impl Fn(&S::Hyperplane) -> Vec<f64>,
) -> (Vec<f64>, Vec<[i64; 2]>) {
    let (mut rows, mut children) = (Vec::new(), Vec::<[i64; 2]>::new());
    // The children that are still to come: the parent of each, and its side.
    let mut open: Vec<(usize, usize)> = Vec::new();
    for entry in preorder(tree) {
        let number = match &entry {
            Entry::Leaf(Label::Out) => -1,
            Entry::Leaf(Label::In) => -2,
            Entry::Cut(_) => children.len() as i64,
        };
        if let Some((parent, side)) = open.pop() {
            children[parent][side] = number;
        }
        if let Entry::Cut(cut) = entry {
            rows.extend(row(&cut));
            open.extend([(children.len(), 1), (children.len(), 0)]);
            children.push([0; 2]);
        }
    }
    (rows, children)
}
