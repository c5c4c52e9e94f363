//! Bounded convex bodies, divided by hyperplanes.

use super::Affine;
use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::space::clip;

/// A bounded convex body, given by its walls: fragments with the body on their minus sides.
#[derive(Clone, Debug)]
pub struct Polytope<S: Affine> {
    walls: Vec<S::Fragment>,
}

impl<S: Affine> Polytope<S> {
    /// The box from the lattice point `low` to `high`; `None` if it is flat or exceeds
    /// [`Affine::MAX_COORDINATE`].
    ///
    /// # Example
    /// ```
    /// use bspcsg::geometry::spaces::affine::Polytope;
    /// use bspcsg::geometry::spaces::dim2::Dim2;
    /// use bspcsg::geometry::spaces::dim3::Dim3;
    ///
    /// let [low, high] = [[0; 3], [2, 3, 4]];
    /// let block = Polytope::<Dim3>::cuboid(&low, &high).expect("it is not flat");
    /// assert!((block.volume() - 24.0).abs() < 1e-9);
    /// let sheet = Polytope::<Dim2>::cuboid(&low, &high).expect("it is not flat");
    /// assert!((sheet.surface() - 10.0).abs() < 1e-9);
    /// ```
    pub fn cuboid(low: &[i64; 3], high: &[i64; 3]) -> Option<Self> {
        let cuts = (0..S::DIM)
            .map(|axis| {
                Some([
                    S::axis_cut(axis, low[axis])?,
                    S::axis_cut(axis, high[axis])?,
                ])
            })
            .collect::<Option<Vec<_>>>()?;
        let inside = |wall: S::Fragment, own: usize| {
            let others = cuts.iter().enumerate().filter(|(axis, _)| *axis != own);
            others.into_iter().try_fold(wall, |rest, (_, [low, high])| {
                clip::<S>(clip::<S>(rest, low, Half::Plus)?, high, Half::Minus)
            })
        };
        let mut walls = Vec::with_capacity(2 * S::DIM);
        for (axis, [low, high]) in cuts.iter().enumerate() {
            let below = S::reversed(&S::span(low, &S::EVERYTHING)?);
            walls.push(inside(below, axis)?);
            walls.push(inside(S::span(high, &S::EVERYTHING)?, axis)?);
        }
        let flat = (0..S::DIM).any(|axis| low[axis] >= high[axis]);
        (!flat).then_some(Self { walls })
    }

    /// The walls of the body, with the body on their minus sides.
    pub fn walls(&self) -> &[S::Fragment] {
        &self.walls
    }

    /// The part of a hyperplane inside the body; `None` if it does not cross the interior.
    pub fn span(&self, cut: &S::Hyperplane) -> Option<S::Fragment> {
        self.walls
            .iter()
            .try_fold(S::span(cut, &S::EVERYTHING)?, |rest, wall| {
                clip::<S>(rest, S::hyperplane(wall), Half::Minus)
            })
    }

    /// The parts of the body on the minus and on the plus side of a hyperplane; `None` for a part without
    /// interior.
    pub fn divided(&self, cut: &S::Hyperplane) -> [Option<Self>; 2] {
        let (mut minus, mut plus) = (Vec::new(), Vec::new());
        for wall in &self.walls {
            match S::split(wall, cut) {
                Split::Minus => minus.push(wall.clone()),
                Split::Plus => plus.push(wall.clone()),
                Split::Both { minus: m, plus: p } => {
                    minus.push(m);
                    plus.push(p);
                }
                Split::Coplanar(_) => {}
            }
        }
        let Some(span) = self.span(cut) else {
            let whole = Some(self.clone());
            return if plus.is_empty() {
                [whole, None]
            } else {
                [None, whole]
            };
        };
        plus.push(S::reversed(&span));
        minus.push(span);
        [minus, plus].map(|walls| Some(Self { walls }))
    }

    /// The length of the body in 1D, its area in 2D, its volume in 3D, in lattice steps.
    ///
    /// # Exactness
    /// Computed in doubles, from corners that are correct to a few units in the last place.
    pub fn volume(&self) -> f64 {
        let apex = self.walls.first().and_then(|w| S::corners(w).pop());
        let apex = apex.unwrap_or_default();
        let sum: f64 = self
            .walls
            .iter()
            .map(|wall| S::cone_measure(wall, &apex))
            .sum();
        sum.max(0.0)
    }

    /// The measure of the body's border: 2 in 1D, perimeter in 2D, surface area in 3D, in lattice steps.
    pub fn surface(&self) -> f64 {
        self.walls.iter().map(S::size).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spaces::dim1::Dim1;
    use crate::geometry::spaces::dim2::Dim2;
    use crate::geometry::spaces::dim3::Dim3;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs()
    }

    #[test]
    fn boxes_have_the_measures_of_boxes() {
        let (low, high) = ([-1, 2, 3], [4, 8, 5]);
        let line = Polytope::<Dim1>::cuboid(&low, &high).unwrap();
        assert!(close(line.volume(), 5.0) && close(line.surface(), 2.0));
        let plane = Polytope::<Dim2>::cuboid(&low, &high).unwrap();
        assert!(close(plane.volume(), 30.0) && close(plane.surface(), 22.0));
        let space = Polytope::<Dim3>::cuboid(&low, &high).unwrap();
        assert!(close(space.volume(), 60.0) && close(space.surface(), 104.0));
    }

    #[test]
    fn flat_boxes_are_none() {
        assert!(Polytope::<Dim3>::cuboid(&[0; 3], &[1, 1, 0]).is_none());
        assert!(Polytope::<Dim2>::cuboid(&[0; 3], &[1, 1, 0]).is_some());
    }

    #[test]
    fn parts_add_up_to_the_whole() {
        let whole = Polytope::<Dim3>::cuboid(&[0; 3], &[9; 3]).unwrap();
        let corners = [[9, 0, 0], [0, 9, 0], [0, 0, 9]];
        let cut = Dim3::fragment(&corners).unwrap();
        let [minus, plus] = whole.divided(Dim3::hyperplane(&cut));
        let (minus, plus) = (minus.unwrap().volume(), plus.unwrap().volume());
        assert!(close(minus, 729.0 / 6.0) && close(minus + plus, 729.0));
    }

    use crate::geometry::spaces::space::Space;

    #[test]
    fn a_wall_divides_nothing_off() {
        let whole = Polytope::<Dim2>::cuboid(&[0; 3], &[9; 3]).unwrap();
        let [minus, plus] = whole.divided(&Dim2::axis_cut(0, 9).unwrap());
        assert!(minus.is_some() && plus.is_none());
        let [minus, plus] = whole.divided(&Dim2::axis_cut(1, -4).unwrap());
        assert!(minus.is_none() && plus.is_some());
    }
}
