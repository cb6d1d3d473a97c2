//! What explains the recordings in place of what was found.
//!
//! A round simulates the few candidates that promise most beside a model that lacks an effect, whose looks are wrong by as
//! much as that lacks. Beside the model that was found, less one of its effects, looks are as right as they can be: what
//! takes up most of that effect's part there is simulated, too, and compared on all runs. Two models that are no further
//! apart than chance are as good as each other.

use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::Stopped;
use crate::calibrate::sensed::rounds::rest::Rest;
use crate::calibrate::sensed::rounds::round::{Round, Tried};
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::rounds::words::names;
use crate::calibrate::sensed::thresholds::{
    BY_LOOKS, GAIN, GAIN_PER_VALUE, KINDS, RIVAL, RIVALS, SIMULATED, TWINS,
};
use crate::calibrate::sensed::values::linear::Derivatives;
use crate::calibrate::sensed::values::model::{Model, price};
use crate::calibrate::sensed::values::trajectory::Far;
use crate::effects::{SELDOM, Setting};
use rayon::prelude::*;

/// Difference of cost below which rivals are compared at values from whole simulations: those from looks are a little off, by
/// what looks are wrong by, which differs from rival to rival. In a trial a drive that gives cost 13 more than gains that
/// imitate it, and 12 less there.
const CLOSE: f64 = 10.0 * TWINS[0];

/// Steps of Gauss and Newton from values that fit one run to those that fit the others, at most.
const STEPS: usize = 6;

/// Of effects that explain recordings alike the one that is named, by its place: an instrument's error before one of the
/// machine, a common effect before one that imitates it, of several the one with the fewest values, the earlier before the later.
fn preferred(alike: &[&Setting]) -> Option<usize> {
    let seldom = |effect: &Setting| SELDOM.iter().any(|kind| kind.name == effect.kind.name);
    let rank = |place: &usize| {
        let effect = alike[*place];
        let sort = if effect.kind.is_instrument() { 0 } else { 1 + u8::from(seldom(effect)) };
        (sort, effect.values().count())
    };
    (0..alike.len()).min_by_key(rank)
}

/// Of effects that explain about as much, the best first, the place of the one that is named. The first `alike` of them are as
/// good by chance alone, which is no reason to blame the machine; an effect that contains another one fits its rattle as well,
/// and goes before it only where it does better than all of these.
fn chosen(near: &[Setting], alike: usize) -> usize {
    let twins: Vec<&Setting> = near.iter().take(alike).collect();
    let first = preferred(&twins).unwrap_or(0);
    let inner = near.get(first).and_then(|own| near.iter().position(|effect| own.contains(effect)));
    inner.unwrap_or(first)
}

/// A model with an effect in place of another one.
struct Rival {
    effect: Setting,
    model: Model,
    /// What it costs on all data more than what was found.
    cost: f64,
}

