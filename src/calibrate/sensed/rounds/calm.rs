//! What takes energy out of a rattle, and may show in nothing else: residuals are noise without it, only less
//! noise than joints make that rattle on.

use super::round::{Round, Tried};
use super::search::Search;
use super::unseen::away;
use super::words::name;
use crate::calibrate::sensed::residuals::problem::Stopped;
use crate::calibrate::sensed::thresholds::CALMER;
use crate::calibrate::sensed::values::model::Model;
use crate::effects::{CALMING, Setting, Target};

impl Search<'_> {
    /// The model with what makes the recordings so much likelier that no chance does, under joints that rattle; the
    /// round in which that was looked for. It does so on the data that values are fitted on, too: what few replicas bring
    /// by chance in one run they do not bring in another. Of each kind that may calm a rattle the whole machine's or the
    /// output body's is tried.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(super) fn calmer(&self, model: &Model) -> Result<(Round, Option<Model>), Stopped> {
        let mut round = Round::default();
        let mut best: Option<Model> = None;
        let output = self.problem.declared.names.output.as_deref();
        let own = |candidate: &&Setting| {
            let whole = match &candidate.target {
                Target::Machine => true,
                Target::Body(body) => Some(body.as_str()) == output,
                _ => false,
            };
            let calms = CALMING.iter().any(|kind| kind.name == candidate.kind.name);
            let known = model.fit.effects.iter().any(|effect| effect.is(candidate));
            whole && calms && !known
        };
        for candidate in self.candidates.iter().filter(own) {
            (self.tell)(&format!("simulating with {}: does it calm the rattle?", name(candidate)));
            let effects = [model.fit.effects.as_slice(), &[away(candidate)]].concat();
            let Some(settled) = self.settle(&effects, 2)? else { continue };
            let gain = model.cost() - settled.cost();
            let effect = settled.fit.effects[model.fit.effects.len()].clone();
            // It removes nothing that stands above noise.
            round.tried.push(Tried {
                effect,
                gain,
                share: 0.0,
                fitted: true,
                chance: 0.0,
                simulated: true,
            });
            if best.as_ref().is_none_or(|best| settled.cost() < best.cost()) {
                best = Some(settled);
            }
        }
        round.tried.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let enough = CALMER * self.names.len() as f64;
        let gains = |best: &Model| {
            [model.cost() - best.cost(), self.misfit_of_fitted(model) - self.misfit_of_fitted(best)]
        };
        let calms = |best: &Model| gains(best).iter().all(|gain| *gain > enough);
        let calmer = best.filter(|best| calms(best) && self.is_noise(best));
        round.added = calmer.as_ref().and_then(|best| best.fit.effects.last().cloned());
        Ok((round, calmer))
    }

    /// −2 log likelihood on the data that values were fitted on, but for a constant.
    fn misfit_of_fitted(&self, Model { fit, baseline, .. }: &Model) -> f64 {
        let on = &self.split.on;
        fit.chi2 + self.noisiness(baseline, on) + baseline.lost(on)
    }
}
