//! The class `Tree`: an immutable exact solid.

use std::sync::{Arc, OnceLock};

use num_bigint::BigInt;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyType};

use super::arrays::{array, rows, wide};
use super::calls::errors::{to_python, with_report};
use super::calls::run::{here, run, MIN_ELEMENTS_FOR_POOL};
use super::hyperplanes::{coefficients, row_of, Row};
use crate::error::panics::caught;
use crate::error::{Error, ErrorKind, Result};
use crate::extract::boundary::collect::has_no_boundary;
use crate::extract::joining::patches::Patches;
use crate::extract::mesh::Mesh;
use crate::extract::rounding::round;
use crate::extract::rounding::snapping::crosses_once_snapped;
use crate::extract::simplify::result::simplified;
use crate::geometry::plane::Lattice;
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::spaces::motion::Motion;
use crate::interrupt::poll;
use crate::merge::descent::counters::Counters;
use crate::merge::evaluate::{blamed_on_snapshot, evaluate, normalize, union_with_itself};
use crate::merge::expression::{Expression, Term};
use crate::merge::profile::{Declined, KernelCount};
use crate::merge::rule::Rule;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::grid::{snap_point, Pitch};
use crate::mesh::half_space::{bounding_plane, half_space};
use crate::mesh::import::import;
use crate::mesh::triangles::TriangleMesh;
use crate::query::classify::{classify, Location};
use crate::query::contact::{divided, surfaces_and_euler_number, surfaces_meet};
use crate::query::measure::{volume_near, volume_residues, volume_rounded, volume_within};
use crate::query::planes::supporting_planes;
use crate::query::region::section::Sections;
use crate::store::snapshot::Snapshot;
use crate::tree::solid::Solid;
use crate::tree::stats::{stats, Stats};
use crate::tree::work::{work, work_to_settle};

type Corners = ((f64, f64, f64), (f64, f64, f64));

type SourceArrays<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray1<i64>>,
);

type MeshArrays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>);

/// An immutable exact solid: a partition tree. See `_core.pyi`.
#[pyclass(frozen, module = "bspcsg._core")]
pub struct Tree {
    solid: Solid,
    patches: Patches,
    counters: Option<Counters>,
    rounded: OnceLock<Rounded>,
    counts: OnceLock<(usize, i64)>,
}

/// The rounded mesh of a tree, with its arrays in Python.
struct Rounded {
    /// The patches whose polygons the mesh is made of.
    patches: Patches,
    vertices: Py<PyArray2<f64>>,
    triangles: Py<PyArray2<i64>>,
    origins: Vec<[u32; 2]>,
    flips: Vec<bool>,
    findings: Vec<Finding>,
}

impl Tree {
    fn of(solid: Solid) -> Self {
        Self {
            solid,
            patches: Patches::default(),
            counters: None,
            rounded: OnceLock::new(),
            counts: OnceLock::new(),
        }
    }

    fn given(&self) -> Option<&TriangleMesh> {
        let mut sources = self.solid.sources().iter();
        let (Some(source), None) = (sources.next(), sources.next()) else {
            return None;
        };
        source.mesh().filter(|_| source.is_as_given())
    }

    /// Runs the work of a method; the report of a defect contains the solid.
    fn run<T: Send>(
        &self,
        py: Python<'_>,
        method: &str,
        threads: usize,
        size: usize,
        work: impl FnOnce() -> Result<T> + Send,
    ) -> PyResult<T> {
        let blamed_on_snapshot = || caught(work).map_err(|e| blamed_on_snapshot(&self.solid, e));
        run(py, threads, size, blamed_on_snapshot).map_err(|e| {
            with_report(py, e, &format!("Tree.{method}"), || {
                let inputs = PyDict::new(py);
                let operand = Bound::new(py, Self::of(self.solid.clone()))?;
                inputs.set_item("operand-0", operand)?;
                Ok(inputs)
            })
        })
    }

    fn is_bare(&self, py: Python<'_>) -> PyResult<bool> {
        let bare = || Ok(has_no_boundary(&self.solid));
        self.run(py, "is_empty", 0, self.size(), bare)
    }

    fn size(&self) -> usize {
        work(std::slice::from_ref(&self.solid), MIN_ELEMENTS_FOR_POOL)
    }

