//! Models of a free swing against its recording, over windows that each start anew.
//!
//! A model is judged by what it predicts: in each window the angle and the rate at its start are fitted
//! on its first part, and the angle is predicted over all of it.

use crate::engine::{self, Schedule, StepControl};
use crate::mechanism::{Mechanism, pendulum};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use rayon::prelude::*;

/// Fixed step in s: at 8 rad/s its error of the period, `(ωh)²/24`, is 3e-6.
const STEP: f64 = 1e-3;

/// Time between two samples in s that are compared: a 200th of a swing.
const LOOK: f64 = 4e-3;

/// Finite differences of the start in rad and rad/s, and corrections of it: the second is below 1e-9.
const NUDGE: f64 = 1e-5;
const CORRECTIONS: usize = 2;

/// A stretch of a recording of one angle.
#[derive(Clone, Debug)]
pub struct Window {
    /// Angle in rad at each look.
    angles: Vec<f64>,
}

/// What is predicted, and from how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Length of a window in s.
    pub window: f64,
    /// Its first part, which the start is fitted to, in s.
    pub start: f64,
}

/// Cuts `angles` (rad, one every `interval` s) into windows side by side.
pub fn windows(angles: &[f64], interval: f64, plan: Plan) -> Vec<Window> {
    let [length, stride] = [plan.window, LOOK].map(|t| (t / interval).round().max(1.0) as usize);
    angles
        .chunks_exact(length)
        .map(|part| Window { angles: part.iter().step_by(stride).copied().collect() })
        .collect()
}

/// A pendulum by its start (rad, rad/s).
pub type Build<'a> = &'a (dyn Fn([f64; 2]) -> Mechanism + Sync);

/// How the windows of a fit are stepped.
const CONTROL: StepControl = StepControl::Fixed(STEP);

/// Angles in rad of a pendulum every `interval` s, the first of them near `near`.
///
/// # Errors
/// A run that breaks down.
pub fn angles(
    mechanism: &Mechanism,
    control: StepControl,
    mut near: f64,
    interval: f64,
    samples: usize,
) -> Result<Vec<f64>, engine::Halt> {
    let schedule = Schedule { duration: interval * (samples - 1).max(1) as f64, interval };
    let mut angles = Vec::with_capacity(samples);
    engine::run(mechanism, control, schedule, &mut |instant| {
        [near, _] = pendulum::angle(&instant.states[0], near);
        angles.push(near);
    })?;
    angles.resize(samples, f64::NAN);
    Ok(angles)
}

/// Angles in rad at `looks` instants of a pendulum released so; NaN after a breakdown.
fn swing(build: Build, control: StepControl, start: [f64; 2], looks: usize) -> Vec<f64> {
    angles(&build(start), control, start[0], LOOK, looks).unwrap_or_else(|_| vec![f64::NAN; looks])
}

/// The start (rad, rad/s) of a pendulum that fits its recorded angles (rad, one every `interval` s) best
/// over the first part of a plan.
pub fn start(
    build: Build,
    control: StepControl,
    angles: &[f64],
    interval: f64,
    plan: Plan,
) -> [f64; 2] {
    let stride = (LOOK / interval).round().max(1.0) as usize;
    let head = ((plan.start / interval).round() as usize + 1).min(angles.len());
    let looks: Vec<f64> = angles[..head].iter().step_by(stride).copied().collect();
    started(build, control, &looks)
}

/// The start that fits all of `recorded` best, by Newton's steps with finite differences.
fn started(build: Build, control: StepControl, recorded: &[f64]) -> [f64; 2] {
    let early = (recorded.len() / 4).max(1).min(recorded.len() - 1);
    let rate = (recorded[early] - recorded[0]) / (LOOK * early.max(1) as f64);
    let mut start = Vector2::new(recorded[0], rate);
    for _ in 0..CORRECTIONS {
        let at = |start: Vector2<f64>| swing(build, control, start.into(), recorded.len());
        let now = at(start);
        let [by_angle, by_rate] = [Vector2::x(), Vector2::y()].map(|e| at(start + e * NUDGE));
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for i in 0..recorded.len() {
            let slope = Vector2::new(by_angle[i] - now[i], by_rate[i] - now[i]) / NUDGE;
            normal += slope * slope.transpose();
            right += slope * (recorded[i] - now[i]);
        }
        let Some(inverse) = normal.try_inverse() else { break };
        start += inverse * right;
    }
    start.into()
}

/// Predicted less recorded angle in rad over one window.
fn deviation(build: Build, window: &Window, plan: Plan) -> Vec<f64> {
    let recorded = &window.angles;
    let head = ((plan.start / LOOK).round() as usize + 1).min(recorded.len());
    let start = started(build, CONTROL, &recorded[..head]);
    let predicted = swing(build, CONTROL, start, recorded.len());
    predicted.iter().zip(recorded).map(|(p, r)| p - r).collect()
}

