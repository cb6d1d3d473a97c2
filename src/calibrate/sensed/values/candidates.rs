//! Where to start looking for the values of a candidate.

use super::fit::{Fit, FitTarget};
use super::periodic::frequencies;
use crate::calibrate::values::least_squares::{REDUCED, REDUCTIONS, too_far};
use crate::effects::{ALL, CONTAINS, Kind, Scan, ScanRange, Setting};
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::FRAC_PI_2;

/// Every effect that lasts on everything that it can act on, at its neutral values, under one of its names; none
/// of the kinds `without`, nor what contains them.
pub fn candidates(mechanism: &Mechanism, without: &[&str]) -> Vec<Setting> {
    let ruled_out = |kind: &Kind| {
        let inner = CONTAINS.iter().filter(|(outer, _)| outer.name == kind.name);
        inner.map(|(_, inner)| *inner).chain([kind]).any(|kind| without.contains(&kind.name))
    };
    let kinds = ALL.iter().filter(|kind| kind.lasts() && !ruled_out(kind));
    let all = kinds.flat_map(|kind| kind.candidates(mechanism));
    all.filter(|effect| effect.better_known_as(mechanism).is_none()).collect()
}

/// How often a size that the machine cannot have is halved: down to a hundredth.
const HALVED: usize = 7;

/// Starts of a candidate that are fitted.
pub(in crate::calibrate::sensed) const KEPT: usize = 2;

/// Periods that are looked at, at most.
const TRIED: usize = 12;

/// A candidate beside the effects of a model, at its most promising values: of a list of starts the best `kept`.
pub fn starts(target: &FitTarget, model: &Fit, candidate: &Setting, kept: usize) -> Vec<Setting> {
    let change = |values: &[f64]| target.response(&candidate.with(values));
    if let Some(scan) = candidate.kind.scan {
        return scanned(target, model, candidate, scan, &change);
    }
    let listed = candidate.starts(&target.problem.declared);
    if listed.is_empty() {
        return vec![candidate.clone()];
    }
    // The best multiple of each start, by least squares. What was too much of it once is not tried again.
    let sizes = candidate.sizes();
    let mut share = 1.0;
    let scored = listed.into_iter().filter_map(|listed| {
        let mut start = candidate.sized(&listed, share * listed[0]);
        let column = within(&model.white, &mut start, (&sizes, 0.0), &change)?;
        share = start[0] / listed[0];
        let multiple = -column.dot(&model.white) / column.norm_squared();
        if multiple <= 0.0 || !multiple.is_finite() {
            return Some((0.0, candidate.with(&start)));
        }
        let start = candidate.sized(&start, multiple * start[0]);
        Some((multiple.powi(2) * column.norm_squared(), candidate.with(&start)))
    });
    let possible = |start: Setting| {
        // What the machine cannot have so much of it may have a part of.
        let mut values: Vec<f64> = start.values().map(|(_, value)| value).collect();
        for _ in 0..HALVED {
            if change(&values).is_some() {
                break;
            }
            values = candidate.sized(&values, 0.5 * values[0]);
        }
        candidate.with(&values)
    };
    best(scored.collect(), kept).into_iter().map(possible).collect()
}

/// What values change of a residual, those at `places` brought nearer to a `neutral` value until that is not
/// [too much](too_far).
pub(in crate::calibrate::sensed) fn within(
    residual: &DVector<f64>,
    values: &mut [f64],
    (places, neutral): (&[usize], f64),
    change: &dyn Fn(&[f64]) -> Option<DVector<f64>>,
) -> Option<DVector<f64>> {
    for _ in 0..REDUCTIONS {
        match change(values) {
            Some(column) if !too_far(&column, residual) => return Some(column),
            _ => {
                for &i in places {
                    values[i] = neutral + REDUCED * (values[i] - neutral);
                }
            }
        }
    }
    change(values)
}

/// The starts that promise most.
fn best(mut scored: Vec<(f64, Setting)>, kept: usize) -> Vec<Setting> {
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.truncate(kept);
    scored.into_iter().map(|(_, start)| start).collect()
}

