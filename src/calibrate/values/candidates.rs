//! What could be missing: every effect, at every joint, in every variant; and where to start looking
//! for its values.

use super::fit::{self, LegsFit, LegsFitTarget};
use crate::effects::{
    ALL, CONTAINS, JointKinds, Kind, Scan, ScanRange, Setting, Target as On, Targets,
};
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Every effect at its neutral point, to be added to a model; none of the kinds `without`, nor what
/// contains them.
pub fn all(mechanism: &Mechanism, without: &[&str]) -> Vec<Setting> {
    let mut found = Vec::new();
    let ruled_out = |kind: &Kind| {
        let inner = CONTAINS.iter().filter(|(outer, _)| outer.name == kind.name);
        inner.map(|(_, inner)| *inner).chain([kind]).any(|kind| without.contains(&kind.name))
    };
    for kind in ALL.iter().filter(|kind| !ruled_out(kind)) {
        for on in targets(kind, mechanism) {
            for variant in kind.variants_of(mechanism, &on) {
                found.extend(Setting::neutral(kind, on.clone(), variant, mechanism));
            }
        }
    }
    found
}

/// What a kind may act on here: the platform, the whole machine, joints of one kind. The lens sees no other body,
/// no point beside the anchors and no instrument by itself, and takes what acts all the time.
fn targets(kind: &Kind, mechanism: &Mechanism) -> Vec<On> {
    if !kind.lasts() {
        return Vec::new();
    }
    let each = || kind.joints_of(mechanism).into_iter().map(|name| On::Joints(vec![name]));
    match kind.targets {
        Targets::Machine | Targets::Commands | Targets::Body => vec![On::Machine],
        Targets::Joint(JointKinds::Any) => Vec::new(),
        Targets::Joint(_) => each().collect(),
        Targets::JointOrAll(_) => each().chain([On::Machine]).collect(),
        Targets::Point | Targets::Sensor(_) | Targets::Tracker => Vec::new(),
    }
}

/// The best values of a candidate on a target: first what is linear, then Gauss–Newton from the most
/// promising starts. `model` is the target's residual without the candidate, `mechanism` a machine of the rig.
pub fn tune(
    target: &LegsFitTarget,
    mechanism: &Mechanism,
    model: &LegsFit,
    candidate: &Setting,
) -> Option<LegsFit> {
    let starts = starts(target, mechanism, model, candidate);
    let fits = starts.into_iter().filter_map(|start| fit::fit(target, &[start], 8));
    fits.min_by(|a, b| a.chi2.total_cmp(&b.chi2))
}

/// Starts that are kept for Gauss–Newton.
const KEPT: usize = 3;

fn starts(
    target: &LegsFitTarget,
    mechanism: &Mechanism,
    model: &LegsFit,
    candidate: &Setting,
) -> Vec<Setting> {
    let kind = candidate.kind;
    let change = |values: &[f64]| {
        target.look(&[candidate.with(values)]).map(|there| there.white - &model.white)
    };
    if let Some(scan) = kind.scan {
        return scanned(target, model, candidate, scan, &change);
    }
    let listed = candidate.starts(mechanism);
    if listed.is_empty() {
        return vec![candidate.clone()];
    }
    // The first value is an amplitude: the best multiple of each start, by least squares.
    let scored = listed.into_iter().filter_map(|mut start| {
        let column = change(&start)?;
        let multiple = -column.dot(&model.white) / column.norm_squared();
        if multiple <= 0.0 {
            return Some((0.0, candidate.with(&start)));
        }
        start[0] *= multiple;
        Some((multiple.powi(2) * column.norm_squared(), candidate.with(&start)))
    });
    best(scored.collect())
}

/// The starts that promise most.
fn best(mut scored: Vec<(f64, Setting)>) -> Vec<Setting> {
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.truncate(KEPT);
    scored.into_iter().map(|(_, start)| start).collect()
}

