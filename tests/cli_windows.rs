//! `freeplay calibrate` and `predict` on machines that nothing holds: free ones, and ones that efforts alone drive.

mod cli_common;

use cli_common::Place;
use serde_json::Value;
use std::fmt::Write as _;

/// A link that a motor swings.
const LINK: &str = r#"name = "link"
environment = { gravity = [0.0, -9.81] }
[ground.points]
O = [0.0, 0.0]
[[body]]
name = "link"
mass = 0.6
inertia = 0.008
center_of_mass = [0.0, -0.2]
points = { O = [0.0, 0.0], E = [0.0, -0.3] }
[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "link.O"
[[drive]]
joint = "O"
kind = "force"
[[sensor]]
column = "q"
quantity = "position"
of = "O"
std = 1e-4
[[sensor]]
column = "torque"
quantity = "force"
of = "O"
"#;

/// Friction of the real one, N·m and N·m·s.
const COULOMB: f64 = 0.08;
const VISCOUS: f64 = 0.01;

/// A run of the real link, whose encoder has this zero, by a simulation of its own: some rows came late, and it
/// begins in motion.
fn run(zero: f64, start: [f64; 2], frequency: f64) -> String {
    let inertia = 0.008 + 0.6 * 0.2 * 0.2;
    let torque = |t: f64| 0.5 * (frequency * t).sin();
    let rate = |t: f64, [q, v]: [f64; 2]| {
        let friction = COULOMB * (v / 0.02).tanh() + VISCOUS * v;
        [v, (torque(t) - friction - 0.6 * 9.81 * 0.2 * q.sin()) / inertia]
    };
    let h = 1e-4;
    let (mut text, mut state) = (String::from("t,q,torque,temperature\n"), start);
    for k in 0..80_000 {
        let t = f64::from(k) * h;
        let late = if k % 20_000 == 10_000 { 7 } else { 0 };
        if k % 20 == late || (late == 0 && k % 20_000 == 10_007) {
            // Noise of 1e-4 rad without a random generator: the golden ratio's multiples are spread evenly.
            let even = (f64::from(k / 20) * 0.618_033_988_749_895).fract() - 0.5;
            let noise = 1e-4 * even * 12f64.sqrt();
            let _ = writeln!(text, "{t:.5},{:.7},{:.6},20", state[0] + zero + noise, torque(t));
        }
        let after = |d: [f64; 2], by: f64| [state[0] + by * d[0], state[1] + by * d[1]];
        let k1 = rate(t, state);
        let k2 = rate(t + h / 2.0, after(k1, h / 2.0));
        let k3 = rate(t + h / 2.0, after(k2, h / 2.0));
        let k4 = rate(t + h, after(k3, h));
        for i in 0..2 {
            state[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
    text
}

fn json(place: &Place, file: &str) -> Value {
    serde_json::from_str(&place.read(file)).expect("JSON")
}

/// The errors of a column over windows of a length.
fn over(windows: &Value, run: &str, length: f64, column: &str) -> f64 {
    let list = windows.as_array().expect("horizons");
    let of = |w: &&Value| w["run"] == run && (w["window_s"].as_f64() == Some(length));
    let found = list.iter().find(of).unwrap_or_else(|| panic!("{run} {length}"));
    let errors = found["errors"].as_array().expect("errors");
    let error = errors.iter().find(|e| e["channel"] == column).expect("column");
    error["after"].as_f64().expect("a number")
}

/// Friction of a link and zeros that an operator set anew for each run are found, in runs that begin in motion.
#[test]
fn friction_and_zeros_of_runs_are_found_in_windows() {
    let place = Place::new();
    place.write("rig.toml", LINK);
    place.write("a.csv", &run(0.03, [0.4, 2.0], 7.0));
    place.write("b.csv", &run(-0.05, [-0.8, 0.0], 4.0));
    place.write("c.csv", &run(0.08, [0.2, -1.0], 5.0));
    place.noted(
        "calibrate --rig rig.toml --data a.csv --data b.csv --validate c.csv --out out --quiet",
    );
    let report = json(&place, "out/report.json");
    let effects = report["effects"].as_array().expect("effects");
    let value = |kind: &str, name: &str| {
        let effect = effects.iter().find(|effect| effect["kind"] == kind);
        let effect = effect.unwrap_or_else(|| panic!("no {kind} among {effects:?}"));
        effect["params"][name]["value"].as_f64().expect("a number")
    };
    let coulomb = value("joint-friction", "coulomb");
    assert!((coulomb / COULOMB - 1.0).abs() < 0.1, "{coulomb}");
    assert!(value("encoder-zero", "run_std") > 0.03);
    let missed = over(&report["windows"]["horizons"], "c.csv", 0.5, "q");
    assert!(missed < 1e-3, "{missed}");
    let remarks = report["windows"]["remarks"].to_string();
    assert!(remarks.contains("early or late") && remarks.contains("temperature"), "{remarks}");

    place.noted("predict out/calibrated.toml --data c.csv --window 0.4 --fit 0.1 --out p --quiet");
    let errors = json(&place, "p/errors.json");
    // The run sticks now and then; 0.1 s of rest say little of a start.
    let missed = over(&errors["windows"], "c.csv", 0.4, "q");
    assert!(missed < 2e-3, "{missed}");
    let zero = errors["run_zeros"][0]["offset"].as_f64().expect("a zero");
    let mean = value("encoder-zero", "offset");
    assert!((zero + mean - 0.08).abs() < 5e-3, "{zero} {mean}");
    assert_eq!(place.read("p/predicted.csv").lines().next(), Some("t,q,torque"));
    place.refused("predict rig.toml --data c.csv --window 0.1 --fit 0.2", &["fit < window"]);
}

fn measured(file: &str) -> Option<std::path::PathBuf> {
    let folder = freeplay::calibrate::hardware::folder(None);
    let file = std::path::absolute(folder).expect("a folder").join(file);
    if !file.is_file() {
        println!("skipped: data not present ({})", file.display());
        return None;
    }
    Some(file)
}

/// A measured arm with two motors, where its recordings are present, against the bars of their README.
#[test]
fn a_measured_arm_is_predicted() {
    let names = ["fit_00", "fit_02", "fit_05", "validate_03", "validate_04"];
    let files = names.map(|name| measured(&format!("two-link-arm/{name}.csv")));
    let [Some(a), Some(b), Some(c), Some(v), Some(w)] = files else { return };
    let place = Place::new();
    place.write("rig.toml", include_str!("../assets/two-link-arm-declared.toml"));
    let data = [a, b, c].map(|file| format!("--data {} ", file.display())).concat();
    println!("{}", place.noted(&format!("calibrate --rig rig.toml {data}--out out")).out);
    let mut squares = [0.0; 4];
    for (i, file) in [v, w].iter().enumerate() {
        let line = format!("predict out/calibrated.toml --data {} --out p{i}", file.display());
        println!("{}", place.noted(&line).out);
        let windows = &json(&place, &format!("p{i}/errors.json"))["windows"];
        let run = file.file_name().expect("a name").to_string_lossy().into_owned();
        for (k, (length, column)) in
            [(0.3, "q1_rad"), (0.3, "q2_rad"), (0.5, "q1_rad"), (0.5, "q2_rad")].iter().enumerate()
        {
            squares[k] += over(windows, &run, *length, column).powi(2) / 2.0;
        }
    }
    for (square, bar) in squares.iter().zip([6.5e-3, 13e-3, 10e-3, 26e-3]) {
        assert!(square.sqrt() <= bar, "{} above {bar}", square.sqrt());
    }
}

/// A measured double pendulum, where its recording is present, against the bar of its README.
#[test]
fn a_measured_double_pendulum_is_predicted() {
    let Some(file) = measured("double-pendulum/double_pendulum_1kHz.csv") else { return };
    let text = std::fs::read_to_string(file).expect("readable");
    let place = Place::new();
    place.write("rig.toml", include_str!("../assets/double-pendulum-declared.toml"));
    for part in ["id", "val"] {
        let of = |line: &&str| line.split(',').nth(1).is_some_and(|p| p == part || p == "split");
        let rows = text.lines().filter(of).map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            format!("{},{},{}\n", cells[0], cells[2], cells[3])
        });
        place.write(&format!("{part}.csv"), &rows.collect::<String>());
    }
    println!("{}", place.good("calibrate --rig rig.toml --data id.csv --out out"));
    let line = "predict out/calibrated.toml --data val.csv --window 2.5 --fit 0.25 --out p";
    println!("{}", place.good(line));
    let windows = &json(&place, "p/errors.json")["windows"];
    for (column, bar) in [("theta1_rad", 2.1e-3), ("theta2_rad", 2.4e-3)] {
        let missed = over(windows, "val.csv", 2.5, column);
        assert!(missed <= bar, "{column}: {missed} above {bar}");
    }
}
