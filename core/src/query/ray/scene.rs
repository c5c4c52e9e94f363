//! The facets that rays are cast at, snapped to a lattice, with a tree of boxes.

use std::sync::OnceLock;

use super::cell::{Cell, Frame};
use super::closed::require_closed;
use super::facet::Facet;
use super::ratio::Ratio;
use super::treelet::Deferred;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::poll;
use crate::mesh::grid::Pitch;

/// Facets on a lattice, and a hierarchy of boxes over them, which is refined where rays are cast.
///
/// Facets without extent (corners on one line, or equal) are left out: no ray hits them.
#[derive(Debug)]
pub struct Scene<const D: usize> {
    pitch: Pitch,
    /// The corners in lattice steps, which doubles represent exactly.
    facets: Vec<Facet<D>>,
    /// The index of each facet in the input, ascending; empty if all facets are in the scene.
    numbers: Vec<u32>,
    cell: Cell<D>,
    frame: Frame<D>,
    /// The mean extent of facets, in the frame.
    mean_facet_size: f64,
    root: Deferred<D>,
    /// Whether the facets of the scene are closed, without border; empty until a caller needs to know.
    closed: OnceLock<Result<()>>,
}

impl<const D: usize> Scene<D> {
    /// Snaps facets, given in model units, to the lattice with `pitch`; if `pitch` is `None`, to a lattice
    /// that suits them.
    ///
    /// # Errors
    /// `NonFinite` and `TooLarge` with the facet's number.
    pub fn new(facets: &[Facet<D>], pitch: Option<Pitch>) -> Result<Self> {
        let pitch = match pitch {
            Some(pitch) => pitch,
            None => suited(facets)?,
        };
        Self::over(facets, pitch, Deferred::over)
    }

    /// Makes the scene after its facets have moved, on the same lattice. Keeps the tree and refits its
    /// boxes, unless the number of facets or the set of those with an extent has changed.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn refitted(&self, facets: &[Facet<D>]) -> Result<Self> {
        let moved = Self::over(facets, self.pitch, |kept, frame| {
            if kept.len() == self.facets.len() {
                self.root.refitted(kept, frame)
            } else {
                Deferred::over(kept, frame)
            }
        })?;
        if moved.numbers == self.numbers {
            return Ok(moved);
        }
        Self::new(facets, Some(self.pitch))
    }

    fn over(
        facets: &[Facet<D>],
        pitch: Pitch,
        root: impl FnOnce(&[Facet<D>], &Frame<D>) -> Deferred<D>,
    ) -> Result<Self> {
        if u32::try_from(facets.len()).is_err() {
            let text = "a scene must have fewer than 2^32 facets";
            return Err(Error::new(ErrorKind::TooLarge, text));
        }
        let mut kept = Vec::with_capacity(facets.len());
        let mut numbers = Vec::with_capacity(facets.len());
        for (number, facet) in facets.iter().enumerate() {
            poll();
            let snapped = snap_facet(pitch, facet).map_err(|e| at_facet(&e, number))?;
            if has_extent(&snapped) {
                kept.push(snapped.map(|corner| corner.map(|c| c as f64)));
                numbers.push(number as u32);
            }
        }
        if kept.len() == facets.len() {
            numbers.clear();
        }
        let cell = Cell::around(&kept);
        let frame = Frame::of(&cell);
        let mean_facet_size = mean_facet_size(&kept) * frame.scale;
        let root = root(&kept, &frame);
        Ok(Self {
            pitch,
            facets: kept,
            numbers,
            cell,
            frame,
            mean_facet_size,
            root,
            closed: OnceLock::new(),
        })
    }

    /// The exponent of the lattice step.
    pub fn pitch(&self) -> Pitch {
        self.pitch
    }

    /// The facets that can be hit, in lattice steps.
    pub fn facets(&self) -> &[Facet<D>] {
        &self.facets
    }

    /// The index in the input of a facet of the scene.
    pub fn number(&self, facet: u32) -> u32 {
        self.numbers.get(facet as usize).copied().unwrap_or(facet)
    }

    /// A box around all facets.
    pub fn cell(&self) -> &Cell<D> {
        &self.cell
    }

    /// The frame in which the boxes of the tree are given.
    pub fn frame(&self) -> &Frame<D> {
        &self.frame
    }

    /// Returns the mean extent of facets, in the frame.
    pub fn mean_facet_size(&self) -> f64 {
        self.mean_facet_size
    }

    /// The root of the tree of boxes.
    pub fn root(&self) -> &Deferred<D> {
        &self.root
    }

    /// Returns an error if the facets of the scene are not closed; decides it once.
    ///
    /// # Errors
    /// `NotClosed` with the indices in the input of facets at the border.
    pub fn require_closed(&self) -> Result<()> {
        if let Some(known) = self.closed.get() {
            return known.clone();
        }
        // Not within `get_or_init`: a pool thread that waits there could steal a task that calls this
        // function, too.
        let found = require_closed(&self.facets, |facet| self.number(facet));
        self.closed.get_or_init(|| found).clone()
    }

    /// Divides all leaves of the tree that were not divided yet, on all threads of the pool.
    pub fn complete(&self) {
        self.root.complete(&self.facets);
    }

    /// The lattice point nearest to a point in model units.
    ///
    /// # Errors
    /// `NonFinite`, and `TooLarge` beyond 2^53 steps.
    #[inline]
    pub fn snap(&self, point: &[f64; D]) -> Result<[i64; D]> {
        snap(self.pitch, point)
    }

    /// Converts a ray's parameter to model units per length of the given direction, correctly rounded.
    pub fn parameter(&self, at: &Ratio, exponent: i32) -> f64 {
        parameter(self.pitch, at, exponent)
    }

    /// Returns the point, in model units, with given barycentric coordinates among corners in lattice steps.
    pub fn position(&self, corners: &Facet<D>, weights: &[f64; D]) -> [f64; D] {
        let mut point = [0.0; D];
        for (corner, weight) in corners.iter().zip(weights) {
            for k in 0..D {
                point[k] += weight * self.pitch.units(corner[k]);
            }
        }
        point
    }
}

