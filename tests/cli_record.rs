//! `freeplay record`: what sensors would show, and whether calibrations find in it what was hidden. The real binary.

mod cli_common;

use cli_common::Place;
use serde_json::Value;

const RIG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs/rig-1/rig.toml");
const PLANAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-1/rig.toml");

/// 20 µm of wear in A1, under gravity, which keeps the joints loaded.
const WORN: &str = "--set effect.0.kind=joint-wear --set effect.0.joint=A1 --set effect.0.clearance_m=1.2e-4 \
                    --set environment.gravity=[0,-9.81]";

fn json(place: &Place, name: &str) -> Value {
    serde_json::from_str(&place.read(name)).unwrap()
}

#[test]
fn twenty_micrometres_of_wear_are_recorded_and_found() {
    let place = Place::new();
    let text = place.good(&format!("record {RIG} {WORN} --duration 1.5 --out worn"));
    assert!(text.contains("joint-wear at A1: shows"), "{text}");
    let said = json(&place, "worn/record.json");
    // The sensors see them by ten floors and more.
    assert!(said["shows_floors"].as_f64().unwrap() > 10.0, "{said}");
    assert!(!place.read("worn/rig.toml").contains("joint-wear"));
    assert!(place.read("worn/truth.toml").contains("joint-wear"));
    // The truth explains its own recording to within noise; the rig does not.
    let predicted = |model: &str| {
        place.good(&format!(
            "predict worn/{model}.toml --data worn/run-b.csv --out {model} --quiet"
        ));
        let errors = json(&place, &format!("{model}/errors.json"))["errors"].clone();
        let ratio = |e: &Value| e["after"].as_f64().unwrap() / e["floor"].as_f64().unwrap();
        errors.as_array().unwrap().iter().map(ratio).fold(0.0, f64::max)
    };
    assert!(predicted("truth") < 1.5);
    assert!(predicted("rig") > 5.0);
    // And the loop closes.
    place.good(
        "calibrate --rig worn/rig.toml --data worn/run-a.csv --validate worn/run-b.csv --out found --quiet",
    );
    let found = json(&place, "found/report.json");
    assert_eq!(
        (&found["verdict"], &found["effects"][0]["kind"]),
        (&"explained".into(), &"joint-wear".into())
    );
    let clearance = found["effects"][0]["params"]["clearance_m"]["value"].as_f64().unwrap();
    assert!((clearance - 1.2e-4).abs() < 1e-6, "{clearance}");
}

#[test]
fn recordings_follow_from_the_seed() {
    let place = Place::new();
    let record = |out: &str, more: &str| {
        place.good(&format!("record {PLANAR} --duration 1.2 --out {out} --quiet {more}"));
        place.read(&format!("{out}/run-a.csv"))
    };
    let first = record("a", "");
    assert_eq!(record("b", ""), first);
    assert_ne!(record("c", "--set seed=2"), first);
    // Columns of the rig, at the rate asked for; nothing hidden, nothing missed.
    assert!(first.starts_with("t,q_O_cmd,q_O,T_O,a_slider\n0.000000,"), "{}", &first[..60]);
    assert_eq!(first.lines().count(), 1202);
    assert!(json(&place, "a/record.json")["shows_floors"].is_null());
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let place = Place::new();
    place.refused("record", &["sensor: is missing", "--set sensors.pose_std=4e-6"]);
    // Limits of recordings are told by the options that break them.
    let says = ["--rate: is 100 Hz", "at least 200", "--duration: is 0.5 s", "at least 1 s"];
    place.refused(&format!("record {RIG} --rate 100 --duration 0.5"), &says);
    place.refused(&format!("record {PLANAR} --rate 100"), &["--rate: is 100 Hz", "at least 200"]);
    place.refused(&format!("record {RIG} --duration 0"), &["--duration: is 0"]);
    let says = ["--set simulation.duration: is not how long recordings are", "--duration"];
    place.refused(&format!("record {RIG} --set simulation.duration=2"), &says);
    place.write("four-bar.toml", &place.good("init four-bar"));
    place
        .refused("record four-bar.toml", &["sensor: is missing", "`freeplay init four-bar --rig`"]);
    // More than anybody reads again, and than memory holds.
    for rows in ["--rate 1e12", "--rate 1e300", "--duration 86400", "--duration 100 --rate 1e5"] {
        let says = ["12 sensors", "numbers; expected at most 1e7", "--rate or --duration"];
        place.refused(&format!("record {RIG} {rows}"), &says);
    }
    place
        .refused(&format!("record {RIG} --set contact.law=native"), &["contact.law", "hertz-step"]);
    // Hours of computing, told after a second; days on a busy computer.
    let says = ["of computing", "--yes", "--duration"];
    place.refused(&format!("record {PLANAR} --duration 9000 --rate 200"), &says);
}

#[test]
fn a_section_without_meaning_is_told_once() {
    let place = Place::new();
    place.write(
        "four-bar.toml",
        "name = \"x\"\n[mechanism]\nkind = \"four-bar\"\n[legs]\ndensity = 7850.0\n",
    );
    let done = place.freeplay("record four-bar.toml");
    assert_eq!(done.code, 2, "{}", done.err);
    assert_eq!(done.err.matches("is not used").count(), 1, "{}", done.err);
}
