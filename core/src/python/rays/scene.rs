//! The class `RayScene`: facets in one, two or three dimensions, and rays cast at them.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Error, ErrorKind, Result};
use crate::merge::rule::Rule;
use crate::mesh::grid::Pitch;
use crate::python::calls::errors::{to_python, with_report};
use crate::python::calls::in_use::InUse;
use crate::python::calls::run::{run, MIN_ELEMENTS_FOR_POOL};
use crate::query::ray::answer::{Hit, Kind};
use crate::query::ray::batch::{Inside, Rays};
use crate::query::ray::view::{views, View};
use crate::query::ray::Scene;

/// The cost of casting a ray, in elements of other work.
pub(super) const ELEMENTS_PER_RAY: usize = 100;

enum Facets {
    Points(Scene<1>),
    Segments(Scene<2>),
    Triangles(Scene<3>),
}

/// Evaluates an expression with the scene, in any dimension.
macro_rules! with_scene {
    ($facets:expr, $scene:ident => $body:expr) => {
        match $facets {
            Facets::Points($scene) => $body,
            Facets::Segments($scene) => $body,
            Facets::Triangles($scene) => $body,
        }
    };
}

type Floats<'py> = Bound<'py, PyArray1<f64>>;
type Indices<'py> = Bound<'py, PyArray1<i64>>;

/// For each hit: facet, t, kind, weights and point; the weights and the points are flat.
pub(super) type HitArrays<'py> = (
    Indices<'py>,
    Floats<'py>,
    Bound<'py, PyArray1<i8>>,
    Floats<'py>,
    Floats<'py>,
);

pub(super) struct Columns {
    facet: Vec<i64>,
    t: Vec<f64>,
    kind: Vec<i8>,
    weights: Vec<f64>,
    points: Vec<f64>,
}

impl Columns {
    fn with_room<const D: usize>(hits: usize) -> Self {
        Self {
            facet: Vec::with_capacity(hits),
            t: Vec::with_capacity(hits),
            kind: Vec::with_capacity(hits),
            weights: Vec::with_capacity(hits * D),
            points: Vec::with_capacity(hits * D),
        }
    }

    fn push<const D: usize>(&mut self, hit: &Hit<D>) {
        self.facet.push(i64::from(hit.number));
        self.t.push(hit.t);
        self.kind.push(match hit.kind {
            Kind::Interior => 0,
            Kind::Edge => 1,
            Kind::Vertex => 2,
        });
        self.weights.extend(hit.weights);
        self.points.extend(hit.point);
    }

    fn push_miss<const D: usize>(&mut self) {
        self.facet.push(-1);
        self.t.push(f64::INFINITY);
        self.kind.push(-1);
        self.weights.extend([f64::NAN; D]);
        self.points.extend([f64::NAN; D]);
    }

    pub(super) fn of_first<const D: usize>(hits: &[Option<Hit<D>>]) -> Self {
        let mut columns = Self::with_room::<D>(hits.len());
        for hit in hits {
            match hit {
                Some(hit) => columns.push(hit),
                None => columns.push_miss::<D>(),
            }
        }
        columns
    }

    fn of_all<const D: usize>(hits: &[Vec<Hit<D>>]) -> Self {
        let mut columns = Self::with_room::<D>(hits.iter().map(Vec::len).sum());
        hits.iter().flatten().for_each(|hit| columns.push(hit));
        columns
    }

