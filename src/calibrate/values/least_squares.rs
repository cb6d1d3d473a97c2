//! Gauss–Newton with bounds, in the damping of Levenberg and Marquardt.

use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A value that a fit may choose.
///
/// [`least_squares`] has an example.
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
    /// Its derivative by each value, from before the last step, if the fit got so far.
    pub jacobian: Option<DMatrix<f64>>,
}

/// Residual in units of noise at some values, or none where there is no such model.
pub type ResidualAt<'a> = &'a (dyn Fn(&[f64]) -> Option<DVector<f64>> + Sync);

/// Derivative of the residual by each value; none without values.
pub fn jacobian(
    look: ResidualAt,
    free: &[Free],
    values: &[f64],
    residual: &DVector<f64>,
) -> Option<DMatrix<f64>> {
    let column = |i| derivative(look, free, values, residual, i);
    let columns = (0..free.len()).into_par_iter().map(column).collect::<Option<Vec<_>>>()?;
    (!columns.is_empty()).then(|| DMatrix::from_columns(&columns))
}

/// Derivative of the residual by value `i`, by a forward difference over its step, away from the nearest bound; over a
/// [part](REDUCED) of it where the whole one does [more than counts](too_far): what is a hair to one machine is
/// everything to another.
pub fn derivative(
    look: ResidualAt,
    free: &[Free],
    values: &[f64],
    residual: &DVector<f64>,
    i: usize,
) -> Option<DVector<f64>> {
    let Free { step, bounds } = free[i];
    let mut step = if values[i] + step > bounds[1] { -step } else { step };
    for last in (0..=REDUCTIONS).map(|k| k == REDUCTIONS) {
        let mut beside = values.to_vec();
        beside[i] += step;
        let change = look(&beside).map(|there| there - residual);
        match change {
            Some(change) if last || !too_far(&change, residual) => return Some(change / step),
            None if last => return None,
            _ => step *= REDUCED,
        }
    }
    None
}

/// Whether a step that is to tell a direction was too long: it changed a residual in units of noise by more than all that
/// there is of it, and by more than a unit.
pub fn too_far(change: &DVector<f64>, residual: &DVector<f64>) -> bool {
    change.norm() > residual.norm().max(1.0)
}

/// What is left of a step that was [too long](too_far), and how often: down to a millionth.
pub const REDUCED: f64 = 0.01;
/// See [`REDUCED`].
pub const REDUCTIONS: usize = 3;

/// When a fit ends, and how it comes by derivatives.
///
/// [`least_squares`] has an example.
#[derive(Clone, Copy, Debug)]
pub struct FitEffort {
    /// Steps, at most.
    pub steps: usize,
    /// Drop of the sum of squares, beside as many parts of a thousand of it, that is none.
    pub enough: f64,
    /// Whether derivatives are those of the step before, corrected by what it found (Broyden), as long as
    /// steps bring what they promise: where a look costs a simulation.
    pub secant: bool,
}

/// Share of the promised drop from which a step has brought what it promised.
const PROMISED: f64 = 0.25;

