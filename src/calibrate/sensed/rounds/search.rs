//! One effect after another, until what is left is noise; several hypotheses at once, for the first of two
//! effects is often mistaken for a rival that also takes up a part of the second.

use super::rest::Rest;
use super::round::{Round, SeenBeside, Tried};
use super::words::names;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Split, Stopped};
use crate::calibrate::sensed::residuals::residual::Name;
use crate::calibrate::sensed::thresholds::{
    BUDGET, EFFECTS, HYPOTHESES, MOSTLY, NEAR, NOISE, TWINS,
};
use crate::calibrate::sensed::values::fit::FitTarget;
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::trajectory::Far;
use crate::effects::Setting;

/// What a search found.
#[derive(Debug)]
pub struct Found {
    /// The best model.
    pub best: Model,
    /// The model as declared.
    pub declared: Model,
    /// Round by round.
    pub rounds: Vec<Round>,
    /// What still stands out of what the best model leaves, however little that is.
    pub rest: Option<Rest>,
    /// Whether it stopped at a model whose joints lift off, and those of the declared one do not: several simulations
    /// of each model go further.
    pub lifts_off: bool,
}

/// What is searched in.
pub struct Search<'a> {
    /// The rig and its runs.
    pub problem: &'a RigProblem,
    /// Which data count for what.
    pub split: &'a Split,
    /// Effects at their neutral values.
    pub candidates: &'a [Setting],
    /// Names of the residuals.
    pub names: Vec<Name>,
    /// Hears what is being tried.
    pub tell: &'a (dyn Fn(&str) + Sync),
    /// Simulations of whole runs before it began.
    before: u64,
}

impl<'a> Search<'a> {
    /// A search in a problem, and who hears what is being tried.
    pub fn new(
        problem: &'a RigProblem,
        split: &'a Split,
        candidates: &'a [Setting],
        tell: &'a (dyn Fn(&str) + Sync),
    ) -> Self {
        let names = problem.names().unwrap_or_default();
        Self { problem, split, candidates, names, tell, before: problem.whole_runs() }
    }

    /// Whether it has taken as many simulations as it may.
    pub(super) fn is_spent(&self) -> bool {
        self.problem.whole_runs() - self.before >= BUDGET || self.problem.is_worn_out()
    }

