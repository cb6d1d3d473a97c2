//! `freeplay calibrate` on mechanisms that a file describes, with the sensors that it has, the real binary.

#[path = "../cli_common/mod.rs"]
mod cli_common;
mod crane;
mod hidden;
mod laws;
mod linkages;
mod refusals;
mod rigs;
mod shaper;

use cli_common::Place;
use serde_json::Value;

/// What is found in recordings of a machine with these effects hidden in it, key by key: the values of as many effects, in the same order,
/// of these kinds and at these places.
pub fn found_of(rig: &str, effects: &[&[(&str, &str)]]) -> Vec<Value> {
    let report = report_of(rig, effects);
    assert_eq!(report["verdict"], "explained", "{}", report["summary"]);
    let found = report["effects"].as_array().unwrap();
    assert_eq!(found.len(), effects.len(), "{}", report["summary"]);
    for (found, hidden) in found.iter().zip(effects) {
        let names =
            |key: &&(&str, &str)| ["kind", "joint", "body", "point", "sensor"].contains(&key.0);
        for (key, value) in hidden.iter().filter(names) {
            assert_eq!(found[key], *value, "{}", report["summary"]);
        }
    }
    found.iter().map(|effect| effect["params"].clone()).collect()
}

/// The report of a calibration of that machine with these effects hidden in its recordings.
pub fn report_of(rig: &str, effects: &[&[(&str, &str)]]) -> Value {
    let place = Place::new();
    let rig = format!("{}/tests/cli_calibrate_mechanism/{rig}.toml", env!("CARGO_MANIFEST_DIR"));
    let keys = effects.iter().enumerate().flat_map(|(i, effect)| {
        effect.iter().map(move |(key, value)| format!(" --set effect.{i}.{key}={value}"))
    });
    place.good(&format!("record {rig} --out hidden --quiet{}", keys.collect::<String>()));
    place.good(
        "calibrate --rig hidden/rig.toml --data hidden/run-a.csv --validate hidden/run-b.csv --out found --quiet",
    );
    serde_json::from_str(&place.read("found/report.json")).unwrap()
}

/// A crank-rocker on a servo, with play in two joints, an encoder on either side and a torque.
pub const FOUR_BAR: &str = r#"name = "four-bar"

[environment]
gravity = [0.0, -9.81]

[ground.points]
O = [0.0, 0.0]
D = [0.16, 0.0]

[[body]]
name = "crank"
mass = 0.2
inertia = 2e-4
center_of_mass = [0.015, 0.0]
points = { O = [0.0, 0.0], A = [0.05, 0.0] }
start = [0.0, 0.0, 1.0]

[[body]]
name = "coupler"
mass = 0.15
inertia = 4e-4
center_of_mass = [0.07, 0.01]
points = { A = [0.0, 0.0], B = [0.15, 0.0] }
start = [0.027, 0.042, 0.4]

[[body]]
name = "rocker"
mass = 0.3
inertia = 6e-4
center_of_mass = [0.06, 0.0]
points = { D = [0.0, 0.0], B = [0.11, 0.0] }
start = [0.16, 0.0, 1.5]

[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "crank.O"

[[joint]]
name = "A"
kind = "revolute"
ring = "crank.A"
journal = "coupler.A"
clearance = 1e-4
bearing_radius = 0.008

[[joint]]
name = "B"
kind = "revolute"
ring = "rocker.B"
journal = "coupler.B"
clearance = 1e-4
bearing_radius = 0.008

[[joint]]
name = "D"
kind = "revolute"
ring = "ground.D"
journal = "rocker.D"

[[drive]]
joint = "O"
kind = "servo"
stiffness = 300.0
damping = 1.2

[[sensor]]
column = "crank_cmd"
quantity = "command"
of = "O"

[[sensor]]
column = "crank"
quantity = "position"
of = "O"
resolution = 2e-5

[[sensor]]
column = "torque"
quantity = "force"
of = "O"
std = 0.003
lowpass = 400.0

[[sensor]]
column = "rocker"
quantity = "position"
of = "D"
resolution = 4e-5
"#;