/// Least squares from the given values on, with these derivatives at first, if they are `known`; none where
/// there is no model at its start.
///
/// ```
/// use freeplay::calibrate::least_squares::{FitEffort, Free, least_squares};
/// use nalgebra::DVector;
///
/// // y = a + b t through three points.
/// let look = |v: &[f64]| Some(DVector::from_fn(3, |i, _| v[0] + v[1] * i as f64 - [1.0, 3.0, 5.0][i]));
/// let free = [Free { step: 1e-3, bounds: [-10.0, 10.0] }, Free { step: 1e-3, bounds: [-10.0, 10.0] }];
/// let effort = FitEffort { steps: 20, enough: 1e-9, secant: false };
/// let best = least_squares(&look, &free, vec![0.0, 0.0], effort, None).unwrap();
/// assert!((best.values[0] - 1.0).abs() < 1e-6 && (best.values[1] - 2.0).abs() < 1e-6);
/// ```
pub fn least_squares(
    look: ResidualAt,
    free: &[Free],
    start: Vec<f64>,
    effort: FitEffort,
    mut known: Option<DMatrix<f64>>,
) -> Option<Best> {
    let residual = look(&start)?;
    let mut best = Best { values: start, residual, jacobian: None };
    let mut damping = 1e-6;
    for _ in 0..effort.steps {
        let old = known.is_some();
        let renewed = || jacobian(look, free, &best.values, &best.residual);
        let Some(jacobian) = known.take().or_else(renewed) else { break };
        let scaled = DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |r, c| {
            jacobian[(r, c)] * free[c].step
        });
        let normal = scaled.transpose() * &scaled;
        let gradient = scaled.transpose() * &best.residual;
        let before = best.residual.norm_squared();
        let worth = |drop: f64| drop >= effort.enough * (1.0 + 1e-3 * before);
        let mut done = true;
        // What derivatives of before do not lead to, new ones may.
        for _ in 0..if old { 1 } else { 6 } {
            let trial = step(free, &best.values, &normal, &gradient, damping);
            let change = change(&best.values, &trial);
            let expected = &best.residual + &jacobian * &change;
            let promised = before - expected.norm_squared();
            if effort.secant && !worth(promised) {
                break;
            }
            let there = look(&trial).filter(|there| there.norm_squared() < before);
            done = !old;
            if let Some(residual) = there {
                let drop = before - residual.norm_squared();
                let kept = effort.secant && drop > PROMISED * promised;
                known = kept.then(|| secant(&jacobian, &change, &residual - expected, free));
                done = !worth(drop) && (kept || !old);
                best = Best { values: trial, residual, ..best };
                damping = (damping * 0.1).max(1e-9);
                break;
            }
            damping = (damping * 10.0).max(1e-4);
        }
        best.jacobian = Some(jacobian);
        if done {
            break;
        }
    }
    Some(best)
}

/// By how much values differ.
fn change(before: &[f64], now: &[f64]) -> DVector<f64> {
    let pairs = now.iter().zip(before);
    DVector::from_iterator(now.len(), pairs.map(|(now, before)| now - before))
}

/// Derivatives that meet what a step found, which they `missed` by Δr − J Δx:
/// `J + (Δr − J Δx) Δxᵀ/(Δxᵀ Δx)` in units of the values' steps (Broyden, *Math. Comp.* 19, 1965).
fn secant(
    jacobian: &DMatrix<f64>,
    change: &DVector<f64>,
    missed: DVector<f64>,
    free: &[Free],
) -> DMatrix<f64> {
    let unit = free.iter().zip(change.iter()).map(|(free, change)| change / free.step.powi(2));
    let along = DVector::from_iterator(change.len(), unit);
    let length = along.dot(change).max(f64::MIN_POSITIVE);
    jacobian + missed * along.transpose() / length
}

/// Whether nothing tells a value: all that makes sense of it changes the residual by less than a unit of noise, its derivative's
/// square in units of the value's step being `own`. Where such a value goes is a matter of rounding.
fn is_untold(own: f64, Free { step, bounds: [low, high] }: Free) -> bool {
    own.sqrt() * (high - low) < step
}

