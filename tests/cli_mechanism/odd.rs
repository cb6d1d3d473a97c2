//! Odd but plausible mistakes in mechanism files, and what looks like one and is none.

use crate::files::{FOUR_BAR, with};
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
