//! Hits under another law of contact than declared are found, with what they return.

use crate::cli_common::Place;
use serde_json::Value;

/// A pendulum with much play, of which a tracker sees the journal.
const PENDULUM: &str = r#"name = "pendulum"

[environment]
gravity = [0.0, -9.81]

[ground.points]
O = [0.0, 0.0]

[[body]]
name = "arm"
mass = 0.5
inertia = 0.003
center_of_mass = [0.15, 0.0]
points = { O = [0.0, 0.0] }
start = [0.0, 0.0, 1.2]

[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "arm.O"
clearance = 5e-4
bearing_radius = 0.008
friction = 0.08

[[sensor]]
column = "q"
quantity = "position"
of = "O"
std = 1e-5

[[sensor]]
column = "x"
quantity = "x"
of = "arm.O"
std = 2e-6

[[sensor]]
column = "y"
quantity = "y"
of = "arm.O"
std = 2e-6
"#;

/// It is let go in the middle of its play, falls on its ring and bounces. The bar is a hundredth of what is returned: where a hit
/// comes a little later all after it do, and values near by explain a recording as well as the right one.
#[test]
fn a_pendulum_that_bounces_as_another_law_has_it_is_explained() {
    let place = Place::new();
    place.write("rig.toml", PENDULUM);
    let law = "--set contact.law=flores --set contact.restitution=0.63";
    place.good(&format!("record rig.toml --duration 1.2 {law} --out made --quiet"));
    let line = "calibrate --rig rig.toml --data made/run-a.csv --validate made/run-b.csv --json --quiet --out r";
    let report: Value = serde_json::from_str(&place.good(line)).unwrap();
    assert_eq!(report["verdict"], "explained", "{}", report["summary"]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!((effects.len(), &effects[0]["kind"]), (1, &"contact-law".into()), "{effects:?}");
    let found = effects[0]["params"]["restitution"]["value"].as_f64().unwrap();
    assert!((found / 0.63 - 1.0).abs() < 0.01, "{found}");
}
