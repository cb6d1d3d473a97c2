//! What is hidden in linkages with play in most joints: what looks show, and whole simulations have to tell.

use crate::found_of;
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
