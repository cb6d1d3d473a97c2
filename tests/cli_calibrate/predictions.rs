//! Predictions: what they take, what they write, what they refuse.

use crate::cli_common::Place;
use crate::recording::{Break, Table, assert_number, rig};
use serde_json::Value;

#[test]
fn a_prediction_takes_what_was_measured() {
    let place = Place::new();
    let mut table = Table::of_rig("run-b.csv");
    table.rows.truncate(1200);
    let rig_file = rig("rig.toml").display().to_string();
    for (file, dropped, channels) in [
        ("whole.csv", &[][..], 9),
        ("no-pose.csv", &["x", "y", "phi"], 6),
        ("no-forces.csv", &["F1", "F2", "F3"], 6),
        ("commands.csv", &["q1", "q2", "q3", "F1", "F2", "F3", "x", "y", "phi"], 0),
    ] {
        let mut table = table.clone();
        table.drop(dropped);
        place.write(file, &table.text());
        let out = place.good(&format!("predict {rig_file} --data {file} --out {file}-out --json"));
        assert_eq!(out, place.read(&format!("{file}-out/errors.json")));
        let json: Value = serde_json::from_str(&out).unwrap();
        let errors = json["errors"].as_array().unwrap();
        assert_eq!(errors.len(), channels, "{file}");
        for error in errors {
            assert!(error["before"].is_null(), "the declared model has no effects");
            assert_number(&error["after"], "after");
            assert_number(&error["floor"], "floor");
        }
        let predicted = place.read(&format!("{file}-out/predicted.csv"));
        let header: Vec<&str> = predicted.lines().next().unwrap().split(',').collect();
        assert_eq!(header[..table.header.len()], table.header, "{file}");
        assert_eq!(header.len(), 13, "what was not measured is predicted too");
        assert_eq!(predicted.lines().count(), 1201);
    }
    // A pose shows how the machine swung; without one it starts as it was let go, whatever else was
    // measured.
    let last = |file: &str| {
        let text = place.read(&format!("{file}-out/predicted.csv"));
        let mut cells: Vec<(String, f64)> = text
            .lines()
            .next()
            .unwrap()
            .split(',')
            .map(str::to_owned)
            .zip(text.lines().last().unwrap().split(',').map(|cell| cell.parse().unwrap()))
            .collect();
        cells.sort_by(|a, b| a.0.cmp(&b.0));
        cells
    };
    for ((name, one), (_, other)) in last("no-pose.csv").iter().zip(&last("commands.csv")) {
        assert!((one - other).abs() < 1e-6 + 1e-3 * one.abs(), "{name}: {one} {other}");
    }
}

/// A column of a log that no sensor has was refused once.
#[test]
fn a_column_that_nobody_asks_for_is_told_and_carried_along() {
    let place = Place::new();
    let mut table = Table::of_rig("run-b.csv");
    table.rows.truncate(1200);
    let predict = |name: &str, table: &Table| {
        place.write(&format!("{name}.csv"), &table.text());
        let rig = rig("rig.toml");
        place.freeplay(&format!("predict {} --data {name}.csv --out {name}", rig.display()))
    };
    assert_eq!(predict("plain", &table).code, 0);
    table.header.push("motor_temperature".to_owned());
    table.rows.iter_mut().for_each(|row| row.push("warm".to_owned()));
    let done = predict("more", &table);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(done.err, "note: more.csv: columns that no sensor has: motor_temperature\n");
    let carried = place.read("plain/predicted.csv").replace('\n', ",warm\n");
    let carried = carried.replacen(",warm", ",motor_temperature", 1);
    assert_eq!(place.read("more/predicted.csv"), carried);
    let page = place.read("more/index.html");
    assert!(page.contains("The recording is not explained: "), "the verdict leads");
    assert!(!page.contains("<th>before</th>"), "without effects there is nothing before");
    // Beside a gap it may be what the gap lacks.
    table.drop(&["F1"]);
    let done = predict("gap", &table);
    assert_eq!(done.code, 0, "{}", done.err);
    let said = "note: gap.csv: columns that no sensor has: motor_temperature; sensors that no column has: F1\n";
    assert_eq!(done.err, said);
}

