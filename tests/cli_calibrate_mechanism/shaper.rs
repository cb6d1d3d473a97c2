//! What is hidden in a machine whose bodies slide: a ram that does not turn.

use crate::cli_common::Place;
use serde_json::Value;

const RIG: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cli_calibrate_mechanism/quick-return.toml");

/// Where it sits on the ram nothing tells: rounding sent it to the end of what makes sense, and it was struck off for that.
#[test]
#[ignore = "two minutes"]
fn a_payload_is_found_on_a_ram_that_does_not_turn() {
    let place = Place::new();
    let hidden =
        "--set effect.0.kind=payload --set effect.0.body=ram --set effect.0.mass_kg=0.2 --quiet";
    place.good(&format!("record {RIG} --out hidden {hidden}"));
    place.good(
        "calibrate --rig hidden/rig.toml --data hidden/run-a.csv --validate hidden/run-b.csv --out found --quiet",
    );
    let report: Value = serde_json::from_str(&place.read("found/report.json")).unwrap();
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(
        (&report["verdict"], effects.len()),
        (&"explained".into(), 1),
        "{}",
        report["summary"]
    );
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["body"]),
        (&"payload".into(), &"ram".into()),
        "{}",
        report["summary"]
    );
    let values = &effects[0]["params"];
    let mass = values["mass_kg"]["value"].as_f64().unwrap();
    assert!((mass - 0.2).abs() < 1e-3, "{values}");
    assert!(values.get("com_x_m").is_none() && values.get("com_y_m").is_none(), "{values}");
}
