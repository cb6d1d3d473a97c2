//! One mass hits a ring head-on, against the closed table of an independent solver
//! (`assets/reference/impact.csv`): peak force, contact time, rebound speed, order of convergence.
//!
//! The table's contact time lasts from touch to parting (δ > 0). A tally counts the time with force
//! (F > 0), which is shorter where the clip cuts off a pull; a fine integration of the law gives it.

mod common;

use common::Curve;
use freeplay::contact::{Clearance, ForceLaw, HertzStep};
use freeplay::engine::{
    ClearanceJoint, ClearanceJoints, Instant, Schedule, StepControl, physics_world, run,
};
use freeplay::mechanism::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
use nalgebra::{UnitComplex, Vector2, Vector3};
use rapier2d_f64::dynamics::{MassProperties, RigidBodyBuilder, RigidBodyHandle};
use rapier2d_f64::math::Vector;
use rapier2d_f64::pipeline::PhysicsWorld;
use std::sync::Arc;

/// Radial clearance in m; a head-on hit does not depend on it.
const CLEARANCE: f64 = 1e-4;
/// Steps of free flight before the hit.
const FLIGHT: f64 = 3.0;

/// A row of the table.
#[derive(Clone, Copy, Debug)]
struct Row {
    mass: f64,
    speed: f64,
    law: HertzStep,
    expected: Hit,
}

/// What a hit gives.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// Peak force in N.
    peak: f64,
    /// Time from touch to parting in s.
    overlap: f64,
    /// Time with force in s.
    force_time: f64,
    /// Rebound over impact speed.
    rebound: f64,
}

fn table() -> Vec<Row> {
    let read = |row: &Vec<f64>| {
        let &[mass, speed, stiffness, exponent, c_max, d_max, peak, _, time, rebound] =
            row.as_slice()
        else {
            panic!("ten columns: {row:?}")
        };
        let law = HertzStep { stiffness, exponent, c_max, d_max, clip: true };
        let force_time = force_time(mass, speed, &law);
        Row { mass, speed, law, expected: Hit { peak, overlap: time, force_time, rebound } }
    };
    Curve::read("impact.csv").rows.iter().map(read).collect()
}

/// Time with force in s: `m δ̈ = −F(δ, δ̇)` by the classical Runge–Kutta method at 0.1 µs. (Under the
/// clip the force ends twice: near the surface the spring outgrows the damper's pull again.)
fn force_time(mass: f64, speed: f64, law: &HertzStep) -> f64 {
    const STEP: f64 = 1e-7;
    let force = |y: [f64; 2]| law.normal_force(y[0], y[1]);
    let slope = |y: [f64; 2]| [y[1], -force(y) / mass];
    let along = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
    let mut y = [0.0, speed];
    let mut steps = 0;
    while y[0] >= 0.0 {
        let k1 = slope(y);
        let k2 = slope(along(y, k1, STEP / 2.0));
        let k3 = slope(along(y, k2, STEP / 2.0));
        let k4 = slope(along(y, k3, STEP));
        y = [0, 1].map(|i| y[i] + STEP / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        steps += u32::from(force(y) > 0.0);
    }
    f64::from(steps) * STEP
}

/// The row of the paper's sizes: 0.1 kg, 0.1 m/s, C_max 500 N·s/m.
fn typical() -> Row {
    let typical = |r: &Row| r.mass == 0.1 && r.speed == 0.1 && r.law.c_max == 500.0;
    table().into_iter().find(typical).unwrap()
}

/// `n` places in the step where contact may begin.
fn offsets(n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |k| (k as f64 + 0.5) / n as f64)
}

impl Row {
    fn clearance(&self) -> Clearance {
        let (bearing_radius, journal_radius) = (0.01, 0.01 - CLEARANCE);
        Clearance { bearing_radius, journal_radius, law: Arc::new(self.law), friction: None }
    }

    /// Some direction, in which no component vanishes.
    fn direction() -> Vector2<f64> {
        Vector2::new(0.7f64.cos(), 0.7f64.sin())
    }

