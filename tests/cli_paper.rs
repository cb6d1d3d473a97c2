//! `freeplay paper`, the real binary.

mod cli_common;

use assert_cmd::Command;
use cli_common::{Place, names};
use serde_json::Value;

const FILES: [&str; 12] = [
    "band-accelerations.svg",
    "band-contact.svg",
    "band-forces.svg",
    "figure-4.svg",
    "figure-5.svg",
    "figure-6.svg",
    "figure-7.svg",
    "figure-8.svg",
    "figure-9.svg",
    "index.html",
    "paper.json",
    "scenario.toml",
];

/// What an interval and a limit such as "above 0.1" come to.
fn verdict(ci95: &Value, limit: &str) -> &'static str {
    let (side, limit) = limit.split_once(' ').unwrap();
    let limit: f64 = limit.parse().unwrap();
    let [low, high] = [0, 1].map(|i| ci95[i].as_f64().unwrap());
    let (above, below) = (low > limit, high < limit);
    match (side, above, below) {
        ("above", true, _) | ("below", _, true) => "supported",
        ("above", _, true) | ("below", true, _) => "contradicted",
        _ => "undecided",
    }
}

fn assert_figures(place: &Place) {
    for number in 4..=9 {
        let svg = place.read(&format!("freeplay-paper-default/figure-{number}.svg"));
        let curves = |colour: &str| {
            let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
            let long = lines.filter(|line| line.contains(colour) && line.len() > 1000);
            long.count()
        };
        assert!(svg.contains("C = 0.5 mm") && svg.contains("C = 0.00001 mm"), "{number}");
        assert_eq!((curves("#0072B2"), curves("#222222")), (2, 2), "figure {number}");
    }
}

/// The `i`-th claim is what its values say, under each variant.
fn assert_claim(i: usize, claim: &Value, variants: &[Value]) {
    let (key, limit) = (&claim["key"], claim["limit"].as_str().unwrap());
    assert!(claim["value"].is_number() && claim["ci95"][1].is_number(), "{claim}");
    assert!(!claim["evidence"].as_str().unwrap().is_empty(), "{claim}");
    let mut verdicts = Vec::new();
    for variant in variants {
        let judged = &variant["claims"][i];
        assert_eq!(&judged["key"], key);
        // Growth at every step is judged by all steps, of which the smallest is shown.
        if judged["ci95"][0].is_null() {
            // Endless, against an ideal machine that needs nothing, or never defined.
            assert_ne!(judged["verdict"], "contradicted", "{}: {judged}", variant["key"]);
            verdicts.push(&judged["verdict"]);
            continue;
        }
        let shown = verdict(&judged["ci95"], limit);
        if !key.as_str().unwrap().ends_with("grows") {
            assert_eq!(judged["verdict"], shown, "{}: {judged}", variant["key"]);
        } else if judged["verdict"] == "supported" {
            assert_eq!(shown, "supported", "{}: {judged}", variant["key"]);
        }
        verdicts.push(&judged["verdict"]);
    }
    assert_eq!(&claim["verdict"], verdicts[0]);
    let moves = &claim["over_variants"];
    for word in ["supported", "contradicted", "undecided"] {
        let count = verdicts.iter().filter(|verdict| **verdict == word).count();
        assert_eq!(moves[word], count, "{claim}");
    }
}

fn assert_parameters(parameters: &[Value]) {
    let origin = |name: &str| {
        let row = parameters.iter().find(|p| p["name"].as_str().unwrap().contains(name)).unwrap();
        row["origin"].as_str().unwrap()
    };
    assert_eq!(["C_max", "d_max", "trajectory", "phi"].map(origin), ["assumed"; 4]);
    assert_eq!(["platform, mass", "stiffness K", "density"].map(origin), ["paper"; 3]);
}

