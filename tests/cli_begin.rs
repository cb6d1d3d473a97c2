//! What a newcomer begins with: `init`, `schema`, `man`. The real binary.

mod cli_common;

use cli_common::Place;
use freeplay::scenario::Mechanism;
use serde_json::{Map, Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// What a value has against a schema: the parts of JSON Schema that ours uses, at the place `at`.
fn against(schema: &Value, value: &Value, at: &str) -> Vec<String> {
    let mut found = Vec::new();
    if schema == &json!(true) {
        return found;
    }
    let complaint = |what: &str| format!("{at}: {value} {what}");
    for (key, rule) in schema.as_object().into_iter().flatten() {
        match key.as_str() {
            "type" => {
                let kinds: Vec<&str> = match rule {
                    Value::Array(all) => all.iter().filter_map(Value::as_str).collect(),
                    one => one.as_str().into_iter().collect(),
                };
                if !kinds.iter().any(|kind| is(value, kind)) {
                    found.push(complaint(&format!("is not {kinds:?}")));
                }
            }
            "const" if value != rule => found.push(complaint(&format!("is not {rule}"))),
            "enum" if !rule.as_array().unwrap().contains(value) => {
                found.push(complaint("is unknown"))
            }
            "minimum" if value.as_f64() < rule.as_f64() => found.push(complaint("is too small")),
            "maximum" if value.as_f64() > rule.as_f64() => found.push(complaint("is too large")),
            "minItems" if count(value).is_some_and(|n| n < rule.as_u64().unwrap()) => {
                found.push(complaint("is too short"))
            }
            "maxItems" if count(value).is_some_and(|n| n > rule.as_u64().unwrap()) => {
                found.push(complaint("is too long"))
            }
            "items" => found.extend(items(rule, value, at)),
            "required" => {
                let lacks = |key: &&Value| value.get(key.as_str().unwrap()).is_none();
                let keys = rule.as_array().unwrap().iter().filter(|_| value.is_object());
                found.extend(keys.filter(lacks).map(|key| complaint(&format!("lacks {key}"))));
            }
            "properties" | "additionalProperties" => {}
            "anyOf" | "oneOf" => {
                let all: Vec<Vec<String>> =
                    rule.as_array().unwrap().iter().map(|one| against(one, value, at)).collect();
                if all.iter().all(|one| !one.is_empty()) {
                    found.push(complaint(&format!("fits none of {all:?}")));
                }
            }
            "$schema" | "title" | "description" | "default" | "const" | "enum" | "minimum"
            | "maximum" | "minItems" | "maxItems" => {}
            other => panic!("{at}: the schema says `{other}`, which this test does not know"),
        }
    }
    found.extend(members(schema, value, at));
    found
}

/// Number of a list's items.
fn count(value: &Value) -> Option<u64> {
    value.as_array().map(|items| items.len() as u64)
}

/// What a list's items have against the rule of each, or of all.
fn items(rule: &Value, value: &Value, at: &str) -> Vec<String> {
    let items = value.as_array().into_iter().flatten().enumerate();
    let of_item = |(i, item): (usize, &Value)| match rule {
        Value::Array(each) => against(&each[i.min(each.len() - 1)], item, &format!("{at}.{i}")),
        one => against(one, item, &format!("{at}.{i}")),
    };
    items.flat_map(of_item).collect()
}

fn is(value: &Value, kind: &str) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    }
}

fn members(schema: &Value, value: &Value, at: &str) -> Vec<String> {
    let none = Map::new();
    let known = schema.get("properties").and_then(Value::as_object).unwrap_or(&none);
    let mut found = Vec::new();
    for (key, member) in value.as_object().into_iter().flatten() {
        let place = format!("{at}.{key}");
        match (known.get(key), schema.get("additionalProperties")) {
            (Some(rule), _) => found.extend(against(rule, member, &place)),
            (None, Some(Value::Bool(false))) => found.push(format!("{place}: unknown key")),
            (None, Some(rule)) => found.extend(against(rule, member, &place)),
            (None, None) => {}
        }
    }
    found
}

fn toml(text: &str) -> Value {
    let table: toml::Table = text.parse().unwrap();
    serde_json::to_value(table).unwrap()
}

