//! Reads all numbers of a file at once: Python takes ten times as long for numbers in a text, and numpy
//! three to four times as long for numbers that are not aligned or have the other byte order.

use std::str::FromStr;

use numpy::{Element, PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::arrays::{flat, rows};
use super::ending::detached;
use super::errors::to_python;
use crate::arith::convert::as_double;

/// The byte that represents a number in the pattern of a row.
const NUMBER: u8 = b'#';

/// Return the decimal numbers of a text that consists of repetitions of `row`, in order, each rounded once.
///
/// In `row`, the byte `#` represents a number, and every other byte must occur in the text as it is.
#[pyfunction]
pub fn numbers_in_rows<'py>(
    py: Python<'py>,
    text: &[u8],
    row: &[u8],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    in_rows(py, text, row)
}

/// Return the whole numbers of a text that consists of repetitions of the pattern `row`, in which `#`
/// represents a number.
#[pyfunction]
pub fn whole_numbers_in_rows<'py>(
    py: Python<'py>,
    text: &[u8],
    row: &[u8],
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    in_rows(py, text, row)
}

fn in_rows<'py, T: Decimal + Element>(
    py: Python<'py>,
    text: &[u8],
    row: &[u8],
) -> PyResult<Bound<'py, PyArray1<T>>> {
    let found = detached(py, || scanned(text, row));
    let values = found.map_err(|at| {
        PyValueError::new_err(format!("the text has an unexpected line at byte {at}"))
    })?;
    Ok(PyArray1::from_vec(py, values))
}

/// Return true if the faces of a binary PLY file are the given triangles; each face is a byte 3 and three
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
    Ok(detached(py, || same_triangles(faces, &expected)))
}

/// Return true if bytes are the given 64-bit numbers; each takes eight bytes, the lowest first, or the
/// highest if `big_endian`.
#[pyfunction]
pub fn are_words(
    py: Python<'_>,
    data: &[u8],
    words: PyReadonlyArray2<'_, u64>,
    big_endian: bool,
) -> bool {
    let expected = flat(&words);
    detached(py, || {
        if big_endian {
            same_words(data, &expected, u64::from_be_bytes)
        } else {
            same_words(data, &expected, u64::from_le_bytes)
        }
    })
}

fn same_words(bytes: &[u8], expected: &[u64], word: impl Fn([u8; 8]) -> u64) -> bool {
    let (found, rest) = bytes.as_chunks();
    let pairs = found.iter().zip(expected);
    // Collects all bits that differ, without branches.
    let bits = pairs.fold(0, |bits, (a, b)| bits | word(*a) ^ b);
    rest.is_empty() && found.len() == expected.len() && bits == 0
}

/// The number of bytes of a triangle in a binary PLY file.
const PLY_TRIANGLE_BYTES: usize = 13;

fn same_triangles(faces: &[u8], triangles: &[[i64; 3]]) -> bool {
    let (faces, rest) = faces.as_chunks::<PLY_TRIANGLE_BYTES>();
    if !rest.is_empty() || faces.len() != triangles.len() {
        return false;
    }
    // Collects all bits that differ, separately for each number: so no face waits for the one before.
    let mut bits = [0; 4];
    for (face, [a, b, c]) in faces.iter().zip(triangles) {
        let corner = |k: usize| {
            let bytes = [face[k], face[k + 1], face[k + 2], face[k + 3]];
            i64::from(i32::from_le_bytes(bytes))
        };
        bits[0] |= i64::from(face[0] ^ 3);
        bits[1] |= corner(1) ^ a;
        bits[2] |= corner(5) ^ b;
        bits[3] |= corner(9) ^ c;
    }
    bits == [0; 4]
}

/// A type of number that is read from a text.
trait Decimal: FromStr + Send {
    /// Returns the value of digits without sign, point or exponent, few enough for it to be exact.
    fn of_digits(digits: &[u8]) -> Self;
}

/// The largest number of digits that cannot exceed 2^53, below which every whole number is a double.
const MAX_EXACT_DIGITS: usize = 15;

impl Decimal for i64 {
    fn of_digits(digits: &[u8]) -> i64 {
        let add = |sum: i64, &digit: &u8| sum * 10 + i64::from(digit - b'0');
        digits.iter().fold(0, add)
    }
}

