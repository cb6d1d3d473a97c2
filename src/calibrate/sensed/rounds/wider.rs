//! Effects that contain one that was found, where that misses a run that nothing was fitted to.

use super::round::{Round, Tried};
use super::search::Search;
use super::words::names;
use crate::calibrate::sensed::residuals::problem::Stopped;
use crate::calibrate::sensed::values::candidates::starts;
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::sensed::values::trajectory::Far;
use crate::effects::Setting;

impl Search<'_> {
    /// A model that meets the predictions of all runs, with an effect in place of one that it contains, and the round that
    /// led to it; in place of one that leaves no more than noise and misses a run that its values were not fitted to. What the two
    /// effects differ by may show along that run alone: values are fitted to the first one still. None where the model misses
    /// none, and where no such effect meets them.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn wider(
        &self,
        model: &Model,
    ) -> Result<Option<(Model, Round)>, Stopped> {
        let effects = &model.fit.effects;
        let pairs = effects.iter().enumerate().flat_map(|(i, own)| {
            let all = self.candidates.iter();
            all.filter(move |candidate| candidate.contains(own)).map(move |outer| (i, outer))
        });
        let wider: Vec<(usize, &Setting)> = pairs.collect();
        // Simulations are dear: most effects are contained in none.
        if wider.is_empty() || model.baseline.rattles || !self.is_noise(model) {
            return Ok(None);
        }
        if !self.misses(model, &self.split.hold)? {
            return Ok(None);
        }
        let all = [self.split.on.as_slice(), &self.split.hold].concat();
        let target = self.target(&model.baseline, false);
        for (i, candidate) in wider {
            let mut others = effects.clone();
            others.remove(i);
            let Some(without) = target.look(&others) else { continue };
            for start in starts(&target, &without, candidate) {
                let effects = [others.as_slice(), &[start]].concat();
                (self.tell)(&format!("fitting whole simulations with {}", names(&effects)));
                if let Some(wider) = self.fitted(&effects, Far::All).ok().flatten()
                    && self.is_noise(&wider)
                    && !self.misses(&wider, &all)?
                {
                    let round = round(&wider, model);
                    return Ok(Some((wider, round)));
                }
            }
        }
        Ok(None)
    }
}

/// The round that led from one model to one with another last effect.
fn round(wider: &Model, from: &Model) -> Round {
    let added = wider.fit.effects.last().cloned();
    let gain = from.cost() - wider.cost();
    let tried = added.iter().map(|effect| Tried::simulated(effect.clone(), gain, from)).collect();
    Round { tried, added, ..Round::default() }
}
