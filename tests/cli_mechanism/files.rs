//! Mechanism files for these tests.

/// A crank-rocker with clearance in two joints, its crank turned by a servo.
pub const FOUR_BAR: &str = r#"name = "four-bar"

[ground.points]
O = [0.0, 0.0]
D = [0.2, 0.0]

[[body]]
name = "crank"
mass = 0.15
inertia = 1.5e-4
center_of_mass = [0.02, 0.0]
points = { O = [0.0, 0.0], A = [0.06, 0.0] }
start = [0.0, 0.0, 0.8]

[[body]]
name = "coupler"
mass = 0.2
inertia = 6.7e-4
center_of_mass = [0.09, 0.0]
points = { A = [0.0, 0.0], B = [0.18, 0.0] }
start = [0.042, 0.043, 0.5]

[[body]]
name = "rocker"
mass = 0.25
inertia = 4.7e-4
center_of_mass = [0.07, 0.0]
points = { D = [0.0, 0.0], B = [0.13, 0.0] }
start = [0.2, 0.0, 1.575]

[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "crank.O"

[[joint]]
name = "A"
kind = "revolute"
ring = "crank.A"
journal = "coupler.A"
clearance = 1.5e-4
bearing_radius = 0.008

[[joint]]
name = "B"
kind = "revolute"
ring = "rocker.B"
journal = "coupler.B"
clearance = 2e-4
bearing_radius = 0.008

[[joint]]
name = "D"
kind = "revolute"
ring = "ground.D"
journal = "rocker.D"

[[drive]]
joint = "O"
kind = "servo"
stiffness = 400.0
damping = 1.5

[motion]
joint = "O"
kind = "line"
velocity = 6.0

[simulation]
duration = 0.03
"#;

/// A slider-crank that its slider drives.
pub const SLIDER_CRANK: &str = r#"name = "slider-crank"

[ground.points]
O = [0.0, 0.0]

[[body]]
name = "crank"
mass = 0.12
inertia = 1.1e-4
center_of_mass = [0.02, 0.0]
points = { O = [0.0, 0.0], A = [0.05, 0.0] }
start = [0.0, 0.0, 0.5]

[[body]]
name = "rod"
mass = 0.09
inertia = 2.2e-4
center_of_mass = [0.075, 0.0]
points = { A = [0.0, 0.0], B = [0.15, 0.0] }
start = [0.0439, 0.024, -0.16]

[[body]]
name = "piston"
mass = 0.25
inertia = 8e-5
points = { P = [0.0, 0.0] }
start = [0.192, 0.0, 0.0]

[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "crank.O"

[[joint]]
name = "A"
kind = "revolute"
ring = "crank.A"
journal = "rod.A"

[[joint]]
name = "B"
kind = "revolute"
ring = "rod.B"
journal = "piston.P"

[[joint]]
name = "slide"
kind = "prismatic"
base = "ground.O"
axis = 0.0
slider = "piston.P"

[[drive]]
joint = "slide"
kind = "prescribed"

[motion]
joint = "slide"
kind = "quintic"
from = 0.19
to = 0.15
time = 0.1

[simulation]
duration = 0.1
"#;

/// The text with one passage replaced, which must be there.
pub fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no {from:?} to replace");
    text.replacen(from, to, 1)
}

/// The line, counted from 1, on which a passage stands.
pub fn line(text: &str, passage: &str) -> usize {
    let place = text.find(passage).unwrap_or_else(|| panic!("no {passage:?}"));
    text[..place].matches('\n').count() + 1
}
