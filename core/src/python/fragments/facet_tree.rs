//! A fragment tree of one dimension with the facets that it was made of.

use num_bigint::BigInt;

use super::convert::{BuildMethod, BuildOptions};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::{Half, Side};
use crate::geometry::spaces::affine::{Affine, Polytope, Viewpoint};
use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim2::Dim2;
use crate::geometry::spaces::dim3::Dim3;
use crate::interrupt::poll;
use crate::mesh::facets::Facet;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::NodeId;
use crate::python::hyperplanes::{row_of, FromRow, Row};
use crate::query::path::{cast_ray, locate, RayEvent, RayPath};
use crate::query::ray::scene::snap;
use crate::query::ray::Ray;
use crate::query::stab::Cast;
use crate::tree::fragments::{
    build, build_watched, perfect, Ask, Division, FragmentTree, Lines, NodeCut, Piece, Plan,
};
use crate::tree::trace::Watcher;

/// A fragment tree of dimension one, two or three.
pub enum AnyFacetTree {
    Line(FacetTree<Dim1>),
    Plane(FacetTree<Dim2>),
    Space(FacetTree<Dim3>),
}

/// Builds the tree over facets in a space of the given dimension.
pub fn build_any(
    dimension: usize,
    facets: Vec<Facet>,
    pitch: Pitch,
    options: &BuildOptions,
) -> Result<AnyFacetTree> {
    Ok(match dimension {
        1 => AnyFacetTree::Line(build_tree(facets, pitch, options)?),
        2 => AnyFacetTree::Plane(build_tree(facets, pitch, options)?),
        3 => AnyFacetTree::Space(build_tree(facets, pitch, options)?),
        _ => {
            let text = format!("corners must have 1, 2 or 3 coordinates, not {dimension}");
            return Err(Error::new(ErrorKind::Shape, text));
        }
    })
}

/// Facets, their fragment tree, and the pitch of their lattice.
pub struct FacetTree<S: Affine> {
    pub facets: Vec<Facet>,
    pub tree: FragmentTree<S>,
    pub pitch: Pitch,
}

fn build_tree<S: FromRow>(
    facets: Vec<Facet>,
    pitch: Pitch,
    options: &BuildOptions,
) -> Result<FacetTree<S>> {
    let tree = build(pieces::<S>(&facets)?, plan(&facets, options)?)?;
    Ok(FacetTree {
        facets,
        tree,
        pitch,
    })
}

/// Builds a tree whose cuts a callback chooses.
pub fn build_asking<S: FromRow>(
    facets: Vec<Facet>,
    pitch: Pitch,
    own: &[Row],
    ask: Ask<S>,
) -> Result<FacetTree<S>> {
    let plan = Plan::Own(own_cuts::<S>(own)?, Box::new(Plan::Asked(ask)));
    let tree = build(pieces::<S>(&facets)?, plan)?;
    Ok(FacetTree {
        facets,
        tree,
        pitch,
    })
}

fn own_cuts<S: FromRow>(own: &[Row]) -> Result<Vec<S::Hyperplane>> {
    own.iter().map(|row| S::from_row(row)).collect()
}

fn plan<S: FromRow>(facets: &[Facet], options: &BuildOptions) -> Result<Plan<S>> {
    let plan = match &options.method {
        BuildMethod::Given(cuts) => Plan::Given(cuts.clone()),
        BuildMethod::Lines(sample) => Plan::Lines(Lines {
            corners: facets.iter().map(|f| f.corners.clone()).collect(),
            sample: *sample,
        }),
        BuildMethod::Policy(policy, top, margin) => Plan::Policy {
            policy: *policy,
            top: *top,
            region: if policy.needs_region() {
                Some(grown_box(facets, *margin)?)
            } else {
                None
            },
        },
    };
    if options.own.is_empty() {
        return Ok(plan);
    }
    Ok(Plan::Own(own_cuts::<S>(&options.own)?, Box::new(plan)))
}

/// All fragments of a tree as flat lists.
pub struct Export {
    pub vertices: Vec<[f64; 3]>,
    pub offsets: Vec<i64>,
    pub source: Vec<i64>,
    pub node: Vec<i64>,
    pub original: Vec<bool>,
    pub flipped: Vec<bool>,
}

impl<S: FromRow> FacetTree<S> {
    /// Builds the tree again, and returns a record of the division of each region.
    pub fn construction(&self, options: &BuildOptions) -> Result<Vec<Division>> {
        let mut divisions = Vec::new();
        let plan = plan(&self.facets, options)?;
        build_watched(pieces::<S>(&self.facets)?, plan, &mut divisions)?;
        Ok(divisions)
    }

