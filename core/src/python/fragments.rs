//! The class `FragmentTree`: a partition tree over points, segments or polygons.

use std::sync::atomic::AtomicBool;

use num_bigint::BigInt;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use super::errors::to_python;
use super::run::run;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::affine::{Affine, Polytope, Viewpoint};
use crate::geometry::dim1::Dim1;
use crate::geometry::dim2::Dim2;
use crate::geometry::dim3::Dim3;
use crate::geometry::plane::Lattice;
use crate::geometry::side::{Half, Side};
use crate::mesh::facets::{check_reach, facets, snap_corners, suited_pitch, Facet, Lenience};
use crate::mesh::grid::Pitch;
use crate::tree::fragments::{
    back_to_front, build, measures, perfect, sides, FragmentTree, NodeCut, Piece, Plan, Policy,
    Sample,
};

type Ints<'py> = Bound<'py, PyArray1<i64>>;
type Floats<'py> = Bound<'py, PyArray1<f64>>;
type Rows<'py> = Bound<'py, PyArray2<f64>>;
type Bools<'py> = Bound<'py, PyArray1<bool>>;
type FragmentArrays<'py> = (
    Rows<'py>,
    Ints<'py>,
    Ints<'py>,
    Ints<'py>,
    Bools<'py>,
    Bools<'py>,
);

struct Held<S: Affine> {
    facets: Vec<Facet>,
    tree: FragmentTree<S>,
    pitch: Pitch,
}

enum Inner {
    Line(Held<Dim1>),
    Plane(Held<Dim2>),
    Space(Held<Dim3>),
}

/// Runs the same code on the tree of whichever dimension it is.
macro_rules! each {
    ($inner:expr, $held:ident => $body:expr) => {
        match $inner {
            Inner::Line($held) => $body,
            Inner::Plane($held) => $body,
            Inner::Space($held) => $body,
        }
    };
}

/// A partition tree over facets. See `_core.pyi`.
#[pyclass(frozen, name = "FragmentTree", module = "bspcsg._core")]
pub struct PyFragmentTree {
    inner: Inner,
    corners: Vec<Lattice>,
    offsets: Vec<i64>,
}

/// What a caller says about how to build, before the dimension is known.
#[derive(Clone, Debug)]
enum Wish {
    Policy(Policy, Option<usize>, i64),
    Given(Vec<NodeCut>),
}

#[pymethods]
impl PyFragmentTree {
    #[classmethod]
    #[pyo3(signature = (corners, offsets, policy, seed=0, sample=8, alpha=0.5, top=0, pitch=None, lenience=(false, false)))]
    #[allow(clippy::too_many_arguments)]
    fn build(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        corners: PyReadonlyArray2<'_, f64>,
        offsets: PyReadonlyArray1<'_, i64>,
        policy: &str,
        seed: u64,
        sample: usize,
        alpha: f64,
        top: usize,
        pitch: Option<i64>,
        lenience: (bool, bool),
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let policy = named_policy(policy, seed, Sample(sample), alpha).map_err(fail)?;
        let pitch = pitch.map(Pitch::new).transpose().map_err(fail)?;
        let dimension = corners.as_array().ncols();
        let rows: Vec<[f64; 3]> = padded(&corners, 0.0);
        let offsets = offsets.as_array().to_vec();
        let wish = Wish::Policy(policy, (top > 0).then_some(top), 1);
        let (inner, corners) = run(py, 0, rows.len(), |cancel| {
            let pitch = match pitch {
                Some(pitch) => pitch,
                None => suited_pitch(dimension, &rows)?,
            };
            let lattice = snap_corners(dimension, &rows, pitch)?;
            let facets = facets(dimension, &lattice, &offsets, lenience_of(lenience))?;
            let inner = built(dimension, facets, pitch, wish, cancel)?;
            Ok((inner, lattice))
        })?;
        Ok(Self {
            inner,
            corners,
            offsets,
        })
    }

    #[classmethod]
    #[allow(clippy::too_many_arguments)]
    fn rebuild(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        corners: PyReadonlyArray2<'_, i64>,
        offsets: PyReadonlyArray1<'_, i64>,
        pitch: i64,
        cuts: PyReadonlyArray2<'_, i64>,
        lenience: (bool, bool),
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let pitch = Pitch::new(pitch).map_err(fail)?;
        let dimension = corners.as_array().ncols();
        let rows: Vec<Lattice> = padded(&corners, 0);
        let offsets = offsets.as_array().to_vec();
        let cuts = node_cuts(&cuts).map_err(fail)?;
        let inner = run(py, 0, rows.len(), |cancel| {
            check_reach(dimension, &rows)?;
            let facets = facets(dimension, &rows, &offsets, lenience_of(lenience))?;
            built(dimension, facets, pitch, Wish::Given(cuts), cancel)
        })?;
        Ok(Self {
            inner,
            corners: rows,
            offsets,
        })
    }

