//! The paper's machine and the independent solver's curves, for tests.

#![allow(dead_code)] // compiled into every test binary, and none of them uses all of it

use freeplay::contact::{
    Clearance, CoulombFriction, HertzStep, Material, StiffnessForm, hertz_stiffness,
};
use freeplay::engine::{Instant, Schedule, StepControl, Work, run};
use freeplay::mechanism::{Bearing, BodyState, Drive, Dynamics, Evaluation, Mechanism};
use freeplay::scenario::Scenario;
use freeplay::simulate::assemble;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

/// Servo gains of the reference curves.
pub const SERVO: Drive = Drive::Servo { stiffness: 5e5, damping: 300.0 };

/// What the reference curves vary.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub clearance: f64,
    pub drive: Drive,
    pub gravity: f64,
    pub phase: f64,
    pub friction: f64,
}

impl Default for Case {
    fn default() -> Self {
        Self { clearance: 5e-4, drive: Drive::Prescribed, gravity: 0.0, phase: 0.0, friction: 0.0 }
    }
}

pub fn hertz(bearing: f64, journal: f64) -> HertzStep {
    let material = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };
    let stiffness = hertz_stiffness(StiffnessForm::Printed, material, bearing, journal);
    HertzStep { stiffness, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true }
}

impl Case {
    pub fn bearing(&self) -> Bearing {
        let (bearing_radius, journal_radius) = (0.01, 0.01 - self.clearance);
        Bearing::Clearance(Clearance {
            bearing_radius,
            journal_radius,
            law: Arc::new(hertz(bearing_radius, journal_radius)),
            friction: (self.friction > 0.0)
                .then_some(CoulombFriction { coefficient: self.friction, velocity: 1e-3 }.into()),
        })
    }

    pub fn mechanism(&self) -> Mechanism {
        self.with(self.bearing())
    }

    /// The machine with every joint as `bearing`.
    pub fn with(&self, bearing: Bearing) -> Mechanism {
        let drive = match self.drive {
            Drive::Servo { stiffness, damping } => {
                vec![
                    "drive.mode=servo".into(),
                    format!("drive.stiffness={stiffness:e}"),
                    format!("drive.damping={damping:e}"),
                ]
            }
            _ => Vec::new(),
        };
        let sets = [
            format!("motion.phase={:e}", self.phase),
            format!("environment.gravity=[0,{:e}]", self.gravity),
        ];
        let scenario = Scenario::load(None, &[&sets[..], &drive[..]].concat()).unwrap();
        let mut mechanism = assemble(&scenario).unwrap().mechanism;
        for joint in &mut mechanism.revolutes {
            joint.bearing = bearing.clone();
        }
        mechanism
    }
}

/// A curve of the independent solver: columns by name.
pub struct Curve {
    headers: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Curve {
    pub fn read(name: &str) -> Self {
        let path = format!("{}/assets/reference/{name}", env!("CARGO_MANIFEST_DIR"));
        let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
        let headers = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let rows = reader
            .records()
            .map(|r| r.unwrap().iter().map(|f| f.parse().unwrap()).collect())
            .collect();
        Self { headers, rows }
    }

    pub fn column(&self, name: &str) -> Vec<f64> {
        let i = self.headers.iter().position(|h| h == name).unwrap_or_else(|| panic!("{name}"));
        self.rows.iter().map(|r| r[i]).collect()
    }
}

/// Largest distance of the platform from a reference curve, in m, over its rows up to `until` s.
pub fn platform_error(
    mechanism: &Mechanism,
    control: StepControl,
    curve: &Curve,
    until: f64,
) -> (f64, Work) {
    let (t, x, y) = (curve.column("t"), curve.column("x"), curve.column("y"));
    let rows = t.iter().take_while(|t| **t <= until + 1e-9).count();
    let interval = (t[rows - 1] - t[0]) / (rows - 1) as f64;
    let mut worst = 0.0f64;
    let mut k = 0;
    let schedule = Schedule { duration: t[rows - 1], interval };
    let work = run(mechanism, control, schedule, &mut |instant: &Instant| {
        assert!((instant.t - t[k]).abs() < 1e-9, "row {k}: {} {}", instant.t, t[k]);
        let p = instant.states[mechanism.output].position;
        worst = worst.max((p.x - x[k]).hypot(p.y - y[k]));
        k += 1;
    })
    .unwrap();
    assert_eq!(k, rows);
    (worst, work)
}

/// The machine without clearance at one instant: it moves exactly as commanded.
#[derive(Clone, Copy, Debug)]
pub struct IdealMachine {
    pub position: Vector2<f64>,
    pub acceleration: Vector2<f64>,
    pub drive_forces: [f64; 3],
}

impl IdealMachine {
    /// At time `t` of `case`: a machine whose circle begins there is built in that very state.
    pub fn at(case: Case, t: f64) -> Self {
        let phase = case.phase + 2.0 * PI * t;
        let mechanism = Case { phase, ..case }.with(Bearing::Ideal);
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let mut dynamics = Dynamics::new(&mechanism);
        let mut evaluation = Evaluation::new(&mechanism);
        dynamics.forces(&mechanism, 0.0, &states, &mut evaluation);
        dynamics.accelerations(&mechanism, &states, &mut evaluation);
        Self {
            position: states[mechanism.output].position,
            acceleration: evaluation.accelerations[mechanism.output].xy(),
            drive_forces: std::array::from_fn(|i| evaluation.drive_forces[i]),
        }
    }
}

/// Largest drive force |F| in N of all steps since the row before.
pub fn peak_drive_force(instant: &Instant) -> f64 {
    instant.peaks.drive_force
}

/// Kinetic energy in J of bodies with these masses and inertias.
pub fn kinetic_energy(mechanism: &Mechanism, states: &[BodyState]) -> f64 {
    let energy =
        |m: f64, i: f64, v: Vector3<f64>| 0.5 * (m * v.xy().norm_squared() + i * v.z * v.z);
    mechanism.bodies.iter().zip(states).map(|(b, s)| energy(b.mass, b.inertia, s.twist)).sum()
}
