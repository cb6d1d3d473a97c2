//! Detection limits: how large each effect would have to be for these recordings to show it.
//!
//! By the linearisation of the fit: an effect of size a changes the residual in units of noise by `a c`. A search
//! sees it where that makes some residual more than noise, and names it where what the values of the model cannot
//! make good, `a c⊥`, brings more than a chance candidate does. Currie, *Anal. Chem.* 40 (1968) 586–593, has the
//! two kinds of error that a limit is a balance of.

use super::left::Left;
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::thresholds::{GAIN, GAIN_PER_VALUE, SURE};
use crate::calibrate::sensed::values::candidates::within;
use crate::calibrate::sensed::values::fit::FitTarget as Fitted;
use crate::calibrate::sensed::values::model::Model;
use crate::effects::{Kind, ScanRange, Setting, Target};
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// The smallest size of an effect that would have been seen.
#[derive(Clone, Debug)]
pub struct DetectionLimit {
    /// Which effect.
    pub kind: &'static Kind,
    /// Of what.
    pub target: Target,
    /// Its parameter that is looked at, and its unit.
    pub parameter: &'static str,
    /// See there.
    pub unit: &'static str,
    /// How far from its neutral value that would have to be; none where no size would show.
    pub smallest: Option<f64>,
}

/// Numbers of white residuals that belong together, and what is left there now.
struct WhiteNumbers {
    places: Vec<usize>,
    left: Left,
}

/// Limits of all candidates beside a model whose residuals are noise, on the data that they are judged on; none
/// where residuals are not.
pub fn limits(search: &Search, model: &Model) -> Vec<DetectionLimit> {
    if !search.is_noise(model) {
        return Vec::new();
    }
    let hold =
        Fitted { problem: search.problem, baseline: &model.baseline, on: &search.split.hold };
    let Some(base) = hold.look(&model.fit.effects) else { return Vec::new() };
    let own = hold.jacobian(&base).filter(|jacobian| jacobian.ncols() > 0);
    let own = own.map(|jacobian| jacobian.qr().q());
    let places = model.baseline.places(search.problem, &search.split.hold);
    let of = |(k, left): (usize, Left)| {
        let places = (0..places.len()).filter(|&i| places[i].0 == k).collect();
        WhiteNumbers { places, left }
    };
    let parts: Vec<WhiteNumbers> =
        search.left_on(model, true).into_iter().enumerate().map(of).collect();
    let fresh = |candidate: &&Setting| !model.fit.effects.iter().any(|e| e.is(candidate));
    let found: Vec<DetectionLimit> = simplest(search.candidates.iter().filter(fresh))
        .into_par_iter()
        .filter_map(|candidate| {
            let (parameter, neutral) = candidate.values().next()?;
            let step = candidate.kind.parameter(parameter)?;
            let listed = !candidate.starts(&search.problem.declared).is_empty();
            let sizes = if listed { candidate.sizes() } else { vec![0] };
            let ways = ways(&search.problem.declared, candidate, neutral, step.step);
            let change = |values: &[f64]| {
                let with = [model.fit.effects.as_slice(), &[candidate.with(values)]].concat();
                Some(hold.look(&with)?.white - &base.white)
            };
            // Seen whatever its phase: the way that shows least counts.
            let smallest = ways.into_iter().try_fold(0.0f64, |worst, mut values| {
                let column = within(&base.white, &mut values, (&sizes, neutral), &change)?;
                let column = column / (values[0] - neutral).abs();
                Some(worst.max(size(&column, own.as_ref(), &parts, model.baseline.rattles)))
            });
            let room = (step.bounds[1] - neutral).abs().max((step.bounds[0] - neutral).abs());
            let smallest = smallest.filter(|size| size.is_finite() && *size <= room);
            let (kind, target) = (candidate.kind, candidate.target.clone());
            Some(DetectionLimit { kind, target, parameter, unit: step.unit, smallest })
        })
        .collect();
    found
}

/// Of each effect on each target the variant with the fewest values.
fn simplest<'a>(candidates: impl Iterator<Item = &'a Setting>) -> Vec<&'a Setting> {
    let mut found: Vec<&Setting> = Vec::new();
    for candidate in candidates {
        match found.iter_mut().find(|known| known.is(candidate)) {
            Some(known) if known.values().count() > candidate.values().count() => {
                *known = candidate;
            }
            Some(_) => {}
            None => found.push(candidate),
        }
    }
    found
}

