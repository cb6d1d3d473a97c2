//! Effects that are known, hidden in recordings of the self-test's 3-RPR.

use crate::cli_common::Place;
use crate::worst;
use serde_json::Value;

const RIG: &str = include_str!("../../src/calibrate/sensed/self_test/three-rpr.toml");

/// Sines that take every drive through its range, no two directions alike.
const MOTION: &str = "
[motion]
kind = \"multisine\"
terms = [
    { amplitude = [0.035, 0.0, 0.0], frequency = 1.2, phase = 0.0 },
    { amplitude = [0.0, 0.03, 0.0], frequency = 1.7, phase = 0.4 },
    { amplitude = [0.0, 0.0, 0.16], frequency = 1.3, phase = 0.1 },
]
";

/// Earth's, along y.
const DOWN: f64 = -9.81;

/// The report on recordings of the rig with these effects, of which its declaration says nothing.
fn calibrated(gravity: f64, effects: &str, more: &str) -> Value {
    let place = Place::new();
    place.write("truth.toml", &format!("seed = 3\n{RIG}{MOTION}{effects}"));
    let set = format!("--set environment.gravity=[0,{gravity}]");
    place.good(&format!("record truth.toml {set} --out c --quiet"));
    let line = "calibrate --rig c/rig.toml --data c/run-a.csv --validate c/run-b.csv --out found";
    serde_json::from_str(&place.good(&format!("{line} {more} --json --quiet"))).unwrap()
}

/// An effect: its kind, its joint if it has one, and its values.
type HiddenEffect<'a> = (&'a str, Option<&'a str>, &'a [(&'a str, f64)]);

/// Each effect by kind and joint, its values within four standard deviations, the first, which says how large it is, within
/// this share of its own.
fn found(report: &Value, hidden: &[HiddenEffect], within: f64) {
    assert_eq!(report["verdict"], "explained", "{}", report["summary"]);
    let effects = report["effects"].as_array().unwrap();
    assert_eq!(effects.len(), hidden.len(), "{}", report["summary"]);
    for (kind, joint, values) in hidden {
        let own = effects.iter().find(|e| e["kind"] == *kind && e["joint"].as_str() == *joint);
        let own = own.unwrap_or_else(|| panic!("{kind}: {}", report["summary"]));
        for (name, truth) in *values {
            let [value, std] =
                ["value", "std"].map(|key| own["params"][name][key].as_f64().unwrap());
            println!("{kind}.{name}: {value} ± {std}, hidden {truth}");
            assert!((value - truth).abs() < 4.0 * std, "{name}: {value} ± {std}, not {truth}");
        }
        let (size, truth) = values[0];
        let value = own["params"][size]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < within, "{size}: {value}, not {truth}");
    }
    let (ratio, channel) = worst(report);
    assert!(ratio < 1.3, "{channel}: {ratio} floors");
}

/// With 29 g on the platform a leg is nearly unloaded now and then. A journal that crossed over at another
/// time in the model than in the recording drew the fit to a payload three times as far out, and the
/// verdict was `unexplained`.
#[test]
fn a_payload_that_nearly_unloads_a_leg_is_found() {
    let report = calibrated(
        DOWN,
        "[[effect]]\nkind = \"payload\"\nmass_kg = 0.029\ncom_x_m = 0.021\ncom_y_m = -0.012\n",
        "",
    );
    let values = [("mass_kg", 0.029), ("com_x_m", 0.021), ("com_y_m", -0.012)];
    found(&report, &[("payload", None, &values)], 0.03);
}

/// Where joints rattle, looks read off flying forces which way a journal leans. Least squares made the
/// clearance of a worn joint small that such noise is multiplied by (attenuation): 0.2 mm for 0.27 mm, and
/// the verdict was `unexplained`.
#[test]
#[ignore = "two minutes: a machine that rattles"]
fn a_worn_joint_that_rattles_is_found_with_its_clearance() {
    let worn = "[[effect]]\nkind = \"joint-wear\"\njoint = \"A2\"\nclearance_m = 2.7e-4\n";
    let report = calibrated(0.0, worn, "");
    found(&report, &[("joint-wear", Some("A2"), &[("clearance_m", 2.7e-4)])], 0.06);
}

/// A model that is off swings with another frequency than the machine, and an anchor offset was nearer than a payload beside
/// a worn joint.
#[test]
#[ignore = "two minutes: two effects"]
fn a_payload_and_a_worn_joint_are_told_apart() {
    let both = "[[effect]]\nkind = \"payload\"\nmass_kg = 0.076\ncom_x_m = -0.017\ncom_y_m = -0.021\n\
                [[effect]]\nkind = \"joint-wear\"\njoint = \"C3\"\nclearance_m = 2.3e-4\n";
    let report = calibrated(DOWN, both, "");
    let payload = [("mass_kg", 0.076), ("com_x_m", -0.017), ("com_y_m", -0.021)];
    let worn = [("clearance_m", 2.3e-4)];
    let hidden = [("payload", None, &payload[..]), ("joint-wear", Some("C3"), &worn[..])];
    found(&report, &hidden, 0.05);
}

/// An unbalance near the swing of the platform makes joints rattle that gravity keeps loaded in the declared
/// machine. A regression: whether joints rattle was decided on the declared machine, so that the truth itself
/// missed the recording by eight times noise, and the verdict was `unexplained`.
#[test]
#[ignore = "two minutes: a machine that rattles"]
fn a_machine_that_rattles_under_what_it_lacks_is_understood() {
    let unbalance = "[[effect]]\nkind = \"unbalance\"\nmass_radius_kg_m = 2.5e-5\nfrequency_Hz = 34.0\n\
                     phase_rad = 1.0\n";
    let report = calibrated(DOWN, unbalance, "");
    assert_eq!(report["rattle"]["chaotic"], true, "the test rests on it");
    let values = [("mass_radius_kg_m", 2.5e-5), ("frequency_Hz", 34.0)];
    found(&report, &[("unbalance", None, &values)], 0.05);
}

/// Friction in a drive beside a payload, where joints rattle.
#[test]
#[ignore = "two minutes: two effects on a machine that rattles"]
fn a_payload_and_friction_are_told_apart_where_joints_rattle() {
    let both = "[[effect]]\nkind = \"payload\"\nmass_kg = 0.088\ncom_x_m = 0.013\ncom_y_m = 0.008\n\
                [[effect]]\nkind = \"actuator-friction\"\njoint = \"P3\"\ncoulomb_N = 1.24\nviscous_Ns_m = 4.4\n";
    let report = calibrated(0.0, both, "");
    let friction = [("coulomb_N", 1.24), ("viscous_Ns_m", 4.4)];
    let hidden = [
        ("payload", None, &[("mass_kg", 0.088)][..]),
        ("actuator-friction", Some("P3"), &friction[..]),
    ];
    found(&report, &hidden, 0.1);
}

/// A worn joint that must not be named passes for play in a drive, which looks cannot tell from it where the
/// load does not turn. A regression: that was the verdict, although the platform swings otherwise under it
/// and its simulation missed the recording by 3.3 floors.
#[test]
#[ignore = "two minutes: everything that has a name is tried"]
fn what_simulations_miss_is_not_explained() {
    let worn = "[[effect]]\nkind = \"joint-wear\"\njoint = \"C1\"\nclearance_m = 2.4e-4\n";
    let report = calibrated(DOWN, worn, "--without joint-wear");
    assert_eq!(report["verdict"], "unexplained", "{}", report["summary"]);
}
