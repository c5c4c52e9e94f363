//! The numbers of a file at once: Python's own way takes ten times as long with those of a text, and
//! numpy's four times as long with those of records that are not aligned.

use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arrays::{flat, rows};
use super::errors::to_python;

/// Largest number of digits that cannot pass 2^53, below which every whole number is a double.
const SHORT: usize = 15;

/// The decimal numbers among the words of `text`, each rounded once, in their order.
///
/// A number begins with a digit, a sign or a point that no letter precedes, and ends before the
/// first byte that no number has. What looks like one and is none is an error.
#[pyfunction]
pub fn numbers_in<'py>(py: Python<'py>, text: &[u8]) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let found = py.detach(|| scanned(text));
    let values = found.map_err(|at| PyValueError::new_err(format!("no number at byte {at}")))?;
    Ok(PyArray1::from_vec(py, values))
}

/// True if the faces of a binary PLY are these triangles; each is a byte that says three, and three
/// little-endian `i32`.
///
/// # Errors
/// `Shape` if the triangles have not three corners each.
#[pyfunction]
pub fn are_triangles(
    py: Python<'_>,
    faces: &[u8],
    triangles: PyReadonlyArray2<'_, i64>,
) -> PyResult<bool> {
    let expected = rows(&triangles, "triangles").map_err(|e| to_python(py, &e))?;
    Ok(py.detach(|| same_triangles(faces, &expected)))
}

/// True if the vertices of a binary PLY are these points, bit by bit; each is three little-endian
/// doubles.
#[pyfunction]
pub fn are_points(py: Python<'_>, vertices: &[u8], points: PyReadonlyArray2<'_, f64>) -> bool {
    let expected = flat(&points);
    py.detach(|| same_numbers(vertices, &expected))
}

fn same_numbers(found: &[u8], expected: &[f64]) -> bool {
    let (found, rest) = found.as_chunks();
    let pairs = found.iter().zip(expected);
    let bits = pairs.fold(0, |bits, (a, b)| {
        bits | u64::from_le_bytes(*a) ^ b.to_bits()
    });
    rest.is_empty() && found.len() == expected.len() && bits == 0
}

/// Bytes of a triangle in a binary PLY.
const FACE: usize = 13;

fn same_triangles(faces: &[u8], triangles: &[[i64; 3]]) -> bool {
    let (faces, rest) = faces.as_chunks::<FACE>();
    // All bits that differ: with no branch on the way, no face waits for the one before.
    let mut bits = 0;
    for (face, [a, b, c]) in faces.iter().zip(triangles) {
        let corner = |k: usize| {
            let bytes = [face[k], face[k + 1], face[k + 2], face[k + 3]];
            i64::from(i32::from_le_bytes(bytes))
        };
        bits |= i64::from(face[0] ^ 3) | (corner(1) ^ a) | (corner(5) ^ b) | (corner(9) ^ c);
    }
    rest.is_empty() && faces.len() == triangles.len() && bits == 0
}

/// The numbers, or where one is not valid.
fn scanned(text: &[u8]) -> Result<Vec<f64>, usize> {
    let mut values = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let byte = text[at];
        if byte.is_ascii_alphabetic() || byte == b'_' {
            at += length_of(&text[at..], is_of_word);
        } else if is_of_number(byte) {
            let length = length_of(&text[at..], is_of_number);
            values.push(value(&text[at..at + length]).ok_or(at)?);
            at += length;
        } else {
            at += 1;
        }
    }
    Ok(values)
}

fn length_of(text: &[u8], belongs: fn(u8) -> bool) -> usize {
    text.iter()
        .position(|&byte| !belongs(byte))
        .unwrap_or(text.len())
}

fn is_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

fn is_of_number(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E')
}

fn value(digits: &[u8]) -> Option<f64> {
    if digits.len() <= SHORT && digits.iter().all(u8::is_ascii_digit) {
        let add = |sum: u64, &digit: &u8| sum * 10 + u64::from(digit - b'0');
        return Some(digits.iter().fold(0, add) as f64);
    }
    std::str::from_utf8(digits).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::{same_triangles, scanned};

    #[test]
    fn numbers_among_words() {
        let text = b"v 1 -2.5 3e-05\n<x v1=\"7\" y=\"+.5\"/> end 2e9 12345678901234567890";
        let expected = [1.0, -2.5, 3e-5, 7.0, 0.5, 2e9, 12_345_678_901_234_567_890.0];
        assert_eq!(scanned(text), Ok(expected.to_vec()));
        assert_eq!(scanned(b""), Ok(vec![]));
        assert_eq!(scanned(b"a1 _2 3"), Ok(vec![3.0]));
    }

    #[test]
    fn what_is_no_number_has_a_place() {
        assert_eq!(scanned(b"1 2-3"), Err(2));
        assert_eq!(scanned(b" ."), Err(1));
    }
    #[test]
    fn triangles_of_records() {
        let record = |count: u8, corners: [i32; 3]| {
            let numbers = corners.into_iter().flat_map(i32::to_le_bytes);
            std::iter::once(count).chain(numbers).collect::<Vec<u8>>()
        };
        let triangles = [[0, 1, 2], [70_000, 300, i64::from(i32::MAX)]];
        let faces = [record(3, [0, 1, 2]), record(3, [70_000, 300, i32::MAX])].concat();
        assert!(same_triangles(&faces, &triangles));
        assert!(same_triangles(&[], &[]));
        for at in 0..faces.len() {
            let mut other = faces.clone();
            other[at] ^= 1;
            assert!(!same_triangles(&other, &triangles), "byte {at}");
            assert!(!same_triangles(&faces[..at], &triangles), "{at} bytes");
        }
        assert!(!same_triangles(&faces, &triangles[..1]));
        assert!(!same_triangles(
            &record(3, [-1, 1, 2]),
            &[[(1 << 32) - 1, 1, 2]]
        ));
    }
}