    fn rounded(&self, py: Python<'_>, threads: usize) -> PyResult<&Rounded> {
        if let Some(rounded) = self.rounded.get() {
            return Ok(rounded);
        }
        let (mesh, triangles) = self.run(py, "to_mesh", threads, self.size(), || {
            let mesh = round::mesh_of_patches(&self.solid, &self.patches)?;
            let triangles = wide(&mesh.triangles);
            Ok((mesh, triangles))
        })?;
        let Mesh {
            vertices,
            origins,
            flips,
            findings,
            patches,
            ..
        } = mesh;
        let rounded = Rounded {
            patches,
            vertices: array(py, vertices)?.unbind(),
            triangles: array(py, triangles)?.unbind(),
            origins,
            flips,
            findings,
        };
        Ok(self.rounded.get_or_init(|| rounded))
    }

    /// The patches whose polygons the rounded mesh is made of.
    fn made_patches(&self, py: Python<'_>) -> PyResult<&Patches> {
        Ok(&self.rounded(py, 0)?.patches)
    }
}

/// Makes the finding that an operand's coordinates were rounded to a coarser lattice.
fn operand_rounded(text: String) -> Finding {
    Finding::about("operand_rounded", Severity::Note, &[0], text)
}

#[pymethods]
impl Tree {
    #[classmethod]
    #[pyo3(signature = (vertices, faces, pitch=None, trusted=false, rounded=None))]
    fn from_mesh(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        faces: PyReadonlyArray2<'_, i64>,
        pitch: Option<i64>,
        trusted: bool,
        rounded: Option<String>,
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let vertices = rows(&vertices, "vertices").map_err(fail)?;
        let faces = rows(&faces, "faces").map_err(fail)?;
        let pitch = pitch.map(Pitch::new).transpose().map_err(fail)?;
        let source = run(py, 0, faces.len(), || import(&vertices, &faces, pitch)).map_err(|e| {
            with_report(py, e, "Tree.from_mesh", || {
                let inputs = PyDict::new(py);
                inputs.set_item("vertices", array(py, vertices.to_vec())?)?;
                inputs.set_item("faces", array(py, faces.to_vec())?)?;
                inputs.set_item("pitch", pitch.map(Pitch::exponent))?;
                Ok(inputs)
            })
        })?;
        let source = source.with_findings(rounded.map(operand_rounded).into_iter().collect());
        Ok(Self::of(Solid::of_source(Arc::new(source), trusted)))
    }

    #[classmethod]
    #[pyo3(signature = (hyperplane, pitch, rounded=None))]
    fn half_space(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        hyperplane: Row,
        pitch: i64,
        rounded: Option<String>,
    ) -> PyResult<Self> {
        here(py, || {
            let (normal, offset) = coefficients(&hyperplane)?;
            let source = half_space(normal, &offset, Pitch::new(pitch)?, rounded)?;
            Ok(Self::of(Solid::of_source(Arc::new(source), true)))
        })
    }

    #[classmethod]
    fn empty(_cls: &Bound<'_, PyType>, py: Python<'_>, pitch: i64) -> PyResult<Self> {
        here(py, || {
            Ok(Self::of(Solid::uniform(Pitch::new(pitch)?, false)))
        })
    }

    #[classmethod]
    fn full(_cls: &Bound<'_, PyType>, py: Python<'_>, pitch: i64) -> PyResult<Self> {
        here(py, || {
            Ok(Self::of(Solid::uniform(Pitch::new(pitch)?, true)))
        })
    }

    #[classmethod]
    #[pyo3(signature = (program, operands, threads=0))]
    fn evaluate(
        _cls: &Bound<'_, PyType>,
        py: Python<'_>,
        program: Bound<'_, PyAny>,
        operands: Vec<PyRef<'_, Self>>,
        threads: usize,
    ) -> PyResult<Self> {
        let lines: Vec<(String, Vec<u32>)> = program.extract()?;
        let terms = lines
            .into_iter()
            .map(|(name, arguments)| term(&name, arguments))
            .collect::<Result<Vec<_>>>();
        let expression = terms
            .and_then(Expression::new)
            .map_err(|e| to_python(py, &e))?;
        let solids: Vec<Solid> = operands.iter().map(|o| o.solid.clone()).collect();
        let (solid, counters) = run(py, threads, work(&solids, MIN_ELEMENTS_FOR_POOL), || {
            evaluate(&expression, &solids)
        })
        .map_err(|e| {
            with_report(py, e, "Tree.evaluate", || {
                let inputs = PyDict::new(py);
                inputs.set_item("program", &program)?;
                for (k, solid) in solids.iter().enumerate() {
                    let operand = Bound::new(py, Self::of(solid.clone()))?;
                    inputs.set_item(format!("operand-{k}"), operand)?;
                }
                Ok(inputs)
            })
        })?;
        Ok(Self {
            counters: Some(counters),
            ..Self::of(solid)
        })
    }

