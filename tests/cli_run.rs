//! `freeplay run`, the real binary.

mod cli_common;

use cli_common::{Place, WRONG, names, write_wrong_files};
use serde_json::Value;

const FILES: [&str; 14] = [
    "acceleration.svg",
    "actuator-forces.svg",
    "animation.svg",
    "index.html",
    "joint-forces.svg",
    "orbits.svg",
    "path-error.svg",
    "path.svg",
    "player.html",
    "scenario.toml",
    "summary.json",
    "timeseries.csv",
    "wear.csv",
    "wear.svg",
];

const COLUMNS: &str = "t,x,y,phi,vx,vy,omega,ax,ay,alpha,q1,q2,q3,F1,F2,F3,\
    ecc_A1,force_A1,force_A1_max,ecc_A2,force_A2,force_A2_max,ecc_A3,force_A3,force_A3_max,\
    ecc_C1,force_C1,force_C1_max,ecc_C2,force_C2,force_C2_max,ecc_C3,force_C3,force_C3_max";

/// Columns of a time series by name.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let i = csv.lines().next().unwrap().split(',').position(|c| c == name).unwrap();
    csv.lines().skip(1).map(|line| line.split(',').nth(i).unwrap().parse().unwrap()).collect()
}

#[test]
fn the_default_run_writes_everything_that_was_promised() {
    let place = Place::new();
    let out = place.good("run --duration 0.06");
    assert_eq!(place.entries(), ["freeplay-run-default"]);
    assert_eq!(names(&place.path("freeplay-run-default")), FILES);
    assert!(out.contains("peak contact force") && out.contains("freeplay-run-default/index.html"));

    let csv = place.read("freeplay-run-default/timeseries.csv");
    assert_eq!(csv.lines().next(), Some(COLUMNS));
    let t = column(&csv, "t");
    assert_eq!((t.len(), t[0], t[120]), (121, 0.0, 0.06));
    assert_eq!(csv.lines().nth(4).unwrap().split(',').next(), Some("0.0015"));
    // The start of the default circle, and the ideal machine's acceleration until the first hit.
    assert_eq!(column(&csv, "x")[0], 0.05);
    assert!((column(&csv, "q1")[0] - 0.3782082287).abs() < 1e-9);
    assert!(column(&csv, "force_A1_max").iter().any(|f| *f > 1.0));

    let json: Value =
        serde_json::from_str(&place.read("freeplay-run-default/summary.json")).unwrap();
    for key in [
        "peak_contact_force_N",
        "peak_platform_acceleration_m_s2",
        "peak_actuator_force_N",
        "rms_path_error_m",
        "max_path_error_m",
        "contact_fraction",
        "impacts",
        "steps",
        "simulated_s",
        "wall_s",
        "rms_acceleration_deviation_m_s2",
        "rms_actuator_force_deviation_N",
        "impacts_per_s",
        "largest_penetration_m",
        "smallest_step_s",
        "largest_step_s",
        "step_error_m_s",
        "wall_s_per_simulated_s",
        "seed",
    ] {
        assert!(json[key].is_number(), "{key}: {}", json[key]);
    }
    // A step is accepted up to (1/0.9)⁴ = 1.5 times the tolerance of 1e-5 m/s.
    assert!(json["step_error_m_s"].as_f64().unwrap() <= 1.6e-5);
    assert_eq!(json["halted"], Value::Null);
    assert_eq!(json["rapier_version"], freeplay::engine::RAPIER_VERSION);
    assert_eq!(json["simulated_s"], 0.06);
    let joints: Vec<&str> =
        json["joints"].as_array().unwrap().iter().map(|j| j["joint"].as_str().unwrap()).collect();
    assert_eq!(joints, ["A1", "A2", "A3", "C1", "C2", "C3"]);
    assert_eq!(json["joints"][0]["clearance_m"], 5e-4);

    // The figures agree with the rows from the settling time (half of so short a run) on.
    let peak = column(&csv, "force_C1_max")[61..].iter().copied().fold(0.0, f64::max);
    assert!((json["joints"][3]["peak_force_N"].as_f64().unwrap() - peak).abs() < 1e-6 * peak);

    let page = place.read("freeplay-run-default/index.html");
    assert!(
        page.contains("500 µm of clearance")
            && page.contains(&json["scenario_hash"].to_string()[1..65])
    );
}

