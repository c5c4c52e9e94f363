//! Joins cut faces and the faces that continue them in their plane to polygons with holes.

use std::sync::Arc;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use smallvec::SmallVec;

use crate::extract::boundary::collect::{Boundary, CutFace};
use crate::extract::boundary::leaves::{Fate, Fates};
use crate::extract::boundary::rim::{FrontierEdge, Rims};
use crate::extract::joining::chords::{divided, Chord, EdgeContact};
use crate::extract::joining::group::PlaneGroup;
use crate::extract::joining::patches::Patches;
use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{Outline, OutlineEdge};
use crate::geometry::plane::{normal, Plane};
use crate::geometry::polygon::Polygon;
use crate::geometry::side::{Orientation, Side};
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{OrientedFace, SourceFace};

/// A plane group (the boundary faces of one plane) while its faces are gathered.
struct Gathered {
    plane: Arc<Plane>,
    patch: u32,
    faces: SmallVec<[OrientedFace; 2]>,
    /// The outlines of the cut faces in the group.
    cut: SmallVec<[Outline; 1]>,
    /// The edges of whole faces that joined the group.
    whole: Vec<OutlineEdge>,
    /// The chords that divide the polygon of the group.
    chords: Vec<Chord>,
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

/// All plane groups (the boundary faces of one plane each) while their faces are gathered.
struct Grouping<'a> {
    sources: &'a Sources,
    patches: &'a Patches,
    join: bool,
    fates: Fates,
    groups: Vec<Gathered>,
    by_plane: HashMap<(Arc<Plane>, u32), usize>,
    open: Vec<(OrientedFace, usize)>,
    rims: Rims,
}

/// The boundary of a solid, with its cut faces joined to polygons by plane.
pub struct Joined {
    /// The fate of each source face: whole, cut or gone; a face that joined a polygon counts as cut.
    pub fates: Fates,
    /// The polygons, with the faces that make them up.
    pub groups: Vec<PlaneGroup>,
    /// For each source, where its whole faces end.
    pub rims: Rims,
    /// The lines of the chords along which polygons were divided.
    pub chords: Vec<LineKey>,
}

/// Joins cut faces, and whole faces that continue them in their plane, to polygons.
///
/// Faces of different patches are not joined. Without `join` each cut face stays alone, as is necessary if
/// faces of one plane may overlap.
pub fn group(boundary: Boundary, sources: &Sources, patches: &Patches, join: bool) -> Joined {
    let count = boundary.cut.len();
    let mut grouping = Grouping {
        sources,
        patches,
        join,
        rims: Rims::of(&boundary.fates, sources),
        fates: boundary.fates,
        groups: Vec::with_capacity(count),
        by_plane: HashMap::default(),
        open: Vec::with_capacity(count),
    };
    for cut in boundary.cut {
        poll();
        grouping.add_cut(cut);
    }
    if join {
        for contact in patches.contacts() {
            poll();
            grouping.add_contact(contact);
        }
        grouping.spread();
        grouping.absorb_seams();
        grouping.spread();
    }
    grouping.joined()
}