/// Predicted less recorded angle in rad over one window, with the time in s from its start.
pub fn deviations(build: Build, window: &Window, plan: Plan) -> Vec<(f64, f64)> {
    let deviations = deviation(build, window, plan);
    (0u32..).map(|k| f64::from(k) * LOOK).zip(deviations).collect()
}

/// Root mean square deviation in rad over all windows, and over each.
pub fn score(build: Build, windows: &[Window], plan: Plan) -> (f64, Vec<f64>) {
    let each: Vec<f64> = windows
        .par_iter()
        .map(|window| {
            let deviations = deviation(build, window, plan);
            (deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64).sqrt()
        })
        .collect();
    let mean = each.iter().map(|rms| rms * rms).sum::<f64>() / each.len().max(1) as f64;
    (mean.sqrt(), each)
}

/// The parameters that make the deviations over `windows` least, from `start`, none below its `lower`
/// bound. `steps` are the finite differences. Levenberg–Marquardt.
pub fn fit(
    build: &(dyn Fn(&[f64], [f64; 2]) -> Mechanism + Sync),
    start: &[f64],
    steps: &[f64],
    lower: &[f64],
    windows: &[Window],
    plan: Plan,
) -> Vec<f64> {
    let all = |values: &[f64]| -> DVector<f64> {
        let with = |start: [f64; 2]| build(values, start);
        let parts: Vec<Vec<f64>> =
            windows.par_iter().map(|window| deviation(&with, window, plan)).collect();
        DVector::from_vec(parts.concat())
    };
    let mut values = start.to_vec();
    let mut now = all(&values);
    let mut damping = 1e-3;
    for _ in 0..ITERATIONS {
        let columns: Vec<DVector<f64>> = (0..values.len())
            .map(|k| {
                let mut other = values.clone();
                other[k] += steps[k];
                (all(&other) - &now) / steps[k]
            })
            .collect();
        let jacobian = DMatrix::from_columns(&columns);
        let (normal, gradient) = (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&now));
        let before = now.norm_squared();
        let mut better = false;
        while damping < 1e3 {
            let mut damped = normal.clone();
            for k in 0..values.len() {
                damped[(k, k)] *= 1.0 + damping;
            }
            let Some(factors) = damped.cholesky() else { break };
            let change = factors.solve(&gradient);
            let tried: Vec<f64> =
                (0..values.len()).map(|k| (values[k] - change[k]).max(lower[k])).collect();
            let there = all(&tried);
            if there.norm_squared() < before {
                (values, now, better) = (tried, there, true);
                damping *= 0.1;
                break;
            }
            damping *= 10.0;
        }
        if !better || now.norm_squared() > before * (1.0 - 1e-4) {
            break;
        }
    }
    values
}

/// Standard deviations of fitted values: what is left of a window belongs together, so it counts window by
/// window, `(JᵀJ)⁻¹ (Σ_w Jᵀ_w e_w eᵀ_w J_w) (JᵀJ)⁻¹` (Liang, Zeger, Biometrika 73 (1986) 13–22).
pub fn spread(
    build: &(dyn Fn(&[f64], [f64; 2]) -> Mechanism + Sync),
    values: &[f64],
    steps: &[f64],
    windows: &[Window],
    plan: Plan,
) -> Vec<f64> {
    let count = values.len();
    let each: Vec<(DMatrix<f64>, DVector<f64>)> = windows
        .par_iter()
        .map(|window| {
            let at = |values: &[f64]| {
                let with = |start: [f64; 2]| build(values, start);
                DVector::from_vec(deviation(&with, window, plan))
            };
            let now = at(values);
            let columns: Vec<DVector<f64>> = (0..count)
                .map(|k| {
                    let mut other = values.to_vec();
                    other[k] += steps[k];
                    (at(&other) - &now) / steps[k]
                })
                .collect();
            (DMatrix::from_columns(&columns), now)
        })
        .collect();
    let (mut normal, mut meat) = (DMatrix::zeros(count, count), DMatrix::zeros(count, count));
    for (jacobian, left) in &each {
        normal += jacobian.tr_mul(jacobian);
        let moment = jacobian.tr_mul(left);
        meat += &moment * moment.transpose();
    }
    let Some(inverse) = normal.try_inverse() else { return vec![f64::NAN; count] };
    let covariance = &inverse * meat * &inverse;
    (0..count).map(|k| covariance[(k, k)].max(0.0).sqrt()).collect()
}

/// Iterations of a fit: from declared values it takes four to six.
const ITERATIONS: usize = 10;
