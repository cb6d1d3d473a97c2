//! Values that TOML allows and nothing here can use.

use super::document::{Document, join};
use crate::measure::shown::is_hidden;
use toml::{Table, Value};

/// Most values of one text that are complained about one by one.
const TOLD: usize = 50;

/// The part of a path that leads into a table or a list.
enum PathStep<'a> {
    Key(&'a str),
    Place(usize),
}

/// Paths, what is wrong there, and what would be right.
type Unusable = Vec<(String, String, &'static str)>;

impl Document {
    /// Values that TOML allows and nothing here can use: numbers that are infinite or none, texts that act on what
    /// shows them. The path, what is wrong and what would be right, of the first ones.
    pub(super) fn unusable(&self) -> Vec<(String, String, &'static str)> {
        let mut found = Vec::new();
        unusable_in_table(&self.table, &mut Vec::new(), &mut found);
        found
    }
}

fn unusable_in_table<'a>(table: &'a Table, way: &mut Vec<PathStep<'a>>, found: &mut Unusable) {
    for (key, value) in table {
        way.push(PathStep::Key(key));
        if key.contains(is_hidden) {
            complain_of_text(key, way, found);
        }
        unusable_in(value, way, found);
        way.pop();
    }
}

fn unusable_in<'a>(value: &'a Value, way: &mut Vec<PathStep<'a>>, found: &mut Unusable) {
    match value {
        Value::Float(number) if !number.is_finite() && found.len() < TOLD => {
            found.push((path_of(way), format!("is {number}"), "expected a finite number"));
        }
        Value::String(text) if text.contains(is_hidden) => complain_of_text(text, way, found),
        Value::Table(table) => unusable_in_table(table, way, found),
        Value::Array(elements) => {
            for (i, value) in elements.iter().enumerate() {
                way.push(PathStep::Place(i));
                unusable_in(value, way, found);
                way.pop();
            }
        }
        _ => {}
    }
}

fn complain_of_text(text: &str, way: &[PathStep<'_>], found: &mut Unusable) {
    if let Some(c) = text.chars().find(|c| is_hidden(*c))
        && found.len() < TOLD
    {
        let message = format!("holds the character U+{:04X}, which does not show", u32::from(c));
        let help = "expected text in one line, without control characters";
        found.push((path_of(way), message, help));
    }
}

/// Only what is complained about has its path written.
fn path_of(way: &[PathStep<'_>]) -> String {
    way.iter().fold(String::new(), |path, step| match step {
        PathStep::Key(key) => join(&path, key),
        PathStep::Place(place) => join(&path, &place.to_string()),
    })
}
