//! One slider-crank for two solvers: this project's, and the one in minimal coordinates that the bench
//! races against.

#[path = "../../benches/minimal_coordinates/mod.rs"]
#[allow(dead_code)] // it solves another machine as well
pub mod minimal_coordinates;

use crate::common::hertz;
use freeplay::contact::Clearance;
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::{
    Actuator, Attachment, Bearing, Body, BodyState, Command, Commands, Drive, JointIndex,
    Mechanism, Prismatic, Revolute,
};
use minimal_coordinates::slider_crank::{self as minimal, Sample};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::sync::Arc;

/// Angles of the crank at the start, in rad.
pub const STARTS: [f64; 4] = [0.5, 2.0, -1.0, -2.5];

/// Largest distance in m of two runs' rods or sliders.
pub fn apart(a: &[Sample], b: &[Sample]) -> f64 {
    assert_eq!(a.len(), b.len());
    let distance = |(a, b): (&Sample, &Sample)| {
        let rod = (a.rod[0] - b.rod[0]).hypot(a.rod[1] - b.rod[1]);
        rod.max((a.slider - b.slider).abs())
    };
    a.iter().zip(b).map(distance).fold(0.0, f64::max)
}

/// The solver in minimal coordinates: rows at `times` (s), and steps.
pub fn theirs(start: f64, tolerance: f64, times: &[f64]) -> (Vec<Sample>, u64) {
    let mut rows = Vec::with_capacity(times.len());
    let work = minimal::simulate(start, tolerance, times, |sample| rows.push(sample));
    (rows, work.steps)
}

/// This project: rows of `schedule`, and steps.
pub fn ours(mechanism: &Mechanism, tolerance: f64, schedule: Schedule) -> (Vec<Sample>, u64) {
    let mut rows = Vec::new();
    let work = run(mechanism, StepControl::Tolerance(tolerance), schedule, &mut |instant| {
        let [rod, slider] = [1, 2].map(|body: usize| instant.states[body].position);
        rows.push(Sample { rod: [rod.x, rod.y], slider: slider.x });
    });
    (rows, work.unwrap().steps)
}

#[derive(Debug)]
struct Quintic(f64);

impl Commands for Quintic {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let [position, rate, acceleration] = minimal::command(self.0, t);
        commands.fill(Command { position, rate, acceleration });
    }
}

/// The mechanism with its crank at `start` rad, at rest, its journals centred.
pub fn mechanism(start: f64) -> Mechanism {
    let ([x, y], angle, slider) = minimal::ideal(start);
    let body = |name, mass, inertia, position, angle| {
        let rotation = UnitComplex::new(angle);
        Body::new(name, mass, inertia, BodyState { position, rotation, twist: Vector3::zeros() })
    };
    let centre = UnitComplex::new(start) * Vector2::new(minimal::CRANK_CENTRE, 0.0);
    let bodies = vec![
        body("crank", minimal::CRANK_MASS, minimal::CENTRAL_CRANK_INERTIA, centre, start),
        body("rod", minimal::ROD_MASS, minimal::ROD_INERTIA, Vector2::new(x, y), angle),
        body("slider", minimal::SLIDER_MASS, 8e-5, Vector2::new(slider, 0.0), 0.0),
    ];
    let at = |body, x| Attachment { body: Some(body), point: Vector2::new(x, 0.0) };
    let ground = Attachment { body: None, point: Vector2::zeros() };
    let revolute = |name: &str, ring, journal, bearing| Revolute {
        name: name.into(),
        ring,
        journal,
        bearing,
        out_of_round: None,
    };
    let bearing_radius = minimal::BEARING_RADIUS;
    let journal_radius = bearing_radius - minimal::CLEARANCE;
    let law = Arc::new(hertz(bearing_radius, journal_radius));
    let play =
        Bearing::Clearance(Clearance { bearing_radius, journal_radius, law, friction: None });
    let (crank_end, half) = (minimal::CRANK - minimal::CRANK_CENTRE, 0.5 * minimal::ROD);
    let servo = Drive::Servo { stiffness: minimal::STIFFNESS, damping: minimal::DAMPING };
    Mechanism {
        revolutes: vec![
            revolute("O", ground, at(0, -minimal::CRANK_CENTRE), Bearing::Ideal),
            revolute("A", at(0, crank_end), at(1, -half), play.clone()),
            revolute("B", at(1, half), at(2, 0.0), play),
        ],
        prismatics: vec![Prismatic {
            name: "slide".into(),
            base: ground,
            slider: at(2, 0.0),
            axes: [UnitComplex::identity(); 2],
            play: false,
        }],
        actuators: vec![Actuator::new("O", JointIndex::Revolute(0), servo)],
        commands: Arc::new(Quintic(start)),
        gravity: Vector2::new(0.0, minimal::GRAVITY),
        output: 2,
        ..Mechanism::free(bodies)
    }
}
