//! Divides polygons along edges of other faces that lie inside them.

use std::sync::Arc;

use smallvec::SmallVec;

use super::group::PlaneGroup;
use crate::geometry::line::LineKey;
use crate::geometry::outline::{halves, BareEdge, Outline};
use crate::geometry::plane::Plane;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::OrientedFace;

/// A segment in which a surface touches itself: it lies in a face, and other faces of the surface share it.
#[derive(Clone, Debug)]
pub struct EdgeContact {
    /// Points whose convex hull contains the segment, such as its ends.
    pub hull: SmallVec<[Arc<Vertex>; 3]>,
    /// Two other faces that share the segment, in one plane or two; the first lies across the face's plane.
    pub beside: [OrientedFace; 2],
    /// The face whose polygon is divided at the segment.
    pub face: OrientedFace,
}

impl EdgeContact {
    /// The face that contains the segment, and the two faces that share it.
    pub fn faces(&self) -> [OrientedFace; 3] {
        let [first, second] = self.beside;
        [self.face, first, second]
    }

    /// The face that is divided, and the line at which it is.
    pub fn place(&self, sources: &Sources) -> (OrientedFace, LineKey) {
        let [plane, across] = [self.face, self.beside[0]].map(|face| plane_of(face, sources));
        (self.face, LineKey::of_planes(&plane, &across))
    }

    /// The segment as a chord, which divides the polygon of the face that contains it.
    pub fn chord(&self, sources: &Sources) -> Chord {
        Chord {
            hull: self.hull.clone(),
            plane: plane_of(self.beside[0], sources),
            line: self.place(sources).1,
        }
    }
}

fn plane_of(face: OrientedFace, sources: &Sources) -> Arc<Plane> {
    sources.get(face.slot()).plane(face.id())
}

/// A segment in a polygon's plane, and another plane that contains the segment.
#[derive(Clone, Debug)]
pub struct Chord {
    /// Points whose convex hull contains the segment.
    hull: SmallVec<[Arc<Vertex>; 3]>,
    plane: Arc<Plane>,
    line: LineKey,
}

impl Chord {
    /// Returns two flags: whether a part of the chord may lie on the minus side of a plane, and whether a
    /// part may lie on the plus side.
    fn reaches(&self, plane: &Plane) -> [bool; 2] {
        let sides: SmallVec<[Side; 3]> = self.hull.iter().map(|p| p.side_of(plane)).collect();
        [Side::Minus, Side::Plus].map(|side| sides.contains(&side))
    }
}

/// A part of the polygon of a plane group (the boundary faces of one plane), and the chords that divide it
/// further.
struct Part {
    edges: Vec<BareEdge>,
    faces: SmallVec<[OrientedFace; 2]>,
    chords: Vec<Chord>,
}

/// Divides the polygon of a plane group (the boundary faces of one plane) along chords, each extended through
/// the part that it lies in: a planar autopartition. Appends to `lines` the line of each chord that was used.
///
/// # Cost
/// Each part is traversed once for each chord that divides it. The middle chord of a list comes first: of
/// sorted parallel chords, half lie on either side of it.
///
/// # Source
/// Thibault, Naylor 1987 (autopartition).
pub fn divided(
    group: PlaneGroup,
    chords: Vec<Chord>,
    sources: &Sources,
    lines: &mut Vec<LineKey>,
) -> Vec<PlaneGroup> {
    let plane = Arc::clone(&group.plane);
    let mut done = Vec::new();
    let mut open = vec![Part {
        edges: group.edges().to_vec(),
        faces: group.faces,
        chords,
    }];
    while let Some(mut part) = open.pop() {
        poll();
        if part.chords.is_empty() {
            done.push(PlaneGroup {
                plane: Arc::clone(&plane),
                faces: part.faces,
                outline: Outline::of_bare(&part.edges),
            });
            continue;
        }
        let pivot = part.chords.swap_remove(part.chords.len() / 2);
        lines.push(pivot.line);
        // A chord on the same line divides neither half.
        part.chords.retain(|chord| chord.line != pivot.line);
        let halves = part.halved(&plane, &pivot.plane, sources);
        open.extend(halves.into_iter().filter(|half| !half.edges.is_empty()));
    }
    done
}

impl Part {
    /// Returns the parts on the minus and on the plus side of `cut`, a plane across the group's plane
    /// `support`.
    fn halved(self, support: &Arc<Plane>, cut: &Arc<Plane>, sources: &Sources) -> [Self; 2] {
        let mut halves = halves(self.edges, support, cut).map(|edges| Self {
            edges,
            faces: SmallVec::new(),
            chords: Vec::new(),
        });
        for chord in self.chords {
            poll();
            let reached = halves.iter_mut().zip(chord.reaches(cut));
            for (half, _) in reached.filter(|(_, reaches)| *reaches) {
                half.chords.push(chord.clone());
            }
        }
        for face in self.faces {
            poll();
            let reached = halves.iter_mut().zip(reaches(face, cut, sources));
            for (half, _) in reached.filter(|(_, reaches)| *reaches) {
                half.faces.push(face);
            }
        }
        halves
    }
}

/// Returns two flags: whether a corner of a face lies on the minus side of a plane, and whether a corner lies
/// on the plus side.
fn reaches(face: OrientedFace, plane: &Plane, sources: &Sources) -> [bool; 2] {
    let Some(mesh) = sources.get(face.slot()).mesh() else {
        // A half-space's face is everywhere.
        return [true; 2];
    };
    let sides = mesh.corners(face.id()).map(|p| plane.side_of_lattice(&p));
    [Side::Minus, Side::Plus].map(|side| sides.contains(&side))
}
