//! Values of a model that agree with simulations of it.

use super::baseline::{LegsBaseline, Like};
use super::fit::{self, LegsFit, LegsFitTarget};
use super::instrument::changed;
use super::least_squares::values;
use super::model::{LegsCase, LegsSegment, SearchError};
use super::whole::{close, rough};
use crate::effects::Setting;

/// How much more than nothing each value of an effect has to bring: Akaike's price of a parameter in
/// units of −2 log likelihood.
pub const GAIN_PER_VALUE: f64 = 2.0;

/// The change of a value, in its standard deviations, that is no change: of a model that may be the last,
/// and of one that is compared with others.
pub const SETTLED: f64 = 0.3;
const NEARLY: f64 = 3.0;

/// Mean square in units of noise through the lens beyond which a model lacks more than digits of its
/// values. A mass and where it sits may settle as far off as 5: what the lens is wrong by changes with
/// them as much as the residual does; whole simulations find them from there.
pub const HOPEFUL: f64 = 8.0;

/// A model that simulations of itself have been held against.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Its effects at their best values on the segments that count.
    pub fit: LegsFit,
    /// Bias and noise from simulations at (nearly) these values.
    pub baseline: LegsBaseline,
    /// Σ of squares on the held-out segments.
    pub held: f64,
    /// −2 log likelihood there, but for a constant: Σ of squares plus, where joints rattle, the logarithm
    /// of the noise's determinant: a model that rattles more is not better for explaining less. Where
    /// joints stay loaded the noise is the sensors' under every model; what their determinants differ by
    /// is how well sixteen draws catch it, but for a swing that is not the recorded one.
    pub misfit: f64,
}

/// Which data count for the fits and which are held out, and what must not be found.
#[derive(Clone, Debug)]
pub struct FitData<'a> {
    /// Segments that values are fitted on.
    pub on: &'a [LegsSegment],
    /// Segments that candidates are judged on.
    pub hold: &'a [LegsSegment],
    /// Kinds of effects that are no candidates.
    pub without: &'a [&'a str],
}

impl FitData<'_> {
    fn segments(&self) -> Vec<LegsSegment> {
        [self.on, self.hold].concat()
    }
}

/// Fits the values of a model, simulating it anew each time: the lens's own fault depends on them.
/// What is known of a model that is `like` this one saves time.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn settle(
    case: &LegsCase,
    question: &FitData,
    effects: &[Setting],
    times: usize,
    like: Option<&LegsBaseline>,
) -> Result<Settled, SearchError> {
    settle_while(case, question, effects, times, like, |_, change| change > SETTLED)
}

/// The same of a model that is compared with others: simulated twice only where that may make it the better
/// one, as its misfit `promises`.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn compared(
    case: &LegsCase,
    question: &FitData,
    effects: &[Setting],
    like: Option<&LegsBaseline>,
    promises: impl Fn(&Settled) -> bool,
) -> Result<Settled, SearchError> {
    settle_while(case, question, effects, 2, like, |model, change| {
        change > NEARLY && promises(model)
    })
}

/// The same as long as the best model and the largest change of its values, in standard deviations, say.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn settle_while(
    case: &LegsCase,
    question: &FitData,
    effects: &[Setting],
    times: usize,
    like: Option<&LegsBaseline>,
    mut go_on: impl FnMut(&Settled, f64) -> bool,
) -> Result<Settled, SearchError> {
    let segments = question.segments();
    let mut effects = effects.to_vec();
    let mut settled: Option<Settled> = None;
    for _ in 0..times.max(1) {
        let same = settled.as_ref().map(|settled| Like::Same(&settled.baseline));
        let like = same.or(like.map(Like::Beside));
        let baseline = case.baseline(&effects, &segments, like)?;
        let target =
            LegsFitTarget { case, baseline: &baseline, on: question.on, fixed: &[], blind: None };
        let iterations = if effects.is_empty() { 0 } else { 6 };
        let Some(mut fit) = fit::fit(&target, &effects, iterations) else { break };
        if baseline.rattles {
            fit = fit::without_pull(&target, fit);
        } else {
            fit.jacobian = fit::jacobian(&target, &fit);
        }
        let held = LegsFitTarget { on: question.hold, ..target };
        let held = held.look(&fit.effects).map_or(f64::INFINITY, |fit| fit.chi2);
        let change = change(&effects, &fit);
        effects.clone_from(&fit.effects);
        let misfit = held + noisiness(case, question, &baseline);
        // Where joints rattle values never come to rest: each time the replicas' bias is another.
        let worse = |before: &Settled| baseline.rattles && before.misfit < misfit;
        if !settled.as_ref().is_some_and(worse) {
            settled = Some(Settled { fit, baseline, held, misfit });
        }
        if !settled.as_ref().is_some_and(|settled| go_on(settled, change)) {
            break;
        }
    }
    settled.ok_or_else(|| {
        case.rig.problem("effect", "gives a machine that cannot be", "other values").into()
    })
}

