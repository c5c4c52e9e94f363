//! The class `RayTree`: a tree of supporting hyperplanes of facets that grows where rays pass.

use num_bigint::BigInt;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use super::scene::{facets, Columns, HitArrays, ELEMENTS_PER_RAY};
use super::store;
use crate::arith::Int;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim2::Dim2;
use crate::geometry::spaces::dim3::Dim3;
use crate::mesh::grid::Pitch;
use crate::python::calls::errors::to_python;
use crate::python::calls::in_use::InUse;
use crate::python::calls::run::run;
use crate::python::hyperplanes::Row;
use crate::query::ray::Scene;
use crate::query::stab::batch::{test_rays, test_rays_watched};
use crate::query::stab::node::Growth;
use crate::query::stab::record::Record;
use crate::query::stab::tree::Shape;
use crate::query::stab::view::View;
use crate::query::stab::{Cast, StabEvent, StabTree, Trace};

enum Stabbed {
    Points(StabTree<Dim1, 1>),
    Segments(StabTree<Dim2, 2>),
    Triangles(StabTree<Dim3, 3>),
}

/// Evaluates an expression with the tree, in any dimension.
macro_rules! with_tree {
    ($stabbed:expr, $tree:ident => $body:expr) => {
        match $stabbed {
            Stabbed::Points($tree) => $body,
            Stabbed::Segments($tree) => $body,
            Stabbed::Triangles($tree) => $body,
        }
    };
}

/// The numbers of nodes, leaves and tests of each ray, one ray after the other.
type Counts<'py> = Bound<'py, PyArray1<i64>>;

/// A tree that grows where rays pass; several calls may test rays at the same time. See `_core.pyi`.
#[pyclass(frozen, module = "bspcsg._core")]
pub struct RayTree {
    tree: Stabbed,
    calls: InUse,
}

#[pymethods]
impl RayTree {
    /// Make a tree over facets.
    ///
    /// `hits` are initial counters; `threshold` is None for a tree that rays do not change; `limit` is the
    /// largest number of nodes of a tree that is completed at once, None for a tree of one leaf; `grown` is
    /// what `dump` returned for a tree over the same facets.
    #[new]
    #[pyo3(signature = (dimension, corners, pitch=None, threshold=None, hits=None, limit=None, grown=None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn new(
        py: Python<'_>,
        dimension: usize,
        corners: PyReadonlyArray1<'_, f64>,
        pitch: Option<i64>,
        threshold: Option<u64>,
        hits: Option<Vec<u64>>,
        limit: Option<usize>,
        grown: Option<&[u8]>,
    ) -> PyResult<Self> {
        let fail = |e: Error| to_python(py, &e);
        let pitch = pitch.map(Pitch::new).transpose().map_err(fail)?;
        let growth = threshold.map_or(Growth::Never, Growth::Visits);
        let flat = corners.as_slice()?;
        let record = grown.map(store::from_bytes).transpose().map_err(fail)?;
        let plan = Plan {
            flat,
            pitch,
            growth,
            hits,
            limit,
            record,
        };
        let tree = run(py, 0, flat.len(), || match dimension {
            1 => Ok(Stabbed::Points(plan.tree()?)),
            2 => Ok(Stabbed::Segments(plan.tree()?)),
            3 => Ok(Stabbed::Triangles(plan.tree()?)),
            _ => {
                let text = format!("rays are cast in 1, 2 or 3 dimensions, not in {dimension}");
                Err(Error::new(ErrorKind::Shape, text))
            }
        })?;
        let calls = InUse::default();
        Ok(Self { tree, calls })
    }

    #[getter]
    fn pitch(&self, py: Python<'_>) -> PyResult<i64> {
        self.read(
            py,
            |tree| with_tree!(tree, tree => tree.scene().pitch().exponent()),
        )
    }

    /// Return for each ray the first hit and its cost: the numbers of nodes, leaves and tests.
    fn test<'py>(
        &self,
        py: Python<'py>,
        origins: PyReadonlyArray1<'py, f64>,
        directions: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(HitArrays<'py>, Counts<'py>)> {
        let _call = self.calls.enter(py)?;
        let (origins, heads) = (origins.as_slice()?, directions.as_slice()?);
        let (columns, counts) = run(py, 0, origins.len() * ELEMENTS_PER_RAY, || {
            with_tree!(&self.tree, tree => {
                let (hits, traces) = test_rays(tree, origins, heads)?;
                Ok((Columns::of_first(&hits), counts(&traces)))
            })
        })?;
        Ok((columns.arrays(py), PyArray1::from_vec(py, counts)))
    }

    /// Return the first hit of a ray, its cost, and its steps. A step has a kind, a node, a facet, a count or
    /// flag, and for a division three lists: the facets in the cut, on its minus side and on its plus side.
    fn test_watched<'py>(
        &self,
        py: Python<'py>,
        origin: PyReadonlyArray1<'py, f64>,
        direction: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<(HitArrays<'py>, Counts<'py>, Vec<StabRow>)> {
        let _call = self.calls.enter(py)?;
        let (origin, head) = (origin.as_slice()?, direction.as_slice()?);
        let (columns, counts, events) = run(py, 0, ELEMENTS_PER_RAY, || {
            with_tree!(&self.tree, tree => {
                let mut events: Vec<StabEvent> = Vec::new();
                let (hits, traces) = test_rays_watched(tree, origin, head, &mut events)?;
                Ok((Columns::of_first(&hits), counts(&traces), events))
            })
        })?;
        let rows = events.into_iter().map(stab_row).collect();
        Ok((columns.arrays(py), PyArray1::from_vec(py, counts), rows))
    }

    /// Return the nodes in the order in which they were made, as columns; each leaf has the facets of its
    /// list, each inner node the facets in its cut.
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = self.read(
            py,
            |tree| with_tree!(tree, tree => NodeColumns::of(&tree.views())),
        )?;
        let dict = PyDict::new(py);
        for (name, column) in [
            ("visits", columns.visits),
            ("depth", columns.depth),
            ("minus", columns.minus),
            ("plus", columns.plus),
            ("offsets", columns.offsets),
            ("facets", columns.facets),
            ("hits", columns.hits),
        ] {
            dict.set_item(name, PyArray1::from_vec(py, column))?;
        }
        dict.set_item("hyperplanes", columns.rows)?;
        Ok(dict)
    }

    /// Return the cuts and counters of the tree as bytes; facets and threshold are not included.
    fn dump<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let record = self.read(py, |tree| with_tree!(tree, tree => tree.record()))?;
        let bytes = store::to_bytes(&record).map_err(|e| to_python(py, &e))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let shape = self.read(py, |tree| with_tree!(tree, tree => tree.shape()))?;
        let dict = PyDict::new(py);
        for (name, value) in named(&shape) {
            dict.set_item(name, value)?;
        }
        Ok(dict)
    }
}

