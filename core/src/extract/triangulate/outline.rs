//! Joins boundary edges at their vertices to corners.
//!
//! A corner is one wedge of the region at a vertex, named by the edge that leaves it. A vertex
//! where boundaries touch has several corners; in angular order, wedges of the region and of the
//! outside alternate between its edges.

use std::cmp::Ordering;

use super::{Error, Planar};
use crate::interrupt::poll;

/// For every edge of a region's boundary, the edge before it.
pub(super) struct Outline {
    previous: Vec<usize>,
}

/// An edge at a vertex, with its other end.
#[derive(Clone, Copy)]
struct Spoke {
    edge: usize,
    far: u32,
    leaves: bool,
}

impl Outline {
    /// Joins edges to boundaries; their vertices are numbered from zero.
    pub(super) fn new<P: Planar>(points: &P, edges: &[(u32, u32)]) -> Result<Self, Error> {
        let mut outline = Self {
            previous: vec![0; edges.len()],
        };
        let mut leaving: Vec<usize> = (0..edges.len()).collect();
        let mut arriving = leaving.clone();
        leaving.sort_unstable_by_key(|&e| (edges[e].0, e));
        arriving.sort_unstable_by_key(|&e| (edges[e].1, e));
        let open = leaving
            .iter()
            .zip(&arriving)
            .find(|&(&out, &into)| edges[out].0 != edges[into].1);
        if let Some((&out, &into)) = open {
            return Err(Error::Open {
                vertex: edges[out].0.min(edges[into].1),
            });
        }
        let mut start = 0;
        for outs in leaving.chunk_by(|&a, &b| edges[a].0 == edges[b].0) {
            poll();
            let ins = &arriving[start..start + outs.len()];
            outline.join(points, edges, outs, ins)?;
            start += outs.len();
        }
        Ok(outline)
    }

    pub(super) fn previous(&self, edge: usize) -> usize {
        self.previous[edge]
    }

    /// The vertices before, at and after the corner that `edge` leaves.
    pub(super) fn corner(&self, edges: &[(u32, u32)], edge: usize) -> [u32; 3] {
        [edges[self.previous[edge]].0, edges[edge].0, edges[edge].1]
    }

    /// Joins the edges that leave and that reach one vertex, in pairs along the boundary.
    fn join<P: Planar>(
        &mut self,
        points: &P,
        edges: &[(u32, u32)],
        outs: &[usize],
        ins: &[usize],
    ) -> Result<(), Error> {
        if let (&[out], &[into]) = (outs, ins) {
            self.previous[out] = into;
            return Ok(());
        }
        let vertex = edges[outs[0]].0;
        let mut spokes: Vec<Spoke> = outs
            .iter()
            .map(|&edge| Spoke {
                edge,
                far: edges[edge].1,
                leaves: true,
            })
            .collect();
        spokes.extend(ins.iter().map(|&edge| Spoke {
            edge,
            far: edges[edge].0,
            leaves: false,
        }));
        sort_by_angle(points, vertex, &mut spokes)?;
        if !spokes[0].leaves {
            spokes.rotate_left(1);
        }
        for wedge in spokes.chunks_exact(2) {
            if !wedge[0].leaves || wedge[1].leaves {
                return Err(Error::Crossing { vertex });
            }
            self.previous[wedge[0].edge] = wedge[1].edge;
        }
        Ok(())
    }
}

/// Sorts the edges at a vertex counterclockwise, from the direction straight down.
fn sort_by_angle<P: Planar>(points: &P, vertex: u32, spokes: &mut [Spoke]) -> Result<(), Error> {
    if spokes
        .iter()
        .any(|spoke| points.compare(spoke.far, vertex) == Ordering::Equal)
    {
        return Err(Error::Overlap { vertex });
    }
    let angle = |a: &Spoke, b: &Spoke| {
        let is_left = |spoke: &Spoke| points.compare(spoke.far, vertex) == Ordering::Less;
        is_left(a)
            .cmp(&is_left(b))
            .then_with(|| points.orient(vertex, a.far, b.far).order().reverse())
    };
    spokes.sort_by(angle);
    if spokes
        .windows(2)
        .any(|pair| angle(&pair[0], &pair[1]) == Ordering::Equal)
    {
        return Err(Error::Overlap { vertex });
    }
    Ok(())
}
