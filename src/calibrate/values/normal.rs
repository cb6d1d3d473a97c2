//! Normal equations: how well they say values are known, and many weights at once, fitted to one part of the data and judged
//! on another.

use nalgebra::{DMatrix, DVector};

/// Ridges that are tried, as shares of the mean square of a part's columns.
const RIDGES: [f64; 6] = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];

/// Residuals in units of noise, and what a unit of each weight changes of them.
#[derive(Clone, Copy)]
pub(in crate::calibrate) struct Regressed<'a> {
    pub columns: &'a DMatrix<f64>,
    pub white: &'a DVector<f64>,
}

/// Weights fitted to `on` by least squares, and the share that they remove of what is above noise in `hold`:
/// `min |r + X w|² + Σ λ s w²` with the ridge λ that removes most there, s the mean square of the columns of one of
/// `parts` of equal length, which have sizes of their own. None where no such weights can be found.
pub(in crate::calibrate) fn ridged(
    on: Regressed,
    hold: Regressed,
    parts: usize,
) -> Option<(f64, DVector<f64>)> {
    let features = on.columns.ncols() / parts;
    let normal = on.columns.transpose() * on.columns;
    let rhs = -(on.columns.transpose() * on.white);
    let sizes: Vec<f64> =
        (0..parts).map(|i| normal.diagonal().rows(i * features, features).mean()).collect();
    let before = hold.white.norm_squared();
    let excess = (before - hold.white.len() as f64).max(1.0);
    RIDGES
        .into_iter()
        .filter_map(|ridge| {
            let ridges = DVector::from_fn(rhs.len(), |i, _| ridge * sizes[i / features]);
            let ridged = &normal + DMatrix::from_diagonal(&ridges);
            let weights: DVector<f64> = ridged.cholesky()?.solve(&rhs);
            let left = (hold.white + hold.columns * &weights).norm_squared();
            Some(((before - left) / excess, weights))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

/// `(JᵀJ)⁻¹`, of values of very different size; 0 of those that no residual depends on, none of what is no number.
pub(in crate::calibrate) fn inverse_normal(jacobian: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    // The decomposition does not end with such.
    if !jacobian.iter().all(|value| value.is_finite()) {
        return None;
    }
    let length = |norm: f64| if norm > 0.0 { norm } else { 1.0 };
    let scale: Vec<f64> = jacobian.column_iter().map(|c| length(c.norm())).collect();
    let scaled = |matrix: DMatrix<f64>| {
        DMatrix::from_fn(scale.len(), scale.len(), |r, c| matrix[(r, c)] / (scale[r] * scale[c]))
    };
    Some(scaled(scaled(jacobian.transpose() * jacobian).pseudo_inverse(1e-12).ok()?))
}

/// Mean square of what draws of noise do to values, in units of `(JᵀJ)⁻¹`: the noise is known frequency
/// by frequency, and a rattle that hangs together over several pulls a value that all of them tell of
/// further (a parametric bootstrap; Efron and Tibshirani, *An Introduction to the Bootstrap*, 1993, §6.5).
pub(in crate::calibrate) fn pull(
    jacobian: &DMatrix<f64>,
    inverse: &DMatrix<f64>,
    draws: &[DVector<f64>],
) -> f64 {
    let squares = draws.iter().map(|draw| {
        let along = jacobian.transpose() * draw;
        along.dot(&(inverse * &along))
    });
    squares.sum::<f64>() / (draws.len() * jacobian.ncols()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value that nothing depends on has no part in the others' intervals, and does not keep them from being found.
    #[test]
    fn a_value_without_consequences_is_left_out() {
        let jacobian = DMatrix::from_row_slice(3, 2, &[2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let inverse = inverse_normal(&jacobian).unwrap();
        assert_eq!((inverse[(0, 0)], inverse[(1, 1)]), (0.25, 0.0));
        assert!(inverse_normal(&DMatrix::from_element(2, 2, f64::NAN)).is_none());
    }

    /// The mean of n numbers that are noise each by itself is known to 1/√n; of noise that hangs together
    /// (pairs of the same number) to √2/√n.
    #[test]
    fn noise_that_hangs_together_pulls_further() {
        let jacobian = DMatrix::from_element(4, 1, 1.0);
        let inverse = inverse_normal(&jacobian).unwrap();
        assert!((inverse[(0, 0)] - 0.25).abs() < 1e-12);
        let signs = |i: usize, k: u32| if i >> k & 1 == 0 { 1.0 } else { -1.0 };
        let alone = (0..16).map(|i| DVector::from_fn(4, |r, _| signs(i, r as u32)));
        assert!((pull(&jacobian, &inverse, &alone.collect::<Vec<_>>()) - 1.0).abs() < 1e-12);
        let pairs = (0..4).map(|i| DVector::from_fn(4, |r, _| signs(i, r as u32 / 2)));
        assert!((pull(&jacobian, &inverse, &pairs.collect::<Vec<_>>()) - 2.0).abs() < 1e-12);
    }

    /// A mass in kg and a clearance in m, told apart although one is a million times the other.
    #[test]
    fn values_of_different_size_have_their_own_deviations() {
        let jacobian = DMatrix::from_row_slice(2, 2, &[1e-3, 0.0, 0.0, 1e9]);
        let inverse = inverse_normal(&jacobian).unwrap();
        assert!((inverse[(0, 0)] - 1e6).abs() < 1e-3);
        assert!((inverse[(1, 1)] - 1e-18).abs() < 1e-27);
    }
}
