//! Odd but plausible mistakes in mechanism files, and what looks like one and is none.

use crate::cli_common::Place;
use crate::files::{FOUR_BAR, SLIDER_CRANK, with};
use crate::refusals::{refuse, wrong};

/// A bar and what holds it to the ground.
fn bar(joint: &str) -> String {
    format!(
        "[ground.points]\nO = [0.0, 0.0]\n[environment]\ngravity = [0.0, -9.81]\n[[body]]\nname = \"bar\"\nmass \
         = 0.1\ninertia = 1e-4\npoints = {{ O = [0.0, 0.0], A = [0.1, 0.0] }}\n{joint}[simulation]\nduration = \
         0.02\n"
    )
}

const WELD: &str =
    "[[joint]]\nname = \"W\"\nkind = \"fixed\"\nbase = \"ground.O\"\npart = \"bar.O\"\n";

/// A second bar on the first one.
const SECOND: &str = "[[body]]\nname = \"second\"\nmass = 0.1\ninertia = 1e-4\npoints = { P = [0.0, 0.0] }\n\
    start = [0.1, 0.0, 0.0]\n[[joint]]\nname = \"J\"\nkind = \"revolute\"\nring = \"bar.A\"\njournal = \
    \"second.P\"\n";

/// Where fixed joints held all bodies to the ground there was no body to be the output, and a panic.
#[test]
fn nothing_that_moves() {
    let says =
        "joint.0: \"W\" leaves nothing that moves: fixed joints hold every body to the ground";
    let output = format!("{WELD}[[output]]\npoint = \"bar.A\"\n");
    refuse(vec![
        wrong(bar(WELD), "[[joint]]", says, &["make one of them revolute or prismatic"]),
        wrong(
            bar(&output),
            "[[output]]",
            "output.0: is of \"bar.A\", which does not move",
            &["name a body that joints let move", "leaves nothing that moves"],
        ),
    ]);
}

#[test]
fn what_would_have_no_effect() {
    let spring = |keys: &str| format!("{FOUR_BAR}[[spring]]\n{keys}");
    refuse(vec![
        wrong(
            format!("{FOUR_BAR}[[output]]\npoint = \"ground.D\"\n"),
            "[[output]]",
            "output.0: is of \"ground.D\", which does not move",
            &["name a body"],
        ),
        wrong(
            spring("between = [\"crank.O\", \"crank.A\"]\nstiffness = 100.0\n"),
            "between",
            "spring.0.between: \"crank.O\" and \"crank.A\" move as one",
            &["a spring acts between two bodies"],
        ),
        wrong(
            spring("between = [\"ground.O\", \"ground.D\"]\nstiffness = 100.0\n"),
            "between",
            "spring.0.between: \"ground.O\" and \"ground.D\" move as one",
            &["a spring acts between two bodies"],
        ),
        wrong(
            spring("between = [\"rocker.B\", \"ground.O\"]\nfree_length = 0.1\n"),
            "[[spring]]",
            "spring.0: has neither stiffness nor damping",
            &["write stiffness = …"],
        ),
    ]);
}

#[test]
fn columns_of_two_drives_and_plates_that_cross() {
    let second = "label = \"_D\"\n\n[[drive]]\njoint = \"D\"\nkind = \"force\"\n\n[motion]";
    let mass = "mass = 0.15\ninertia = 1.5e-4\ncenter_of_mass = [0.02, 0.0]\npoints = { O = [0.0, 0.0], A = \
                [0.06, 0.0] }\n";
    let plate = "shape = { kind = \"polygon\", corners = [\"O\", \"C\", \"A\", \"B\"], thickness = 0.01, density = \
                 7800.0 }\npoints = { O = [0.0, 0.0], A = [0.06, 0.0], C = [0.06, 0.03], B = [0.0, 0.05] }\n";
    refuse(vec![
        wrong(
            with(FOUR_BAR, "\n[motion]", second),
            "[[drive]]\njoint = \"D\"",
            "drive.1: names the columns q_D twice",
            &["give one of them another label"],
        ),
        wrong(
            with(FOUR_BAR, mass, plate),
            "shape",
            "body.0.shape.corners: crosses itself: O-C and A-B",
            &["in their order around the plate"],
        ),
    ]);
}

/// Bodies that hang together and float are simulated, and told; springs hold as well as joints.
#[test]
fn machines_that_nothing_holds_to_the_ground_are_told() {
    let place = Place::new();
    place.write("float.toml", &bar(SECOND));
    let told = "warning: float.toml:5: body.0: \"bar\", \"second\" float: no joint and no spring connects them to the \
                ground";
    for command in ["check float.toml", "run float.toml --out float --quiet"] {
        let done = place.freeplay(command);
        assert!(done.code == 0 && done.err.starts_with(told), "{command}: {}", done.err);
        assert!(done.err.contains("fly free"), "{}", done.err);
    }
    // Both fall as one: ½ g t².
    let csv = place.read("float/timeseries.csv");
    let y: f64 = csv.lines().last().unwrap().split(',').nth(2).unwrap().parse().unwrap();
    assert!((y + 0.5 * 9.81 * 0.02 * 0.02).abs() < 1e-9, "{y}");

    // A part of a machine that floats beside it.
    let beside = SECOND.replace("bar.A", "third.P");
    let third =
        "[[body]]\nname = \"third\"\nmass = 0.1\ninertia = 1e-4\npoints = { P = [0.0, 0.0] }\n";
    place.write("beside.toml", &format!("{SLIDER_CRANK}{third}{beside}"));
    let done = place.freeplay("check beside.toml");
    assert!(
        done.code == 0 && done.err.contains("body.3: \"third\", \"second\" float"),
        "{}",
        done.err
    );

    // A body on a rope.
    let rope = "[[spring]]\nbetween = [\"bar.A\", \"ground.O\"]\nstiffness = 1000.0\nfree_length = 0.1\npull_only \
                = true\n";
    place.write("rope.toml", &bar(rope));
    place.good("check rope.toml");
    place.good("run rope.toml --out rope --quiet");
    let csv = place.read("rope/timeseries.csv");
    assert!(csv.lines().count() > 10 && !csv.contains("NaN"), "{csv}");
}

/// What is looked at beforehand has an end, and says where.
#[test]
fn a_motion_of_too_many_turns_is_told() {
    let place = Place::new();
    let drive = "[[joint]]\nname = \"O\"\nkind = \"revolute\"\nring = \"ground.O\"\njournal = \"bar.O\"\n\
                 [motion]\njoint = \"O\"\nkind = \"line\"\nvelocity = 2e6\n";
    place.write("fast.toml", &bar(drive));
    let done = place.freeplay("check fast.toml");
    // Twenty thousand poses 0.02 rad apart, at 2e6 rad/s.
    let told = "motion: is looked at up to t = 1.999e-4 s";
    assert!(done.code == 0 && done.err.contains(told), "{}", done.err);

    // A point that circles faster than any table of its drives' commands could say.
    let five_bar = include_str!("../../assets/mechanisms/five-bar.toml");
    place.write("circles.toml", five_bar);
    let done = place.freeplay("check circles.toml --set motion.period=1e-7");
    let told = "circles.toml:21: motion: carries \"left rod.E\" around 10020000 times, and a table of the \
                inverse kinematics holds 1728 turns at most; a slower motion, or a shorter run";
    assert!(done.code == 2 && done.err.contains(told), "{} {}", done.code, done.err);
}
