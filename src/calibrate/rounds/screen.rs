//! Every candidate through the lens alone, which takes no simulation.

use crate::calibrate::values::baseline::LegsBaseline;
use crate::calibrate::values::candidates;
use crate::calibrate::values::fit::{self, LegsFitTarget};
use crate::calibrate::values::instrument::changed;
use crate::calibrate::values::model::LegsCase;
use crate::calibrate::values::settle::{FitData, GAIN_PER_VALUE, Settled};
use crate::effects::Setting;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Drop of Σ of squares on the fitted data from which a candidate's values are worth fitting together
/// with the others'.
const WORTH: f64 = 20.0;

/// A candidate and what it brings on data not used for its fit.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The candidate at its best values.
    pub effect: Setting,
    /// Drop of Σ of squares on the held-out segments, less what its number of values may bring.
    pub gain: f64,
    /// Drop of Σ of squares on the segments that it was fitted on.
    pub fitted: f64,
    /// Share of the excess above noise that it removes on the held-out segments, 0…1.
    pub share: f64,
    /// Whether it was simulated, rather than looked at through the lens alone.
    pub simulated: bool,
}

/// Share of what is above noise that is gone.
pub fn share(
    before: f64,
    after: f64,
    case: &LegsCase,
    question: &FitData,
    baseline: &LegsBaseline,
) -> f64 {
    let noise = baseline.places(case, question.hold).len() as f64;
    let excess = (before - noise).max(1.0);
    ((before - after) / excess).clamp(0.0, 1.0)
}

/// All candidates through the lens alone: fitted on some data, scored on others, the best first, each
/// with the model that it makes.
pub fn screen(case: &LegsCase, question: &FitData, model: &Settled) -> Vec<(Scored, Vec<Setting>)> {
    let baseline = &model.baseline;
    let target = LegsFitTarget { case, baseline, on: question.on, fixed: &[], blind: None };
    let Ok(machine) = case.runs[0].machine(&case.rig, &[]) else { return Vec::new() };
    let candidates = candidates::all(&machine, question.without);
    // What the values of the present effects could make good: the same for nearly every candidate.
    let Some(present) = without_values(&target, &model.fit.effects) else { return Vec::new() };
    let mut scored: Vec<(Scored, Vec<Setting>)> = candidates
        .par_iter()
        .filter_map(|candidate| {
            // A fuller variant of an effect that the model has takes its place.
            if model.fit.effects.iter().any(|effect| {
                effect.is(candidate) && effect.values().count() >= candidate.values().count()
            }) {
                return None;
            }
            let others: Vec<Setting> =
                model.fit.effects.iter().filter(|effect| !effect.is(candidate)).cloned().collect();
            let replaced = others.len() < model.fit.effects.len();
            let fewer = if replaced { Some(without_values(&target, &others)?) } else { None };
            let blind = fewer.as_ref().unwrap_or(&present);
            let own = LegsFitTarget { fixed: &others, blind: blind.as_ref(), ..target };
            let plain = own.look(&[])?;
            let tuned = candidates::tune(&own, &machine, &plain, candidate)?;
            let fitted = plain.chi2 - tuned.chi2;
            let mut effects = [others, tuned.effects.clone()].concat();
            // All values together, where it is worth the time.
            if fitted > WORTH && (effects.len() > 1 || baseline.rattles) {
                let fit = fit::fit(&target, &effects, 3)?;
                let fit = if baseline.rattles { fit::without_pull(&target, fit) } else { fit };
                effects = fit.effects;
            }
            let held = LegsFitTarget { on: question.hold, ..target };
            let mut left = held.look(&effects)?.chi2;
            // What rattle hides in the data may show in replicas; a simulation will tell.
            if baseline.rattles {
                left = left.min(changed(&held, &model.fit.effects, &effects)?.norm_squared());
            }
            let effect = effects.last()?.clone();
            let gain = model.held - left - GAIN_PER_VALUE * effect.values().count() as f64;
            let share = share(model.held, left, case, question, baseline);
            Some((Scored { effect, gain, fitted, share, simulated: false }, effects))
        })
        .collect();
    scored.sort_by(|a, b| b.0.gain.total_cmp(&a.0.gain));
    scored
}

/// Orthonormal directions of the residual that the values of `effects` could make good, none without
/// effects; or nothing where the machine cannot be.
fn without_values(target: &LegsFitTarget, effects: &[Setting]) -> Option<Option<DMatrix<f64>>> {
    if effects.is_empty() {
        return Some(None);
    }
    let bare = target.look(effects)?;
    Some(fit::jacobian(target, &bare).map(|jacobian| jacobian.qr().q()))
}
