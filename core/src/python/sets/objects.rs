//! The class `ObjectTree`: an immutable partition tree with in and out leaves, of any dimension.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use num_bigint::BigInt;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyType};

use super::each::Set;
use super::input::{self, Input};
use super::pieces::{self, Pieces};
use super::queries::{exact_corners, outline_pieces};
use super::store::Nodes;
use super::traces::{step_row, StepRow};
use crate::error::Result;
use crate::merge::plane::bounded;
use crate::merge::SetOp;
use crate::mesh::grid::Pitch;
use crate::python::arrays::flat;
use crate::python::calls::errors::{to_python, with_report};
use crate::python::calls::run::{here, run};
use crate::python::hyperplanes::Row;
use crate::query::measure::Fraction;
use crate::query::region::outlines::Outline;
use crate::tree::partition::Location;

type Ratio = (BigInt, BigInt);

/// An immutable partition tree of a set on the line, in the plane or in space. See `_core.pyi`.
#[pyclass(frozen, module = "bspcsg._core")]
pub struct ObjectTree {
    set: Set,
    pitch: Pitch,
    outlines: OnceLock<Arc<Vec<Outline>>>,
}

impl ObjectTree {
    fn of(set: Set, pitch: Pitch) -> Self {
        let outlines = OnceLock::new();
        Self {
            set,
            pitch,
            outlines,
        }
    }

    /// Returns the outlines of a region; computes them on the first call.
    fn loops(&self, py: Python<'_>) -> PyResult<Arc<Vec<Outline>>> {
        if let Some(known) = self.outlines.get() {
            return Ok(Arc::clone(known));
        }
        let made = self.work(py, |set, _| set.outlines())?;
        Ok(Arc::clone(self.outlines.get_or_init(|| Arc::new(made))))
    }

    fn work<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Set, Pitch) -> Result<T> + Send,
    ) -> PyResult<T> {
        run(py, 0, self.set.size(), || work(&self.set, self.pitch))
            .map_err(|e| self.with_report(py, e, &[self]))
    }

    fn with(&self, set: Set) -> Self {
        Self::of(set, self.pitch)
    }

    /// Runs work with this set and another on the same lattice; the report of a defect contains both.
    fn compared<T: Send>(
        &self,
        py: Python<'_>,
        other: &Self,
        work: impl FnOnce(&Set, &Set) -> Result<T> + Send,
    ) -> PyResult<T> {
        let (a, b) = (&self.set, &other.set);
        input::same_lattice(self.pitch, other.pitch).map_err(|e| to_python(py, &e))?;
        run(py, 0, a.size() + b.size(), || work(a, b))
            .map_err(|e| self.with_report(py, e, &[self, other]))
    }

    /// Applies a set operation with another set, by the given method `way`: a merge of trees, or a sweep.
    fn operated<T: Send>(
        &self,
        py: Python<'_>,
        other: &Self,
        op: &str,
        way: impl FnOnce(&Set, &Set, SetOp) -> Result<T> + Send,
    ) -> PyResult<T> {
        let op = input::operation(op).map_err(|e| to_python(py, &e))?;
        self.compared(py, other, |a, b| way(a, b, op))
    }

    fn with_report(&self, py: Python<'_>, error: PyErr, operands: &[&Self]) -> PyErr {
        with_report(py, error, "ObjectTree", || {
            let inputs = PyDict::new(py);
            for (k, operand) in operands.iter().enumerate() {
                let operand = Bound::new(py, self.with(operand.set.clone()))?;
                inputs.set_item(format!("operand-{k}"), operand)?;
            }
            Ok(inputs)
        })
    }
}

fn ratio(fraction: Fraction) -> Ratio {
    (fraction.numerator, fraction.denominator)
}

fn rows(array: &PyReadonlyArray2<'_, f64>) -> Vec<Vec<f64>> {
    let view = array.as_array();
    view.rows().into_iter().map(|row| row.to_vec()).collect()
}

