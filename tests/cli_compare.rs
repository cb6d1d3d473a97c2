//! `freeplay compare`, the real binary.

mod cli_common;

use cli_common::{Place, names};
use serde_json::Value;

const FILES: [&str; 9] = [
    "beginning.svg",
    "chaos.svg",
    "compare.csv",
    "compare.json",
    "force-distribution.svg",
    "index.html",
    "over-step.svg",
    "scenario.toml",
    "table.md",
];

#[test]
fn a_comparison_writes_everything_that_was_promised() {
    let place = Place::new();
    let out = place.good("compare --duration 0.06 --steps 2e-5,1e-4 --starts 2 --json");
    assert_eq!(place.entries(), ["freeplay-compare-default"]);
    assert_eq!(names(&place.path("freeplay-compare-default")), FILES);
    assert_eq!(out, place.read("freeplay-compare-default/compare.json"));

    let json: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(json["program"], "freeplay");
    for key in ["starts", "duration_s", "wall_s", "seed"] {
        assert!(json[key].is_number(), "{key}");
    }
    for key in ["restitution", "frequency_Hz", "damping_ratio", "iterations"] {
        assert!(json["native"][key].is_number(), "{key}");
    }
    let rows = json["rows"].as_array().unwrap();
    let laws: Vec<&str> = rows.iter().map(|row| row["law"].as_str().unwrap()).collect();
    let law = ["hertz-step", "hertz-step", "hertz-step"];
    assert_eq!(laws, [&law[..], &["native", "native"], &["ideal", "ideal", "ideal"]].concat());
    assert_eq!((&rows[0]["step_s"], &rows[0]["resolved"]), (&1e-4.into(), &false.into()));
    let quantities = rows[3]["quantities"].as_object().unwrap();
    for (key, value) in quantities {
        assert!(value["mean"].is_number() && value["sem"].is_number(), "{key}: {value}");
    }
    assert!(quantities.contains_key("energy_lost_W") && quantities.len() == 15);
    assert_eq!(json["verdicts"].as_array().unwrap().len(), 15);
    assert!(json["answer"].as_array().unwrap().len() >= 3);
    assert!(json["chaos"]["lyapunov_exponent_1_s"]["mean"].is_number());
    assert!(json["first_hits"]["exact_peak_force_N"]["mean"].as_f64().unwrap() > 1.0);

    let csv = place.read("freeplay-compare-default/compare.csv");
    assert_eq!(csv.lines().count(), 9);
    let columns = csv.lines().map(|line| line.split(',').count());
    assert!(columns.eq([38; 9]), "{csv}");
    assert!(csv.starts_with("law,step_s,tolerance_m_s,resolved,starts,halted,faulty,steps_per_s,"));

    let page = place.read("freeplay-compare-default/index.html");
    let answer = page.find("<section id=\"answer\">").unwrap();
    assert!(page.find("<section").unwrap() == answer, "the page begins with the answer");
    assert!(!page.contains("NaN"));
}

/// Times of computing are in the JSON and on the page only.
#[test]
fn the_same_comparison_gives_the_same_table() {
    let place = Place::new();
    for out in ["a", "b"] {
        place.good(&format!("compare --duration 0.03 --steps 2e-5 --starts 2 --out {out}"));
    }
    for file in ["compare.csv", "table.md", "scenario.toml"] {
        let [a, b] = ["a", "b"].map(|out| place.read(&format!("{out}/{file}")));
        assert_eq!(a, b, "{file}");
    }
}

#[test]
fn other_motions_and_their_text() {
    let place = Place::new();
    let out = place.good(
        "compare --set motion.kind=line --set drive.mode=servo --set environment.gravity=[0,-9.81] \
         --duration 0.03 --steps 1e-5 --starts 2 --out c",
    );
    assert!(out.contains("native") && out.contains("c/index.html"), "{out}");
    place.refused("compare --steps 1e-5 --out c", &["`c` already holds a result", "--force"]);
}

/// Zero against zero is no agreement: verdicts said that native contacts may be used.
#[test]
fn contacts_that_never_were_are_not_approved() {
    let place = Place::new();
    place.write("four-bar.toml", &place.good("init four-bar"));
    let line = "compare four-bar.toml --duration 0.02 --starts 2 --steps 2e-5,1e-5,5e-6";
    let json: Value = serde_json::from_str(&place.good(&format!("{line} --json --out c"))).unwrap();
    for verdict in json["verdicts"].as_array().unwrap() {
        assert_eq!(verdict["use"], "unclear", "{verdict}");
    }
    assert!(
        json["answer"].to_string().contains("No journal touched its ring"),
        "{}",
        json["answer"]
    );
}

