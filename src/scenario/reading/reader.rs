//! From the tree of values to typed sections, collecting what does not fit.

use serde::de::DeserializeOwned;
use serde_path_to_error::{Path, Segment};
use toml::{Table, Value};

use super::document::{Origins, join};
use crate::measure::spelling::nearest;
use crate::scenario::problem::Problem;

/// Problems after which the rest of a section is not looked at: a file with more of them is none of ours.
const MOST: usize = 20;

/// Reads sections one by one and keeps all their problems.
pub(in crate::scenario) struct Reader<'a> {
    origins: &'a Origins,
    pub(super) problems: Vec<Problem>,
}

impl<'a> Reader<'a> {
    pub(in crate::scenario) fn new(origins: &'a Origins) -> Self {
        Reader { origins, problems: Vec::new() }
    }

    /// Reads `table` as a `T`. serde stops at its first complaint, so the key it complained about
    /// is taken out and the rest read again, until nothing is left to complain about.
    pub(in crate::scenario) fn read<T: DeserializeOwned + Default>(
        &mut self,
        section: &str,
        mut table: Table,
    ) -> T {
        loop {
            let error = match serde_path_to_error::deserialize(Value::Table(table.clone())) {
                Ok(value) => return value,
                Err(error) => error,
            };
            let keys = dotted(error.path());
            let path = join(section, &keys);
            let (message, help) = explain(&path, error.inner().message());
            self.complain(&path, message, help);
            let first = keys.split('.').next().unwrap_or_default();
            if table.remove(first).is_none() || self.problems.len() >= MOST {
                return T::default();
            }
        }
    }

    /// Reads `table` as a `T` without defaults; `None` after a complaint.
    pub(super) fn required<T: DeserializeOwned>(
        &mut self,
        section: &str,
        table: Table,
    ) -> Option<T> {
        match serde_path_to_error::deserialize(Value::Table(table)) {
            Ok(value) => Some(value),
            Err(error) => {
                let keys = dotted(error.path());
                let message = error.inner().message();
                match message.strip_prefix("missing field `") {
                    Some(field) => {
                        let key = field.split('`').next().unwrap_or_default();
                        let help = format!("write {key} = …");
                        self.complain(&join(section, key), "is missing".to_owned(), help);
                    }
                    None => {
                        let path = join(section, &keys);
                        let (message, help) = explain(&path, message);
                        self.complain(&path, message, help);
                    }
                }
                None
            }
        }
    }

    /// Takes `kind` out of a section; `None` when it is not there or not one of `known`.
    pub(super) fn take_kind(
        &mut self,
        section: &str,
        table: &mut Table,
        known: &[&'static str],
    ) -> Option<&'static str> {
        self.take_kind_of(section, section, table, known)
    }

    /// The same of a table at `path`, which is a kind of `what`.
    pub(super) fn take_kind_of(
        &mut self,
        path: &str,
        what: &str,
        table: &mut Table,
        known: &[&'static str],
    ) -> Option<&'static str> {
        let kind = table.remove("kind")?;
        let found = known.iter().find(|name| kind.as_str() == Some(name));
        if found.is_none() {
            self.complain(
                &format!("{path}.kind"),
                format!("{kind} is not a kind of {what}"),
                suggest(kind.as_str().unwrap_or_default(), known),
            );
        }
        found.copied()
    }

    pub(in crate::scenario) fn complain(&mut self, path: &str, message: String, help: String) {
        self.problems.push(Problem {
            path: path.to_owned(),
            message,
            help,
            location: self.origins.locate(path),
        });
    }
}

/// `terms[0].frequency` of serde as `terms.0.frequency`.
fn dotted(path: &Path) -> String {
    path.iter().fold(String::new(), |so_far, segment| {
        let key = match segment {
            Segment::Seq { index } => index.to_string(),
            Segment::Map { key } => key.clone(),
            // The name of a value such as `law = "nativ"` is no part of the key's path.
            Segment::Enum { .. } | Segment::Unknown => return so_far,
        };
        join(&so_far, &key)
    })
}

/// serde's message as (what is wrong, what would be right) in the words of a user.
fn explain(path: &str, message: &str) -> (String, String) {
    if message.starts_with("unknown field ") || message.starts_with("unknown variant ") {
        // "unknown field `a`, expected one of `b`, `c`": the first quoted word is the stranger.
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        if let [stranger, known @ ..] = quoted.as_slice() {
            let message = if message.starts_with("unknown field ") {
                format!("unknown key `{path}`")
            } else {
                format!("unknown value \"{stranger}\"")
            };
            return (message, suggest(stranger, known));
        }
    }
    match message.split_once(", expected ") {
        Some((found, expected)) => {
            let found = found
                .replace("invalid length ", "a list of ")
                .replace("invalid type: ", "")
                .replace("invalid value: ", "");
            let found = if found == "sequence" { "a list" } else { &found };
            let mut help = format!("expected {}", in_words(expected));
            // `[[joints]]` for `[[joint]]`, which is a list.
            if found == "a list" && path == "joints" {
                help.push_str(", the defaults of all joints; one joint is a [[joint]]");
            }
            (format!("found {found}"), help)
        }
        None => (message.to_owned(), "see the built-in default scenario".to_owned()),
    }
}

/// The nearest of the known names, or all of them when none is near.
fn suggest(stranger: &str, known: &[&str]) -> String {
    match nearest(stranger, known) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("known here: {}", known.join(", ")),
    }
}

fn in_words(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "u64" => "a whole number, 0 or more",
        "a boolean" => "true or false",
        "a string" => "a string, in quotes",
        "a sequence" => "a list",
        "fewer elements in array" => "fewer elements",
        "a map" => "a section with keys",
        _ if expected.starts_with("struct ") => "a table with keys",
        _ => expected,
    }
}
