//! An effect that is hidden in synthetic recordings is found, with its size.

use crate::FOUR_BAR;
use crate::cli_common::Place;
use freeplay::calibrate::sensed::recording::Recording;
use freeplay::calibrate::sensed::{simulate, start};
use freeplay::engine::StepControl;
use freeplay::model::parts_of;
use freeplay::scenario::Scenario;
use serde_json::Value;

/// A recording of the four-bar with some effects, its crank turning by these waves about a mean.
fn recorded(place: &Place, name: &str, effects: &str, waves: [[f64; 2]; 2], seed: u64) {
    let declared = Scenario::from_text(FOUR_BAR, "rig", &[]).unwrap();
    let truth = Scenario::from_text(&format!("{FOUR_BAR}{effects}"), "truth", &[]).unwrap();
    let sensors = parts_of(&declared).unwrap().sensors;
    let mut text = "t,crank_cmd,crank,torque,rocker\n".to_owned();
    for row in 0..=2000 {
        let t = f64::from(row) * 1e-3;
        // At rest for 50 ms, then up to full speed in a quarter of a second.
        let s = ((t - 0.05) / 0.25).clamp(0.0, 1.0);
        let grown = s * s * s * (10.0 + s * (6.0 * s - 15.0));
        let way = waves.iter().map(|[amplitude, rate]| amplitude * (rate * (t - 0.05)).sin());
        let command = 1.0 + grown * way.sum::<f64>();
        text += &format!("{t:.3},{command:.9},0,0,0\n");
    }
    place.write("commands.csv", &text);
    let like = Recording::read(&place.path("commands.csv"), &sensors, false).unwrap();
    let control = StepControl::Tolerance(1e-5);
    // The joints close at the first commands, whatever the columns that were not measured yet hold.
    let machine = start::released(&declared, &truth.effects, &like, control).unwrap();
    let clean = simulate::record(&machine, control, &like, 7).unwrap();
    place.write(name, &simulate::with_noise(&clean, &sensors, seed).to_csv(&sensors));
}

#[test]
fn friction_in_a_joint_without_a_drive_is_found_with_its_torque() {
    let place = Place::new();
    place.write("rig.toml", FOUR_BAR);
    let effect = "
        [[effect]]
        kind = \"joint-friction\"
        joint = \"D\"
        coulomb = 0.06
    ";
    recorded(&place, "a.csv", effect, [[1.2, 3.0], [0.4, 7.0]], 1);
    recorded(&place, "b.csv", effect, [[0.9, 4.0], [-0.5, 6.0]], 2);
    let text = place
        .good("calibrate --rig rig.toml --data a.csv --validate b.csv --out found --json --quiet");
    let report: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["verdict"], "explained", "{}", report["residuals"]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{}", report["summary"]);
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["joint"]),
        (&"joint-friction".into(), &"D".into())
    );
    let torque = effects[0]["params"]["coulomb"]["value"].as_f64().unwrap();
    assert!((torque / 0.06 - 1.0).abs() < 0.1, "{torque}");
}
