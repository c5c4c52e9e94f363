//! Contact of surfaces: common points of two surfaces, and edges of a surface inside its own faces.

mod edges;

use crate::error::Result;
use crate::extract::assemble::{assemble, assemble_patches};
use crate::extract::joining::patches::Patches;
use crate::extract::surface::facet::Facet;
use crate::extract::surface::near::{near_pairs, Element};
use crate::extract::surface::Surface;
use crate::merge::lists::list::Sources;
use crate::tree::solid::Solid;
pub use edges::edge_contacts;

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
    let meshes = [assemble(first)?, assemble(second)?];
    let surface = |i: usize| Surface::new([first, second][i], &all, &meshes[i]);
    let surfaces = [surface(0), surface(1)];
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

/// Returns patches whose polygons are divided at all edges in which a reduced solid touches itself (see
/// [`edge_contacts`]); `None` if the given patches already are.
///
/// # Errors
/// `Unbounded`.
pub fn divided(solid: &Solid, patches: &Patches) -> Result<Option<Patches>> {
    let sources = Sources::new(solid.sources().clone());
    let mut all = None;
    loop {
        // Dividing joins whole faces to polygons, which may contain further edges.
        let last = all.as_ref().unwrap_or(patches);
        let Some(next) = last.divided(&edge_contacts(solid, last)?, &sources) else {
            return Ok(all);
        };
        all = Some(next);
    }
}

/// Returns the number of connected surfaces of a bounded solid, and the Euler number of its boundary; both
/// depend on the set of points alone if `patches` are divided at all edges in which the solid touches itself.
///
/// # Errors
/// `Unbounded`.
pub fn surfaces_and_euler_number(solid: &Solid, patches: &Patches) -> Result<(usize, i64)> {
    let mesh = assemble_patches(solid, patches)?;
    let counts = mesh.counts();
    Ok((counts.surfaces, counts.euler_number(mesh.triangles.len())))
}
