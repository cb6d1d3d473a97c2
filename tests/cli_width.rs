//! What commands print fits a terminal of 80 columns, and words stay whole. The real binary.

mod cli_common;

use cli_common::Place;

/// Lines that name files are as long as these names, and examples are to be copied.
fn may_be_long(line: &str) -> bool {
    ["Written to", "Now:"].iter().any(|start| line.starts_with(start)) || line.contains(" = ")
}

fn fits(place: &Place, line: &str) {
    let done = place.freeplay(line);
    assert!(done.code < 2, "{line}: {}", done.err);
    for printed in done.out.lines().filter(|line| !may_be_long(line)) {
        let width = printed.chars().count();
        assert!(width <= 80, "{line}: {width} columns\n{printed}\nin\n{}", done.out);
    }
}

#[test]
fn every_command_prints_at_most_80_columns() {
    let place = Place::new();
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-1");
    let four_bar = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/mechanisms/four-bar.toml");
    fits(&place, "run --duration 0.1 --out run");
    fits(&place, "run --duration 0.12 --out other");
    for line in [
        "check",
        &format!("check {four_bar}"),
        "effects",
        "laws",
        "compare --steps 2e-5,1e-5 --starts 2 --duration 0.1",
        "compare --laws hertz-step,flores,lankarani-nikravesh --starts 2 --duration 0.1",
        "paper --phases 2 --duration 0.05",
        "sweep --vary joints.clearance=1e-4,5e-4 --duration 0.1",
        "diff run other",
        "diff run/scenario.toml other/scenario.toml --starts 2",
        "study emps",
        &format!("record {rig}/rig.toml --duration 1.2 --out record"),
        &format!(
            "plan --rig {rig}/rig.toml --data {rig}/run-a.csv --detect payload --duration 1 --candidates 8"
        ),
        &format!("predict {rig}/rig.toml --data {rig}/run-b.csv"),
        "calibrate --rig record/rig.toml --data record/run-a.csv --validate record/run-b.csv",
    ] {
        fits(&place, line);
    }
}

#[test]
fn names_of_laws_and_values_stay_whole() {
    let place = Place::new();
    let text = place.good("compare --steps 2e-5,1e-5 --starts 2 --duration 0.1");
    for word in ["hertz-step", "tolerance", "native", "2e-5 s"] {
        assert!(text.contains(word), "{word} is broken:\n{text}");
    }
    // The answer stands before the figures.
    assert!(text.find("In this machine") < text.find("hertz-step"), "{text}");
}

#[test]
fn studies_print_json_and_keep_quiet() {
    let place = Place::new();
    let skipped: serde_json::Value =
        serde_json::from_str(&place.good("study emps --json")).unwrap();
    assert!(skipped["skipped"].as_str().unwrap().contains("data not present"), "{skipped}");
    assert_eq!(place.good("study pendulum --quiet"), "");
}

/// Examples are to be copied: none is broken by a terminal of 80 columns.
#[test]
fn examples_of_help_stay_whole() {
    let place = Place::new();
    // What clap takes for the width of a terminal that it cannot ask is wider than many are.
    let help = place.good("--help");
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands = commands.take_while(|line| !line.is_empty());
    let names: Vec<&str> = commands
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(names.len() > 15, "{names:?}");
    for command in names.into_iter().chain([""]) {
        let help = place.good(format!("{command} --help").trim());
        let examples = help.lines().skip_while(|line| *line != "Examples:").skip(1);
        let mut goes_on = false;
        for line in examples.take_while(|line| line.starts_with("  ")) {
            assert!(goes_on || line.starts_with("  freeplay"), "{command}: {line}");
            assert!(line.chars().count() <= 80, "{command}: {line}");
            goes_on = line.ends_with('\\');
        }
    }
}
