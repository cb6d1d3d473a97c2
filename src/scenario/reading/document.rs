//! The text of a scenario as a tree of values, each of which remembers where it was written.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

use crate::scenario::problem::{Location, Problem};
use crate::scenario::{Law, is_law_key};

/// A TOML text after `--set` overrides, not yet given a meaning.
pub(in crate::scenario) struct Document {
    pub(in crate::scenario) table: Table,
    pub(super) origins: Origins,
}

/// Where each dotted path of a [`Document`] was written.
#[derive(Debug, Clone)]
pub(in crate::scenario) struct Origins {
    source: String,
    places: BTreeMap<String, KeyPlace>,
    /// Bytes of paths that may still be remembered.
    room: usize,
}

/// Most bytes of paths that are remembered; what comes later is said to be where the section around it is. A long
/// key before a long list would otherwise take their product.
const ROOM: usize = 16 << 20;

#[derive(Debug, Clone)]
enum KeyPlace {
    Line(u32),
    Set(String),
}

impl Document {
    /// Parses `text`; `source` is the file's name for messages.
    pub(in crate::scenario) fn parse(text: &str, source: &str) -> Result<Self, Problem> {
        let table = toml::from_str(text).map_err(|error| syntax_problem(&error, text, source))?;
        let mut origins =
            Origins { source: source.to_owned(), places: BTreeMap::new(), room: ROOM };
        // `Table` has no positions, so a second parse collects them; the first saw every error.
        let (positions, _) = DeTable::parse_recoverable(text);
        origins.record_table("", positions.get_ref(), &Lines::of(text));
        Ok(Document { table, origins })
    }

    /// Applies one `PATH=VALUE`.
    ///
    /// Missing sections are made on the way. A number in the path counts the elements of a list
    /// from 0, and the number after the last makes a new one if its `kind` is what is set. A new `kind` starts its section afresh: what the file gave for the old kind (but
    /// not what earlier overrides gave) is dropped, because it means nothing to the new one. A new contact
    /// `law` drops the file's keys that belong to other laws, unless joints have laws of their own, which may
    /// use them. A fixed step drops the file's tolerance, and the other way round.
    pub(in crate::scenario) fn set(&mut self, assignment: &str) -> Result<(), Problem> {
        let (path, value) = assignment.split_once('=').unwrap_or((assignment, ""));
        let path = path.trim();
        let problem = |message: String, help: &str| Problem {
            path: path.to_owned(),
            message,
            help: help.to_owned(),
            location: Location::Set { path: path.to_owned() },
        };
        let keys: Vec<&str> = path.split('.').map(str::trim).collect();
        if !assignment.contains('=') || keys.iter().any(|key| key.is_empty()) {
            return Err(problem(
                format!("`{assignment}` is not an assignment"),
                "write PATH=VALUE, for example joints.clearance=1e-4",
            ));
        }
        let value = parse_value(value.trim()).map_err(|reason| {
            problem(
                format!("the value is not TOML ({reason})"),
                "write a number, a word, or a list such as [0,-9.81]",
            )
        })?;

        let keys = self.by_place(&keys);
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        let path = keys.join(".");
        if let Some(section) = path.strip_suffix(".kind") {
            self.forget_other_kind(section, &value);
        }
        if let Some(section) = path.strip_suffix(".law") {
            self.forget_other_law(section, &value);
        }
        for [one, other] in [["step", "tolerance"], ["tolerance", "step"]] {
            if path.strip_prefix("simulation.") == Some(one) {
                self.forget_beside("simulation", other);
            }
        }
        let mut node = child_of_table(&mut self.table, keys[0], &keys[1..]);
        let mut so_far = keys[0].to_owned();
        self.origins.record_set(&so_far, &path);
        for (i, key) in (1..).zip(&keys[1..]) {
            node = child(node, key, &keys[i + 1..]).map_err(|reason| {
                let mut help = format!("set the whole of it: --set {so_far}=…");
                if so_far == "effect" {
                    help.push_str(", or begin an effect by its kind: --set effect.0.kind=…");
                }
                problem(format!("`{so_far}` {reason}"), &help)
            })?;
            so_far = format!("{so_far}.{key}");
            self.origins.record_set(&so_far, &path);
        }
        *node = value;
        self.origins.replace(&path);
        Ok(())
    }

