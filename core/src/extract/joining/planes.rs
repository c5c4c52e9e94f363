//! Cut faces and their coplanar neighbours joined into polygons with holes.

use std::sync::Arc;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use smallvec::SmallVec;

use crate::extract::boundary::collect::{Boundary, CutFace};
use crate::extract::boundary::leaves::Fate;
use crate::extract::boundary::rim::{FrontierEdge, Rims};
use crate::extract::joining::patches::Patches;
use crate::extract::mesh::TriangleFace;
use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{BareEdge, Outline, OutlineEdge};
use crate::geometry::plane::{normal, Plane};
use crate::geometry::polygon::Polygon;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;

/// All boundary in one oriented plane that is not left as it came.
#[derive(Debug)]
pub struct PlaneGroup {
    /// The plane, inside on its minus side.
    pub plane: Arc<Plane>,
    /// The faces that lie in it, ascending.
    pub faces: Vec<TriangleFace>,
    /// The outline, counterclockwise as seen from outside.
    pub outline: Outline,
}

impl PlaneGroup {
    /// The edges of the outline.
    pub fn edges(&self) -> &[BareEdge] {
        self.outline.edges()
    }

    /// The keys of the lines that the edges lie on.
    pub fn lines(&mut self) -> &[LineKey] {
        self.outline.lines(&PlaneResidues::of(&self.plane))
    }
}

/// A group in the making.
struct Gathered {
    plane: Arc<Plane>,
    patch: u32,
    faces: Vec<TriangleFace>,
    /// The outlines of cut faces.
    cut: SmallVec<[Outline; 1]>,
    /// The edges of whole faces.
    whole: Vec<OutlineEdge>,
}

impl Gathered {
    fn joined(mut self) -> PlaneGroup {
        self.faces.sort_unstable();
        let outline = if let ([single], []) = (&mut self.cut[..], &self.whole[..]) {
            std::mem::take(single)
        } else {
            let plane = PlaneResidues::of(&self.plane);
            let cut = self.cut.into_iter().flat_map(|c| c.keyed(&plane));
            Outline::of(cut.chain(self.whole).collect())
        };
        PlaneGroup {
            plane: self.plane,
            faces: self.faces,
            outline,
        }
    }
}

/// Groups in the making.
struct Grouping<'a> {
    sources: &'a Sources,
    patches: &'a Patches,
    join: bool,
    fates: Vec<Vec<Fate>>,
    groups: Vec<Gathered>,
    by_plane: HashMap<(Arc<Plane>, u32), usize>,
    open: Vec<(u32, u32, bool, usize)>,
    rims: Rims,
}

/// Joins cut faces by plane; returns the fates that remain, the groups, and where whole faces end.
///
/// Faces of different patches are not joined. Without `join` each cut face stays on its own, as it
/// must where faces of one plane may overlap.
pub fn group(
    boundary: Boundary,
    sources: &Sources,
    patches: &Patches,
    join: bool,
) -> (Vec<Vec<Fate>>, Vec<PlaneGroup>, Rims) {
    let mut grouping = Grouping {
        sources,
        patches,
        join,
        rims: Rims::of(&boundary.fates, sources),
        fates: boundary.fates,
        groups: Vec::new(),
        by_plane: HashMap::default(),
        open: Vec::new(),
    };
    for cut in boundary.cut {
        poll();
        grouping.add_cut(cut);
    }
    if join {
        grouping.spread();
        grouping.absorb_seams();
        grouping.spread();
    }
    let groups = grouping.groups.into_iter().filter(|g| !g.faces.is_empty());
    let mut groups: Vec<PlaneGroup> = groups.map(Gathered::joined).collect();
    groups.retain(|g| !g.edges().is_empty());
    (grouping.fates, groups, grouping.rims)
}

