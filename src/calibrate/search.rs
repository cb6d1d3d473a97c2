//! One effect after another, until what is left of the residual is noise.

use super::candidates;
use super::fit::{self, Fit, Target};
use super::model::{Baseline, Case, Segment};
use crate::effects::Setting;
use crate::engine::Halt;
use crate::scenario::Problem;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Drop of Σ of squares on data not used for the fit that an effect has to bring, with loaded joints and
/// with joints that rattle, and how much more for each of its values. Twice the logarithm of the number
/// of candidates, some 150 with their frequencies, is 10; where joints rattle, bias and noise come from
/// a few replicas, and two sets of them differ by some tens. An effect three times as large as what
/// hides it brings a thousand and more.
const GAIN: [f64; 2] = [40.0, 100.0];
const GAIN_PER_VALUE: f64 = 2.0;

/// Rivals that are simulated, and the share of the best one's gain that makes a rival.
const RIVALS: usize = 6;
const RIVAL_SHARE: f64 = 0.6;

/// Simulations after which values have settled, at most, and the change of a value, in its standard
/// deviations, that is no change.
const SETTLES: usize = 7;
const SETTLED: f64 = 0.3;

/// Most effects that are added.
const EFFECTS: usize = 4;

/// Why a search cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum SearchError {
    /// The rig cannot be simulated as declared.
    #[error("{0}")]
    Model(#[from] Problem),
    /// A simulation broke down.
    #[error("{0}")]
    Halted(#[from] Halt),
}

/// A candidate and what it brings on data not used for its fit.
#[derive(Clone, Debug)]
pub struct Scored {
    /// The candidate at its best values.
    pub effect: Setting,
    /// Drop of Σ of squares on the held-out segments, less what its number of values may bring.
    pub gain: f64,
    /// Share of the excess above noise that it removes there, 0…1.
    pub share: f64,
    /// Whether it was simulated, rather than looked at through the lens alone.
    pub simulated: bool,
}

/// One round of the search.
#[derive(Clone, Debug)]
pub struct Round {
    /// Candidates, the best first.
    pub ranking: Vec<Scored>,
    /// What was added, if anything was worth it.
    pub added: Option<Setting>,
}

/// A model that simulations of itself have been held against.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Its effects at their best values on the segments that count.
    pub fit: Fit,
    /// Bias and noise from simulations at (nearly) these values.
    pub baseline: Baseline,
    /// Σ of squares on the held-out segments.
    pub held: f64,
    /// −2 log likelihood there, but for a constant: Σ of squares plus the logarithm of the noise's
    /// determinant. A model that rattles more is not better for explaining less.
    pub misfit: f64,
    /// How often it was simulated.
    pub times: usize,
}

/// What a search found.
#[derive(Debug)]
pub struct Found {
    /// The model in the end.
    pub model: Settled,
    /// The model as declared.
    pub declared: Settled,
    /// Round by round.
    pub rounds: Vec<Round>,
    /// Simulations it took.
    pub simulations: usize,
}

/// Which data count for the fits and which are held out, and what must not be found.
#[derive(Clone, Debug)]
pub struct Question<'a> {
    /// Segments that values are fitted on.
    pub on: &'a [Segment],
    /// Segments that candidates are judged on.
    pub hold: &'a [Segment],
    /// Kinds of effects that are no candidates.
    pub without: &'a [&'a str],
}

impl Question<'_> {
    fn segments(&self) -> Vec<Segment> {
        [self.on, self.hold].concat()
    }
}

/// Fits the values of a model, simulating it anew each time: the lens's own fault depends on them.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn settle(
    case: &Case,
    question: &Question,
    effects: &[Setting],
    times: usize,
) -> Result<Settled, SearchError> {
    let segments = question.segments();
    let mut effects = effects.to_vec();
    let mut settled = None;
    for time in 1..=times.max(1) {
        let machines = case.machines(&effects)?;
        let logs = case.simulate(&machines, true)?;
        let baseline = case.baseline(&machines, &logs, &segments);
        let target = Target { case, baseline: &baseline, on: question.on, fixed: &[], blind: None };
        let iterations = if effects.is_empty() { 0 } else { 6 };
        let Some(mut fit) = fit::fit(&target, &effects, iterations) else { break };
        fit.jacobian = fit::jacobian(&target, &fit);
        let held = Target { on: question.hold, ..target };
        let held = held.look(&fit.effects).map_or(f64::INFINITY, |fit| fit.chi2);
        let change = change(&effects, &fit);
        effects.clone_from(&fit.effects);
        let misfit = held + baseline.log_determinant(question.hold);
        settled = Some(Settled { fit, baseline, held, misfit, times: time });
        if change < SETTLED {
            break;
        }
    }
    settled.ok_or_else(|| {
        case.rig.problem("effect", "gives a machine that cannot be", "other values").into()
    })
}