impl Search<'_> {
    /// The model, or one with rivals in place of its effects that explains all runs better, without what that does not need; `rounds`
    /// hear what is as good as each effect.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn beside_rivals(
        &self,
        model: Model,
        rounds: &mut [Round],
    ) -> Result<Model, Stopped> {
        let mut best = model;
        let mut held: Vec<Setting> = Vec::new();
        let open = |best: &Model, held: &[Setting]| {
            best.fit.effects.iter().position(|own| !held.iter().any(|held| held.is(own)))
        };
        while let Some(i) = open(&best, &held) {
            let own = best.fit.effects[i].clone();
            let [simulated, beyond] = self.rivals(&best, i);
            let mut all = self.in_its_place(&best, i, simulated)?;
            let up_to = |chance: f64| {
                let enough = all[0].cost + chance;
                all.iter().take_while(move |rival| rival.cost < enough)
            };
            let as_good = up_to(TWINS[usize::from(best.baseline.rattles)]);
            let near: Vec<Setting> = as_good.map(|rival| rival.effect.clone()).collect();
            let alike = up_to(TWINS[0]).count();
            let place = chosen(&near, alike);
            let round = rounds
                .iter_mut()
                .find(|round| round.added.as_ref().is_some_and(|added| added.is(&own)));
            let Rival { effect: won, model, .. } = all.swap_remove(place);
            if let Some(round) = round {
                let not_ruled_out = match near.iter().any(|effect| effect.is(&own)) {
                    true => beyond
                        .into_iter()
                        .filter(|effect| !round.rules_out(effect, &own, CLOSE))
                        .collect(),
                    false => Vec::new(),
                };
                round.add_instead(&won, near, not_ruled_out);
            }
            // Beside the wrong effect another one may stand in for what that lacks of the right one.
            best = if won.is(&own) { model } else { self.needed(model)? };
            held.push(won);
        }
        Ok(best)
    }

    /// A model, and those with a rival in place of one of its effects that leave no more than noise either, the best on all
    /// data first.
    fn in_its_place(
        &self,
        model: &Model,
        place: usize,
        rivals: Vec<Setting>,
    ) -> Result<Vec<Rival>, Stopped> {
        let mut others = model.fit.effects.clone();
        let own = others.remove(place);
        let rattles = model.baseline.rattles;
        let mut all = vec![Rival { effect: own.clone(), model: model.clone(), cost: 0.0 }];
        for rival in rivals {
            let mut effects = others.clone();
            effects.insert(place, rival.clone());
            (self.tell)(&format!("simulating with {} in place of {own}", names(&effects)));
            // What is told apart by ten units of thousands has to stand at its own best values.
            let times = if rattles { 1 } else { 4 };
            let enough = model.misfit + CLOSE;
            let settled = self.settle_within(&effects, times, enough)?;
            let Some(settled) = settled else { continue };
            // What does not come down to noise explains nothing, whatever it costs.
            if self.is_noise(&settled) && !self.imitates(&settled.fit.effects[place]) {
                let cost = match rattles {
                    true => self.dearer(model, &settled),
                    // Simulations are compared once values settle.
                    false => self.whole(&settled) - self.whole(model),
                };
                all.push(Rival { effect: rival, model: settled, cost });
            }
        }
        let by_cost = |a: &Rival, b: &Rival| a.cost.total_cmp(&b.cost);
        all.sort_by(by_cost);
        let enough = all[0].cost + CLOSE;
        let close = all.iter().take_while(|rival| rival.cost < enough).count();
        if close > 1 && !rattles {
            for rival in &mut all[..close] {
                rival.model = self.refined(rival.model.clone(), Far::All)?;
                rival.cost = self.dearer(model, &rival.model);
            }
            all.sort_by(by_cost);
        }
        Ok(all)
    }

    /// What a rival costs on all data more than a model, by what the two have in common: [noise](Baseline::in_common) where joints
    /// of both rattle, [looks](Baseline::leaves_more) where none does. What each costs by its own differs by luck.
    fn dearer(&self, model: &Model, rival: &Model) -> f64 {
        let in_common = match (model.baseline.rattles, rival.baseline.rattles) {
            (true, true) => self.dearer_in_common(model, rival),
            (false, false) => self.dearer_by_looks(model, rival),
            _ => None,
        };
        in_common.unwrap_or_else(|| self.whole(rival) - self.whole(model))
    }

    /// The same by looks that both have in common; none where one of the two cannot move as it was measured.
    fn dearer_by_looks(&self, model: &Model, rival: &Model) -> Option<f64> {
        let left = Baseline::leaves_more(self.problem, [&model.baseline, &rival.baseline])?;
        let price = |model: &Model| 2.0 * price_of_values(&model.fit.effects);
        Some(left + price(rival) - price(model))
    }

    /// The same by looks in common noise; none where one of the two cannot move as it was measured.
    fn dearer_in_common(&self, model: &Model, rival: &Model) -> Option<f64> {
        let two = Baseline::in_common(self.problem, [&model.baseline, &rival.baseline])?;
        let cost = |model: &Model, baseline: &Baseline| {
            let fit = self.target(baseline, false).fit(&model.fit.effects, STEPS)?;
            let held = self.target(baseline, true).look(&fit.effects)?;
            Some(fit.chi2 + held.chi2 + price_of_values(&fit.effects))
        };
        Some(cost(rival, &two[1])? - cost(model, &two[0])?)
    }

    /// The candidates that take up most of what an effect of a model does, in its place: those to be simulated, and those beyond
    /// their number that do so as well as the effect itself, where looks tell that.
    fn rivals(&self, model: &Model, place: usize) -> [Vec<Setting>; 2] {
        let mut others = model.fit.effects.clone();
        let own = others.remove(place);
        let looks = [false, true].map(|held| self.target(&model.baseline, held).look(&others));
        let [Some(fit), Some(held)] = looks else { return [Vec::new(), Vec::new()] };
        let gain = held.chi2 - model.held;
        let without = Model { fit, held: held.chi2, misfit: held.chi2, ..model.clone() };
        let mut found: Vec<(bool, Setting)> = Vec::new();
        // What one linear step falls short of differs from effect to effect, by more than twins do.
        let fitted = |tried: Tried| match tried.fitted || tried.gain <= RIVAL * gain {
            true => tried,
            false => self.closer(&without, &tried, held.chi2).unwrap_or(tried),
        };
        let all: Vec<Tried> = self.screened(&without).into_par_iter().map(fitted).collect();
        for tried in all {
            let known = found.iter().any(|(_, known)| known.is(&tried.effect));
            // One with more values than it was left with may do as well as those in its place.
            let more = tried.effect.values().count() > own.values().count();
            if !known
                && (more || !tried.effect.is(&own))
                && tried.gain > RIVAL * gain
                && !self.imitates(&tried.effect)
            {
                let as_well =
                    !model.baseline.rattles && tried.gain > gain - TWINS[0].max(BY_LOOKS * gain);
                found.push((as_well, tried.effect));
            }
        }
        let simulated = best_of_kinds(&mut found);
        let alike = |place: &usize| found[*place].0;
        let places: Vec<usize> = (0..found.len()).filter(alike).collect();
        let named: Vec<&Setting> = places.iter().map(|&place| &found[place].1).collect();
        if let Some(place) = preferred(&named).map(|first| places[first])
            && place >= simulated
        {
            found[simulated - 1..=place].rotate_right(1);
        }
        let beyond = found.split_off(simulated);
        let beyond = beyond.into_iter().filter(|(as_well, _)| *as_well);
        [
            found.into_iter().map(|(_, effect)| effect).collect(),
            beyond.map(|(_, effect)| effect).collect(),
        ]
    }

    /// What would still take more off what a model leaves than chance does, on data that it is not fitted to: a candidate
    /// beside its effects, or other values of them on another run than that which they were fitted to. A model that is right
    /// leaves neither; one that imitates what is missing does, even where what it leaves is no larger than noise. What one
    /// simulation of a candidate can follow is held against that: a candidate that filters what sensors show takes noise off
    /// looks by more than a few draws of it tell.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub(in crate::calibrate::sensed) fn rest(
        &self,
        model: &Model,
    ) -> Result<Option<Rest>, Stopped> {
        if let Some(drop) = self.other_values(model) {
            return Ok(Some(Rest::Values(drop)));
        }
        for Tried { effect, gain, .. } in self.standing_out(model).into_iter().take(SIMULATED) {
            if model.baseline.rattles {
                return Ok(Some(Rest::Effect(effect, gain)));
            }
            let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&effect)].concat();
            (self.tell)(&format!("simulating with {}", names(&effects)));
            let settled = self.settle(&effects, 1)?;
            let gain = settled.map_or(0.0, |settled| model.misfit - settled.misfit);
            if gain > enough(model, effect.values().count()) {
                return Ok(Some(Rest::Effect(effect, gain)));
            }
        }
        Ok(None)
    }

    /// What other values of a model's effects would take off the sum of squares of the runs that these were not fitted to, where
    /// that is more than chance does.
    fn other_values(&self, model: &Model) -> Option<f64> {
        let values: usize = model.fit.effects.iter().map(|effect| effect.values().count()).sum();
        let hold = self.target(&model.baseline, true);
        let refitted = hold.fit(&model.fit.effects, STEPS)?;
        let shrunk = model.baseline.shrunk(self.problem, &refitted.effects, &self.split.hold);
        let drop = model.held - refitted.chi2 - shrunk.unwrap_or(0.0);
        let chance = || {
            let on = model.fit.jacobian.clone()?;
            let columns = Derivatives { on, hold: hold.jacobian(&refitted)?, known: 0 };
            columns.refitted(&self.draws(model), model.baseline.replicas)
        };
        let stands_out =
            drop > enough(model, values) && chance().is_none_or(|chance| drop > chance);
        stands_out.then_some(drop)
    }

    /// Candidates that by looks would still take more off what a model leaves than chance does, the best first.
    pub(in crate::calibrate::sensed) fn standing_out(&self, model: &Model) -> Vec<Tried> {
        let mut all = self.screened(model);
        all.retain(|tried| {
            let enough = enough(model, tried.effect.values().count()).max(tried.chance);
            tried.fitted && tried.gain > enough
        });
        all
    }

    /// An effect of a model whose joints rattle more than the declared one's by more than few replicas tell, and that is not
    /// seen in anything else: without it, looks leave no more beside that rattle than few replicas may. That a rattle makes
    /// recordings likely says nothing of what causes it.
    pub(in crate::calibrate::sensed) fn rattles_alone(
        &self,
        declared: &Model,
        model: &Model,
    ) -> Option<Setting> {
        let noisiness = |model: &Model| self.noisiness(&model.baseline, &self.split.hold);
        if noisiness(model) < noisiness(declared) + GAIN[1] {
            return None;
        }
        let hold = self.target(&model.baseline, true);
        let effects = &model.fit.effects;
        let unseen = |place: &usize| {
            let mut others = effects.clone();
            others.remove(*place);
            hold.look(&others).is_some_and(|without| without.chi2 < model.held + GAIN[1])
        };
        (0..effects.len()).find(unseen).map(|place| effects[place].clone())
    }

    /// What a model costs on all data: those that it was fitted to tell rivals apart as well, at Akaike's price.
    fn whole(&self, model: &Model) -> f64 {
        let on = &self.split.on;
        let noise = self.noisiness(&model.baseline, on) + model.baseline.lost(on);
        model.cost() + model.fit.chi2 + noise + price_of_values(&model.fit.effects)
    }
}

