//! Directions in which values are changed to see what they do.
//!
//! Where two values are hard to tell apart, a step of each by itself, a standard deviation of it alone,
//! shows little of what both together do: less than simulations are wrong by. A fit then walks at random
//! along the valley, and intervals come out too narrow. Steps along the axes of the ellipsoid of errors
//! are as long as it is.

use super::least_squares::Free;
use nalgebra::{DMatrix, DVector};

/// Steps of parameters that an axis reaches, at most, in a standard deviation.
const REACH: f64 = 10.0;

/// Directions in which values are changed, a standard deviation each: a matrix with a row for each value
/// and a column for each axis.
#[derive(Clone, Debug)]
pub struct ValueAxes(DMatrix<f64>);

impl ValueAxes {
    /// Each value by itself, by this share of its step.
    pub fn along(free: &[Free], share: f64) -> Self {
        let steps = free.iter().map(|free| free.step * share);
        Self(DMatrix::from_diagonal(&DVector::from_iterator(free.len(), steps)))
    }

    /// Values within their bounds so many standard deviations along the axes from `now`.
    pub fn values(&self, free: &[Free], now: &[f64], steps: &[f64]) -> Vec<f64> {
        let change = &self.0 * DVector::from_column_slice(steps);
        let changed = now.iter().zip(change.iter()).zip(free);
        changed.map(|((now, d), free)| (now + d).clamp(free.bounds[0], free.bounds[1])).collect()
    }

    /// Derivatives by values from those along the axes.
    pub fn derivatives(&self, along: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        Some(along * self.0.clone().try_inverse()?)
    }

    /// Derivatives along the axes from those by values.
    pub fn derivatives_along(&self, own: &DMatrix<f64>) -> DMatrix<f64> {
        own * &self.0
    }

    /// The axes of the ellipsoid of errors that follows from derivatives along these; none where those
    /// are no numbers.
    pub fn turned(&self, free: &[Free], along: &DMatrix<f64>) -> Option<Self> {
        let normal = along.transpose() * along;
        if !normal.iter().all(|value| value.is_finite()) {
            return None;
        }
        let ellipsoid = normal.symmetric_eigen();
        let mut axes = &self.0 * ellipsoid.eigenvectors;
        for (mut axis, square) in axes.column_iter_mut().zip(ellipsoid.eigenvalues.iter()) {
            let reach = axis.iter().zip(free).map(|(d, free)| (d / free.step).abs());
            let largest = reach.fold(f64::MIN_POSITIVE, f64::max);
            axis *= f64::min(1.0 / square.max(0.0).sqrt(), REACH / largest);
        }
        Some(Self(axes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn the_long_axis_of_a_valley_is_found_though_looks_are_wrong_by_more_than_single_steps_show() {
        // r = (a − b, 1e-3 (a + b)) / 1e-2, each wrong by up to 1e-2: the long axis is 7.07 for one
        // standard deviation, and a single value's step of 1e-2 moves the second row by 1e-3.
        let wrong = Cell::new(1.0);
        let look = |v: &[f64]| {
            wrong.set(-wrong.get() * 0.9);
            let [a, b] = [v[0] * 1e2, v[1] * 1e2];
            DVector::from_vec(vec![a - b, 1e-3 * (a + b) + 1e-2 * wrong.get()])
        };
        let free = [Free { step: 1.0, bounds: [-1e6, 1e6] }; 2];
        let now = [0.0, 0.0];
        let mut axes = ValueAxes::along(&free, 1e-2);
        let mut longest = 0.0;
        for _ in 0..3 {
            let base = look(&now);
            let columns: Vec<_> = (0..2)
                .map(|i| {
                    let steps: [f64; 2] = std::array::from_fn(|k| f64::from(u8::from(i == k)));
                    look(&axes.values(&free, &now, &steps)) - &base
                })
                .collect();
            let along = DMatrix::from_columns(&columns);
            let own = axes.derivatives(&along).unwrap();
            let covariance = (own.transpose() * own).try_inverse().unwrap();
            longest = covariance[(0, 0)].sqrt();
            axes = axes.turned(&free, &along).unwrap();
        }
        // Var(a) = (1e-2)² / 4 + (1e-2 / 1e-3)² / 4.
        assert!((longest / 5.0 - 1.0).abs() < 0.1, "{longest}");
    }

    #[test]
    fn derivatives_that_are_no_numbers_have_no_axes() {
        let free = [Free { step: 0.1, bounds: [-1.0, 1.0] }];
        let along = DMatrix::from_element(2, 1, f64::NAN);
        assert!(ValueAxes::along(&free, 1.0).turned(&free, &along).is_none());
    }

    #[test]
    fn an_axis_that_nothing_depends_on_reaches_no_farther_than_its_steps() {
        let free = [Free { step: 0.1, bounds: [-1e6, 1e6] }; 2];
        let along = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.0]);
        let ValueAxes(axes) = ValueAxes::along(&free, 1.0).turned(&free, &along).unwrap();
        assert!(axes.iter().all(|d| d.is_finite() && d.abs() <= 0.1 * REACH), "{axes}");
    }
}
