//! `freeplay calibrate` on the six rigs, `freeplay study` on measured hardware.

use crate::cli_common::Place;
use crate::kept::{Differences, kept_json};
use crate::{asset, figures, json};
use serde_json::{Value, json as object};
use std::path::PathBuf;

/// Verdict, what was found, and how well it fits.
fn found(report: &Value) -> Value {
    let effects: Vec<Value> = report["effects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|effect| {
            let [kind, joint, depends_on, as_good, not_ruled_out, params] =
                ["kind", "joint", "depends_on", "as_good", "not_ruled_out", "params"]
                    .map(|key| &effect[key]);
            object!({
                "kind": kind, "joint": joint, "depends_on": depends_on, "as_good": as_good,
                "not_ruled_out": not_ruled_out, "params": params,
            })
        })
        .collect();
    let rest = ["verdict", "summary", "errors", "rattle", "simulations"].map(|key| &report[key]);
    let [verdict, summary, errors, rattle, simulations] = rest;
    object!({
        "verdict": verdict, "summary": summary, "effects": effects, "errors": errors, "rattle": rattle,
        "simulations": simulations,
    })
}

/// The calibration of a rig. Verdict, kinds, joints and the sentence must be the same. Numbers are those
/// that are kept to a share of 1e-6 as long as arithmetic is the same, and what differs more is printed.
/// Where the order of arithmetic has changed, a search ends elsewhere: with two lengths of the rig
/// changed in their last bits, values moved by up to 0.3 of their standard deviations, errors by up to
/// 0.01 of their floors, or 0.16 where joints rattle (rigs 1 and 6). The test fails where a value moves
/// by more than its standard deviation, or an error by more than 0.03 of its floor, 0.4 where joints
/// rattle.
fn calibration(rig: usize) {
    let name = format!("rig-{rig}");
    let [rig_file, a, b] =
        ["rig.toml", "run-a.csv", "run-b.csv"].map(|file| asset(&format!("rigs/{name}/{file}")));
    let place = Place::new();
    let line = format!("calibrate --rig {rig_file} --data {a} --validate {b} --out c");
    let file = format!("{name}.json");
    let [kept, now] = kept_json(&file, &found(&json(&place, &line)));
    for key in ["verdict", "summary"] {
        assert_eq!(now[key], kept[key], "{name}");
    }
    let rattles = kept["rattle"]["chaotic"] == true;
    let [error_share, std_share] = if rattles { [0.4, 0.4] } else { [0.03, 0.1] };
    let mut differences = Differences::default();
    let mut number = |place: String, kept: &Value, now: &Value, limit: f64| {
        let [kept, now] = [kept, now].map(|number| number.as_f64().unwrap());
        if (now - kept).abs() > 1e-6 * kept.abs() {
            println!("{name}: {place}: {now}, kept {kept}");
        }
        differences.number(&place, kept, now, limit);
    };
    let [effects, errors] = ["effects", "errors"]
        .map(|key| (kept[key].as_array().unwrap(), now[key].as_array().unwrap()));
    assert_eq!((effects.1.len(), errors.1.len()), (effects.0.len(), errors.0.len()), "{name}");
    for (kept, now) in effects.0.iter().zip(effects.1) {
        for key in ["kind", "joint", "depends_on", "as_good", "not_ruled_out"] {
            assert_eq!(now[key], kept[key], "{name}");
        }
        let params = [kept, now].map(|effect| effect["params"].as_object().unwrap());
        assert!(params[0].keys().eq(params[1].keys()), "{name}: {now}");
        for (key, kept) in params[0] {
            let (now, std) = (&params[1][key], kept["std"].as_f64().unwrap());
            number(key.clone(), &kept["value"], &now["value"], std);
            number(format!("std of {key}"), &kept["std"], &now["std"], std_share * std);
        }
    }
    for (kept, now) in errors.0.iter().zip(errors.1) {
        for key in ["run", "role", "channel", "unit"] {
            assert_eq!(now[key], kept[key], "{name}");
        }
        let floor = kept["floor"].as_f64().unwrap();
        for key in ["before", "after", "floor"] {
            let place = format!("{key} of {} in {}", kept["channel"], kept["run"]);
            let limit = error_share * floor.max(kept[key].as_f64().unwrap());
            number(place, &kept[key], &now[key], limit);
        }
    }
    differences.settle(&file);
}

macro_rules! calibrations {
    ($($name:ident $rig:literal,)*) => {$(
        #[test]
        #[ignore = "a calibration: up to two minutes on two cores"]
        fn $name() {
            calibration($rig);
        }
    )*};
}

calibrations! { rig_1 1, rig_2 2, rig_3 3, rig_4 4, rig_5 5, rig_6 6, }

/// The folder of measured recordings; without it the test says so, and passes.
fn measured(name: &str) -> Option<PathBuf> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/measured"));
    let folder = std::env::var_os("FREEPLAY_MEASURED").map_or_else(beside, PathBuf::from);
    if folder.join(name).is_dir() {
        return Some(folder);
    }
    println!("skipped: no recordings in {}; FREEPLAY_MEASURED says where", folder.display());
    None
}

/// What a study writes: its tables, whose numbers have three or four digits.
fn study(name: &str) {
    let Some(folder) = measured(name) else { return };
    let place = Place::new();
    place.good(&format!("study {name} --data {} --out s", folder.display()));
    let written: Value = serde_json::from_str(&place.read("s/study.json")).unwrap();
    figures::compare(&format!("study-{name}"), written, 1e-6);
}

#[test]
fn the_measured_drive_stage() {
    study("emps");
}

#[test]
#[ignore = "half a minute on two cores"]
fn the_measured_pendulum() {
    study("pendulum");
}

/// The measured pendulum's whole decay, predicted by what was found of it: more digits than the study's.
#[test]
fn the_decay_of_the_measured_pendulum() {
    let Some(folder) = measured("pendulum") else { return };
    let place = Place::new();
    let (model, log) = (asset("pendulum-calibrated.toml"), "pendulum/single_pendulum_1kHz.csv");
    let line = format!(
        "predict {model} --data {}/{log} --window 54.9 --fit 0.25 --out p",
        folder.display()
    );
    // Its other columns are told.
    let text = place.noted(&format!("{line} --json --quiet")).out;
    figures::compare("predict-pendulum", serde_json::from_str(&text).unwrap(), 1e-6);
}

/// A recording of the measured drive stage, predicted as declared.
#[test]
fn the_measured_drive_stage_as_declared() {
    let Some(folder) = measured("emps") else { return };
    let place = Place::new();
    let model = asset("drive-stage-declared.toml");
    let line = format!("predict {model} --data {}/emps/emps_pulses.csv --out p", folder.display());
    figures::compare("predict-drive-stage", json(&place, &line), 1e-6);
}
