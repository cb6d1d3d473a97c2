//! An effect that is hidden in synthetic recordings is found, with its size.

use crate::FOUR_BAR;
use crate::cli_common::Place;
use freeplay::calibrate::sensed::recording::Recording;
use freeplay::calibrate::sensed::{released, simulate};
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
    let machine = released::released(&declared, &truth.effects, &like, control).unwrap().machine;
    let clean = simulate::record(&machine, control, &like, 7).unwrap();
    place.write(name, &simulate::with_noise(&clean, &sensors, seed).to_csv(&sensors));
}

/// The report on two recordings of the four-bar with an effect of which its declaration says nothing.
fn report_with(effect: &str) -> Value {
    report_of([effect, effect])
}

/// The same, each recording with its own effect.
fn report_of(effects: [&str; 2]) -> Value {
    let place = Place::new();
    place.write("rig.toml", FOUR_BAR);
    recorded(&place, "a.csv", effects[0], [[1.2, 3.0], [0.4, 7.0]], 1);
    recorded(&place, "b.csv", effects[1], [[0.9, 4.0], [-0.5, 6.0]], 2);
    let command =
        "calibrate --rig rig.toml --data a.csv --validate b.csv --out found --json --quiet";
    serde_json::from_str(&place.good(command)).unwrap()
}

#[test]
fn friction_in_a_joint_without_a_drive_is_found_with_its_torque() {
    let effect = "
        [[effect]]
        kind = \"joint-friction\"
        joint = \"D\"
        coulomb = 0.06
    ";
    let report = report_with(effect);
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

/// A blow on the crank in the run that is judged alone, which no effect that lasts explains.
#[test]
fn a_blow_in_one_run_is_found_with_its_time_joint_and_impulse() {
    let blow = "
        [[effect]]
        kind = \"impulse\"
        body = \"crank\"
        at_s = 1.1
        iphi_Nms = 0.01
    ";
    let report = report_of(["", blow]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{}", report["summary"]);
    let params = &effects[0]["params"];
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["depends_on"]),
        (&"unnamed".into(), &"time".into())
    );
    assert_eq!((&effects[0]["joint"], &effects[0]["run"]), (&"O".into(), &"b.csv".into()));
    let value = |name: &str| params[name]["value"].as_f64().unwrap();
    assert!((value("at_s") - 1.1).abs() < 0.015, "{params}");
    assert!((value("impulse_Nms") / 0.01 - 1.0).abs() < 0.2, "{params}");
    assert!(report["summary"].as_str().unwrap().contains("does not last"), "{}", report["summary"]);
}

#[test]
fn a_command_that_reaches_its_drive_late_is_found_with_its_delay() {
    let report = report_with("\n[[effect]]\nkind = \"command-delay\"\ndelay_s = 0.002\n");
    assert_eq!(report["verdict"], "explained", "{}", report["residuals"]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{}", report["summary"]);
    assert_eq!(effects[0]["kind"], "command-delay");
    let delay = effects[0]["params"]["delay_s"]["value"].as_f64().unwrap();
    assert!((delay / 0.002 - 1.0).abs() < 0.1, "{delay}");
}

/// What the report says would have been seen is hidden in that size, and in a quarter of it.
#[test]
fn what_is_said_to_be_seen_is_seen_and_much_less_is_not() {
    let nothing = report_with("");
    assert_eq!(nothing["verdict"], "nothing-missing", "{}", nothing["residuals"]);
    let limits = nothing["limits"].as_array().unwrap();
    let limit =
        limits.iter().find(|limit| limit["kind"] == "payload" && limit["body"] == "coupler");
    let smallest = limit.unwrap()["smallest"].as_f64().unwrap();
    let hidden = |mass: f64| {
        let keys = format!("body = \"coupler\"\nmass_kg = {mass}");
        report_with(&format!("\n[[effect]]\nkind = \"payload\"\n{keys}\n"))
    };
    assert_ne!(hidden(1.5 * smallest)["verdict"], "nothing-missing", "{smallest}");
    assert_eq!(hidden(0.25 * smallest)["verdict"], "nothing-missing", "{smallest}");
}

#[test]
fn an_instrument_noisier_than_declared_is_told_and_no_effect_is_blamed() {
    let place = Place::new();
    let quiet = FOUR_BAR.replace("std = 0.003", "std = 0.0012");
    assert_ne!(quiet, FOUR_BAR);
    place.write("rig.toml", &quiet);
    recorded(&place, "a.csv", "", [[1.2, 3.0], [0.4, 7.0]], 1);
    recorded(&place, "b.csv", "", [[0.9, 4.0], [-0.5, 6.0]], 2);
    let text = place
        .good("calibrate --rig rig.toml --data a.csv --validate b.csv --out found --json --quiet");
    let report: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["verdict"], "nothing-missing", "{}", report["residuals"]);
    let noises = report["noises"].as_array().unwrap();
    assert_eq!(noises.len(), 1, "{noises:?}");
    assert_eq!(noises[0]["column"], "torque");
    let ratio = noises[0]["measured"].as_f64().unwrap() / noises[0]["declared"].as_f64().unwrap();
    assert!((ratio / 2.5 - 1.0).abs() < 0.1, "{ratio}");
}
