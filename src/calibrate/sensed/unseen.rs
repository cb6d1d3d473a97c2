//! Effects that residuals hardly see without a simulation.

use super::hypotheses::Tried;
use super::problem::Stopped;
use super::search::{Search, names};
use super::settle::Model;
use super::thresholds::GAIN;
use crate::effects::{Joints, Setting, Targets};

/// How far from its neutral value an effect that only simulations show is tried, in steps of its parameters: a
/// joint's clearance of 0.05 mm more.
const AWAY: f64 = 10.0;

impl Search<'_> {
    /// Models with one more effect of the joints' bearings, which residuals hardly see without a simulation: how
    /// bodies swing in their play shows them. Values are those of whole simulations.
    pub(super) fn unseen(&self, model: &Model, tried: &mut [Tried]) -> Result<Vec<Model>, Stopped> {
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
            if self.is_spent() {
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
}

/// An effect some way from its values, for what only simulations show.
pub(super) fn away(effect: &Setting) -> Setting {
    let values = effect.values().map(|(name, value)| {
        let parameter = effect.kind.parameter(name);
        parameter.map_or(value, |p| (value + AWAY * p.step).clamp(p.bounds[0], p.bounds[1]))
    });
    effect.with(&values.collect::<Vec<_>>())
}
