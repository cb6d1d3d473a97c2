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
        let mut tried =
            Self { effect, gain, share: 0.0, fitted: true, chance: 0.0, simulated: true };
        tried.gains(gain, beside);
        tried
    }

    /// What it gains over a model by simulations, in place of what looks promised.
    pub(super) fn gains(&mut self, gain: f64, beside: &Model) {
        (self.simulated, self.gain) = (true, gain);
        self.share = (gain / beside.held).clamp(0.0, 1.0);
    }
}

/// One round of a search.
#[derive(Clone, Debug, Default)]
pub struct Round {
    /// Candidates, the best first.
    pub tried: Vec<Tried>,
    /// What was added.
    pub added: Option<Setting>,
    /// What was as good in whole simulations.
    pub as_good: Vec<Setting>,
    /// What residuals alone do not rule out in its place, and was not simulated.
    pub not_ruled_out: Vec<Setting>,
}

impl Round {
    /// The effect that was added, from now on, in place of the one so far, and what is no worse in its place: in whole
    /// simulations, and as far as residuals tell.
    pub(in crate::calibrate::sensed) fn add_instead(
        &mut self,
        won: &Setting,
        as_good: Vec<Setting>,
        not_ruled_out: Vec<Setting>,
    ) {
        let known = |all: &[Setting], effect: &Setting| all.iter().any(|known| known.is(effect));
        for effect in as_good {
            if !known(&self.as_good, &effect) {
                self.as_good.push(effect);
            }
        }
        self.as_good.retain(|effect| !effect.is(won));
        self.not_ruled_out = not_ruled_out;
        self.not_ruled_out.retain(|effect| !effect.is(won) && !known(&self.as_good, effect));
        self.added = Some(won.clone());
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::named;

    /// What simulations found as good is not said again of what residuals do not rule out, and what was named before is as good
    /// as what is named now.
    #[test]
    fn what_is_named_is_nowhere_among_what_is_as_good() {
        let at = |joint: &str| Setting::new(named("joint-wear").unwrap(), Some(joint), &[]);
        let mut round = Round { added: Some(at("A")), as_good: vec![at("B")], ..Round::default() };
        round.add_instead(
            &at("B"),
            vec![at("B"), at("A"), at("C")],
            vec![at("C"), at("D"), at("B")],
        );
        let names = |all: &[Setting]| all.iter().map(Setting::to_string).collect::<Vec<_>>();
        assert_eq!(round.added.as_ref().map(Setting::to_string), Some(at("B").to_string()));
        assert_eq!(names(&round.as_good), names(&[at("A"), at("C")]));
        assert_eq!(names(&round.not_ruled_out), names(&[at("D")]));
    }
}
