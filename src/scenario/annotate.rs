//! A scenario as a file to begin with: every key with what it means, from the schema of the reader.

use super::Scenario;
use super::schema::schema;
use serde_json::{Map, Value};

/// Columns of a line of comments.
const WIDTH: usize = 96;

/// The text of a scenario with every default filled in, each section and key with its meaning above it, and the optional
/// keys that it does not have as comments.
///
/// ```
/// use freeplay::scenario::{Scenario, annotated};
///
/// let scenario = Scenario::load(None, &[])?;
/// let file = annotated(&scenario);
/// assert!(file.lines().filter(|line| line.starts_with('#')).count() > 50, "every key with what it means");
/// assert_eq!(Scenario::from_text(&file, "init.toml", &[])?.hash(), scenario.hash());
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
pub fn annotated(scenario: &Scenario) -> String {
    let schema = schema();
    let text = scenario.to_toml();
    // A table from its header to the line before the next one; the keys above all headers first.
    let mut tables: Vec<Vec<&str>> = vec![Vec::new()];
    // A start left out that follows from the duration goes on following it.
    let follows =
        |line: &str| scenario.simulation.settle.is_none() && line.starts_with("settle = ");
    for line in text.lines().filter(|line| !line.is_empty() && !follows(line)) {
        if line.starts_with('[') {
            tables.push(Vec::new());
        }
        if let Some(table) = tables.last_mut() {
            table.push(line);
        }
    }
    let mut said: Vec<String> = Vec::new();
    let mut annotated = comment(
        "A scenario of freeplay. SI units: m, kg, s, N, rad. `freeplay check FILE` says what is wrong with it.",
    );
    annotated += "#:schema freeplay.schema.json\n";
    for lines in tables {
        annotated += &table(&schema, &lines, &mut said);
    }
    annotated
}

/// One table. What the tables of a list have in common is `said` at the first.
fn table(schema: &Value, lines: &[&str], said: &mut Vec<String>) -> String {
    let header = lines.first().filter(|line| line.starts_with('[')).copied();
    let name = header.unwrap_or_default().trim_matches(['[', ']']);
    let kind = lines.iter().find_map(|line| line.strip_prefix("kind = "));
    let kind = kind.map(|kind| kind.trim_matches('"'));
    let first = |what: &str, said: &mut Vec<String>| {
        let new = !said.iter().any(|known| known == what);
        said.push(what.to_owned());
        new
    };
    let about = if name.is_empty() { Some(schema) } else { section(schema, name) };
    let alternative = about.and_then(|about| alternative(about, kind));
    let mut text = String::new();
    if let Some(header) = header {
        text += "\n";
        let words = about.and_then(description).or(alternative.and_then(description));
        if first(name, said) {
            text += &words.map_or(String::new(), comment);
        }
        text += &format!("{header}\n");
    }
    let keys = alternative.and_then(properties);
    let of = format!("{name}/{}", kind.unwrap_or_default());
    for line in lines.iter().filter(|line| !line.starts_with('[')) {
        let key = line.split(" = ").next().unwrap_or_default();
        let words = keys.and_then(|keys| description(keys.get(key)?));
        if first(&format!("{of}/{key}"), said) {
            text += &words.map_or(String::new(), comment);
        }
        text += &format!("{line}\n");
    }
    if name.is_empty() || !first(&of, said) {
        return text;
    }
    let absent = |key: &str| !lines.iter().any(|line| line.starts_with(&format!("{key} = ")));
    for (key, about) in keys.into_iter().flatten().filter(|(key, _)| absent(key)) {
        // Tables of their own are no keys to be uncommented.
        if let Some(words) = description(about).filter(|_| properties(about).is_none()) {
            text += &comment(&format!("{key} = … : {words}"));
        }
    }
    text
}

/// The schema of a section, or of one in it (`drive.sampled`), by its name in a header.
fn section<'a>(schema: &'a Value, name: &str) -> Option<&'a Value> {
    let mut about = schema;
    for part in name.split('.') {
        about = properties(alternative(about, None)?)?.get(part)?;
    }
    Some(about)
}

/// What a table of this kind is, of the alternatives of a section; the table itself where there are none.
fn alternative<'a>(about: &'a Value, kind: Option<&str>) -> Option<&'a Value> {
    if let Some(keys) = properties(about) {
        let of = keys.get("kind").and_then(|known| known.get("const")).and_then(Value::as_str);
        return (of.is_none() || of == kind).then_some(about);
    }
    if let Some(items) = about.get("items") {
        return alternative(items, kind);
    }
    let all = ["anyOf", "oneOf"].into_iter().filter_map(|key| about.get(key)?.as_array()).flatten();
    all.filter_map(|one| alternative(one, kind)).next()
}

fn properties(about: &Value) -> Option<&Map<String, Value>> {
    about.get("properties")?.as_object()
}

fn description(about: &Value) -> Option<&str> {
    about.get("description")?.as_str()
}

fn comment(words: &str) -> String {
    let lines = textwrap::wrap(words, textwrap::Options::new(WIDTH).break_words(false));
    lines.iter().map(|line| format!("# {line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_annotated_scenario_is_the_same_scenario() {
        for kind in crate::scenario::Mechanism::KINDS {
            let text = format!("[mechanism]\nkind = \"{kind}\"\n");
            let plain = Scenario::from_text(&text, "plain.toml", &[]).expect("a template");
            let annotated = annotated(&plain);
            let again = Scenario::from_text(&annotated, "annotated.toml", &[]);
            assert_eq!(again.expect(kind).to_toml(), plain.to_toml(), "{kind}");
            assert!(annotated.lines().all(|line| line.chars().count() <= 120), "{annotated}");
            // Every number has a line that says what it is.
            let keys = annotated.lines().filter(|line| !line.starts_with(['#', '['])).count();
            let comments = annotated.lines().filter(|line| line.starts_with('#')).count();
            assert!(comments > keys / 2, "{kind}: {comments} comments for {keys} keys");
        }
    }
}