/// Largest change of a value by a fit, in its standard deviations, each by itself.
fn change(before: &[Setting], fit: &Fit) -> f64 {
    let (before, after) = (fit::values(before), fit::values(&fit.effects));
    let Some(jacobian) = &fit.jacobian else { return 0.0 };
    let columns = jacobian.column_iter().map(|column| column.norm());
    let moved = before.iter().zip(&after).zip(columns).map(|((b, a), size)| (a - b).abs() * size);
    moved.fold(0.0, f64::max)
}

/// The model with simpler variants of its effects where they do as well: fewer values that explain the
/// held-out data up to what the values may bring.
fn simplified(case: &Case, question: &Question, model: Settled) -> Settled {
    let mut best = model;
    for i in 0..best.fit.effects.len() {
        let effect = best.fit.effects[i].clone();
        let mut variants: Vec<_> = effect.kind.variants.to_vec();
        variants.sort_by_key(|names| names.len());
        for names in variants.iter().filter(|names| names.len() < effect.values().count()) {
            let values: Vec<(&'static str, f64)> =
                names.iter().map(|name| (*name, effect.value(name).unwrap_or(0.0))).collect();
            let simpler = Setting::new(effect.kind, effect.joint.as_deref(), &values);
            let mut effects = best.fit.effects.clone();
            effects[i] = simpler;
            let baseline = best.baseline.clone();
            let on = Target { case, baseline: &baseline, on: question.on, fixed: &[], blind: None };
            let Some(mut fit) = fit::fit(&on, &effects, 8) else { continue };
            let Some(held) = (Target { on: question.hold, ..on }).look(&fit.effects) else {
                continue;
            };
            let fewer = (effect.values().count() - names.len()) as f64;
            if held.chi2 - best.held < 2.0 * GAIN_PER_VALUE * fewer + 4.0 {
                fit.jacobian = fit::jacobian(&on, &fit);
                let misfit = best.misfit + held.chi2 - best.held;
                best = Settled { fit, held: held.chi2, misfit, ..best };
                break;
            }
        }
    }
    best
}

/// Searches for what the declared model lacks; `tell` hears what is being tried.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn search(
    case: &Case,
    question: &Question,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Found, SearchError> {
    tell("simulating the model as declared");
    let mut simulations = case.runs.len() * case.replicas;
    let mut model = settle(case, question, &[], 1)?;
    let declared = model.clone();
    let mut rounds = Vec::new();
    while model.fit.effects.len() < EFFECTS {
        tell(&format!("trying every effect beside {}", names(&model.fit.effects)));
        let mut ranking = screen(case, question, &model);
        let best = ranking.first().map_or(0.0, |(scored, _)| scored.gain);
        let threshold = GAIN[usize::from(case.chaotic)];
        let rivals: Vec<usize> = (0..ranking.len())
            .filter(|&i| {
                let (scored, _) = &ranking[i];
                scored.gain > threshold && scored.gain > RIVAL_SHARE * best
            })
            .take(RIVALS)
            .collect();
        let mut winner: Option<(usize, Settled)> = None;
        for &i in &rivals {
            let (scored, effects) = &ranking[i];
            tell(&format!("simulating with {}", name(&scored.effect)));
            let Ok(settled) = settle(case, question, effects, 2) else { continue };
            simulations += settled.times * case.runs.len() * case.replicas;
            let values = scored.effect.values().count() as f64;
            let (scored, _) = &mut ranking[i];
            let drop = model.misfit - settled.misfit;
            scored.gain = drop - GAIN_PER_VALUE * values;
            scored.share = share(model.held, model.held - drop, case, question, &settled.baseline);
            scored.simulated = true;
            if let Some(own) = settled.fit.effects.last() {
                scored.effect = own.clone();
            }
            let best = winner.as_ref().map_or(f64::NEG_INFINITY, |(w, _)| ranking[*w].0.gain);
            if ranking[i].0.gain > best {
                winner = Some((i, settled));
            }
        }
        let winner = winner.filter(|(i, _)| ranking[*i].0.gain > threshold);
        let added = winner.as_ref().map(|(i, _)| ranking[*i].0.effect.clone());
        let mut ranking: Vec<Scored> = ranking.into_iter().map(|(scored, _)| scored).collect();
        ranking.sort_by(|a, b| {
            (b.simulated, b.gain)
                .partial_cmp(&(a.simulated, a.gain))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        rounds.push(Round { ranking, added });
        let Some((_, settled)) = winner else { break };
        tell(&format!("settling {}", names(&settled.fit.effects)));
        model = settle(case, question, &settled.fit.effects, SETTLES)?;
        simulations += model.times * case.runs.len() * case.replicas;
        model = simplified(case, question, model);
    }
    Ok(Found { model, declared, rounds, simulations })
}

/// Share of what is above noise that is gone.
fn share(before: f64, after: f64, case: &Case, question: &Question, baseline: &Baseline) -> f64 {
    let noise = baseline.places(case, question.hold).len() as f64;
    let excess = (before - noise).max(1.0);
    ((before - after) / excess).clamp(0.0, 1.0)
}

/// All candidates through the lens alone: fitted on some data, scored on others, the best first, each
/// with the model that it makes.
fn screen(case: &Case, question: &Question, model: &Settled) -> Vec<(Scored, Vec<Setting>)> {
    let baseline = &model.baseline;
    let target = Target { case, baseline, on: question.on, fixed: &[], blind: None };
    let Ok(machine) = case.runs[0].machine(&case.rig, &[]) else { return Vec::new() };
    let candidates = candidates::all(&machine, question.without);
    // What the values of the present effects could make good: the same for nearly every candidate.
    let Some(present) = without_values(&target, &model.fit.effects) else { return Vec::new() };
    let mut scored: Vec<(Scored, Vec<Setting>)> =
        candidates
            .par_iter()
            .filter_map(|candidate| {
                // A fuller variant of an effect that the model has takes its place.
                let same = |effect: &Setting| {
                    effect.kind.name == candidate.kind.name && effect.joint == candidate.joint
                };
                if model.fit.effects.iter().any(|effect| {
                    same(effect) && effect.values().count() >= candidate.values().count()
                }) {
                    return None;
                }
                let others: Vec<Setting> =
                    model.fit.effects.iter().filter(|effect| !same(effect)).cloned().collect();
                let replaced = others.len() < model.fit.effects.len();
                let fewer = if replaced { Some(without_values(&target, &others)?) } else { None };
                let blind = fewer.as_ref().unwrap_or(&present);
                let own = Target { fixed: &others, blind: blind.as_ref(), ..target };
                let plain = own.look(&[])?;
                let tuned = candidates::tune(&own, &plain, candidate)?;
                let mut effects = [others, tuned.effects.clone()].concat();
                // All values together, where it is worth the time.
                if plain.chi2 - tuned.chi2 > 0.5 * GAIN[0] && effects.len() > 1 {
                    effects = fit::fit(&target, &effects, 3)?.effects;
                }
                let held = Target { on: question.hold, ..target }.look(&effects)?.chi2;
                let effect = effects.last()?.clone();
                let gain = model.held - held - GAIN_PER_VALUE * effect.values().count() as f64;
                let share = share(model.held, held, case, question, baseline);
                Some((Scored { effect, gain, share, simulated: false }, effects))
            })
            .collect();
    scored.sort_by(|a, b| b.0.gain.total_cmp(&a.0.gain));
    scored
}

/// Orthonormal directions of the residual that the values of `effects` could make good, none without
/// effects; or nothing where the machine cannot be.
fn without_values(target: &Target, effects: &[Setting]) -> Option<Option<DMatrix<f64>>> {
    if effects.is_empty() {
        return Some(None);
    }
    let bare = target.look(effects)?;
    Some(fit::jacobian(target, &bare).map(|jacobian| jacobian.qr().q()))
}

/// An effect in words: `joint-wear at A2`.
pub fn name(effect: &Setting) -> String {
    match &effect.joint {
        Some(joint) => format!("{} at {joint}", effect.kind.name),
        None => effect.kind.name.to_owned(),
    }
}

/// Effects in words.
pub fn names(effects: &[Setting]) -> String {
    if effects.is_empty() {
        return "the model as declared".to_owned();
    }
    effects.iter().map(name).collect::<Vec<_>>().join(", ")
}