    /// The cuts of a tree over the same facets that cuts none of them.
    fn perfect_cuts<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<i64>>>> {
        let found = run(py, 0, 0, |_| each!(&self.inner, held => held.perfect()))?;
        found.map(|cuts| cut_rows(py, cuts.into_iter())).transpose()
    }

    #[getter]
    fn dimension(&self) -> usize {
        match self.inner {
            Inner::Line(_) => 1,
            Inner::Plane(_) => 2,
            Inner::Space(_) => 3,
        }
    }

    #[getter]
    fn pitch(&self) -> i64 {
        each!(&self.inner, held => held.pitch.exponent())
    }

    fn __len__(&self) -> usize {
        each!(&self.inner, held => held.tree.nodes().len())
    }

    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let (normals, offsets) = each!(&self.inner, held => held.hyperplanes());
        dict.set_item("normal", rows(py, normals, self.dimension())?)?;
        dict.set_item("offset", PyArray1::from_vec(py, offsets))?;
        let links = each!(&self.inner, held => held.links());
        for (name, list) in ["minus", "plus", "parent", "depth", "start", "end"]
            .iter()
            .zip(links)
        {
            dict.set_item(name, PyArray1::from_vec(py, list))?;
        }
        let cuts = each!(&self.inner, held => held.cuts());
        dict.set_item("cut", cut_rows(py, cuts.into_iter())?)?;
        Ok(dict)
    }

    /// The exact coefficients n, d of a node's hyperplane n·x + d = 0, in lattice steps.
    fn coefficients(&self, node: usize) -> Option<Vec<BigInt>> {
        fn of<S: Affine>(held: &Held<S>, node: usize) -> Option<Vec<BigInt>> {
            let [a, b, c, d] = S::exact(&held.tree.nodes().get(node)?.hyperplane);
            let mut all: Vec<BigInt> = [a, b, c].into_iter().take(S::DIM).collect();
            all.push(d);
            Some(all)
        }
        each!(&self.inner, held => of(held, node))
    }

    fn fragments<'py>(&self, py: Python<'py>) -> PyResult<FragmentArrays<'py>> {
        let size = each!(&self.inner, held => held.tree.fragments().len());
        let export = run(py, 0, size, |_| {
            Ok(each!(&self.inner, held => held.export()))
        })?;
        Ok((
            rows(py, export.vertices, self.dimension())?,
            PyArray1::from_vec(py, export.offsets),
            PyArray1::from_vec(py, export.source),
            PyArray1::from_vec(py, export.node),
            PyArray1::from_vec(py, export.original),
            PyArray1::from_vec(py, export.flipped),
        ))
    }

    /// Each cut of a fragment as node and input facet.
    fn splits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let pairs = each!(&self.inner, held => held
            .tree
            .crossings()
            .iter()
            .map(|c| [i64::from(c.node), held.source(c.piece)])
            .collect());
        super::arrays::array(py, pairs)
    }

    /// The nodes from the farthest to the nearest.
    fn order<'py>(&self, py: Python<'py>, eye: [f64; 3], at_infinity: bool) -> PyResult<Ints<'py>> {
        let order = run(py, 0, self.__len__(), |_| {
            let eye = self.viewpoint(eye, at_infinity)?;
            Ok(each!(&self.inner, held => back_to_front(&held.tree, &eye)))
        })?;
        Ok(PyArray1::from_vec(
            py,
            order.into_iter().map(i64::from).collect(),
        ))
    }

    /// The side of each node's hyperplane on which the eye lies: -1, 0 or 1.
    fn sides<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        at_infinity: bool,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let found = run(py, 0, self.__len__(), |_| {
            let eye = self.viewpoint(eye, at_infinity)?;
            Ok(each!(&self.inner, held => sides(&held.tree, &eye)))
        })?;
        let sign = |side: &Side| match side {
            Side::Minus => -1,
            Side::On => 0,
            Side::Plus => 1,
        };
        Ok(PyArray1::from_vec(py, found.iter().map(sign).collect()))
    }

    /// Volume and surface of the root's region and of all nodes' regions, in lattice steps.
    fn measures<'py>(
        &self,
        py: Python<'py>,
        margin: f64,
    ) -> PyResult<(f64, f64, Floats<'py>, Floats<'py>)> {
        let (whole, all) = run(py, 0, self.__len__(), |_| {
            each!(&self.inner, held => {
                let whole = held.whole(margin)?;
                Ok(((whole.volume(), whole.surface()), measures(&held.tree, &whole)))
            })
        })?;
        let volumes = all.iter().map(|m| m.volume).collect();
        let surfaces = all.iter().map(|m| m.surface).collect();
        Ok((
            whole.0,
            whole.1,
            PyArray1::from_vec(py, volumes),
            PyArray1::from_vec(py, surfaces),
        ))
    }

    /// The corners of a region's walls; `node` None is the root's region, `side` -1 or 1 the part
    /// of a node's region on that side of its hyperplane.
    #[pyo3(signature = (node, side, margin))]
    fn region<'py>(
        &self,
        py: Python<'py>,
        node: Option<u32>,
        side: i8,
        margin: f64,
    ) -> PyResult<Vec<Rows<'py>>> {
        let walls = run(
            py,
            0,
            0,
            |_| each!(&self.inner, held => held.region(node, side, margin)),
        )?;
        let dimension = self.dimension();
        walls.into_iter().map(|w| rows(py, w, dimension)).collect()
    }

    /// The corners of the part of a node's hyperplane inside its region.
    fn span<'py>(&self, py: Python<'py>, node: u32, margin: f64) -> PyResult<Rows<'py>> {
        let corners = run(
            py,
            0,
            0,
            |_| each!(&self.inner, held => held.span(node, margin)),
        )?;
        rows(py, corners, self.dimension())
    }

    /// The facets as they came onto the lattice: corners in steps, and offsets.
    fn lattice<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyArray2<i64>>, Ints<'py>)> {
        let corners = rows(py, self.corners.clone(), self.dimension())?;
        Ok((corners, PyArray1::from_vec(py, self.offsets.clone())))
    }

    /// How many convex pieces the facets were taken apart into.
    #[getter]
    fn piece_count(&self) -> usize {
        each!(&self.inner, held => held.facets.len())
    }

    /// The facet that each convex piece is a part of.
    fn piece_sources<'py>(&self, py: Python<'py>) -> Ints<'py> {
        let facets = each!(&self.inner, held => &held.facets);
        let sources = facets.iter().map(|f| i64::from(f.source)).collect();
        PyArray1::from_vec(py, sources)
    }
}

