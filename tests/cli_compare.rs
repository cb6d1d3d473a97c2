//! `freeplay compare`, the real binary.

mod cli_common;

use cli_common::{Place, names};
use serde_json::Value;

const FILES: [&str; 8] = [
    "beginning.svg",
    "chaos.svg",
    "compare.csv",
    "compare.json",
    "force-distribution.svg",
    "index.html",
    "over-step.svg",
    "scenario.toml",
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
    assert!(csv.starts_with("law,step_s,tolerance_m_s,resolved,starts,halted,steps_per_s,"));

    let page = place.read("freeplay-compare-default/index.html");
    let answer = page.find("<section id=\"answer\">").unwrap();
    assert!(page.rfind("<section").unwrap() == answer, "the page ends with the answer");
    assert!(!page.contains("NaN"));
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
