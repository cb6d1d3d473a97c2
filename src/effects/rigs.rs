//! Small mechanism files for the tests of effects, and what they do.

use crate::engine::{Instant, Schedule, run};
use crate::mechanism::{BodyState, Dynamics, Evaluation};
use crate::scenario::Scenario;
use crate::simulate::{Machine, assemble};
use std::ops::Deref;

/// A crank of 50 mm at 0.5 rad, a rod of 150 mm, a piston on the x axis, gravity, sensors of all sorts.
pub(super) const SLIDER_CRANK: &str = r#"environment = { gravity = [0.0, -9.81] }
[ground.points]
O = [0.0, 0.0]
S = [0.0, 0.0]
[[body]]
name = "crank"
mass = 0.1
inertia = 1e-4
center_of_mass = [0.02, 0.0]
points = { O = [0.0, 0.0], A = [0.05, 0.0] }
start = [0.0, 0.0, 0.5]
[[body]]
name = "rod"
mass = 0.2
inertia = 4e-4
center_of_mass = [0.07, 0.0]
points = { A = [0.0, 0.0], B = [0.15, 0.0] }
start = [0.044, 0.024, -0.16]
[[body]]
name = "piston"
mass = 0.3
inertia = 1e-4
points = { P = [0.0, 0.0] }
start = [0.19, 0.0, 0.0]
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
ring = "piston.P"
journal = "rod.B"
[[joint]]
name = "S"
kind = "prismatic"
base = "ground.S"
axis = 0.0
slider = "piston.P"
[[drive]]
joint = "O"
kind = "prescribed"
[[motion]]
joint = "O"
kind = "line"
start = 0.5
velocity = 0.0
[[output]]
body = "piston"
[[output]]
point = "rod.B"
[[sensor]]
column = "q_O"
quantity = "position"
of = "O"
[[sensor]]
column = "q_A"
quantity = "position"
of = "A"
[[sensor]]
column = "T_O"
quantity = "force"
of = "O"
[[sensor]]
column = "x_A"
quantity = "x"
of = "crank.A"
[[sensor]]
column = "y_A"
quantity = "y"
of = "crank.A"
[[sensor]]
column = "phi_rod"
quantity = "angle"
of = "rod.A"
[[sensor]]
column = "x_B"
quantity = "x"
of = "rod.B"
[[sensor]]
column = "x_P"
quantity = "x"
of = "piston.P"
"#;

/// A table that a servo holds at 0.5 rad.
pub(super) const TURNTABLE: &str = r#"[ground.points]
O = [0.0, 0.0]
[[body]]
name = "table"
mass = 1.0
inertia = 0.01
points = { O = [0.0, 0.0], A = [0.1, 0.0] }
start = [0.0, 0.0, 0.5]
[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "table.O"
[[drive]]
joint = "O"
kind = "servo"
stiffness = 400.0
damping = 1.5
[[motion]]
joint = "O"
kind = "line"
start = 0.5
velocity = 0.0
[[sensor]]
column = "q_O"
quantity = "position"
of = "O"
"#;

/// A wheel of 0.02 kg m² that turns with 5 rad/s, and a slide of 2 kg that moves with 0.5 m/s along x.
pub(super) const WHEEL_AND_SLIDE: &str = r#"[ground.points]
O = [0.0, 0.0]
S = [0.0, 1.0]
[[body]]
name = "wheel"
mass = 1.0
inertia = 0.02
points = { O = [0.0, 0.0] }
start = [0.0, 0.0, 0.0]
velocity = [0.0, 0.0, 5.0]
[[body]]
name = "slide"
mass = 2.0
inertia = 0.1
points = { S = [0.0, 0.0] }
start = [0.0, 1.0, 0.0]
velocity = [0.5, 0.0, 0.0]
[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "wheel.O"
[[joint]]
name = "S"
kind = "prismatic"
base = "ground.S"
axis = 0.0
slider = "slide.S"
[simulation]
tolerance = 1e-8
"#;

/// A machine at its start.
pub(super) struct Rig(Machine);

impl Deref for Rig {
    type Target = Machine;

    fn deref(&self) -> &Machine {
        &self.0
    }
}

impl Rig {
    pub(super) fn states(&self) -> Vec<BodyState> {
        self.mechanism.bodies.iter().map(|body| body.start).collect()
    }

    fn now(&self) -> Evaluation {
        let mut now = Evaluation::new(&self.mechanism);
        let mut dynamics = Dynamics::new(&self.mechanism);
        dynamics.forces(&self.mechanism, 0.0, &self.states(), &mut now);
        dynamics.accelerations(&self.mechanism, &self.states(), &mut now);
        now
    }

    /// Effort of a drive.
    pub(super) fn effort(&self, drive: usize) -> f64 {
        self.now().drive_forces[drive]
    }

    /// Turns a body about its centre of mass.
    pub(super) fn turn(&mut self, body: usize, by: f64) {
        let body = &mut self.0.mechanism.bodies[body];
        body.angle += by;
        body.start.rotation = nalgebra::UnitComplex::new(body.angle);
    }

    /// Angle of a joint.
    pub(super) fn angle(&self, joint: &str) -> f64 {
        let (_, joint) = self.mechanism.joints().find(|(name, _)| *name == joint).unwrap();
        self.mechanism.start_coordinate(joint)
    }

    /// What a sensor reads.
    pub(super) fn reads(&self, column: &str) -> f64 {
        let sensor = self.mechanism.sensors.iter().find(|sensor| sensor.column == column).unwrap();
        let angles: Vec<f64> = self.mechanism.bodies.iter().map(|body| body.angle).collect();
        sensor.reading(&self.mechanism, &self.states(), &angles, &self.now())
    }

    /// What it shows when nothing moves.
    pub(super) fn shows(&self, column: &str) -> f64 {
        let sensor = self.mechanism.sensors.iter().find(|sensor| sensor.column == column).unwrap();
        sensor.scale * self.reads(column) + sensor.offset
    }
}

pub(super) fn closed(text: &str) -> Rig {
    let scenario = Scenario::from_text(text, "test.toml", &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut machine = assemble(&scenario).unwrap_or_else(|e| panic!("{e}"));
    machine.mechanism.close(0.0).unwrap();
    Rig(machine)
}

/// Time, effort of the first drive and states at the rows of a run.
pub(super) fn rows(text: &str, duration: f64) -> Vec<(f64, f64, Vec<BodyState>)> {
    let machine = closed(text);
    let mut rows = Vec::new();
    let schedule = Schedule { duration, interval: duration / 50.0 };
    run(&machine.mechanism, machine.control, schedule, &mut |instant: &Instant| {
        let effort = instant.evaluation.drive_forces.first().copied().unwrap_or_default();
        rows.push((instant.t, effort, instant.states.to_vec()));
    })
    .unwrap();
    rows
}

/// The two bodies at the end of a run.
pub(super) fn ended(text: &str, duration: f64) -> [BodyState; 2] {
    let (_, _, states) = rows(text, duration).pop().unwrap();
    states.try_into().unwrap()
}
