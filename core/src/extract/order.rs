//! Sorts new points and triangles of a mesh. The order depends on positions alone, so that equal results have
//! equal bytes, independent of earlier evaluations.
//!
//! Constructed points are sorted by their doubles, with copies next to each other. Triangles that are not
//! untouched faces are sorted by face, then by vertices; each starts at its vertex with the lowest number.

use std::cmp::Ordering;

use super::mesh::{Corner, ExactMesh};
use crate::geometry::vertices::VertexTable;
use crate::interrupt::{poll, spend};
use crate::mesh::handle::{OrientedFace, VertexId};

/// Sorts the constructed points of a mesh, with their positions in doubles, and its new triangles.
pub(super) fn put_in_order(mesh: &mut ExactMesh, positions: &mut [[f64; 3]]) {
    sort_points(mesh, positions);
    sort_new_triangles(mesh);
}

fn sort_points(mesh: &mut ExactMesh, positions: &mut [[f64; 3]]) {
    let is_given = |corner: &Corner| matches!(corner, Corner::Source(..));
    let first = mesh.vertices.partition_point(is_given);
    let corners = mesh.vertices[first..].iter().zip(&positions[first..]);
    let mut points: Vec<([f64; 3], u32, usize)> = Vec::with_capacity(corners.len());
    for (number, (corner, position)) in corners.enumerate() {
        if let Corner::Point(point) = *corner {
            points.push((*position, point, number));
        }
    }
    // Copies of a point keep their order.
    points.sort_by(|a, b| by_place(a.0, b.0).then_with(|| by_point(&mesh.table, a.1, b.1)));
    let mut numbers = vec![VertexId::default(); points.len()];
    for (number, (position, point, before)) in (first..).zip(points) {
        numbers[before] = VertexId::of(number);
        mesh.vertices[number] = Corner::Point(point);
        positions[number] = position;
    }
    // Untouched faces have no constructed corners.
    for vertex in mesh.triangles[mesh.untouched..].iter_mut().flatten() {
        if let Some(place) = vertex.index().checked_sub(first) {
            *vertex = numbers[place];
        }
    }
}

fn by_place(a: [f64; 3], b: [f64; 3]) -> Ordering {
    let by = |axis: usize| a[axis].total_cmp(&b[axis]);
    by(0).then_with(|| by(1)).then_with(|| by(2))
}

/// Compares two points with equal doubles by their exact coordinates.
fn by_point(table: &VertexTable, a: u32, b: u32) -> Ordering {
    poll();
    if a == b {
        return Ordering::Equal;
    }
    let by = |axis: usize| table.point(a).compare(table.point(b), axis);
    by(0).then_with(|| by(1)).then_with(|| by(2))
}

fn sort_new_triangles(mesh: &mut ExactMesh) {
    let triangles = &mut mesh.triangles[mesh.untouched..];
    let faces = &mut mesh.faces[mesh.untouched..];
    spend(triangles.len());
    let first_lowest = |&[a, b, c]: &[VertexId; 3]| match a.min(b).min(c) {
        low if low == a => [a, b, c],
        low if low == b => [b, c, a],
        _ => [c, a, b],
    };
    let rows = faces
        .iter()
        .copied()
        .zip(triangles.iter().map(first_lowest));
    let mut rows: Vec<(OrientedFace, [VertexId; 3])> = rows.collect();
    rows.sort_unstable();
    for ((face, triangle), row) in faces.iter_mut().zip(triangles).zip(rows) {
        (*face, *triangle) = row;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::assemble::assemble;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, tetrahedra};
    use crate::tree::solid::Solid;

    fn ordered(solid: &Solid) -> (ExactMesh, Vec<[f64; 3]>) {
        let mut mesh = assemble(solid).expect("bounded");
        let mut positions = mesh.positions(solid);
        put_in_order(&mut mesh, &mut positions);
        (mesh, positions)
    }

    #[test]
    fn vertices_come_by_source_or_place_and_new_triangles_by_face() {
        let solid = made_of(&tetrahedra(), Term::Xor);
        let (mesh, positions) = ordered(&solid);
        let points = |corner: &&Corner| matches!(corner, Corner::Point(_));
        let count = mesh.vertices.iter().filter(points).count();
        let (given, made) = mesh.vertices.split_at(mesh.vertices.len() - count);
        assert!(given.is_sorted() && given.iter().all(|c| matches!(c, Corner::Source(..))));
        assert!(made.iter().all(|c| matches!(c, Corner::Point(_))));
        assert!(positions[given.len()..].is_sorted());
        assert_eq!(positions, mesh.positions(&solid));
        let new = mesh.untouched..mesh.triangles.len();
        let rows: Vec<_> = new.map(|t| (mesh.faces[t], mesh.triangles[t])).collect();
        assert!(rows.is_sorted());
        let begins_at_lowest = |t: &[VertexId; 3]| t[0] < t[1] && t[0] < t[2];
        assert!(rows.iter().all(|(_, triangle)| begins_at_lowest(triangle)));
    }

    #[test]
    fn copies_of_a_vertex_follow_it() {
        let boxes = [cuboid([0; 3], [4; 3]), cuboid([4, 4, 0], [8, 8, 4])];
        let (mesh, _) = ordered(&made_of(&boxes, Term::Or));
        assert!(mesh.vertices.is_sorted());
        let pairs = mesh.vertices.windows(2);
        assert_eq!(pairs.filter(|pair| pair[0] == pair[1]).count(), 2);
    }

    #[test]
    fn points_of_equal_doubles_come_in_their_exact_order() {
        let mut table = VertexTable::default();
        let [a, b] = [[0, 0, 1], [0, 0, 2]].map(|place| table.number_at(place));
        assert_eq!(by_point(&table, a, b), Ordering::Less);
        assert_eq!(by_point(&table, b, a), Ordering::Greater);
        assert_eq!(by_point(&table, a, a), Ordering::Equal);
    }
}
