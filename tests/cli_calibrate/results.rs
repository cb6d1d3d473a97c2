//! The folder of a calibration.

use crate::cli_common::{Place, names};
use crate::recording::{Table, assert_number, rig};
use serde_json::Value;

/// Half a minute: a short recording, and few effects to try.
#[test]
fn a_calibration_writes_everything_that_was_promised() {
    let place = Place::new();
    let mut table = Table::of_rig("run-a.csv");
    table.rows.truncate(1500);
    place.write("run.csv", &table.text());
    let effects: Value = serde_json::from_str(&place.good("effects --json")).unwrap();
    let tried = ["payload", "actuator-friction", "drag"];
    let without: String = effects
        .as_array()
        .unwrap()
        .iter()
        .map(|effect| effect["name"].as_str().unwrap())
        .filter(|name| !tried.contains(name))
        .map(|name| format!(" --without {name}"))
        .collect();
    let rig_file = rig("rig.toml").display().to_string();
    let line = format!("calibrate --rig {rig_file} --data run.csv{without} --json --out c");
    let out = place.good(&line);
    assert_eq!(out, place.read("c/report.json"));

    let json: Value = serde_json::from_str(&out).unwrap();
    let mut files: Vec<String> = json["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|file| file.as_str().unwrap().to_owned())
        .collect();
    files.sort();
    assert_eq!(names(&place.path("c")), files);
    for file in ["calibrated.toml", "index.html", "predicted-run.csv", "report.json"] {
        assert!(files.iter().any(|name| name == file), "{file}");
    }
    assert_eq!(json["program"], "freeplay");
    // Halves of 1.5 s need not tell whether anything else is missing; what is certain they tell.
    assert_ne!(json["verdict"], "nothing-missing", "{out}");
    assert_effect(&json["effects"][0]);
    let errors = json["errors"].as_array().unwrap();
    assert_errors(errors);
    assert_ranking(&json["ranking"], &tried);
    for key in ["simulations", "wall_s"] {
        assert_number(&json[key], key);
    }
    assert!(json["rapier_version"].is_string() && json["scenario_hash"].is_string());
    let residuals = json["residuals"].as_array().unwrap();
    assert_eq!(residuals.len(), 9, "law and dynamics of each drive, closure of each reading");
    let of_drive = residuals.iter().find(|r| r["residual"] == "dynamics of P2").unwrap();
    assert!(of_drive["mean_square_before"].as_f64() > of_drive["mean_square_after"].as_f64());

    let (predicted, log) = (place.read("c/predicted-run.csv"), table.text());
    assert_eq!(predicted.lines().count(), log.lines().count());
    assert_eq!(predicted.lines().next(), log.lines().next());

    assert_page(&place.read("c/index.html"), json["verdict"].as_str().unwrap());

    assert_model_predicts(&place, errors);

    let again = format!("calibrate --rig {rig_file} --data run.csv --out c");
    place.refused(&again, &["`c` already holds a result", "--force"]);
}

fn assert_effect(effect: &Value) {
    assert_eq!((&effect["kind"], &effect["joint"]), (&"actuator-friction".into(), &"P2".into()));
    assert!(effect["evidence"].as_str().unwrap().starts_with("takes "));
    for (name, fitted) in effect["params"].as_object().unwrap() {
        let [low, value, high] =
            [&fitted["ci95"][0], &fitted["value"], &fitted["ci95"][1]].map(|v| v.as_f64().unwrap());
        assert!(low < value && value < high && fitted["std"].as_f64().unwrap() > 0.0, "{name}");
    }
}

fn assert_errors(errors: &[Value]) {
    let channels: Vec<&str> = errors.iter().map(|e| e["channel"].as_str().unwrap()).collect();
    assert_eq!(channels, ["q1", "q2", "q3", "F1", "F2", "F3", "x", "y", "phi"]);
    for error in errors {
        assert_eq!((&error["run"], &error["role"]), (&"run.csv".into(), &"calibration".into()));
        for key in ["before", "after", "floor"] {
            assert_number(&error[key], key);
        }
    }
    let force = &errors[4];
    assert_eq!(force["unit"], "N");
    assert!(force["before"].as_f64().unwrap() > 10.0 * force["after"].as_f64().unwrap());
}

/// Only what was `tried` stands there, and the hidden effect alone is kept.
fn assert_ranking(ranking: &Value, tried: &[&str]) {
    let ranking = ranking.as_array().unwrap();
    assert!(ranking.len() > 4);
    for candidate in ranking {
        let score = candidate["validation_score"].as_f64().unwrap();
        assert!((0.0..=1.0).contains(&score), "{candidate}");
        let kind = candidate["kind"].as_str().unwrap();
        assert!(tried.contains(&kind), "--without {kind} was not heeded");
    }
    let kept: Vec<&Value> = ranking.iter().filter(|c| c["kept"] == true).collect();
    assert_eq!((kept.len(), &kept[0]["kind"]), (1, &"actuator-friction".into()));
}

fn assert_page(page: &str, verdict: &str) {
    assert!(page.contains(&format!("Calibration of rig-2: {verdict}")) && !page.contains("NaN"));
    for id in ["effects", "why", "errors", "candidates", "limits", "residuals", "provenance"] {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }
}

/// The calibrated model is a scenario like any other, and errs as the report says.
fn assert_model_predicts(place: &Place, errors: &[Value]) {
    place
        .good("run c/calibrated.toml --set simulation.settle=0.01 --duration 0.03 --out r --quiet");
    let predicted = place.good("predict c/calibrated.toml --data run.csv --out p --json");
    let predicted: Value = serde_json::from_str(&predicted).unwrap();
    for (one, other) in predicted["errors"].as_array().unwrap().iter().zip(errors) {
        for key in ["channel", "unit"] {
            assert_eq!(one[key], other[key], "{key} of {}", one["channel"]);
        }
        for key in ["after", "floor"] {
            assert_eq!(one[key], other[key], "{key} of {}", one["channel"]);
        }
        // The swing that the declared machine begins with is found from other looks: 0.6 % apart.
        let [one, other] = [one, other].map(|error| error["before"].as_f64().unwrap());
        assert!((one / other - 1.0).abs() < 0.01, "{one} and {other}");
    }
}