    /// Returns the tree with more facets: existing cuts stay, and regions without facets are divided as
    /// `options` say.
    pub fn grown(&self, facets: Vec<Facet>, options: &BuildOptions) -> Result<Self> {
        let rest = plan(&facets, options)?;
        let plan = Plan::Grown(Box::new(self.tree.clone()), Box::new(rest));
        let tree = build(pieces::<S>(&facets)?, plan)?;
        let pitch = self.pitch;
        Ok(Self {
            facets,
            tree,
            pitch,
        })
    }

    /// Returns options that build the same tree again.
    pub fn build_options(&self) -> BuildOptions {
        let own = self
            .tree
            .own_hyperplanes()
            .iter()
            .map(row_of::<S>)
            .collect();
        let method = BuildMethod::Given(self.cuts());
        BuildOptions { method, own }
    }

    /// Returns the nodes that a point passes, each with the side of its hyperplane on which the point lies.
    pub fn path(&self, point: &[f64; 3]) -> Vec<(u32, i8)> {
        let point = Viewpoint::point(point, -self.pitch.exponent());
        let steps = locate(&self.tree, &point).into_iter();
        steps.map(|step| (step.node.0, sign(step.side))).collect()
    }

    /// Returns for each ray the first hit and the cost of finding it: numbers of nodes, leaves and tests.
    pub fn cast<const D: usize>(&self, rays: &[[f64; 6]]) -> Result<Vec<RayPath>>
    where
        S: Cast<D>,
    {
        let cast = |(number, ray): (usize, &[f64; 6])| {
            poll();
            self.cast_one(ray, &mut ()).map_err(|e| {
                let text = format!("ray {number}: {}", e.message());
                Error::at(e.kind(), vec![number as u64], text)
            })
        };
        rays.iter().enumerate().map(cast).collect()
    }

    /// Returns the first hit of a ray, given by the coordinates of its origin and of its direction.
    pub fn cast_one<const D: usize>(
        &self,
        ray: &[f64; 6],
        watcher: &mut impl Watcher<RayEvent>,
    ) -> Result<RayPath>
    where
        S: Cast<D>,
    {
        let origin: [f64; D] = std::array::from_fn(|k| ray[k]);
        let direction: [f64; D] = std::array::from_fn(|k| ray[3 + k]);
        let ray = Ray::new(snap(self.pitch, &origin)?, &direction)?;
        Ok(cast_ray(
            &self.tree,
            &self.facets,
            self.pitch,
            &ray,
            watcher,
        ))
    }
}

/// Returns −1 for the minus side, 0 for `On`, 1 for the plus side.
pub fn sign(side: Side) -> i8 {
    match side {
        Side::Minus => -1,
        Side::On => 0,
        Side::Plus => 1,
    }
}

impl<S: Affine> FacetTree<S> {
    pub fn perfect(&self) -> Result<Option<Vec<NodeCut>>> {
        perfect(&pieces::<S>(&self.facets)?)
    }

    pub fn source(&self, piece: u32) -> i64 {
        i64::from(self.facets[piece as usize].source)
    }

    pub fn coefficients(&self, node: NodeId) -> Option<Vec<BigInt>> {
        let [a, b, c, d] = S::exact(&self.tree.nodes().get(node.index())?.hyperplane);
        let mut all: Vec<BigInt> = [a, b, c].into_iter().take(S::DIM).collect();
        all.push(d);
        Some(all)
    }

    /// Converts lattice steps to model units.
    pub fn units(&self, steps: [f64; 3]) -> [f64; 3] {
        let power = 10f64.powi(self.pitch.exponent().unsigned_abs() as i32);
        steps.map(|k| {
            if self.pitch.exponent() <= 0 {
                k / power
            } else {
                k * power
            }
        })
    }

    pub fn positions(&self, piece: &S::Fragment) -> Vec<[f64; 3]> {
        S::corners(piece)
            .into_iter()
            .map(|p| self.units(p))
            .collect()
    }

    /// Returns the unit normals n and the offsets of all nodes' hyperplanes n·x = offset, in model units.
    pub fn hyperplanes(&self) -> (Vec<[f64; 3]>, Vec<f64>) {
        let unit = |cut: &S::Hyperplane| {
            let [a, b, c, d] = S::approx(cut);
            let length = (a * a + b * b + c * c).sqrt();
            let [offset, ..] = self.units([-d / length; 3]);
            ([a / length, b / length, c / length], offset)
        };
        self.tree
            .nodes()
            .iter()
            .map(|n| unit(&n.hyperplane))
            .unzip()
    }

    pub fn links(&self) -> [Vec<i64>; 6] {
        let number = |link: Option<NodeId>| link.map_or(-1, i64::from);
        let nodes = self.tree.nodes();
        [
            nodes.iter().map(|n| number(n.minus)).collect(),
            nodes.iter().map(|n| number(n.plus)).collect(),
            nodes
                .iter()
                .map(|n| number(n.parent.map(|p| p.0)))
                .collect(),
            nodes.iter().map(|n| i64::from(n.depth)).collect(),
            nodes.iter().map(|n| i64::from(n.coplanar.start)).collect(),
            nodes.iter().map(|n| i64::from(n.coplanar.end)).collect(),
        ]
    }

