//! A solid's exact boundary as plain data: stored, moved, refined, and made into a tree again.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::sealed::{seal, unseal, Kind};
use super::sound::is_sound;
use super::wholes::WholeFaces;
use crate::arith::bounds::{self, is_coordinate, COORDINATE_BITS};
use crate::arith::{Int, Sign};
use crate::error::{Error, ErrorKind, Result};
use crate::extract::boundary::collect::{collect, CutFace};
use crate::extract::rounding::snapping::{
    crosses_once_snapped, crossing_faces, look_at, look_at_contacts, moved_doubles,
};
use crate::geometry::cell::Cell;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{cancelled_if_needed, BareEdge, OutlineEdge};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Carrier;
use crate::geometry::side::{Half, Orientation, Side};
use crate::geometry::spaces::motion::Motion;
use crate::geometry::vertex::{cross, Vertex};
use crate::interrupt::poll;
use crate::merge::evaluate::normalize;
use crate::merge::lists::list::Sources;
use crate::merge::rule::Rule;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::{FaceId, Slot, VertexId};
use crate::mesh::import::is_flat;
use crate::mesh::source::{Shape, Source};
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node, Part, PartElement};
use crate::tree::solid::Solid;

/// The exact boundary of a solid as plain data, without its tree.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::import::import;
/// use bspcsg::store::snapshot::Snapshot;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// let mut bytes = Snapshot::of(&solid).to_bytes()?;
/// assert_eq!(Snapshot::solid_from_bytes(&bytes)?.pitch(), solid.pitch());
/// // Damage is noticed.
/// bytes[40] ^= 1;
/// assert!(Snapshot::solid_from_bytes(&bytes).is_err());
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    pitch: i64,
    outside: i32,
    reduced: bool,
    sources: Vec<SourceData>,
    wholes: Vec<WholeFaces>,
    parts: Vec<PartData>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum SourceData {
    Mesh(TriangleMesh),
    HalfSpace(PlaneData),
    /// A mesh with its pairs of faces that touch, found by an earlier search, so that images of the mesh need
    /// no search.
    Searched(TriangleMesh, Vec<[u32; 2]>),
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct PartData {
    slot: Slot,
    face: FaceId,
    /// True if the orientation of the part is opposite to its face.
    flip: bool,
    edges: Vec<EdgeData>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct EdgeData {
    from: VertexData,
    to: VertexData,
    carrier: CarrierData,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum CarrierData {
    Edge(Lattice, Lattice),
    Cut(PlaneData, bool),
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum VertexData {
    Lattice(Lattice),
    Meet([[u64; 6]; 3], [u64; 6]),
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct PlaneData([i128; 3], [u64; 3]);

fn too_large() -> Error {
    let text = "the moved or refined solid does not fit the lattice of 2^53 steps; move the solid less, or \
                choose a coarser pitch";
    Error::new(ErrorKind::TooLarge, text)
}

fn bad_snapshot() -> Error {
    Kind::Solid.contradiction()
}

impl Snapshot {
    /// Collects the exact boundary of a solid.
    pub fn of(solid: &Solid) -> Self {
        let sources = Sources::new(solid.sources().clone());
        let boundary = collect(solid, &sources);
        let mut wholes = WholeFaces::of(&boundary);
        let (planes, cut): (Vec<_>, Vec<_>) = boundary.cut.iter().partition(|c| is_full_plane(c));
        wholes.extend(planes.into_iter().map(WholeFaces::plane));
        let parts = cut.into_iter().map(|c| PartData {
            slot: c.face.slot(),
            face: c.face.id(),
            flip: c.face.orientation.is_opposite(),
            edges: c.outline.edges().iter().map(EdgeData::of).collect(),
        });
        let parts: Vec<_> = parts.collect();
        Self {
            pitch: solid.pitch().exponent(),
            outside: solid.root().outside,
            reduced: solid.is_reduced(),
            sources: SourceData::of_all(solid, &wholes, &parts),
            wholes,
            parts,
        }
    }

    /// Makes the solid with this boundary, as one deferred leaf.
    ///
    /// # Errors
    /// `BadSnapshot` if the data contradict themselves.
    pub fn solid(&self) -> Result<Solid> {
        let pitch = Pitch::new(self.pitch)?;
        let made = |s: &SourceData| Ok(Arc::new(s.source(pitch)?));
        let sources: Result<Vec<_>> = self.sources.iter().map(made).collect();
        self.solid_of(pitch, &sources?)
    }

    fn solid_of(&self, pitch: Pitch, sources: &[Arc<Source>]) -> Result<Solid> {
        let cell = sources
            .iter()
            .filter_map(|s| s.cell())
            .reduce(|a, b| a.join(&b));
        let Some(cell) = cell.filter(|_| !(self.wholes.is_empty() && self.parts.is_empty())) else {
            return Ok(Solid::uniform(pitch, self.outside > 0));
        };
        let mut leaf = DeferredLeaf {
            corner: self.outside,
            ..DeferredLeaf::default()
        };
        for w in &self.wholes {
            poll();
            let source = sources.get(w.slot.index()).ok_or_else(bad_snapshot)?;
            let known = w.faces.iter().all(|f| f.index() < source.face_count());
            if !known || !w.faces.is_sorted_by(|a, b| a < b) {
                return Err(bad_snapshot());
            }
            let source = Arc::clone(source);
            leaf.groups.push(FaceGroup {
                source,
                orientation: w.manner.orientation(),
                touching: w.manner.is_touching(),
                faces: w.faces.clone(),
            });
        }
        for p in &self.parts {
            poll();
            leaf.parts.push(p.element(sources, cell)?);
        }
        let node = Arc::new(Node::Deferred(leaf));
        let root = Branch {
            cell,
            outside: self.outside,
            complement: false,
            node,
        };
        Ok(Solid::new(
            root,
            pitch,
            sources.iter().collect(),
            self.reduced,
        ))
    }

    /// Returns the image of a solid under a motion of its lattice; each source stores its image for each
    /// motion.
    ///
    /// On axes along which a motion shifts, vertices take the doubles of their lattice points. If that makes
    /// a mesh cross itself, the solid is first united with itself, and all its vertices take the doubles of
    /// their lattice points.
    ///
    /// # Errors
    /// `TooLarge` if a point or plane leaves the lattice; `Unbounded`, `Internal`.
    pub fn image(solid: &Solid, motion: &Motion) -> Result<Solid> {
        let pitch = solid.pitch();
        if crosses_once_snapped(solid, motion.shifted()) {
            let solid = normalize(solid, Rule::Positive)?;
            look_at_contacts(&solid, motion);
            let mut data = Self::of(&solid);
            for source in &mut data.sources {
                source.snap(pitch);
            }
            return data.moved(motion, pitch)?.solid();
        }
        look_at_contacts(solid, motion);
        let data = Self::of(solid).moved(motion, pitch)?;
        let each = solid.sources().iter().zip(&data.sources);
        let images: Result<Vec<_>> = each.map(|(s, data)| data.image(s, motion)).collect();
        data.solid_of(pitch, &images?)
    }

    /// Returns the image of the boundary under a motion of the lattice, on a lattice of the given pitch.
    ///
    /// # Errors
    /// `TooLarge` if a point or plane leaves the lattice.
    pub fn moved(&self, motion: &Motion, pitch: Pitch) -> Result<Self> {
        if self.reaches_infinity() {
            let text =
                "an unbounded solid other than a half-space cannot be moved; intersect the solid \
                        with a box first";
            return Err(Error::new(ErrorKind::Unbounded, text));
        }
        let mut image = self.clone();
        image.pitch = pitch.exponent();
        for source in &mut image.sources {
            source.apply(motion, pitch)?;
        }
        for edge in image.parts.iter_mut().flat_map(|p| &mut p.edges) {
            edge.apply(motion)?;
        }
        image.outside = image.label_at_infinity()?;
        Ok(image)
    }

    /// Returns the same boundary on a finer lattice; the empty and the full set fit any lattice.
    ///
    /// # Errors
    /// `TooLarge` if a point or plane leaves the lattice; `PitchMismatch` if `finer` is coarser than the
    /// lattice.
    pub fn refined(&self, finer: Pitch) -> Result<Self> {
        let own = Pitch::new(self.pitch)?;
        if self.wholes.is_empty() && self.parts.is_empty() {
            return Ok(Self {
                pitch: finer.exponent(),
                sources: Vec::new(),
                ..self.clone()
            });
        }
        if finer > own {
            let text = format!(
                "the lattice step 10^{} is not finer than 10^{}",
                finer.exponent(),
                self.pitch
            );
            return Err(Error::new(ErrorKind::PitchMismatch, text));
        }
        let scale = finer.refinement(own).ok_or_else(too_large)?;
        let motion = Motion {
            scale,
            ..Motion::IDENTITY
        };
        self.moved(&motion, finer)
    }

    /// Returns true if the boundary has an unbounded face and other faces, or a face that is cut at the
    /// border of the universe.
    fn reaches_infinity(&self) -> bool {
        let unbounded = |slot: Slot| {
            matches!(
                self.sources.get(slot.index()),
                Some(SourceData::HalfSpace(_))
            )
        };
        let alone = self.wholes.len() == 1 && self.parts.is_empty();
        let edges = self
            .parts
            .iter()
            .filter(|p| unbounded(p.slot))
            .flat_map(|p| &p.edges);
        (self.wholes.iter().any(|w| unbounded(w.slot)) && !alone)
            || edges
                .into_iter()
                .any(|e| e.carrier.carrier().is_ok_and(|c| c.is_border()))
    }

    /// Returns the winding number of the solid at the corner of the universe with the least coordinates; if a
    /// single plane is the whole boundary, its orientation decides.
    fn label_at_infinity(&self) -> Result<i32> {
        if let [only] = self.wholes.as_slice()
            && let Some(SourceData::HalfSpace(plane)) = self.sources.get(only.slot.index())
        {
            let side = plane.plane()?.side_of_corner(&Cell::UNIVERSE.corner());
            let turned = only.manner.orientation().is_opposite();
            return Ok(i32::from((side == Half::Minus) != turned));
        }
        Ok(self.outside)
    }

    /// Encodes the boundary as bytes.
    ///
    /// # Errors
    /// `Internal` if encoding fails.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let sources = self.sources.iter().cloned().map(SourceData::written);
        let written = Self {
            sources: sources.collect(),
            ..self.clone()
        };
        seal(Kind::Solid, &written)
    }

    /// Decodes a solid from bytes, which are checked in full.
    ///
    /// One claim is trusted ([`Solid::marked_as_claimed`]): that the faces are the reduced boundary. Checking
    /// it would cost ten times as much as all other checks together.
    ///
    /// # Errors
    /// `BadSnapshot`.
    pub fn solid_from_bytes(bytes: &[u8]) -> Result<Solid> {
        let snapshot: Self = unseal(Kind::Solid, bytes)?;
        let solid = snapshot.solid().map_err(|_| bad_snapshot())?;
        if !matches!(snapshot.outside, 0 | 1) || !is_sound(&solid) {
            return Err(bad_snapshot());
        }
        Ok(solid.marked_as_claimed())
    }
}

/// Returns true if a half-space's face is cut only by the border of the universe.
fn is_full_plane(cut: &CutFace) -> bool {
    let mut edges = cut.outline.edges().iter();
    edges.all(|e| e.carrier.is_border())
}

impl SourceData {
    /// Returns the data of a solid's sources; a source without a boundary face becomes an empty mesh.
    fn of_all(solid: &Solid, wholes: &[WholeFaces], parts: &[PartData]) -> Vec<Self> {
        let mut is_named = vec![false; solid.sources().len()];
        let slots = wholes.iter().map(|w| w.slot);
        for slot in slots.chain(parts.iter().map(|p| p.slot)) {
            is_named[slot.index()] = true;
        }
        let all = solid.sources().iter().zip(is_named);
        all.map(|(source, is_named)| {
            if is_named {
                Self::of(source)
            } else {
                Self::Mesh(TriangleMesh::default())
            }
        })
        .collect()
    }

    fn of(source: &Source) -> Self {
        match source.shape() {
            Shape::Mesh(mesh) => {
                if source.passing_pairs().get().is_some_and(|p| !p.is_empty()) {
                    // The pairs are stored as one list, of which a reader takes that it is complete.
                    look_at(source, mesh);
                }
                if source.close_pairs().get().is_some() {
                    Self::Searched(mesh.clone(), source.suspected_pairs())
                } else {
                    Self::Mesh(mesh.clone())
                }
            }
            Shape::HalfSpace(plane) => Self::HalfSpace(PlaneData::of(plane)),
        }
    }

    fn mesh(&mut self) -> Option<&mut TriangleMesh> {
        match self {
            Self::Mesh(mesh) | Self::Searched(mesh, _) => Some(mesh),
            Self::HalfSpace(_) => None,
        }
    }

    fn source(&self, pitch: Pitch) -> Result<Source> {
        let of_mesh = |mesh: &TriangleMesh| {
            let shape = Shape::Mesh(mesh.clone());
            let is_sound = is_sound_mesh(mesh);
            is_sound.then(|| Source::new(pitch, shape, Vec::new()))
        };
        match self {
            Self::HalfSpace(plane) => {
                let shape = Shape::HalfSpace(Arc::new(plane.plane()?));
                Ok(Source::new(pitch, shape, Vec::new()))
            }
            Self::Mesh(mesh) => of_mesh(mesh).ok_or_else(bad_snapshot),
            Self::Searched(mesh, pairs) => {
                let named = pairs
                    .iter()
                    .flatten()
                    .all(|t| (*t as usize) < mesh.faces.len());
                let source = of_mesh(mesh).filter(|_| named).ok_or_else(bad_snapshot)?;
                Ok(source.with_close_pairs(pairs.clone()))
            }
        }
    }

    /// Returns the image of a source under a motion, made of `self`, the data of the moved source.
    fn image(&self, source: &Source, motion: &Motion) -> Result<Arc<Source>> {
        let made = || Ok(Arc::new(self.source(source.pitch())?));
        // A source that bounds nothing becomes an empty mesh, even if its image is known.
        if matches!(self, Self::Mesh(mesh) if mesh.faces.is_empty()) {
            return made();
        }
        if let Some(known) = source.images().get(motion) {
            return Ok(known);
        }
        Ok(source.images().keep(motion, made()?))
    }

    /// Returns the data to write; pairs of close faces are written only if some faces cross, because a reader
    /// would not search for these.
    fn written(self) -> Self {
        match self {
            Self::Searched(mesh, pairs) if crossing_faces(&mesh, &pairs).is_empty() => {
                Self::Mesh(mesh)
            }
            other => other,
        }
    }

    /// Replaces the doubles of all vertices by the doubles of their lattice points.
    fn snap(&mut self, pitch: Pitch) {
        if let Some(mesh) = self.mesh() {
            for (place, double) in mesh.vertices.iter().zip(&mut mesh.doubles) {
                *double = place.map(|k| pitch.coordinate(k));
            }
        }
    }

    fn apply(&mut self, motion: &Motion, pitch: Pitch) -> Result<()> {
        if let Self::HalfSpace(plane) = self {
            *plane = plane.moved(motion)?;
        }
        let Some(mesh) = self.mesh() else {
            return Ok(());
        };
        for (vertex, double) in mesh.vertices.iter_mut().zip(&mut mesh.doubles) {
            *vertex = motion.point(vertex).ok_or_else(too_large)?;
            *double = moved_doubles(motion, pitch, double, vertex);
        }
        if motion.mirrors() {
            for face in &mut mesh.faces {
                face.swap(1, 2);
            }
        }
        Ok(())
    }
}

/// Returns true if the lists have matching lengths, and no face is flat or names a missing vertex.
fn is_sound_mesh(mesh: &TriangleMesh) -> bool {
    let TriangleMesh {
        vertices,
        doubles,
        faces,
        numbers,
    } = mesh;
    let count = vertices.len();
    let named = faces.iter().flatten().all(|v| v.index() < count);
    let fits = vertices.iter().flatten().all(|k| is_coordinate(*k));
    let numbered = numbers.as_ref().is_none_or(|n| n.len() == faces.len());
    let flat = |f: &[VertexId; 3]| is_flat(&f.map(|v| vertices[v.index()]));
    named && fits && numbered && doubles.len() == count && !faces.iter().any(flat)
}

impl PartData {
    fn element(&self, sources: &[Arc<Source>], home: Cell) -> Result<PartElement> {
        let source = sources.get(self.slot.index()).ok_or_else(bad_snapshot)?;
        if self.face.index() >= source.face_count() {
            return Err(bad_snapshot());
        }
        let support = source.plane(self.face);
        let edges = self
            .edges
            .iter()
            .map(|e| e.edge(&support))
            .collect::<Result<Vec<_>>>()?;
        if !is_balanced(&edges) {
            return Err(bad_snapshot());
        }
        let part = Part::new(
            Arc::clone(source),
            self.face,
            home,
            cancelled_if_needed(edges),
        );
        Ok(PartElement {
            part: Arc::new(part),
            orientation: Orientation::turned_around(self.flip),
        })
    }
}

impl EdgeData {
    fn of(edge: &BareEdge) -> Self {
        let carrier = match &edge.carrier {
            Carrier::Edge(edge) => {
                let (a, b) = edge.ends();
                CarrierData::Edge(*a, *b)
            }
            Carrier::Cut(plane, flip) => CarrierData::Cut(PlaneData::of(plane), *flip),
        };
        Self {
            from: VertexData::of(&edge.from),
            to: VertexData::of(&edge.to),
            carrier,
        }
    }

    fn edge(&self, support: &Plane) -> Result<OutlineEdge> {
        let carrier = self.carrier.carrier()?;
        let (from, to) = (self.from.vertex()?, self.to.vertex()?);
        if !carries(&carrier, support, &from, &to) {
            return Err(bad_snapshot());
        }
        let line = LineKey::of(&carrier.line(&PlaneResidues::of(support)));
        Ok(OutlineEdge {
            from: Arc::new(from),
            to: Arc::new(to),
            carrier,
            line,
        })
    }

    fn apply(&mut self, motion: &Motion) -> Result<()> {
        self.from = self.from.moved(motion)?;
        self.to = self.to.moved(motion)?;
        let point = |p: &Lattice| motion.point(p).ok_or_else(too_large);
        self.carrier = match &self.carrier {
            CarrierData::Edge(a, b) => CarrierData::Edge(point(a)?, point(b)?),
            CarrierData::Cut(plane, flip) => CarrierData::Cut(plane.moved(motion)?, *flip),
        };
        if motion.mirrors() {
            std::mem::swap(&mut self.from, &mut self.to);
            if let CarrierData::Edge(a, b) = &mut self.carrier {
                std::mem::swap(a, b);
            }
        }
        Ok(())
    }
}

impl CarrierData {
    fn carrier(&self) -> Result<Carrier> {
        Ok(match self {
            Self::Edge(a, b) => Carrier::Edge(LatticeEdge::new(*a, *b)),
            Self::Cut(plane, flip) => Carrier::Cut(Arc::new(plane.plane()?), *flip),
        })
    }
}

/// Returns true if the plane of a carrier and the plane `support` meet in a line that contains both ends of
/// an edge.
fn carries(carrier: &Carrier, support: &Plane, from: &Vertex, to: &Vertex) -> bool {
    let on = |plane: &Plane| from.side_of(plane) == Side::On && to.side_of(plane) == Side::On;
    let crosses = |plane: &Plane| {
        cross(plane.normal(), support.normal())
            .iter()
            .any(|c| !c.is_zero())
    };
    let carried = match carrier {
        Carrier::Edge(edge) => {
            let (a, b) = edge.ends();
            let near = [a, b].iter().all(|p| p.iter().all(|k| is_coordinate(*k)));
            near && a != b
                && support.side_of_lattice(a) == Side::On
                && support.side_of_lattice(b) == Side::On
                && on(&carrier.plane(support))
        }
        Carrier::Cut(plane, _) => crosses(plane) && on(plane),
    };
    carried && on(support) && !from.equals(to)
}

/// Returns true if, at each point, as many edges of an outline start as end.
fn is_balanced(edges: &[OutlineEdge]) -> bool {
    let mut ends: Vec<_> = edges.iter().map(|e| e.from.key()).collect();
    let mut starts: Vec<_> = edges.iter().map(|e| e.to.key()).collect();
    ends.sort_unstable();
    starts.sort_unstable();
    ends == starts
}

impl VertexData {
    fn of(vertex: &Vertex) -> Self {
        if let Some(p) = vertex.as_lattice() {
            return Self::Lattice(*p);
        }
        let h = vertex.coordinates();
        Self::Meet(h.x.map(|c| *c.limbs()), *h.w.limbs())
    }

    fn moved(&self, motion: &Motion) -> Result<Self> {
        match self {
            Self::Lattice(p) => motion.point(p).map(Self::Lattice).ok_or_else(too_large),
            Self::Meet(x, w) => {
                let w6 = Int::from_limbs(*w);
                let mut image = [[0; 6]; 3];
                for (i, (axis, sign)) in motion.axes.into_iter().enumerate() {
                    let turned: Int<8> = Int::from_limbs(x[axis]).mul_i64(sign * motion.scale);
                    let shifted: Int<8> = w6.mul_i64(motion.shift[i]);
                    let sum = (turned + shifted).narrow::<6>().ok_or_else(too_large)?;
                    image[i] = *sum.limbs();
                }
                Ok(Self::Meet(image, *w))
            }
        }
    }

    fn vertex(&self) -> Result<Vertex> {
        match self {
            Self::Lattice(p) if p.iter().all(|k| is_coordinate(*k)) => Ok(Vertex::lattice(*p)),
            Self::Lattice(_) => Err(bad_snapshot()),
            Self::Meet(x, w) => {
                let (x, w) = (x.map(Int::from_limbs), Int::from_limbs(*w));
                let fits = |c: &Int<6>, bits| c.bit_length() <= bits;
                let numerators = x
                    .iter()
                    .all(|c| fits(c, bounds::point_numerator(COORDINATE_BITS)));
                let weight = fits(&w, bounds::point_weight(COORDINATE_BITS));
                if w.sign() != Sign::Positive || !numerators || !weight {
                    return Err(bad_snapshot());
                }
                Ok(Vertex::homogeneous(x, w))
            }
        }
    }
}

impl PlaneData {
    fn of(plane: &Plane) -> Self {
        Self(*plane.normal(), *plane.offset().limbs())
    }

    fn moved(&self, motion: &Motion) -> Result<Self> {
        let image = motion.plane(&self.plane()?).ok_or_else(too_large)?;
        Ok(Self::of(&image))
    }

    fn plane(&self) -> Result<Plane> {
        let offset: Int<3> = Int::from_limbs(self.1);
        let limit = 1u128 << bounds::normal(COORDINATE_BITS);
        let normal = self.0.iter().all(|c| c.unsigned_abs() < limit);
        if !normal || offset.bit_length() > bounds::offset(COORDINATE_BITS) {
            return Err(bad_snapshot());
        }
        Plane::new(self.0, offset).ok_or_else(bad_snapshot)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::Snapshot;
    use crate::extract::rounding::snapping::look_at_contacts;
    use crate::geometry::spaces::motion::Motion;
    use crate::mesh::grid::Pitch;
    use crate::mesh::import::import;
    use crate::tree::solid::Solid;

    #[test]
    fn an_image_has_the_close_pairs_of_its_solid() {
        let floor = [[0.0, 0.0, 1.0], [8.0, 0.0, 1.0], [0.0, 8.0, 2.0], [0.0; 3]];
        let spike = [
            [1.0, 4.0, 1.5],
            [3.0, 1.0, 9.0],
            [1.0, 3.0, 9.0],
            [-1.0, -1.0, 9.0],
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let faces = [faces, faces.map(|t| t.map(|v| v + 4))].concat();
        let source = import(&[floor, spike].concat(), &faces, Pitch::new(-1).ok());
        let solid = Solid::of_source(Arc::new(source.expect("it is closed")), false);
        let motion = Motion::of_axes(&[-2, 1, 3], &[0, 0, 1]).expect("a motion");
        let pairs = |solid: &Solid| {
            solid
                .sources()
                .iter()
                .find_map(|s| s.close_pairs().get().cloned())
        };
        let image = || {
            let data = Snapshot::of(&solid).moved(&motion, solid.pitch());
            data.and_then(|data| data.solid()).expect("an image")
        };
        assert_eq!(pairs(&image()), None);
        look_at_contacts(&solid, &motion);
        let found = pairs(&solid).expect("they were looked for");
        assert!(!found.is_empty());
        assert_eq!(pairs(&image()), Some(found.clone()));
        let again = image();
        look_at_contacts(&again, &motion);
        assert_eq!(pairs(&again), Some(found));
    }
}