/// The model with values from whole simulations, where the joints stay loaded and it is nearly complete.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn refined(
    case: &LegsCase,
    question: &FitData,
    model: Settled,
) -> Result<Settled, SearchError> {
    let hopeless = HOPEFUL * model.baseline.places(case, question.hold).len() as f64;
    if model.baseline.rattles || model.fit.effects.is_empty() || model.held > hopeless {
        return Ok(model);
    }
    let starts = &model.baseline.starts;
    let effects = rough(case, question.on, &model.fit.effects, starts);
    let Some(effects) = effects else { return Ok(model) };
    // What the motion does not show, the lens does: how much play there is, from which the swing follows.
    let again = settle(case, question, &effects, 1, None)?;
    let starts = &again.baseline.starts;
    let fit = close(case, question.on, &again.fit.effects, starts);
    let Some(fit) = fit else { return Ok(model) };
    let baseline =
        case.baseline(&fit.effects, &question.segments(), Some(Like::Beside(&model.baseline)))?;
    let target =
        LegsFitTarget { case, baseline: &baseline, on: question.hold, fixed: &[], blind: None };
    let held = target.look(&fit.effects).map_or(f64::INFINITY, |fit| fit.chi2);
    let misfit = held + noisiness(case, question, &baseline);
    Ok(Settled { fit, baseline, held, misfit })
}

/// What a model pays for being noisy.
fn noisiness(case: &LegsCase, question: &FitData, baseline: &LegsBaseline) -> f64 {
    let own = if case.chaotic { baseline.log_determinant(question.hold) } else { 0.0 };
    own + baseline.lost(question.hold)
}

/// Largest change of a value by a fit, in its standard deviations, each by itself.
fn change(before: &[Setting], fit: &LegsFit) -> f64 {
    let (before, after) = (values(before), values(&fit.effects));
    let Some(jacobian) = &fit.jacobian else { return 0.0 };
    let columns = jacobian.column_iter().map(|column| column.norm());
    let moved = before.iter().zip(&after).zip(columns).map(|((b, a), size)| (a - b).abs() * size);
    moved.fold(0.0, f64::max)
}

/// The model with simpler variants of its effects where they do as well: fewer values that explain the
/// held-out data up to what the values may bring.
pub fn simplified(case: &LegsCase, question: &FitData, model: Settled) -> Settled {
    let mut best = model;
    for i in 0..best.fit.effects.len() {
        let effect = best.fit.effects[i].clone();
        let mut variants: Vec<_> = effect.kind.variants.to_vec();
        variants.sort_by_key(|names| names.len());
        for names in variants.iter().filter(|names| names.len() < effect.values().count()) {
            let values: Vec<(&'static str, f64)> =
                names.iter().map(|name| (*name, effect.value(name).unwrap_or(0.0))).collect();
            let simpler = Setting::on(effect.kind, effect.target.clone(), &values);
            let mut effects = best.fit.effects.clone();
            effects[i] = simpler;
            let baseline = best.baseline.clone();
            let on = LegsFitTarget {
                case,
                baseline: &baseline,
                on: question.on,
                fixed: &[],
                blind: None,
            };
            let held = LegsFitTarget { on: question.hold, ..on };
            let rattles = baseline.rattles;
            let Some(fit) = fit::fit(&on, &effects, 8) else { continue };
            let fit = if rattles { fit::without_pull(&on, fit) } else { fit };
            let white = match rattles {
                // The data's rattle speaks for the variant that was fitted to it.
                true => changed(&held, &best.fit.effects, &fit.effects),
                false => held.look(&fit.effects).map(|there| there.white),
            };
            let Some(held) = white.map(|white| white.norm_squared()) else { continue };
            let fewer = (effect.values().count() - names.len()) as f64;
            if held - best.held < 2.0 * GAIN_PER_VALUE * fewer + 4.0 {
                let jacobian = if rattles { fit.jacobian } else { fit::jacobian(&on, &fit) };
                let misfit = best.misfit + held - best.held;
                best = Settled { fit: LegsFit { jacobian, ..fit }, held, misfit, ..best };
                break;
            }
        }
    }
    best
}
