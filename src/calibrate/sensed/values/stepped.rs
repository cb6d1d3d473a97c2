//! Linear steps of candidates' values by whole simulations of a hair beside their neutral ones, or of as much as changes what is
//! left by all that is missing.

use super::linear::{remains, stepped_along};
use super::whole::Whole;
use crate::calibrate::values::least_squares::{Free, ResidualAt, derivative, free};
use crate::calibrate::values::rough::derivative_over;
use crate::effects::Setting;
use crate::mechanism::Mechanism;
use nalgebra::DVector;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::{Mutex, PoisonError};

/// How often one that keeps less than half of what it promises is halved: a long one of what hardly acts promises much.
const HALVED: i32 = 3;

/// How often one is doubled as long as that takes more off: what gives way acts the less by a hair the stiffer it is as declared.
const DOUBLED: i32 = 4;

/// How far a value is moved for a derivative.
#[derive(Clone, Copy, Debug)]
pub(in crate::calibrate::sensed) enum StepLength {
    /// By a hair.
    Hair,
    /// By as much as changes a residual by about `change` units of noise beside what hits make of a hair, which is `rough` at most.
    Change { change: f64, rough: f64 },
}

impl StepLength {
    fn derivative(
        self,
        look: ResidualAt,
        free: &[Free],
        values: &[f64],
        left: &DVector<f64>,
        i: usize,
    ) -> Option<DVector<f64>> {
        match self {
            StepLength::Hair => derivative(look, free, values, left, i),
            StepLength::Change { change, rough } => {
                derivative_over(look, free[i], (values, i), left, [change, rough])
            }
        }
    }
}

/// Residuals of variants of one effect, each machine simulated once: one that does not have a value has it at nothing.
pub(in crate::calibrate::sensed) struct Variants<'a> {
    look: &'a (dyn Fn(&Setting) -> Option<DVector<f64>> + Sync),
    known: Mutex<HashMap<Vec<u64>, Option<DVector<f64>>>>,
}

impl<'a> Variants<'a> {
    /// Those of the effects that `look` knows the residuals of.
    pub fn new(look: &'a (dyn Fn(&Setting) -> Option<DVector<f64>> + Sync)) -> Self {
        Self { look, known: Mutex::default() }
    }

    /// The residual with an effect.
    pub fn look(&self, effect: &Setting) -> Option<DVector<f64>> {
        let values = effect.kind.parameters.iter().map(|p| effect.value(p.name).unwrap_or(0.0));
        let key: Vec<u64> = values.map(f64::to_bits).collect();
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(residual) = known().get(&key) {
            return residual.clone();
        }
        let residual = (self.look)(effect);
        known().insert(key, residual.clone());
        residual
    }
}

/// A candidate and one linear step of its values.
pub(in crate::calibrate::sensed) struct Stepped {
    /// Drop of the sum of squares that it promises.
    pub gain: f64,
    /// Before it.
    from: Setting,
    /// After it.
    pub to: Setting,
}

impl Stepped {
    /// What a simulation some way along the step takes off the sum of squares of what is `left` beside `own` effects, less what
    /// other coordinates to let the machine go from make up for, by which `starts` are the derivatives; and the candidate there.
    /// None where such a machine cannot be.
    pub fn tried(
        &self,
        whole: &Whole,
        own: &[Setting],
        starts: &[DVector<f64>],
        left: &DVector<f64>,
    ) -> Option<(f64, Setting)> {
        let before = remains(starts, left)?;
        let gain = |times: f64| {
            let there = self.times(times);
            let seen = whole.look(&[own, std::slice::from_ref(&there)].concat())?;
            Some((before - remains(starts, &seen)?, there))
        };
        let kept = |tried: &(f64, Setting)| tried.0 > 0.5 * self.gain;
        let first = gain(1.0);
        let Some(mut best) = first.clone().filter(kept) else {
            let shorter = (1..=HALVED).filter_map(|halved| gain(0.5f64.powi(halved)));
            return first.into_iter().chain(shorter).max_by(|a, b| a.0.total_cmp(&b.0));
        };
        for doubled in 1..=DOUBLED {
            let more = gain(2.0f64.powi(doubled)).filter(|more| more.0 > best.0);
            let Some(more) = more else { break };
            best = more;
        }
        Some(best)
    }