impl Decimal for f64 {
    fn of_digits(digits: &[u8]) -> f64 {
        as_double(i64::of_digits(digits))
    }
}

/// Returns the numbers of a text of rows; the error is the index of the byte at which the text differs from
/// the pattern.
fn scanned<T: Decimal>(text: &[u8], row: &[u8]) -> Result<Vec<T>, usize> {
    let mut between = row.split(|byte| *byte == NUMBER);
    let first = between.next().unwrap_or_default();
    let others: Vec<&[u8]> = between.collect();
    let mut values = Vec::new();
    let mut at = 0;
    while at < text.len() {
        // A pattern without bytes matches no text.
        if row.is_empty() {
            return Err(at);
        }
        at = behind(text, at, first)?;
        for next in &others {
            let length = length_of_number(&text[at..]);
            values.push(value(&text[at..at + length]).ok_or(at)?);
            at = behind(text, at + length, next)?;
        }
    }
    Ok(values)
}

/// Returns the index after the bytes `expected` if they stand in the text at the index `at`; else `at` as the
/// error.
fn behind(text: &[u8], at: usize, expected: &[u8]) -> Result<usize, usize> {
    let is_there = text[at..].starts_with(expected);
    is_there.then_some(at + expected.len()).ok_or(at)
}

fn length_of_number(text: &[u8]) -> usize {
    let is_of_number =
        |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E');
    text.iter().take_while(|byte| is_of_number(byte)).count()
}

fn value<T: Decimal>(number: &[u8]) -> Option<T> {
    if (1..=MAX_EXACT_DIGITS).contains(&number.len()) && number.iter().all(u8::is_ascii_digit) {
        return Some(T::of_digits(number));
    }
    std::str::from_utf8(number).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::{same_triangles, same_words, scanned};

    #[test]
    fn numbers_of_rows() {
        let text = b"v 1 -2.5\nv 3e-05 12345678901234567890\n";
        let expected = [1.0, -2.5, 3e-5, 12_345_678_901_234_567_890.0];
        assert_eq!(scanned(text, b"v # #\n"), Ok(expected.to_vec()));
        let text = b"<x v1=\"7\" y=\"+5\"/>";
        assert_eq!(scanned(text, b"<x v1=\"#\" y=\"#\"/>"), Ok(vec![7, 5]));
        assert_eq!(scanned::<f64>(b"", b"# #\n"), Ok(vec![]));
        assert_eq!(scanned(b"1\n2\n", b"#\n"), Ok(vec![1, 2]));
    }

    #[test]
    fn other_rows_have_a_place() {
        let place = |text: &[u8]| scanned::<f64>(text, b"v # #\n").unwrap_err();
        assert_eq!(place(b"v 1 2\nv 1\n"), 9);
        assert_eq!(place(b"v 1 2-3\n"), 4);
        assert_eq!(place(b"v 1 \n"), 4);
        assert_eq!(place(b"v 1 2"), 5);
        assert_eq!(place(b"v 1 inf\n"), 4);
        assert_eq!(place(b"w 1 2\n"), 0);
        assert_eq!(scanned::<i64>(b"1.5\n", b"#\n"), Err(0));
        assert_eq!(scanned::<i64>(b"12345678901234567890\n", b"#\n"), Err(0));
        assert_eq!(scanned::<i64>(b"1", b""), Err(0));
    }

    #[test]
    fn words_of_either_order() {
        let words = [1, u64::MAX - 1];
        for (bytes, word) in [
            (
                words.map(u64::to_le_bytes).concat(),
                u64::from_le_bytes as fn([u8; 8]) -> u64,
            ),
            (words.map(u64::to_be_bytes).concat(), u64::from_be_bytes),
        ] {
            assert!(same_words(&bytes, &words, word));
            assert!(!same_words(&bytes, &words[..1], word));
            for at in 0..bytes.len() {
                let mut other = bytes.clone();
                other[at] ^= 1;
                assert!(!same_words(&other, &words, word), "byte {at}");
                assert!(!same_words(&bytes[..at], &words, word), "{at} bytes");
            }
        }
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