/// Converts a ray's parameter to model units per length of the given direction, correctly rounded.
pub fn parameter(pitch: Pitch, at: &Ratio, exponent: i32) -> f64 {
    in_lengths(at.scaled_to_f64(pitch.exponent()), exponent)
}

/// Converts a parameter along a direction that was multiplied by 2^`exponent` to one along the given
/// direction.
pub fn in_lengths(parameter: f64, exponent: i32) -> f64 {
    // Two steps, because the scale alone can leave the range of doubles.
    let half = exponent / 2;
    parameter * power_of_two(half) * power_of_two(exponent - half)
}

/// 2^`exponent`, which must be a normal double.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// Chooses a lattice for facets by their largest coordinate and extent, as import does for meshes.
fn suited<const D: usize>(facets: &[Facet<D>]) -> Result<Pitch> {
    let (mut largest, mut extent) = (0.0f64, 0.0f64);
    for k in 0..D {
        let all = || {
            facets
                .iter()
                .flatten()
                .map(|c| c[k])
                .filter(|x| x.is_finite())
        };
        let low = all().fold(f64::INFINITY, f64::min);
        let high = all().fold(f64::NEG_INFINITY, f64::max);
        if low <= high {
            largest = largest.max(low.abs()).max(high.abs());
            extent = extent.max(high - low);
        }
    }
    Pitch::suited(largest, extent)
}

/// Returns the lattice point nearest to a point in model units.
///
/// # Errors
/// `NonFinite`, and `TooLarge` beyond 2^53 steps.
#[inline]
pub fn snap<const D: usize>(pitch: Pitch, point: &[f64; D]) -> Result<[i64; D]> {
    let mut snapped = [0; D];
    for (k, c) in point.iter().enumerate() {
        snapped[k] = pitch.snap(*c)?;
    }
    Ok(snapped)
}

fn snap_facet<const D: usize>(pitch: Pitch, facet: &Facet<D>) -> Result<[[i64; D]; D]> {
    let mut snapped = [[0; D]; D];
    for (i, corner) in facet.iter().enumerate() {
        snapped[i] = snap(pitch, corner)?;
    }
    Ok(snapped)
}

fn at_facet(error: &Error, number: usize) -> Error {
    let text = format!("facet {number}: {}", error.message());
    Error::at(error.kind(), vec![number as u64], text)
}

/// The mean, over all facets, of the largest extent along an axis.
fn mean_facet_size<const D: usize>(facets: &[Facet<D>]) -> f64 {
    let extent = |facet: &Facet<D>| {
        let cell = Cell::around([facet]);
        (0..D)
            .map(|k| cell.high[k] - cell.low[k])
            .fold(0.0, f64::max)
    };
    facets.iter().map(extent).sum::<f64>() / facets.len().max(1) as f64
}

/// Returns true if the corners span the dimension of the facet: not all on a line in 3D, not equal in 2D.
fn has_extent<const D: usize>(corners: &[[i64; D]; D]) -> bool {
    let edge = |i: usize| -> [i128; D] {
        std::array::from_fn(|k| i128::from(corners[i][k]) - i128::from(corners[0][k]))
    };
    match D {
        1 => true,
        2 => edge(1) != [0; D],
        _ => {
            let (a, b) = (edge(1), edge(2));
            [(0, 1), (1, 2), (2, 0)]
                .iter()
                .any(|(i, j)| a[*i] * b[*j] != a[*j] * b[*i])
        }
    }
}