    /// The same path with places in lists for the names of their elements: `joint.A.clearance` is
    /// `joint.2.clearance`.
    fn by_place(&self, keys: &[&str]) -> Vec<String> {
        let mut node = self.table.get(keys[0]);
        let mut path = vec![keys[0].to_owned()];
        for key in &keys[1..] {
            let place = match node {
                Some(Value::Array(elements)) => named(elements, key),
                _ => None,
            };
            path.push(place.map_or_else(|| (*key).to_owned(), |place| place.to_string()));
            node = match node {
                Some(Value::Array(elements)) => {
                    path.last().and_then(|key| elements.get(key.parse::<usize>().ok()?))
                }
                Some(Value::Table(table)) => table.get(*key),
                _ => None,
            };
        }
        path
    }

    fn forget_other_kind(&mut self, section: &str, new_kind: &Value) {
        let Some(Value::Table(table)) = self.table.get_mut(section) else {
            return;
        };
        if table.get("kind").is_none_or(|kind| kind == new_kind) {
            return;
        }
        self.origins.drop_file_keys(section, table, |_| true);
    }

    /// Drops what a file gave for a key that goes with no other value of its section.
    fn forget_beside(&mut self, section: &str, other: &str) {
        if let Some(Value::Table(table)) = self.table.get_mut(section) {
            self.origins.drop_file_keys(section, table, |key| key == other);
        }
    }

    fn forget_other_law(&mut self, section: &str, law: &Value) {
        let Some(law) = law.as_str().and_then(Law::named) else { return };
        let joints = self.table.get("joint").and_then(Value::as_array);
        let own =
            joints.is_some_and(|joints| joints.iter().any(|joint| joint.get("law").is_some()));
        if section == "contact" && own {
            return;
        }
        let mut keys = section.split('.');
        let root = keys.next().and_then(|key| self.table.get_mut(key));
        let found = keys.fold(root, |node, key| match node? {
            Value::Table(table) => table.get_mut(key),
            Value::Array(elements) => elements.get_mut(key.parse::<usize>().ok()?),
            _ => None,
        });
        let Some(Value::Table(table)) = found else { return };
        self.origins.drop_file_keys(section, table, |key| is_law_key(key) && !law.takes(key));
    }
}

impl Origins {
    /// Where `path` was written, or else the nearest section around it that was.
    pub(in crate::scenario) fn locate(&self, path: &str) -> Location {
        let mut around = path;
        loop {
            match self.places.get(around) {
                Some(KeyPlace::Line(line)) => return self.in_file(Some(*line)),
                // A section that an override only passed through says nothing of its other keys.
                Some(KeyPlace::Set(set)) if around == path || around == set => {
                    return Location::Set { path: set.clone() };
                }
                _ => {}
            }
            match around.rsplit_once('.') {
                Some((parent, _)) => around = parent,
                None => return self.in_file(None),
            }
        }
    }

    /// A path in a section that an override gave, if one did.
    pub(in crate::scenario) fn set_in(&self, section: &str) -> Option<&str> {
        let inside =
            |path: &str| path.strip_prefix(section).is_some_and(|rest| rest.starts_with('.'));
        let given = self.places.iter().filter(|(_, place)| matches!(place, KeyPlace::Set(_)));
        given.map(|(path, _)| path.as_str()).find(|path| inside(path))
    }

    /// Whether something was written at `path`.
    pub(in crate::scenario) fn has(&self, path: &str) -> bool {
        self.places.contains_key(path)
    }

    /// Takes keys out of a section, but not those that an override gave.
    fn drop_file_keys(&mut self, section: &str, table: &mut Table, dropped: impl Fn(&str) -> bool) {
        table.retain(|key, _| {
            let path = format!("{section}.{key}");
            let keep = !dropped(key) || matches!(self.places.get(&path), Some(KeyPlace::Set(_)));
            if !keep {
                self.forget(&path);
            }
            keep
        });
    }

    fn in_file(&self, line: Option<u32>) -> Location {
        Location::File { name: self.source.clone(), line, column: None }
    }

    fn record_table(&mut self, prefix: &str, table: &DeTable<'_>, lines: &Lines) {
        for (key, value) in table {
            self.record(prefix, key.get_ref(), lines.number(key.span().start), value, lines);
        }
    }

    fn record(
        &mut self,
        prefix: &str,
        key: &str,
        line: u32,
        value: &Spanned<DeValue<'_>>,
        lines: &Lines,
    ) {
        let Some(room) = self.room.checked_sub(prefix.len() + 1 + key.len()) else { return };
        self.room = room;
        let path = join(prefix, key);
        self.places.insert(path.clone(), KeyPlace::Line(line));
        match value.get_ref() {
            DeValue::Table(table) => self.record_table(&path, table, lines),
            DeValue::Array(elements) => {
                for (i, element) in elements.iter().enumerate() {
                    let line = lines.number(element.span().start);
                    self.record(&path, &i.to_string(), line, element, lines);
                }
            }
            _ => {}
        }
    }

