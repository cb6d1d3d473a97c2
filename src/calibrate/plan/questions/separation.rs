//! How far apart models are along a motion, in standard deviations of the residuals' noise.
//!
//! **Detection.** With c the change of the residuals by an effect, in units of noise, a look finds it with the deflection
//! `‖c‖`: the Fisher information about its size, times its square (S. M. Kay, *Fundamentals of Statistical Signal
//! Processing* II, 1998, section 4.3). Where an effect may come in several ways (a phase, a place), the way that shows
//! least counts.
//!
//! **Discrimination.** Of two rivals that differ by d, the values of the rival are free. With J the derivative of the
//! residuals by these, what no values make good is `d⊥ = (I − J J⁺) d`; its norm is the criterion of A. C. Atkinson,
//! V. V. Fedorov, *Biometrika* 62 (1975) 57–70 (T-optimality), with the fit of the rival linearised about its best
//! values. Either of the two may be the truth: the smaller of both counts.

use super::sight::{Seen, Sight};
use crate::calibrate::sensed::limits::ways;
use crate::calibrate::sensed::thresholds::{GAIN, GAIN_PER_VALUE, SURE, TWINS};
use crate::calibrate::values::least_squares::{FitEffort, jacobian, least_squares};
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::effects::Setting;
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Standard deviations from which a calibration names an effect of one value: what it has to bring, and enough more that
/// noise does not take it away.
pub fn named() -> f64 {
    (GAIN[0] + GAIN_PER_VALUE).sqrt() + SURE
}

/// Standard deviations from which a calibration calls no rival as good.
pub fn told() -> f64 {
    TWINS[0].sqrt() + SURE
}

/// Standard deviations below which a change is none: rounding of poses that are closed to a tenth of a picometre.
const NOTHING: f64 = 1e-3;

/// Steps of the fit of a rival, and starts of it that are followed.
const STEPS: usize = 8;
const STARTS: usize = 2;

/// A question with numbers: what models are held against each other.
#[derive(Clone, Debug)]
pub enum PosedQuestion {
    /// Two rivals.
    Between {
        /// Both.
        rivals: [Setting; 2],
        /// What may be, and the other one at the values by which it comes nearest on the present motion: each of the two
        /// may be the truth.
        pairs: Vec<[Setting; 2]>,
    },
    /// An effect in all its ways, each at the size that is to be seen.
    Detect {
        /// The effect.
        effect: Setting,
        /// Its ways.
        ways: Vec<Setting>,
    },
}

impl PosedQuestion {
    /// Standard deviations that answer it.
    pub fn wanted(&self) -> f64 {
        match self {
            Self::Between { .. } => told(),
            Self::Detect { .. } => named(),
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Between { rivals: [a, b], .. } => format!("{a} or {b}"),
            Self::Detect { effect, .. } => effect.to_string(),
        }
    }
}

/// How far apart the models of a question are.
#[derive(Clone, Debug)]
pub struct Apart {
    /// Standard deviations.
    pub sigma: f64,
    /// The change of the residuals that this is the norm of.
    pub difference: DVector<f64>,
}

/// How far apart the models of a question are along a recorded motion, rivals linearised about their values; none where a
/// model cannot be there.
pub fn apart(sight: &Sight, seen: &Seen, posed: &PosedQuestion) -> Option<Apart> {
    let least = |all: Vec<Apart>| all.into_iter().min_by(|a, b| a.sigma.total_cmp(&b.sigma));
    match posed {
        PosedQuestion::Detect { ways, .. } => {
            let base = sight.look(seen, &[])?;
            let one =
                |way: &Setting| Some(of(sight.look(seen, std::slice::from_ref(way))? - &base));
            least(ways.par_iter().map(one).collect::<Option<Vec<_>>>()?)
        }
        PosedQuestion::Between { pairs, .. } => {
            let one = |[truth, rival]: &[Setting; 2]| {
                let look = |values: &[f64]| sight.look(seen, &[rival.with(values)]);
                let effects = std::slice::from_ref(rival);
                let here = look(&values(effects))?;
                let derivative = jacobian(&look, &free(effects), &values(effects), &here)?;
                let difference = sight.look(seen, std::slice::from_ref(truth))? - &here;
                Some(of(beyond(&difference, &derivative)))
            };
            least(pairs.par_iter().map(one).collect::<Option<Vec<_>>>()?)
        }
    }
}

fn of(difference: DVector<f64>) -> Apart {
    Apart { sigma: difference.norm(), difference }
}

/// What of a difference the columns of a derivative do not make up. Columns are scaled to one, and such as the others
/// make up but for rounding count with them.
fn beyond(difference: &DVector<f64>, derivative: &DMatrix<f64>) -> DVector<f64> {
    let mut left = difference.clone();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for column in derivative.column_iter() {
        let norm = column.norm();
        if norm == 0.0 {
            continue;
        }
        let mut unit = column / norm;
        // Twice: once leaves what rounding made of nearly parallel columns.
        for _ in 0..2 {
            for known in &basis {
                unit -= known * known.dot(&unit);
            }
        }
        let rest = unit.norm();
        if rest > 1e-6 {
            unit /= rest;
            left -= &unit * unit.dot(&left);
            basis.push(unit);
        }
    }
    left
}

