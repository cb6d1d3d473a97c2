//! Other values of what was found, or effects that contain it, where that misses a run that nothing was fitted to.

use super::round::{Round, Tried};
use super::search::Search;
use super::words::names;
use crate::calibrate::sensed::residuals::problem::{Segment, Stopped};
use crate::calibrate::sensed::values::candidates::{KEPT, starts};
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::sensed::values::trajectory::Far;

impl Search<'_> {
    /// A model that meets the predictions of all runs in place of one that leaves no more than noise and misses a run that its values
    /// were not fitted to: with values of its effects at which a fit to the first run did not [end](Self::elsewhere), or with an
    /// effect in place of one that it contains, and the round that led to that. What two such models differ by may show along
    /// the other run alone: values are fitted to the first one still. None where the model misses none, and where no such model
    /// meets them.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn meeting_all(
        &self,
        model: &Model,
    ) -> Result<Option<(Model, Option<Round>)>, Stopped> {
        let none = model.fit.effects.is_empty();
        if none
            || model.baseline.rattles
            || !self.is_noise(model)
            || !self.misses(model, &self.split.hold)?
        {
            return Ok(None);
        }
        let all = [self.split.on.as_slice(), &self.split.hold].concat();
        if let Some(elsewhere) = self.elsewhere(model)?
            && !self.misses(&elsewhere, &all)?
            && self.rest(&elsewhere)?.is_none()
        {
            return Ok(Some((elsewhere, None)));
        }
        let wider = self.wider(model, &all)?;
        Ok(wider.map(|(wider, round)| (wider, Some(round))))
    }

    /// A model that meets the predictions of `all` runs with an effect in place of one that it contains, and the round that led to
    /// it.
    fn wider(&self, model: &Model, all: &[Segment]) -> Result<Option<(Model, Round)>, Stopped> {
        let effects = &model.fit.effects;
        let pairs = effects.iter().enumerate().flat_map(|(i, own)| {
            let all = self.candidates.iter();
            all.filter(move |candidate| candidate.contains(own)).map(move |outer| (i, outer))
        });
        let target = self.target(&model.baseline, false);
        for (i, candidate) in pairs {
            let mut others = effects.clone();
            others.remove(i);
            let Some(without) = target.look(&others) else { continue };
            for start in starts(&target, &without, candidate, KEPT) {
                let effects = [others.as_slice(), &[start]].concat();
                (self.tell)(&format!("fitting whole simulations with {}", names(&effects)));
                if let Some(wider) = self.fitted(&effects, Far::All).ok().flatten()
                    && self.is_noise(&wider)
                    && !self.misses(&wider, all)?
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
