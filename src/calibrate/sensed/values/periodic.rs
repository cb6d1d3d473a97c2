//! Frequencies at which something that repeats in time may act.
//!
//! What acts with the phase `θ = 2πft + φ` does so as `a(t) cos θ + b(t) sin θ`, where a and b are what the machine
//! makes of it in its poses. A machine that moves spreads one frequency over many: the residual's highest peaks may
//! lie beside it. Two looks at one frequency tell a and b, and these what any other one would show.

use super::fit::{Fit, FitTarget};
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment};
use crate::calibrate::sensed::residuals::residual::Residuals;
use crate::calibrate::sensed::thresholds::DYNAMICS_BAND;
use crate::calibrate::values::spectrum::{Signal, transform};
use crate::effects::{Scan, Setting};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The frequency in Hz of the two looks: any will do.
const LOOKED_AT: f64 = 1.0;

/// Frequencies tried in each 1/T of a recording of T seconds: between two of them a wave keeps four fifths of its
/// power.
const FINER: f64 = 2.0;

/// Frequencies that are kept: sums with those of the motion stand beside the right one.
const KEPT: usize = 4;

/// What a unit of an amplitude does on one segment, residual by residual: the parts that go with the cosine and with
/// the sine of its phase.
struct AmplitudeParts {
    times: Vec<f64>,
    cosine: Vec<Signal>,
    sine: Vec<Signal>,
}

