//! Wear under a constant load against Archard's law in closed form: `V = k F s`, k the wear coefficient over the hardness,
//! s the distance that the journal slides.

mod cli_common;

use cli_common::Place;
use freeplay::contact::{Material, StiffnessForm, hertz_stiffness};
use serde_json::Value;
use std::f64::consts::TAU;

const CLEARANCE: f64 = 1e-4;
const RADIUS: f64 = 0.01;
/// Axial length of the bearing in m: its diameter.
const LENGTH: f64 = 0.02;
/// Load in N, and rate in rad/s at which the body turns.
const LOAD: f64 = 2.0 * 9.81;
const RATE: f64 = 10.0 * TAU / 2.0;
/// Of both surfaces: the default's.
const MATERIAL: Material = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };
/// 1/Pa.
const COEFFICIENT: f64 = 1e-13;

/// A body of 2 kg that its weight presses on a pin, and a drive turns; `ring` and `journal` say which is which. It starts
/// where it rests.
fn pin(ring: &str, journal: &str) -> String {
    format!(
        "name = \"pin\"\n[environment]\ngravity = [0.0, -9.81]\n[ground.points]\nO = [0.0, 0.0]\n\
         [[body]]\nname = \"disc\"\nmass = 2.0\ninertia = 1e-3\npoints = {{ O = [0.0, 0.0] }}\n\
         [[joint]]\nname = \"O\"\nkind = \"revolute\"\nring = \"{ring}\"\njournal = \"{journal}\"\n\
         clearance = {CLEARANCE:e}\nbearing_radius = {RADIUS}\n\
         [motion]\njoint = \"O\"\nkind = \"line\"\nvelocity = {RATE}\n\
         [contact]\nc_max = 5000.0\nwear_coefficient = {COEFFICIENT:e}\n\
         [simulation]\nduration = 0.5\nsettle = 0.3\n"
    )
}

fn json(place: &Place, line: &str) -> Value {
    serde_json::from_str(&place.good(&format!("{line} --quiet --json"))).unwrap()
}

fn near(found: &Value, expected: f64, share: f64) {
    let number = found.as_f64().unwrap();
    assert!((number / expected - 1.0).abs() < share, "{number:e}, expected {expected:e}");
}

/// How far a journal has come that a load in one direction has worn into a ring at rest, in m: it removes
/// `2 R L (e sin φ₀ − c φ₀)`, `cos φ₀ = c/e`.
fn depth(volume: f64) -> f64 {
    let (mut low, mut high) = (CLEARANCE, 100.0 * CLEARANCE);
    for _ in 0..100 {
        let e: f64 = 0.5 * (low + high);
        let edge = (CLEARANCE / e).acos();
        let removed = 2.0 * RADIUS * LENGTH * (e * edge.sin() - CLEARANCE * edge);
        if removed > volume { high = e } else { low = e }
    }
    low - CLEARANCE
}

/// What a run counts in its last 0.2 s, and what a ring at rest becomes, under both engines.
#[test]
fn a_ring_at_rest_wears_in_one_place() {
    let place = Place::new();
    place.write("pin.toml", &pin("ground.O", "disc.O"));
    let rubbed = LOAD * RATE * (RADIUS - CLEARANCE) * 0.2;
    for engine in ["rapier", "direct"] {
        let run = json(&place, &format!("run pin.toml --engine {engine} --out run-{engine}"));
        near(&run["joints"][0]["wear_J"], rubbed, 1e-6);
        let table = place.read(&format!("run-{engine}/wear.csv"));
        let mut rows = table.lines();
        assert_eq!(rows.next(), Some("angle,wear_O"));
        let cells =
            |row: &str| row.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>();
        let rows: Vec<Vec<f64>> = rows.map(cells).collect();
        assert_eq!(rows.len(), 360);
        assert!((rows[270][0] - 0.75 * TAU).abs() < 1e-12);
        assert!((rows[270][1] / rubbed - 1.0).abs() < 1e-6, "{:e}", rows[270][1]);

        let out = format!("worn-{engine}");
        let worn =
            json(&place, &format!("wear pin.toml --cycles 2e5 --engine {engine} --out {out}"));
        let volume = COEFFICIENT * rubbed * 2e5;
        near(&worn["period_s"], 0.2, 1e-12);
        near(&worn["joints"][0]["volume_m3"], volume, 1e-6);
        near(&worn["joints"][0]["clearance_m"], CLEARANCE + volume / (TAU * RADIUS * LENGTH), 1e-6);
        near(&worn["joints"][0]["depth_m"], depth(volume), 1e-4);
        assert!(place.read(&format!("{out}/index.html")).contains("<svg"));
    }
    // The worn machine is a scenario like any other: its journal lies deeper by the depth, and as deep in the ring as Hertz'
    // contact is. The ring's table rounds the corner of the groove over a degree, by 1 % of the reach.
    let worn = json(&place, "run worn-rapier/worn.toml --out again");
    let pressed = (LOAD
        / hertz_stiffness(StiffnessForm::Printed, MATERIAL, RADIUS, RADIUS - CLEARANCE))
    .powf(2.0 / 3.0);
    let expected = CLEARANCE + depth(COEFFICIENT * rubbed * 2e5) + pressed;
    near(&worn["joints"][0]["max_eccentricity_m"], expected, 0.012);
    near(&worn["joints"][0]["wear_J"], rubbed, 1e-6);
}

