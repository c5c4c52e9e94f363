//! Finds the intervals of a ray inside closed surfaces, by winding numbers between crossings.

use super::facet::cross;
use super::first::likely;
use super::line::Ray;
use super::ratio::Ratio;
use super::scene::Scene;
use crate::arith::Sign;
use crate::merge::rule::Rule;

/// An interval of a ray that is inside a closed set.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// The parameter at which the interval begins.
    pub from: Ratio,
    /// The facet through which the ray enters; `None` if it starts inside.
    pub entry: Option<u32>,
    /// The parameter at which the interval ends, and the facet through which the ray leaves; `None` if it
    /// never leaves.
    pub end: Option<(Ratio, u32)>,
}

struct Crossing {
    at: Ratio,
    facet: u32,
    step: i32,
}

/// Returns the intervals of a ray inside a closed set, in order; none is empty, and no two touch.
///
/// The facets must be closed; `outside` is the winding number far along every ray. The ray is shifted
/// infinitesimally, by (ε, ε², ε³): a ray that runs in a facet is inside there if the shifted points are.
pub fn stretches<const D: usize>(
    scene: &Scene<D>,
    ray: &Ray<D>,
    rule: Rule,
    outside: i32,
) -> Vec<Stretch> {
    let crossings = crossings(scene, ray);
    let mut winding = crossings.iter().map(|c| c.step).sum::<i32>() + outside;
    let mut found = Vec::new();
    let mut entry = rule.inside(winding).then_some((Ratio::ZERO, None));
    for group in crossings.chunk_by(|a, b| a.at == b.at) {
        winding -= group.iter().map(|c| c.step).sum::<i32>();
        let (at, facet) = (group[0].at, group[0].facet);
        match (entry, rule.inside(winding)) {
            (None, true) => entry = Some((at, Some(facet))),
            (Some((from, entered)), false) => {
                found.push(stretch(from, entered, Some((at, facet))));
                entry = None;
            }
            _ => {}
        }
    }
    found.extend(entry.map(|(from, entered)| stretch(from, entered, None)));
    found
}

fn stretch(from: Ratio, entry: Option<u32>, end: Option<(Ratio, u32)>) -> Stretch {
    Stretch { from, entry, end }
}

/// Returns the crossings of a ray with facets at positive parameters, by parameter, then input order; `step`
/// is +1 where the ray leaves and −1 where it enters.
fn crossings<const D: usize>(scene: &Scene<D>, ray: &Ray<D>) -> Vec<Crossing> {
    let facets = likely(scene, std::slice::from_ref(ray))
        .pop()
        .unwrap_or_default();
    let crossing = |facet: u32| {
        let (at, step) = cross(ray, &scene.facets()[facet as usize])?;
        let step = i32::from(step);
        (at.sign() == Sign::Positive).then_some(Crossing { at, facet, step })
    };
    let mut found: Vec<_> = facets.into_iter().filter_map(crossing).collect();
    found.sort_by(|a, b| {
        let order = a.at.cmp(&b.at);
        order.then_with(|| a.facet.cmp(&b.facet))
    });
    found
}
