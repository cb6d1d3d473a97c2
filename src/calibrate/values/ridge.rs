//! Many weights at once, fitted to one part of the data and judged on another.

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
