//! `freeplay evaluate`: one run for a program that drives many.

mod cli_common;

use cli_common::Place;
use serde_json::Value;

const SHORT: &str = "--duration 0.05 --set simulation.tolerance=1e-4";

#[test]
fn a_line_has_the_figures_of_run_in_the_order_that_is_asked_for() {
    let place = Place::new();
    let names = ["rms_path_error_m", "impacts", "peak_contact_force_N", "rms_path_error_m"];
    let line = place.good(&format!("evaluate {SHORT} --figures {}", names.join(",")));
    assert_eq!(place.entries(), [""; 0], "nothing is written");
    place.good(&format!("run {SHORT} --out r --quiet"));
    let summary: Value = serde_json::from_str(&place.read("r/summary.json")).unwrap();
    // Both read by one reader, which may miss the last digit.
    let read = |text: &str| serde_json::from_str::<Value>(text).unwrap();
    let figures: Vec<Value> = line.split_whitespace().map(read).collect();
    assert_eq!(figures, names.map(|name| summary[name].clone()));
}

#[test]
fn parameters_come_in_any_form_and_results_go_into_a_file() {
    let place = Place::new();
    let line = format!("evaluate {SHORT} --figures impacts,max_path_error_m");
    let expected =
        place.good(&format!("{line} --set joints.clearance=2e-4 --set drive.mode=servo"));
    place.write("lines", "# mine\njoints.clearance = 2e-4\ndrive.mode = servo\n");
    place.write("json", r#"{"joints.clearance": 0.0002, "drive.mode": "servo"}"#);
    place.write(
        "dakota",
        "   2 variables\n   2.0e-04 joints.clearance\n   servo drive.mode\n   2 functions\n   1 ASV_1:impacts\n   1 ASV_2:error\n",
    );
    place.write(
        "aprepro",
        "{ DAKOTA_VARS = 2 }\n{ joints.clearance = 2.0e-04 }\n{ drive.mode = \"servo\" }\n{ DAKOTA_FNS = 2 }\n",
    );
    for file in ["lines", "json", "dakota", "aprepro"] {
        assert_eq!(place.good(&format!("{line} --parameters {file}")), expected, "{file}");
    }
    assert_eq!(place.good(&format!("{line} --parameters json --results out")), "");
    // A link stays one, and what it points at is written.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("elsewhere", place.path("link")).unwrap();
        place.write("elsewhere", "before");
        place.good(&format!("{line} --parameters json --results link"));
        assert!(place.path("link").symlink_metadata().unwrap().is_symlink());
        assert_eq!(place.read("elsewhere"), place.read("out"));
    }
    assert_eq!(place.read("out"), expected);
}

#[test]
fn without_figures_the_line_is_fail_and_the_reason_on_standard_error() {
    let place = Place::new();
    place.write("none", "joints.clearance\n");
    let weak = "--duration 0.2 --set contact.stiffness=10 --set contact.c_max=0";
    for (line, code, reason) in [
        (
            format!("--figures impact {SHORT}"),
            2,
            "`impact` is no figure of a run; did you mean `impacts`?",
        ),
        (
            format!("--figures impacts {SHORT} --set joints.clearence=1"),
            2,
            "did you mean `clearance`?",
        ),
        (
            format!("--figures impacts {SHORT} --parameters none"),
            2,
            "none:1: `joints.clearance` is no parameter",
        ),
        (format!("--figures impacts {SHORT} --parameters absent"), 2, "absent: cannot be read"),
        ("--figures impacts --set motion.radius=0.09".to_owned(), 2, "leg 1 would have to be"),
        (format!("--figures impacts {weak}"), 1, "broke down at t = 0.0"),
        (
            "--figures step_error_m_s --duration 0.02 --set simulation.step=1e-5".to_owned(),
            1,
            "no `step_error_m_s`",
        ),
    ] {
        let done = place.freeplay(&format!("evaluate {line}"));
        assert_eq!((done.code, done.out.as_str()), (code, "FAIL\n"), "{line}\n{}", done.err);
        assert!(done.err.contains(reason), "{line}\n{}", done.err);
        place.freeplay(&format!("evaluate {line} --results out"));
        assert_eq!(place.read("out"), "FAIL\n", "{line}");
    }
}

/// Nothing is simulated for a line that has nowhere to go.
#[test]
fn results_that_cannot_be_written_are_refused_beforehand() {
    let place = Place::new();
    for file in ["absent/out", "."] {
        let done =
            place.freeplay(&format!("evaluate --duration 1000 --figures impacts --results {file}"));
        assert_eq!((done.code, done.out.as_str()), (2, "FAIL\n"), "{}", done.err);
        assert!(done.err.contains(&format!("--results {file}: cannot be written")), "{}", done.err);
    }
    assert_eq!(place.entries(), [""; 0]);
}

#[test]
fn parameters_that_are_missing_or_given_twice_are_refused() {
    let place = Place::new();
    place.write("empty", "# nothing\n");
    place.write("one", "joints.clearance = 1e-4\n");
    place.write("strange", "foo = 1\n");
    for (line, reason) in [
        ("--parameters empty", "empty: holds no parameter; expected lines"),
        ("--parameters one --set joints.clearance=2e-4", "joints.clearance: is given twice"),
        ("--parameters strange", "--parameters strange: foo: unknown key `foo`"),
    ] {
        let done = place.freeplay(&format!("evaluate --figures impacts {SHORT} {line}"));
        assert_eq!((done.code, done.out.as_str()), (2, "FAIL\n"), "{line}\n{}", done.err);
        assert!(done.err.contains(reason), "{line}\n{}", done.err);
    }
}