#[test]
fn bad_steps_are_refused() {
    let place = Place::new();
    for (steps, fragments) in [
        ("", &["--steps", "is empty", "1e-7 to 1e-4"][..]),
        (",", &["`` is not a number"]),
        ("1e-5,x", &["`x` is not a number", "1e-7 to 1e-4"]),
        ("1e-5,-1e-5", &["-1e-5 is out of range"]),
        ("-1", &["-1 is out of range"]),
        ("0", &["0 is out of range"]),
        ("nan", &["nan is out of range"]),
        ("1e-3", &["1e-3 is out of range"]),
        ("1e-5,2e-5,3e-5,4e-5,5e-5,6e-5,7e-5,8e-5,9e-5", &["9 steps", "at most 8"]),
    ] {
        place.refused(&format!("compare --steps={steps}"), fragments);
    }
    assert_eq!(place.freeplay("compare --starts 1").code, 2);
    place.refused("compare --set motion.phi=0", &["motion.phi"]);
    place.refused("compare --set native.iterations=0", &["native.iterations", "1 to 100"]);
    place
        .refused("compare --set native.restitution=1.5", &["native.restitution", "0 (no rebound)"]);
    place.refused("compare --set native.freqency=10", &["did you mean `frequency`?"]);
}

const PENDULUM: &str =
    "--set mechanism.kind=pendulum --set environment.gravity=[0,-9.81] --set effect=[]";

/// A machine with one joint and without actuators: nothing is said of what it does not have.
#[test]
fn a_pendulum_with_clearance_is_compared() {
    let place = Place::new();
    let line = "compare --duration 0.3 --steps 2e-5,1e-5 --starts 3 --out p --json";
    let out = place.good(&format!("{line} {PENDULUM}"));
    let json: Value = serde_json::from_str(&out).unwrap();
    let (rows, verdicts) = (json["rows"].as_array().unwrap(), json["verdicts"].as_array().unwrap());
    assert_eq!(verdicts.len(), 13, "{verdicts:?}");
    for row in rows {
        for key in ["peak_actuator_force_N", "rms_actuator_force_deviation_N"] {
            assert!(row["quantities"][key]["mean"].is_null(), "{row}");
        }
    }
    assert!(verdicts.iter().all(|v| !v["quantity"].as_str().unwrap().contains("actuator")));
    // Without clearance the arm is where the ideal swing is: a mean of 10 ms deviates by the errors of
    // two steps, not by the swing's own 10 m/s².
    let ideal = rows.last().unwrap();
    assert_eq!((&ideal["law"], &ideal["step_s"]), (&"ideal".into(), &Value::Null));
    let smooth = &ideal["quantities"]["rms_smooth_acceleration_deviation_m_s2"]["mean"];
    assert!(smooth.as_f64().unwrap() < 1e-3, "{smooth}");
    // Starts differ: three equal runs would have no scatter.
    let law = rows.iter().find(|row| row["step_s"].is_null()).unwrap();
    assert_eq!(law["law"], "hertz-step");
    let peak = &law["quantities"]["rms_acceleration_deviation_m_s2"];
    assert!(peak["sem"].as_f64().unwrap() > 0.0, "{peak}");
}

/// A tolerance that resolves no hit: its figures stood in the table like any others, with exit code 0.
#[test]
fn a_comparison_whose_runs_do_not_balance_says_so() {
    let place = Place::new();
    let sets = "--set simulation.tolerance=0.03 --set simulation.settle=0.05";
    let line = format!("compare --duration 0.15 --steps 1e-4 --starts 2 --out c {sets}");
    let done = place.freeplay(&line);
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("error: hertz-step at the tolerance: "), "{}", done.err);
    assert!(done.err.contains("of 2 runs: the energy is off by "), "{}", done.err);
    let json: Value = serde_json::from_str(&place.read("c/compare.json")).unwrap();
    let mut rows = json["rows"].as_array().unwrap().iter();
    let loose = rows.find(|row| row["law"] == "hertz-step" && row["resolved"] == true).unwrap();
    assert_eq!(loose["tolerance_m_s"], 0.03);
    let faulty = loose["faulty"].as_u64().unwrap();
    assert!(faulty >= 1, "{loose}");
    assert!(place.read("c/index.html").contains(&format!("{faulty} with faults)")));
}