impl Grouping<'_> {
    /// Turns the gathered groups into polygons, and divides those that have chords.
    fn joined(self) -> Joined {
        let (mut groups, mut chords) = (Vec::with_capacity(self.groups.len()), Vec::new());
        for mut gathered in self.groups {
            if gathered.faces.is_empty() {
                continue;
            }
            let dividing = std::mem::take(&mut gathered.chords);
            let group = gathered.joined();
            if group.edges().is_empty() {
                continue;
            }
            if dividing.is_empty() {
                groups.push(group);
            } else {
                groups.extend(divided(group, dividing, self.sources, &mut chords));
            }
        }
        groups.shrink_to_fit();
        Joined {
            fates: self.fates,
            groups,
            rims: self.rims,
            chords,
        }
    }

    /// Puts the three faces at an edge contact into groups by plane, and divides the polygon of the face that
    /// contains the edge.
    fn add_contact(&mut self, contact: &EdgeContact) {
        for face in contact.faces() {
            if self.fates[face.face] == Fate::Whole(face.orientation) {
                let group = self.group_of(face);
                self.absorb(face, group);
            }
        }
        let group = self.group_of(contact.face);
        self.groups[group].chords.push(contact.chord(self.sources));
    }

    /// Returns the index of the group of a face's plane and patch; adds the group if there is none.
    fn group_of(&mut self, face: OrientedFace) -> usize {
        let plane = self.oriented_plane(face);
        let patch = self.patch(face);
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
                faces: SmallVec::new(),
                cut: SmallVec::new(),
                whole: Vec::new(),
                chords: Vec::new(),
            });
        }
        at
    }

    fn add_cut(&mut self, cut: CutFace) {
        let face = cut.face;
        let at = self.group_of(face);
        let outline = match face.orientation {
            Orientation::Same => cut.outline,
            Orientation::Opposite => cut.outline.flipped(),
        };
        let group = &mut self.groups[at];
        group.faces.push(face);
        group.cut.push(outline);
        self.open.push((face, at));
    }

    fn oriented_plane(&self, face: OrientedFace) -> Arc<Plane> {
        let plane = self.sources.get(face.slot()).plane(face.id());
        match face.orientation {
            Orientation::Same => plane,
            Orientation::Opposite => Arc::new(plane.flipped()),
        }
    }

    fn patch(&self, face: OrientedFace) -> u32 {
        self.patches.of(face.face, self.sources.get(face.slot()))
    }

    /// Returns true if a face lies in the plane of a group, with the plane's orientation and the group's
    /// patch.
    fn lies_in(&self, face: OrientedFace, group: usize) -> bool {
        let Some(mesh) = self.sources.get(face.slot()).mesh() else {
            return false;
        };
        if self.patch(face) != self.groups[group].patch {
            return false;
        }
        let (plane, [a, b, c]) = (&self.groups[group].plane, mesh.corners(face.id()));
        if [a, b, c]
            .iter()
            .any(|p| plane.side_of_lattice(p) != Side::On)
        {
            return false;
        }
        let axis = plane.main_axis();
        let opposite = (normal(&a, &b, &c)[axis] < 0) != (plane.normal()[axis] < 0);
        Orientation::turned_around(opposite) == face.orientation
    }

    /// Moves a whole face into a plane group (the boundary faces of one plane); from then on its fate is
    /// `Cut`.
    fn absorb(&mut self, face: OrientedFace, group: usize) {
        let source = self.sources.get(face.slot());
        let Some(mesh) = source.mesh() else {
            return;
        };
        self.fates[face.face] = Fate::Cut;
        self.rims.outdated(face.slot());
        let polygon = Polygon::triangle(&mesh.corners(face.id()), source.plane(face.id()));
        let edges = OutlineEdge::edges_of(&polygon);
        let faces = &mut self.groups[group].faces;
        faces.push(face);
        let target = &mut self.groups[group].whole;
        match face.orientation {
            Orientation::Same => target.extend(edges),
            Orientation::Opposite => target.extend(edges.map(|e| e.reversed())),
        }
        self.open.push((face, group));
    }

    /// Moves into a plane group (the boundary faces of one plane) all whole coplanar faces that are connected
    /// to its faces across edges.
    fn spread(&mut self) {
        while let Some((face, group)) = self.open.pop() {
            poll();
            for half in face.id().half_edges() {
                let Some(next) = self.rims.across(face.slot(), half, self.sources) else {
                    continue;
                };
                let next = SourceFace::new(face.slot(), next).oriented(face.orientation);
                let whole = self.fates[next.face] == Fate::Whole(next.orientation);
                if whole && self.lies_in(next, group) {
                    self.absorb(next, group);
                }
            }
        }
        self.rims.renew(&self.fates, self.sources);
    }

    /// Moves a whole face into a plane group (the boundary faces of one plane) if it has an edge on a line
    /// that also contains an edge of another face in this plane.
    fn absorb_seams(&mut self) {
        let candidates = self.candidates();
        // A face that is alone in its plane shares no line there.
        let mut alone: Vec<bool> = self.groups.iter().map(|g| g.faces.is_empty()).collect();
        for pair in candidates.windows(2).filter(|p| p[0].group == p[1].group) {
            let [p, q] = [&pair[0], &pair[1]].map(|c| c.face.face);
            alone[pair[0].group] &= p == q;
        }
        let mut lines: HashMap<(usize, LineKey), Option<SourceFace>> = HashMap::default();
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
            let face = c.face.face;
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
            if self.fates[c.face.face] == Fate::Whole(c.face.orientation) {
                self.absorb(c.face, c.group);
            }
        }
    }

    /// Returns the edges at which whole faces end, sorted by the plane group (the boundary faces of one
    /// plane) that the face could join.
    fn candidates(&mut self) -> Vec<Candidate> {
        let frontier = self.rims.frontier(&self.fates, self.sources);
        let mut candidates: Vec<Candidate> = Vec::with_capacity(frontier.len());
        for (number, edge) in (0..).zip(frontier) {
            let face = edge.face();
            let Fate::Whole(orientation) = self.fates[face] else {
                continue;
            };
            let face = face.oriented(orientation);
            let last = candidates.last();
            let known = last.filter(|c| c.face == face);
            let group = match known {
                Some(c) => c.group,
                None => self.group_of(face),
            };
            candidates.push(Candidate {
                group,
                number,
                edge,
                face,
            });
        }
        candidates.sort_unstable_by_key(|c| (c.group, c.number));
        candidates
    }
}

/// An edge at which a whole face ends, and the plane group (the boundary faces of one plane) that the face
/// may join.
#[derive(Clone, Copy)]
struct Candidate {
    group: usize,
    /// The index of the edge among all edges where whole faces end.
    number: u32,
    edge: FrontierEdge,
    face: OrientedFace,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::boundary::collect::collect;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, tetrahedra};
    use crate::tree::solid::Solid;

    /// The number of faces in each plane group of a union.
    fn sizes(solids: &[Solid; 2], join: bool) -> Vec<usize> {
        let solid = made_of(solids, Term::Or);
        let sources = Sources::new(solid.sources().clone());
        let boundary = collect(&solid, &sources);
        let joined = group(boundary, &sources, &Patches::default(), join);
        joined.groups.iter().map(|g| g.faces.len()).collect()
    }

    #[test]
    fn cut_faces_of_different_planes_stay_apart() {
        assert_eq!(sizes(&tetrahedra(), true), [1; 4]);
    }

    #[test]
    fn cut_faces_of_one_plane_are_joined() {
        // The boxes lie side by side, with common floors and ceilings, and one extends into the other.
        let boxes = [cuboid([0; 3], [6, 4, 4]), cuboid([3, 0, 0], [9, 4, 4])];
        let joined = sizes(&boxes, true);
        assert!(joined.len() < sizes(&boxes, false).len());
        assert!(joined.iter().all(|faces| *faces > 1));
    }
}
