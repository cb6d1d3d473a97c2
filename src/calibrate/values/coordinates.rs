//! What a fit chooses: values of effects, or other numbers that say the same.

use super::least_squares::{Free, free, values};
use crate::effects::{FittedBy, Setting};
use crate::mechanism::Mechanism;

/// The numbers that a fit of effects chooses: of each effect its own values, or what it is [fitted by](FittedBy) in their
/// place.
pub struct FitCoordinates<'a> {
    mechanism: &'a Mechanism,
    effects: Vec<Fitted<'a>>,
}

/// An effect, the numbers that a fit of it begins with, their steps and bounds, and what they are if not its values.
struct Fitted<'a> {
    effect: &'a Setting,
    start: Vec<f64>,
    free: Vec<Free>,
    by: Option<FittedBy>,
}

impl<'a> FitCoordinates<'a> {
    /// Those of effects on a machine, from their values on.
    pub fn of(mechanism: &'a Mechanism, effects: &'a [Setting]) -> Self {
        let fitted = |effect: &'a Setting| {
            let own = std::slice::from_ref(effect);
            let other = effect.kind.fitted_by.and_then(|by| {
                let numbers = (by.numbers)(mechanism, effect)?;
                Some((numbers, by))
            });
            match other {
                None => Fitted { effect, start: values(own), free: free(own), by: None },
                Some((numbers, by)) => {
                    let free = numbers.iter().map(|of| Free { step: of.step, bounds: of.bounds });
                    let start = numbers.iter().map(|of| of.start).collect();
                    Fitted { effect, start, free: free.collect(), by: Some(by) }
                }
            }
        };
        Self { mechanism, effects: effects.iter().map(fitted).collect() }
    }

    /// Whether they are the effects' values.
    pub fn are_values(&self) -> bool {
        self.effects.iter().all(|fitted| fitted.by.is_none())
    }

    /// What a fit begins with, in a row.
    pub fn start(&self) -> Vec<f64> {
        self.effects.iter().flat_map(|fitted| fitted.start.iter().copied()).collect()
    }

    /// Steps and bounds of each.
    pub fn free(&self) -> Vec<Free> {
        self.effects.iter().flat_map(|fitted| fitted.free.iter().copied()).collect()
    }

    /// The effects that such numbers stand for.
    pub fn effects(&self, numbers: &[f64]) -> Vec<Setting> {
        let mut rest = numbers;
        let each = self.effects.iter().map(|Fitted { effect, start, by, .. }| {
            let (own, others) = rest.split_at(start.len());
            rest = others;
            match by {
                Some(by) => effect.with(&(by.values)(self.mechanism, effect, own)),
                None => effect.with(own),
            }
        });
        each.collect()
    }
}
