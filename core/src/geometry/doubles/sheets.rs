//! Exact tests whether surfaces cross at an edge, from the half-planes of the triangles around it.
//!
//! Where more than two triangles share an edge, it is unknown which pairs of them belong to one surface.
//! Surfaces cross at the edge if they cross for every choice of pairs.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::{seen_along, side, turn, Facing, Point, Triangle};
use crate::arith::Sign;
use crate::geometry::side::Side;

/// A triangle at an edge, as the half-plane that the edge's line bounds on the triangle's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// The corner of the triangle that is not on the edge.
    pub apex: Point,
    /// True if the triangle's border runs in the direction of the edge, false if in the opposite direction.
    pub is_along: bool,
}

impl Sheet {
    /// 1 if the triangle's border runs in the direction of the edge, −1 if in the opposite direction.
    fn direction_sign(&self) -> i64 {
        if self.is_along {
            1
        } else {
            -1
        }
    }
}

/// The triangles around an edge as half-planes; nearly always two.
pub type Sheets = SmallVec<[Sheet; 2]>;

/// Return whether unequal numbers of triangles (sheets) run in the two directions of an edge, so that a
/// surface ends there.
fn is_open(sheets: &[Sheet]) -> bool {
    sheets.iter().map(Sheet::direction_sign).sum::<i64>() != 0
}

/// Return whether a surface made of the sheets at an edge crosses the plane of a triangle that contains the
/// edge, or ends at the edge.
///
/// Sheets in the plane overlap the triangle, which other tests find; here they do not count as crossing.
pub fn surface_crosses_plane(plane: &Triangle, sheets: &[Sheet]) -> bool {
    let facing = Facing::of(plane);
    let (mut below, mut above) = (0, 0);
    for sheet in sheets {
        match facing.side(&sheet.apex) {
            Side::Minus => below += sheet.direction_sign(),
            Side::On => {}
            Side::Plus => above += sheet.direction_sign(),
        }
    }
    is_open(sheets) || below != 0 && above != 0
}

/// Return whether surfaces made of the sheets at one edge cross surfaces made of the sheets at another edge
/// on the same line, or end there.
///
/// In the order around the line, each sheet is a letter, and a sheet of the opposite direction the inverse
/// letter: the sheets can be paired without a crossing exactly if their word cancels in the free group.
///
/// Sheets that coincide overlap, which other tests find; here they do not count as crossing.
pub fn surfaces_cross(axis: [&Point; 2], [first, second]: [&[Sheet]; 2]) -> bool {
    if is_open(first) || is_open(second) {
        return true;
    }
    let letters = |is_first: bool, sheets: &[Sheet]| {
        let letter = |sheet: &Sheet| (is_first, *sheet);
        sheets.iter().map(letter).collect::<SheetWord>()
    };
    let mut word = letters(true, first);
    word.extend(letters(false, second));
    let Some(start) = first.first() else {
        return false;
    };
    let order = |x: &Sheet, y: &Sheet| order_around(axis, &start.apex, [&x.apex, &y.apex]);
    word.sort_by(|(_, x), (_, y)| order(x, y));
    let is_beside = |w: &[(bool, Sheet)]| w[0].0 != w[1].0 && order(&w[0].1, &w[1].1).is_eq();
    !word.windows(2).any(is_beside) && !cancels(&word)
}

/// The triangles (sheets) around a line that contains two edges; each flag is true for a triangle at the
/// first edge.
type SheetWord = SmallVec<[(bool, Sheet); 4]>;

/// Return whether a sequence of triangles (sheets) around a line, read as a word of letters and inverse
/// letters, cancels to the empty word in the free group.
fn cancels(word: &[(bool, Sheet)]) -> bool {
    let mut left = SmallVec::<[(bool, bool); 4]>::new();
    for (is_first, Sheet { is_along, .. }) in word {
        if left.last() == Some(&(*is_first, !is_along)) {
            left.pop();
        } else {
            left.push((*is_first, *is_along));
        }
    }
    left.is_empty()
}

/// The order of two half-planes around a line, by angle from a half-plane `start`; each is given by a point
/// in it.
fn order_around([a, b]: [&Point; 2], start: &Point, [x, y]: [&Point; 2]) -> Ordering {
    let turn = |u: &Point, v: &Point| side(&[*a, *b, *u], v);
    let quarter = |x: &Point| match turn(start, x) {
        Side::On if is_same_half([a, b], start, x) => 0,
        Side::Plus => 1,
        Side::On => 2,
        Side::Minus => 3,
    };
    let within = || match turn(x, y) {
        Side::Plus => Ordering::Less,
        Side::On => Ordering::Equal,
        Side::Minus => Ordering::Greater,
    };
    quarter(x).cmp(&quarter(y)).then_with(within)
}

