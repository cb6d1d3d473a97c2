//! What is hidden in a machine of which an angle shows a freedom that nothing drives, and whose joint nobody measures.

use crate::cli_common::Place;
use serde_json::Value;

const RIG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cli_calibrate_mechanism/crane.toml");

/// A camera shows the load's angle in the room; without it the recordings were refused.
#[test]
#[ignore = "a minute and a half"]
fn a_payload_is_found_on_a_load_whose_angle_alone_is_seen() {
    let place = Place::new();
    let hidden = "--set effect.0.kind=payload --set effect.0.body=load --set effect.0.mass_kg=0.2 \
                  --set effect.0.com_x_m=0.25";
    place.good(&format!("record {RIG} --out hidden {hidden} --quiet"));
    place.good(
        "calibrate --rig hidden/rig.toml --data hidden/run-a.csv --validate hidden/run-b.csv --out found --quiet",
    );
    let report: Value = serde_json::from_str(&place.read("found/report.json")).unwrap();
    let summary = &report["summary"];
    assert_eq!(report["verdict"], "explained", "{summary}");
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{summary}");
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["body"]),
        (&"payload".into(), &"load".into()),
        "{summary}"
    );
    for (name, truth) in [("mass_kg", 0.2), ("com_x_m", 0.25)] {
        let value = effects[0]["params"][name]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 2e-3, "{name}: {value}");
    }
}
