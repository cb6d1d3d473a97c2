//! One effect after another, until what is left is noise; several hypotheses at once, for the first of two
//! effects is often mistaken for a rival that also takes up a part of the second.

use super::baseline::Baseline;
use super::candidates::starts;
use super::fit::{Fit, Target};
use super::problem::{Problem, Split, Stopped};
use super::residual::{Kind, Name};
use super::thresholds::{
    BUDGET, CLOSER, EFFECTS, GAIN, GAIN_PER_VALUE, HYPOTHESES, LARGEST, MOSTLY, NOISE, PROMISING,
    SIMULATED, TWINS,
};
use super::trajectory::fitted;
use crate::effects::{Joints, Setting, Targets};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::Serialize;

/// A model that simulations of itself have been held against.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its effects at their best values.
    pub fit: Fit,
    /// Bias and noise from simulations at (nearly) these values.
    pub baseline: Baseline,
    /// Σ of squares on the data that candidates are judged on.
    pub held: f64,
    /// −2 log likelihood there, but for a constant.
    pub misfit: f64,
}

impl Model {
    /// What the model costs: its misfit and the price of its values.
    pub fn cost(&self) -> f64 {
        let values: usize = self.fit.effects.iter().map(|effect| effect.values().count()).sum();
        self.misfit + GAIN_PER_VALUE * values as f64
    }
}

/// How much of a residual stands above noise, on data that candidates are judged on.
#[derive(Clone, Debug, Serialize)]
pub struct Left {
    /// Which residual.
    pub residual: Kind,
    /// Of which joint or column.
    pub of: String,
    /// Mean square in units of noise: 1 for noise.
    pub mean_square: f64,
    /// Its largest coefficient in units of noise.
    pub largest: f64,
}

/// A candidate of a round.
#[derive(Clone, Debug)]
pub struct Tried {
    /// The effect with the values that fitted.
    pub effect: Setting,
    /// Drop of Σ of squares on data not used for its fit.
    pub gain: f64,
    /// Share of what was there that this is.
    pub share: f64,
    /// Whether the machine was simulated with it.
    pub simulated: bool,
}

/// One round of a search.
#[derive(Clone, Debug, Default)]
pub struct Round {
    /// Candidates, the best first.
    pub tried: Vec<Tried>,
    /// What was added.
    pub added: Option<Setting>,
    /// What was as good.
    pub as_good: Vec<Setting>,
}

/// What a search found.
#[derive(Debug)]
pub struct Found {
    /// The best model.
    pub best: Model,
    /// The model as declared.
    pub declared: Model,
    /// Round by round.
    pub rounds: Vec<Round>,
}

/// What is searched in.
pub struct Search<'a> {
    /// The rig and its runs.
    pub problem: &'a Problem,
    /// Which data count for what.
    pub split: &'a Split,
    /// Effects at their neutral values.
    pub candidates: Vec<Setting>,
    /// Names of the residuals.
    pub names: Vec<Name>,
    /// Hears what is being tried.
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// A change of a value, in its standard deviations, that is none.
const SETTLED: f64 = 0.3;

/// How far from its neutral value an effect that only simulations show is tried, in steps of its parameters: a
/// joint's clearance of 0.05 mm more.
const AWAY: f64 = 10.0;