impl PyFragmentTree {
    fn viewpoint(&self, eye: [f64; 3], at_infinity: bool) -> Result<Viewpoint> {
        if eye.iter().any(|c| !c.is_finite()) {
            return Err(Error::new(
                ErrorKind::NonFinite,
                "the viewpoint is not finite",
            ));
        }
        if !at_infinity {
            return Ok(Viewpoint::point(&eye, -self.pitch()));
        }
        if eye.iter().all(|c| *c == 0.0) {
            return Err(Error::new(ErrorKind::BadNormal, "the direction is zero"));
        }
        Ok(Viewpoint::direction(&eye))
    }
}

struct Export {
    vertices: Vec<[f64; 3]>,
    offsets: Vec<i64>,
    source: Vec<i64>,
    node: Vec<i64>,
    original: Vec<bool>,
    flipped: Vec<bool>,
}

impl<S: Affine> Held<S> {
    fn perfect(&self) -> Result<Option<Vec<NodeCut>>> {
        perfect(&pieces::<S>(&self.facets)?)
    }

    fn source(&self, piece: u32) -> i64 {
        i64::from(self.facets[piece as usize].source)
    }

    /// Lattice steps to model units.
    fn units(&self, steps: [f64; 3]) -> [f64; 3] {
        let power = 10f64.powi(self.pitch.exponent().unsigned_abs() as i32);
        steps.map(|k| {
            if self.pitch.exponent() <= 0 {
                k / power
            } else {
                k * power
            }
        })
    }

    fn positions(&self, piece: &S::Fragment) -> Vec<[f64; 3]> {
        S::corners(piece)
            .into_iter()
            .map(|p| self.units(p))
            .collect()
    }

    /// Unit normals, and offsets in model units: n·x = offset.
    fn hyperplanes(&self) -> (Vec<[f64; 3]>, Vec<f64>) {
        let unit = |cut: &S::Hyperplane| {
            let [a, b, c, d] = S::approx(cut);
            let length = (a * a + b * b + c * c).sqrt();
            let [offset, ..] = self.units([-d / length; 3]);
            ([a / length, b / length, c / length], offset)
        };
        self.tree
            .nodes()
            .iter()
            .map(|n| unit(&n.hyperplane))
            .unzip()
    }