/// A ring that turns under the load wears all round, by `k F s/(2π R L)`. It slides a little faster than its radius turns:
/// the pin's surface lies as deep in it as Hertz' contact is.
#[test]
fn a_ring_that_turns_wears_evenly() {
    let place = Place::new();
    place.write("pin.toml", &pin("disc.O", "ground.O"));
    let run = json(&place, "run pin.toml --out run");
    let deep = run["joints"][0]["max_eccentricity_m"].as_f64().unwrap() - CLEARANCE;
    let rubbed = LOAD * RATE * (RADIUS + deep) * 0.2;
    near(&run["joints"][0]["wear_J"], rubbed, 1e-6);
    let worn = json(&place, "wear pin.toml --cycles 2e4 --out worn");
    let grown = COEFFICIENT * rubbed * 2e4 / (TAU * RADIUS * LENGTH);
    near(&worn["joints"][0]["clearance_m"], CLEARANCE + grown, 1e-6);
    near(&worn["joints"][0]["largest_clearance_m"], CLEARANCE + grown, 2e-3);
    // Half a turn a cycle wears half as much here; that it is no whole number of turns is told.
    let halves =
        place.freeplay("wear pin.toml --cycles 4e4 --period 0.1 --out halves --json --quiet");
    assert_eq!(halves.code, 0, "{}", halves.err);
    assert!(halves.err.starts_with("warning: --period: is 0.1 s"), "{}", halves.err);
    let halves: Value = serde_json::from_str(&halves.out).unwrap();
    near(&halves["joints"][0]["clearance_m"], CLEARANCE + grown, 1e-6);
}

#[test]
fn what_is_missing_or_impossible_is_told() {
    let place = Place::new();
    place.write("pin.toml", &pin("ground.O", "disc.O"));
    place.refused("wear pin.toml --cycles 0", &["--cycles: is 0; expected above 0"]);
    place.refused("wear pin.toml --cycles -5", &["--cycles: is -5; expected above 0"]);
    place.refused("wear pin.toml --cycles 1 --tolerance 2", &["--tolerance: is 2"]);
    place.refused(
        "wear pin.toml --cycles 1 --period 0.4",
        &["--period: is 0.4 s", "at most what a run counts"],
    );
    place.refused(
        "wear pin.toml --cycles 1 --period 1e-300",
        &["--period: is 1e-300 s", "expected at least the time between two rows"],
    );
    let short = "wear --cycles 1 --set contact.wear_coefficient=1e-14 --set motion.period=0.1 --duration 0.06";
    let done = place.freeplay(&format!("{short} --out lengthened"));
    assert!(done.err.contains("warning: runs take 0.13 s"), "{}", done.err);
    let quintic = "wear --cycles 1 --set contact.wear_coefficient=1e-13 --set motion.kind=quintic";
    place.refused(quintic, &["--period: is missing"]);
    let swings = "wear --cycles 10 --set mechanism.kind=pendulum --set environment.gravity=[0,-9.81] --set effect=[]";
    place.refused(swings, &["--period: is missing"]);
    place.refused(
        "wear --cycles 1 --period 0.5",
        &["contact.wear_coefficient", "is missing", "1/Pa"],
    );
    let ideal =
        "wear --cycles 1 --period 0.5 --set contact.wear_coefficient=1e-13 --set contact.law=ideal";
    place.refused(ideal, &["leaves nothing that wears"]);
    place.refused("run --set contact.wear_coefficient=-1", &["contact.wear_coefficient: is -1"]);
    place.refused(
        "run pin.toml --set joint.O.profile=[0,0]",
        &["has 2 values", "expected 4 or more"],
    );
    place.refused(
        "run pin.toml --set joint.O.profile=[0,0,0,-2e-4]",
        &["narrows the ring by 0.0002 m"],
    );
    place.refused(
        "run pin.toml --set joint.O.profile=[0,0,0,0] --set contact.law=native",
        &["not possible under the law \"native\""],
    );
}