    pub(super) fn arrays(self, py: Python<'_>) -> HitArrays<'_> {
        (
            PyArray1::from_vec(py, self.facet),
            PyArray1::from_vec(py, self.t),
            PyArray1::from_vec(py, self.kind),
            PyArray1::from_vec(py, self.weights),
            PyArray1::from_vec(py, self.points),
        )
    }
}

/// Facets that rays are cast at. See `_core.pyi`.
#[pyclass(frozen, module = "bspcsg._core")]
pub struct RayScene {
    facets: Facets,
    calls: InUse,
}

fn known_nodes<'py, const D: usize>(
    py: Python<'py>,
    scene: &Scene<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let known = run(py, 0, 0, || Ok(views(scene)))?;
    let dict = PyDict::new(py);
    let steps = |of: fn(&View<D>) -> [f64; D]| {
        let step = scene.pitch().coordinate(1);
        PyArray1::from_vec(py, known.iter().flat_map(of).map(|k| k * step).collect())
    };
    dict.set_item("low", steps(|node| node.cell.low))?;
    dict.set_item("high", steps(|node| node.cell.high))?;
    let parent = |node: &View<D>| node.parent.map_or(-1, i64::from);
    dict.set_item(
        "parent",
        PyArray1::from_vec(py, known.iter().map(parent).collect()),
    )?;
    let deferred = known.iter().map(|node| node.deferred).collect();
    dict.set_item("deferred", PyArray1::<bool>::from_vec(py, deferred))?;
    let (mut offsets, mut facets) = (vec![0i64], Vec::new());
    for node in &known {
        let list = node.facets.iter();
        facets.extend(list.map(|facet| i64::from(scene.number(*facet))));
        offsets.push(facets.len() as i64);
    }
    dict.set_item("offsets", PyArray1::from_vec(py, offsets))?;
    dict.set_item("facets", PyArray1::from_vec(py, facets))?;
    Ok(dict)
}

#[pymethods]
impl RayScene {
    #[new]
    #[pyo3(signature = (dimension, corners, pitch=None))]
    fn new(
        py: Python<'_>,
        dimension: usize,
        corners: PyReadonlyArray1<'_, f64>,
        pitch: Option<i64>,
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let pitch = pitch.map(Pitch::new).transpose().map_err(fail)?;
        let flat = corners.as_slice()?;
        let facets = run(py, 0, flat.len(), || build(dimension, flat, pitch))?;
        let calls = InUse::default();
        Ok(Self { facets, calls })
    }

    #[getter]
    fn pitch(&self) -> i64 {
        with_scene!(&self.facets, scene => scene.pitch().exponent())
    }

    /// The number of facets that can be hit.
    fn __len__(&self) -> usize {
        with_scene!(&self.facets, scene => scene.facets().len())
    }

    /// Divide all parts of the tree of boxes that no ray has reached yet.
    #[pyo3(signature = (threads=0))]
    fn complete(&self, py: Python<'_>, threads: usize) -> PyResult<()> {
        self.run(py, threads, MIN_ELEMENTS_FOR_POOL, || {
            with_scene!(&self.facets, scene => scene.complete());
            Ok(())
        })
    }

    /// Return a scene with moved facets, given by their new corners, in the same number; the tree of boxes is
    /// kept, with boxes of new extents.
    fn refitted(&self, py: Python<'_>, corners: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        let flat = corners.as_slice()?;
        let facets = self.run(py, 0, flat.len(), || {
            Ok(match &self.facets {
                Facets::Points(scene) => Facets::Points(scene.refitted(&facets(flat)?)?),
                Facets::Segments(scene) => Facets::Segments(scene.refitted(&facets(flat)?)?),
                Facets::Triangles(scene) => Facets::Triangles(scene.refitted(&facets(flat)?)?),
            })
        })?;
        let calls = InUse::default();
        Ok(Self { facets, calls })
    }

