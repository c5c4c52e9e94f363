//! Converts numpy arrays and names to the core's types, and back.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::error::{Error, ErrorKind, Result};
use crate::mesh::facets::Lenience;
use crate::python::arrays::array;
use crate::python::hyperplanes::Row;
use crate::tree::fragments::{NodeCut, Policy, Sample};

/// The method of building a tree, before the dimension is known: by a policy, by lines through corners, or by
/// given cuts.
#[derive(Clone, Debug)]
pub enum BuildMethod {
    Policy(Policy, Option<usize>, i64),
    Lines(Sample),
    Given(Vec<NodeCut>),
}

/// The method of building a tree, and hyperplanes given by the caller that are used as cuts first.
#[derive(Clone, Debug)]
pub struct BuildOptions {
    pub method: BuildMethod,
    pub own: Vec<Row>,
}

pub fn lenience_of((triangulate_nonplanar, drop_flat): (bool, bool)) -> Lenience {
    Lenience {
        triangulate_nonplanar,
        drop_flat,
    }
}

pub fn named_policy(name: &str, seed: u64, sample: Sample, alpha: f64) -> Result<Policy> {
    Ok(match name {
        "first" => Policy::First,
        "random" => Policy::Random(seed),
        "least-splits" => Policy::LeastSplits(sample),
        "balanced" => Policy::Balanced(sample),
        "weighted" => Policy::Weighted(sample, alpha),
        "least-cost" => Policy::LeastCost(sample),
        _ => {
            let text = format!(
                "'{name}' is not a policy; use first, random, least-splits, balanced, weighted or \
                 least-cost"
            );
            return Err(Error::new(ErrorKind::Shape, text));
        }
    })
}

/// Returns the rows of an array with up to three columns, filled up to three with `fill`.
pub fn padded<T: numpy::Element + Copy>(array: &PyReadonlyArray2<'_, T>, fill: T) -> Vec<[T; 3]> {
    let view = array.as_array();
    let row =
        |r: numpy::ndarray::ArrayView1<'_, T>| [0, 1, 2].map(|i| r.get(i).copied().unwrap_or(fill));
    view.rows().into_iter().map(row).collect()
}

pub fn rows<T: numpy::Element + Copy>(
    py: Python<'_>,
    points: Vec<[T; 3]>,
    dimension: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = points.len();
    let flat = points
        .iter()
        .flat_map(|p| p.iter().copied().take(dimension));
    PyArray1::from_vec(py, flat.collect()).reshape([count, dimension])
}

/// Replaces the axis in a row that describes a cut, if the hyperplane of the cut is in the tree's own list.
const OWN_AXIS: i64 = -2;

/// Returns cuts as rows: (-1, piece) for a piece's hyperplane, (axis, coordinate) for an axis-parallel cut,
/// (-2, index) for a hyperplane in the tree's own list.
pub fn cut_rows(
    py: Python<'_>,
    cuts: impl Iterator<Item = NodeCut>,
) -> PyResult<Bound<'_, PyArray2<i64>>> {
    array(py, cuts.map(cut_row).collect())
}

pub fn cut_row(cut: NodeCut) -> [i64; 2] {
    match cut {
        NodeCut::Pivot(piece) => [-1, i64::from(piece)],
        NodeCut::Axis { axis, at } => [axis as i64, at],
        NodeCut::Own(number) => [OWN_AXIS, i64::from(number)],
    }
}

pub fn node_cuts(array: &PyReadonlyArray2<'_, i64>) -> Result<Vec<NodeCut>> {
    let wrong = |_| Error::new(ErrorKind::BadSnapshot, "a stored cut has invalid numbers");
    let cut = |row: [i64; 3]| match row {
        [-1, piece, _] => u32::try_from(piece).map(NodeCut::Pivot).map_err(wrong),
        [OWN_AXIS, number, _] => u32::try_from(number).map(NodeCut::Own).map_err(wrong),
        [axis, at, _] => {
            let axis = usize::try_from(axis).map_err(wrong)?;
            Ok(NodeCut::Axis { axis, at })
        }
    };
    padded(array, 0).into_iter().map(cut).collect()
}