/// Starts of a repeating effect: the frequencies that explain most by least squares.
fn scanned(
    target: &LegsFitTarget,
    model: &LegsFit,
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
        ScanRange::WaveNumbers(range) => waves(target, candidate, range),
        ScanRange::Frequencies => peaks(target, model),
        ScanRange::Orders([from, to, step]) => {
            (0..).map(|i| from + step * f64::from(i)).take_while(|order| *order <= to).collect()
        }
    };
    let scored = tried.into_iter().filter_map(|value| {
        let mut columns = Vec::new();
        for &amplitude in &amplitudes {
            for angle in [0.0, std::f64::consts::FRAC_PI_2] {
                let mut values = vec![0.0; names.len()];
                values[over] = value;
                values[phase] = angle;
                values[amplitude] = step(candidate.kind, names[amplitude]);
                columns.push(change(&values)?);
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
    best(scored.collect())
}

/// Amplitudes that repeat with one phase, fitted to a residual by least squares: `columns` hold what a unit of each changes
/// of it at the phases 0 and π/2. What they remove, the phase (rad) of the largest, and of each its part in that phase.
pub(in crate::calibrate) fn of_one_phase(
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
pub(in crate::calibrate) fn step(kind: &Kind, name: &str) -> f64 {
    kind.parameter(name).map_or(1.0, |parameter| parameter.step)
}

/// Values of a scan that are looked at closely.
const TRIED: usize = 40;

/// Frequencies in Hz at which the residual of the dynamics stands out most.
fn peaks(target: &LegsFitTarget, model: &LegsFit) -> Vec<f64> {
    /// So much (Hz) lies between two of them.
    const APART: f64 = 0.5;
    let mut power: BTreeMap<u64, f64> = BTreeMap::new();
    for (value, (channel, frequency)) in
        model.white.iter().zip(target.baseline.places(target.case, target.on))
    {
        // The servo's law and the closure do not see forces.
        if channel >= 6 && frequency > APART {
            *power.entry((frequency * 1e6) as u64).or_default() += value * value;
        }
    }
    let power = power.into_iter().map(|(frequency, power)| (frequency as f64 * 1e-6, power));
    highest(power.collect(), APART)
}

/// Periods in m whose waves over a leg's length stand out most in what is left of its closure or its
/// force, when what varies slowly with the length is taken out.
fn waves(target: &LegsFitTarget, candidate: &Setting, [from, to, step]: [f64; 3]) -> Vec<f64> {
    let first = if candidate.values().any(|(name, _)| name == "amplitude_m") { 3 } else { 6 };
    let Some(segment) = target.on.first() else { return Vec::new() };
    let Ok((signals, lengths)) = target.case.plain(target.fixed, segment) else {
        return Vec::new();
    };
    let legs: Vec<usize> = (0..3)
        .filter(|leg| candidate.joint().is_none_or(|joint| joint == format!("P{}", leg + 1)))
        .collect();
    let flat: Vec<Vec<f64>> = legs
        .iter()
        .map(|&leg| without_trend(&lengths[leg], &signals[first + leg].values))
        .collect();
    let count = ((to - from) / step) as usize;
    let power = (0..=count).map(|i| {
        let number = from + i as f64 * step;
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (values, &leg) in flat.iter().zip(&legs) {
            for (value, q) in values.iter().zip(&lengths[leg]) {
                let (s, c) = (TAU * number * q).sin_cos();
                sine += value * s;
                cosine += value * c;
            }
        }
        (number, sine * sine + cosine * cosine)
    });
    highest(power.collect(), 2.0 * step).into_iter().map(|number| 1.0 / number).collect()
}

/// What is left of `values` when a parabola over `x` is taken out, by least squares.
fn without_trend(x: &[f64], values: &[f64]) -> Vec<f64> {
    let middle = x.iter().sum::<f64>() / x.len() as f64;
    let matrix = DMatrix::from_fn(x.len(), 3, |r, c| ((x[r] - middle) * 10.0).powi(c as i32));
    let rhs = DVector::from_column_slice(values);
    let normal = matrix.transpose() * &matrix;
    match normal.cholesky() {
        Some(factor) => {
            let weights = factor.solve(&(matrix.transpose() * &rhs));
            (rhs - matrix * weights).as_slice().to_vec()
        }
        None => values.to_vec(),
    }
}

/// The places with the most power, at least `apart` from each other.
fn highest(mut power: Vec<(f64, f64)>, apart: f64) -> Vec<f64> {
    power.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut kept: Vec<f64> = Vec::new();
    for (place, _) in power {
        if kept.len() < TRIED && kept.iter().all(|k| (k - place).abs() > apart) {
            kept.push(place);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;
    use crate::simulate::assemble;

    /// The search's thresholds were found with this many ways to explain a residual; more of them would
    /// explain more noise.
    #[test]
    fn on_three_legs_the_lens_is_asked_about_the_effects_that_it_sees() {
        let text = "mechanism = { kind = \"3rpr\" }\n";
        let machine = assemble(&Scenario::from_text(text, "test.toml", &[]).unwrap()).unwrap();
        let found = all(&machine.mechanism, &[]);
        assert_eq!(
            found.len(),
            96,
            "thresholds of this method were found with 96 ways: keep a new effect from it where it sees nothing of it, or \
             hold the rates of its trials (docs/calibrate.md) against those with the effect, and write the new number here"
        );
        let of = |kind: &str| found.iter().filter(|setting| setting.kind.name == kind).count();
        for (kind, count) in [("payload", 1), ("drive-compliance", 4), ("actuator-friction", 15)] {
            assert_eq!(of(kind), count, "{kind}");
        }
        for kind in ["joint-friction", "point-offset", "impulse", "encoder-zero", "torque-ripple"] {
            assert_eq!(of(kind), 0, "{kind}");
        }
    }
}