    fn links(&self) -> [Vec<i64>; 6] {
        let number = |link: Option<u32>| link.map_or(-1, i64::from);
        let nodes = self.tree.nodes();
        [
            nodes.iter().map(|n| number(n.minus)).collect(),
            nodes.iter().map(|n| number(n.plus)).collect(),
            nodes
                .iter()
                .map(|n| number(n.parent.map(|p| p.0)))
                .collect(),
            nodes.iter().map(|n| i64::from(n.depth)).collect(),
            nodes.iter().map(|n| i64::from(n.coplanar.start)).collect(),
            nodes.iter().map(|n| i64::from(n.coplanar.end)).collect(),
        ]
    }

    fn cuts(&self) -> Vec<NodeCut> {
        self.tree.nodes().iter().map(|n| n.cut).collect()
    }

    fn export(&self) -> Export {
        let count = self.tree.fragments().len();
        let mut export = Export {
            vertices: Vec::with_capacity(S::DIM * count),
            offsets: Vec::with_capacity(count + 1),
            source: Vec::with_capacity(count),
            node: Vec::with_capacity(count),
            original: Vec::with_capacity(S::DIM * count),
            flipped: Vec::with_capacity(count),
        };
        export.offsets.push(0);
        for (number, node) in (0i64..).zip(self.tree.nodes()) {
            for fragment in &self.tree.fragments()[as_range(&node.coplanar)] {
                let facet = &self.facets[fragment.piece.number as usize];
                let shape = &fragment.piece.fragment;
                export.vertices.extend(self.positions(shape));
                export
                    .original
                    .extend(S::original(shape, &facet.corners, &facet.seams));
                export.offsets.push(export.vertices.len() as i64);
                export.source.push(i64::from(facet.source));
                export.node.push(number);
                export.flipped.push(fragment.flipped);
            }
        }
        export
    }

    /// The box of the facets grown by a margin in model units, at least one step.
    fn whole(&self, margin: f64) -> Result<Polytope<S>> {
        let steps = (margin / self.units([1.0; 3])[0])
            .round()
            .clamp(1.0, S::REACH as f64) as i64;
        grown_box(&self.facets, steps)
    }

    fn region(&self, node: Option<u32>, side: i8, margin: f64) -> Result<Vec<Vec<[f64; 3]>>> {
        let whole = self.whole(margin)?;
        let region = match node {
            None => Some(whole),
            Some(node) => {
                let region = self.tree.region(node, &whole);
                match (region, half_of(side)) {
                    (Some(region), Some(half)) => {
                        let cut = &self.tree.nodes()[node as usize].hyperplane;
                        let [minus, plus] = region.divided(cut);
                        if half == Half::Minus {
                            minus
                        } else {
                            plus
                        }
                    }
                    (region, _) => region,
                }
            }
        };
        let walls = region.as_ref().map_or(&[][..], |r| r.walls());
        Ok(walls.iter().map(|w| self.positions(w)).collect())
    }

    fn span(&self, node: u32, margin: f64) -> Result<Vec<[f64; 3]>> {
        let whole = self.whole(margin)?;
        let span = self
            .tree
            .region(node, &whole)
            .and_then(|r| r.span(&self.tree.nodes()[node as usize].hyperplane));
        Ok(span.map_or_else(Vec::new, |s| self.positions(&s)))
    }
}

fn as_range(range: &std::ops::Range<u32>) -> std::ops::Range<usize> {
    range.start as usize..range.end as usize
}

fn half_of(side: i8) -> Option<Half> {
    match side {
        0 => None,
        ..=-1 => Some(Half::Minus),
        1.. => Some(Half::Plus),
    }
}

/// The box of facets grown by a number of steps; the unit box if there are none.
fn grown_box<S: Affine>(facets: &[Facet], margin: i64) -> Result<Polytope<S>> {
    let corners = || facets.iter().flat_map(|f| &f.corners);
    let reach = |k: i64| k.clamp(-S::REACH, S::REACH);
    let low = [0, 1, 2].map(|i| reach(corners().map(|c| c[i]).min().unwrap_or(0) - margin));
    let high = [0, 1, 2].map(|i| reach(corners().map(|c| c[i]).max().unwrap_or(0) + margin));
    Polytope::cuboid(&low, &high).ok_or_else(|| {
        let text = "the facets fill the lattice, so that there is no room around them";
        Error::new(ErrorKind::TooLarge, text)
    })
}

