//! `freeplay diff`: what differs by more than chance. The real binary.

mod cli_common;

use cli_common::Place;
use serde_json::Value;

fn rows(place: &Place, folder: &str) -> Vec<Value> {
    let text = place.read(&format!("{folder}/diff.json"));
    let diff: Value = serde_json::from_str(&text).unwrap();
    diff["rows"].as_array().unwrap().clone()
}

fn differing(rows: &[Value]) -> Vec<&str> {
    let differ = rows.iter().filter(|row| row["differs"] == true);
    differ.map(|row| row["key"].as_str().unwrap()).collect()
}

#[test]
fn models_differ_where_they_differ_by_more_than_from_start_to_start() {
    let place = Place::new();
    let machine = |clearance: &str| {
        format!(
            "[mechanism]\nkind = \"3rpr\"\n[joints]\nclearance = {clearance}\n[simulation]\nduration = 0.5\n"
        )
    };
    place.write("wide.toml", &machine("5e-4"));
    place.write("same.toml", &machine("5e-4"));
    place.write("tight.toml", &machine("1e-4"));
    let text = place.good("diff wide.toml same.toml --out same");
    assert!(text.starts_with("wide.toml and same.toml differ in none of 15 figures"), "{text}");
    place.good("diff wide.toml tight.toml --out other");
    let found = rows(&place, "other");
    let keys = differing(&found);
    assert!(keys.contains(&"rms_path_error_m") && keys.contains(&"impacts_per_s"), "{keys:?}");
    assert!(found.iter().all(|row| row["floor"].as_f64().unwrap() > 0.0), "{found:?}");
    assert!(place.read("other/index.html").contains("data-plots"));
}

#[test]
fn a_single_chaotic_run_is_told_for_one_draw() {
    let place = Place::new();
    place.good("run --duration 0.3 --out a --quiet");
    place.good("run --duration 0.3 --set joints.clearance=4e-4 --out b --quiet");
    let done = place.freeplay("diff a b --out d");
    assert_eq!(done.code, 0, "{}", done.err);
    for fragment in [
        "warning: The machine is chaotic",
        "one draw",
        "freeplay diff a/scenario.toml b/scenario.toml",
    ] {
        assert!(done.err.contains(fragment), "{}", done.err);
    }
    let found = rows(&place, "d");
    let row = |key: &str| found.iter().find(|row| row["key"] == key).unwrap();
    assert_eq!(
        (&row("peak_contact_force_N")["one_draw"], &row("peak_contact_force_N")["differs"]),
        (&true.into(), &Value::Null)
    );
    // Places differ by more than both runs' own errors, before chaos parts them.
    assert_eq!(row("x")["differs"], true);
    let label = |key: &str| row(key)["label"].as_str().unwrap().to_owned();
    assert_eq!(label("ecc_C1"), "eccentricity of C1, rms");
    assert_eq!(
        [label("q2"), label("F3")],
        ["length of leg 2, rms", "actuator force of leg 3, rms"]
    );
    // Without play there is no chance: figures differ or do not.
    for (out, period) in [("i", "1"), ("j", "1"), ("k", "0.9")] {
        place.good(&format!(
            "run --set contact.law=ideal --duration 0.3 --set motion.period={period} --out {out} --quiet"
        ));
    }
    place.good("diff i j --out same");
    assert_eq!(differing(&rows(&place, "same")), [""; 0]);
    place.good("diff i k --out other");
    assert!(differing(&rows(&place, "other")).contains(&"peak_platform_acceleration_m_s2"));
}

#[test]
fn what_is_neither_run_nor_scenario_is_refused() {
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    place.refused("diff empty empty", &["holds no summary.json", "freeplay run"]);
    place.refused("diff no.toml no.toml", &["no.toml: cannot be read"]);

    place.good("run --duration 0.01 --out a --quiet");
    let series = place.read("a/timeseries.csv");
    place.write("a/timeseries.csv", &series.replacen("\n0,", "\n0,far", 1));
    place.refused(
        "diff a a",
        &["timeseries.csv: ", "line 2, column x: expected a number, found `far"],
    );
    let [first, second] = [series.lines().nth(1).unwrap(), series.lines().nth(2).unwrap()];
    place.write("a/timeseries.csv", &series.replacen(second, first, 1));
    place.refused("diff a a", &["timeseries.csv: ", "line 3: expected a time after that"]);
}

/// The sentence names the number of floors that the table goes by, options are told by their names, unlike machines
/// are told.
#[test]
fn thresholds_and_unlike_machines_are_told() {
    let place = Place::new();
    let short = "--duration 0.05 --set simulation.tolerance=1e-4 --quiet";
    place.good(&format!("run {short} --out a"));
    place.good(&format!("run {short} --set mechanism.kind=pendulum --set environment.gravity=[0,-9.81] --set effect=[] --out b"));
    place.refused("diff a b --engine direct", &["--engine: two results"]);
    let done = place.freeplay("diff a b --out d");
    assert!(done.code == 0 && done.out.contains("by more than 3 × their floors"), "{}", done.out);
    assert!(done.err.contains("warning: The machines are unlike"), "{}", done.err);
    place.refused("diff a b --starts 2", &["--starts: two results"]);
    let longer = place.read("a/scenario.toml").replacen("duration = 0.05", "duration = 0.06", 1);
    place.write("longer.toml", &longer);
    let done = place.freeplay("diff a/scenario.toml longer.toml --starts 2 --out t");
    assert!(
        done.code == 0 && done.err.starts_with("warning: The times that count are unlike"),
        "{}",
        done.err
    );
    let text = place.good("diff a/scenario.toml a/scenario.toml --starts 2 --out e");
    assert!(text.replace('\n', " ").contains("by more than 1.5 × their floors"), "{text}");
}
