//! Other values of what was found, or effects that contain it, where that misses a run that nothing was fitted to, or leaves more than
//! noise.

use super::round::{Round, Tried};
use super::search::Search;
use super::words::names;
use crate::calibrate::sensed::residuals::problem::{Segment, Stopped};
use crate::calibrate::sensed::values::candidates::{KEPT, starts};
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::trajectory::Far;
use crate::calibrate::values::least_squares::{Free, free, values};
use crate::effects::Setting;
use rayon::prelude::*;

/// Sizes of an effect at which a fit may not have ended, in units of that at which it did: of a drive's backlash of 0.8 mrad one ended at
/// 0.22, and left a third.
const SIZES: [f64; 6] = [0.125, 0.25, 0.5, 2.0, 4.0, 8.0];

impl Search<'_> {
    /// A model that meets the predictions of all runs in place of one that leaves no more than noise and misses a run that its values
    /// were not fitted to: with values of its effects from predictions of the first run, or at which a fit to that did not
    /// [end](Self::elsewhere), or with an effect in place of one that it contains, and the round that led to that. What two such
    /// models differ by may show along the other run alone: values are fitted to the first one still. None where the model misses
    /// none, and where no such model meets them.
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
        // Looks may be off by more than predictions tell.
        if let Some(foretold) = self.foretold(model)?
            && !self.misses(&foretold, &all)?
        {
            return Ok(Some((foretold, None)));
        }
        if let Some(elsewhere) = self.elsewhere(model)?
            && !self.misses(&elsewhere, &all)?
            && self.rest(&elsewhere)?.is_none()
        {
            return Ok(Some((elsewhere, None)));
        }
        let wider = self.wider(model, &all)?;
        Ok(wider.map(|(wider, round)| (wider, Some(round))))
    }

    /// The model, or one with its last effect [several times](SIZES) as large, fitted from there, where that leaves less: a fit to whole
    /// simulations ends behind a rise of what is left, and a step as long as noise asks for does not lead across.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(super) fn otherwise_sized(&self, model: Model) -> Result<Model, Stopped> {
        let Some((last, others)) = model.fit.effects.split_last() else { return Ok(model) };
        let start = values(std::slice::from_ref(last));
        if start[0] == 0.0 || self.problem.is_worn_out() {
            return Ok(model);
        }
        (self.tell)(&format!("simulating {} of other sizes", names(std::slice::from_ref(last))));
        let makes_sense = |sized: &Setting| {
            let free = free(std::slice::from_ref(sized));
            let within = |((_, value), free): ((_, f64), &Free)| {
                (free.bounds[0]..=free.bounds[1]).contains(&value)
            };
            sized.values().zip(&free).all(within)
        };
        let sized = SIZES.iter().map(|times| last.with(&last.sized(&start, times * start[0])));
        let sized: Vec<Setting> = sized.filter(makes_sense).collect();
        let with = |last: &Setting| [others, std::slice::from_ref(last)].concat();
        let least = self.over_whole(&model, |whole, effects| {
            let left = |effects: &[Setting]| whole.look(effects).map(|left| left.norm_squared());
            let own = left(effects)?;
            let all = sized.par_iter().filter_map(|sized| Some((left(&with(sized))?, sized)));
            all.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|least| least.0 < own - price(&model))
        })?;
        let Some((_, sized)) = least else { return Ok(model) };
        (self.tell)(&format!("fitting whole simulations with {}", names(&with(sized))));
        let fitted = self.fitted(&with(sized), Far::All).ok().flatten();
        Ok(fitted.filter(|fitted| fitted.misfit < model.misfit).unwrap_or(model))
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
