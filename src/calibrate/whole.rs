//! Values from whole simulations, held against the recording point by point.
//!
//! Where loads keep the joints in contact nothing is chaotic: a complete model started like the machine
//! meets every sample up to the sensors' noise, which is white and declared. No lens gets as much out of
//! a recording: one leg may be nearly unloaded for an instant, and when its journal crosses over hangs on
//! the third digit of what loads it. The start is fitted with the values ([`super::start`]).

use super::fit::{Fit, free, values, with_values};
use super::least_squares::{Free, least_squares};
use super::model::{Case, Segment};
use super::rattle::noise;
use super::replica;
use super::spectrum::{Signal, transform};
use super::start::{KICKS, Kicks, Start, kicked, still};
use crate::effects::Setting;
use crate::measure::log::{Channel, Log};
use nalgebra::DVector;

/// Highest frequencies in Hz that count: at first below the swing, whose phase has many wrong answers
/// for values that are off; then all that a platform does.
const BANDS: [f64; 2] = [30.0, 100.0];

/// Steps of Gauss and Newton in each band, at most.
const STEPS: [usize; 2] = [3, 4];

/// Share of a parameter's step by which derivatives are taken: the swing's phase bends what is straight
/// through the lens.
const STEP: f64 = 0.1;

/// Mean square in units of noise up to which a model is complete enough for its values to be better than
/// through the lens: what it lacks would be made good by them.
const COMPLETE: f64 = 1.5;

/// The values of a model near `effects`, whose runs start like `starts`, that meet segments point by
/// point, with residual and derivatives from which intervals follow; none where joints rattle, or where
/// no values make the model nearly complete.
pub fn whole(case: &Case, on: &[Segment], effects: &[Setting], starts: &[Start]) -> Option<Fit> {
    let count = values(effects).len();
    if case.chaotic || count == 0 {
        return None;
    }
    let kicks: Vec<Option<Kicks>> = starts.iter().map(|start| start.kicks).collect();
    let mut free: Vec<Free> = free(effects);
    free.iter_mut().for_each(|free| free.step *= STEP);
    let mut start = values(effects);
    for kicks in on.iter().filter_map(|segment| kicks[segment.run]) {
        start.extend(kicks.iter());
        free.extend([Free { step: STEP, bounds: [f64::NEG_INFINITY, f64::INFINITY] }; KICKS]);
    }
    let mut fit = None;
    for (band, steps) in BANDS.into_iter().zip(STEPS) {
        let look = |values: &[f64]| {
            let (own, mut rest) = values.split_at(count);
            let effects = with_values(effects, own);
            let mut white = Vec::new();
            for segment in on {
                let own = kicks[segment.run].map(|_| {
                    let (own, others) = rest.split_at(KICKS);
                    rest = others;
                    Kicks::from_column_slice(own)
                });
                white.extend(residual(case, segment, &effects, own, band)?);
            }
            Some(DVector::from_vec(white))
        };
        let best = least_squares(&look, &free, start.clone(), steps)?;
        start.clone_from(&best.values);
        fit = Some(best);
    }
    let best = fit?;
    let chi2 = best.residual.norm_squared();
    if chi2 > COMPLETE * best.residual.len() as f64 {
        return None;
    }
    // What kicks could do as well tells nothing of values.
    let jacobian = best.jacobian.map(|jacobian| {
        let own = jacobian.columns(0, count).into_owned();
        if jacobian.ncols() == count {
            return own;
        }
        let others = jacobian.columns(count, jacobian.ncols() - count).into_owned().qr().q();
        &own - &others * (others.transpose() * &own)
    });
    let effects = with_values(effects, &best.values[..count]);
    Some(Fit { effects, chi2, white: best.residual, jacobian })
}

/// Recording less simulation on a segment in units of noise, by frequency; none where the model cannot be
/// simulated.
fn residual(
    case: &Case,
    segment: &Segment,
    effects: &[Setting],
    kicks: Option<Kicks>,
    band: f64,
) -> Option<Vec<f64>> {
    let run = &case.runs[segment.run];
    let log = run.log.part(0..segment.rows.end);
    let mut machine = run.released(&case.rig, effects).ok()?;
    if let Some(kicks) = kicks {
        machine = kicked(&still(&machine, case.control).ok()?, &kicks);
    }
    let simulated = replica::simulate(&machine, &case.sensors, case.control, &log, 0).ok()?;
    let signal = |channel: Channel| {
        let unit = noise(&case.sensors, channel)?;
        let rows = |log: &Log| Some(log.get(channel)?[segment.rows.clone()].to_vec());
        let (measured, simulated) = (rows(&log)?, rows(&simulated)?);
        let values = measured.iter().zip(simulated).map(|(a, b)| (a - b) / unit).collect();
        Some(Signal { values, band })
    };
    let signals: Vec<Signal> = log.channels().filter_map(signal).collect();
    Some(transform(&signals, log.interval).concat())
}