impl Grouping<'_> {
    /// The group of a face's plane and patch.
    fn group_of(&mut self, slot: u32, face: u32, flip: bool) -> usize {
        let plane = self.oriented_plane(slot, face, flip);
        let patch = self.patch(slot, face);
        let next = self.groups.len();
        let at = if self.join {
            let key = (Arc::clone(&plane), patch);
            *self.by_plane.entry(key).or_insert(next)
        } else {
            next
        };
        if at == next {
            self.groups.push(Gathered {
                plane,
                patch,
                faces: Vec::new(),
                cut: SmallVec::new(),
                whole: Vec::new(),
            });
        }
        at
    }

    fn add_cut(&mut self, cut: CutFace) {
        let (slot, face, flip) = (cut.slot, cut.face, cut.flip);
        let at = self.group_of(slot, face, flip);
        let outline = if flip {
            cut.outline.flipped()
        } else {
            cut.outline
        };
        let group = &mut self.groups[at];
        group.faces.push(TriangleFace { slot, face, flip });
        group.cut.push(outline);
        self.open.push((slot, face, flip, at));
    }

    fn oriented_plane(&self, slot: u32, face: u32, flip: bool) -> Arc<Plane> {
        let plane = self.sources.get(slot as usize).plane(face);
        if flip {
            Arc::new(plane.flipped())
        } else {
            plane
        }
    }

    fn patch(&self, slot: u32, face: u32) -> u32 {
        let source = self.sources.get(slot as usize);
        self.patches.of(slot, source, face)
    }

    /// Whether a face lies in the plane of a group, is turned as the group is, and of its patch.
    fn lies_in(&self, slot: u32, face: u32, flip: bool, group: usize) -> bool {
        let Some(mesh) = self.sources.get(slot as usize).mesh() else {
            return false;
        };
        if self.patch(slot, face) != self.groups[group].patch {
            return false;
        }
        let (plane, [a, b, c]) = (&self.groups[group].plane, mesh.corners(face));
        if [a, b, c].iter().any(|p| plane.side_of_lattice(p) != 0) {
            return false;
        }
        let axis = plane.main_axis();
        (normal(&a, &b, &c)[axis] < 0) ^ (plane.normal()[axis] < 0) == flip
    }

    /// Moves a whole face into the group of its plane.
    fn absorb(&mut self, slot: u32, face: u32, flip: bool, group: usize) {
        let source = self.sources.get(slot as usize);
        let Some(mesh) = source.mesh() else {
            return;
        };
        self.fates[slot as usize][face as usize] = Fate::Cut;
        self.rims.outdated(slot);
        let polygon = Polygon::triangle(&mesh.corners(face), source.plane(face));
        let edges = OutlineEdge::all_of(&polygon);
        let faces = &mut self.groups[group].faces;
        faces.push(TriangleFace { slot, face, flip });
        let target = &mut self.groups[group].whole;
        if flip {
            target.extend(edges.map(|e| e.reversed()));
        } else {
            target.extend(edges);
        }
        self.open.push((slot, face, flip, group));
    }

    /// Absorbs the whole faces that continue a group's faces across an edge in the same plane.
    fn spread(&mut self) {
        while let Some((slot, face, flip, group)) = self.open.pop() {
            poll();
            for half in 3 * face..3 * face + 3 {
                let Some(next) = self.rims.across(slot, half, self.sources) else {
                    continue;
                };
                let whole = self.fates[slot as usize][next as usize] == Fate::Whole(flip);
                if whole && self.lies_in(slot, next, flip, group) {
                    self.absorb(slot, next, flip, group);
                }
            }
        }
        self.rims.renew(&self.fates, self.sources);
    }

    /// Absorbs whole faces that share a line and a plane with others of another source or part.
    fn absorb_seams(&mut self) {
        let candidates = self.candidates();
        // Faces that are alone in their plane share no line there.
        let mut alone: Vec<bool> = self.groups.iter().map(|g| g.faces.is_empty()).collect();
        for pair in candidates.windows(2).filter(|p| p[0].group == p[1].group) {
            let [p, q] = [&pair[0], &pair[1]].map(|c| (c.edge.slot, c.edge.half / 3));
            alone[pair[0].group] &= p == q;
        }
        let mut lines: HashMap<(usize, LineKey), Option<(u32, u32)>> = HashMap::default();
        let near = candidates.iter().filter(|c| !alone[c.group]);
        let keyed: Vec<(&Candidate, LineKey)> =
            near.map(|c| (c, c.edge.line(self.sources))).collect();
        let asked: HashSet<usize> = keyed.iter().map(|c| c.0.group).collect();
        for at in &asked {
            poll();
            let Gathered {
                plane, cut, whole, ..
            } = &mut self.groups[*at];
            let plane = PlaneResidues::of(plane);
            let cut = cut.iter_mut().flat_map(|c| c.lines(&plane)).copied();
            let own = cut.chain(whole.iter().map(|e| e.line));
            lines.extend(own.map(|line| ((*at, line), None)));
        }
        for (c, line) in &keyed {
            let face = (c.edge.slot, c.edge.half / 3);
            let first = lines.entry((c.group, *line)).or_insert(Some(face));
            if *first != Some(face) {
                *first = None;
            }
        }
        let shared = keyed
            .iter()
            .filter(|(c, line)| lines[&(c.group, *line)].is_none());
        let mut shared: Vec<Candidate> = shared.map(|(c, _)| **c).collect();
        shared.sort_unstable_by_key(|c| c.number);
        for c in shared {
            poll();
            let (slot, face) = (c.edge.slot, c.edge.half / 3);
            if self.fates[slot as usize][face as usize] == Fate::Whole(c.flip) {
                self.absorb(slot, face, c.flip, c.group);
            }
        }
    }

    /// The edges in which whole faces end, with the groups of the faces' planes; by group.
    fn candidates(&mut self) -> Vec<Candidate> {
        let frontier = self.rims.frontier(&self.fates, self.sources);
        let mut candidates: Vec<Candidate> = Vec::with_capacity(frontier.len());
        for (number, edge) in (0..).zip(frontier) {
            let (slot, face) = (edge.slot, edge.half / 3);
            let Fate::Whole(flip) = self.fates[slot as usize][face as usize] else {
                continue;
            };
            let last = candidates.last();
            let known = last.filter(|c| (c.edge.slot, c.edge.half / 3) == (slot, face));
            let group = match known {
                Some(c) => c.group,
                None => self.group_of(slot, face, flip),
            };
            candidates.push(Candidate {
                group,
                number,
                edge,
                flip,
            });
        }
        candidates.sort_unstable_by_key(|c| (c.group, c.number));
        candidates
    }
}

/// An edge of a whole face that may belong to a group.
#[derive(Clone, Copy)]
struct Candidate {
    group: usize,
    /// The place in the frontier.
    number: u32,
    edge: FrontierEdge,
    flip: bool,
}
