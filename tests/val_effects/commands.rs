//! Effects as users meet them: explained, set, varied, refused.

use super::cli_common::Place;
use super::common::{INSTANTS, LIVELY, effect, ideal};
use freeplay::effects::{ALL, JointKinds, Kind, Targets};

/// The `[[effect]]` that `freeplay effects NAME` shows.
fn example(place: &Place, kind: &Kind) -> String {
    let text = place.good(&format!("effects {}", kind.name));
    let start = text.find("    [[effect]]").unwrap_or_else(|| panic!("{text}"));
    text[start..].lines().map(|line| format!("{}\n", line.trim_start())).collect()
}

#[test]
fn every_example_runs_and_repeats() {
    let place = Place::new();
    // What has no name is written by a calibration, not by hand; sensors, drives of revolute joints and sampled
    // drives are those of other machines (`cli_mechanism`, `golden`).
    let of_this_machine = |kind: &Kind| {
        let others = [Some(JointKinds::DrivenRevolute), Some(JointKinds::Sampled)];
        let driven = !others.contains(&kind.targets.joints());
        driven && !matches!(kind.targets, Targets::Sensor(_) | Targets::Tracker)
    };
    for kind in ALL.iter().filter(|kind| kind.name != "unnamed" && of_this_machine(kind)) {
        for mode in ["prescribed", "servo"] {
            let text =
                format!("{LIVELY}drive = {{ mode = \"{mode}\" }}\n{}", example(&place, kind));
            place.write("example.toml", &text);
            place.good("run example.toml --duration 0.01 --quiet --out a --force");
            place.good("run a/scenario.toml --quiet --out b --force");
            assert_eq!(
                place.read("a/timeseries.csv"),
                place.read("b/timeseries.csv"),
                "{}",
                kind.name
            );
            assert_eq!(
                place.read("a/scenario.toml"),
                place.read("b/scenario.toml"),
                "{}",
                kind.name
            );
        }
    }
}

#[test]
fn effects_are_explained_in_full() {
    let place = Place::new();
    let all = place.good("effects");
    let json: serde_json::Value = serde_json::from_str(&place.good("effects --json")).unwrap();
    assert_eq!(json.as_array().unwrap().len(), ALL.len());
    assert!(all.lines().all(|line| line.chars().count() <= 100), "lines fit");
    for (kind, object) in ALL.iter().zip(json.as_array().unwrap()) {
        assert_eq!(object["name"], kind.name);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in [kind.summary, kind.equation, kind.source, kind.trace] {
            assert!(words(&all).contains(&words(part)), "{}: {part}", kind.name);
        }
        for (parameter, entry) in
            kind.parameters.iter().zip(object["parameters"].as_array().unwrap())
        {
            assert!(all.contains(parameter.name));
            assert_eq!(entry["name"], parameter.name);
            assert_eq!(entry["default"].as_f64(), parameter.default);
        }
    }
    let one = place.good("effects payload --json");
    assert_eq!(serde_json::from_str::<serde_json::Value>(&one).unwrap()["name"], "payload");
    place.refused("effects paylod", &["paylod", "'payload'"]);
}

#[test]
fn effects_can_be_set_and_varied() {
    let place = Place::new();
    place.write("my.toml", &format!("{LIVELY}{}", effect("payload", "mass_kg = 0.1")));
    place.good("run my.toml --duration 0.01 --quiet --out a --set effect.0.mass_kg=0.25");
    assert!(place.read("a/scenario.toml").contains("mass_kg = 0.25"));
    place.good("sweep my.toml --duration 0.01 --quiet --out s --vary effect.0.mass_kg=0,1,2");
    let table = place.read("s/sweep.csv");
    assert_eq!(table.lines().count(), 4, "{table}");
    assert!(table.lines().next().unwrap().contains("effect.0.mass_kg"), "{table}");
    place.refused(
        "sweep my.toml --out t --vary effect.0.mass_kg=0,99",
        &["effect.0.mass_kg", "is 99"],
    );
    let set = "--set effect=[{kind=\"drag\",force_Ns_m=3}]";
    place.good(&format!("run --duration 0.01 --quiet --out b {set}"));
    assert!(place.read("b/scenario.toml").contains("force_Ns_m = 3"));
}