/// Starts of a repeating effect: the frequencies that explain most by least squares.
fn scanned(
    target: &FitTarget,
    model: &Fit,
    candidate: &Setting,
    scan: Scan,
    change: &dyn Fn(&[f64]) -> Option<DVector<f64>>,
) -> Vec<Setting> {
    let names: Vec<&'static str> = candidate.values().map(|(name, _)| name).collect();
    let place = |name: &str| names.iter().position(|n| *n == name);
    let (Some(over), Some(phase)) = (place(scan.over), place(scan.phase)) else {
        return Vec::new();
    };
    let amplitudes: Vec<usize> = (0..names.len()).filter(|&i| i != over && i != phase).collect();
    let tried = match scan.range {
        ScanRange::Frequencies => {
            let names: Vec<&'static str> = amplitudes.iter().map(|&i| names[i]).collect();
            frequencies(target, model, candidate, scan, &names)
        }
        ScanRange::Orders([from, to, step]) => {
            let count = ((to - from) / step) as usize;
            (0..=count).map(|i| from + i as f64 * step).collect()
        }
        ScanRange::WaveNumbers([from, to, step]) => {
            let count = ((to - from) / step) as usize;
            let stride = count.div_ceil(TRIED).max(1);
            (0..=count).step_by(stride).map(|i| 1.0 / (from + i as f64 * step)).collect()
        }
    };
    // What was too much of an amplitude once is not tried again.
    let mut sizes: Vec<f64> =
        amplitudes.iter().map(|&amplitude| step(candidate.kind, names[amplitude])).collect();
    let scored = tried.into_iter().filter_map(|value| {
        let mut columns = Vec::new();
        for (&amplitude, size) in amplitudes.iter().zip(&mut sizes) {
            let unit = step(candidate.kind, names[amplitude]);
            for angle in [0.0, FRAC_PI_2] {
                let mut values = vec![0.0; names.len()];
                values[over] = value;
                values[phase] = angle;
                values[amplitude] = *size;
                let column = within(&model.white, &mut values, (&[amplitude], 0.0), change)?;
                *size = values[amplitude];
                columns.push(column * (unit / *size));
            }
        }
        let mut values = vec![0.0; names.len()];
        values[over] = value;
        let (removed, angle, along) = of_one_phase(&columns, &model.white)?;
        values[phase] = angle;
        for (&amplitude, along) in amplitudes.iter().zip(along) {
            values[amplitude] = along * step(candidate.kind, names[amplitude]);
        }
        Some((removed, candidate.with(&values)))
    });
    best(scored.collect(), KEPT)
}

/// Amplitudes that repeat with one phase, fitted to a residual by least squares: `columns` hold what a unit of each changes
/// of it at the phases 0 and π/2. What they remove, the phase (rad) of the largest, and of each its part in that phase.
pub(super) fn of_one_phase(
    columns: &[DVector<f64>],
    residual: &DVector<f64>,
) -> Option<(f64, f64, Vec<f64>)> {
    let matrix = DMatrix::from_columns(columns);
    let normal = matrix.transpose() * &matrix;
    let rhs = -(matrix.transpose() * residual);
    let weights = normal.cholesky()?.solve(&rhs);
    let pairs = weights.as_slice().chunks(2);
    let largest = pairs.clone().max_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])))?;
    let angle = largest[1].atan2(largest[0]);
    let along = pairs.map(|pair| pair[0] * angle.cos() + pair[1] * angle.sin()).collect();
    Some((weights.dot(&rhs), angle, along))
}

/// The size of a unit of a parameter.
fn step(kind: &Kind, name: &str) -> f64 {
    kind.parameter(name).map_or(1.0, |parameter| parameter.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::baseline::Baseline;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::effects::{Target, named};

    /// Friction near rest of a machine whose friction is a fiftieth of what a search starts from goes with that in motion.
    #[test]
    fn what_has_the_unit_of_a_size_goes_with_it() {
        let problem = RigProblem::planar("planar-6");
        let values = [("coulomb_N", 2e-3), ("static_N", 4e-3), ("stribeck_m_s", 0.1)];
        let joint = Target::Joints(vec!["slide".to_owned()]);
        let hidden = Setting::on(named("stribeck-friction").unwrap(), joint, &values);
        let released = problem.let_go(std::slice::from_ref(&hidden)).unwrap();
        let recorded = problem.simulated(&released, 1).unwrap().remove(0).remove(0);
        let problem = problem.recorded_as(recorded);
        let on = problem.split().on;
        let baseline = Baseline::of(&problem, &[], &[], &on).unwrap();
        let target = FitTarget { problem: &problem, baseline: &baseline, on: &on };
        let model = target.look(&[]).unwrap();
        let candidate = hidden.with(&[0.0, 0.0, 0.1]);
        let found = starts(&target, &model, &candidate, KEPT).remove(0);
        let value = |name: &str| found.value(name).unwrap();
        assert!((1e-3..4e-3).contains(&value("coulomb_N")), "{found:?}");
        assert!((value("static_N") / value("coulomb_N") - 2.0).abs() < 1e-9, "{found:?}");
    }
}
