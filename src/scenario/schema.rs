//! The schema of scenario files (JSON Schema, draft 7: what TOML editors read), made of the types that the reader reads
//! into; effects and contact laws come from their own lists.

use super::sections::{
    Body, Columns, ContactKeys, Drive, Environment, Ground, Joint, JointDrive, JointPath, Joints,
    Legs, Mechanism, Motion, Native, Output, Sensor, Sensors, Simulation, Spring, Stop,
};
use crate::effects::{self, Kind, Targets};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

/// The schema.
///
/// ```
/// use freeplay::scenario::schema;
///
/// let schema = schema();
/// assert_eq!(schema["title"], "freeplay scenario");
/// assert_eq!(schema["properties"]["seed"]["default"], 1);
/// ```
pub fn schema() -> Value {
    let mut generator = SchemaSettings::draft07()
        .with(|settings| settings.inline_subschemas = true)
        .into_generator();
    let mut properties = Map::new();
    let mut section = |name: &str, about: &str, value: Value| {
        let mut value = value;
        if let (Some(object), false) = (value.as_object_mut(), about.is_empty()) {
            object.insert("description".to_owned(), about.into());
        }
        properties.insert(name.to_owned(), value);
    };
    section(
        "name",
        "What the results are called.",
        json!({"type": "string", "default": "default"}),
    );
    let seed = json!({"type": "integer", "minimum": 0, "default": 1});
    section("seed", "Seed of all random numbers.", seed);
    let g = &mut generator;
    section("mechanism", "", of::<Mechanism>(g));
    section("legs", "", of::<Legs>(g));
    section("joints", "", of::<Joints>(g));
    section("contact", "", of::<ContactKeys>(g));
    section("native", "", of::<Native>(g));
    section("drive", "", either(of::<Drive>(g), list(of::<JointDrive>(g))));
    section("environment", "", of::<Environment>(g));
    section("sensors", "", of::<Sensors>(g));
    section("columns", "", of::<Columns>(g));
    section("motion", "", motion(g));
    section("simulation", "", of::<Simulation>(g));
    let effects: Vec<Value> = effects::ALL.iter().map(|kind| effect(kind)).collect();
    let what =
        "What acts on the machine beside what is declared; `freeplay effects` explains them.";
    section("effect", what, list(json!({"oneOf": effects})));
    section("ground", "", of::<Ground>(g));
    section("body", "", list(of::<Body>(g)));
    section("joint", "", list(of::<Joint>(g)));
    section("spring", "", list(of::<Spring>(g)));
    section("stop", "", list(of::<Stop>(g)));
    section("output", "", list(of::<Output>(g)));
    section("sensor", "", list(of::<Sensor>(g)));
    let mut whole = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "freeplay scenario",
        "description": "A mechanism, its motion and a simulation. SI units: m, kg, s, N, rad.",
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    plain(&mut whole);
    whole
}

/// The schema of a type.
fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Value {
    let mut schema = Value::from(generator.subschema_for::<T>());
    if let Some(object) = schema.as_object_mut() {
        object.remove("$schema");
    }
    schema
}

fn list(items: Value) -> Value {
    json!({"type": "array", "items": items})
}

fn either(one: Value, other: Value) -> Value {
    json!({"anyOf": [one, other]})
}

/// `[motion]` of a body, a point, a template's path (a circle where no kind is said) or one joint; `[[motion]]` of joints.
fn motion(generator: &mut SchemaGenerator) -> Value {
    let mut path = of::<Motion>(generator);
    let name = |about: &str| json!({"type": "string", "description": about});
    for variant in variants(&mut path) {
        variant.insert_property("body", name("The body that it moves, in a described machine."));
        variant.insert_property("point", name("The point that it moves, `body.point`."));
        if variant.is_kind("circle") {
            variant.need_not("kind");
        }
    }
    let mut joint = of::<JointPath>(generator);
    for variant in variants(&mut joint) {
        variant.insert_property("joint", name("The joint that it moves."));
    }
    let mut joints = joint.clone();
    for variant in variants(&mut joints) {
        variant.need("joint");
    }
    json!({"anyOf": [path, joint, list(joints)]})
}

/// What [`variants`] are.
type Object = Map<String, Value>;

/// The alternatives of a tagged type.
fn variants(schema: &mut Value) -> impl Iterator<Item = &mut Object> {
    let all = schema.get_mut("oneOf").and_then(Value::as_array_mut);
    all.into_iter().flatten().filter_map(Value::as_object_mut)
}