impl RayTree {
    /// Reads the tree with the GIL released, because another thread that is changing the tree may need the
    /// GIL.
    fn read<T: Send>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&Stabbed) -> T + Send,
    ) -> PyResult<T> {
        let _call = self.calls.enter(py)?;
        run(py, 0, 0, || Ok(look(&self.tree)))
    }
}

/// A step of a ray: kind, node, facet, and a count or flag; for a division also the facets in the cut, on its
/// minus side and on its plus side.
type StabRow = (&'static str, u32, i64, u64, Option<[Vec<u32>; 3]>);

fn stab_row(event: StabEvent) -> StabRow {
    match event {
        StabEvent::Visit { node, visits, leaf } => {
            let kind = if leaf { "leaf" } else { "visit" };
            (kind, node.0, -1, visits, None)
        }
        StabEvent::Test { node, facet, met } => ("test", node.0, facet.into(), met.into(), None),
        StabEvent::Count { node, facet, hits } => ("count", node.0, facet.into(), hits, None),
        StabEvent::Divide {
            node,
            facet,
            coplanar,
            children,
            lists: [minus, plus],
        } => {
            let lists = Some([coplanar, minus, plus]);
            ("divide", node.0, facet.into(), children[0].0.into(), lists)
        }
    }
}

#[derive(Default)]
struct NodeColumns {
    visits: Vec<i64>,
    depth: Vec<i64>,
    minus: Vec<i64>,
    plus: Vec<i64>,
    offsets: Vec<i64>,
    facets: Vec<i64>,
    hits: Vec<i64>,
    /// The normal and the offset of each inner node's hyperplane, in lattice steps; empty for leaves.
    rows: Vec<Row>,
}

impl NodeColumns {
    fn of<const D: usize>(views: &[View<D>]) -> Self {
        let mut columns = Self::default();
        columns.offsets.push(0);
        for view in views {
            columns.visits.push(view.visits as i64);
            columns.depth.push(view.depth.into());
            let children = view.cut.map(|(_, _, children)| children.map(i64::from));
            let [minus, plus] = children.unwrap_or([-1; 2]);
            columns.minus.push(minus);
            columns.plus.push(plus);
            columns
                .facets
                .extend(view.facets.iter().map(|f| i64::from(*f)));
            columns.hits.extend(view.hits.iter().map(|h| *h as i64));
            columns.offsets.push(columns.facets.len() as i64);
            columns
                .rows
                .push(view.cut.map_or_else(Row::new, |(normal, offset, _)| {
                    let mut row: Row = normal.iter().map(|c| BigInt::from(*c)).collect();
                    row.push(-wide(&offset));
                    row
                }));
        }
        columns
    }
}

fn wide(value: &Int<3>) -> BigInt {
    let bytes: Vec<u8> = value.limbs().iter().flat_map(|l| l.to_le_bytes()).collect();
    BigInt::from_signed_bytes_le(&bytes)
}

struct Plan<'a> {
    flat: &'a [f64],
    pitch: Option<Pitch>,
    growth: Growth,
    hits: Option<Vec<u64>>,
    limit: Option<usize>,
    record: Option<Record>,
}

impl Plan<'_> {
    fn tree<S: Cast<D>, const D: usize>(&self) -> Result<StabTree<S, D>> {
        let scene = Scene::new(&facets(self.flat)?, self.pitch)?;
        if let Some(record) = &self.record {
            return StabTree::regrown(scene, self.growth, record);
        }
        let mut tree = StabTree::new(scene, self.growth, self.hits.as_deref())?;
        if let Some(limit) = self.limit {
            tree.complete(limit)?;
        }
        Ok(tree)
    }
}

fn counts(traces: &[Trace]) -> Vec<i64> {
    let row = |t: &Trace| [t.nodes, t.leaves, t.tests].map(i64::from);
    traces.iter().flat_map(row).collect()
}

fn named(shape: &Shape) -> [(&'static str, u64); 7] {
    [
        ("nodes", shape.nodes),
        ("leaves", shape.leaves),
        ("depth", shape.depth),
        ("fragments", shape.fragments),
        ("subdivisions", shape.subdivisions),
        ("rays", shape.rays),
        ("visits", shape.visits),
    ]
}