#[test]
fn json_is_the_summary_and_nothing_else() {
    let place = Place::new();
    let done = place.freeplay("run --duration 0.02 --json --out r");
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(done.out, place.read("r/summary.json"));
    serde_json::from_str::<Value>(&done.out).unwrap();
    assert_eq!(place.good("run --duration 0.02 --quiet --out q"), "");
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    let place = Place::new();
    place.good("run --duration 0.05 --out a");
    place.good("run --duration 0.05 --out b");
    place.good("run a/scenario.toml --out c");
    let first = place.read("a/timeseries.csv");
    assert_eq!(first, place.read("b/timeseries.csv"));
    assert_eq!(first, place.read("c/timeseries.csv"), "the effective scenario repeats the run");
    assert_eq!(place.read("a/path.svg"), place.read("b/path.svg"));
}

#[test]
fn wrong_input_is_refused_before_anything_is_written() {
    let place = Place::new();
    write_wrong_files(&place);
    for (arguments, fragments) in WRONG {
        place.refused(&format!("run --out x {arguments}"), fragments);
    }
    place.refused("run --out syntax.toml/x", &["cannot write to", "--out"]);
    place.refused("run --out syntax.toml", &["is a file", "--out"]);
    let usage = place.freeplay("run --durration 1");
    assert_eq!(usage.code, 2);
    assert!(usage.err.contains("--duration"), "{}", usage.err);
}

/// A rig file with servos and gravity, as rigs declare them.
const RIG: &str = r#"
name = "rig"
[mechanism]
kind = "3rpr"
platform_inertia = 1.6666666666666667e-4
[joints]
clearance = [0.0001, 0.0001, 0.0001, 0.0002, 0.0001, 0.0001]
friction = 0.1
[drive]
mode = "servo"
stiffness = 5e5
damping = 300.0
[environment]
gravity = [0.0, -9.81]
[sensors]
pose_std = 4e-6
force_lowpass = 400.0
"#;

#[test]
fn a_rig_with_servos_and_gravity_runs() {
    let place = Place::new();
    place.write("rig.toml", RIG);
    place.good("run rig.toml --duration 0.02");
    let json: Value = serde_json::from_str(&place.read("freeplay-run-rig/summary.json")).unwrap();
    assert_eq!((&json["drive"], &json["scenario_name"]), (&"servo".into(), &"rig".into()));
    assert_eq!(json["joints"][3]["clearance_m"], 2e-4);
    assert!(place.read("freeplay-run-rig/index.html").contains("100 µm to 200 µm of clearance"));
}

#[test]
fn every_law_and_motion_runs() {
    let place = Place::new();
    let table: String = (0..=20)
        .map(|k| f64::from(k) * 1e-3)
        .map(|t| format!("{t},{},{},0.5\n", 0.1 * t, 0.02 * t * t))
        .collect();
    place.write("path.csv", &format!("t,x,y,phi\n{table}"));
    for (i, sets) in [
        "contact.law=native",
        "contact.law=ideal --set simulation.step=1e-5",
        "contact.law=ideal --set drive.mode=servo",
        "simulation.tolerance=1e-5",
        "contact.stiffness_form=conformal --set contact.clip=false --set simulation.step=5e-6",
        "motion.kind=line",
        "motion.kind=quintic",
        "motion.kind=multisine",
        "motion.kind=table --set motion.file=path.csv",
    ]
    .iter()
    .enumerate()
    {
        place.good(&format!("run --duration 0.02 --out {i} --set {sets}"));
    }
    // Without clearance the machine does what the ideal one does.
    let json: Value = serde_json::from_str(&place.read("1/summary.json")).unwrap();
    assert!(json["max_path_error_m"].as_f64().unwrap() < 1e-10);
    assert!(json["rms_actuator_force_deviation_N"].as_f64().unwrap() < 1e-6);
    assert_eq!(json["joints"][0]["clearance_m"], Value::Null);
}

#[test]
fn a_run_that_breaks_down_keeps_what_it_has() {
    let place = Place::new();
    let done = place.freeplay("run --out h --set contact.stiffness=10 --set contact.c_max=0");
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.starts_with("error: the simulation broke down at t = 0.0"), "{}", done.err);
    assert!(done.err.contains("in joint "), "{}", done.err);
    // Where the rings wear is a question of a whole run.
    let files: Vec<&str> = FILES.into_iter().filter(|file| !file.starts_with("wear")).collect();
    assert_eq!(names(&place.path("h")), files);
    let json: Value = serde_json::from_str(&place.read("h/summary.json")).unwrap();
    assert!(done.err.contains(json["halted"].as_str().unwrap()));
    let rows = place.read("h/timeseries.csv").lines().count() as f64;
    assert!((rows - json["simulated_s"].as_f64().unwrap() / 5e-4).abs() < 3.0, "{rows}");
    assert!(place.read("h/index.html").contains("did not reach its end"));
}