/// Frequencies in Hz at which a repeating candidate with these `amplitudes` explains most of what a model leaves, by
/// least squares, the best first.
pub(super) fn frequencies(
    target: &FitTarget,
    model: &Fit,
    candidate: &Setting,
    scan: Scan,
    amplitudes: &[&'static str],
) -> Vec<f64> {
    let of = |amplitude: &&str| -> Option<Vec<AmplitudeParts>> {
        let part = |on| parts(target.problem, &model.effects, candidate, scan, amplitude, on);
        target.on.iter().map(part).collect()
    };
    let Some(parts) = amplitudes.iter().map(of).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    let rows = |segment: &Segment| {
        segment.rows.len() as f64 * target.problem.runs[segment.run].view.interval
    };
    let longest = target.on.iter().map(rows).fold(0.0, f64::max);
    let step = 1.0 / (FINER * longest);
    let count = (DYNAMICS_BAND / step) as usize;
    let gains: Vec<f64> = (0..count)
        .map(|i| gain(target, model, &parts, (i + 1) as f64 * step).unwrap_or(0.0))
        .collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
    let mut kept: Vec<usize> = Vec::new();
    for place in order {
        let apart = |known: &usize| known.abs_diff(place) as f64 > 2.0 * FINER;
        if kept.len() < KEPT && kept.iter().all(apart) {
            kept.push(place);
        }
    }
    kept.into_iter().map(|i| (i + 1) as f64 * step).collect()
}

/// What one amplitude does on a segment; none where there is no such machine.
fn parts(
    problem: &RigProblem,
    model: &[Setting],
    candidate: &Setting,
    scan: Scan,
    amplitude: &str,
    segment: &Segment,
) -> Option<AmplitudeParts> {
    let look = |values: &[(&str, f64)]| -> Option<Residuals> {
        let run = &problem.runs[segment.run];
        let own = candidate.values().map(|(name, neutral)| {
            values.iter().find(|(known, _)| *known == name).map_or(neutral, |(_, value)| *value)
        });
        let own = candidate.with(&own.collect::<Vec<_>>());
        let effects = [model, &[own]].concat();
        let machine = machine(&problem.rig, &effects, &run.recording).ok()?;
        problem.residuals(&run.view, &machine, segment)
    };
    let unit = candidate.kind.parameter(amplitude).map_or(1.0, |parameter| parameter.step);
    let of = |size: f64, phase: f64| {
        look(&[(amplitude, size), (scan.over, LOOKED_AT), (scan.phase, phase)])
    };
    let nothing = of(0.0, 0.0)?;
    let [first, later] = [0.0, FRAC_PI_2].map(|phase| of(unit, phase));
    let (first, later) = (first?, later?);
    let run = &problem.runs[segment.run];
    let time = |row: usize| row as f64 * run.view.interval;
    let times: Vec<f64> = segment.rows.clone().step_by(run.view.stride).map(time).collect();
    let turned = |by: &dyn Fn(f64, f64, f64, f64) -> f64| {
        let channels = nothing.signals.iter().zip(&first.signals).zip(&later.signals);
        channels
            .map(|((nothing, first), later)| {
                let rows = times.iter().zip(&nothing.values).zip(&first.values).zip(&later.values);
                let values = rows.map(|(((t, nothing), first), later)| {
                    let (sin, cos) = (TAU * LOOKED_AT * t).sin_cos();
                    by(first - nothing, later - nothing, cos, sin)
                });
                Signal { values: values.collect(), band: nothing.band }
            })
            .collect()
    };
    let cosine = turned(&|first, later, cos, sin| first * cos - later * sin);
    let sine = turned(&|first, later, cos, sin| first * sin + later * cos);
    Some(AmplitudeParts { times, cosine, sine })
}

/// How much of what a model leaves waves of one frequency (Hz) explain.
fn gain(
    target: &FitTarget,
    model: &Fit,
    parts: &[Vec<AmplitudeParts>],
    frequency: f64,
) -> Option<f64> {
    let column = |parts: &[AmplitudeParts], later: bool| -> Option<DVector<f64>> {
        let segments = target.on.iter().zip(parts).map(|(segment, parts)| {
            let pairs = parts.cosine.iter().zip(&parts.sine);
            let signals: Vec<Signal> =
                pairs.map(|pair| wave(&parts.times, pair, frequency, later)).collect();
            let view = &target.problem.runs[segment.run].view;
            let coefficients = transform(&signals, view.interval * view.stride as f64);
            target.baseline.whiten(segment, &coefficients)
        });
        let white = segments.collect::<Option<Vec<_>>>()?;
        Some(DVector::from_iterator(
            white.iter().map(DVector::len).sum(),
            white.iter().flat_map(|part| part.iter().copied()),
        ))
    };
    let columns = parts.iter().flat_map(|parts| [false, true].map(|later| column(parts, later)));
    let matrix = DMatrix::from_columns(&columns.collect::<Option<Vec<_>>>()?);
    let rhs = matrix.tr_mul(&model.white);
    let weights = matrix.tr_mul(&matrix).cholesky()?.solve(&rhs);
    Some(weights.dot(&rhs))
}

/// What a wave of one frequency (Hz) shows at some times (s): of phase 0, or a quarter of a turn later.
fn wave(times: &[f64], (cosine, sine): (&Signal, &Signal), frequency: f64, later: bool) -> Signal {
    let rows = times.iter().zip(&cosine.values).zip(&sine.values);
    let values = rows.map(|((t, a), b)| {
        let (sin, cos) = (TAU * frequency * t).sin_cos();
        if later { b * cos - a * sin } else { a * cos + b * sin }
    });
    Signal { values: values.collect(), band: cosine.band }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target as On, named};

    /// Two looks at one frequency tell what the effect itself does at another one: forces that go round, and a base that
    /// shakes along a line.
    #[test]
    fn looks_at_one_frequency_tell_of_any_other() {
        let problem = RigProblem::planar("planar-2");
        let segment = Segment { run: 0, rows: problem.runs[0].view.rows() };
        let (frequency, phase) = (7.3, 0.8);
        for (kind, on, amplitude, grows) in [
            ("unbalance", On::Body("coupler".to_owned()), "mass_radius_kg_m", 2),
            ("base-vibration", On::Machine, "ax_m_s2", 0),
        ] {
            let kind = named(kind).unwrap();
            let candidate = |size: f64| {
                let values = [(amplitude, size), ("frequency_Hz", frequency), ("phase_rad", phase)];
                Setting::on(kind, on.clone(), &values)
            };
            let scan = kind.scan.unwrap();
            let parts = parts(&problem, &[], &candidate(0.0), scan, amplitude, &segment).unwrap();
            let unit = kind.parameter(amplitude).unwrap().step;
            let run = &problem.runs[0];
            let [without, with] = [0.0, unit].map(|size| {
                let machine = machine(&problem.rig, &[candidate(size)], &run.recording).unwrap();
                problem.residuals(&run.view, &machine, &segment).unwrap().signals
            });
            let more = (frequency / LOOKED_AT).powi(grows);
            let channels = parts.cosine.iter().zip(&parts.sine).zip(without.iter().zip(&with));
            let (mut off, mut size) = (0.0f64, 0.0f64);
            for (pair, (without, with)) in channels {
                let [now, later] =
                    [false, true].map(|later| wave(&parts.times, pair, frequency, later).values);
                for i in 0..now.len() {
                    let told = more * (now[i] * phase.cos() + later[i] * phase.sin());
                    let shown = with.values[i] - without.values[i];
                    (off, size) = (off + (told - shown).powi(2), size + shown.powi(2));
                }
            }
            assert!(size > 0.0 && off < 1e-3 * size, "{}: {off:e} of {size:e}", kind.name);
        }
    }
}
