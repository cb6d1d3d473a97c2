//! Motions of many periods: what is found of one period is found of all.

use crate::cli_common::Place;
use crate::files::{SLIDER_CRANK, with};
use freeplay::mechanism::Command;
use freeplay::scenario::Scenario;
use freeplay::simulate::assemble;
use std::f64::consts::TAU;

/// The slider-crank of many strokes a second; the piston cannot pass its dead point at 0.2 m.
fn strokes(amplitude: f64, range: &str) -> String {
    let motion = format!(
        "kind = \"multisine\"\ncenter = 0.19\nterms = [{{ amplitude = {amplitude}, frequency = 20.0, phase = \
         0.0 }}]\n"
    );
    let text =
        with(SLIDER_CRANK, "kind = \"quintic\"\nfrom = 0.19\nto = 0.15\ntime = 0.1\n", &motion);
    let text = with(&text, "duration = 0.1", "duration = 100.0");
    with(&text, "slider = \"piston.P\"\n", &format!("slider = \"piston.P\"\n{range}"))
}

/// Poses were once spread evenly over the run, as many as the rates at 4000 instants made it seem: of these
/// strokes all were taken in the middle.
#[test]
fn every_stroke_of_a_long_motion_is_looked_at() {
    let place = Place::new();
    place.write("range.toml", &strokes(0.005, "range = [0.18, 0.193]\n"));
    place
        .refused("check range.toml", &["joint.3.range: slide would have to be 0.195", "its range"]);
    place.write("toggle.toml", &strokes(0.015, ""));
    place.refused("run toggle.toml --out x", &["locks near slide = 0.19", "keep the drive within"]);
    place.write("good.toml", &strokes(0.005, ""));
    let check: serde_json::Value =
        serde_json::from_str(&place.good("check good.toml --json")).unwrap();
    let used = &check["drives"][0]["used"];
    for (end, expected) in [(0, 0.185), (1, 0.195)] {
        // Between two poses the piston goes 0.02 sizes of the machine.
        assert!((used[end].as_f64().unwrap() - expected).abs() < 1e-4, "{used}");
    }
    let [low, high] = [0, 1].map(|i| check["ideal"]["actuator_forces_N"][0][i].as_f64().unwrap());
    assert!(high - low > 20.0, "{low} to {high} N");
}

/// A point on two slides.
const SLIDES: &str = r#"
[ground.points]
O = [0.0, 0.0]
[[body]]
name = "cart"
mass = 1.0
inertia = 1e-3
points = { O = [0.0, 0.0] }
start = [0.25, 0.0, 0.0]
[[body]]
name = "tool"
mass = 1.0
inertia = 1e-3
points = { P = [0.0, 0.0] }
start = [0.25, 0.1, 0.0]
[[joint]]
name = "X"
kind = "prismatic"
base = "ground.O"
slider = "cart.O"
[[joint]]
name = "Y"
kind = "prismatic"
base = "cart.O"
slider = "tool.P"
axis = 1.5707963267948966
angle = 0.0
[[drive]]
joint = "X"
kind = "prescribed"
[[drive]]
joint = "Y"
kind = "prescribed"
[motion]
point = "tool.P"
kind = "circle"
center = [0.2, 0.1]
radius = 0.05
period = 0.01
[simulation]
duration = 100.0
"#;

/// The table of the inverse kinematics once had an end at 65536 samples, and was silently coarser beyond.
#[test]
fn the_inverse_kinematics_of_ten_thousand_circles_is_exact() {
    let scenario = Scenario::from_text(SLIDES, "test.toml", &[]).unwrap_or_else(|e| panic!("{e}"));
    let machine = assemble(&scenario).unwrap_or_else(|e| panic!("{e}"));
    let said = machine.table_error.unwrap();
    assert!(said < 1e-11, "{said}");
    for k in 0..400 {
        let t = 99.9 + 0.000_217 * f64::from(k);
        let mut commands = [Command::default(); 2];
        machine.mechanism.commands.at(t, &mut commands);
        let (sin, cos) = (TAU * t / 0.01).sin_cos();
        for (command, exact) in commands.iter().zip([0.2 + 0.05 * cos, 0.1 + 0.05 * sin]) {
            let missed = (command.position - exact).abs();
            assert!(missed < 2e-11, "t = {t}: {missed}");
        }
    }
}
