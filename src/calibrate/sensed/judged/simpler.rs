//! Simpler variants of the effects that were found, and effects that they contain: values that bring no more than chance does are not given.

use crate::calibrate::sensed::residuals::problem::Stopped;
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::rounds::words::name;
use crate::calibrate::sensed::thresholds::{GAIN_PER_VALUE, TWINS};
use crate::calibrate::sensed::values::certainty::uncertain;
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::sensed::values::trajectory::Far;
use crate::calibrate::values::instrument::changed;
use crate::effects::{CONTAINS, Kind, Setting};

impl Search<'_> {
    /// The model with variants of its effects that have fewer values where they do as well: on data that they
    /// were not fitted to they may lose what their values were paid for, and what chance gives one of two rivals.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn simplified(&self, model: Model) -> Result<Model, Stopped> {
        let mut best = model;
        for i in 0..best.fit.effects.len() {
            let simpler = self.variants(&best.fit.effects[i]).into_iter().find_map(|variant| {
                let fewer = best.fit.effects[i].values().count() - variant.values().count();
                // Another name is another hypothesis.
                let own = variant.is(&best.fit.effects[i]);
                let chance = TWINS[usize::from(best.baseline.rattles && !own)];
                let mut effects = best.fit.effects.clone();
                effects[i] = variant;
                let [on, hold] = [false, true].map(|held| self.target(&best.baseline, held));
                let fit = on.settled(on.fit(&effects, STEPS)?);
                let held = match best.baseline.rattles {
                    // The rattle of the data speaks for the values that were fitted to it.
                    true => changed(&hold, &best.fit.effects, &fit.effects)?.norm_squared(),
                    false => hold.look(&fit.effects)?.chi2,
                };
                let lost = held - best.held;
                (lost < GAIN_PER_VALUE * fewer as f64 + chance).then_some((fit, held))
            });
            let Some((fit, held)) = simpler else { continue };
            (self.tell)(&format!("settling a simpler {}", name(&fit.effects[i])));
            // What a look is wrong by depends on all values.
            let settled = match best.baseline.rattles {
                true => None,
                false => self.settle(&fit.effects, 1)?,
            };
            best = settled.unwrap_or_else(|| {
                let misfit = best.misfit + held - best.held;
                Model { fit, held, misfit, baseline: best.baseline.clone() }
            });
        }
        Ok(best)
    }

    /// The model, or one with fewer values of its last effect that leaves less: one that looks hardly tell, such as the rate at which
    /// friction turns round, leads the others astray from simulation to simulation.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn steadier(&self, model: Model) -> Result<Model, Stopped> {
        let Some((last, others)) = model.fit.effects.split_last() else { return Ok(model) };
        let fewer = self.variants(last).into_iter().rev().filter(|fewer| fewer.is(last));
        for fewer in fewer {
            if self.problem.is_worn_out() {
                break;
            }
            let effects = [others, std::slice::from_ref(&fewer)].concat();
            (self.tell)(&format!("settling a simpler {}", name(&fewer)));
            let settled = self.settle_within(&effects, 2, model.misfit)?;
            if let Some(settled) = settled.filter(|settled| settled.misfit < model.misfit) {
                return Ok(settled);
            }
        }
        Ok(model)
    }

    /// The model without effects of which nobody knows that there is any, where it leaves no more than noise without them.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn certain(&self, mut model: Model) -> Result<Model, Stopped> {
        while model.fit.effects.len() > 1
            && self.is_noise(&model)
            && let Some(none) = uncertain(self.problem, &model, &self.split.on)
        {
            let mut fewer = model.fit.effects.clone();
            fewer.retain(|effect| !effect.is(&none));
            let simpler = match model.fit.told {
                Some(_) => self.fitted(&fewer, Far::All)?,
                None => self.at(&fewer, &[])?,
            };
            match simpler.filter(|simpler| self.is_noise(simpler)) {
                Some(simpler) => model = simpler,
                None => break,
            }
        }
        Ok(model)
    }

    /// The variants of an effect, and of those that it contains, with fewer values than it has, those with the
    /// fewest first.
    fn variants(&self, effect: &Setting) -> Vec<Setting> {
        let inner = CONTAINS.iter().filter(|(outer, _)| outer.name == effect.kind.name);
        let kinds = inner.map(|(_, inner)| *inner).chain([effect.kind]);
        let with = |kind: &'static Kind, names: &[&'static str]| {
            let values: Vec<(&'static str, f64)> =
                names.iter().map(|name| (*name, effect.value(name).unwrap_or(0.0))).collect();
            Setting::on(kind, effect.target.clone(), &values)
        };
        let mut simpler: Vec<Setting> = kinds
            .flat_map(|kind| {
                let variants = kind.variants_of(&self.problem.declared, &effect.target);
                variants.into_iter().map(move |names| with(kind, names))
            })
            .filter(|simpler| simpler.better_known_as(&self.problem.declared).is_none())
            .filter(|simpler| simpler.values().count() < effect.values().count())
            .collect();
        simpler.sort_by_key(|simpler| simpler.values().count());
        simpler
    }
}

/// Steps of Gauss and Newton of a variant, at most.
const STEPS: usize = 8;