impl Search<'_> {
    pub(super) fn target<'b>(&'b self, baseline: &'b Baseline, held: bool) -> Target<'b> {
        let on = if held { &self.split.hold } else { &self.split.on };
        Target { problem: self.problem, baseline, on }
    }

    /// Fits the values of a model, simulating it anew each time: what a look is wrong by depends on them.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn settle(&self, effects: &[Setting], times: usize) -> Result<Option<Model>, Stopped> {
        let segments = [self.split.on.as_slice(), &self.split.hold].concat();
        let mut effects = effects.to_vec();
        let mut settled: Option<Model> = None;
        for _ in 0..times.max(1) {
            let deviations = settled.as_ref().map(|model| model.fit.deviations());
            let deviations = deviations.unwrap_or_default();
            let baseline = match Baseline::of(self.problem, &effects, &deviations, &segments) {
                Ok(baseline) => baseline,
                // What cannot be simulated is no model; what was so far may be one.
                Err(_) if !effects.is_empty() => break,
                Err(stopped) => return Err(stopped),
            };
            let steps = if effects.is_empty() { 0 } else { 6 };
            let target = self.target(&baseline, false);
            let Some(mut fit) = target.fit(&effects, steps) else { break };
            fit.jacobian = target.jacobian(&fit);
            let Some(held) = self.target(&baseline, true).look(&fit.effects) else { break };
            let change = change(&effects, &fit);
            effects.clone_from(&fit.effects);
            let own = match baseline.rattles {
                true => baseline.log_determinant(&self.split.hold),
                false => 0.0,
            };
            let noise = own + baseline.lost(&self.split.hold);
            let (rattles, known) = (baseline.rattles, !deviations.is_empty());
            let model = Model { fit, held: held.chi2, misfit: held.chi2 + noise, baseline };
            let worse = settled
                .as_ref()
                .is_some_and(|before| model.baseline.rattles && before.misfit < model.misfit);
            if !worse {
                settled = Some(model);
            }
            // Where joints rattle the second pass knows how far values may be off.
            if change < SETTLED && (!rattles || known) {
                break;
            }
        }
        Ok(settled)
    }

    /// What is left of a model's residuals on data that candidates are judged on.
    pub fn left(&self, model: &Model) -> Vec<Left> {
        let target = self.target(&model.baseline, true);
        let Some(held) = target.look(&model.fit.effects) else { return Vec::new() };
        let places = model.baseline.places(self.problem, &self.split.hold);
        let of = |(k, name): (usize, &Name)| {
            let own = held.white.iter().zip(&places).filter(|(_, (c, _))| *c == k);
            let (mut sum, mut count, mut largest) = (0.0, 0.0, 0.0f64);
            for (value, _) in own {
                sum += value * value;
                count += 1.0;
                largest = largest.max(value.abs());
            }
            let mean_square = sum / f64::max(count, 1.0);
            Left { residual: name.kind, of: name.of.clone(), mean_square, largest }
        };
        self.names.iter().enumerate().map(of).collect()
    }

    /// The candidates beside a model that promise most on data not used for their fit, the best first.
    fn screened(&self, model: &Model) -> Vec<Tried> {
        let (on, hold) = (self.target(&model.baseline, false), self.target(&model.baseline, true));
        let Some(held) = hold.look(&model.fit.effects) else { return Vec::new() };
        let own = model.fit.effects.len();
        let fresh = |candidate: &&Setting| !model.fit.effects.iter().any(|e| e.is(candidate));
        let fresh: Vec<&Setting> = self.candidates.iter().filter(fresh).collect();
        // What the values of the model could make good is no candidate's merit.
        let jacobians = [&on, &hold].map(|target| {
            let fit = target.look(&model.fit.effects)?;
            target.jacobian(&fit)
        });
        let linear = |candidate: &&Setting| {
            starts(&on, &model.fit, candidate)
                .into_iter()
                .filter_map(|start| self.linear(&on, &hold, model, &jacobians, start))
                .map(|(effect, left)| {
                    let gain = held.chi2 - left;
                    let share = (gain / held.chi2).clamp(0.0, 1.0);
                    Tried { effect, gain, share, simulated: false }
                })
                .max_by(|a, b| a.gain.total_cmp(&b.gain))
        };
        let mut tried: Vec<Tried> =
            fresh.par_iter().filter_map(linear).filter(|tried| tried.gain.is_finite()).collect();
        tried.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let closer: Vec<Tried> = tried
            .iter()
            .take(CLOSER)
            .collect::<Vec<_>>()
            .par_iter()
            .filter_map(|near| {
                let start =
                    [model.fit.effects.as_slice(), std::slice::from_ref(&near.effect)].concat();
                let fit = on.fit(&start, 8)?;
                let there = hold.look(&fit.effects)?;
                let gain = held.chi2 - there.chi2;
                let share = (gain / held.chi2).clamp(0.0, 1.0);
                Some(Tried { effect: fit.effects[own].clone(), gain, share, simulated: false })
            })
            .collect();
        for better in closer {
            if let Some(known) = tried.iter_mut().find(|t| {
                t.effect.is(&better.effect)
                    && t.effect.values().map(|(n, _)| n).eq(better.effect.values().map(|(n, _)| n))
            }) {
                *known = better;
            }
        }
        let price = |tried: &Tried| GAIN_PER_VALUE * tried.effect.values().count() as f64;
        tried.sort_by(|a, b| (b.gain - price(b)).total_cmp(&(a.gain - price(a))));
        tried
    }

    /// A candidate's values by one linear step from where it starts, and what they leave on the data that
    /// candidates are judged on; none where there is no such machine.
    fn linear(
        &self,
        on: &Target,
        hold: &Target,
        model: &Model,
        jacobians: &[Option<DMatrix<f64>>; 2],
        start: Setting,
    ) -> Option<(Setting, f64)> {
        let own: Vec<f64> = start.values().map(|(_, value)| value).collect();
        let free = crate::calibrate::fit::free(std::slice::from_ref(&start));
        let look = |target: &Target, values: &[f64]| {
            let effects = [model.fit.effects.as_slice(), &[start.with(values)]].concat();
            target.look(&effects).map(|fit| fit.white)
        };
        let columns = |target: &Target, base: &DVector<f64>, known: &Option<DMatrix<f64>>| {
            let mut columns: Vec<DVector<f64>> =
                known.iter().flat_map(|j| j.column_iter().map(|c| c.into_owned())).collect();
            for (i, free) in free.iter().enumerate() {
                let mut beside = own.clone();
                let back = own[i] + free.step > free.bounds[1];
                let step = if back { -free.step } else { free.step };
                beside[i] += step;
                columns.push((look(target, &beside)? - base) / step);
            }
            Some(DMatrix::from_columns(&columns))
        };
        let base = look(on, &own)?;
        let matrix = columns(on, &base, &jacobians[0])?;
        let known = matrix.ncols() - own.len();
        let mut held: Vec<bool> = vec![false; own.len()];
        // Values that a bound holds stay there, and the others are solved for again.
        let mut step = DVector::zeros(matrix.ncols());
        for _ in 0..=own.len() {
            let moving: Vec<usize> =
                (0..matrix.ncols()).filter(|&c| c < known || !held[c - known]).collect();
            let part = matrix.select_columns(&moving);
            let scales: Vec<f64> =
                part.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE)).collect();
            let unit =
                DMatrix::from_fn(part.nrows(), part.ncols(), |r, c| part[(r, c)] / scales[c]);
            let mut normal = unit.transpose() * &unit;
            for k in 0..normal.nrows() {
                normal[(k, k)] += 1e-9;
            }
            let solved = normal.cholesky()?.solve(&-(unit.transpose() * &base));
            step.fill(0.0);
            for (k, &c) in moving.iter().enumerate() {
                step[c] = solved[k] / scales[k];
            }
            let leaving = (0..own.len()).find(|&k| {
                let [low, high] = free[k].bounds;
                !held[k] && !(low..=high).contains(&(own[k] + step[known + k]))
            });
            let Some(k) = leaving else { break };
            held[k] = true;
        }
        let base_held = look(hold, &own)?;
        let matrix = columns(hold, &base_held, &jacobians[1])?;
        let left = (base_held + matrix * &step).norm_squared();
        let values: Vec<f64> = own.iter().enumerate().map(|(k, v)| v + step[known + k]).collect();
        left.is_finite().then(|| (start.with(&values), left))
    }

    /// The best models with one effect more than this one has, simulated, the best first.
    fn beside(&self, model: &Model) -> Result<(Round, Vec<Model>), Stopped> {
        (self.tell)(&format!("trying every effect{}", beside(&model.fit.effects)));
        let mut tried = self.screened(model);
        let mut found: Vec<Model> = Vec::new();
        for candidate in tried.iter_mut() {
            if found.len() >= SIMULATED || candidate.gain < 0.5 * GAIN[0] {
                break;
            }
            // Variants of one effect are one hypothesis.
            let last =
                |model: &Model| model.fit.effects.last().is_some_and(|e| e.is(&candidate.effect));
            if found.iter().any(last) {
                continue;
            }
            let effects =
                [model.fit.effects.as_slice(), std::slice::from_ref(&candidate.effect)].concat();
            (self.tell)(&format!("simulating with {}", names(&effects)));
            if let Some(settled) = self.settle(&effects, 1)? {
                candidate.simulated = true;
                candidate.gain = model.cost() - settled.cost();
                found.push(settled);
            }
        }
        self.again(model, &mut found, &mut tried)?;
        found.retain(|rival| !rival.fit.effects.last().is_some_and(at_a_limit));
        // What residuals see is tried before what they hardly see.
        let seen =
            |tried: &Tried| tried.simulated && tried.gain > price(model) && tried.share > MOSTLY;
        let noise = |model: &Model| is_noise(&self.left(model));
        if !tried.iter().any(seen) && !found.iter().any(noise) {
            found.extend(self.unseen(model, &mut tried)?);
        }
        found.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        Ok((Round { tried, ..Round::default() }, found))
    }

    /// Simulates rivals again at the values that their first simulations led to, those that promise nearly as much
    /// as the best of them.
    fn again(
        &self,
        model: &Model,
        found: &mut [Model],
        tried: &mut [Tried],
    ) -> Result<(), Stopped> {
        let best = found.iter().map(Model::cost).fold(model.cost(), f64::min);
        let enough = model.cost() - PROMISING * (model.cost() - best);
        for rival in found.iter_mut().filter(|rival| rival.cost() <= enough) {
            let Some(settled) = self.settle(&rival.fit.effects, 1)? else { continue };
            if !settled.baseline.rattles || settled.misfit < rival.misfit {
                *rival = settled;
            }
            let last = rival.fit.effects.last();
            let own = |tried: &&mut Tried| {
                tried.simulated && last.is_some_and(|effect| effect.is(&tried.effect))
            };
            if let Some(tried) = tried.iter_mut().find(own) {
                tried.gain = model.cost() - rival.cost();
            }
        }
        Ok(())
    }

    /// The model with an effect that left nothing but noise beside another one, which may have been mistaken for
    /// an effect of this one.
    fn also(&self, model: &Model, effect: &Setting) -> Result<Vec<Model>, Stopped> {
        if model.fit.effects.iter().any(|own| own.is(effect)) {
            return Ok(Vec::new());
        }
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(effect)].concat();
        (self.tell)(&format!("simulating with {}", names(&effects)));
        Ok(self.settle(&effects, 2)?.into_iter().collect())
    }

    /// Models with one more effect of the joints' bearings, which residuals hardly see without a simulation: how
    /// bodies swing in their play shows them. Values are those of whole simulations.
    fn unseen(&self, model: &Model, tried: &mut [Tried]) -> Result<Vec<Model>, Stopped> {
        let mut found = Vec::new();
        if model.baseline.rattles {
            return Ok(found);
        }
        let of_bearings = |tried: &&mut Tried| {
            let targets = tried.effect.kind.targets;
            let bearing = [Targets::Joint, Targets::JointOrAll].map(|of| of(Joints::Bearing));
            bearing.contains(&targets) && tried.gain < GAIN[0]
        };
        for candidate in tried.iter_mut().filter(of_bearings) {
            if self.problem.simulations() > BUDGET {
                break;
            }
            let effects = [model.fit.effects.as_slice(), &[away(&candidate.effect)]].concat();
            (self.tell)(&format!("simulating with {}", names(&effects)));
            let Some(settled) = self.settle(&effects, 1)? else { continue };
            candidate.simulated = true;
            candidate.gain = model.cost() - settled.cost();
            if candidate.gain > GAIN[0] {
                found.push(self.refined(settled)?);
            }
        }
        Ok(found)
    }

    /// Searches for what the declared model lacks.
    ///
    /// # Errors
    /// A rig that cannot be simulated.
    pub fn run(&self) -> Result<Found, Stopped> {
        (self.tell)("simulating the model as declared");
        let declared = self.settle(&[], 1)?.ok_or_else(|| {
            let message = "cannot move as it was measured".to_owned();
            let help = "are these recordings of this machine?";
            Stopped::Model(self.problem.rig.problem("mechanism", message, help))
        })?;
        let mut best = declared.clone();
        let mut rounds = Vec::new();
        let mut hypotheses = vec![declared.clone()];
        while best.fit.effects.len() < EFFECTS
            && self.problem.simulations() < BUDGET
            && !is_noise(&self.left(&best))
        {
            let mut next: Vec<Model> = Vec::new();
            let mut round = Round::default();
            let mut enough: Option<Setting> = None;
            for (i, model) in hypotheses.iter().enumerate() {
                let (own, found) = match &enough {
                    _ if i > 0 && self.problem.simulations() > BUDGET => break,
                    Some(effect) => (Round::default(), self.also(model, effect)?),
                    None => self.beside(model)?,
                };
                if i == 0 {
                    round = own;
                }
                if enough.is_none() {
                    let last = found.iter().find(|model| is_noise(&self.left(model)));
                    enough = last.and_then(|model| model.fit.effects.last().cloned());
                }
                next.extend(found);
            }
            next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
            next.dedup_by(|a, b| same(&a.fit.effects, &b.fit.effects));
            let won = next.first().is_some_and(|first| first.cost() < best.cost() - price(&best));
            if !won {
                rounds.push(round);
                break;
            }
            let cost = next[0].cost();
            round.added = next[0].fit.effects.last().cloned();
            let near = next.iter().skip(1).filter(|model| model.cost() < cost + TWINS);
            round.as_good = near.filter_map(|model| model.fit.effects.last().cloned()).collect();
            rounds.push(round);
            let before = best.cost();
            best = next[0].clone();
            if !is_noise(&self.left(&best)) {
                best = self.refined(best)?;
                next[0] = best.clone();
            }
            // Of what explains nearly as much something else may come out in the end.
            next.retain(|model| before - model.cost() > 0.7 * (before - cost));
            next.truncate(HYPOTHESES);
            hypotheses = next;
        }
        // What is noise already is not explained any better; that recorded joints rattle less than a model's does
        // not show in what is left, only in its size.
        while best.baseline.rattles
            && best.fit.effects.len() < EFFECTS
            && is_noise(&self.left(&best))
        {
            let (round, calmer) = self.calmer(&best)?;
            rounds.push(round);
            let Some(calmer) = calmer else { break };
            best = calmer;
        }
        if !best.fit.effects.is_empty() {
            // Values that leave noise are left alone: looks alone do not find them as well again.
            if !is_noise(&self.left(&best)) {
                (self.tell)(&format!("settling {}", names(&best.fit.effects)));
                let settled = self.settle(&best.fit.effects, 4)?;
                best = settled.filter(|model| model.misfit < best.misfit).unwrap_or(best);
            }
            best = self.simplified(best)?;
            best = self.needed(best)?;
            if !is_noise(&self.left(&best)) {
                best = self.refined(best)?;
            }
        }
        credited(&mut rounds, &best.fit.effects);
        Ok(Found { best, declared, rounds })
    }

    /// The model with values from whole simulations, where joints do not rattle and that is better.
    fn refined(&self, model: Model) -> Result<Model, Stopped> {
        if model.baseline.rattles || model.fit.effects.is_empty() {
            return Ok(model);
        }
        (self.tell)(&format!("fitting whole simulations with {}", names(&model.fit.effects)));
        let effects = fitted(self.problem, &model.fit.effects, &self.split.on)?;
        let segments = [self.split.on.as_slice(), &self.split.hold].concat();
        let baseline = Baseline::of(self.problem, &effects, &[], &segments)?;
        let on = self.target(&baseline, false);
        let Some(mut fit) = on.look(&effects) else { return Ok(model) };
        fit.jacobian = on.jacobian(&fit);
        let Some(held) = self.target(&baseline, true).look(&effects) else { return Ok(model) };
        let misfit = held.chi2 + baseline.lost(&self.split.hold);
        let refined = Model { fit, held: held.chi2, misfit, baseline };
        Ok(if refined.misfit < model.misfit { refined } else { model })
    }

    /// The model without effects that it does not need.
    fn needed(&self, mut model: Model) -> Result<Model, Stopped> {
        let mut i = 0;
        while model.fit.effects.len() > 1 && i < model.fit.effects.len() {
            let mut fewer = model.fit.effects.clone();
            let dropped = fewer.remove(i);
            (self.tell)(&format!("simulating without {}", name(&dropped)));
            match self.settle(&fewer, 2)? {
                Some(simpler) if simpler.cost() < model.cost() + price(&model) => model = simpler,
                _ => i += 1,
            }
        }
        Ok(model)
    }
}

