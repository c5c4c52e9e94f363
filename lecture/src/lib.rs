//! The core as the lecture page calls it: trees, orders, rays and merges as JSON.
//!
//! Nothing is decided here: every function hands lattice points to the core and writes down what
//! comes back. `scripts/lecture_bundle` compiles this crate to WebAssembly.

mod growing;
mod scene;
mod sets;
mod shield;
mod units;

use bspcsg::error::{Error, ErrorKind, Result};
use bspcsg::geometry::spaces::affine::Affine;
use bspcsg::geometry::spaces::dim1::Dim1;
use bspcsg::geometry::spaces::dim2::Dim2;
use bspcsg::geometry::spaces::dim3::Dim3;
use serde::Serialize;
use wasm_bindgen::prelude::*;

use growing::Growing;
use scene::Scene;
use sets::Outline;

/// A value as text, an error as JavaScript's.
fn told<T: Serialize>(value: Result<T>) -> std::result::Result<String, JsError> {
    let value = value.map_err(|e| JsError::new(e.message()))?;
    serde_json::to_string(&value).map_err(|e| JsError::new(&e.to_string()))
}

fn made<T>(value: Result<T>) -> std::result::Result<T, JsError> {
    value.map_err(|e| JsError::new(e.message()))
}

enum Inner {
    Line(Scene<Dim1>),
    Plane(Scene<Dim2>),
    Space(Scene<Dim3>),
}

macro_rules! each {
    ($inner:expr, $scene:ident => $body:expr) => {
        match $inner {
            Inner::Line($scene) => $body,
            Inner::Plane($scene) => $body,
            Inner::Space($scene) => $body,
        }
    };
}

/// Facets and their autopartition in the order given.
#[wasm_bindgen]
pub struct Autopartition(Inner);

#[wasm_bindgen]
impl Autopartition {
    /// Facet i owns the corners `offsets[i]..offsets[i + 1]`; `room` is the lowest and the highest
    /// corner of the root's region.
    #[wasm_bindgen(constructor)]
    pub fn new(
        dimension: usize,
        corners: Vec<f64>,
        offsets: Vec<i32>,
        room: Vec<f64>,
    ) -> std::result::Result<Autopartition, JsError> {
        let offsets: Vec<i64> = offsets.into_iter().map(i64::from).collect();
        made(Self::of(dimension, &corners, &offsets, &room))
    }

    fn of(dimension: usize, corners: &[f64], offsets: &[i64], room: &[f64]) -> Result<Self> {
        Ok(Self(match dimension {
            1 => Inner::Line(Scene::new(corners, offsets, room)?),
            2 => Inner::Plane(Scene::new(corners, offsets, room)?),
            3 => Inner::Space(Scene::new(corners, offsets, room)?),
            _ => return Err(Error::new(ErrorKind::Shape, "dimensions are 1, 2 and 3")),
        }))
    }

    /// The tree with its regions.
    pub fn view(&self) -> std::result::Result<String, JsError> {
        each!(&self.0, scene => told(Ok(scene.view())))
    }

    /// The nodes from the farthest to the nearest, and the eye's sides.
    pub fn order(&self, x: f64, y: f64, z: f64) -> std::result::Result<String, JsError> {
        each!(&self.0, scene => told(Ok(scene.order([x, y, z]))))
    }

    /// Fragments and cuts of random orders.
    pub fn orders(&self, trials: u32, seed: u32) -> std::result::Result<String, JsError> {
        each!(&self.0, scene => told(scene.orders(trials, u64::from(seed))))
    }

    /// Return the number of the tree's fragments.
    pub fn fragments(&self) -> usize {
        each!(&self.0, scene => scene.fragments())
    }

    /// The trees of the policies.
    pub fn policies(&self, seed: u32) -> std::result::Result<String, JsError> {
        each!(&self.0, scene => told(scene.policies(u64::from(seed))))
    }

