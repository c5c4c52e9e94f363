//! Volume, area and moments of a mesh, in doubles.

use super::handle::VertexId;
use crate::arith::{DoubleDouble, Sum};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::vector::{difference, dot, normal};
use crate::geometry::doubles::Point;
use crate::interrupt::poll;

/// The rounding error of a tetrahedron's volume, as a fraction of the product of the sum norms of three
/// edges. Six times the volume is a determinant, a sum of six products; each product has three rounded
/// differences, two multiplications and three additions.
const VOLUME_ROUNDING: f64 = 8.0 / 6.0 * f64::EPSILON;

/// The largest fraction of a volume that may be rounding error: 2^-32. For a body that fills its box the
/// rounding error is about 2^-48 of the volume; for a thin sheet it is larger by the factor by which the
/// sheet is thinner.
const MAX_ROUNDING_SHARE: f64 = f64::EPSILON * 1_048_576.0;

/// The volume and the area of a mesh.
#[derive(Debug)]
pub struct Measures {
    /// The enclosed volume: the sum of the signed tetrahedra between the faces and a point.
    pub volume: f64,
    /// The surface area: the sum over the faces.
    pub area: f64,
}

/// Measures the volume and area of a closed mesh; each sum is rounded only once.
///
/// `middle` is a point near the mesh. Where rounding errors are too large for the volume, as for a rod far
/// longer than thick, the volume is computed in double-doubles.
pub fn measures(vertices: &[[f64; 3]], faces: &[[VertexId; 3]], middle: [f64; 3]) -> Measures {
    let (mut volume, mut area) = (Sum::default(), Sum::default());
    let mut size = 0.0;
    for face in faces {
        poll();
        let [a, b, c] = face.map(|vertex| vertices[vertex.index()]);
        let normal = normal(&[a, b, c]);
        let from_middle = difference(&a, &middle);
        // The normal comes from edges, so that a small face far from the middle loses no digits to
        // cancellation.
        volume.add(dot(&normal, &from_middle) / 6.0);
        area.add(dot(&normal, &normal).sqrt() / 2.0);
        size += sum_norm(difference(&b, &a)) * sum_norm(difference(&c, &a)) * sum_norm(from_middle);
    }
    let volume = volume.rounded();
    let drowns = size.is_finite() && VOLUME_ROUNDING * size > MAX_ROUNDING_SHARE * volume.abs();
    Measures {
        volume: if drowns {
            moments(vertices, faces, middle).volume
        } else {
            volume
        },
        area: area.rounded(),
    }
}

/// The sum norm of a vector: the sum of its components' magnitudes.
fn sum_norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x.abs()).sum()
}

/// The volume, centroid and second moments of a mesh of density 1.
#[derive(Debug)]
pub struct Moments {
    /// The enclosed volume, the moment of order 0.
    pub volume: f64,
    /// The centroid, relative to the point from which the mesh was measured; not finite without volume.
    pub centroid: [f64; 3],
    /// The second moments: the integrals of the products of two coordinates, relative to the centroid.
    pub second: [[f64; 3]; 3],
}

/// Computes the moments of a closed mesh, relative to a point `middle` near it, in double-doubles.
///
/// # Source
/// A tetrahedron of volume V with corners at the origin, p, q and r has the first moments V/4 (p + q + r).
/// Its second moments are V/20 times the sum of the products of p, q, r and p + q + r, each with itself.
pub fn moments(vertices: &[[f64; 3]], faces: &[[VertexId; 3]], middle: [f64; 3]) -> Moments {
    let zero = DoubleDouble::default();
    let (mut six, mut first, mut second) = (zero, [zero; 3], [[zero; 3]; 3]);
    for face in faces {
        poll();
        let [a, b, c] = face.map(|vertex| &vertices[vertex.index()]);
        let vector =
            |from: &Point, to: &Point| each_axis(|i| DoubleDouble::difference(to[i], from[i]));
        let [p, q, r] = [a, b, c].map(|corner| vector(&middle, corner));
        let weight = determinant(&p, &vector(a, b), &vector(a, c));
        let sum = each_axis(|i| p[i] + q[i] + r[i]);
        six += weight;
        for i in 0..3 {
            first[i] += weight * sum[i];
            for j in 0..=i {
                let [own, others] = [p[i] * p[j] + q[i] * q[j], r[i] * r[j] + sum[i] * sum[j]];
                second[i][j] += weight * (own + others);
            }
        }
    }
    let centroid = each_axis(|i| first[i] / (six * DoubleDouble::from(4.0)));
    let about_centroid = |i: usize, j: usize| {
        let moved = six * DoubleDouble::from(20.0) * centroid[i] * centroid[j];
        (second[i.max(j)][i.min(j)] - moved).rounded() / 120.0
    };
    Moments {
        volume: six.rounded() / 6.0,
        centroid: centroid.map(DoubleDouble::rounded),
        second: each_axis(|i| each_axis(|j| about_centroid(i, j))),
    }
}

fn determinant(
    p: &[DoubleDouble; 3],
    q: &[DoubleDouble; 3],
    r: &[DoubleDouble; 3],
) -> DoubleDouble {
    let minor = |j: usize, k: usize| q[j] * r[k] - q[k] * r[j];
    p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with these side lengths, its lowest corner at the origin.
    fn cuboid(sides: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[VertexId; 3]>) {
        let corner = |k: usize| each_axis(|i| if k >> i & 1 == 1 { sides[i] } else { 0.0 });
        let squares = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let halves = squares
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let faces = halves.map(|face| face.map(VertexId)).collect();
        ((0..8).map(corner).collect(), faces)
    }

    #[test]
    fn a_box_has_its_moments_from_wherever_it_is_measured() {
        let (vertices, faces) = cuboid([2.0, 3.0, 4.0]);
        for middle in [[0.0; 3], [1.0, 1.5, 2.0], [1e9, -1e9, 0.0]] {
            let found = moments(&vertices, &faces, middle);
            let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
            assert!(near(found.volume, 24.0));
            assert!((0..3).all(|i| near(found.centroid[i] + middle[i], [1.0, 1.5, 2.0][i])));
            // A second moment is the volume times a twelfth of the square of a side.
            assert!((0..3).all(|i| near(found.second[i][i], [8.0, 18.0, 32.0][i])));
            assert!(near(found.second[0][1], 0.0) && near(found.second[2][1], 0.0));
        }
    }

    #[test]
    fn volume_does_not_drown_in_length() {
        let (vertices, faces) = cuboid([1e6, 1e-6, 3.0]);
        // After a rotation about the diagonal of two axes, no coordinate is small.
        let (cos, sin) = (0.6, 0.8);
        let turned = |[x, y, z]: [f64; 3]| [x * cos - y * sin, x * sin + y * cos, z + x];
        let vertices: Vec<_> = vertices.into_iter().map(turned).collect();
        let middle = [3e5, 4e5, 5e5];
        let [plain, exact] = [
            measures(&vertices, &faces, middle).volume,
            moments(&vertices, &faces, [0.0; 3]).volume,
        ];
        assert!((plain - exact).abs() < 1e-12 * exact.abs());
        assert!((exact - 3.0).abs() < 1e-3);
    }
}