/// Return whether two points, in one plane with the line through a and b, lie on the same side of the line.
fn is_same_half([a, b]: [&Point; 2], x: &Point, y: &Point) -> bool {
    let first = [*a, *b, *x];
    let second = [*a, *b, *y];
    (0..3).any(|along| {
        let turns = [
            turn(seen_along(&first, along)),
            turn(seen_along(&second, along)),
        ];
        turns[0] != Sign::Zero && turns[0] == turns[1]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXIS: [Point; 2] = [[0.0; 3], [0.0, 0.0, 1.0]];

    /// Sheets around an axis at angles in twelfths of a turn, like hours; negative if they run against the
    /// axis, and 12 is the angle 0.
    fn sheets(hours: &[i32]) -> Sheets {
        let sheet = |hour: &i32| {
            let (y, x) = (f64::from(hour.abs()) * std::f64::consts::TAU / 12.0).sin_cos();
            let apex = [(x * 8.0).round(), (y * 8.0).round(), 0.5];
            Sheet {
                apex,
                is_along: *hour > 0,
            }
        };
        hours.iter().map(sheet).collect()
    }

    fn are_entwined(first: &[i32], second: &[i32]) -> bool {
        let ([a, b], [first, second]) = (AXIS, [first, second].map(sheets));
        let there = surfaces_cross([&a, &b], [&first, &second]);
        assert_eq!(there, surfaces_cross([&b, &a], [&second, &first]));
        there
    }

    /// Return whether sheets can be paired so that no two pairs from different edges interleave around the
    /// line.
    fn can_be_paired(word: &mut Vec<(bool, i32)>) -> bool {
        let Some((is_first, hour)) = word.pop() else {
            return true;
        };
        let mates = |e: &(bool, i32)| e.0 == is_first && (e.1 < 0) != (hour < 0);
        let places: Vec<usize> = (0..word.len()).filter(|k| mates(&word[*k])).collect();
        let found = places.into_iter().any(|k| {
            let (mut before, mut between) = (word[..k].to_vec(), word[k + 1..].to_vec());
            can_be_paired(&mut before) && can_be_paired(&mut between)
        });
        word.push((is_first, hour));
        found
    }

    #[test]
    fn surfaces_of_two_sheets_cross_where_they_interleave() {
        assert!(are_entwined(&[12, -6], &[3, -9]));
        assert!(are_entwined(&[12, -6], &[9, -3]));
        assert!(!are_entwined(&[12, -6], &[3, -4]));
        assert!(!are_entwined(&[12, -2], &[1, -12]), "coincident");
        assert!(are_entwined(&[12], &[3, -4]), "open");
    }

    #[test]
    fn of_more_sheets_those_are_one_surface_that_need_not_cross() {
        // One sheet between two wedges, and one from inside each wedge to the outside.
        assert!(!are_entwined(&[12, -2, 6, -8], &[4, -10]));
        assert!(are_entwined(&[12, -2, 6, -8], &[1, -10]));
    }

    #[test]
    fn words_cancel_if_sheets_can_be_paired() {
        // There are eight angles around a line, each with a sheet of either edge in either direction or with
        // none; every seventh combination is tested.
        let (mut entwined, mut apart) = (0, 0);
        for number in (0..5_u32.pow(8)).step_by(7) {
            let letter = |hour: u8| number / 5_u32.pow(u32::from(hour) - 1) % 5;
            let hours = |along: u32, against: u32| -> Vec<i32> {
                let way = |hour: u8| match letter(hour) {
                    l if l == along => Some(i32::from(hour)),
                    l if l == against => Some(-i32::from(hour)),
                    _ => None,
                };
                (1..9).filter_map(way).collect()
            };
            let (first, second) = (hours(1, 2), hours(3, 4));
            if first.is_empty() || second.is_empty() {
                continue;
            }
            let mut word: Vec<(bool, i32)> = first.iter().map(|h| (true, *h)).collect();
            word.extend(second.iter().map(|h| (false, *h)));
            word.sort_by_key(|e| e.1.abs());
            let crosses = are_entwined(&first, &second);
            assert_eq!(crosses, !can_be_paired(&mut word), "{first:?} {second:?}");
            let is_closed = first.len() % 2 == 0 && second.len() % 2 == 0;
            entwined += usize::from(crosses && is_closed);
            apart += usize::from(!crosses);
        }
        assert!(entwined > 1000 && apart > 1000, "{entwined} {apart}");
    }

    #[test]
    fn surfaces_pass_where_a_side_is_left_with_a_sheet_too_many() {
        // The plane contains the directions of 12 and of 6 hours.
        let plane = [[-9.0, 0.0, 0.0], [9.0, 0.0, -1.0], [9.0, 0.0, 2.0]];
        let there = |hours: &[i32]| surface_crosses_plane(&plane, &sheets(hours));
        assert!(there(&[1, -8]) && there(&[1]) && there(&[1, -2, 3]));
        assert!(!there(&[1, -2]) && !there(&[1, -12]));
        // The wedges lie on both sides of the plane, in any order.
        assert!(!there(&[1, -7, 8, -2]) && !there(&[-2, 8, -7, 1]));
        assert!(there(&[1, -7, 2, -8]) && there(&[-8, 2, -7, 1]));
    }
}
