//! The same physics in a mirror, and in every frame.

use crate::STEP;
use crate::common::{Case, SERVO};
use crate::pair::pairs;
use crate::sampling::{Worst, config, vector};
use freeplay::contact::CoulombFriction;
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::{BodyState, Mechanism};
use nalgebra::{UnitComplex, Vector2, Vector3};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// States of all rows.
fn trajectory(mechanism: &Mechanism, duration: f64, interval: f64) -> Vec<Vec<BodyState>> {
    let mut rows = Vec::new();
    let schedule = Schedule { duration, interval };
    run(mechanism, StepControl::Fixed(STEP), schedule, &mut |instant: &Instant| {
        rows.push(instant.states.to_vec());
    })
    .unwrap();
    rows
}

/// The mechanism seen in a mirror along the x axis.
fn mirrored(mechanism: &Mechanism) -> Mechanism {
    let mut mirror = mechanism.clone();
    for body in &mut mirror.bodies {
        body.start = mirror_state(&body.start);
    }
    for joint in &mut mirror.revolutes {
        joint.ring.point.y *= -1.0;
        joint.journal.point.y *= -1.0;
    }
    for joint in &mut mirror.prismatics {
        joint.base.point.y *= -1.0;
        joint.slider.point.y *= -1.0;
    }
    mirror.gravity.y *= -1.0;
    mirror
}

fn mirror_state(state: &BodyState) -> BodyState {
    let twist = state.twist;
    BodyState {
        position: Vector2::new(state.position.x, -state.position.y),
        rotation: state.rotation.conjugate(),
        twist: Vector3::new(twist.x, -twist.y, -twist.z),
    }
}

/// Largest distance of corresponding bodies in m.
fn apart(a: &[Vec<BodyState>], b: &[Vec<BodyState>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a.position - b.position).norm()).fold(0.0, f64::max)
}

fn mirror_rows(rows: &[Vec<BodyState>]) -> Vec<Vec<BodyState>> {
    rows.iter().map(|row| row.iter().map(mirror_state).collect()).collect()
}

/// Rounding (1e-16 m) grows e-fold in 4 ms at worst (`assets/reference/README.md`): 15 ms make 40
/// times of it. 1e-13 m leaves room for what 1500 steps add.
#[test]
fn the_mirrored_machine_moves_in_the_mirror() {
    for case in [
        Case { phase: 0.3, ..Case::default() },
        Case { phase: 2.0, gravity: -9.81, friction: 0.1, ..Case::default() },
        Case { phase: 4.0, drive: SERVO, gravity: -9.81, ..Case::default() },
    ] {
        // Half a millimetre of clearance takes 20 ms to cross.
        let case = Case { clearance: 1e-4, ..case };
        let mechanism = case.mechanism();
        let rows = trajectory(&mechanism, 0.015, 1e-4);
        let mirror = trajectory(&mirrored(&mechanism), 0.015, 1e-4);
        let error = apart(&rows, &mirror_rows(&mirror));
        let mut hits = 0;
        let schedule = Schedule { duration: 0.015, interval: 0.015 };
        run(&mechanism, StepControl::Fixed(STEP), schedule, &mut |instant: &Instant| {
            hits = instant.tallies.iter().map(|t| t.impacts).sum();
        })
        .unwrap();
        assert!(hits > 0, "{case:?}: nothing touched");
        println!("{case:?}: {hits} hits, mirror off by {error:.1e} m (limit 1e-13)");
        assert!(error <= 1e-13, "{case:?}: mirror off by {error:.2e} m > 1e-13 m");
    }
}

#[test]
fn the_mirrored_pair_moves_in_the_mirror() {
    let worst = Worst::new();
    TestRunner::new(config(48))
        .run(&pairs(), |pair| {
            let friction = CoulombFriction { coefficient: 0.1, velocity: 1e-3 };
            let mechanism = pair.mechanism(500.0, Some(friction));
            let rows = trajectory(&mechanism, 0.015, 1e-4);
            let mirror = trajectory(&mirrored(&mechanism), 0.015, 1e-4);
            let error = apart(&rows, &mirror_rows(&mirror));
            worst.take([error]);
            prop_assert!(error <= 1e-13, "mirror off by {error:e} m > 1e-13 m");
            Ok(())
        })
        .unwrap();
    let [worst] = worst.get();
    println!("pairs in the mirror: off by {worst:.1e} m (limit 1e-13)");
}

/// A hit turns a difference in place Δ into one in direction of about Δ/c, and flights of about
/// 1 ms at 0.2 m/s between hits make at most a few clearances of it: each hit multiplies rounding
/// (1e-16 m at positions around 1 m) by a small number. 1e-10 m is 1e-6 of the smallest clearance.
#[test]
fn physics_is_the_same_in_every_frame() {
    let frames = (-3.0..3.0, vector(1.0), vector(0.5));
    let worst = Worst::new();
    TestRunner::new(config(48))
        .run(&(pairs(), frames), |(pair, (angle, shift, boost))| {
            let friction = CoulombFriction { coefficient: 0.1, velocity: 1e-3 };
            let mechanism = pair.mechanism(500.0, Some(friction));
            let turn = UnitComplex::new(angle);
            let moved = |state: &BodyState, t: f64| {
                let velocity = turn * state.twist.xy() + boost;
                BodyState {
                    position: turn * state.position + shift + boost * t,
                    rotation: turn * state.rotation,
                    twist: Vector3::new(velocity.x, velocity.y, state.twist.z),
                }
            };
            let mut other = mechanism.clone();
            for body in &mut other.bodies {
                body.start = moved(&body.start, 0.0);
            }
            let interval = 1e-4;
            let expected: Vec<Vec<BodyState>> = trajectory(&mechanism, 0.015, interval)
                .iter()
                .enumerate()
                .map(|(k, row)| row.iter().map(|s| moved(s, k as f64 * interval)).collect())
                .collect();
            let error = apart(&trajectory(&other, 0.015, interval), &expected);
            worst.take([error]);
            prop_assert!(error <= 1e-10, "moved system off by {error:e} m > 1e-10 m");
            Ok(())
        })
        .unwrap();
    let [worst] = worst.get();
    println!("turned, shifted and boosted: off by {worst:.1e} m (limit 1e-10)");
}