    #[pyo3(signature = (rule="positive", threads=0))]
    fn normalized(&self, py: Python<'_>, rule: &str, threads: usize) -> PyResult<Self> {
        let rule = match rule {
            "positive" => Rule::Positive,
            "nonzero" => Rule::Nonzero,
            "even-odd" => Rule::EvenOdd,
            _ => {
                let text =
                    format!("'{rule}' is not a winding rule; use positive, nonzero or even-odd");
                return Err(to_python(py, &Error::new(ErrorKind::Shape, text)));
            }
        };
        if rule == Rule::Positive {
            let size = work_to_settle(&self.solid);
            let union_with_itself = || union_with_itself(&self.solid);
            if let Some(solid) = self.run(py, "normalized", threads, size, union_with_itself)? {
                return Ok(Self::of(solid));
            }
        }
        let solid = self.run(py, "normalized", threads, self.size(), || {
            normalize(&self.solid, rule)
        })?;
        Ok(Self::of(solid))
    }

    /// Return the solid of the mesh without short edges and slivers (triangles no higher than the tolerance);
    /// None if none can be removed.
    #[pyo3(signature = (tolerance, threads=0))]
    fn simplified(&self, py: Python<'_>, tolerance: f64, threads: usize) -> PyResult<Option<Self>> {
        let work = || simplified(&self.solid, tolerance);
        let solid = self.run(py, "simplified", threads, self.size(), work)?;
        Ok(solid.map(Self::of))
    }

    /// Return whether the surface contains every wall between inside and outside exactly once and no other
    /// faces; None if that was not checked yet.
    #[getter]
    fn simple(&self) -> Option<bool> {
        let known = self.solid.is_reduced() || self.solid.simple().get().is_some();
        known.then(|| self.solid.is_reduced())
    }