/// How many rivals, the best first, are simulated, each with whether it does as well as what it would replace: the best, and of those
/// that do as well the best of each kind, which is moved to its place among them.
fn best_of_kinds(found: &mut [(bool, Setting)]) -> usize {
    let best = RIVALS.min(found.len());
    let mut simulated = best;
    for i in best..found.len() {
        let (as_well, own) = &found[i];
        let first = !found[..i].iter().any(|(_, known)| known.kind.name == own.kind.name);
        if simulated < KINDS && *as_well && first {
            found[simulated..=i].rotate_right(1);
            simulated += 1;
        }
    }
    simulated
}

/// Akaike's price of the values of effects.
fn price_of_values(effects: &[Setting]) -> f64 {
    let values: usize = effects.iter().map(|effect| effect.values().count()).sum();
    GAIN_PER_VALUE * values as f64
}

/// Drop of the sum of squares beyond chance that so many more values of a model have to bring.
fn enough(model: &Model, values: usize) -> f64 {
    price(model) + 2.0 * GAIN_PER_VALUE * values as f64
}

#[cfg(test)]
mod tests {
    use super::{best_of_kinds, chosen, preferred};
    use crate::effects::{Setting, Target, named};

    /// Wrong points of the links about a joint do not hide that it is worn.
    #[test]
    fn the_best_of_each_kind_that_does_as_well_is_simulated() {
        let wrong = |point: &str| {
            let kind = named("point-offset").unwrap();
            Setting::on(kind, Target::Point(point.to_owned()), &[("dx_m", 1e-4)])
        };
        let worn = |joint: &str| Setting::new(named("joint-wear").unwrap(), Some(joint), &[]);
        let points = ["l.A", "l.B", "ground.A", "ground.B"].map(|point| (true, wrong(point)));
        let slow = Setting::new(named("servo-lag").unwrap(), None, &[]);
        let mut found = points.to_vec();
        found.extend([(true, worn("A")), (false, slow), (true, worn("B"))]);
        assert_eq!(best_of_kinds(&mut found), 4);
        let names: Vec<String> = found.iter().map(|(_, effect)| effect.to_string()).collect();
        assert_eq!(
            names[2..5],
            ["point-offset at ground.A", "joint-wear at A", "point-offset at ground.B"]
        );
    }

