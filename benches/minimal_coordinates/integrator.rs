//! Step size control: the estimated error of the velocities, and the next onset of contact.

use super::system::System;
use super::tsitouras::{EVALUATIONS, State, interpolate, step};

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps accepted.
    pub steps: u64,
    /// Steps refused and done again.
    pub rejected: u64,
    /// Evaluations of the right-hand side (those for outputs between steps not counted).
    pub evaluations: u64,
}

const FIRST_STEP: f64 = 1e-5;
/// In free flight the estimate limits nothing, and the forecast of the flight's end is only so good.
const LONGEST_STEP: f64 = 1e-3;
/// A step this short means that the equations have no solution to follow.
const SHORTEST_STEP: f64 = 1e-14;

const SAFETY: f64 = 0.9;
const LARGEST_GROWTH: f64 = 5.0;
const LARGEST_SHRINKAGE: f64 = 0.2;
/// The estimate is of order h⁵; the PI controller of Gustafsson with Hairer and Wanner's β = 0.04.
const EXPONENT: f64 = 0.2;
const BETA: f64 = 0.04;

/// A step from further away than so many reaches ([`System::ENTRY`]) would weight the force at its end by
/// its own length: it stops short of the onset, at this part of the forecast, which leaves out accelerations.
const NEAR: f64 = 2.0;
const APPROACH: f64 = 0.95;
/// The step after an entry is at most so many times as long as the reach.
const AFTER_ENTRY: f64 = 3.0;

/// Goes from t = 0 through all `times`, which increase, and hands over the state at each.
pub fn integrate<const N: usize, S: System<N>>(
    system: &S,
    tolerance: f64,
    times: &[f64],
    mut observe: impl FnMut(f64, [f64; N], [f64; N]),
) -> Work {
    let weights = system.radii().map(|radius| radius / tolerance);
    let (q, v) = system.start();
    let (mut state, mut pose) = State::new(system, 0.0, q, v);
    let mut work = Work { evaluations: 1, ..Work::default() };
    let mut remaining = times;
    let mut wanted = FIRST_STEP;
    let mut log_before = 0.0;
    while !remaining.is_empty() {
        let onset = system.next_onset(&state.v, &pose);
        loop {
            let mut h = wanted.min(LONGEST_STEP);
            let mut next_at_most = f64::INFINITY;
            if onset.time < h {
                let reach = S::ENTRY * (tolerance * tolerance / onset.speed.powi(3)).powf(0.2);
                if onset.time > NEAR * reach {
                    h = h.min(APPROACH * onset.time);
                } else if onset.time + reach < h {
                    h = onset.time + reach;
                    next_at_most = AFTER_ENTRY * reach;
                }
            }
            assert!(h > SHORTEST_STEP, "no step is short enough at t = {} s", state.t);
            let trial = step(system, &state, h);
            work.evaluations += EVALUATIONS;
            let square = weighted_square(&trial.velocity_error, &weights);
            if square <= 1.0 {
                let log = 0.5 * square.max(1e-10).ln();
                let exponent = BETA * log_before - (EXPONENT - 0.75 * BETA) * log;
                let growth = (SAFETY * exponent.exp()).clamp(LARGEST_SHRINKAGE, LARGEST_GROWTH);
                log_before = log;
                wanted = (h * growth).min(next_at_most);
                work.steps += 1;
                while let Some((&t, rest)) =
                    remaining.split_first().filter(|(t, _)| **t <= trial.end.t)
                {
                    let (q, v) = interpolate(&state, &trial.end, t);
                    observe(t, q, v);
                    remaining = rest;
                }
                (state, pose) = (trial.end, trial.pose);
                break;
            }
            work.rejected += 1;
            wanted = h * (SAFETY * square.powf(-0.5 * EXPONENT)).max(LARGEST_SHRINKAGE);
        }
    }
    work
}

#[inline(always)]
fn weighted_square<const N: usize>(errors: &[f64; N], weights: &[f64; N]) -> f64 {
    let squares: [f64; N] = std::array::from_fn(|n| (errors[n] * weights[n]).powi(2));
    squares.iter().sum()
}