    #[pyo3(signature = (threads=0))]
    fn to_mesh<'py>(&self, py: Python<'py>, threads: usize) -> PyResult<MeshArrays<'py>> {
        let mesh = self.rounded(py, threads)?;
        Ok((
            mesh.vertices.bind(py).clone(),
            mesh.triangles.bind(py).clone(),
        ))
    }

    /// Return for each triangle of the mesh the index (slot) of its source, and the number of its face in the
    /// input.
    fn origins<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        array(py, wide(&self.rounded(py, 0)?.origins))
    }

    /// Return for each triangle of the mesh whether it is oriented opposite to its source's face.
    fn flips<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let flips = self.rounded(py, 0)?.flips.clone();
        Ok(PyArray1::from_vec(py, flips))
    }

    /// Return the same solid, but its mesh will not join faces of different patches; `patches` has for each
    /// source the patch number of each input face, or None.
    fn patched(&self, patches: Vec<Option<PyReadonlyArray1<'_, u32>>>) -> PyResult<Self> {
        let copied = |one: PyReadonlyArray1<'_, u32>| one.as_slice().map(<[u32]>::to_vec);
        let patches = patches
            .into_iter()
            .map(|one| one.map(copied).transpose())
            .collect::<Result<_, _>>()?;
        Ok(Self {
            patches: Patches::new(patches),
            ..Self::of(self.solid.clone())
        })
    }

    /// Return an input mesh on the lattice: its original doubles, its lattice vertices, its faces, and the
    /// numbers of these faces in the input; None for a half-space.
    fn source_arrays<'py>(
        &self,
        py: Python<'py>,
        slot: usize,
    ) -> PyResult<Option<SourceArrays<'py>>> {
        let Some(source) = self.solid.sources().iter().nth(slot) else {
            return Ok(None);
        };
        let Some(mesh) = source.mesh() else {
            return Ok(None);
        };
        let pitch = source.pitch();
        let place = |p: &Lattice| p.map(|k| pitch.coordinate(k));
        let numbers: Vec<i64> = source
            .face_ids()
            .map(|face| i64::from(source.number(face)))
            .collect();
        Ok(Some((
            array(py, mesh.doubles.clone())?,
            array(py, mesh.vertices.iter().map(place).collect())?,
            array(py, wide(&mesh.faces))?,
            PyArray1::from_vec(py, numbers),
        )))
    }

    /// Return whether the input meshes stay closed however their corners are rounded: no face was left out,
    /// no corner lies inside an edge of another face, and welded corners have equal doubles.
    #[getter]
    fn closes_when_moved(&self) -> bool {
        let mut sources = self.solid.sources().iter();
        sources.all(|source| source.closes_when_moved())
    }

    /// Return whether the solid is one input mesh with all faces unchanged.
    #[getter]
    fn holds_given(&self) -> bool {
        self.given().is_some()
    }

    /// Return the arrays of the input mesh, if the solid is one input mesh with unchanged faces.
    fn given_arrays<'py>(&self, py: Python<'py>) -> PyResult<MeshArrays<'py>> {
        let mesh = self.run(py, "given_arrays", 0, 0, || {
            let text = "the solid is not one unchanged input mesh, so no given arrays exist";
            self.given().ok_or_else(|| Error::internal(text))
        })?;
        Ok((
            array(py, mesh.doubles.clone())?,
            array(py, wide(&mesh.faces))?,
        ))
    }

    #[getter]
    fn sources(&self) -> Vec<u64> {
        self.solid.sources().iter().map(|s| s.id()).collect()
    }

    /// Return for each source whether its faces may bound the solid.
    #[getter]
    fn named(&self) -> Vec<bool> {
        let names = self.solid.source_ids();
        let sources = self.solid.sources().iter();
        sources.map(|s| names.contains(&s.id())).collect()
    }

    #[getter]
    fn source_id(&self) -> Option<u64> {
        self.solid.sources().iter().next().map(|s| s.id())
    }

    /// Return the largest distance, over all input meshes, by which snapping to the lattice changed a
    /// coordinate.
    #[getter]
    fn snapped_by(&self) -> f64 {
        let sources = self.solid.sources();
        let of_each = sources
            .iter()
            .filter_map(|s| Some(s.mesh()?.snapped_by(s.pitch())));
        of_each.fold(0.0, f64::max)
    }

    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let all = || self.solid.sources().iter().flat_map(|s| s.findings());
        let all: Vec<Finding> = self.run(py, "findings", 0, self.size(), || Ok(all().collect()))?;
        all.iter().map(|f| finding(py, f)).collect()
    }

    fn mesh_findings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let mesh = self.rounded(py, 0)?;
        mesh.findings.iter().map(|f| finding(py, f)).collect()
    }

    fn volume6_exact(&self, py: Python<'_>, most_bits: u64) -> PyResult<(BigInt, BigInt)> {
        let volume = || volume_within(&self.solid, most_bits);
        let fraction = self.run(py, "volume6_exact", 0, self.size(), volume)?;
        Ok((fraction.numerator, fraction.denominator))
    }

    /// Return the double nearest to the volume; None if the cached sums are not exact enough to decide it.
    fn volume_rounded(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.run(py, "volume_rounded", 0, 0, || {
            Ok(volume_rounded(&self.solid))
        })
    }

    fn volume_near(&self, py: Python<'_>) -> PyResult<(BigInt, BigInt)> {
        let volume = || volume_near(&self.solid);
        let fraction = self.run(py, "volume_near", 0, self.size(), volume)?;
        Ok((fraction.numerator, fraction.denominator))
    }

    fn volume_residues(&self, py: Python<'_>) -> PyResult<Option<(u64, u64)>> {
        let volume = || volume_residues(&self.solid);
        let residues = self.run(py, "volume_residues", 0, self.size(), volume)?;
        Ok(residues.map(Into::into))
    }

    fn classify<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i8>>> {
        let points = rows(&points, "points").map_err(|e| to_python(py, &e))?;
        let size = self.size() + points.len();
        let found = self.run(py, "classify", 0, size, || {
            let pitch = self.solid.pitch();
            let points = points
                .iter()
                .map(|p| {
                    poll();
                    snap_point(pitch, p)
                })
                .collect::<Result<Vec<_>>>()?;
            classify(&self.solid, &points)
        })?;
        let sign = |l: &Location| match l {
            Location::Inside => 1i8,
            Location::Boundary => 0,
            Location::Outside => -1,
        };
        Ok(PyArray1::from_vec(py, found.iter().map(sign).collect()))
    }

    fn sections<'py>(
        &self,
        py: Python<'py>,
        hyperplanes: Vec<Row>,
    ) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let pitch = self.solid.pitch();
        let found = self.run(py, "sections", 0, self.size(), || {
            let boundary = Sections::of(&self.solid)?;
            let section = |row: &Row| {
                let (normal, offset) = coefficients(row)?;
                boundary.by(&bounding_plane(normal, &offset)?)
            };
            hyperplanes.iter().map(section).collect::<Result<Vec<_>>>()
        })?;
        let row =
            |[[a, b, c], [d, e, f]]: [[i64; 3]; 2]| [a, b, c, d, e, f].map(|k| pitch.coordinate(k));
        let rows = |edges: Vec<_>| array(py, edges.into_iter().map(row).collect());
        found.into_iter().map(rows).collect()
    }

    /// Return the planes of the surface, each once, with the solid on the minus side.
    fn planes(&self, py: Python<'_>) -> PyResult<Vec<Row>> {
        let planes = || supporting_planes(&self.solid);
        let planes = self.run(py, "planes", 0, self.size(), planes)?;
        Ok(planes.iter().map(row_of::<Dim3>).collect())
    }

    /// Return whether the surfaces of this solid and another one on the same lattice have a common point.
    fn meets(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let size = self.size() + other.size();
        let meet = || surfaces_meet(&self.solid, &other.solid);
        self.run(py, "meets", 0, size, meet)
    }

    /// Return the same solid, but its mesh will divide faces at all edges in which the surface touches itself;
    /// None if its mesh already does.
    fn divided(&self, py: Python<'_>) -> PyResult<Option<Self>> {
        let patches = self.made_patches(py)?;
        let divided = || divided(&self.solid, patches);
        let divided = self.run(py, "divided", 0, self.size(), divided)?;
        Ok(divided.map(|patches| Self {
            patches,
            ..Self::of(self.solid.clone())
        }))
    }

    /// Return the number of connected surfaces and the Euler number of the boundary of a reduced solid, divided
    /// at all edges in which it touches itself.
    fn surfaces_and_euler_number(&self, py: Python<'_>) -> PyResult<(usize, i64)> {
        if let Some(known) = self.counts.get() {
            return Ok(*known);
        }
        let divided = self.divided(py)?;
        let patches = divided.as_ref().unwrap_or(self).made_patches(py)?;
        let counts = || surfaces_and_euler_number(&self.solid, patches);
        let counts = self.run(py, "surfaces_and_euler_number", 0, self.size(), counts)?;
        Ok(*self.counts.get_or_init(|| counts))
    }

    #[getter]
    fn is_empty(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.is_bare(py)? && self.solid.root().outside <= 0)
    }

    #[getter]
    fn is_full(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.is_bare(py)? && self.solid.root().outside > 0)
    }

    #[getter]
    fn is_bounded(&self, py: Python<'_>) -> PyResult<bool> {
        match self.rounded(py, 0) {
            Ok(_) => Ok(true),
            Err(e) if e.value(py).getattr("code")?.extract::<String>()? == "unbounded" => Ok(false),
            Err(e) => Err(e),
        }
    }

    #[getter]
    fn bounds(&self, py: Python<'_>) -> PyResult<Option<Corners>> {
        let vertices = self.rounded(py, 0)?.vertices.bind(py).readonly();
        let rows = rows(&vertices, "vertices").map_err(|e| to_python(py, &e))?;
        let Some(first) = rows.first() else {
            return Ok(None);
        };
        let (mut low, mut high) = (*first, *first);
        for p in rows.iter() {
            low = [0, 1, 2].map(|i| low[i].min(p[i]));
            high = [0, 1, 2].map(|i| high[i].max(p[i]));
        }
        Ok(Some((low.into(), high.into())))
    }

    #[getter]
    fn pitch(&self) -> i64 {
        self.solid.pitch().exponent()
    }

    /// Return whether a motion of the lattice would make a mesh of the solid cross itself, because vertices
    /// get the doubles of their lattice points instead of their own.
    fn moving_crosses(&self, py: Python<'_>, axes: [i64; 3], shift: [i64; 3]) -> PyResult<bool> {
        let motion = motion(axes, shift).map_err(|e| to_python(py, &e))?;
        let crosses = || Ok(crosses_once_snapped(&self.solid, motion.shifted()));
        self.run(py, "moving_crosses", 0, self.size(), crosses)
    }

    fn moved(&self, py: Python<'_>, axes: [i64; 3], shift: [i64; 3]) -> PyResult<Self> {
        let motion = motion(axes, shift).map_err(|e| to_python(py, &e))?;
        self.run(py, "moved", 0, self.size(), || {
            Ok(Self::of(Snapshot::image(&self.solid, &motion)?))
        })
    }

    /// Return the same solid, with a new identity for each of its sources.
    fn renamed(&self, py: Python<'_>) -> PyResult<Self> {
        let renamed = || Ok(Self::of(self.solid.renamed()));
        self.run(py, "renamed", 0, self.size(), renamed)
    }

    fn refined(&self, py: Python<'_>, pitch: i64) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let finer = Pitch::new(pitch).map_err(fail)?;
        if finer == self.solid.pitch() {
            return Ok(Self::of(self.solid.clone()));
        }
        self.run(py, "refined", 0, self.size(), || {
            let data = Snapshot::of(&self.solid).refined(finer)?;
            Ok(Self::of(data.solid()?))
        })
    }

    fn dump<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = || Snapshot::of(&self.solid).to_bytes();
        let bytes = self.run(py, "dump", 0, self.size(), bytes)?;
        Ok(PyBytes::new(py, &bytes))
    }

    #[classmethod]
    fn load(_cls: &Bound<'_, PyType>, py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        let solid = || Snapshot::solid_from_bytes(data);
        Ok(Self::of(run(py, 0, data.len(), solid)?))
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let Stats {
            nodes,
            leaves,
            deferred,
            elements,
            parts,
            depth,
        } = stats(&self.solid);
        for (name, value) in [
            ("nodes", nodes),
            ("leaves", leaves),
            ("deferred", deferred),
            ("elements", elements),
            ("parts", parts),
            ("depth", depth),
        ] {
            dict.set_item(name, value)?;
        }
        if let Some(counters) = &self.counters {
            for (name, value) in counters.named() {
                dict.set_item(name, value)?;
            }
        }
        Ok(dict)
    }

    /// Return the stages of the evaluation that made the tree, each with name, seconds and count, and the
    /// reason why the tree was made by dividing space (descent) and not by an arrangement of all faces; None
    /// without such a reason.
    fn profile(&self) -> (Vec<(&'static str, f64, usize)>, Option<&'static str>) {
        let Some(counters) = &self.counters else {
            return (Vec::new(), None);
        };
        let profile = &counters.profile;
        let stages = profile.stages.iter().map(|s| (s.name, s.seconds, s.count));
        (stages.collect(), profile.declined.map(Declined::text))
    }

    /// Return the kernels of the evaluation that made the tree, each with its name, how often it was asked
    /// and took a cell, and the reasons why it refused, with their counts.
    fn kernels(&self) -> Vec<KernelRow> {
        let counts = self.counters.iter().flat_map(Counters::kernel_counts);
        let row = |kernel: KernelCount| (kernel.name, kernel.asked(), kernel.took, kernel.refused);
        counts.map(row).collect()
    }
}