    pub fn cuts(&self) -> Vec<NodeCut> {
        self.tree.nodes().iter().map(|n| n.cut).collect()
    }

    pub fn export(&self) -> Export {
        let count = self.tree.fragments().len();
        let mut export = Export {
            vertices: Vec::with_capacity(S::DIM * count),
            offsets: Vec::with_capacity(count + 1),
            source: Vec::with_capacity(count),
            node: Vec::with_capacity(count),
            original: Vec::with_capacity(S::DIM * count),
            flipped: Vec::with_capacity(count),
        };
        export.offsets.push(0);
        for (number, node) in (0i64..).zip(self.tree.nodes()) {
            for fragment in &self.tree.fragments()[as_range(&node.coplanar)] {
                let facet = &self.facets[fragment.piece.number as usize];
                let shape = &fragment.piece.fragment;
                export.vertices.extend(self.positions(shape));
                export
                    .original
                    .extend(S::original_edges(shape, &facet.corners, &facet.seams));
                export.offsets.push(export.vertices.len() as i64);
                export.source.push(i64::from(facet.source));
                export.node.push(number);
                export.flipped.push(fragment.flipped);
            }
        }
        export
    }

    /// Returns the box around the tree's facets (input points, segments or polygons), enlarged by a margin in
    /// model units, but by at least one lattice step.
    pub fn whole(&self, margin: f64) -> Result<Polytope<S>> {
        let steps = (margin / self.units([1.0; 3])[0])
            .round()
            .clamp(1.0, S::MAX_COORDINATE as f64) as i64;
        grown_box(&self.facets, steps)
    }

    pub fn region(
        &self,
        node: Option<NodeId>,
        side: i8,
        margin: f64,
    ) -> Result<Vec<Vec<[f64; 3]>>> {
        let whole = self.whole(margin)?;
        let region = match node {
            None => Some(whole),
            Some(node) => {
                let region = self.tree.region(node, &whole);
                match (region, half_of(side)) {
                    (Some(region), Some(half)) => {
                        let cut = &self.tree.nodes()[node.index()].hyperplane;
                        let [minus, plus] = region.divided(cut);
                        if half == Half::Minus {
                            minus
                        } else {
                            plus
                        }
                    }
                    (region, _) => region,
                }
            }
        };
        let walls = region.as_ref().map_or(&[][..], |r| r.walls());
        Ok(walls.iter().map(|w| self.positions(w)).collect())
    }

    pub fn span(&self, node: NodeId, margin: f64) -> Result<Vec<[f64; 3]>> {
        let whole = self.whole(margin)?;
        let span = self
            .tree
            .region(node, &whole)
            .and_then(|r| r.span(&self.tree.nodes()[node.index()].hyperplane));
        Ok(span.map_or_else(Vec::new, |s| self.positions(&s)))
    }
}

fn as_range(range: &std::ops::Range<u32>) -> std::ops::Range<usize> {
    range.start as usize..range.end as usize
}

fn half_of(side: i8) -> Option<Half> {
    match side {
        0 => None,
        ..=-1 => Some(Half::Minus),
        1.. => Some(Half::Plus),
    }
}

/// Returns the box around facets (points, segments or polygons), enlarged by `margin` steps on each side.
fn grown_box<S: Affine>(facets: &[Facet], margin: i64) -> Result<Polytope<S>> {
    let corners = || facets.iter().flat_map(|f| &f.corners);
    let reach = |k: i64| k.clamp(-S::MAX_COORDINATE, S::MAX_COORDINATE);
    let low = [0, 1, 2].map(|i| reach(corners().map(|c| c[i]).min().unwrap_or(0) - margin));
    let high = [0, 1, 2].map(|i| reach(corners().map(|c| c[i]).max().unwrap_or(0) + margin));
    Polytope::cuboid(&low, &high).ok_or_else(|| {
        let text =
            "the facets extend to the border of the lattice, so no box fits around the facets; \
                    choose a coarser pitch";
        Error::new(ErrorKind::TooLarge, text)
    })
}

fn pieces<S: Affine>(facets: &[Facet]) -> Result<Vec<Piece<S>>> {
    let piece = |(number, facet): (usize, &Facet)| {
        let flat = || Error::internal(format!("piece {number} has no extent"));
        let fragment = S::fragment(&facet.corners).ok_or_else(flat)?;
        let number = u32::try_from(number).map_err(|_| {
            Error::new(
                ErrorKind::TooLarge,
                "the facets are divided into more than 2^32 pieces, the largest number allowed",
            )
        })?;
        Ok(Piece { fragment, number })
    };
    facets.iter().enumerate().map(piece).collect()
}
