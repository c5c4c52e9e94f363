//! The class `FragmentTree`: a partition tree over points, segments or polygons.

mod convert;
mod facet_tree;
mod traces;

use num_bigint::BigInt;
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use self::convert::{
    cut_rows, lenience_of, named_policy, node_cuts, padded, rows, BuildMethod, BuildOptions,
};
use self::facet_tree::{build_any, build_asking, sign, AnyFacetTree};
use self::traces::{candidate_row, division_row, event_row, DivisionRow, EventRow};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Lattice;
use crate::geometry::spaces::affine::Viewpoint;
use crate::mesh::facets::{check_reach, facets, snap_corners, suited_pitch};
use crate::mesh::grid::Pitch;
use crate::mesh::handle::NodeId;
use crate::python::arrays::array;
use crate::python::calls::ending::attached;
use crate::python::calls::errors::{to_python, with_report};
use crate::python::calls::run::run;
use crate::python::hyperplanes::{FromRow, Row};
use crate::query::path::{RayEvent, RayPath};
use crate::tree::fragments::{back_to_front, measures, sides, Answer, Ask, Sample};

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

/// Evaluates an expression with the tree, in any dimension.
macro_rules! each {
    ($inner:expr, $facet_tree:ident => $body:expr) => {
        match $inner {
            AnyFacetTree::Line($facet_tree) => $body,
            AnyFacetTree::Plane($facet_tree) => $body,
            AnyFacetTree::Space($facet_tree) => $body,
        }
    };
}

/// A partition tree over facets. See `_core.pyi`.
#[pyclass(frozen, name = "FragmentTree", module = "bspcsg._core")]
pub struct PyFragmentTree {
    inner: AnyFacetTree,
    corners: Vec<Lattice>,
    offsets: Vec<i64>,
    options: BuildOptions,
}

/// Calls a method with the tree's dimension as a constant parameter.
macro_rules! each_cast {
    ($inner:expr, $facet_tree:ident, $method:ident, $($argument:expr),*) => {
        match $inner {
            AnyFacetTree::Line($facet_tree) => $facet_tree.$method::<1>($($argument),*),
            AnyFacetTree::Plane($facet_tree) => $facet_tree.$method::<2>($($argument),*),
            AnyFacetTree::Space($facet_tree) => $facet_tree.$method::<3>($($argument),*),
        }
    };
}

/// The first piece on a ray and the parameter where the ray meets it; `None` if it meets none.
type FirstHit = Option<(u32, f64)>;

/// For each ray: the facet, the parameter t, and the numbers of nodes, leaves and tests.
type Paths<'py> = (Ints<'py>, Floats<'py>, Ints<'py>, Ints<'py>, Ints<'py>);