/// Runs of the law that break down are left out of its figures, which stood there with exit code 0.
#[test]
fn a_comparison_whose_runs_break_down_says_so() {
    let place = Place::new();
    let sets = "--set simulation.tolerance=0.1 --set simulation.settle=0.05";
    let line = format!("compare --duration 0.15 --steps 1e-4 --starts 2 --out c {sets}");
    let done = place.freeplay(&line);
    assert_eq!(done.code, 1, "{}", done.out);
    let said = "error: hertz-step at the tolerance: 2 of 2 runs: the simulation broke down at ";
    assert!(done.err.contains(said), "{}", done.err);
    assert!(place.read("c/index.html").contains("(2 broke down)"));
}

#[test]
fn a_machine_without_revolute_joints_is_refused() {
    let place = Place::new();
    let stage = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/drive-stage.toml");
    let fragments = ["drive-stage.toml:7: mechanism.kind: has no joint with clearance", "revolute"];
    place.refused(&format!("compare {stage} --duration 0.3"), &fragments);
    place.refused(
        "compare --set mechanism.kind=drive-stage --duration 0.3",
        &["--set mechanism.kind: has no joint with clearance"],
    );
}

/// The table of the docs, between its two comments.
fn table_of_docs() -> &'static str {
    let docs = include_str!("../docs/compare.md");
    let (_, rest) = docs.split_once("<!-- table.md -->\n").expect("begins");
    rest.split_once("<!-- end of table.md -->").expect("ends").0
}

/// Its shape from a short comparison: what stands in the cells takes a whole one.
#[test]
fn the_docs_show_the_table_that_compare_writes() {
    let place = Place::new();
    place.good("compare --duration 0.06 --starts 2 --out c --quiet");
    let table = place.read("c/table.md");
    assert_eq!(table.lines().count(), table_of_docs().lines().count());
    for (k, (ours, readme)) in table.lines().zip(table_of_docs().lines()).enumerate() {
        let cells =
            |line: &str| line.split('|').map(str::trim).map(String::from).collect::<Vec<_>>();
        let (ours, readme) = (cells(ours), cells(readme));
        assert_eq!((ours.len(), &ours[1]), (readme.len(), &readme[1]));
        if k < 2 {
            assert_eq!(ours, readme);
            continue;
        }
        // A shorter motion strays by another power of ten.
        let unit = |cell: &str| match cell.split([' ', ',']).nth(1).unwrap_or("") {
            "mm" | "µm" | "nm" => "m".to_owned(),
            unit => unit.to_owned(),
        };
        for (ours, readme) in ours.iter().zip(&readme) {
            assert!(!ours.contains('–') && unit(ours) == unit(readme), "{ours} and {readme}");
        }
    }
}

#[test]
#[ignore = "a whole comparison: half a minute on two cores"]
fn the_docs_table_is_that_of_the_default_comparison() {
    let place = Place::new();
    place.good("compare --quiet");
    assert_eq!(place.read("freeplay-compare-default/table.md"), table_of_docs());
}

/// What a comparison replaces is told; one law alone is no comparison.
#[test]
fn laws_and_steps_that_are_not_used_are_told() {
    let place = Place::new();
    let short = "compare --duration 0.03 --steps 1e-5 --starts 2 --quiet";
    for (set, says) in [
        (
            "contact.law=flores --set contact.restitution=0.5",
            "contact.law: is \"flores\" and is not used",
        ),
        ("contact.law=ideal", "contact.law: is \"ideal\" and is not used"),
        ("simulation.step=1e-5", "simulation.step: is not used; --steps says"),
    ] {
        let done = place.freeplay(&format!("{short} --set {set} --force --out c"));
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(done.err.starts_with("warning: --set ") && done.err.contains(says), "{}", done.err);
    }
    for laws in ["hertz-step", "flores,flores"] {
        place.refused(
            &format!("compare --laws {laws}"),
            &["--laws: ", "nothing to compare", "two laws"],
        );
    }
}

/// One step shows no limit: all verdicts are unclear, and that is not "for nothing".
#[test]
fn what_cannot_be_told_is_not_called_useless() {
    let place = Place::new();
    let out = place.good("compare --duration 0.03 --steps 1e-5 --starts 2 --out c --json");
    let json: Value = serde_json::from_str(&out).unwrap();
    assert!(json["verdicts"].as_array().unwrap().iter().all(|v| v["use"] == "unclear"), "{out}");
    let answer = json["answer"][0].as_str().unwrap();
    assert!(answer.starts_with("This comparison cannot tell"), "{answer}");
}