/// Whether a value of an effect lies at the end of what makes sense, where the effect is not its neutral self: it
/// imitates another one.
fn at_a_limit(effect: &Setting) -> bool {
    let phase = effect.kind.scan.map(|scan| scan.phase);
    effect.values().any(|(name, value)| {
        let Some(parameter) = effect.kind.parameter(name) else { return false };
        let near = |bound: f64| (value - bound).abs() < parameter.step;
        let ends = parameter.bounds.into_iter().filter(|bound| *bound != 0.0);
        Some(name) != phase && ends.into_iter().any(near)
    })
}

/// Drop of cost that one more effect has to bring.
fn price(model: &Model) -> f64 {
    GAIN[usize::from(model.baseline.rattles)]
}

/// An effect some way from its values, for what only simulations show.
pub(super) fn away(effect: &Setting) -> Setting {
    let values = effect.values().map(|(name, value)| {
        let parameter = effect.kind.parameter(name);
        parameter.map_or(value, |p| (value + AWAY * p.step).clamp(p.bounds[0], p.bounds[1]))
    });
    effect.with(&values.collect::<Vec<_>>())
}

/// Gives each effect that was kept the round in which it was tried first, where another hypothesis was the better
/// one at that time.
fn credited(rounds: &mut [Round], kept: &[Setting]) {
    let added = |rounds: &[Round], effect: &Setting| {
        rounds.iter().any(|round| round.added.as_ref().is_some_and(|added| added.is(effect)))
    };
    for effect in kept {
        if added(rounds, effect) {
            continue;
        }
        let free = |round: &&mut Round| {
            let own = |added: &Setting| kept.iter().any(|kept| kept.is(added));
            let tried = round.tried.iter().any(|tried| tried.effect.is(effect));
            tried && !round.added.as_ref().is_some_and(own)
        };
        if let Some(round) = rounds.iter_mut().find(free) {
            round.added = Some(effect.clone());
        }
    }
}