#[pymethods]
impl PyFragmentTree {
    #[classmethod]
    #[pyo3(signature = (corners, offsets, policy, seed=0, sample=8, alpha=0.5, top=0, pitch=None, lenience=(false, false), own=None))]
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
        own: Option<Vec<Row>>,
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let method = method_of(policy, seed, sample, alpha, top).map_err(fail)?;
        let own = own.unwrap_or_default();
        let options = BuildOptions { method, own };
        let pitch = pitch.map(Pitch::new).transpose().map_err(fail)?;
        let dimension = corners.as_array().ncols();
        let rows: Vec<[f64; 3]> = padded(&corners, 0.0);
        let offsets = offsets.as_array().to_vec();
        let (inner, corners) = run(py, 0, rows.len(), || {
            let pitch = match pitch {
                Some(pitch) => pitch,
                None => suited_pitch(&rows)?,
            };
            let lattice = snap_corners(dimension, &rows, pitch)?;
            let facets = facets(dimension, &lattice, &offsets, lenience_of(lenience))?;
            let inner = build_any(dimension, facets, pitch, &options)?;
            Ok((inner, lattice))
        })?;
        Ok(Self {
            inner,
            corners,
            offsets,
            options,
        })
    }

    /// Return a tree whose cuts the callback `answer(depth, count, candidates)` chooses. It returns a pair:
    /// the index of a candidate and None; or any number and the row (normal, offset) of a hyperplane.
    #[classmethod]
    #[allow(clippy::too_many_arguments)]
    fn asked(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        corners: PyReadonlyArray2<'_, f64>,
        offsets: PyReadonlyArray1<'_, i64>,
        answer: Py<PyAny>,
        sample: usize,
        pitch: i64,
        lenience: (bool, bool),
        own: Vec<Row>,
    ) -> PyResult<Self> {
        let pitch = Pitch::new(pitch).map_err(|e| to_python(py, &e))?;
        let dimension = corners.as_array().ncols();
        let rows: Vec<[f64; 3]> = padded(&corners, 0.0);
        let offsets = offsets.as_array().to_vec();
        let raised = Raised::default();
        let slot = Arc::clone(&raised);
        let sample = Sample(sample);
        let made = run(py, 0, rows.len(), || {
            let lattice = snap_corners(dimension, &rows, pitch)?;
            let facets = facets(dimension, &lattice, &offsets, lenience_of(lenience))?;
            let inner = match dimension {
                1 => AnyFacetTree::Line(build_asking(
                    facets,
                    pitch,
                    &own,
                    ask(answer, slot, sample),
                )?),
                2 => AnyFacetTree::Plane(build_asking(
                    facets,
                    pitch,
                    &own,
                    ask(answer, slot, sample),
                )?),
                _ => AnyFacetTree::Space(build_asking(
                    facets,
                    pitch,
                    &own,
                    ask(answer, slot, sample),
                )?),
            };
            Ok((inner, lattice))
        });
        if let Some(error) = raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
            return Err(error);
        }
        let (inner, corners) = made?;
        let options = each!(&inner, facet_tree => facet_tree.build_options());
        Ok(Self {
            inner,
            corners,
            offsets,
            options,
        })
    }

    /// Return the tree with more facets; the given policy divides regions that had no facets.
    #[allow(clippy::too_many_arguments)]
    fn grown(
        &self,
        py: Python<'_>,
        corners: PyReadonlyArray2<'_, f64>,
        offsets: PyReadonlyArray1<'_, i64>,
        policy: &str,
        seed: u64,
        sample: usize,
        alpha: f64,
        lenience: (bool, bool),
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let method = method_of(policy, seed, sample, alpha, 0).map_err(fail)?;
        let own = Vec::new();
        let options = BuildOptions { method, own };
        let dimension = self.dimension();
        let rows: Vec<[f64; 3]> = padded(&corners, 0.0);
        let pitch = Pitch::new(self.pitch()).map_err(fail)?;
        let mut all_corners = self.corners.clone();
        let mut all_offsets = self.offsets.clone();
        let start = all_corners.len() as i64;
        all_offsets.extend(offsets.as_array().iter().skip(1).map(|at| at + start));
        let (inner, corners) = self.run(py, all_corners.len() + rows.len(), || {
            all_corners.extend(snap_corners(dimension, &rows, pitch)?);
            let facets = facets(dimension, &all_corners, &all_offsets, lenience_of(lenience))?;
            let inner = match &self.inner {
                AnyFacetTree::Line(facet_tree) => {
                    AnyFacetTree::Line(facet_tree.grown(facets, &options)?)
                }
                AnyFacetTree::Plane(facet_tree) => {
                    AnyFacetTree::Plane(facet_tree.grown(facets, &options)?)
                }
                AnyFacetTree::Space(facet_tree) => {
                    AnyFacetTree::Space(facet_tree.grown(facets, &options)?)
                }
            };
            Ok((inner, all_corners))
        })?;
        let options = each!(&inner, facet_tree => facet_tree.build_options());
        Ok(Self {
            inner,
            corners,
            offsets: all_offsets,
            options,
        })
    }

    /// Return a record of the division at each node of the tree, in the order of the nodes.
    fn construction(&self, py: Python<'_>) -> PyResult<Vec<DivisionRow>> {
        let options = &self.options;
        let divisions = self.run(
            py,
            self.corners.len(),
            || each!(&self.inner, facet_tree => facet_tree.construction(options)),
        )?;
        Ok(divisions.into_iter().map(division_row).collect())
    }

    /// Return the nodes that a point passes on its path from the root, each with the side of the node's
    /// hyperplane on which the point lies: −1, 0 or 1.
    fn path(&self, py: Python<'_>, point: [f64; 3]) -> PyResult<Vec<(u32, i8)>> {
        self.run(py, 0, || {
            Ok(each!(&self.inner, facet_tree => facet_tree.path(&point)))
        })
    }

    /// Return for each ray the facet that it meets first, the parameter of the hit, and the numbers of
    /// visited nodes, visited leaves and tests.
    fn cast<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray2<'py, f64>,
        directions: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Paths<'py>> {
        let rays = rays_of(&origins, &directions);
        let paths = self.run(py, rays.len() * ELEMENTS_PER_RAY, || {
            each_cast!(&self.inner, facet_tree, cast, &rays)
        })?;
        let count = |of: fn(&RayPath) -> u64| {
            PyArray1::from_vec(py, paths.iter().map(|p| of(p) as i64).collect())
        };
        let source = |path: &RayPath| path.hit.map_or(-1, |hit| self.source(hit.0));
        let t = |path: &RayPath| path.hit.map_or(f64::INFINITY, |hit| hit.1);
        Ok((
            PyArray1::from_vec(py, paths.iter().map(source).collect()),
            PyArray1::from_vec(py, paths.iter().map(t).collect()),
            count(|p| p.nodes),
            count(|p| p.leaves),
            count(|p| p.tests),
        ))
    }

    /// Return the steps of one ray through the tree, and its first hit: the piece of a facet and the
    /// parameter.
    fn ray_events(
        &self,
        py: Python<'_>,
        origin: [f64; 3],
        direction: [f64; 3],
    ) -> PyResult<(FirstHit, Vec<EventRow>)> {
        let mut events: Vec<RayEvent> = Vec::new();
        let [a, b, c] = origin;
        let [d, e, f] = direction;
        let ray = [a, b, c, d, e, f];
        let path = self.run(py, ELEMENTS_PER_RAY, || {
            each_cast!(&self.inner, facet_tree, cast_one, &ray, &mut events)
        })?;
        Ok((path.hit, events.iter().map(event_row).collect()))
    }

    /// Return the cuts that are not hyperplanes of facets, as rows of normal and offset, in lattice steps.
    fn own(&self) -> Vec<Row> {
        each!(&self.inner, facet_tree => facet_tree.build_options()).own
    }

    #[classmethod]
    #[pyo3(signature = (corners, offsets, pitch, cuts, lenience, own=None))]
    #[allow(clippy::too_many_arguments)]
    fn rebuild(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        corners: PyReadonlyArray2<'_, i64>,
        offsets: PyReadonlyArray1<'_, i64>,
        pitch: i64,
        cuts: PyReadonlyArray2<'_, i64>,
        lenience: (bool, bool),
        own: Option<Vec<Row>>,
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let pitch = Pitch::new(pitch).map_err(fail)?;
        let dimension = corners.as_array().ncols();
        let rows: Vec<Lattice> = padded(&corners, 0);
        let offsets = offsets.as_array().to_vec();
        let method = BuildMethod::Given(node_cuts(&cuts).map_err(fail)?);
        let own = own.unwrap_or_default();
        let options = BuildOptions { method, own };
        let inner = run(py, 0, rows.len(), || {
            check_reach(&rows)?;
            let facets = facets(dimension, &rows, &offsets, lenience_of(lenience))?;
            build_any(dimension, facets, pitch, &options)
        })?;
        Ok(Self {
            inner,
            corners: rows,
            offsets,
            options,
        })
    }

    /// Return cuts for a tree over the same facets in which no facet is split; None if the search finds none.
    fn perfect_cuts<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<i64>>>> {
        let found = self.run(
            py,
            0,
            || each!(&self.inner, facet_tree => facet_tree.perfect()),
        )?;
        found.map(|cuts| cut_rows(py, cuts.into_iter())).transpose()
    }

    #[getter]
    fn dimension(&self) -> usize {
        match self.inner {
            AnyFacetTree::Line(_) => 1,
            AnyFacetTree::Plane(_) => 2,
            AnyFacetTree::Space(_) => 3,
        }
    }

    #[getter]
    fn pitch(&self) -> i64 {
        each!(&self.inner, facet_tree => facet_tree.pitch.exponent())
    }

    fn __len__(&self) -> usize {
        each!(&self.inner, facet_tree => facet_tree.tree.nodes().len())
    }

    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let (normals, offsets) = each!(&self.inner, facet_tree => facet_tree.hyperplanes());
        dict.set_item("normal", rows(py, normals, self.dimension())?)?;
        dict.set_item("offset", PyArray1::from_vec(py, offsets))?;
        let links = each!(&self.inner, facet_tree => facet_tree.links());
        for (name, list) in ["minus", "plus", "parent", "depth", "start", "end"]
            .iter()
            .zip(links)
        {
            dict.set_item(name, PyArray1::from_vec(py, list))?;
        }
        let cuts = each!(&self.inner, facet_tree => facet_tree.cuts());
        dict.set_item("cut", cut_rows(py, cuts.into_iter())?)?;
        Ok(dict)
    }

    /// Return the exact coefficients n, d of a node's hyperplane n·x + d = 0, in lattice steps.
    fn coefficients(&self, node: u32) -> Option<Vec<BigInt>> {
        each!(&self.inner, facet_tree => facet_tree.coefficients(NodeId(node)))
    }

    fn fragments<'py>(&self, py: Python<'py>) -> PyResult<FragmentArrays<'py>> {
        let size = each!(&self.inner, facet_tree => facet_tree.tree.fragments().len());
        let export = self.run(py, size, || {
            Ok(each!(&self.inner, facet_tree => facet_tree.export()))
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

    /// Return for each division of a fragment in two the number of the node whose cut divides it, and the
    /// index of the input facet.
    fn splits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let pairs = each!(&self.inner, facet_tree => facet_tree
            .tree
            .crossings()
            .iter()
            .map(|c| [i64::from(c.node), facet_tree.source(c.piece)])
            .collect());
        array(py, pairs)
    }

    /// Return the nodes in painter's order, from the farthest to the nearest.
    fn order<'py>(&self, py: Python<'py>, eye: [f64; 3], at_infinity: bool) -> PyResult<Ints<'py>> {
        let order = self.run(py, self.__len__(), || {
            let eye = self.viewpoint(eye, at_infinity)?;
            Ok(each!(&self.inner, facet_tree => back_to_front(&facet_tree.tree, &eye)))
        })?;
        Ok(PyArray1::from_vec(
            py,
            order.into_iter().map(i64::from).collect(),
        ))
    }

    /// Return for each node the side of its hyperplane on which the eye lies: -1, 0 or 1.
    fn sides<'py>(
        &self,
        py: Python<'py>,
        eye: [f64; 3],
        at_infinity: bool,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let found = self.run(py, self.__len__(), || {
            let eye = self.viewpoint(eye, at_infinity)?;
            Ok(each!(&self.inner, facet_tree => sides(&facet_tree.tree, &eye)))
        })?;
        Ok(PyArray1::from_vec(
            py,
            found.into_iter().map(sign).collect(),
        ))
    }

    /// Return the volume and the surface of the root's region, then arrays of the volume and the surface of
    /// each node's region, in lattice steps.
    fn measures<'py>(
        &self,
        py: Python<'py>,
        margin: f64,
    ) -> PyResult<(f64, f64, Floats<'py>, Floats<'py>)> {
        let (whole, all) = self.run(py, self.__len__(), || {
            each!(&self.inner, facet_tree => {
                let whole = facet_tree.whole(margin)?;
                Ok(((whole.volume(), whole.surface()), measures(&facet_tree.tree, &whole)))
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

    /// Return the corners of the walls of a region. If `node` is None, it is the root's region; else the
    /// region of the node, or its part on one side of the node's hyperplane if `side` is -1 or 1.
    #[pyo3(signature = (node, side, margin))]
    fn region<'py>(
        &self,
        py: Python<'py>,
        node: Option<u32>,
        side: i8,
        margin: f64,
    ) -> PyResult<Vec<Rows<'py>>> {
        let walls = self.run(
            py,
            0,
            || each!(&self.inner, facet_tree => facet_tree.region(node.map(NodeId), side, margin)),
        )?;
        let dimension = self.dimension();
        walls.into_iter().map(|w| rows(py, w, dimension)).collect()
    }

    /// Return the corners of the part of a node's hyperplane inside the node's region.
    fn span<'py>(&self, py: Python<'py>, node: u32, margin: f64) -> PyResult<Rows<'py>> {
        let corners = self.run(
            py,
            0,
            || each!(&self.inner, facet_tree => facet_tree.span(NodeId(node), margin)),
        )?;
        rows(py, corners, self.dimension())
    }

    /// Return the tree's facets (input points, segments or polygons) on the lattice: the corners of all
    /// facets in lattice steps, and for each facet the index of its first corner.
    fn lattice<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyArray2<i64>>, Ints<'py>)> {
        let corners = rows(py, self.corners.clone(), self.dimension())?;
        Ok((corners, PyArray1::from_vec(py, self.offsets.clone())))
    }

    /// Return the number of convex pieces into which the tree's facets (input points, segments or polygons)
    /// were divided.
    #[getter]
    fn piece_count(&self) -> usize {
        each!(&self.inner, facet_tree => facet_tree.facets.len())
    }

    /// Return for each convex piece the facet that it is a part of.
    fn piece_sources<'py>(&self, py: Python<'py>) -> Ints<'py> {
        let facets = each!(&self.inner, facet_tree => &facet_tree.facets);
        let sources = facets.iter().map(|f| i64::from(f.source)).collect();
        PyArray1::from_vec(py, sources)
    }
}