    /// The candidate so many times along the step, as far as its values make sense.
    fn times(&self, times: f64) -> Setting {
        let bounds = free(std::slice::from_ref(&self.from)).into_iter().map(|free| free.bounds);
        let ends = self.from.values().zip(self.to.values()).zip(bounds);
        let values =
            ends.map(
                |(((_, from), (_, to)), [low, high])| {
                    if from == to { from } else { (from + times * (to - from)).clamp(low, high) }
                },
            );
        self.from.with(&values.collect::<Vec<f64>>())
    }
}

/// A linear step of a candidate's values, whose gain is the drop of the sum of squares of what is `left` beyond that by one of the
/// coordinates from which a machine that nothing holds was let go, by which `starts` are the derivatives. None where such a
/// machine cannot be.
pub(in crate::calibrate::sensed) fn linear_step(
    look: ResidualAt,
    (mechanism, candidate): (&Mechanism, &Setting),
    starts: &[DVector<f64>],
    left: &DVector<f64>,
    over: StepLength,
) -> Option<Stepped> {
    let names: Vec<&str> = candidate.values().map(|(name, _)| name).collect();
    let neutral: Vec<f64> = candidate.values().map(|(_, value)| value).collect();
    let free = free(std::slice::from_ref(candidate));
    let alone = remains(starts, left)?;
    let stepped = |columns: &[DVector<f64>], own: &[f64], free: &[Free]| {
        let all = [starts, columns].concat();
        let (least, change) = stepped_along(&all, starts.len(), left, own, free)?;
        let gain = alone - least;
        let change: Vec<f64> = change.iter().skip(starts.len()).copied().collect();
        gain.is_finite().then_some((gain, change))
    };
    // Of one with a list of starts the first value is its size, which begins at nothing; the others are a start's.
    let listed = candidate.starts(mechanism);
    let grows = |start: &[f64]| {
        let look = |size: &[f64]| look(&candidate.sized(start, size[0]));
        over.derivative(&look, &free[..1], &neutral[..1], left, 0)
    };
    if let (true, [begin, next, ..]) = (turns_round(&names, &listed), listed.as_slice()) {
        let across = &listed[listed.len() / 4];
        let columns = [begin, across].map(|start| grows(start));
        let [Some(first), Some(across)] = columns else { return None };
        let wide = Free { bounds: [-f64::MAX, f64::MAX], ..free[0] };
        let (gain, change) = stepped(&[first, across], &[0.0; 2], &[wide; 2])?;
        let turn = change[1].atan2(change[0]).rem_euclid(TAU) / TAU;
        let angle = begin[1] + turn * listed.len() as f64 * (next[1] - begin[1]);
        let amplitude = neutral[0] + change[0].hypot(change[1]);
        let [from, to] = [neutral[0], amplitude].map(|size| candidate.with(&[size, angle]));
        return Some(Stepped { gain, from, to });
    }
    if let Some(start) = listed.first() {
        let (gain, change) = stepped(&[grows(start)?], &neutral[..1], &free[..1])?;
        let [from, to] = [neutral[0], neutral[0] + change[0]]
            .map(|size| candidate.with(&candidate.sized(start, size)));
        return Some(Stepped { gain, from, to });
    }
    let slope = |i: usize| over.derivative(look, &free, &neutral, left, i);
    let columns: Vec<_> = (0..neutral.len()).map(slope).collect::<Option<_>>()?;
    let (gain, change) = stepped(&columns, &neutral, &free)?;
    let values: Vec<f64> = neutral.iter().zip(change).map(|(value, by)| value + by).collect();
    Some(Stepped { gain, from: candidate.with(&neutral), to: candidate.with(&values) })
}

/// Whether a list of starts goes once round the period of an angle, their last value, in equal steps: what a quarter of them
/// apart is then is the cosine and the sine of one wave, in which a response is linear.
fn turns_round(names: &[&str], listed: &[Vec<f64>]) -> bool {
    let angle = names.last().is_some_and(|name| name.ends_with("_rad"));
    angle && names.len() == 2 && listed.len() >= 4 && listed.len().is_multiple_of(4)
}