/// Whether residuals are noise. What cannot be looked at is not.
pub fn is_noise(left: &[Left]) -> bool {
    let within = |left: &Left| left.mean_square < NOISE && left.largest < LARGEST;
    !left.is_empty() && left.iter().all(within)
}

/// Largest change of a value by a fit, in its standard deviations, each by itself.
fn change(before: &[Setting], fit: &Fit) -> f64 {
    use crate::calibrate::fit::values;
    let Some(jacobian) = &fit.jacobian else { return 0.0 };
    let sizes = jacobian.column_iter().map(|column| column.norm());
    let pairs = values(before).into_iter().zip(values(&fit.effects)).zip(sizes);
    pairs.map(|((before, after), size)| (after - before).abs() * size).fold(0.0, f64::max)
}

fn same(a: &[Setting], b: &[Setting]) -> bool {
    a.len() == b.len() && a.iter().all(|a| b.iter().any(|b| a.is(b)))
}

/// An effect in words: its name, and where it is.
pub fn name(effect: &Setting) -> String {
    effect.to_string()
}

/// Effects in words.
pub fn names(effects: &[Setting]) -> String {
    effects.iter().map(name).collect::<Vec<_>>().join(" and ")
}

fn beside(effects: &[Setting]) -> String {
    if effects.is_empty() { String::new() } else { format!(" beside {}", names(effects)) }
}