    /// Where the journal starts so that contact begins `offset` of a step into a step.
    fn start(&self, step: f64, offset: f64) -> Vector2<f64> {
        let radial = self.clearance().radial();
        Self::direction() * (radial - self.speed * step * (FLIGHT + offset))
    }

    /// Steps until the journal flies again, and has not crossed the ring.
    fn steps(&self, step: f64) -> u64 {
        (1.2 * self.expected.overlap / step + FLIGHT + 5.0).ceil() as u64
    }

    /// The hit under `run`.
    fn run(&self, step: f64, offset: f64) -> Hit {
        let velocity = Self::direction() * self.speed;
        let start = BodyState {
            position: self.start(step, offset),
            rotation: UnitComplex::new(0.3),
            twist: Vector3::new(velocity.x, velocity.y, 0.0),
        };
        let mechanism = Mechanism {
            revolutes: vec![Revolute {
                name: "ring".into(),
                ring: Attachment { body: None, point: Vector2::zeros() },
                journal: Attachment { body: Some(0), point: Vector2::zeros() },
                bearing: Bearing::Clearance(self.clearance()),
                out_of_round: None,
            }],
            ..Mechanism::free(vec![Body::new("mass", self.mass, 1e-4, start)])
        };
        let schedule = Schedule { duration: self.steps(step) as f64 * step, interval: step };
        let mut hit = Hit { peak: 0.0, overlap: 0.0, force_time: 0.0, rebound: 0.0 };
        run(&mechanism, StepControl::Fixed(step), schedule, &mut |instant: &Instant| {
            let tally = instant.tallies[0];
            if instant.evaluation.contacts[0].penetration > 0.0 {
                hit.overlap += step;
            }
            hit.peak = hit.peak.max(tally.peak);
            hit.force_time = tally.contact_time;
            hit.rebound = instant.states[0].twist.xy().norm() / self.speed;
        })
        .unwrap();
        hit
    }

    /// The hit under `ClearanceJoints` in a rapier world; `ring_mass` is infinite for a fixed body.
    /// The relative motion is that of the reduced mass, which is made that of the row.
    fn world(&self, step: f64, offset: f64, ring_mass: f64) -> Hit {
        let mut world = physics_world(step);
        // 1/m = 1/m_ring + 1/m_journal
        let journal_mass = 1.0 / (1.0 / self.mass - 1.0 / ring_mass);
        let share = if ring_mass.is_finite() { self.mass / ring_mass } else { 0.0 };
        let velocity = Self::direction() * self.speed;
        let ring = if ring_mass.is_finite() {
            insert(&mut world, Vector2::zeros(), ring_mass, velocity * -share)
        } else {
            world.bodies.insert(RigidBodyBuilder::fixed())
        };
        let start = self.start(step, offset);
        let journal = insert(&mut world, start, journal_mass, velocity * (1.0 - share));
        let mut joints = ClearanceJoints::new();
        let joint = joints.add(
            &mut world,
            ClearanceJoint {
                ring_body: ring,
                ring_point: Vector2::zeros(),
                journal_body: journal,
                journal_point: Vector2::zeros(),
                clearance: self.clearance(),
            },
        );
        let mut hit = Hit { peak: 0.0, overlap: 0.0, force_time: 0.0, rebound: 0.0 };
        for _ in 0..self.steps(step) {
            joints.step(&mut world);
            let contact = joints.contact(joint).unwrap();
            hit.peak = hit.peak.max(contact.normal_force);
            hit.overlap += if contact.penetration > 0.0 { step } else { 0.0 };
            hit.force_time += if contact.normal_force > 0.0 { step } else { 0.0 };
        }
        let [ring, journal] = [ring, journal].map(|body| joints.state(body).unwrap().twist.xy());
        hit.rebound = (journal - ring).norm() / self.speed;
        hit
    }
}

fn insert(
    world: &mut PhysicsWorld,
    position: Vector2<f64>,
    mass: f64,
    velocity: Vector2<f64>,
) -> RigidBodyHandle {
    world.bodies.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(position.x, position.y))
            .linvel(Vector::new(velocity.x, velocity.y))
            .additional_mass_properties(MassProperties::new(Vector::ZERO, mass, 1e-4))
            .can_sleep(false),
    )
}

