//! A round of a search: what was tried, what was added, what was as good.

use crate::calibrate::sensed::values::model::Model;
use crate::effects::Setting;

/// A candidate of a round.
#[derive(Clone, Debug)]
pub struct Tried {
    /// The effect with the values that fitted.
    pub effect: Setting,
    /// Drop of Σ of squares on data not used for its fit.
    pub gain: f64,
    /// Share of what was there that this is.
    pub share: f64,
    /// Whether its values were fitted by more than one linear step, and what shrinks of the noise is no gain.
    pub fitted: bool,
    /// Drop that draws of noise bring it by chance.
    pub chance: f64,
    /// Whether the machine was simulated with it.
    pub simulated: bool,
}

impl Tried {
    /// One that whole simulations were fitted with, beside a model that it gains so much over.
    pub(super) fn simulated(effect: Setting, gain: f64, beside: &Model) -> Self {
        let share = (gain / beside.held).clamp(0.0, 1.0);
        Self { effect, gain, share, fitted: true, chance: 0.0, simulated: true }
    }
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

impl Round {
    /// Whether simulations of this round left more with an effect than with its own one, by more than `enough`.
    pub(in crate::calibrate::sensed) fn rules_out(
        &self,
        effect: &Setting,
        own: &Setting,
        enough: f64,
    ) -> bool {
        let gain = |of: &Setting| {
            let simulated = |tried: &&Tried| tried.simulated && tried.effect.is(of);
            self.tried.iter().find(simulated).map(|tried| tried.gain)
        };
        gain(effect).zip(gain(own)).is_some_and(|(gain, own)| gain < own - enough)
    }
}

/// What is beside a model.
pub(super) struct Beside {
    pub round: Round,
    /// Models with one effect more, simulated, the best first.
    pub found: Vec<Model>,
    pub sight: SeenBeside,
}

/// How much of what a model lacks residuals see beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SeenBeside {
    /// All but little more than noise.
    All,
    /// Most of it.
    Most,
    /// Less: only simulations may show what it lacks.
    Less,
}
