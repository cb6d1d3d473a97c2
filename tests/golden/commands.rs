//! `freeplay check`, `compare`, `sweep` and `predict`.

use crate::cli_common::Place;
use crate::{asset, figures, json};
use serde_json::{Map, Value};

#[test]
fn checks() {
    let place = Place::new();
    for name in ["drive-stage", "pendulum"] {
        let checked = json(&place, &format!("check {}", asset(&format!("{name}.toml"))));
        figures::compare(&format!("check-{name}"), checked, 1e-9);
    }
    figures::compare("check-default", json(&place, "check"), 1e-9);
}

#[test]
fn checks_of_other_motions() {
    let place = Place::new();
    for (name, motion) in [
        ("line", "motion.start=[-0.05,0.01] --set motion.velocity=[0.1,0.02]"),
        ("quintic", "motion.from=[0,0,0.4] --set motion.to=[0.03,0.02,0.7]"),
        (
            "multisine",
            "motion.center=[0,0,0.6] --set motion.terms=[{amplitude=[0.02,0.01,0.1],frequency=2,phase=0.3}]",
        ),
    ] {
        let servo = "--set drive.mode=servo --set environment.gravity=[0,-9.81]";
        let line = format!("check {servo} --set motion.kind={name} --set {motion}");
        figures::compare(&format!("check-{name}"), json(&place, &line), 1e-9);
    }
}

/// As long as the engine's own contacts repeat themselves.
#[test]
fn comparison() {
    let line = "compare --duration 0.035 --steps 2e-5,1e-5 --starts 2 --out c";
    let mut all = json(&Place::new(), line);
    // Without clearance there is nothing but rounding to see a trend in.
    all["trends"].as_array_mut().unwrap().retain(|trend| trend["law"] != "ideal");
    figures::compare("compare", all, 1e-3);
}

/// The law and ideal joints for longer.
#[test]
fn longer_comparison() {
    let line = "compare --duration 0.06 --steps 2e-5,1e-5 --starts 2 --out c";
    let all = json(&Place::new(), line);
    let rows = all["rows"].as_array().unwrap().iter().filter(|row| row["law"] != "native");
    figures::compare("compare-longer", rows.cloned().collect(), 1e-5);
}

/// The rows, by the names of their columns.
#[test]
fn sweep() {
    let place = Place::new();
    place.good(
        "sweep --vary joints.clearance=2e-4,5e-4 --vary drive.mode=prescribed,servo --duration 0.05 \
         --quiet --out s",
    );
    let text = place.read("s/sweep.csv");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let cell = |text: &str| text.parse::<f64>().map_or_else(|_| text.into(), Value::from);
    let rows: Vec<Value> = lines
        .map(|row| head.iter().zip(row).map(|(name, text)| ((*name).to_owned(), cell(text))))
        .map(|row| row.collect::<Map<_, _>>().into())
        .collect();
    let table = serde_json::json!({ "columns": head, "rows": rows });
    figures::compare("sweep", table, 1e-5);
}

/// Rigs whose joints stay loaded, as declared.
#[test]
fn predictions() {
    let place = Place::new();
    for rig in 2..=5 {
        let [rig_file, log] =
            ["rig.toml", "run-b.csv"].map(|f| asset(&format!("rigs/rig-{rig}/{f}")));
        let predicted = json(&place, &format!("predict {rig_file} --data {log} --out p{rig}"));
        figures::compare(&format!("predict-rig-{rig}"), predicted, 1e-6);
    }
}