#[test]
fn the_study_writes_everything_that_was_promised() {
    let place = Place::new();
    let out = place.good("paper --duration 0.12 --phases 3 --json");
    assert_eq!(place.entries(), ["freeplay-paper-default"]);
    assert_eq!(names(&place.path("freeplay-paper-default")), FILES);
    assert_eq!(out, place.read("freeplay-paper-default/paper.json"));

    assert_figures(&place);

    let json: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&json["program"], &json["phases"]), (&"freeplay".into(), &3.into()));
    assert_eq!(json["scenario_hash"].as_str().unwrap().len(), 64);
    assert_eq!(json["clearances_m"], serde_json::json!([1e-8, 1e-6, 1e-5, 1e-4, 5e-4]));

    let (claims, variants) =
        (json["claims"].as_array().unwrap(), json["variants"].as_array().unwrap());
    assert_eq!((claims.len(), variants.len()), (14, 13));
    for (i, claim) in claims.iter().enumerate() {
        assert_claim(i, claim, variants);
    }
    for variant in variants {
        for case in variant["cases"].as_array().unwrap() {
            assert_eq!(case["halted"], 0, "{}", variant["key"]);
            // On the line the first 0.12 s are a flight: only forces are there for sure.
            let peak = &case["quantities"]["peak_actuator_force_N"];
            assert!(peak["mean"].as_f64().unwrap() > 0.0 && peak["runs"] == 3, "{case}");
        }
    }
    let adams = variants.iter().find(|v| v["key"] == "adams-damping").unwrap();
    assert_eq!(adams["sets"], serde_json::json!(["contact.c_max=1e4", "contact.d_max=1e-4"]));
    assert_parameters(json["parameters"].as_array().unwrap());

    let page = place.read("freeplay-paper-default/index.html");
    let claims = page.find("<section id=\"claims\">").unwrap();
    assert_eq!(page.find("<section"), Some(claims), "the result stands first");
    assert!(!page.contains("NaN") && page.matches("<figcaption>").count() == 9);

    let taken = "paper --out freeplay-paper-default";
    place.refused(taken, &["`freeplay-paper-default` already holds a result", "--force"]);
}

#[test]
fn threads_do_not_matter() {
    let place = Place::new();
    let run = |threads: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_freeplay"));
        let line = "paper --duration 0.03 --phases 2 --json --force --set drive.mode=servo";
        let command = command.args(line.split_whitespace()).current_dir(place.path(""));
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        let mut json: Value = serde_json::from_slice(&output.stdout).unwrap();
        json.as_object_mut().unwrap().remove("wall_s").unwrap();
        json
    };
    assert_eq!(run("1"), run("3"));
}

#[test]
fn wrong_input_is_refused() {
    let place = Place::new();
    place.refused("paper --set motion.kind=quintic", &["motion.kind", "circle", "line"]);
    place.refused("paper --set joints.clearance=1e-4", &["joints.clearance", "1e-8, 1e-6"]);
    place.refused("paper --set joints.bearing_radius=4e-4", &["joints.clearance"]);
    place.refused("paper --set motion.phi=0", &["motion.phi", "singular"]);
    place.refused("paper --set motion.radius=0.09", &["motion.radius", "0.2 to 0.4 m"]);
    place.refused("paper --set motion.center=[0,0.015]", &["stroke", "variant `phi-90`"]);
    for kind in ["pendulum", "drive-stage"] {
        place.refused(
            &format!("paper --set mechanism.kind={kind}"),
            &["--set mechanism.kind: is not the paper's machine", "expected \"3rpr\""],
        );
    }
    assert_eq!(place.freeplay("paper --phases 1").code, 2);
    assert_eq!(place.freeplay("paper scenario.toml").code, 2);
}

/// A tolerance that resolves no hit: claims were judged by such runs, with exit code 0.
#[test]
fn a_study_whose_runs_do_not_balance_says_so() {
    let place = Place::new();
    let sets = "--set simulation.tolerance=0.01 --set simulation.settle=0.05";
    let done = place.freeplay(&format!("paper --duration 0.1 --phases 2 --out p {sets}"));
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("error: assumed at 5e-4 m of clearance: "), "{}", done.err);
    assert!(done.err.contains("of 2 runs: the energy is off by "), "{}", done.err);
    let json: Value = serde_json::from_str(&place.read("p/paper.json")).unwrap();
    let cases = json["variants"][0]["cases"].as_array().unwrap();
    let faulty: u64 = cases.iter().map(|case| case["faulty"].as_u64().unwrap()).sum();
    assert!(faulty > 0, "{cases:?}");
    assert!(place.read("p/index.html").contains("runs with faults"));
}

/// Runs that break down are left out of all means: a study that lost some says so, and does not end well.
#[test]
fn a_study_whose_runs_break_down_says_so() {
    let place = Place::new();
    let sets = "--set simulation.tolerance=0.1 --set simulation.settle=0.05";
    let done = place.freeplay(&format!("paper --duration 0.1 --phases 2 --out p {sets}"));
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("of 2 runs: broke down"), "{}", done.err);
}
