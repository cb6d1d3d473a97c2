//! Models with one effect more than another one has, simulated.

use super::round::{Beside, Round, SeenBeside, Tried};
use super::search::Search;
use super::words::names;
use crate::calibrate::sensed::judged::left::Left;
use crate::calibrate::sensed::residuals::problem::{Run, Stopped};
use crate::calibrate::sensed::thresholds::{
    AFAR, GAIN, MOSTLY, NEARER, NOISE, PROMISING, SIMULATED,
};
use crate::calibrate::sensed::values::candidates::starts;
use crate::calibrate::sensed::values::fit::Fit;
use crate::calibrate::sensed::values::model::{Model, price};
use crate::effects::{Parameter, ScanRange, Setting};
use crate::mechanism::{Mechanism, Reads, Sensor};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Share of what was left below which a pass leaves less of a model that still comes nearer: another is worth its simulations.
const HALVED: f64 = 0.5;

impl Search<'_> {
    /// The best models with one effect more than this one has that residuals see.
    pub(super) fn beside(&self, model: &Model) -> Result<Beside, Stopped> {
        (self.tell)(&format!("trying every effect{}", beside(&model.fit.effects)));
        let mut tried = self.screened(model);
        let mut found: Vec<Model> = Vec::new();
        for candidate in tried.iter_mut() {
            if found.len() >= SIMULATED || candidate.gain < 0.5 * GAIN[0] {
                break;
            }
            // Variants of one effect are one hypothesis; a simpler one may be led astray less.
            let same =
                |model: &&Model| model.fit.effects.last().is_some_and(|e| e.is(&candidate.effect));
            let count = |effect: &Setting| effect.values().count();
            let simpler = |model: &Model| {
                model.fit.effects.last().is_some_and(|e| count(&candidate.effect) < count(e))
            };
            let known: Vec<&Model> = found.iter().filter(same).collect();
            if known.len() > 1 || known.iter().any(|model| !simpler(model)) {
                continue;
            }
            let effects =
                [model.fit.effects.as_slice(), std::slice::from_ref(&candidate.effect)].concat();
            (self.tell)(&format!("simulating with {}", names(&effects)));
            if let Some(settled) = self.settle(&effects, 1)? {
                candidate.gains(model.cost() - settled.cost(), model);
                found.push(settled);
            }
        }
        self.again(model, &mut found, &mut tried)?;
        let nearer = self.nearer(model, &found, &mut tried)?;
        found.retain(|rival| !rival.fit.effects.last().is_some_and(|own| self.imitates(own)));
        found.extend(nearer);
        let seen =
            |tried: &Tried| tried.simulated && tried.gain > price(model) && tried.share > MOSTLY;
        // What leaves little more than noise of what was much more.
        let little = |found: &Model| {
            let noisy = |left: &Left| left.mean_square <= left.limit.max(NOISE[1]);
            let most = model.cost() - found.cost() > MOSTLY * model.cost();
            self.is_noise(found) || most && self.left(found).iter().all(noisy)
        };
        let sight = match (found.iter().any(little), tried.iter().any(seen)) {
            (true, _) => SeenBeside::All,
            (false, true) => SeenBeside::Most,
            (false, false) => SeenBeside::Less,
        };
        found.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        Ok(Beside { round: Round { tried, ..Round::default() }, found, sight })
    }

    /// The best of what was simulated, where that [imitates](Self::imitates) another effect, at values by which it does not and leaves
    /// no more than noise: small motions show a spring as well with its anchor afar, and looks are off by more than the two differ.
    fn nearer(
        &self,
        model: &Model,
        found: &[Model],
        tried: &mut [Tried],
    ) -> Result<Option<Model>, Stopped> {
        let best = found.iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
        let Some(last) = best.and_then(|best| best.fit.effects.last()) else { return Ok(None) };
        if !self.imitates(last) {
            return Ok(None);
        }
        let target = self.target(&model.baseline, false);
        let starts = starts(&target, &model.fit, last, NEARER);
        let own = &model.fit.effects;
        let fitted = |start: &Setting| {
            target.fit(&[own.as_slice(), std::slice::from_ref(start)].concat(), 8)
        };
        let near = |fit: &Fit| fit.effects.last().is_some_and(|own| !self.imitates(own));
        let fits = starts.par_iter().filter_map(fitted).filter(near);
        let Some(fit) = fits.min_by(|a, b| a.chi2.total_cmp(&b.chi2)) else { return Ok(None) };
        (self.tell)(&format!("simulating with {}", names(&fit.effects)));
        let Some(settled) = self.settle(&fit.effects, 2)? else { return Ok(None) };
        if !self.is_noise(&settled) {
            return Ok(None);
        }
        if let Some(tried) = tried.iter_mut().find(|tried| tried.simulated && tried.effect.is(last))
        {
            tried.gains(model.cost() - settled.cost(), model);
        }
        Ok(Some(settled))
    }

    /// Simulates rivals again at the values that their first simulations led to, those that promise nearly as much
    /// as the best of them: once, and those that rattle, which are not fitted to whole simulations, as long as each time halves what
    /// is left.
    fn again(
        &self,
        model: &Model,
        found: &mut [Model],
        tried: &mut [Tried],
    ) -> Result<(), Stopped> {
        let best = found.iter().map(Model::cost).fold(model.cost(), f64::min);
        let enough = model.cost() - PROMISING * (model.cost() - best);
        for rival in found.iter_mut().filter(|rival| rival.cost() <= enough) {
            let mut before = f64::INFINITY;
            while rival.held < HALVED * before {
                let Some(settled) = self.settle(&rival.fit.effects, 1)? else { break };
                before = if settled.baseline.rattles { rival.held } else { 0.0 };
                if !settled.baseline.rattles || settled.misfit < rival.misfit {
                    *rival = settled;
                }
            }
            let last = rival.fit.effects.last();
            let own = |tried: &&mut Tried| {
                tried.simulated && last.is_some_and(|effect| effect.is(&tried.effect))
            };
            if let Some(tried) = tried.iter_mut().find(own) {
                tried.gains(model.cost() - rival.cost(), model);
            }
        }
        Ok(())
    }

    /// The model with an effect that left nothing but noise beside another one, which may have been mistaken for
    /// an effect of this one.
    pub(super) fn also(&self, model: &Model, effect: &Setting) -> Result<Vec<Model>, Stopped> {
        if model.fit.effects.iter().any(|own| own.is(effect)) {
            return Ok(Vec::new());
        }
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(effect)].concat();
        (self.tell)(&format!("simulating with {}", names(&effects)));
        Ok(self.settle(&effects, 2)?.into_iter().collect())
    }

    /// Whether an effect's values say that it imitates another one: one lies at the end of what makes sense, a place is far
    /// off the machine, or what repeats does so less than once in a run, or on the way of its joint.
    pub(in crate::calibrate::sensed) fn imitates(&self, effect: &Setting) -> bool {
        let afar = AFAR * self.problem.declared.size();
        // A machine need not stand at the origin: places are around where they are looked for.
        let starts = effect.starts(&self.problem.declared);
        let middle = |i: usize| {
            starts.iter().map(|start| start[i]).sum::<f64>() / starts.len().max(1) as f64
        };
        let far = |(i, (name, value)): (usize, (&str, f64))| {
            let place = |p: &Parameter| p.unit == "m" && p.bounds[0] < 0.0;
            effect.kind.parameter(name).is_some_and(place) && (value - middle(i)).abs() > afar
        };
        let once = effect.kind.scan.is_some_and(|scan| {
            let periods = effect.value(scan.over).map(|value| match scan.range {
                ScanRange::Frequencies => value * self.seconds(),
                ScanRange::Orders(_) => value * self.travel(effect) / TAU,
                ScanRange::WaveNumbers(_) => self.travel(effect) / value,
            });
            periods.is_some_and(|periods| periods < 1.0)
        });
        once || at_a_limit(effect) || effect.values().enumerate().any(far)
    }

    /// The longest run in s.
    fn seconds(&self) -> f64 {
        let seconds = |run: &Run| run.recording.duration();
        self.problem.runs.iter().map(seconds).fold(0.0, f64::max)
    }

    /// How far the joints of an effect go in a run, at most, in m or rad, as their sensors or commands show; endless where
    /// nobody recorded that.
    fn travel(&self, effect: &Setting) -> f64 {
        let Mechanism { sensors, actuators, .. } = &self.problem.declared;
        let own = |joint| {
            let name = self.problem.declared.joint_name(joint);
            effect.target.names().iter().any(|own| own == name)
        };
        let shows = |sensor: &Sensor| match sensor.reads {
            Reads::Position(joint) => own(joint),
            Reads::Command(drive) => own(actuators[drive].joint),
            _ => false,
        };
        let columns = sensors.iter().enumerate().filter(|(_, sensor)| shows(sensor));
        let runs = &self.problem.runs;
        let recorded =
            columns.flat_map(|(i, _)| runs.iter().filter_map(move |r| r.recording.get(i)));
        let farthest = recorded.map(|column| {
            let least = column.iter().copied().fold(f64::INFINITY, f64::min);
            column.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
        });
        farthest.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
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

fn beside(effects: &[Setting]) -> String {
    if effects.is_empty() { String::new() } else { format!(" beside {}", names(effects)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::effects::{Target, named};

    #[test]
    fn what_is_afar_or_hardly_repeats_imitates_something_else() {
        let problem = RigProblem::planar("planar-1");
        let split = problem.split();
        let search = Search::new(&problem, &split, &[], &|_| {});
        let body = Target::Body("rod".to_owned());
        let payload = |mass: f64, x: f64| {
            let values = [("mass_kg", mass), ("com_x_m", x), ("com_y_m", 0.0)];
            search.imitates(&Setting::on(named("payload").unwrap(), body.clone(), &values))
        };
        let size = problem.declared.size();
        assert!(!payload(0.1, 0.0) && !payload(0.1, 1.5 * size));
        assert!(payload(0.1, 3.0 * size), "far off the machine");
        assert!(payload(20.0, 0.0), "as much as makes sense");
        // Somewhere else in the room.
        let mut aside = RigProblem::planar("planar-1");
        for body in &mut aside.declared.bodies {
            body.start.position.x += 10.0;
        }
        let there = Search::new(&aside, &split, &[], &|_| {});
        let cable = |x: f64| {
            let values = [
                ("stiffness_N_m", 5.0),
                ("anchor_x_m", x),
                ("anchor_y_m", 0.0),
                ("rest_length_m", 0.1),
            ];
            Setting::on(named("tether").unwrap(), body.clone(), &values)
        };
        assert!(!search.imitates(&cable(0.1)) && search.imitates(&cable(10.1)));
        assert!(!there.imitates(&cable(10.1)) && there.imitates(&cable(0.1)));
        // Runs of three seconds.
        let vibration = |frequency: f64| {
            let values = [("ax_m_s2", 0.1), ("frequency_Hz", frequency)];
            let kind = named("base-vibration").unwrap();
            search.imitates(&Setting::on(kind, Target::Machine, &values))
        };
        assert!(vibration(0.3) && !vibration(0.4));
        // The crank goes round many times, the drives of a five-bar an eighth of a turn.
        let ripple = |search: &Search, joint: &str, per_turn: f64| {
            let joint = Target::Joints(vec![joint.to_owned()]);
            let values = [("amplitude", 0.1), ("per_turn", per_turn)];
            search.imitates(&Setting::on(named("torque-ripple").unwrap(), joint, &values))
        };
        assert!(!ripple(&search, "O", 1.5));
        let five_bar = RigProblem::planar("planar-5");
        let swings = Search::new(&five_bar, &split, &[], &|_| {});
        let drive = &five_bar.declared.actuators[0].name;
        assert!(ripple(&swings, drive, 1.5) && !ripple(&swings, drive, 12.0));
    }
}