/// A run compares with the machine as declared.
#[test]
fn the_ideal_machine_has_no_effects() {
    let plain = ideal("", &[]);
    let mut loaded = ideal(&effect("payload", "mass_kg = 5"), &[]);
    let mut plain = plain;
    for t in INSTANTS {
        assert_eq!(loaded.ideal.at(t).drive_forces, plain.ideal.at(t).drive_forces);
    }
}

#[test]
fn wrong_effects_are_refused_with_file_and_line() {
    let place = Place::new();
    // Line 1 is the mechanism's, line 2 `[[effect]]`, line 3 its kind, and so on.
    let cases: &[(&str, &str, &[&str])] = &[
        ("paylod", "", &["bad.toml:3: effect.0.kind", "\"paylod\" is not an effect", "payload"]),
        ("payload", "mass = 3", &["bad.toml:4: ", "effect.0.mass", "known here: mass_kg"]),
        ("payload", "mass_kg = 30", &["bad.toml:4: effect.0.mass_kg: is 30", "from 0 to 20 kg"]),
        ("payload", "mass_kg = -1", &["bad.toml:4: effect.0.mass_kg: is -1"]),
        ("payload", "mass_kg = \"much\"", &["bad.toml:4: effect.0.mass_kg", "expected a number"]),
        ("payload", "mass_kg = nan", &["bad.toml:4: effect.0.mass_kg: is NaN"]),
        (
            "payload",
            "joint = \"A1\"",
            &["bad.toml:4: ", "`joint` is not a key of the effect payload"],
        ),
        (
            "sensor-offset",
            "offset_m = 1e-3",
            &["bad.toml:2: effect.0.joint: is missing", "joint = "],
        ),
        (
            "sensor-offset",
            "joint = \"A1\"",
            &["bad.toml:4: effect.0.joint", "\"A1\"", "P1, P2, P3"],
        ),
        ("anchor-offset", "joint = \"C1\"", &["bad.toml:4: effect.0.joint", "not on the base"]),
        ("joint-wear", "joint = \"C1\"", &["bad.toml:2: effect.0.clearance_m: is missing"]),
        ("joint-wear", "joint = \"C1\"; clearance_m = 0.01", &["bad.toml:5: effect.0.clearance_m"]),
        (
            "out-of-round",
            "joint = \"C1\"; lobes = 2.5",
            &["bad.toml:5: effect.0.lobes", "whole number"],
        ),
        (
            "out-of-round",
            "joint = \"C1\"; amplitude_m = 6e-4",
            &["bad.toml:5: effect.0.amplitude_m", "below the joint's clearance"],
        ),
        ("servo-gain", "joint = 3", &["bad.toml:4: effect.0.joint", "name of a joint, in quotes"]),
        ("sensor-offset", "joint = \"P1\"; offset_m = 0.05; # far", &[]),
    ];
    for (kind, keys, fragments) in cases {
        let text = format!("mechanism = {{ kind = \"3rpr\" }}\n{}", effect(kind, keys));
        place.write("bad.toml", &text);
        if fragments.is_empty() {
            place.good("check bad.toml --quiet");
        } else {
            place.refused("run bad.toml --out r", fragments);
        }
    }
    place.write("bad.toml", "mechanism = { kind = \"3rpr\" }\n[[effect]]\njoint = \"A1\"\n");
    place.refused("run bad.toml --out r", &["bad.toml:2: effect.0.kind: is missing"]);
    let two = format!("mechanism = {{ kind = \"3rpr\" }}\n{0}{0}bad = 1\n", effect("drag", ""));
    place.write("bad.toml", &two);
    place.refused("run bad.toml --out r", &["bad.toml:8: ", "effect.1.bad"]);
    // The physics engine's own contacts know round rings only.
    let keys = effect("out-of-round", "joint = \"C1\"; amplitude_m = 1e-4");
    place.write("bad.toml", &format!("mechanism = {{ kind = \"3rpr\" }}\n{keys}"));
    let native = "run bad.toml --out r --set contact.law=native";
    place.refused(native, &["bad.toml:3: effect.0.kind", "contact.law"]);
}