/// Values at which a candidate is looked at: a step from neutral, for each place where a search for it starts.
pub(in crate::calibrate) fn ways(
    mechanism: &Mechanism,
    candidate: &Setting,
    neutral: f64,
    step: f64,
) -> Vec<Vec<f64>> {
    let names: Vec<&str> = candidate.values().map(|(name, _)| name).collect();
    let own: Vec<f64> = candidate.values().map(|(_, value)| value).collect();
    let moved = |mut values: Vec<f64>| {
        values[0] = neutral + step;
        values
    };
    let place = |name: &str| names.iter().position(|n| *n == name);
    if let Some(scan) = candidate.kind.scan
        && let (Some(over), Some(phase)) = (place(scan.over), place(scan.phase))
    {
        let tried: Vec<f64> = match scan.range {
            ScanRange::Frequencies => vec![1.0, 5.0, 25.0],
            ScanRange::Orders([from, to, _]) => vec![from, (from * to).sqrt(), to],
            ScanRange::WaveNumbers([from, to, _]) => {
                [from, (from * to).sqrt(), to].map(|k| 1.0 / k).to_vec()
            }
        };
        let with = |value: f64| {
            [0.0, FRAC_PI_2].map(|angle| {
                let mut values = moved(own.clone());
                (values[over], values[phase]) = (value, angle);
                values
            })
        };
        return tried.into_iter().flat_map(with).collect();
    }
    let listed = candidate.starts(mechanism);
    let listed = listed.iter().map(|start| candidate.sized(start, neutral + step));
    if listed.len() == 0 { vec![moved(own)] } else { listed.collect() }
}

/// The size at which an effect with this column would be seen and named.
fn size(
    column: &DVector<f64>,
    own: Option<&DMatrix<f64>>,
    parts: &[WhiteNumbers],
    rattles: bool,
) -> f64 {
    let across = match own {
        Some(q) => column - q * (q.transpose() * column),
        None => column.clone(),
    };
    // Σ(n + a c)² grows by a²|c|² give or take 2 a |c|.
    let named = (GAIN[usize::from(rattles)] + GAIN_PER_VALUE).sqrt() + SURE;
    let named = named / across.norm();
    let seen = parts.iter().map(|part| {
        let count = part.places.len() as f64;
        let squares: f64 = part.places.iter().map(|&i| across[i].powi(2)).sum();
        let largest = part.places.iter().map(|&i| across[i].abs()).fold(0.0, f64::max);
        let short = (part.left.limit - part.left.mean_square).max(0.0) * count;
        let short = short + SURE * (2.0 * count).sqrt();
        ((short / squares).sqrt()).min((part.left.largest_limit + SURE) / largest)
    });
    named.max(seen.fold(f64::INFINITY, f64::min))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::residual::ResidualKind;

    /// Where draws of rattle reach further than 1.3 in mean square or 6 at the largest, an effect has to show by more to be seen.
    #[test]
    fn what_noise_may_be_is_not_seen() {
        let size_of = |column: &DVector<f64>, limit: f64, largest_limit: f64| {
            let of = "A".to_owned();
            let residual = ResidualKind::Closure;
            let left = Left {
                residual,
                of,
                mean_square: 1.0,
                limit,
                largest: 3.0,
                largest_limit,
                noise: true,
            };
            let part = WhiteNumbers { places: (0..column.len()).collect(), left };
            size(column, None, &[part], false)
        };
        let spread = DVector::from_element(100, 1.0);
        // √(0.3 + 2 √200 / 100) and √(2 + 2 √200 / 100): by its mean square.
        assert!((size_of(&spread, 1.3, 6.0) - 0.763).abs() < 1e-3);
        assert!((size_of(&spread, 3.0, 6.0) - 1.511).abs() < 1e-3);
        // 6 + 2 and 9 + 2: by its largest.
        let single = DVector::from_fn(100, |row, _| if row == 7 { 1.0 } else { 0.0 });
        assert!((size_of(&single, 3.0, 6.0) - 8.0).abs() < 1e-9);
        assert!((size_of(&single, 3.0, 9.0) - 11.0).abs() < 1e-9);
    }
}
