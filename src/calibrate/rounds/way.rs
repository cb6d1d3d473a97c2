//! A model and how a search came by it.

use super::screen::Scored;
use crate::calibrate::values::settle::{GAIN_PER_VALUE, Settled};
use crate::effects::Setting;

/// One round of the search.
#[derive(Clone, Debug)]
pub struct LegsRound {
    /// Candidates, the best first.
    pub ranking: Vec<Scored>,
    /// What was added, if anything was worth it.
    pub added: Option<Setting>,
    /// What could have been added as well.
    pub as_good: Vec<Setting>,
}

impl LegsRound {
    /// A round in which nothing was worth adding.
    pub fn without_gain(ranking: Vec<Scored>) -> Self {
        Self { ranking, added: None, as_good: Vec::new() }
    }
}

/// A model and how it was come by.
#[derive(Clone, Debug)]
pub struct Way {
    /// The model.
    pub model: Settled,
    /// The rounds that led to it.
    pub rounds: Vec<LegsRound>,
    /// Whether each of its effects removed nearly all that stood above noise before it.
    pub certain: bool,
}

impl Way {
    /// What models of different numbers of values are compared by.
    pub fn cost(&self) -> f64 {
        self.model.misfit + self.price()
    }

    /// What its values have to bring.
    pub fn price(&self) -> f64 {
        let values = self.model.fit.effects.iter().map(|effect| effect.values().count());
        GAIN_PER_VALUE * values.sum::<usize>() as f64
    }

    /// What was added last.
    pub fn added(&self) -> Option<&Setting> {
        self.rounds.last()?.added.as_ref()
    }

    /// Its effects, whatever their order and values.
    pub fn key(effects: &[Setting]) -> Vec<String> {
        let with_values = |effect: &Setting| {
            let values: Vec<&str> = effect.values().map(|(name, _)| name).collect();
            format!("{}: {}", name(effect), values.join(" "))
        };
        let mut names: Vec<String> = effects.iter().map(with_values).collect();
        names.sort();
        names
    }
}

/// An effect in words: `joint-wear at A2`.
pub fn name(effect: &Setting) -> String {
    effect.to_string()
}

/// Effects in words.
pub fn names(effects: &[Setting]) -> String {
    if effects.is_empty() {
        return "the model as declared".to_owned();
    }
    effects.iter().map(name).collect::<Vec<_>>().join(", ")
}