    /// `path` was reached by the override of `set`; a place it already has stays.
    fn record_set(&mut self, path: &str, set: &str) {
        self.places.entry(path.to_owned()).or_insert_with(|| KeyPlace::Set(set.to_owned()));
    }

    /// `path` and all below it now come from an override.
    fn replace(&mut self, path: &str) {
        self.forget(path);
        self.places.insert(path.to_owned(), KeyPlace::Set(path.to_owned()));
    }

    fn forget(&mut self, path: &str) {
        let below = format!("{path}.");
        self.places.retain(|place, _| place != path && !place.starts_with(&below));
    }
}

/// `prefix.key`, or `key` at the top.
pub(super) fn join(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// What is under `key`; if nothing is, a list or a section, by what is sought in it, `rest`.
fn child_of_table<'a>(table: &'a mut Table, key: &str, rest: &[&str]) -> &'a mut Value {
    let list = rest.first().is_some_and(|key| key.parse::<usize>().is_ok());
    table
        .entry(key)
        .or_insert_with(|| if list { Value::Array(Vec::new()) } else { Value::Table(Table::new()) })
}

fn child<'a>(node: &'a mut Value, key: &str, rest: &[&str]) -> Result<&'a mut Value, String> {
    match node {
        Value::Table(table) => Ok(child_of_table(table, key, rest)),
        Value::Array(elements) => {
            let count = elements.len();
            if rest == ["kind"] && key.parse() == Ok(count) {
                elements.push(Value::Table(Table::new()));
            }
            key.parse()
                .ok()
                .and_then(|i: usize| elements.get_mut(i))
                .ok_or_else(|| format!("is a list of {count}, counted from 0: it has no {key}"))
        }
        other => Err(format!("is one {}, neither section nor list", other.type_str())),
    }
}

/// The element of a list of sections that is called `name`, or is about the joint of that name.
fn named(elements: &[Value], name: &str) -> Option<usize> {
    let calls = |element: &Value| {
        let key = |key| element.get(key).and_then(Value::as_str);
        key("name").or_else(|| key("joint")).or_else(|| key("column")) == Some(name)
    };
    elements.iter().position(calls)
}

/// A bare word is a string; what begins like a list, a table or a quoted string must be one.
fn parse_value(text: &str) -> Result<Value, String> {
    match text.parse() {
        Ok(value) => Ok(value),
        Err(_) if !text.is_empty() && !text.starts_with(['[', '{', '"', '\'']) => {
            Ok(Value::String(text.to_owned()))
        }
        Err(error) => Err(one_line(error.message())),
    }
}

/// Tables of which a file may have many, and their headers.
const LISTS: [&str; 8] = ["body", "joint", "drive", "spring", "stop", "output", "sensor", "effect"];

fn syntax_problem(error: &toml::de::Error, text: &str, source: &str) -> Problem {
    let position = error.span().map(|span| line_and_column(text, span.start));
    let line = position.and_then(|(line, _)| text.lines().nth(line as usize - 1));
    let name = line.and_then(|line| line.trim().strip_prefix('[')?.split(']').next());
    let help = match name.filter(|name| LISTS.contains(name)) {
        Some(name) => format!("there may be many of them: write [[{name}]]"),
        None => "the file must be TOML: `key = value` lines under `[section]` headers".to_owned(),
    };
    Problem {
        path: String::new(),
        message: one_line(error.message()),
        help,
        location: Location::File {
            name: source.to_owned(),
            line: position.map(|(line, _)| line),
            column: position.map(|(_, column)| column),
        },
    }
}

fn one_line(message: &str) -> String {
    message.trim().replace('\n', ", ")
}

/// Where the lines of a text begin: a file of many keys is not counted through once for each.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(end, _)| end + 1).collect())
    }

    /// Line of a byte offset, counted from 1.
    fn number(&self, offset: usize) -> u32 {
        self.0.partition_point(|start| *start <= offset) as u32 + 1
    }
}

/// Line and column of a byte offset, both counted from 1.
fn line_and_column(text: &str, offset: usize) -> (u32, u32) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.matches('\n').count() as u32 + 1, before[line_start..].chars().count() as u32 + 1)
}
