//! Recordings that lack some of what a 3-RPR's instruments measure are calibrated with what they have, and those
//! that lack nothing by the same method, through the file that the template stands for.

use crate::cli_common::Place;
use crate::recording::Table;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn file(rig: usize, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/rigs/rig-{rig}")).join(name)
}

fn table(rig: usize, name: &str) -> Table {
    let text = std::fs::read_to_string(file(rig, name)).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    Table { header: lines.next().unwrap(), rows: lines.collect() }
}

/// The report of a rig whose recordings lack these columns.
fn without(rig: usize, columns: &[&str]) -> Value {
    let place = Place::new();
    for run in ["run-a.csv", "run-b.csv"] {
        let mut table = table(rig, run);
        table.drop(columns);
        place.write(run, &table.text());
    }
    let text = place.good(&format!(
        "calibrate --rig {} --data run-a.csv --validate run-b.csv --out found --json --quiet",
        file(rig, "rig.toml").display()
    ));
    // What was found is a scenario like any other, and predicts what the recordings hold.
    place.good("predict found/calibrated.toml --data run-b.csv --out predicted --quiet");
    serde_json::from_str(&text).unwrap()
}

/// The report of a rig with all of its columns, described body by body.
fn described(rig: usize) -> Value {
    let place = Place::new();
    let rig_file = file(rig, "rig.toml");
    place.write("rig.toml", &place.good(&format!("expand {}", rig_file.display())));
    let [a, b] = ["run-a.csv", "run-b.csv"].map(|run| file(rig, run).display().to_string());
    let text = place.good(&format!(
        "calibrate --rig rig.toml --data {a} --validate {b} --out found --json --quiet"
    ));
    serde_json::from_str(&text).unwrap()
}

/// Name and joint of the one effect that explains, and its values by name.
fn only(report: &Value) -> (String, String, impl Fn(&str) -> f64) {
    assert_eq!(report["verdict"], "explained", "{}", report["residuals"]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{}", report["summary"]);
    let effect = effects[0].clone();
    let word = |key: &str| effect[key].as_str().unwrap_or_default().to_owned();
    let (kind, joint) = (word("kind"), word("joint"));
    (kind, joint, move |name: &str| effect["params"][name]["value"].as_f64().unwrap())
}

/// Largest error on the run that was not fitted, in floors.
fn worst(report: &Value) -> f64 {
    let errors = report["errors"].as_array().unwrap();
    let judged = errors.iter().filter(|error| error["role"] == "validation");
    let ratio = |e: &Value| e["after"].as_f64().unwrap() / e["floor"].as_f64().unwrap();
    judged.map(ratio).fold(0.0, f64::max)
}

const POSE: &[&str] = &["x", "y", "phi"];

#[test]
fn without_a_tracker_a_rig_that_lacks_nothing_is_left_alone() {
    let report = without(4, POSE);
    assert_eq!(report["verdict"], "nothing-missing", "{}", report["summary"]);
    assert!(worst(&report) < 1.3, "{}", report["errors"]);
    let channels: Vec<&str> = report["errors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e["channel"].as_str().unwrap())
        .collect();
    assert_eq!(channels[..6], ["q1", "q2", "q3", "F1", "F2", "F3"]);
}

#[test]
fn without_encoders_or_forces_a_rig_that_lacks_nothing_is_left_alone() {
    for columns in [&["q1", "q2", "q3"], &["F1", "F2", "F3"]] {
        let report = without(4, columns);
        assert_eq!(report["verdict"], "nothing-missing", "{columns:?}: {}", report["summary"]);
        assert!(worst(&report) < 1.3, "{}", report["errors"]);
    }
}

/// As much friction as the tracker's recordings show, by the name that it has there.
#[test]
fn without_a_tracker_friction_in_a_drive_is_found() {
    let report = without(2, POSE);
    let (kind, joint, value) = only(&report);
    assert_eq!((kind.as_str(), joint.as_str()), ("actuator-friction", "P2"));
    assert!((value("coulomb_N") / 1.797 - 1.0).abs() < 0.02, "{}", value("coulomb_N"));
    assert!((value("viscous_Ns_m") / 5.993 - 1.0).abs() < 0.02, "{}", value("viscous_Ns_m"));
    assert!(worst(&report) < 1.3, "{}", report["errors"]);
}

fn the_payload_of_rig_1(report: &Value) {
    let (kind, _, value) = only(report);
    assert_eq!((kind.as_str(), &report["effects"][0]["body"]), ("payload", &"platform".into()));
    assert!((value("mass_kg") / 0.0659 - 1.0).abs() < 0.1, "{}", value("mass_kg"));
    // The tracker's recordings say 12.0 and −10.3 mm, known to 0.9 mm.
    assert!((value("com_x_m") - 0.0120).abs() < 2e-3, "{}", value("com_x_m"));
    assert!((value("com_y_m") + 0.0103).abs() < 2e-3, "{}", value("com_y_m"));
    assert!(worst(report) < 1.5, "{}", report["errors"]);
}

#[test]
#[ignore = "two minutes: 150 simulations of a machine that rattles"]
fn without_a_tracker_a_payload_on_a_machine_that_rattles_is_found() {
    the_payload_of_rig_1(&without(1, POSE));
}

#[test]
#[ignore = "two minutes: 150 simulations of a machine that rattles"]
fn a_payload_on_a_machine_that_rattles_is_found_through_its_description() {
    the_payload_of_rig_1(&described(1));
}

#[test]
#[ignore = "a minute: 44 simulations"]
fn a_worn_joint_is_told_from_what_resembles_it_through_its_description() {
    let report = described(3);
    let (kind, joint, value) = only(&report);
    assert_eq!((kind.as_str(), joint.as_str()), ("joint-wear", "C2"));
    assert!((value("clearance_m") / 4.2e-4 - 1.0).abs() < 0.01, "{}", value("clearance_m"));
    assert!(worst(&report) < 1.3, "{}", report["errors"]);
}

#[test]
#[ignore = "some minutes: two effects, and starts that no release gives"]
fn two_effects_are_found_beside_a_start_that_no_release_gives() {
    let report = described(5);
    assert_eq!(report["verdict"], "explained", "{}", report["residuals"]);
    let effects = report["effects"].as_array().unwrap();
    let of = |kind: &str| effects.iter().find(|effect| effect["kind"] == kind).unwrap();
    let value = |kind: &str, name: &str| of(kind)["params"][name]["value"].as_f64().unwrap();
    assert_eq!((effects.len(), &of("anchor-offset")["joint"]), (2, &"A2".into()));
    // What all columns say.
    assert!((value("anchor-offset", "dx_m") - 4.0e-4).abs() < 1e-5);
    assert!((value("anchor-offset", "dy_m") + 2.5e-4).abs() < 1e-5);
    assert!((value("gravity", "gx_m_s2") - 0.45).abs() < 0.01);
    assert!(worst(&report) < 1.3, "{}", report["errors"]);
}
