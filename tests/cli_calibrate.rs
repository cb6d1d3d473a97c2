//! `freeplay calibrate` and `freeplay predict`, the real binary: what they write, and that they refuse
//! recordings that cannot be right.

mod cli_common;

use cli_common::{Place, names};
use serde_json::Value;
use std::path::PathBuf;

fn rig(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("assets/rigs/rig-2").join(name)
}

/// A recording as texts, to be broken.
#[derive(Clone)]
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn of_rig(name: &str) -> Self {
        let text = std::fs::read_to_string(rig(name)).unwrap();
        let mut lines =
            text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    fn column(&self, name: &str) -> usize {
        self.header.iter().position(|column| column == name).unwrap()
    }

    fn text(&self) -> String {
        let lines = std::iter::once(&self.header).chain(&self.rows).map(|row| row.join(","));
        lines.collect::<Vec<_>>().join("\n") + "\n"
    }

    fn rename(&mut self, from: &str, to: &str) {
        let column = self.column(from);
        self.header[column] = to.to_owned();
    }

    fn drop(&mut self, names: &[&str]) {
        for name in names {
            let column = self.column(name);
            self.header.remove(column);
            for row in &mut self.rows {
                row.remove(column);
            }
        }
    }

    fn set(&mut self, row: usize, name: &str, value: &str) {
        let column = self.column(name);
        self.rows[row][column] = value.to_owned();
    }

    fn scale(&mut self, names: &[&str], factor: f64) {
        for name in names {
            let column = self.column(name);
            for row in &mut self.rows {
                row[column] = (row[column].parse::<f64>().unwrap() * factor).to_string();
            }
        }
    }
}

