//! Gauss–Newton with bounds, on residuals in units of noise.

use super::model::{Baseline, Case, Segment};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};

/// Parameters of effects that a fit is free to choose, in a row: effect by effect, value by value.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The effects with their values.
    pub effects: Vec<Setting>,
    /// Σ of squares of the residual in units of noise.
    pub chi2: f64,
    /// The residual there.
    pub white: DVector<f64>,
    /// Its derivative by each parameter, if the fit got so far.
    pub jacobian: Option<DMatrix<f64>>,
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
fn scales(effects: &[Setting]) -> Vec<(f64, [f64; 2])> {
    let parameters = effects
        .iter()
        .flat_map(|effect| effect.values().filter_map(|(name, _)| effect.kind.parameter(name)));
    parameters.map(|parameter| (parameter.step, parameter.bounds)).collect()
}

/// What is fitted to what.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// The rig and its runs.
    pub case: &'a Case,
    /// Bias and noise.
    pub baseline: &'a Baseline,
    /// Segments that count.
    pub on: &'a [Segment],
    /// Effects that stay as they are.
    pub fixed: &'a [Setting],
    /// Orthonormal directions in which the residual does not count: what the values of the fixed
    /// effects could make good.
    pub blind: Option<&'a DMatrix<f64>>,
}

impl Target<'_> {
    /// The residual with these effects, or none where such a machine cannot be.
    pub fn look(&self, effects: &[Setting]) -> Option<Fit> {
        let together = [self.fixed, effects].concat();
        let mut white = self.case.white(self.baseline, &together, self.on).ok()?;
        if let Some(blind) = self.blind {
            white -= blind * (blind.transpose() * &white);
        }
        let chi2 = white.norm_squared();
        chi2.is_finite().then(|| Fit { effects: effects.to_vec(), chi2, white, jacobian: None })
    }
}

/// Derivative of the residual by each parameter, by forward differences of a parameter's own step,
/// away from its nearest bound.
pub fn jacobian(target: &Target, fit: &Fit) -> Option<DMatrix<f64>> {
    let now = values(&fit.effects);
    let mut matrix = DMatrix::zeros(fit.white.len(), now.len());
    for (i, (step, [_, high])) in scales(&fit.effects).into_iter().enumerate() {
        let step = if now[i] + step > high { -step } else { step };
        let mut beside = now.clone();
        beside[i] += step;
        let there = target.look(&with_values(&fit.effects, &beside))?;
        matrix.set_column(i, &((there.white - &fit.white) / step));
    }
    Some(matrix)
}

/// Least squares from the given values on, at most `iterations` of Levenberg and Marquardt's steps;
/// none where the model cannot be built at its start.
pub fn fit(target: &Target, effects: &[Setting], iterations: usize) -> Option<Fit> {
    let mut best = target.look(effects)?;
    let scales = scales(effects);
    let mut damping = 1e-6;
    for _ in 0..iterations {
        let Some(jacobian) = jacobian(target, &best) else { break };
        let now = values(&best.effects);
        let scaled = DMatrix::from_fn(jacobian.nrows(), jacobian.ncols(), |r, c| {
            jacobian[(r, c)] * scales[c].0
        });
        let normal = scaled.transpose() * &scaled;
        let gradient = scaled.transpose() * &best.white;
        let before = best.chi2;
        best.jacobian = Some(jacobian);
        for _ in 0..6 {
            // Parameters that lie on a bound and would leave it are held.
            let mut held = vec![false; now.len()];
            let mut step = DVector::zeros(now.len());
            for _ in 0..=now.len() {
                let free: Vec<usize> = (0..now.len()).filter(|&i| !held[i]).collect();
                let small = DMatrix::from_fn(free.len(), free.len(), |r, c| {
                    let diagonal =
                        if r == c { damping * (normal[(free[r], free[r])] + 1e-9) } else { 0.0 };
                    normal[(free[r], free[c])] + diagonal
                });
                let rhs = DVector::from_fn(free.len(), |r, _| -gradient[free[r]]);
                let Some(solved) = small.cholesky().map(|c| c.solve(&rhs)) else { break };
                step.fill(0.0);
                for (r, &i) in free.iter().enumerate() {
                    step[i] = solved[r];
                }
                let leaving = free.iter().copied().find(|&i| {
                    let [low, high] = scales[i].1;
                    (now[i] <= low && step[i] < 0.0) || (now[i] >= high && step[i] > 0.0)
                });
                match leaving {
                    Some(i) => held[i] = true,
                    None => break,
                }
            }
            let trial: Vec<f64> = now
                .iter()
                .zip(step.iter())
                .zip(&scales)
                .map(|((value, step), (scale, [low, high]))| {
                    (value + step * scale).clamp(*low, *high)
                })
                .collect();
            let there = target.look(&with_values(&best.effects, &trial));
            match there {
                Some(there) if there.chi2 < best.chi2 => {
                    best = Fit { jacobian: best.jacobian.take(), ..there };
                    damping = (damping * 0.1).max(1e-9);
                    break;
                }
                _ => damping = (damping * 10.0).max(1e-4),
            }
        }
        if before - best.chi2 < 1e-3 * (1.0 + 1e-3 * before) {
            break;
        }
    }
    Some(best)
}
