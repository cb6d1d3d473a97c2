//! What speaks against a model that leaves no more than noise.

use crate::effects::Setting;

/// What such an effect does.
const IMITATES: &str = "it imitates something that has no name here";

/// What speaks against a model that leaves no more than noise: what still stands out of that, and by how much it would lower
/// the sum of squares in units of noise; or an effect of it that may as well not be there.
#[derive(Clone, Debug)]
pub enum Rest {
    /// An effect beside its own.
    Effect(Setting, f64),
    /// Other values of its own effects for the runs that they were not fitted to.
    Values(f64),
    /// Values of an effect that are no larger than what nobody knows of them.
    Uncertain(Setting),
    /// An effect that makes joints rattle as they do in the recordings and not in the declared machine, and shows in
    /// nothing else.
    Rattles(Setting),
}

impl Rest {
    /// The same in a sentence.
    pub fn words(&self) -> String {
        match self {
            Rest::Effect(effect, gain) => {
                format!(
                    "beside it {effect} would still take {gain:.0} off the sum of squares: {IMITATES}"
                )
            }
            Rest::Values(gain) => format!(
                "other values of it would take {gain:.0} off the sum of squares of the other recordings: {IMITATES}"
            ),
            Rest::Rattles(effect) => format!(
                "{effect} makes joints rattle as they do in the recordings, and shows in nothing else: whatever lifts them off does as well"
            ),
            Rest::Uncertain(effect) => {
                format!(
                    "{effect} is no larger there than what is uncertain of it: there may be none"
                )
            }
        }
    }
}
