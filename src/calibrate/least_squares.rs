//! Gauss–Newton with bounds, in the damping of Levenberg and Marquardt.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A value that a fit may choose.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Change by which derivatives are taken, and which all free values are counted in.
    pub step: f64,
    /// Least and largest value.
    pub bounds: [f64; 2],
}

/// The best values that were found.
#[derive(Clone, Debug)]
pub struct Best {
    /// The values.
    pub values: Vec<f64>,
    /// The residual there, in units of noise.
    pub residual: DVector<f64>,
    /// Its derivative by each value, from the last step but one, if the fit got so far.
    pub jacobian: Option<DMatrix<f64>>,
}

/// Residual in units of noise at some values, or none where there is no such model.
pub type Look<'a> = &'a (dyn Fn(&[f64]) -> Option<DVector<f64>> + Sync);

/// Derivative of the residual by each value, by forward differences, away from the nearest bound; none
/// without values.
pub fn jacobian(
    look: Look,
    free: &[Free],
    values: &[f64],
    residual: &DVector<f64>,
) -> Option<DMatrix<f64>> {
    let column = |(i, free): (usize, &Free)| {
        let step = if values[i] + free.step > free.bounds[1] { -free.step } else { free.step };
        let mut beside = values.to_vec();
        beside[i] += step;
        Some((look(&beside)? - residual) / step)
    };
    let columns = free.par_iter().enumerate().map(column).collect::<Option<Vec<_>>>()?;
    (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
}

/// Least squares from the given values on, at most `iterations` steps, until one brings no more than
/// `enough` and as many parts of a thousand; none where there is no model at its start.
pub fn least_squares(
    look: Look,
    free: &[Free],
    start: Vec<f64>,
    iterations: usize,
    enough: f64,
) -> Option<Best> {
    let residual = look(&start)?;
    let mut best = Best { values: start, residual, jacobian: None };
    let mut damping = 1e-6;
    for _ in 0..iterations {
        let Some(jacobian) = jacobian(look, free, &best.values, &best.residual) else { break };
        let scaled = DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |r, c| {
            jacobian[(r, c)] * free[c].step
        });
        let normal = scaled.transpose() * &scaled;
        let gradient = scaled.transpose() * &best.residual;
        let before = best.residual.norm_squared();
        best.jacobian = Some(jacobian);
        let mut now = before;
        for _ in 0..6 {
            let trial = step(free, &best.values, &normal, &gradient, damping);
            let there = look(&trial).filter(|there| there.norm_squared() < before);
            if let Some(residual) = there {
                now = residual.norm_squared();
                best = Best { values: trial, residual, ..best };
                damping = (damping * 0.1).max(1e-9);
                break;
            }
            damping = (damping * 10.0).max(1e-4);
        }
        if before - now < enough * (1.0 + 1e-3 * before) {
            break;
        }
    }
    Some(best)
}

/// The values a damped step further. Those that lie on a bound and would leave it are held.
fn step(
    free: &[Free],
    now: &[f64],
    normal: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
) -> Vec<f64> {
    let mut held = vec![false; now.len()];
    let mut step = DVector::zeros(now.len());
    for _ in 0..=now.len() {
        let moving: Vec<usize> = (0..now.len()).filter(|&i| !held[i]).collect();
        let small = DMatrix::from_fn(moving.len(), moving.len(), |r, c| {
            let own = normal[(moving[r], moving[c])];
            own + if r == c { damping * (own + 1e-9) } else { 0.0 }
        });
        let rhs = DVector::from_fn(moving.len(), |r, _| -gradient[moving[r]]);
        let Some(solved) = small.cholesky().map(|c| c.solve(&rhs)) else { break };
        step.fill(0.0);
        for (r, &i) in moving.iter().enumerate() {
            step[i] = solved[r];
        }
        let leaving = moving.iter().copied().find(|&i| {
            let [low, high] = free[i].bounds;
            (now[i] <= low && step[i] < 0.0) || (now[i] >= high && step[i] > 0.0)
        });
        match leaving {
            Some(i) => held[i] = true,
            None => break,
        }
    }
    let values = now.iter().zip(step.iter()).zip(free);
    values
        .map(|((value, step), Free { step: scale, bounds: [low, high] })| {
            (value + step * scale).clamp(*low, *high)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: [f64; 2] = [-1e3, 1e3];

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        // Rosenbrock's function: its smallest value is 0 at (1, 1).
        let look =
            |v: &[f64]| Some(DVector::from_vec(vec![10.0 * (v[1] - v[0] * v[0]), 1.0 - v[0]]));
        let free = [Free { step: 1e-6, bounds: WIDE }; 2];
        let best = least_squares(&look, &free, vec![-1.2, 1.0], 100, 1e-12).expect("a model");
        assert!(best.values.iter().all(|v| (v - 1.0).abs() < 1e-5), "{:?}", best.values);
    }

    #[test]
    fn a_bound_holds_one_value_and_lets_the_other_go_to_its_best() {
        // (a + b − 3)² + (a − b − 1)² without bounds: a = 2, b = 1; with a ≤ 1: b = 1.
        let look = |v: &[f64]| Some(DVector::from_vec(vec![v[0] + v[1] - 3.0, v[0] - v[1] - 1.0]));
        let free = [Free { step: 1e-3, bounds: [0.0, 1.0] }, Free { step: 1e-3, bounds: WIDE }];
        let best = least_squares(&look, &free, vec![0.5, 0.0], 50, 1e-12).expect("a model");
        assert!((best.values[0] - 1.0).abs() < 1e-9 && (best.values[1] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_model_that_cannot_be_is_not_fitted() {
        let free = [Free { step: 1.0, bounds: WIDE }];
        assert!(least_squares(&|_| None, &free, vec![0.0], 5, 0.1).is_none());
        assert!(jacobian(&|_| None, &[], &[], &DVector::zeros(1)).is_none(), "nothing to change");
    }
}
