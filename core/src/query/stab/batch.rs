//! Tests rays in a stab tree one after another, because a ray may change the tree before the next is tested.

use super::cast::Cast;
use super::trace::{StabEvent, Trace};
use super::tree::StabTree;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::poll;
use crate::query::ray::answer::{hit, Hit};
use crate::query::ray::Ray;
use crate::tree::trace::Watcher;

/// The first hit of each ray, and the cost of finding it, in the order of the rays.
pub type Tested<const D: usize> = (Vec<Option<Hit<D>>>, Vec<Trace>);

/// Tests rays, given by flat arrays of origins and directions, in their order.
///
/// # Errors
/// `Shape`; `NonFinite`, `TooLarge`, `BadNormal` with the ray's number, before any ray is tested.
pub fn test_rays<S: Cast<D>, const D: usize>(
    tree: &StabTree<S, D>,
    origins: &[f64],
    directions: &[f64],
) -> Result<Tested<D>> {
    test_rays_watched(tree, origins, directions, &mut ())
}

/// Tests rays as [`test_rays`] does, and reports each step to `watcher`.
///
/// # Errors
/// As for [`test_rays`].
pub fn test_rays_watched<S: Cast<D>, const D: usize>(
    tree: &StabTree<S, D>,
    origins: &[f64],
    directions: &[f64],
    watcher: &mut impl Watcher<StabEvent>,
) -> Result<Tested<D>> {
    let rays = rays(tree, origins, directions)?;
    let mut hits = Vec::with_capacity(rays.len());
    let mut traces = Vec::with_capacity(rays.len());
    for ray in rays {
        poll();
        let (found, trace) = tree.test_ray_watched(&ray, watcher);
        hits.push(found.map(|f| hit(tree.scene(), &ray, &f)));
        traces.push(trace);
    }
    Ok((hits, traces))
}

fn rays<S: Cast<D>, const D: usize>(
    tree: &StabTree<S, D>,
    origins: &[f64],
    directions: &[f64],
) -> Result<Vec<Ray<D>>> {
    if origins.len() != directions.len() || !origins.len().is_multiple_of(D) {
        let text = format!("origins and directions must both have shape (n, {D})");
        return Err(Error::new(ErrorKind::Shape, text));
    }
    let point = |flat: &[f64]| -> [f64; D] { std::array::from_fn(|k| flat[k]) };
    let pairs = origins.chunks_exact(D).zip(directions.chunks_exact(D));
    let numbered = pairs.enumerate().map(|(i, (o, d))| {
        let origin = tree.scene().snap(&point(o));
        let ray = origin.and_then(|origin| Ray::new(origin, &point(d)));
        ray.map_err(|e| {
            let text = format!("ray {i}: {}", e.message());
            Error::at(e.kind(), vec![i as u64], text)
        })
    });
    numbered.collect()
}