#[pymethods]
impl ObjectTree {
    #[classmethod]
    #[pyo3(signature = (dimension, facets, pitch, *, faces=None, winding="positive", policy="balanced", seed=0, cuts=None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn build(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        dimension: usize,
        facets: PyReadonlyArray2<'_, f64>,
        pitch: i64,
        faces: Option<PyReadonlyArray2<'_, i64>>,
        winding: &str,
        policy: &str,
        seed: u64,
        cuts: Option<Vec<Row>>,
    ) -> PyResult<Self> {
        let fail = |e| to_python(py, &e);
        let pitch = Pitch::new(pitch).map_err(fail)?;
        let own = |f| crate::python::arrays::rows(f, "faces").map(Cow::into_owned);
        let faces = faces.as_ref().map(own);
        let input = Input {
            facets: rows(&facets),
            faces: faces.transpose().map_err(fail)?.unwrap_or_default(),
            cuts: cuts.unwrap_or_default(),
            rule: input::rule(winding).map_err(fail)?,
            policy: input::policy(policy, seed).map_err(fail)?,
        };
        let size = input.facets.len();
        let set = run(py, 0, size, || Set::build(dimension, &input, pitch))?;
        Ok(Self::of(set, pitch))
    }

    #[classmethod]
    fn half_space(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        hyperplane: Row,
        pitch: i64,
    ) -> PyResult<Self> {
        here(py, || {
            let pitch = Pitch::new(pitch)?;
            let set = Set::half_space(&hyperplane)?;
            Ok(Self::of(set, pitch))
        })
    }

    #[classmethod]
    fn uniform(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        dimension: usize,
        full: bool,
        pitch: i64,
    ) -> PyResult<Self> {
        here(py, || {
            let set = Set::uniform(dimension, full)?;
            Ok(Self::of(set, Pitch::new(pitch)?))
        })
    }

    fn merge(&self, py: Python<'_>, other: PyRef<'_, Self>, op: &str) -> PyResult<Self> {
        let set = self.operated(py, &other, op, Set::merge)?;
        Ok(self.with(set))
    }

    /// Return the region inside closed outlines, given by segments; its tree is made on demand.
    #[classmethod]
    fn region(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        segments: PyReadonlyArray2<'_, f64>,
        pitch: i64,
        winding: &str,
    ) -> PyResult<Self> {
        let fail = |e| to_python(py, &e);
        let pitch = Pitch::new(pitch).map_err(fail)?;
        let rule = input::rule(winding).map_err(fail)?;
        let rows = crate::python::arrays::rows(&segments, "segments").map_err(fail)?;
        let set = run(py, 0, rows.len(), || {
            let outlines = input::outlines(&rows, pitch)?;
            Ok(Set::Plane(bounded(&outlines, rule)?.into()))
        })?;
        Ok(Self::of(set, pitch))
    }

    /// Return the result of a set operation by the faster method, merging trees or sweeping over boundaries.
    fn combined(&self, py: Python<'_>, other: PyRef<'_, Self>, op: &str) -> PyResult<Self> {
        let set = self.operated(py, &other, op, Set::combined)?;
        Ok(self.with(set))
    }

    /// Return the union of this region and others on the same lattice, by one sweep over all boundaries.
    fn composed(&self, py: Python<'_>, others: Vec<PyRef<'_, Self>>) -> PyResult<Self> {
        for other in &others {
            input::same_lattice(self.pitch, other.pitch).map_err(|e| to_python(py, &e))?;
        }
        let sets: Vec<&Set> = others.iter().map(|other| &other.set).collect();
        let size = sets.iter().map(|set| set.size()).sum();
        let all = || Set::composed(std::iter::once(&self.set).chain(sets));
        let operands: Vec<&Self> = others.iter().map(|other| &**other).collect();
        let set = run(py, 0, size, all).map_err(|e| self.with_report(py, e, &operands))?;
        Ok(self.with(set))
    }

    /// Return the result of an operation, and the steps of merging the trees: the kind of step, two numbers
    /// (the roots of two merged trees, or one node), the action, and the reason. Roots are nodes in preorder;
    /// −1 is an Out leaf, −2 an In leaf.
    fn merge_steps(
        &self,
        py: Python<'_>,
        other: PyRef<'_, Self>,
        op: &str,
    ) -> PyResult<(Self, Vec<StepRow>)> {
        let (set, steps) = self.operated(py, &other, op, Set::merge_steps)?;
        Ok((self.with(set), steps.iter().map(step_row).collect()))
    }

    /// Return the hyperplanes of the inner nodes in preorder: rows of normal and offset in lattice steps.
    fn hyperplanes(&self, py: Python<'_>) -> PyResult<Vec<Row>> {
        self.work(py, |set, _| set.hyperplanes())
    }

    fn equals(&self, py: Python<'_>, other: PyRef<'_, Self>) -> PyResult<bool> {
        self.compared(py, &other, Set::equals)
    }

    fn complement(&self, py: Python<'_>) -> PyResult<Self> {
        here(py, || Ok(self.with(self.set.complement())))
    }

    fn partitioned(&self, py: Python<'_>, hyperplane: Row) -> PyResult<Self> {
        let set = self.work(py, |set, _| set.partitioned(&hyperplane))?;
        Ok(self.with(set))
    }

    fn split(&self, py: Python<'_>, hyperplane: Row) -> PyResult<(Self, Self)> {
        let [minus, plus] = self.work(py, |set, _| set.split(&hyperplane))?;
        Ok((self.with(minus), self.with(plus)))
    }

    fn split_case(&self, py: Python<'_>, hyperplane: Row) -> PyResult<&'static str> {
        self.work(py, |set, _| set.split_case(&hyperplane))
    }

    fn condensed(&self, py: Python<'_>) -> PyResult<Self> {
        Ok(self.with(self.work(py, |set, _| set.condensed())?))
    }

    fn moved(&self, py: Python<'_>, axes: Vec<i64>, shift: Vec<i64>) -> PyResult<Self> {
        let map = input::lattice_map(self.set.dimension(), &axes, &shift)
            .map_err(|e| to_python(py, &e))?;
        Ok(self.with(self.work(py, |set, _| set.moved(&map))?))
    }

    fn refined(&self, py: Python<'_>, pitch: i64) -> PyResult<Self> {
        let finer = Pitch::new(pitch).map_err(|e| to_python(py, &e))?;
        let set = self.work(py, |set, own| set.refined(own, finer))?;
        Ok(Self::of(set, finer))
    }

    fn boundary<'py>(&self, py: Python<'py>) -> PyResult<Pieces<'py>> {
        let found = self.work(py, Set::boundary)?;
        pieces::arrays(py, found, self.set.dimension())
    }

    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Pieces<'py>> {
        let found = self.work(py, Set::edges)?;
        pieces::arrays(py, found, 2)
    }

    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Pieces<'py>> {
        let found = self.work(py, Set::cells)?;
        pieces::arrays(py, found, self.set.dimension())
    }

    fn outlines<'py>(&self, py: Python<'py>) -> PyResult<Pieces<'py>> {
        let found = outline_pieces(&self.loops(py)?, self.pitch);
        pieces::arrays(py, found, 2)
    }

    fn exact_outlines(&self, py: Python<'_>) -> PyResult<Vec<Vec<[Ratio; 2]>>> {
        let loops = self.loops(py)?;
        let corners = |outline| {
            let corners = exact_corners(outline, self.pitch).into_iter();
            corners.map(|p| p.map(ratio)).collect()
        };
        Ok(loops.iter().map(corners).collect())
    }

    fn measure(&self, py: Python<'_>) -> PyResult<Ratio> {
        self.work(py, Set::measure).map(ratio)
    }

    fn moments(&self, py: Python<'_>) -> PyResult<Vec<Ratio>> {
        Ok(self.work(py, Set::moments)?.map(ratio).into())
    }

    /// Return a lower and an upper bound of the area as fractions, far closer to each other than neighbouring
    /// doubles.
    fn area_bounds(&self, py: Python<'_>) -> PyResult<[Ratio; 2]> {
        Ok(self.work(py, Set::area_bounds)?.map(ratio))
    }

    /// Return for each point the nearest point of the boundary, in model units, rounded.
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points =
            crate::python::arrays::rows(&points, "points").map_err(|e| to_python(py, &e))?;
        let size = self.set.size() + points.len();
        let found = run(py, 0, size, || self.set.nearest(&points, self.pitch))
            .map_err(|e| self.with_report(py, e, &[self]))?;
        crate::python::arrays::array(py, found)
    }

    fn cast<'py>(
        &self,
        py: Python<'py>,
        origin: [f64; 2],
        direction: [f64; 2],
    ) -> PyResult<Pieces<'py>> {
        let found = self.work(py, |set, pitch| set.cast(origin, direction, pitch))?;
        pieces::arrays(py, found, 2)
    }

    fn classify<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let (columns, numbers) = (points.as_array().ncols(), flat(&points));
        let size = self.set.size() + points.as_array().nrows();
        let found = run(py, 0, size, || {
            self.set.classify(&numbers, columns, self.pitch)
        })
        .map_err(|e| self.with_report(py, e, &[self]))?;
        let sign = |location: &Location| match location {
            Location::In => 1i8,
            Location::On => 0,
            Location::Out => -1,
        };
        Ok(PyArray1::from_vec(py, found.iter().map(sign).collect()))
    }

    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Nodes<'py>> {
        self.set.nodes(py, self.pitch)
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let stats = self.work(py, |set, _| set.stats())?;
        let dict = PyDict::new(py);
        dict.set_item("nodes", stats.cuts)?;
        dict.set_item("leaves", stats.leaves)?;
        dict.set_item("depth", stats.depth)?;
        dict.set_item("fragments", stats.facets)?;
        Ok(dict)
    }

    fn dump<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = here(py, || self.set.to_bytes(self.pitch))?;
        Ok(PyBytes::new(py, &bytes))
    }

    #[classmethod]
    fn load(_cls: &Bound<'_, PyType>, py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let (set, pitch) = here(py, || Set::from_bytes(data))?;
        Ok(Self::of(set, pitch))
    }

    #[getter]
    fn dimension(&self) -> usize {
        self.set.dimension()
    }

    #[getter]
    fn pitch(&self) -> i64 {
        self.pitch.exponent()
    }

    #[getter]
    fn is_empty(&self) -> bool {
        self.set.uniform_label() == Some(false)
    }

    #[getter]
    fn is_full(&self) -> bool {
        self.set.uniform_label() == Some(true)
    }

    #[getter]
    fn is_bounded(&self, py: Python<'_>) -> PyResult<bool> {
        self.work(py, |set, _| Ok(set.is_bounded()))
    }
}