/// The values of a rival that come nearest to what a truth shows along a recorded motion, and what is left then; none
/// where no such machine can be.
pub fn nearest(
    sight: &Sight,
    seen: &Seen,
    truth: &[Setting],
    rival: &Setting,
) -> Option<(Setting, Apart)> {
    let (base, target) = (sight.look(seen, &[])?, sight.look(seen, truth)?);
    let wanted = &target - &base;
    let mechanism = sight.declared();
    // All its variants: the search has them all.
    let variants = rival.kind.variants_of(mechanism, &rival.target);
    let starts: Vec<(f64, Setting)> = variants
        .into_iter()
        .filter_map(|variant| {
            Setting::neutral(rival.kind, rival.target.clone(), variant, mechanism)
        })
        .flat_map(|neutral| {
            let first = neutral.values().next().map_or(0.0, |(_, value)| value);
            stepped(mechanism, &neutral).into_iter().map(move |start| (first, start))
        })
        .collect();
    let scored = |(neutral, start): &(f64, Setting)| {
        let column = sight.look(seen, std::slice::from_ref(start))? - &base;
        let multiple = column.dot(&wanted) / column.norm_squared();
        let gain = multiple * column.dot(&wanted);
        if !gain.is_finite() {
            return None;
        }
        let mut own = values(std::slice::from_ref(start));
        let (name, first) = start.values().next()?;
        own[0] = start.kind.parameter(name)?.clamped(neutral + multiple * (first - neutral));
        Some((gain, start.with(&own)))
    };
    let mut scored: Vec<(f64, Setting)> = starts.par_iter().filter_map(scored).collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    // The best starts of each variant: one with fewer values may come as near.
    let mut kept: Vec<Setting> = Vec::new();
    for (_, start) in scored {
        let count = start.values().count();
        if kept.iter().filter(|known| known.values().count() == count).count() < STARTS {
            kept.push(start);
        }
    }
    let effort = FitEffort { steps: STEPS, enough: 1e-3, secant: false };
    let fitted = |start: &Setting| {
        let effects = std::slice::from_ref(start);
        let look =
            |values: &[f64]| Some(sight.look(seen, &with_values(effects, values))? - &target);
        let best = least_squares(&look, &free(effects), values(effects), effort, None)?;
        Some((start.with(&best.values), of(best.residual)))
    };
    let fits: Vec<(Setting, Apart)> = kept.par_iter().filter_map(fitted).collect();
    fits.into_iter().min_by(|a, b| a.1.sigma.total_cmp(&b.1.sigma))
}

/// An effect a small step from where it changes nothing, in each of its ways.
fn stepped(mechanism: &Mechanism, neutral: &Setting) -> Vec<Setting> {
    let Some((name, value)) = neutral.values().next() else { return Vec::new() };
    let Some(parameter) = neutral.kind.parameter(name) else { return Vec::new() };
    let step =
        if value + parameter.step > parameter.bounds[1] { -parameter.step } else { parameter.step };
    ways(mechanism, neutral, value, step).iter().map(|values| neutral.with(values)).collect()
}

/// The size of an effect at which a look would name it in all of its ways that show at all, its first value's distance
/// from neutral: a mass in a body's fixed pivot moves nothing, whatever it is. None where no way shows at a size that
/// makes sense, or no machine can be looked at.
pub fn detectable(sight: &Sight, seen: &Seen, effect: &Setting) -> Option<f64> {
    let base = sight.look(seen, &[])?;
    let (name, neutral) = effect.values().next()?;
    let [low, high] = effect.kind.parameter(name)?.bounds;
    let room = (high - neutral).abs().max((neutral - low).abs());
    let one = |way: &Setting| {
        let (_, value) = way.values().next()?;
        let column = sight.look(seen, std::slice::from_ref(way))? - &base;
        let size = named() * (value - neutral).abs() / column.norm();
        (size.is_finite() && size <= room).then_some(size)
    };
    stepped(sight.declared(), effect)
        .par_iter()
        .filter_map(one)
        .collect::<Vec<f64>>()
        .into_iter()
        .reduce(f64::max)
}

/// Whether a model changes what is seen of a machine at all.
pub fn shows(sight: &Sight, seen: &Seen, effect: &Setting) -> bool {
    let looks = sight.look(seen, &[]).zip(sight.look(seen, std::slice::from_ref(effect)));
    looks.is_some_and(|(without, with)| (with - without).norm() > NOTHING)
}

/// The effect in all its ways at a size (the first value's distance from neutral), within bounds.
pub fn sized(mechanism: &Mechanism, effect: &Setting, size: f64) -> Vec<Setting> {
    let Some((name, neutral)) = effect.values().next() else { return Vec::new() };
    let Some(parameter) = effect.kind.parameter(name) else { return Vec::new() };
    let value = neutral + size;
    let step = if value > parameter.bounds[1] { -size } else { size };
    let step = parameter.clamped(neutral + step) - neutral;
    ways(mechanism, effect, neutral, step).iter().map(|values| effect.with(values)).collect()
}