/// The cost of casting a ray, in elements of other work.
const ELEMENTS_PER_RAY: usize = 1000;

/// Storage for the exception that a callback raised.
type Raised = Arc<Mutex<Option<PyErr>>>;

fn method_of(
    policy: &str,
    seed: u64,
    sample: usize,
    alpha: f64,
    top: usize,
) -> Result<BuildMethod> {
    if policy == "end-points" {
        return Ok(BuildMethod::Lines(Sample(sample)));
    }
    let policy = named_policy(policy, seed, Sample(sample), alpha)?;
    Ok(BuildMethod::Policy(policy, (top > 0).then_some(top), 1))
}

/// Wraps a Python callback that chooses cuts; stores its exception in `raised`.
fn ask<S: FromRow>(answer: Py<PyAny>, raised: Raised, sample: Sample) -> Ask<S> {
    let refused = move |error: PyErr| {
        *raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        Error::new(ErrorKind::Cancelled, "the policy raised an exception")
    };
    Ask {
        sample,
        answer: Box::new(move |depth, count, candidates| {
            let rows: Vec<_> = candidates.iter().map(candidate_row).collect();
            let found = attached(|py| {
                let found = answer.call1(py, (depth, count, rows))?;
                found.extract::<(usize, Option<Row>)>(py)
            });
            match found.map_err(&refused)? {
                (place, None) => Ok(Answer::Candidate(place)),
                (_, Some(row)) => S::from_row(&row).map(Answer::Hyperplane),
            }
        }),
    }
}