/// What is changed of a table's schema.
trait SchemaChange {
    fn insert_property(&mut self, key: &str, schema: Value);
    fn is_kind(&self, kind: &str) -> bool;
    fn need(&mut self, key: &str);
    fn need_not(&mut self, key: &str);
}

impl SchemaChange for Object {
    fn insert_property(&mut self, key: &str, schema: Value) {
        if let Some(properties) = self.get_mut("properties").and_then(Value::as_object_mut) {
            properties.insert(key.to_owned(), schema);
        }
    }

    fn is_kind(&self, kind: &str) -> bool {
        let said = self.get("properties").and_then(|p| p.pointer("/kind/const"));
        said.and_then(Value::as_str) == Some(kind)
    }

    fn need(&mut self, key: &str) {
        if let Some(required) = self.get_mut("required").and_then(Value::as_array_mut) {
            required.push(key.into());
        }
    }

    fn need_not(&mut self, key: &str) {
        if let Some(required) = self.get_mut("required").and_then(Value::as_array_mut) {
            required.retain(|known| known != key);
        }
    }
}

/// An `[[effect]]` of a kind.
fn effect(kind: &Kind) -> Value {
    let mut properties = Map::new();
    properties.insert("kind".to_owned(), json!({"const": kind.name}));
    if let Some(key) = kind.targets.key() {
        let names = json!({"type": "array", "items": {"type": "string"}, "minItems": 1});
        let one = json!({"type": "string"});
        let value = match kind.targets {
            Targets::Body | Targets::Point => one,
            _ => json!({"anyOf": [one, names]}),
        };
        properties.insert(key.to_owned(), value);
    }
    for parameter in kind.parameters {
        let [low, high] = parameter.bounds;
        let unit = if parameter.unit.is_empty() { "1" } else { parameter.unit };
        let mut schema = json!({
            "type": "number",
            "description": format!("{} ({unit})", parameter.about),
        });
        for (key, bound) in [("minimum", low), ("maximum", high)] {
            if bound.is_finite() {
                schema[key] = bound.into();
            }
        }
        if let Some(default) = parameter.default {
            schema["default"] = default.into();
        }
        properties.insert(parameter.name.to_owned(), schema);
    }
    let target = kind.targets.key().filter(|_| kind.targets.required());
    let required: Vec<&str> = ["kind"].into_iter().chain(target).collect();
    // What an effect without a name does stands in tables.
    let open = kind.name == effects::UNNAMED;
    json!({
        "type": "object",
        "description": kind.summary,
        "properties": properties,
        "required": required,
        "additionalProperties": open,
    })
}

/// Takes out of descriptions what only the program's own documentation can follow, and of numbers what is no key of the
/// standard.
fn plain(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            if object.get("type").is_some_and(|kind| kind.is_string() || kind.is_array()) {
                object.remove("format");
            }
            if let Some(Value::String(text)) = object.get_mut("description") {
                *text = without_links(text);
            }
            object.values_mut().for_each(plain);
        }
        Value::Array(list) => list.iter_mut().for_each(plain),
        _ => {}
    }
}

/// "[`Quintic`](path)" and "[`Quintic`]" as "`Quintic`", lines joined.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some(start) = rest.find("[`") {
        let Some(end) = rest[start..].find("`]").map(|end| start + end) else { break };
        plain += &rest[..start];
        plain += &rest[start + 1..=end];
        rest = &rest[end + 2..];
        if rest.starts_with('(') {
            rest = rest.split_once(')').map_or("", |(_, after)| after);
        }
    }
    (plain + rest).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_of_the_documentation_become_words() {
        let text = "see [`Drive::sampled`](crate::x) and\n[`On`]: done";
        assert_eq!(without_links(text), "see `Drive::sampled` and `On`: done");
    }

    #[test]
    fn every_section_has_its_keys_with_words() {
        let schema = schema();
        let clearance = schema.pointer("/properties/joints/properties/clearance").expect("a key");
        let about = clearance["description"].as_str().expect("words");
        assert!(about.starts_with("Clearance c of each joint, m"), "{about}");
        assert_eq!(schema.pointer("/properties/joints/additionalProperties"), Some(&json!(false)));
        let effects = schema.pointer("/properties/effect/items/oneOf").and_then(Value::as_array);
        assert_eq!(effects.map(Vec::len), Some(effects::ALL.len()));
    }
}
