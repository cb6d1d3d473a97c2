//! Lists of kinds (effects, laws), printed as a whole or one of them.

use super::table::paragraph;
use serde_json::Value;

/// A list, and how one of its kinds is printed.
pub(in crate::cli) struct Catalogue<K: 'static> {
    /// All kinds.
    pub all: &'static [&'static K],
    /// What is said before all of them.
    pub introduction: &'static str,
    /// A kind for people, and an example of it.
    pub explained: fn(&K) -> String,
    pub example: fn(&K) -> String,
    /// A kind as JSON.
    pub described: fn(&K) -> Value,
}

impl<K> Catalogue<K> {
    /// The text of one kind, or of all of them, as JSON or for people.
    pub fn text(&self, one: Option<&K>, json: bool) -> String {
        match (one, json) {
            (Some(kind), false) => format!("{}\n{}", (self.explained)(kind), (self.example)(kind)),
            (None, false) => {
                let all: Vec<String> = self.all.iter().map(|kind| (self.explained)(kind)).collect();
                format!("{}\n{}", paragraph("", "", self.introduction), all.join("\n"))
            }
            (Some(kind), true) => format!("{:#}\n", (self.described)(kind)),
            (None, true) => {
                let all = self.all.iter().map(|kind| (self.described)(kind));
                format!("{:#}\n", Value::Array(all.collect()))
            }
        }
    }
}