    pub(in crate::calibrate::sensed) fn target<'b>(
        &'b self,
        baseline: &'b Baseline,
        held: bool,
    ) -> FitTarget<'b> {
        let on = if held { &self.split.hold } else { &self.split.on };
        FitTarget { problem: self.problem, baseline, on }
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
        // What is no larger than noise as a whole may still be an effect that stands out of it.
        let mut lacks = !self.is_noise(&best) || !self.standing_out(&best).is_empty();
        while best.fit.effects.len() < EFFECTS && !self.is_spent() && lacks {
            let NextRound { mut round, mut next, lifts_off } = self.beside_all(&hypotheses)?;
            let won = |next: &[Model]| {
                next.first().is_some_and(|first| first.cost() < best.cost() - price(&best))
            };
            if !won(&next) {
                next = self.over_all(&best, &mut round.tried)?;
            }
            if !won(&next) {
                rounds.push(round);
                break;
            }
            // Of what explains nearly as much something else may come out in the end.
            let (before, cost) = (best.cost(), next[0].cost());
            let near =
                next.into_iter().filter(|model| before - model.cost() > NEAR * (before - cost));
            hypotheses = self.all_refined(near.take(HYPOTHESES).collect(), before)?;
            best = hypotheses[0].clone();
            round.added = best.fit.effects.last().cloned();
            let enough = best.cost() + TWINS[usize::from(best.baseline.rattles)];
            let as_good = hypotheses[1..].iter().filter(|model| model.cost() < enough);
            round.as_good = as_good.filter_map(|model| model.fit.effects.last().cloned()).collect();
            rounds.push(round);
            if lifts_off {
                return Ok(Found { best, declared, rounds, rest: None, lifts_off });
            }
            lacks = !self.is_noise(&best);
        }
        // What is noise already is not explained any better; that recorded joints rattle less than a model's does
        // not show in what is left, only in its size.
        while best.baseline.rattles && best.fit.effects.len() < EFFECTS && self.is_noise(&best) {
            let (round, calmer) = self.calmer(&best)?;
            rounds.push(round);
            let Some(calmer) = calmer else { break };
            best = calmer;
        }
        let (best, rest) = self.borne_out(best, &mut rounds)?;
        Ok(Found { best, declared, rounds, rest, lifts_off: false })
    }

    /// Hypotheses with values from whole simulations, one after another until one leaves no more than noise, and the best of them, where
    /// it takes most of what was there `before` and leaves more, with others; the best first.
    fn all_refined(&self, mut hypotheses: Vec<Model>, before: f64) -> Result<Vec<Model>, Stopped> {
        for (i, model) in hypotheses.iter_mut().enumerate() {
            if i > 0 && self.problem.is_worn_out() {
                break;
            }
            if !self.is_noise(model) {
                *model = self.refined(model.clone(), Far::Promising)?;
            }
            if self.is_noise(model) {
                break;
            }
        }
        hypotheses.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        if let Some(best) = hypotheses.first_mut()
            && before - best.cost() > MOSTLY * before
            && !self.is_noise(best)
        {
            *best = self.steadier(best.clone())?;
            if !self.is_noise(best) && !self.is_lost(best)? {
                *best = self.otherwise_sized(best.clone())?;
            }
        }
        Ok(hypotheses)
    }

    /// What is found beside several hypotheses, the best first, and the round of the first one. Once one effect leaves no more
    /// than noise beside one of them, it alone is tried beside the others. What residuals see beside any of them is tried before
    /// what they hardly see beside one, and this not at all where that leaves little more than noise, where residuals see what
    /// takes the rest, or where one simulation of the best says little.
    fn beside_all(&self, hypotheses: &[Model]) -> Result<NextRound, Stopped> {
        let mut next: Vec<Model> = Vec::new();
        let mut round = Round::default();
        let mut enough: Option<Setting> = None;
        let mut sights = Vec::new();
        for (i, model) in hypotheses.iter().enumerate() {
            if i > 0 && self.is_spent() {
                break;
            }
            if let Some(effect) = &enough {
                next.extend(self.also(model, effect)?);
                continue;
            }
            let own = self.beside(model)?;
            if i == 0 {
                round = own.round;
            }
            let last = own.found.iter().find(|model| self.is_noise(model));
            enough = last.and_then(|model| model.fit.effects.last().cloned());
            sights.push(own.sight);
            next.extend(own.found);
        }
        next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        let lifts_off = next
            .first()
            .is_some_and(|best| !self.is_noise(best) && self.problem.lifts_off(&best.fit.effects));
        let hidden = |&i: &usize| sights[i] == SeenBeside::Less;
        let hidden: Vec<usize> = (0..sights.len()).filter(hidden).collect();
        let seen = sights.contains(&SeenBeside::All);
        if !(hidden.is_empty() || lifts_off || seen || self.sees_the_rest(&next)) {
            for i in hidden {
                if i > 0 && self.is_spent() {
                    break;
                }
                let mut tried = Vec::new();
                let list = if i == 0 { &mut round.tried } else { &mut tried };
                next.extend(self.unseen(&hypotheses[i], list)?);
            }
        }
        next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        next.dedup_by(|a, b| same(&a.fit.effects, &b.fit.effects));
        Ok(NextRound { round, next, lifts_off })
    }

    /// Whether by looks one more effect beside one of the best models takes most of what that leaves above noise, and leaves no
    /// more than noise.
    fn sees_the_rest(&self, models: &[Model]) -> bool {
        models.iter().take(HYPOTHESES).any(|model| {
            let look = self.target(&model.baseline, true).look(&model.fit.effects);
            let count = look.map_or(0, |look| look.white.len()) as f64;
            let takes_it = |tried: Tried| {
                let most = tried.gain > MOSTLY * (model.held - count) && tried.gain > price(model);
                most && model.held - tried.gain < NOISE[0] * count
            };
            !self.is_noise(model) && self.screened(model).into_iter().any(takes_it)
        })
    }

    /// A model that was found with its values settled, without what it does not need, held against its rivals; and, where it
    /// leaves no more than noise, what still stands out of that.
    fn borne_out(
        &self,
        mut best: Model,
        rounds: &mut [Round],
    ) -> Result<(Model, Option<Rest>), Stopped> {
        if !best.fit.effects.is_empty() {
            // Values that leave noise are left alone: looks alone do not find them as well again.
            if !self.is_noise(&best) {
                (self.tell)(&format!("settling {}", names(&best.fit.effects)));
                let settled = self.settle(&best.fit.effects, 4)?;
                let better = settled.filter(|model| model.misfit < best.misfit);
                // What never settles is held against simulations of other values than its own.
                let own = match better {
                    Some(model) if !model.baseline.rattles => self.at(&model.fit.effects, &[])?,
                    other => other,
                };
                best = own.filter(|model| model.misfit < best.misfit).unwrap_or(best);
            }
            best = self.simplified(best)?;
            best = self.needed(best)?;
            if !self.is_noise(&best) {
                best = self.refined(best, Far::All)?;
            }
            if !self.is_noise(&best) && best.baseline.rattles {
                best = self.foretold(&best)?.unwrap_or(best);
            }
        }
        credited(rounds, &best.fit.effects);
        if !self.is_noise(&best) {
            return Ok((best, None));
        }
        best = self.swinging_as_seen(best)?;
        let effects = best.fit.effects.clone();
        best = self.beside_rivals(best, rounds)?;
        if !same(&effects, &best.fit.effects) {
            best = self.swinging_as_seen(best)?;
        }
        let mut rest = self.rest(&best)?;
        if rest.is_some() && !best.baseline.rattles {
            best = self.refined(best, Far::All)?;
            rest = self.rest(&best)?;
        }
        Ok((best, rest))
    }
}

/// What is beside several hypotheses.
struct NextRound {
    /// The round of the first one.
    round: Round,
    /// Models with one effect more, the best first.
    next: Vec<Model>,
    /// Whether joints lift off in the best of those that residuals see, and as declared they do not.
    lifts_off: bool,
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

fn same(a: &[Setting], b: &[Setting]) -> bool {
    a.len() == b.len() && a.iter().all(|a| b.iter().any(|b| a.is(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::values::candidates::candidates;

    /// A payload is missing here, and nobody has the time to look for it.
    #[test]
    fn nothing_is_begun_after_too_many_steps() {
        let problem = RigProblem::planar("planar-1").worn_out();
        let (split, all) = (problem.split(), candidates(&problem.declared, &[]));
        let search = Search::new(&problem, &split, &all, &|_| {});
        let found = search.run().unwrap();
        assert!(!search.is_noise(&found.best), "something is missing");
        assert!(found.rounds.is_empty() && found.best.fit.effects.is_empty());
        let before = problem.simulations();
        assert!(search.unseen(&found.declared, &mut Vec::new()).unwrap().is_empty());
        assert!(search.foretold(&found.declared).unwrap().is_none());
        assert_eq!(problem.simulations(), before);
    }
}