/// Somebody meant milliseconds, or wants rows by the nanosecond.
#[test]
fn what_takes_days_or_fills_the_disk_is_asked_for() {
    let place = Place::new();
    let long = "run --duration 8e4 --set simulation.output_interval=10 --out r";
    place.refused(long, &["of computing", "--yes", "--duration"]);
    place.refused("run --duration 1e6 --out r", &["simulation.duration", "at most 86400 s, a day"]);
    let rows = "run --duration 1 --set simulation.output_interval=1e-7 --out r";
    place.refused(rows, &["would write about", "GB", "--yes", "simulation.output_interval"]);
    place.good("run --duration 0.02 --yes --out r --quiet");
}

/// What makes many runs is judged by the first seconds of them, those that break down at once left out.
#[test]
fn many_runs_that_take_days_are_asked_for() {
    let place = Place::new();
    place.write("a.toml", "mechanism.kind = \"3rpr\"\nsimulation.duration = 8e4\n");
    let wear = "wear --cycles 1e6 --set contact.wear_coefficient=1e-14 --duration 8e4";
    for line in [
        "compare --duration 8e4",
        "compare --laws hertz,liu --duration 8e4",
        "paper --duration 8e4",
        "diff a.toml a.toml --set joints.clearance=1e-4",
        wear,
    ] {
        place.refused(&format!("{line} --out r"), &["of computing", "--yes"]);
        assert!(!place.path("r").exists(), "{line}");
    }
    place.good(&wear.replace("8e4", "1.2 --yes --out r --quiet"));
}

#[test]
fn a_table_that_ends_early_is_warned_about() {
    let place = Place::new();
    let table: String = (0..=10).map(|k| format!("{},0,0,0.5\n", f64::from(k) * 1e-3)).collect();
    place.write("path.csv", &format!("t,x,y,phi\n{table}"));
    let motion = "--set motion.kind=table --set motion.file=path.csv";
    for command in ["run", "check"] {
        let done = place.freeplay(&format!("{command} {motion} --duration 0.02"));
        let fragments = ["warning: ", "motion.file: ends at t = 0.01 s, and the run at 0.02 s"];
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(fragments.iter().all(|fragment| done.err.contains(fragment)), "{}", done.err);
    }
    place.good(&format!("check {motion} --duration 0.01"));
}

#[test]
fn effects_are_added_by_their_kind() {
    let place = Place::new();
    let ideal = "run --duration 0.02 --set contact.law=ideal";
    place.good(&format!(
        "{ideal} --out a --set effect.0.kind=payload --set effect.0.mass_kg=0.1 \
         --set effect.1.kind=drag --set effect.1.force_Ns_m=0.5"
    ));
    place.good(&format!(
        "{ideal} --out b --set \
         effect=[{{kind=\"payload\",mass_kg=0.1}},{{kind=\"drag\",force_Ns_m=0.5}}]"
    ));
    assert_eq!(place.read("a/timeseries.csv"), place.read("b/timeseries.csv"));
    assert_eq!(place.read("a/scenario.toml"), place.read("b/scenario.toml"));
    for (set, fragments) in [
        ("effect.0.mass_kg=1", ["`effect` is a list of 0", "--set effect.0.kind=…"]),
        ("effect.1.kind=drag", ["`effect` is a list of 0", "it has no 1"]),
        ("effect.0.kind=paylode", ["effect.0.kind", "\"paylode\" is not an effect"]),
    ] {
        place.refused(&format!("run --set {set}"), &fragments);
    }
}