fn rays_of(
    origins: &PyReadonlyArray2<'_, f64>,
    directions: &PyReadonlyArray2<'_, f64>,
) -> Vec<[f64; 6]> {
    let (origins, heads) = (padded(origins, 0.0), padded(directions, 0.0));
    let pairs = origins.into_iter().zip(heads);
    pairs
        .map(|([a, b, c], [d, e, f])| [a, b, c, d, e, f])
        .collect()
}

impl PyFragmentTree {
    fn source(&self, piece: u32) -> i64 {
        each!(&self.inner, facet_tree => facet_tree.source(piece))
    }

    /// Runs the work of a method; the report of a defect contains the tree's facets (its input points,
    /// segments or polygons).
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        size: usize,
        work: impl FnOnce() -> Result<T> + Send,
    ) -> PyResult<T> {
        run(py, 0, size, work).map_err(|e| {
            with_report(py, e, "FragmentTree", || {
                let inputs = PyDict::new(py);
                let corners = rows(py, self.corners.clone(), self.dimension())?;
                inputs.set_item("corners", corners)?;
                inputs.set_item("offsets", self.offsets.clone())?;
                Ok(inputs)
            })
        })
    }

    fn viewpoint(&self, eye: [f64; 3], at_infinity: bool) -> Result<Viewpoint> {
        if eye.iter().any(|c| !c.is_finite()) {
            return Err(Error::new(
                ErrorKind::NonFinite,
                "the viewpoint has a coordinate that is not finite",
            ));
        }
        if !at_infinity {
            return Ok(Viewpoint::point(&eye, -self.pitch()));
        }
        if eye.iter().all(|c| *c == 0.0) {
            return Err(Error::new(
                ErrorKind::BadNormal,
                "the direction is the zero vector",
            ));
        }
        Ok(Viewpoint::direction(&eye))
    }
}
