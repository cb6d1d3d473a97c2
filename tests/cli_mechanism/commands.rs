//! The commands on machines other than the 3-RPR.

use crate::cli_common::{Place, names};
use crate::files::FOUR_BAR;
use freeplay::scenario::Mechanism;
use serde_json::Value;

/// Pictures and pages that every run writes.
const FILES: [&str; 9] = [
    "acceleration.svg",
    "animation.svg",
    "index.html",
    "path-error.svg",
    "path.svg",
    "player.html",
    "scenario.toml",
    "summary.json",
    "timeseries.csv",
];

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Everything of a run's folder is there, and no number of it is missing.
fn complete(place: &Place, folder: &str, joints: bool) {
    let written = names(&place.path(folder));
    for file in FILES {
        // Without play there is nothing that a path could err by.
        if !joints && file == "path-error.svg" {
            continue;
        }
        assert!(written.iter().any(|name| name == file), "{folder} lacks {file}: {written:?}");
        assert!(!place.read(&format!("{folder}/{file}")).is_empty(), "{folder}/{file} is empty");
    }
    let csv = place.read(&format!("{folder}/timeseries.csv"));
    let columns = csv.lines().next().unwrap().split(',').count();
    for (i, line) in csv.lines().enumerate().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!(numbers.len(), columns, "{folder}: line {i}");
        assert!(numbers.iter().all(|x| x.is_finite()), "{folder}: line {i}: {line}");
    }
    let page = place.read(&format!("{folder}/index.html"));
    assert!(!page.contains("NaN") && !page.contains("inf "), "{folder}/index.html");
    let summary = json(&place.read(&format!("{folder}/summary.json")));
    assert_eq!(summary["halted"], Value::Null, "{folder}");
    for key in ["peak_contact_force_N", "peak_platform_acceleration_m_s2", "rms_path_error_m"] {
        // A machine without revolute joints has no contacts.
        let there = joints || key != "peak_contact_force_N";
        assert_eq!(summary[key].is_number(), there, "{folder}: {key}: {}", summary[key]);
    }
}

#[test]
fn a_mechanism_file_is_checked_run_compared_and_swept() {
    let place = Place::new();
    place.write("four-bar.toml", FOUR_BAR);

    let check = json(&place.good("check four-bar.toml --json"));
    assert_eq!((&check["ok"], &check["findings"]), (&true.into(), &Value::Array(Vec::new())));
    assert_eq!(check["freedoms"]["counted"], 1);
    assert_eq!(check["freedoms"]["free"], 1);
    assert_eq!(check["freedoms"]["driven"], 1);
    assert_eq!(check["drives"][0]["joint"], "O");
    assert_eq!(check["loops"][0]["joints"].as_array().unwrap().len(), 4);
    let clearances: Vec<Option<f64>> =
        check["joints"].as_array().unwrap().iter().map(|j| j["clearance_m"].as_f64()).collect();
    assert_eq!(clearances, [None, Some(1.5e-4), Some(2e-4), None]);
    let text = place.good("check four-bar.toml");
    for word in ["crank", "coupler", "rocker", "servo"] {
        assert!(text.contains(word), "{text}\nlacks {word}");
    }

    place.good("run four-bar.toml --out run");
    complete(&place, "run", true);
    let header = place.read("run/timeseries.csv").lines().next().unwrap().to_owned();
    for body in ["crank", "coupler", "rocker"] {
        let columns = ["x", "y", "phi", "vx", "vy", "omega", "ax", "ay", "alpha"]
            .map(|head| format!("{head}_{body}"))
            .join(",");
        assert!(header.contains(&columns), "{header}\nlacks {columns}");
    }
    assert!(header.contains(",q_O,F_O,"), "{header}");
    let joints = "ecc_A,force_A,force_A_max,ecc_B,force_B,force_B_max";
    assert!(header.ends_with(joints), "{header}");
    // The scenario that it wrote repeats the run.
    place.good("run run/scenario.toml --out again --quiet");
    assert_eq!(place.read("run/timeseries.csv"), place.read("again/timeseries.csv"));

    place.good("compare four-bar.toml --duration 0.02 --out compared");
    let compared = names(&place.path("compared"));
    assert!(compared.iter().any(|name| name == "index.html"), "{compared:?}");

    place.good(
        "sweep four-bar.toml --out swept --quiet --vary joint.A.clearance=1e-4,2e-4 --vary \
         body.rocker.mass=0.2..0.3:2 --vary drive.O.stiffness=300,400",
    );
    let sweep = place.read("swept/sweep.csv");
    let rows: Vec<&str> = sweep.lines().collect();
    assert_eq!(rows.len(), 9, "{sweep}");
    assert!(rows[0].starts_with("joint.A.clearance,body.rocker.mass,drive.O.stiffness,"));
    assert!(rows[1].starts_with("0.0001,0.2,300"), "{}", rows[1]);
    // Every variant is another machine.
    let mut forces: Vec<&str> =
        rows[1..].iter().map(|row| row.splitn(5, ',').nth(4).unwrap()).collect();
    forces.sort_unstable();
    forces.dedup();
    assert_eq!(forces.len(), 8, "{sweep}");
    place.refused(
        "sweep four-bar.toml --out x --vary joint.Z.clearance=1e-4",
        &["joint.Z.clearance", "has no Z"],
    );
}

#[test]
fn every_template_is_checked_run_compared_and_swept() {
    let place = Place::new();
    for kind in Mechanism::KINDS {
        let file = format!("{kind}.toml");
        let gravity = "[environment]\ngravity = [0.0, -9.81]\n";
        let text = format!(
            "name = \"{kind}\"\n[mechanism]\nkind = \"{kind}\"\n{gravity}[simulation]\nduration = 0.03\n"
        );
        place.write(&file, &text);
        let done = place.freeplay(&format!("check {file} --json"));
        assert_eq!(done.code, 0, "{kind}: {}", done.err);
        let check = json(&done.out);
        assert_eq!(check["ok"], true, "{kind}");
        assert!(!check["bodies"].as_array().unwrap().is_empty(), "{kind}");
        let free = check["freedoms"]["free"].as_u64().unwrap();
        let driven = check["freedoms"]["driven"].as_u64().unwrap();
        let expected = match kind {
            "3rpr" | "3rrr" => (3, 3),
            "five-bar" => (2, 2),
            "double-pendulum" => (2, 0),
            "pendulum" => (1, 0),
            _ => (1, 1),
        };
        assert_eq!((free, driven), expected, "{kind}");

        let done = place.freeplay(&format!("run {file} --out {kind} --quiet"));
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{kind}");
        complete(&place, kind, kind != "drive-stage");
        if kind == "drive-stage" {
            let missing = "mechanism.kind: has no joint with clearance";
            place.refused(&format!("compare {file} --out x"), &["drive-stage.toml:3: ", missing]);
        } else {
            place.good(&format!("compare {file} --out {kind}-c --quiet"));
            assert!(names(&place.path(&format!("{kind}-c"))).iter().any(|f| f == "index.html"));
        }
        let vary = "environment.gravity.1=-9.81,-5";
        let done = place.freeplay(&format!("sweep {file} --out {kind}-s --quiet --vary {vary}"));
        assert_eq!(done.code, 0, "{kind}: {}", done.err);
        assert_eq!(place.read(&format!("{kind}-s/sweep.csv")).lines().count(), 3, "{kind}");
    }
}