/// Every scenario and rig that comes with the program.
fn shipped(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            shipped(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn the_schema_takes_what_the_reader_takes() {
    let place = Place::new();
    let schema: Value = serde_json::from_str(&place.good("schema")).unwrap();
    let mut files = Vec::new();
    shipped(&Path::new(env!("CARGO_MANIFEST_DIR")).join("assets"), &mut files);
    assert!(files.len() > 20, "{files:?}");
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(against(&schema, &toml(&text), ""), [""; 0], "{}", path.display());
    }
    // Every template with every default filled in, and what it expands to.
    for kind in Mechanism::KINDS {
        let written = place.good(&format!("init {kind}"));
        assert_eq!(against(&schema, &toml(&written), ""), [""; 0], "{kind}");
        place.write("begun.toml", &written);
        let expanded = place.good("expand begun.toml");
        assert_eq!(against(&schema, &toml(&expanded), ""), [""; 0], "{kind} expanded");
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses() {
    let place = Place::new();
    let schema: Value = serde_json::from_str(&place.good("schema")).unwrap();
    let machine = "[mechanism]\nkind = \"3rpr\"\n";
    for (wrong, word) in [
        ("[joints]\nclearence = 1e-4\n", "clearence"),
        ("[contact]\nlaw = \"nativ\"\n", "nativ"),
        ("[simulation]\nduration = \"long\"\n", "duration"),
        ("[motion]\nkind = \"circle\"\nradios = 0.1\n", "radios"),
        ("[[effect]]\nkind = \"payload\"\nmass = 1.0\n", "mass"),
        ("[[effect]]\nkind = \"payload\"\nmass_kg = -1.0\n", "mass_kg"),
        ("[surroundings]\n", "surroundings"),
    ] {
        let text = format!("{machine}{wrong}");
        let found = against(&schema, &toml(&text), "").join("\n");
        assert!(found.contains(word), "{wrong}: the schema says {found:?}");
        place.write("wrong.toml", &text);
        assert_eq!(place.freeplay("check wrong.toml").code, 2, "{wrong}");
    }
}

#[test]
fn what_init_prints_can_be_used_at_once() {
    let place = Place::new();
    for kind in Mechanism::KINDS {
        let scenario = place.good(&format!("init {kind}"));
        assert!(scenario.lines().filter(|line| line.starts_with("# ")).count() > 40, "{kind}");
        place.write("begun.toml", &scenario);
        let done = place.freeplay("check begun.toml --quiet");
        assert_eq!(done.code, 0, "{kind}: {}", done.err);
    }
    // A rig has sensors, and they can be recorded.
    for kind in ["3rpr", "four-bar", "slider-crank"] {
        place.write("rig.toml", &place.good(&format!("init {kind} --rig")));
        let done =
            place.freeplay(&format!("record rig.toml --duration 1 --out rec-{kind} --quiet"));
        assert_eq!(done.code, 0, "{kind}: {}", done.err);
        assert!(place.read(&format!("rec-{kind}/run-a.csv")).lines().count() == 1002, "{kind}");
    }
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let place = Place::new();
    assert!(place.good("man").starts_with(".ie"));
    place.good("man --out man1");
    let pages = cli_common::names(&place.path("man1"));
    for command in ["run", "record", "diff", "calibrate", "sweep"] {
        let page = format!("freeplay-{command}.1");
        assert!(pages.contains(&page), "{pages:?}");
        assert!(place.read(&format!("man1/{page}")).contains(".SH OPTIONS"));
    }
}

/// What is printed to begin with runs shorter, too, and machines without drives move.
#[test]
fn what_init_prints_runs_shorter_and_moves() {
    let place = Place::new();
    for kind in ["3rpr", "pendulum", "double-pendulum"] {
        place.write("k.toml", &place.good(&format!("init {kind}")));
        place.good(&format!("run k.toml --duration 0.1 --quiet --out {kind}"));
    }
    for kind in ["pendulum", "double-pendulum"] {
        let text = place.read(&format!("{kind}/summary.json"));
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert!(json["ideal_peak_platform_acceleration_m_s2"].as_f64().unwrap() > 0.1, "{text}");
    }
}