/// Worst errors over all offsets: peak and rebound relative, the two times in steps.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    peak: f64,
    rebound: f64,
    overlap: f64,
    force_time: f64,
}

impl Errors {
    /// Measures and prints them, with the mean over the offsets.
    fn measure(label: &str, row: &Row, step: f64, hit: impl Fn(f64) -> Hit) -> Self {
        const OFFSETS: usize = 16;
        let (mut worst, mut mean) = ([0.0f64; 4], [0.0; 4]);
        for offset in offsets(OFFSETS) {
            let (hit, expected) = (hit(offset), row.expected);
            let errors = [
                hit.peak / expected.peak - 1.0,
                hit.rebound / expected.rebound - 1.0,
                (hit.overlap - expected.overlap) / step,
                (hit.force_time - expected.force_time) / step,
            ];
            for i in 0..4 {
                worst[i] = worst[i].max(errors[i].abs());
                mean[i] += errors[i] / OFFSETS as f64;
            }
        }
        println!(
            "{label}, step {step:.0e} s: peak {:.4} % (mean {:+.4} %), rebound {:.4} % \
             (mean {:+.4} %), contact {:.2} steps (mean {:+.2}), force {:.2} steps (mean {:+.2})",
            100.0 * worst[0],
            100.0 * mean[0],
            100.0 * worst[1],
            100.0 * mean[1],
            worst[2],
            mean[2],
            worst[3],
            mean[3],
        );
        let [peak, rebound, overlap, force_time] = worst;
        Self { peak, rebound, overlap, force_time }
    }

    fn require(&self, label: &str) {
        let percent = 100.0 * self.peak;
        assert!(percent <= 1.0, "{label}: peak force off by {percent:.3} % > 1 %");
        let percent = 100.0 * self.rebound;
        assert!(percent <= 0.5, "{label}: rebound speed off by {percent:.3} % > 0.5 %");
        let Self { overlap, force_time, .. } = self;
        assert!(*overlap <= 2.0, "{label}: contact time off by {overlap:.2} steps > 2");
        assert!(*force_time <= 2.0, "{label}: time with force off by {force_time:.2} steps > 2");
    }
}

impl Row {
    fn label(&self) -> String {
        format!("{} kg, {} m/s, C_max {}", self.mass, self.speed, self.law.c_max)
    }

    fn errors(&self, step: f64) -> Errors {
        Errors::measure(&self.label(), self, step, |offset| self.run(step, offset))
    }
}

#[test]
fn all_rows_at_five_microseconds() {
    let table = table();
    assert_eq!(table.len(), 27);
    let worst: Vec<_> = table.iter().map(|row| row.errors(5e-6)).collect();
    for (row, worst) in table.iter().zip(worst) {
        worst.require(&row.label());
    }
}

#[test]
fn rebound_converges_with_second_order() {
    let row = typical();
    let rms = |step: f64| {
        let error = |offset| row.run(step, offset).rebound - row.expected.rebound;
        (offsets(32).map(|o| error(o).powi(2)).sum::<f64>() / 32.0).sqrt()
    };
    let (coarse, fine) = (rms(1e-5), rms(1e-6));
    let order = (coarse / fine).log10();
    println!("rebound: rms error {coarse:.3e} at 1e-5 s, {fine:.3e} at 1e-6 s, order {order:.3}");
    assert!(order >= 1.8, "order of convergence {order:.3} < 1.8");
}

/// The same hit in somebody's own rapier world, the ring on a body of `ring_mass`.
fn in_a_rapier_world(label: &str, ring_mass: f64) {
    let (row, step) = (typical(), 5e-6);
    let worst = Errors::measure(label, &row, step, |o| row.world(step, o, ring_mass));
    worst.require(label);
}

#[test]
fn in_a_rapier_world_with_the_ring_on_a_fixed_body() {
    in_a_rapier_world("ClearanceJoints, fixed ring", f64::INFINITY);
}

#[test]
fn in_a_rapier_world_between_two_moving_bodies() {
    in_a_rapier_world("ClearanceJoints, ring on a free body of 0.3 kg", 0.3);
}