    /// Return the nodes that rays have reached, in preorder, as columns: boxes, parents, flags that are true
    /// for nodes not divided yet, and the facets of leaves.
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let _call = self.calls.enter(py)?;
        with_scene!(&self.facets, scene => known_nodes(py, scene))
    }

    #[pyo3(signature = (origins, directions, threads=0))]
    fn first<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<HitArrays<'py>> {
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let columns = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => Ok(Columns::of_first(&rays.first(scene)?)))
        })?;
        Ok(columns.arrays(py))
    }

    /// Return for each ray the index of the first facet that it meets; −1 for a ray that meets none.
    #[pyo3(signature = (origins, directions, threads=0))]
    fn first_facets<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<Indices<'py>> {
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let facets = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => rays.facets(scene))
        })?;
        Ok(PyArray1::from_vec(py, facets))
    }

    /// Return the index of each ray's first hit, and columns with all hits; with `merge` only the first of
    /// several hits at one point.
    #[pyo3(signature = (origins, directions, merge=false, threads=0))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
        merge: bool,
        threads: usize,
    ) -> PyResult<(Indices<'py>, HitArrays<'py>)> {
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let (offsets, columns) = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => {
                let hits = rays.all(scene, merge)?;
                Ok((offsets(&hits), Columns::of_all(&hits)))
            })
        })?;
        Ok((PyArray1::from_vec(py, offsets), columns.arrays(py)))
    }

    /// Return three flat arrays: the index of each ray's first interval inside the set, the parameters at
    /// both ends of each interval, and the facets there. If `unbounded`, the winding number far from the
    /// facets is 1.
    #[pyo3(signature = (origins, directions, rule="positive", unbounded=false, threads=0))]
    fn intervals<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
        rule: &str,
        unbounded: bool,
        threads: usize,
    ) -> PyResult<(Indices<'py>, Floats<'py>, Indices<'py>)> {
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let rule = winding_rule(rule).map_err(|e| to_python(py, &e))?;
        let outside = i32::from(unbounded);
        let found = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => rays.inside(scene, rule, outside))
        })?;
        let ends = |i: &Inside| i.t;
        let t = found.iter().flatten().flat_map(ends).collect();
        let facets = found.iter().flatten().flat_map(|i| i.facets).collect();
        Ok((
            PyArray1::from_vec(py, offsets(&found)),
            PyArray1::from_vec(py, t),
            PyArray1::from_vec(py, facets),
        ))
    }

    #[pyo3(signature = (origins, targets, threads=0))]
    fn hidden<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        targets: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let (origins, heads) = (origins.as_slice()?, targets.as_slice()?);
        let found = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => rays.hidden(scene))
        })?;
        Ok(PyArray1::from_vec(py, found))
    }

    #[pyo3(signature = (origins, directions, limits, threads=0))]
    fn blocked<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
        limits: PyReadonlyArray1<'py, f64>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let limits = limits.as_slice()?;
        let found = self.run(py, threads, origins.len() * ELEMENTS_PER_RAY, || {
            let rays = Rays { origins, heads };
            with_scene!(&self.facets, scene => rays.blocked(scene, limits))
        })?;
        Ok(PyArray1::from_vec(py, found))
    }
}

impl RayScene {
    /// Runs work that may divide parts of the tree; the report of a defect contains the facets (points,
    /// segments or triangles) of the scene.
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        threads: usize,
        size: usize,
        work: impl FnOnce() -> Result<T> + Send,
    ) -> PyResult<T> {
        let _call = self.calls.enter(py)?;
        run(py, threads, size, work).map_err(|e| {
            with_report(py, e, "RayScene", || {
                let corners: Vec<f64> = with_scene!(&self.facets, scene => {
                    scene.facets().iter().flatten().flatten().copied().collect()
                });
                let inputs = PyDict::new(py);
                inputs.set_item("corners", PyArray1::from_vec(py, corners))?;
                Ok(inputs)
            })
        })
    }
}

fn build(dimension: usize, flat: &[f64], pitch: Option<Pitch>) -> Result<Facets> {
    match dimension {
        1 => Ok(Facets::Points(Scene::new(&facets(flat)?, pitch)?)),
        2 => Ok(Facets::Segments(Scene::new(&facets(flat)?, pitch)?)),
        3 => Ok(Facets::Triangles(Scene::new(&facets(flat)?, pitch)?)),
        _ => {
            let text = format!("rays are cast in 1, 2 or 3 dimensions, not in {dimension}");
            Err(Error::new(ErrorKind::Shape, text))
        }
    }
}

pub(super) fn facets<const D: usize>(flat: &[f64]) -> Result<Vec<[[f64; D]; D]>> {
    if !flat.len().is_multiple_of(D * D) {
        let text = format!("facets must have shape (n, {D}, {D})");
        return Err(Error::new(ErrorKind::Shape, text));
    }
    let facet = |c: &[f64]| std::array::from_fn(|i| std::array::from_fn(|k| c[i * D + k]));
    Ok(flat.chunks_exact(D * D).map(facet).collect())
}

fn winding_rule(name: &str) -> Result<Rule> {
    match name {
        "positive" => Ok(Rule::Positive),
        "nonzero" => Ok(Rule::Nonzero),
        "even-odd" => Ok(Rule::EvenOdd),
        _ => {
            let text = format!("'{name}' is not a winding rule; use positive, nonzero or even-odd");
            Err(Error::new(ErrorKind::Shape, text))
        }
    }
}

fn offsets<T>(rows: &[Vec<T>]) -> Vec<i64> {
    let mut sum = 0;
    let ends = rows.iter().map(|row| {
        sum += row.len() as i64;
        sum
    });
    std::iter::once(0).chain(ends).collect()
}
