//! What is hidden in linkages with play in most joints: what looks show, and whole simulations have to tell.

use crate::{found_of, report_of};
use serde_json::Value;

/// Asserts that a value is within a share of the hidden one.
fn near(found: &Value, name: &str, truth: f64, share: f64) {
    let value = found[name]["value"].as_f64().unwrap();
    assert!((value / truth - 1.0).abs() < share, "{name}: {value}, hidden {truth}");
}

/// Looks do not tell 3.94 N from 4 N, for joints lean this way and that; predictions do, and missed by two floors.
#[test]
#[ignore = "a minute and a half"]
fn friction_of_an_actuator_is_told_by_predictions() {
    let hidden = [
        ("kind", "actuator-friction"),
        ("joint", "P2"),
        ("coulomb_N", "4"),
        ("viscous_Ns_m", "10"),
    ];
    let found = found_of("three-prr", &[&hidden]).remove(0);
    near(&found, "coulomb_N", 4.0, 0.01);
    near(&found, "viscous_Ns_m", 10.0, 0.02);
}

/// A fit ended at a quarter of it, behind a rise of what is left.
#[test]
#[ignore = "three minutes"]
fn a_backlash_is_looked_for_at_other_sizes() {
    let hidden = [("kind", "drive-backlash"), ("joint", "O"), ("play_rad", "8e-4")];
    let found = found_of("stephenson", &[&hidden]).remove(0);
    near(&found, "play_rad", 8e-4, 0.05);
}

/// A lag of all drives and friction in one joint, both thousands of times what noise leaves: six replicas of each model spent all that a
/// calibration may take before the second effect was found.
#[test]
#[ignore = "five minutes"]
fn two_large_effects_are_found_where_joints_rattle() {
    let lag = [("kind", "servo-lag"), ("time_constant_s", "0.0015")];
    let friction =
        [("kind", "joint-friction"), ("joint", "B1"), ("coulomb", "0.05"), ("viscous", "0.01")];
    let found = found_of("three-rrr", &[&lag, &friction]);
    near(&found[0], "time_constant_s", 0.0015, 0.01);
    near(&found[1], "coulomb", 0.05, 0.05);
    near(&found[1], "viscous", 0.01, 0.1);
}

/// Looks blame the wrong body, and a point 3.5 µm off for what that lacks of the right one: dropped with it.
#[test]
#[ignore = "three minutes"]
fn what_a_wrong_effect_needed_is_dropped_with_it() {
    let payload = [
        ("kind", "payload"),
        ("body", "head"),
        ("mass_kg", "0.5"),
        ("com_x_m", "0.15"),
        ("com_y_m", "0.075"),
    ];
    let ripple = [
        ("kind", "torque-ripple"),
        ("joint", "O"),
        ("amplitude", "0.2"),
        ("per_turn", "18"),
        ("phase_rad", "0.4"),
    ];
    let found = found_of("lift", &[&payload, &ripple]);
    near(&found[0], "mass_kg", 0.5, 0.001);
    near(&found[0], "com_x_m", 0.15, 0.2);
    near(&found[1], "amplitude", 0.2, 0.01);
}

/// A worn joint that leans one way all along is a link too short: which of the two it is nothing tells, and the report says so. What
/// looks make of its clearance turned round from pass to pass, and four did not settle it.
#[test]
#[ignore = "five minutes"]
fn a_worn_joint_is_not_told_from_a_short_link() {
    let payload = [
        ("kind", "payload"),
        ("body", "platform"),
        ("mass_kg", "0.3"),
        ("com_x_m", "0"),
        ("com_y_m", "0.05"),
    ];
    let worn = [("kind", "joint-wear"), ("joint", "S1"), ("clearance_m", "2e-4")];
    let report = report_of("three-prr", &[&payload, &worn]);
    let found = report["effects"].as_array().unwrap();
    assert_eq!(found.len(), 2, "{}", report["summary"]);
    assert_eq!([&found[0]["kind"], &found[0]["body"]], ["payload", "platform"]);
    let own = format!("{} at {}", found[1]["kind"], found[1]["joint"]).replace('"', "");
    let alike = found[1]["as_good"].as_array().unwrap().iter().filter_map(Value::as_str);
    let mut all = alike.chain([own.as_str()]);
    assert!(all.any(|effect| effect == "joint-wear at S1"), "{}", report["summary"]);
}