fn pieces<S: Affine>(facets: &[Facet]) -> Result<Vec<Piece<S>>> {
    let piece = |(number, facet): (usize, &Facet)| {
        let flat = || Error::internal(format!("piece {number} has no extent"));
        let fragment = S::fragment(&facet.corners).ok_or_else(flat)?;
        let number = u32::try_from(number)
            .map_err(|_| Error::new(ErrorKind::TooLarge, "there are at most 2^32 pieces"))?;
        Ok(Piece { fragment, number })
    };
    facets.iter().enumerate().map(piece).collect()
}

fn built(
    dimension: usize,
    facets: Vec<Facet>,
    pitch: Pitch,
    wish: Wish,
    cancel: &AtomicBool,
) -> Result<Inner> {
    Ok(match dimension {
        1 => Inner::Line(held(facets, pitch, wish, cancel)?),
        2 => Inner::Plane(held(facets, pitch, wish, cancel)?),
        3 => Inner::Space(held(facets, pitch, wish, cancel)?),
        _ => {
            let text = format!("corners must have 1, 2 or 3 coordinates, not {dimension}");
            return Err(Error::new(ErrorKind::Shape, text));
        }
    })
}

fn held<S: Affine>(
    facets: Vec<Facet>,
    pitch: Pitch,
    wish: Wish,
    cancel: &AtomicBool,
) -> Result<Held<S>> {
    let pieces = pieces::<S>(&facets)?;
    let plan = match wish {
        Wish::Given(cuts) => Plan::Given(cuts),
        Wish::Policy(policy, top, margin) => Plan::Policy {
            policy,
            top,
            region: if policy.needs_region() {
                Some(grown_box(&facets, margin)?)
            } else {
                None
            },
        },
    };
    let tree = build(pieces, plan, cancel)?;
    Ok(Held {
        facets,
        tree,
        pitch,
    })
}

fn lenience_of((triangulate_bent, drop_flat): (bool, bool)) -> Lenience {
    Lenience {
        triangulate_bent,
        drop_flat,
    }
}

fn named_policy(name: &str, seed: u64, sample: Sample, alpha: f64) -> Result<Policy> {
    Ok(match name {
        "first" => Policy::First,
        "random" => Policy::Random(seed),
        "least-splits" => Policy::LeastSplits(sample),
        "balanced" => Policy::Balanced(sample),
        "weighted" => Policy::Weighted(sample, alpha),
        "least-cost" => Policy::LeastCost(sample),
        _ => {
            let text = format!("there is no policy '{name}'");
            return Err(Error::new(ErrorKind::Shape, text));
        }
    })
}

/// Rows of up to three numbers, filled up.
fn padded<T: numpy::Element + Copy>(array: &PyReadonlyArray2<'_, T>, fill: T) -> Vec<[T; 3]> {
    let view = array.as_array();
    let row =
        |r: numpy::ndarray::ArrayView1<'_, T>| [0, 1, 2].map(|i| r.get(i).copied().unwrap_or(fill));
    view.rows().into_iter().map(row).collect()
}

fn rows<T: numpy::Element + Copy>(
    py: Python<'_>,
    points: Vec<[T; 3]>,
    dimension: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    use numpy::PyArrayMethods;
    let count = points.len();
    let flat = points
        .iter()
        .flat_map(|p| p.iter().copied().take(dimension));
    PyArray1::from_vec(py, flat.collect()).reshape([count, dimension])
}

/// Cuts as rows: (-1, piece) for a pivot, (axis, coordinate) for an axis-parallel cut.
fn cut_rows(
    py: Python<'_>,
    cuts: impl Iterator<Item = NodeCut>,
) -> PyResult<Bound<'_, PyArray2<i64>>> {
    let row = |cut| match cut {
        NodeCut::Pivot(piece) => [-1, i64::from(piece)],
        NodeCut::Axis { axis, at } => [axis as i64, at],
    };
    super::arrays::array(py, cuts.map(row).collect())
}

fn node_cuts(array: &PyReadonlyArray2<'_, i64>) -> Result<Vec<NodeCut>> {
    let wrong = |_| Error::new(ErrorKind::BadSnapshot, "a stored cut is not one");
    let cut = |row: [i64; 3]| match row {
        [-1, piece, _] => u32::try_from(piece).map(NodeCut::Pivot).map_err(wrong),
        [axis, at, _] => {
            let axis = usize::try_from(axis).map_err(wrong)?;
            Ok(NodeCut::Axis { axis, at })
        }
    };
    padded(array, 0).into_iter().map(cut).collect()
}
