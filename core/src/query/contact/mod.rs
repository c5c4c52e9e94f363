//! Contact of surfaces: common points of two surfaces, and edges of a surface inside its own faces.

mod edges;
mod facet;
mod near;
mod surface;

use crate::error::Result;
use crate::extract::joining::patches::Patches;
use crate::tree::solid::Solid;
pub use edges::edge_contacts;
use facet::Facet;
use near::{near_pairs, Element};
use surface::Surface;

/// Return whether the surfaces of two reduced solids on one lattice have a point in common; exact.
///
/// # Cost
/// Proportional to both meshes, and to the pairs of triangles whose boxes overlap, up to the first pair that
/// meets.
///
/// # Errors
/// `Unbounded`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::grid::Pitch;
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::contact::surfaces_meet;
/// use bspcsg::tree::solid::Solid;
///
/// let corner = |x: f64| {
///     let vertices = [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]];
///     let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
///     let source = import(&vertices, &faces, Some(Pitch::new(-1)?))?;
///     Ok::<_, bspcsg::error::Error>(Solid::of_source(Arc::new(source), false))
/// };
/// assert!(surfaces_meet(&corner(0.0)?, &corner(1.0)?)?);
/// assert!(!surfaces_meet(&corner(0.0)?, &corner(1.1)?)?);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn surfaces_meet(first: &Solid, second: &Solid) -> Result<bool> {
    let all = Patches::default();
    let surfaces = [Surface::of(first, &all)?, Surface::of(second, &all)?];
    let space = surfaces[0].space().within(&surfaces[1].space());
    let near = surfaces.each_ref().map(|s| s.triangles_in(&space));
    let element = |operand| move |&(_, space): &(u32, _)| Element { operand, space };
    let mut elements: Vec<Element> = near[0].iter().map(element(0)).collect();
    elements.extend(near[1].iter().map(element(1)));
    let facets: Vec<Facet> = (surfaces.iter().zip(&near))
        .flat_map(|(surface, near)| near.iter().map(|(triangle, _)| surface.facet(*triangle)))
        .collect();
    let facet = |number: u32| &facets[number as usize];
    let apart = near_pairs(
        &elements,
        |number| Some(facet(number).corners.clone()),
        |p, q| (!facet(p).meets(facet(q))).then_some(()),
    );
    Ok(apart.is_none())
}
