//! Effects in words.

use crate::effects::Setting;

/// An effect in words: its name, and where it is.
pub fn name(effect: &Setting) -> String {
    effect.to_string()
}

/// Effects in words.
pub fn names(effects: &[Setting]) -> String {
    effects.iter().map(name).collect::<Vec<_>>().join(" and ")
}