/// A name, how a good recording is broken, and what the message must contain.
type Break = (&'static str, fn(&mut Table), &'static [&'static str]);

const BROKEN: &[Break] = &[
    (
        "a renamed command",
        |t| t.rename("q1_cmd", "q1cmd"),
        &["bad.csv:1: ", "unknown column `q1cmd`", "did you mean `q1_cmd`?"],
    ),
    ("a small letter", |t| t.rename("F1", "f1"), &["unknown column `f1`", "did you mean `F1`?"]),
    ("a foreign column", |t| t.rename("F1", "torque"), &["unknown column `torque`", "q1_cmd"]),
    ("a column twice", |t| t.rename("F2", "F1"), &["bad.csv:1: ", "column `F1` twice"]),
    ("no force", |t| t.drop(&["F3"]), &["bad.csv:1: no column `F3`", "actuator forces"]),
    (
        "no forces",
        |t| t.drop(&["F1", "F2", "F3"]),
        &["no column `F1`, `F2`, `F3`", "freeplay predict"],
    ),
    ("no pose", |t| t.drop(&["x", "y", "phi"]), &["no column `x`, `y`, `phi`", "pose (x y, m"]),
    ("no time", |t| t.drop(&["t"]), &["bad.csv:1: no column `t`"]),
    (
        "a gap",
        |t| drop(t.rows.drain(1000..1100)),
        &["bad.csv:1002: a step of 0.101", "constant rate"],
    ),
    ("a repeated row", |t| t.rows[700] = t.rows[699].clone(), &["bad.csv:702: ", "is repeated"]),
    ("rows exchanged", |t| t.rows.swap(700, 710), &["bad.csv:703: time runs backwards"]),
    ("not a number", |t| t.set(500, "x", "NaN"), &["bad.csv:502: column `x` holds NaN"]),
    ("infinity", |t| t.set(500, "F2", "inf"), &["bad.csv:502: column `F2` holds inf"]),
    ("an empty cell", |t| t.set(500, "q3", ""), &["bad.csv:502: column `q3` holds nothing"]),
    ("a word", |t| t.set(500, "phi", "n/a"), &["bad.csv:502: column `phi` holds n/a"]),
    ("a short row", |t| drop(t.rows[500].pop()), &["bad.csv:502: ", "as many values as"]),
    ("no rows", |t| t.rows.clear(), &["bad.csv", "0 row(s)"]),
    (
        "a dead force sensor",
        |t| (0..t.rows.len()).for_each(|row| t.set(row, "F2", "0.000")),
        &["bad.csv: column `F2` never changes while the commands do", "connected"],
    ),
    (
        "a dead tracker",
        |t| (0..t.rows.len()).for_each(|row| t.set(row, "y", "0.01")),
        &["column `y` never changes"],
    ),
    ("900 ms", |t| t.rows.truncate(900), &["bad.csv: lasts 0.8990 s", "at least 1 s"]),
    ("x in mm", |t| t.scale(&["x"], 1e3), &["column `x` starts with", "in mm", "by 0.001"]),
    ("y in mm", |t| t.scale(&["x", "y"], 1e3), &["column `x` starts", "column `y` starts"]),
    ("phi in mrad", |t| t.scale(&["phi"], 1e3), &["column `phi` starts with 521", "in mrad"]),
    ("phi in degrees", |t| t.scale(&["phi"], 57.295_779_5), &["column `phi`", "in degrees"]),
    ("q2 in mm", |t| t.scale(&["q2"], 1e3), &["column `q2` starts with 332", "in mm"]),
    (
        "commands in mm",
        |t| t.scale(&["q1_cmd", "q2_cmd", "q3_cmd"], 1e3),
        &["column `q1_cmd` starts with 332", "column `q2_cmd`", "column `q3_cmd`", "by 0.001"],
    ),
    (
        "every length in mm",
        |t| t.scale(&["q1_cmd", "q2_cmd", "q3_cmd", "q1", "q2", "q3", "x", "y"], 1e3),
        &["column `q1_cmd`", "column `q3`", "column `x`", "in mm"],
    ),
    (
        "forces in kN",
        |t| t.scale(&["F1", "F2", "F3"], 1e-3),
        &["bad.csv: column `F1` is of the order of", "in kN", "multiply by 1000"],
    ),
    ("forces in mN", |t| t.scale(&["F1", "F2", "F3"], 1e3), &["column `F3`", "in mN"]),
    ("time in ms", |t| t.scale(&["t"], 1e3), &["rows are 1.0000 s apart", "in ms, write it in s"]),
    (
        "a low rate",
        |t| {
            let mut row = 0;
            t.rows.retain(|_| {
                row += 1;
                row % 10 == 1
            });
        },
        &["rows are 0.0100 s apart", "at least 300 a second"],
    ),
    (
        "lengths exchanged",
        |t| {
            t.rename("q1", "q");
            t.rename("q2", "q1");
            t.rename("q", "q2");
        },
        &["do not close", "columns exchanged"],
    ),
    (
        "commands exchanged",
        |t| {
            t.rename("q1_cmd", "q");
            t.rename("q2_cmd", "q1_cmd");
            t.rename("q", "q2_cmd");
        },
        &["columns `q1_cmd` and `q1` differ by"],
    ),
];

#[test]
fn broken_recordings_are_refused() {
    let place = Place::new();
    let good = Table::of_rig("run-a.csv");
    let line = format!("calibrate --rig {} --data bad.csv --out c", rig("rig.toml").display());
    for (name, broken, fragments) in BROKEN {
        let mut table = good.clone();
        broken(&mut table);
        place.write("bad.csv", &table.text());
        println!("{name}");
        place.refused(&line, fragments);
    }
}

#[test]
fn a_broken_validation_run_is_refused() {
    let place = Place::new();
    let mut table = Table::of_rig("run-b.csv");
    table.scale(&["F1", "F2", "F3"], 1e-3);
    place.write("bad.csv", &table.text());
    std::fs::copy(rig("run-a.csv"), place.path("copy.csv")).unwrap();
    let line = format!(
        "calibrate --rig {} --data {}",
        rig("rig.toml").display(),
        rig("run-a.csv").display()
    );
    place.refused(&format!("{line} --validate bad.csv"), &["bad.csv: column `F1`", "in kN"]);
    let copied = &["copy.csv: holds the same samples as", "run-a.csv", "another run"];
    place.refused(&format!("{line} --validate copy.csv"), copied);
    place.refused(&format!("{line} --validate none.csv"), &["none.csv: cannot be read"]);
}

#[test]
fn rigs_that_do_not_fit_are_refused() {
    let place = Place::new();
    let toml = std::fs::read_to_string(rig("rig.toml")).unwrap();
    let data = rig("run-a.csv").display().to_string();
    let without_sensors = &toml[..toml.find("[sensors]").unwrap()];
    place.write("no-sensors.toml", without_sensors);
    place.write("effect.toml", &format!("{toml}\n[[effect]]\nkind = \"payload\"\nmass_kg = 0.1\n"));
    place.write("rig.toml", &toml);
    for (rig, options, fragments) in [
        ("no-sensors.toml", "", &["no-sensors.toml: sensors: is missing", "pose_std", "exact"][..]),
        ("effect.toml", "", &["effect.toml:", "effect", "holds 1 effect", "freeplay predict"]),
        ("none.toml", "", &["none.toml: cannot be read"]),
        ("rig.toml", "--set sensors.pose_std=0", &["sensors.pose_std", "is 0 m, exact"]),
        ("rig.toml", "--set sensors.pose_sd=1", &["did you mean `pose_std`?"]),
        ("rig.toml", "--set contact.law=native", &["contact.law: is \"native\"", "hertz-step"]),
        (
            "rig.toml",
            "--set mechanism.base_side=0.7",
            &["run-a.csv: columns `q", "do not close", "base_side 0.7 m", "is this the rig"],
        ),
        ("rig.toml", "--without payloads", &["--without: `payloads`", "did you mean `payload`?"]),
        ("rig.toml", "--without zzz", &["`zzz` is not an effect; known: payload, "]),
    ] {
        place.refused(&format!("calibrate --rig {rig} --data {data} {options}"), fragments);
    }
    assert_eq!(place.freeplay(&format!("calibrate --data {data}")).code, 2);
    assert_eq!(place.freeplay("calibrate --rig rig.toml").code, 2);
}

fn assert_number(value: &Value, what: &str) {
    assert!(value.is_number(), "{what}: {value}");
}

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
    let effect = &json["effects"][0];
    assert_eq!((&effect["kind"], &effect["joint"]), (&"actuator-friction".into(), &"P2".into()));
    assert!(effect["evidence"].as_str().unwrap().starts_with("removes "));
    for (name, fitted) in effect["params"].as_object().unwrap() {
        let [low, value, high] =
            [&fitted["ci95"][0], &fitted["value"], &fitted["ci95"][1]].map(|v| v.as_f64().unwrap());
        assert!(low < value && value < high && fitted["std"].as_f64().unwrap() > 0.0, "{name}");
    }
    let errors = json["errors"].as_array().unwrap();
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
    let ranking = json["ranking"].as_array().unwrap();
    assert!(ranking.len() > 4);
    for candidate in ranking {
        let score = candidate["validation_score"].as_f64().unwrap();
        assert!((0.0..=1.0).contains(&score), "{candidate}");
        let kind = candidate["kind"].as_str().unwrap();
        assert!(tried.contains(&kind), "--without {kind} was not heeded");
    }
    let kept: Vec<&Value> = ranking.iter().filter(|c| c["kept"] == true).collect();
    assert_eq!((kept.len(), &kept[0]["kind"]), (1, &"actuator-friction".into()));
    for key in ["simulations", "wall_s"] {
        assert_number(&json[key], key);
    }
    assert!(json["rapier_version"].is_string() && json["scenario_hash"].is_string());
    let residuals = json["residuals"].as_array().unwrap();
    assert_eq!(residuals.len(), 3);
    assert!(
        residuals[2]["mean_square_before"].as_f64() > residuals[2]["mean_square_after"].as_f64()
    );

    let (predicted, log) = (place.read("c/predicted-run.csv"), table.text());
    assert_eq!(predicted.lines().count(), log.lines().count());
    assert_eq!(predicted.lines().next(), log.lines().next());

    let page = place.read("c/index.html");
    let verdict = json["verdict"].as_str().unwrap();
    assert!(page.contains(&format!("Calibration of rig-2: {verdict}")) && !page.contains("NaN"));
    for id in ["facts", "effects", "errors", "depends-on", "candidates", "residuals", "provenance"]
    {
        assert!(page.contains(&format!("id=\"{id}\"")), "{id}");
    }

    // The calibrated model is a scenario like any other.
    place
        .good("run c/calibrated.toml --set simulation.settle=0.01 --duration 0.03 --out r --quiet");
    let predicted = place.good("predict c/calibrated.toml --data run.csv --out p --json");
    let predicted: Value = serde_json::from_str(&predicted).unwrap();
    for (one, other) in predicted["errors"].as_array().unwrap().iter().zip(errors) {
        for key in ["channel", "unit", "before", "after", "floor"] {
            assert_eq!(one[key], other[key], "{key} of {}", one["channel"]);
        }
    }

    let again = format!("calibrate --rig {rig_file} --data run.csv --out c");
    place.refused(&again, &["`c` already holds a result", "--force"]);
}

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

#[test]
fn predictions_refuse_what_cannot_be_right() {
    let place = Place::new();
    let rig_file = rig("rig.toml").display().to_string();
    let good = Table::of_rig("run-b.csv");
    let breaks: [Break; 4] = [
        (
            "no command",
            |t| t.drop(&["q2_cmd"]),
            &["bad.csv:1: no column `q2_cmd`", "predict needs"],
        ),
        ("time in ms", |t| t.scale(&["t"], 1e3), &["at least 100 a second", "in ms"]),
        ("forces in kN", |t| t.scale(&["F1", "F2", "F3"], 1e-3), &["column `F1`", "in kN"]),
        (
            "commands alone, in mm",
            |t| {
                t.drop(&["q1", "q2", "q3", "F1", "F2", "F3", "x", "y", "phi"]);
                t.scale(&["q1_cmd", "q2_cmd", "q3_cmd"], 1e3);
            },
            &["column `q1_cmd` starts with 368", "in mm"],
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
        &["no pose of the machine has the lengths of the first row", "base_side 2 m"],
    );
    place.refused("predict none.toml --data bad.csv", &["none.toml: cannot be read"]);
}