    /// A machine is blamed only where no instrument would explain as much, and of something seldom only where nothing common
    /// would; many values are no explanation where one is.
    #[test]
    fn instruments_are_named_before_the_machine() {
        let on = |kind, target: &Target, values: &[_]| {
            Setting::on(named(kind).unwrap(), target.clone(), values)
        };
        let joint = Target::Joints(vec!["A".to_owned()]);
        let wear = on("joint-wear", &joint, &[("clearance_m", 3e-4)]);
        let round = on("out-of-round", &joint, &[("amplitude_m", 1e-5)]);
        let sensor = Target::Sensors(vec!["q_A".to_owned()]);
        let zero = on("encoder-zero", &sensor, &[("offset", 1e-4)]);
        let values = [("mass_kg", 0.1), ("com_x_m", 0.0), ("com_y_m", 0.0)];
        let payload = on("payload", &Target::Body("rod".to_owned()), &values);
        assert_eq!(preferred(&[]), None);
        assert_eq!(preferred(&[&wear]), Some(0));
        assert_eq!(preferred(&[&round, &wear]), Some(1));
        assert_eq!(preferred(&[&round]), Some(0));
        assert_eq!(preferred(&[&payload, &wear, &wear]), Some(1));
        assert_eq!(preferred(&[&wear, &zero, &zero]), Some(1));
    }

    /// Friction that falls with speed fits a rattle better than plain friction of the same joint by less than few replicas tell.
    #[test]
    fn what_contains_another_effect_has_to_do_better_than_chance() {
        let on = |kind, joint: &str| Setting::new(named(kind).unwrap(), Some(joint), &[]);
        let [falling, plain] =
            ["stribeck-friction", "actuator-friction"].map(|kind| on(kind, "P3"));
        let other = on("actuator-friction", "P1");
        assert_eq!(chosen(&[falling.clone(), other.clone(), plain.clone()], 1), 2);
        assert_eq!(chosen(&[falling.clone(), other.clone()], 1), 0);
        assert_eq!(chosen(&[plain, falling, other], 1), 0);
        assert_eq!(chosen(&[], 0), 0);
    }
}
