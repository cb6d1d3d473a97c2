//! A machine with a kind and the mechanism file that it expands to are the same machine.

use crate::cli_common::Place;
use freeplay::scenario::Mechanism;
use std::collections::BTreeSet;

/// Runs a scenario and its expansion: the time series must be equal to the byte.
fn same_bytes(place: &Place, name: &str, text: &str, sets: &str) {
    place.write(&format!("{name}.toml"), text);
    let expanded = place.freeplay(&format!("expand {name}.toml {sets}"));
    assert_eq!(expanded.code, 0, "{name} {sets}: {}", expanded.err);
    assert!(expanded.out.contains("[[body]]") && !expanded.out.contains("[mechanism]"));
    place.write(&format!("{name}-expanded.toml"), &expanded.out);
    for (file, sets) in [(name.to_owned(), sets), (format!("{name}-expanded"), "")] {
        let done = place.freeplay(&format!("run {file}.toml --quiet --force --out {file} {sets}"));
        assert_eq!(done.code, 0, "{file} {sets}: {}", done.err);
    }
    let [template, file] =
        ["", "-expanded"].map(|end| place.read(&format!("{name}{end}/timeseries.csv")));
    assert!(template.lines().count() > 20, "{name} {sets}");
    assert_eq!(template, file, "{name} {sets}");
    // A mechanism file is already what it expands to.
    assert_eq!(expanded.out, place.good(&format!("expand {name}-expanded.toml")), "{name} {sets}");
}

const EFFECTS: &str = r#"
[[effect]]
kind = "payload"
mass_kg = 0.1
com_x_m = 0.02
[[effect]]
kind = "joint-wear"
joint = "C2"
clearance_m = 8e-4
[[effect]]
kind = "anchor-offset"
joint = "A1"
dx_m = 1e-4
dy_m = 0.0
"#;

#[test]
fn the_3rpr_and_its_expansion_give_the_same_bytes() {
    let place = Place::new();
    let kind = "[mechanism]\nkind = \"3rpr\"\n[simulation]\nduration = 0.03\n";
    for sets in [
        "",
        "--set drive.mode=servo --set environment.gravity=[0,-9.81]",
        "--set drive.mode=sampled",
        "--set contact.law=ideal",
        "--set contact.law=native --set simulation.step=1e-5",
        "--set simulation.step=2e-5 --set joints.friction=0.1",
        "--set joints.clearance=[1e-4,2e-4,3e-4,1e-4,2e-4,3e-4]",
        "--set motion.kind=quintic",
        "--set motion.kind=line --set drive.mode=servo",
    ] {
        same_bytes(&place, "three", kind, sets);
    }
    same_bytes(&place, "effects", &format!("{kind}{EFFECTS}"), "--set drive.mode=servo");
}

/// Every template, falling down, each in two ways.
const TEMPLATES: [(&str, [&str; 2]); 7] = [
    ("drive-stage", ["", "--set drive.mode=servo"]),
    ("pendulum", ["", "--set joints.clearance=1e-4"]),
    ("slider-crank", ["", "--set drive.mode=servo --set drive.stiffness=400"]),
    ("four-bar", ["", "--set contact.law=ideal"]),
    ("five-bar", ["", "--set contact.law=native --set simulation.step=1e-5"]),
    ("3rrr", ["", "--set joints.clearance=1e-4"]),
    ("double-pendulum", ["", "--set simulation.tolerance=1e-6"]),
];

/// A new kind is among them, too; the 3-RPR has tests of its own.
#[test]
fn every_kind_has_a_line_here() {
    let tried = TEMPLATES.iter().map(|(kind, _)| *kind).chain(["3rpr"]);
    let tried: BTreeSet<&str> = tried.collect();
    assert_eq!(tried, BTreeSet::from(Mechanism::KINDS));
}

const DOWN: &str = "--set environment.gravity=[0,-9.81]";

fn template(kind: &str) -> String {
    format!("[mechanism]\nkind = \"{kind}\"\n[simulation]\nduration = 0.03\n")
}

#[test]
fn every_template_and_its_expansion_give_the_same_bytes() {
    let place = Place::new();
    for (kind, sets) in TEMPLATES {
        for sets in sets {
            same_bytes(&place, kind, &template(kind), &format!("{DOWN} {sets}"));
        }
    }
}

/// Whatever moves them, machines do not hear of the rows: at common instants all columns but the largest values since
/// the row before are the same.
#[test]
fn every_template_moves_the_same_whatever_rows_are_asked_for() {
    let place = Place::new();
    for (kind, sets) in TEMPLATES {
        place.write("machine.toml", &template(kind));

        for sets in sets.iter().chain(&["--engine direct"]) {
            let rows = |interval: &str| -> Vec<String> {
                place.good(&format!(
                    "run machine.toml --quiet --force --out run {DOWN} {sets} \
                     --set simulation.output_interval={interval}"
                ));
                let table = place.read("run/timeseries.csv");
                let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
                let kept = |line: &str| {
                    let cells = line.split(',').zip(&names);
                    let kept: Vec<_> = cells.filter(|(_, name)| !name.ends_with("_max")).collect();
                    kept.into_iter().map(|(cell, _)| format!("{cell},")).collect()
                };
                table.lines().map(kept).collect()
            };
            let (coarse, fine) = (rows("1e-3"), rows("2.5e-4"));
            assert_eq!((coarse.len(), fine.len()), (32, 122), "{kind} {sets}");
            for (k, row) in coarse.iter().enumerate().skip(1) {
                assert_eq!(*row, fine[4 * k - 3], "{kind} {sets}");
            }
        }
    }
}