/// A tolerance that no hit is resolved at: energy comes from nowhere.
#[test]
fn a_run_that_does_not_balance_says_so() {
    let place = Place::new();
    let done = place.freeplay(
        "run --out r --duration 0.28 --set simulation.tolerance=1e-2 --set environment.gravity=[0,-9.81]",
    );
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("\nerror: the energy is off by "), "{}", done.err);
    let json: Value = serde_json::from_str(&place.read("r/summary.json")).unwrap();
    assert!(json["watched"]["energy"]["imbalance_share"].as_f64().unwrap() > 0.01);
    assert!(!json["watched"]["faults"].as_array().unwrap().is_empty());
    assert!(place.read("r/index.html").contains("Do not trust this run"));

    place.good("run --out s --duration 0.1");
    let json: Value = serde_json::from_str(&place.read("s/summary.json")).unwrap();
    let watched = &json["watched"];
    assert!(watched["energy"]["imbalance_share"].as_f64().unwrap() < 1e-3, "{watched}");
    assert!(watched["own_error"]["position_m"].as_f64().unwrap() < 1e-6, "{watched}");
    assert_eq!(
        (&watched["faults"], &watched["doubts"]),
        (&Value::Array(vec![]), &Value::Array(vec![]))
    );
    assert!(place.read("s/index.html").contains("Energy is off by at most"));
}

/// Of a machine that follows its ideal, rounding was shown as if it were a result: a path error of 3e-7 nm.
#[test]
fn a_machine_without_play_shows_no_rounding_as_a_result() {
    let place = Place::new();
    place.good("run --set contact.law=ideal --duration 0.1 --out ideal --quiet");
    let page = place.read("ideal/index.html");
    assert!(page.contains("Peak joint force") && page.contains("Peak actuator force"));
    for meaningless in
        ["Path error, largest", "rms deviation from ideal", "Impacts", "Peak contact"]
    {
        assert!(!page.contains(meaningless), "{meaningless}");
    }
    // With a servo it does stray.
    place.good(
        "run --set contact.law=ideal --set drive.mode=servo --duration 0.1 --out servo --quiet",
    );
    assert!(place.read("servo/index.html").contains("Path error, largest"));
    place.refused("run --duration 1s", &["expected a number of seconds without a unit"]);
}

/// A run draws no random numbers: a seed that is set changes nothing, and who sets it is told.
#[test]
fn a_seed_that_changes_nothing_is_told() {
    let place = Place::new();
    let done = place.freeplay("run --duration 0.02 --set seed=5 --out a --quiet");
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.err.starts_with("warning: --set seed: is not used"), "{}", done.err);
    place.good("run a/scenario.toml --out b --quiet");
}

#[test]
fn a_key_that_is_set_twice_is_refused() {
    let place = Place::new();
    for line in [
        "run --set joints.clearance=1e-4 --set joints.clearance=2e-4",
        "run --duration 0.1 --set simulation.duration=0.2",
        "sweep --vary motion.phase=0,1 --set joints.clearance=1e-4 --set joints.clearance=1e-4",
    ] {
        place.refused(line, &["is given twice, as ", "give it once"]);
    }
}

/// The peak of the machine without clearance was that of its rows, a fifth too small where ten of them make a second.
#[test]
fn ideal_peaks_are_those_of_the_motion_not_of_rows() {
    let place = Place::new();
    place.write("four-bar.toml", &place.good("init four-bar"));
    let peak = |interval: &str| {
        let line =
            "run four-bar.toml --json --quiet --force --out r --set simulation.output_interval=";
        let summary: Value =
            serde_json::from_str(&place.good(&format!("{line}{interval}"))).unwrap();
        summary["ideal_peak_actuator_torque_Nm"].as_f64().unwrap()
    };
    let (few, many) = (peak("0.1"), peak("5e-4"));
    assert!((few - many).abs() < 1e-2 * many, "{few} {many}");
}

/// Machines without a phase are not advised to sweep over it.
#[test]
fn a_chaotic_run_advises_what_its_machine_has() {
    let place = Place::new();
    let chaotic = "--duration 0.3 --set environment.gravity=[0,-9.81]";
    let circle = place.good(&format!("run {chaotic} --out a"));
    assert!(circle.contains("chaotic") && circle.contains("motion.phase"), "{circle}");
    let pendulum =
        place.good(&format!("run {chaotic} --set mechanism.kind=pendulum --set effect=[] --out b"));
    assert!(pendulum.contains("chaotic") && !pendulum.contains("motion.phase"), "{pendulum}");
    let rest = place.good("run --duration 0.1 --set motion.radius=0 --out c");
    assert!(!rest.contains("chaotic"), "{rest}");
    let page = place.read("c/index.html");
    assert!(page.contains("beyond 0.1 s") && page.contains("small differences hardly grow"));
}
