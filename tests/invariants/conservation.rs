//! Momentum, moment of momentum and energy of two bodies and their joint.

use crate::STEP;
use crate::common::kinetic_energy;
use crate::pair::{Pair, momentum, pairs, sample, starts};
use crate::sampling::{Worst, config};
use freeplay::contact::{CoulombFriction, HertzStep};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Kinetic energy and what the contact's spring stores, `K δ^(n+1)/(n+1)`.
fn energy(mechanism: &Mechanism, law: &HertzStep, instant: &Instant) -> f64 {
    let depth = instant.evaluation.contacts[0].penetration.max(0.0);
    let n1 = law.exponent + 1.0;
    kinetic_energy(mechanism, instant.states) + law.stiffness * depth.powf(n1) / n1
}

/// Runs with a row per step.
fn every_step(mechanism: &Mechanism, step: f64, duration: f64, mut look: impl FnMut(&Instant)) {
    let schedule = Schedule { duration, interval: step };
    run(mechanism, StepControl::Fixed(step), schedule, &mut look).unwrap();
}

/// Largest error of the energy over 30 ms relative to the energy that hits can touch, and hits.
fn energy_error(pair: &Pair, step: f64) -> (f64, u64) {
    let (mechanism, law) = (pair.mechanism(0.0, None), pair.law(0.0));
    let (mut first, mut worst, mut hits) = (None, 0.0f64, 0);
    every_step(&mechanism, step, 0.03, |instant| {
        let now = energy(&mechanism, &law, instant);
        worst = worst.max((now - *first.get_or_insert(now)).abs());
        hits = instant.tallies[0].impacts;
    });
    (worst / pair.inner_energy(), hits)
}

#[test]
fn momentum_is_conserved_to_rounding() {
    let worst = Worst::new();
    TestRunner::new(config(64))
        .run(&pairs(), |pair| {
            let friction = CoulombFriction { coefficient: 0.1, velocity: 1e-3 };
            for mechanism in [pair.mechanism(0.0, None), pair.mechanism(500.0, Some(friction))] {
                let start = momentum(&mechanism, &starts(&mechanism));
                // Sizes that the sums are made of.
                let linear: f64 =
                    mechanism.bodies.iter().map(|b| b.mass * b.start.twist.xy().norm()).sum();
                let moment: f64 = mechanism
                    .bodies
                    .iter()
                    .map(|b| b.mass * b.start.twist.xy().norm() * b.start.position.norm())
                    .sum();
                let mut flying = 0;
                let mut errors = [0.0f64; 3];
                every_step(&mechanism, STEP, 0.03, |instant| {
                    let off = momentum(&mechanism, instant.states) - start;
                    flying = if instant.tallies[0].touching { 0 } else { flying + 1 };
                    errors[0] = errors[0].max(off.xy().norm() / linear);
                    // The leapfrog keeps the moment exactly; the velocity that is read at the
                    // same instant as the position is extrapolated while forces act.
                    let slot = if flying > 2 { 1 } else { 2 };
                    errors[slot] = errors[slot].max(off.z.abs() / moment);
                });
                worst.take(errors);
                prop_assert!(errors[0] <= 1e-12, "momentum off by {:e} > 1e-12", errors[0]);
                prop_assert!(errors[1] <= 1e-12, "moment off by {:e} > 1e-12", errors[1]);
                prop_assert!(errors[2] <= 1e-6, "moment in a hit off by {:e} > 1e-6", errors[2]);
            }
            Ok(())
        })
        .unwrap();
    let worst = worst.get();
    println!(
        "relative errors over 30 ms: momentum {:.1e}, moment {:.1e} (limits 1e-12); moment during \
         hits {:.1e} (limit 1e-6)",
        worst[0], worst[1], worst[2]
    );
}

#[test]
fn energy_without_losses_is_conserved_to_second_order() {
    let mut squares = [0.0; 3];
    let (mut worst, mut hits) = (0.0f64, 0);
    let pairs = sample(64);
    for pair in &pairs {
        for (i, square) in squares.iter_mut().enumerate() {
            let (error, count) = energy_error(pair, STEP / f64::powi(2.0, i as i32));
            *square += error * error / pairs.len() as f64;
            if i == 0 {
                worst = worst.max(error);
                hits += count;
            }
        }
    }
    let rms = squares.map(f64::sqrt);
    let ratios = [rms[0] / rms[1], rms[1] / rms[2]];
    println!(
        "energy error over 30 ms, {hits} hits: rms {:.2e}, {:.2e}, {:.2e} at 10, 5, 2.5 µs; ratios \
         {:.2}, {:.2} (at least 3.5); worst {worst:.2e} (limit 0.01)",
        rms[0], rms[1], rms[2], ratios[0], ratios[1]
    );
    assert!(hits > 64, "only {hits} hits");
    assert!(worst <= 0.01, "energy off by {worst:.2e} of the inner energy > 0.01");
    for ratio in ratios {
        assert!(ratio >= 3.5, "halving the step divides the energy error by {ratio:.2} < 3.5");
    }
}

#[test]
fn energy_never_grows_with_losses() {
    let worst = Worst::new();
    TestRunner::new(config(64))
        .run(&(pairs(), 0.0..2000.0, 0.0..0.3), |(pair, c_max, coefficient)| {
            let friction = CoulombFriction { coefficient, velocity: 1e-3 };
            let (mechanism, law) = (pair.mechanism(c_max, Some(friction)), pair.law(c_max));
            let (mut lowest, mut growth) = (f64::INFINITY, 0.0f64);
            every_step(&mechanism, STEP, 0.03, |instant| {
                let now = energy(&mechanism, &law, instant);
                lowest = lowest.min(now);
                growth = growth.max(now - lowest);
            });
            let growth = growth / pair.inner_energy();
            worst.take([growth]);
            prop_assert!(growth <= 0.01, "energy grew by {growth:e} of the inner energy > 0.01");
            Ok(())
        })
        .unwrap();
    let [worst] = worst.get();
    println!("energy with damping and friction grew by at most {worst:.1e} (limit 0.01)");
}