    /// Return the first facet that a ray meets, and its steps through the tree.
    pub fn shoot(
        &self,
        x: f64,
        y: f64,
        z: f64,
        towards_x: f64,
        towards_y: f64,
        towards_z: f64,
    ) -> std::result::Result<String, JsError> {
        let (from, towards) = ([x, y, z], [towards_x, towards_y, towards_z]);
        each!(&self.0, scene => told(scene.shoot(&from, &towards)))
    }

    /// For each segment how many shield it from the line of segment `i`, and where that meets it.
    pub fn shields(&self, i: usize) -> std::result::Result<String, JsError> {
        let Inner::Plane(scene) = &self.0 else {
            return told(Ok(()));
        };
        let segment = |f: &bspcsg::mesh::facets::Facet| Dim2::fragment(&f.corners);
        let segments: Option<Vec<_>> = scene.facets().iter().map(segment).collect();
        let found = shield::shields(&segments.unwrap_or_default(), i);
        let on_page = |at: [f64; 2]| at.map(|k| k / units::STEPS);
        let found: Vec<_> = found
            .into_iter()
            .map(|row| row.map(|(count, at)| (count, on_page(at))))
            .collect();
        told(Ok(found))
    }
}

/// A self-organising tree over segments of the plane.
#[wasm_bindgen]
pub struct SelfOrganising(Growing);

#[wasm_bindgen]
impl SelfOrganising {
    /// One leaf that is divided after more than `threshold` visits; with a threshold of zero a
    /// complete tree, facets with most `hits` first.
    #[wasm_bindgen(constructor)]
    pub fn new(
        corners: Vec<f64>,
        room: Vec<f64>,
        threshold: u32,
        hits: Vec<u32>,
    ) -> std::result::Result<SelfOrganising, JsError> {
        let threshold = (threshold > 0).then_some(u64::from(threshold));
        let hits: Vec<u64> = hits.into_iter().map(u64::from).collect();
        made(Growing::new(&corners, &room, threshold, &hits).map(Self))
    }

    /// Tests one ray.
    pub fn shoot(
        &mut self,
        x: f64,
        y: f64,
        towards_x: f64,
        towards_y: f64,
    ) -> std::result::Result<String, JsError> {
        told(self.0.shoot([x, y], [towards_x, towards_y]))
    }

    /// All nodes with regions and counters.
    pub fn view(&self) -> std::result::Result<String, JsError> {
        told(Ok(self.0.view()))
    }
}

/// A set's tree split by the hyperplane through some points.
#[wasm_bindgen]
pub fn split(
    dimension: usize,
    corners: Vec<f64>,
    offsets: Vec<i32>,
    points: Vec<f64>,
    room: Vec<f64>,
) -> std::result::Result<String, JsError> {
    let set = Outline {
        corners: &corners,
        offsets: &offsets,
    };
    told(match dimension {
        1 => sets::split::<Dim1>(&set, &points, &room),
        2 => sets::split::<Dim2>(&set, &points, &room),
        _ => sets::split::<Dim3>(&set, &points, &room),
    })
}

/// The trees of two sets merged.
#[wasm_bindgen]
#[allow(clippy::too_many_arguments)]
pub fn merge(
    dimension: usize,
    a_corners: Vec<f64>,
    a_offsets: Vec<i32>,
    b_corners: Vec<f64>,
    b_offsets: Vec<i32>,
    operation: &str,
    room: Vec<f64>,
) -> std::result::Result<String, JsError> {
    let a = Outline {
        corners: &a_corners,
        offsets: &a_offsets,
    };
    let b = Outline {
        corners: &b_corners,
        offsets: &b_offsets,
    };
    told(match dimension {
        1 => sets::merge::<Dim1>([&a, &b], operation, &room),
        2 => sets::merge::<Dim2>([&a, &b], operation, &room),
        _ => sets::merge::<Dim3>([&a, &b], operation, &room),
    })
}