/// A tracker may stand anyhow: a quarter of a turn makes its recording no other rig's.
#[test]
fn a_tracker_that_is_turned_is_no_other_rig() {
    let place = Place::new();
    let mut table = Table::of_rig("run-b.csv");
    table.rows.truncate(1200);
    table.exchange("x", "y");
    table.scale(&["x"], -1.0);
    place.write("run.csv", &table.text());
    let rig_file = rig("rig.toml").display().to_string();
    place.good(&format!("predict {rig_file} --data run.csv --quiet"));
}

/// Without `[sensors]` nobody says how exact its instruments are, and the recording is asked.
#[test]
fn a_machine_without_declared_instruments_is_predicted() {
    let place = Place::new();
    let toml = std::fs::read_to_string(rig("rig.toml")).unwrap();
    place.write("rig.toml", &toml[..toml.find("[sensors]").unwrap()]);
    let mut table = Table::of_rig("run-b.csv");
    table.rows.truncate(1200);
    place.write("run.csv", &table.text());
    let json: Value =
        serde_json::from_str(&place.good("predict rig.toml --data run.csv --json --quiet"))
            .unwrap();
    let errors = json["errors"].as_array().unwrap();
    assert_eq!(errors.len(), 9);
    for error in errors {
        assert_number(&error["after"], "after");
        assert_number(&error["floor"], "floor");
    }
}

#[test]
fn predictions_refuse_what_cannot_be_right() {
    let place = Place::new();
    let rig_file = rig("rig.toml").display().to_string();
    let good = Table::of_rig("run-b.csv");
    let breaks: [Break; 4] = [
        (
            "no command",
            |t| t.drop(&["q2_cmd"]),
            &["bad.csv:1: no column `q2_cmd`", "what the machine was asked to do"],
        ),
        ("time in ms", |t| t.scale(&["t"], 1e3), &["at least 100 a second", "in ms"]),
        (
            "forces in kN",
            |t| t.scale(&["F1", "F2", "F3"], 1e-3),
            &["column `F1`", "`F1` times 1000"],
        ),
        (
            "commands alone, in mm",
            |t| {
                t.drop(&["q1", "q2", "q3", "F1", "F2", "F3", "x", "y", "phi"]);
                t.scale(&["q1_cmd", "q2_cmd", "q3_cmd"], 1e3);
            },
            &["column `q1_cmd` starts with 368", "`q1_cmd` times 0.001"],
        ),
    ];
    for (name, broken, fragments) in breaks {
        let mut table = good.clone();
        broken(&mut table);
        place.write("bad.csv", &table.text());
        println!("{name}");
        place.refused(&format!("predict {rig_file} --data bad.csv"), fragments);
    }
    let mut commands = good.clone();
    commands.drop(&["q1", "q2", "q3", "F1", "F2", "F3", "x", "y", "phi"]);
    place.write("bad.csv", &commands.text());
    place.refused(
        &format!("predict {rig_file} --data bad.csv --set mechanism.base_side=2"),
        &["bad.csv: no pose of the machine has its first commands: `q1_cmd` starts with 0.368"],
    );
    // Drives that have no law of their own are asked what the machine takes.
    let mut forces = good.clone();
    forces.rows.truncate(1200);
    forces.scale(&["F1", "F2", "F3"], 1e-3);
    place.write("bad.csv", &forces.text());
    place.refused(
        &format!("predict {rig_file} --data bad.csv --set drive.mode=prescribed"),
        &["column `F1` is what the simulated machine says in another unit", "`F1` times 1000"],
    );
    place.refused("predict none.toml --data bad.csv", &["none.toml: cannot be read"]);
}
