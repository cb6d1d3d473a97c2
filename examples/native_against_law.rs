//! One hit under rapier's own contact and under the contact law, at several steps: a journal of
//! 0.1 kg flies across its bearing at 0.1 m/s and hits the ring. Eight starts an eighth of a
//! step's way apart, because rapier's force depends on where in a step the journal arrives.
//!
//! Look at the peak force. The law's settles on one number as the step shrinks, here the closed form
//! of a lossless Hertzian hit, `F = K δ^1.5` with `½ m v² = K δ^2.5/2.5`. rapier's contact stops the
//! journal within one step, whatever its step is: the force is up to `m v/dt`, without a limit.
//!
//! `cargo run --release --example native_against_law`

use freeplay::contact::{Clearance, ForceLaw, HertzStep, Material, StiffnessForm, hertz_stiffness};
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

const MASS: f64 = 0.1; // kg
const SPEED: f64 = 0.1; // m/s
const BEARING_RADIUS: f64 = 10e-3; // m
const JOURNAL_RADIUS: f64 = 9.5e-3; // m

fn main() {
    let aluminium = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };
    let form = StiffnessForm::Printed;
    let law = HertzStep {
        stiffness: hertz_stiffness(form, aluminium, BEARING_RADIUS, JOURNAL_RADIUS),
        exponent: 1.5,
        c_max: 0.0, // no losses: the peak force is then known in closed form
        d_max: 1e-5,
        clip: true,
    };
    let exact = law.normal_force(law.deepest_penetration(MASS, SPEED), 0.0);
    let native = Bearing::Native {
        bearing_radius: BEARING_RADIUS,
        journal_radius: JOURNAL_RADIUS,
        friction: 0.0,
    };
    let clearance = Bearing::Clearance(Clearance {
        bearing_radius: BEARING_RADIUS,
        journal_radius: JOURNAL_RADIUS,
        law: Arc::new(law),
        friction: None,
    });

    println!("largest force of a hit; closed form under the law {exact:.3} N");
    println!("{:>10} {:>12} {:>12} {:>12}", "step (s)", "law (N)", "rapier (N)", "m v/dt (N)");
    let steps = [2e-5, 1e-5, 5e-6, 2e-6, 1e-6];
    let mut law_errors = Vec::new();
    for step in steps {
        let control = StepControl::Fixed(step);
        let [by_law, by_rapier] = [&clearance, &native].map(|bearing| peak(bearing, control, step));
        println!("{step:10.0e} {by_law:12.4} {by_rapier:12.2} {:12.2}", MASS * SPEED / step);
        law_errors.push((by_law / exact - 1.0).abs());
        let share = by_rapier * step / (MASS * SPEED);
        assert!((0.8..1.001).contains(&share), "rapier stops it at once");
    }
    let by_tolerance = peak(&clearance, StepControl::Tolerance(1e-6), 1e-5);
    println!("{:>10} {by_tolerance:12.4}", "tolerance");
    assert!(law_errors.windows(2).all(|pair| pair[1] < pair[0] / 2.0), "the law converges");
    assert!((by_tolerance / exact - 1.0).abs() < 1e-4, "to the closed form");
}

/// Largest force in N of one hit, from eight starts spread over the way of `step` s.
fn peak(bearing: &Bearing, control: StepControl, step: f64) -> f64 {
    // 0.5 mm at 0.1 m/s: it arrives after 5 ms and is gone after 5.3 ms.
    let schedule = Schedule { duration: 7e-3, interval: 7e-3 };
    let mut peak = 0.0f64;
    for start in 0..8 {
        let mechanism = mechanism(bearing.clone(), (f64::from(start) + 0.5) / 8.0 * step * SPEED);
        let done = run(&mechanism, control, schedule, &mut |instant| {
            peak = peak.max(instant.tallies[0].peak);
        });
        done.expect("one journal in one ring does not break down");
    }
    peak
}

/// A free journal, `x` m from the centre of a ring on the ground.
fn mechanism(bearing: Bearing, x: f64) -> Mechanism {
    let start = BodyState {
        position: Vector2::new(x, 0.0),
        twist: Vector3::new(SPEED, 0.0, 0.0),
        ..BodyState::ground()
    };
    let centre = |body| Attachment { body, point: Vector2::zeros() };
    Mechanism {
        revolutes: vec![Revolute {
            name: "joint".into(),
            ring: centre(None),
            journal: centre(Some(0)),
            bearing,
            out_of_round: None,
        }],
        ..Mechanism::free(vec![Body::new("journal", MASS, 4.5e-6, start)])
    }
}