/// The name of a kernel, how often it was asked and took a cell, and the reasons why it refused.
type KernelRow = (&'static str, u64, u64, Vec<(&'static str, u64)>);

fn term(name: &str, arguments: Vec<u32>) -> Result<Term> {
    match (name, arguments.as_slice()) {
        ("leaf", [k]) => Ok(Term::Operand(*k)),
        ("not", [a]) => Ok(Term::Not(*a)),
        ("or", _) => Ok(Term::Or(arguments)),
        ("and", _) => Ok(Term::And(arguments)),
        ("xor", _) => Ok(Term::Xor(arguments)),
        _ => {
            let text = format!(
                "'{name}' with {} arguments is not a line of an expression; use leaf or not with one \
                 argument, or or, and, xor with any number",
                arguments.len()
            );
            Err(Error::new(ErrorKind::Shape, text))
        }
    }
}

fn motion(axes: [i64; 3], shift: [i64; 3]) -> Result<Motion> {
    Motion::of_axes(&axes, &shift).ok_or_else(|| {
        let text = format!("the axes {axes:?} must contain 1, 2 and 3 once each, with either sign");
        Error::new(ErrorKind::Shape, text)
    })
}

fn finding<'py>(py: Python<'py>, finding: &Finding) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("code", finding.code)?;
    dict.set_item("severity", finding.severity.name())?;
    dict.set_item("count", finding.count)?;
    dict.set_item("where", &finding.place)?;
    dict.set_item("message", &finding.message)?;
    Ok(dict)
}