/// The values a damped step further. Those that lie on a bound and would leave it are held, and those that [nothing
/// tells](is_untold).
fn step(
    free: &[Free],
    now: &[f64],
    normal: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
) -> Vec<f64> {
    let mut held: Vec<bool> =
        free.iter().enumerate().map(|(i, free)| is_untold(normal[(i, i)], *free)).collect();
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

/// The values of all effects in a row.
pub fn values(effects: &[Setting]) -> Vec<f64> {
    effects.iter().flat_map(|effect| effect.values().map(|(_, value)| value)).collect()
}

/// The effects with other values.
pub fn with_values(effects: &[Setting], values: &[f64]) -> Vec<Setting> {
    let mut rest = values;
    effects
        .iter()
        .map(|effect| {
            let (own, others) = rest.split_at(effect.values().count());
            rest = others;
            effect.with(own)
        })
        .collect()
}

/// Step and bounds of each parameter.
pub fn free(effects: &[Setting]) -> Vec<Free> {
    let parameters = effects
        .iter()
        .flat_map(|effect| effect.values().filter_map(|(name, _)| effect.kind.parameter(name)));
    parameters.map(|parameter| Free { step: parameter.step, bounds: parameter.bounds }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    const WIDE: [f64; 2] = [-1e3, 1e3];
    const NEW: FitEffort = FitEffort { steps: 100, enough: 1e-12, secant: false };

    /// A step that leads to where there is no machine, and one that changes more than all there is: both are shortened.
    #[test]
    fn a_step_is_no_longer_than_a_machine_can_take() {
        let free = [Free { step: 1.0, bounds: WIDE }];
        let left = DVector::from_vec(vec![1.0]);
        let bounded = |v: &[f64]| (v[0] < 0.5).then(|| DVector::from_vec(vec![1.0 + 3.0 * v[0]]));
        let bent = |v: &[f64]| Some(DVector::from_vec(vec![1.0 + 3.0 * v[0] + 3e3 * v[0].powi(2)]));
        let slope = |look: ResidualAt| derivative(look, &free, &[0.0], &left, 0).unwrap()[0];
        assert!((slope(&bounded) - 3.0).abs() < 1e-9);
        // Over 1 it would be 3003; over a hundredth of that the residual changes by a third of itself.
        assert!((slope(&bent) - 33.0).abs() < 1e-9, "{}", slope(&bent));
        let nowhere = |_: &[f64]| None;
        assert!(derivative(&nowhere, &free, &[0.0], &left, 0).is_none());
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        // Rosenbrock's function: its smallest value is 0 at (1, 1).
        let look =
            |v: &[f64]| Some(DVector::from_vec(vec![10.0 * (v[1] - v[0] * v[0]), 1.0 - v[0]]));
        let free = [Free { step: 1e-6, bounds: WIDE }; 2];
        let best = least_squares(&look, &free, vec![-1.2, 1.0], NEW, None).expect("a model");
        assert!(best.values.iter().all(|v| (v - 1.0).abs() < 1e-5), "{:?}", best.values);
    }

    #[test]
    fn corrected_derivatives_save_looks() {
        // Five values that bend each other a little: exp(x_i) + x_{i+1}/4 = exp(1) + 1/4.
        let looks = AtomicUsize::new(0);
        let look = |v: &[f64]| {
            looks.fetch_add(1, Ordering::Relaxed);
            let row = |i: usize| (v[i].exp() - 1f64.exp()) + 0.25 * (v[(i + 1) % 5] - 1.0);
            Some(DVector::from_iterator(5, (0..5).map(row)))
        };
        let free = [Free { step: 1e-6, bounds: WIDE }; 5];
        let count = |secant| {
            looks.store(0, Ordering::Relaxed);
            let effort = FitEffort { secant, ..NEW };
            let best = least_squares(&look, &free, vec![0.9; 5], effort, None).expect("a model");
            assert!(best.values.iter().all(|v| (v - 1.0).abs() < 1e-5), "{:?}", best.values);
            looks.load(Ordering::Relaxed)
        };
        let (secant, new) = (count(true), count(false));
        assert!(2 * secant < new + 5, "{secant} {new}");
    }

    #[test]
    fn a_bound_holds_one_value_and_lets_the_other_go_to_its_best() {
        // (a + b − 3)² + (a − b − 1)² without bounds: a = 2, b = 1; with a ≤ 1: b = 1.
        let look = |v: &[f64]| Some(DVector::from_vec(vec![v[0] + v[1] - 3.0, v[0] - v[1] - 1.0]));
        let free = [Free { step: 1e-3, bounds: [0.0, 1.0] }, Free { step: 1e-3, bounds: WIDE }];
        let best = least_squares(&look, &free, vec![0.5, 0.0], NEW, None).expect("a model");
        assert!((best.values[0] - 1.0).abs() < 1e-9 && (best.values[1] - 1.0).abs() < 1e-6);
    }

    /// The place of a mass on what does not turn: rounding alone would send it to the end of what makes sense.
    #[test]
    fn a_value_that_nothing_tells_stays_where_it_is() {
        let look = |v: &[f64]| Some(DVector::from_vec(vec![1e3 * (v[0] - 0.2), 0.3 + 1e-2 * v[1]]));
        let free = [WIDE, [-3.0, 3.0]].map(|bounds| Free { step: 1e-3, bounds });
        let best = least_squares(&look, &free, vec![0.1, 0.05], NEW, None).expect("a model");
        assert!((best.values[0] - 0.2).abs() < 1e-6, "{:?}", best.values);
        assert_eq!(best.values[1], 0.05);
    }

    #[test]
    fn a_model_that_cannot_be_is_not_fitted() {
        let free = [Free { step: 1.0, bounds: WIDE }];
        assert!(least_squares(&|_| None, &free, vec![0.0], NEW, None).is_none());
        assert!(jacobian(&|_| None, &[], &[], &DVector::zeros(1)).is_none(), "nothing to change");
    }
}
