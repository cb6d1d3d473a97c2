//! What must hold whatever the numbers: conservation, action and reaction, symmetry, repeatability.

mod common;

use common::{Case, NoCommands, SERVO, hertz, kinetic_energy};
use freeplay::contact::{Clearance, CoulombFriction, Frame, HertzStep};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
use nalgebra::{UnitComplex, Vector2, Vector3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use std::cell::Cell;
use std::sync::Arc;

const STEP: f64 = 1e-5;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20_230_403),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// The worst of N errors over all cases of a property.
struct Worst<const N: usize>(Cell<[f64; N]>);

impl<const N: usize> Worst<N> {
    fn new() -> Self {
        Self(Cell::new([0.0; N]))
    }

    fn take(&self, errors: [f64; N]) {
        let old = self.0.get();
        self.0.set(std::array::from_fn(|i| old[i].max(errors[i])));
    }

    fn get(&self) -> [f64; N] {
        self.0.get()
    }
}

/// Two free bodies, a ring on the first and a journal on the second.
#[derive(Clone, Copy, Debug)]
struct Pair {
    masses: [f64; 2],
    /// Radii of gyration in m.
    gyration: [f64; 2],
    /// Joint from each centre of mass, in the body's axes, m.
    points: [Vector2<f64>; 2],
    angles: [f64; 2],
    spins: [f64; 2],
    ring: Vector2<f64>,
    /// Where the journal stands in its ring, in clearances.
    eccentricity: Vector2<f64>,
    velocity: Vector2<f64>,
    /// Velocity of the journal relative to its ring in m/s.
    relative: Vector2<f64>,
    clearance: f64,
}

fn vector(size: f64) -> impl Strategy<Value = Vector2<f64>> {
    (-size..size, -size..size).prop_map(|(x, y)| Vector2::new(x, y))
}

/// Hits of at most 0.35 m/s between at least 0.02 kg (as felt at the joint) last 100 µs and more:
/// ten steps.
fn pairs() -> impl Strategy<Value = Pair> {
    let shapes = (
        [0.1..0.5, 0.1..0.5],
        [0.04..0.1, 0.04..0.1],
        [vector(0.05), vector(0.05)],
        [-3.0..3.0, -3.0..3.0],
    );
    let motion = ([-2.0..2.0, -2.0..2.0], vector(0.3), vector(0.6), vector(0.2), vector(0.2));
    (shapes, motion, 1e-4..5e-4).prop_map(|(shapes, motion, clearance)| Pair {
        masses: shapes.0,
        gyration: shapes.1,
        points: shapes.2,
        angles: shapes.3,
        spins: motion.0,
        ring: motion.1,
        eccentricity: motion.2,
        velocity: motion.3,
        relative: motion.4,
        clearance,
    })
}

impl Pair {
    fn law(&self, c_max: f64) -> HertzStep {
        HertzStep { c_max, ..hertz(0.01, 0.01 - self.clearance) }
    }

    fn mechanism(&self, c_max: f64, friction: Option<CoulombFriction>) -> Mechanism {
        let inertia = |i: usize| self.masses[i] * self.gyration[i].powi(2);
        let body = |i: usize, centre: Vector2<f64>, velocity: Vector2<f64>| {
            let rotation = UnitComplex::new(self.angles[i]);
            let arm = rotation * self.points[i];
            let velocity = velocity - turned(arm) * self.spins[i];
            Body {
                name: format!("body {i}"),
                mass: self.masses[i],
                inertia: inertia(i),
                start: BodyState {
                    position: centre - arm,
                    rotation,
                    twist: Vector3::new(velocity.x, velocity.y, self.spins[i]),
                },
                reference: Vector2::zeros(),
            }
        };
        let journal = self.ring + self.eccentricity * self.clearance;
        let attachment = |i: usize| Attachment { body: Some(i), point: self.points[i] };
        Mechanism {
            bodies: vec![
                body(0, self.ring, self.velocity),
                body(1, journal, self.velocity + self.relative),
            ],
            revolutes: vec![Revolute {
                name: "joint".into(),
                ring: attachment(0),
                journal: attachment(1),
                bearing: Bearing::Clearance(Clearance {
                    bearing_radius: 0.01,
                    journal_radius: 0.01 - self.clearance,
                    law: Arc::new(self.law(c_max)),
                    friction,
                }),
                out_of_round: None,
            }],
            prismatics: Vec::new(),
            commands: Arc::new(NoCommands),
            epoch: 0.0,
            gravity: Vector2::zeros(),
            loads: Vec::new(),
            native: freeplay::mechanism::NativeContacts::default(),
            output: 1,
        }
    }

    /// Kinetic energy in J of the motion that hits can touch: that relative to the common centre.
    fn inner_energy(&self) -> f64 {
        let [a, b] = self.masses;
        let mechanism = self.mechanism(0.0, None);
        let states = starts(&mechanism);
        let common = momentum(&mechanism, &states).xy() / (a + b);
        kinetic_energy(&mechanism, &states) - 0.5 * (a + b) * common.norm_squared()
    }
}

fn turned(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|body| body.start).collect()
}

/// Momentum, and moment of momentum about the origin.
fn momentum(mechanism: &Mechanism, states: &[BodyState]) -> Vector3<f64> {
    let of = |(body, state): (&Body, &BodyState)| {
        let p = state.twist.xy() * body.mass;
        let moment = state.position.perp(&p) + body.inertia * state.twist.z;
        Vector3::new(p.x, p.y, moment)
    };
    mechanism.bodies.iter().zip(states).map(of).sum()
}

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

/// The first `n` pairs of the fixed seed.
fn sample(n: u32) -> Vec<Pair> {
    let mut runner = TestRunner::new(config(n));
    (0..n).map(|_| pairs().new_tree(&mut runner).unwrap().current()).collect()
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

#[test]
fn action_equals_reaction() {
    let frames = (vector(0.5), vector(0.2), vector(1.0), -20.0..20.0);
    let other = (vector(7e-4), vector(0.2), vector(1.0), -20.0..20.0);
    let (worst, touched) = (Worst::new(), Cell::new(0));
    TestRunner::new(config(64))
        .run(&(frames, other, 0.0..0.5), |(ring, journal, coefficient)| {
            let frame = |centre, (_, arm, velocity, spin): (_, _, _, f64)| Frame {
                centre,
                arm,
                velocity,
                spin,
            };
            let frames = [frame(ring.0, ring), frame(ring.0 + journal.0, journal)];
            let joint = Clearance {
                bearing_radius: 0.01,
                journal_radius: 0.0098,
                law: Arc::new(hertz(0.01, 0.0098)),
                friction: Some(CoulombFriction { coefficient, velocity: 1e-3 }),
            };
            let (contact, forces) = joint.forces(&frames[0], &frames[1]);
            let Some(wrenches) = forces else {
                prop_assert!(contact.penetration <= 0.0, "a touching journal without force");
                return Ok(());
            };
            touched.set(touched.get() + 1);
            let size = wrenches[0].xy().norm();
            let sum = (wrenches[0].xy() + wrenches[1].xy()).norm();
            let moment: f64 = frames
                .iter()
                .zip(&wrenches)
                .map(|(f, w)| w.z + (f.centre - f.arm).perp(&w.xy()))
                .sum();
            // Arms are of the order of 0.1 m; a force of zero is as good as any.
            let relative = [sum / size.max(1e-9), moment.abs() / size.max(1e-9)];
            worst.take(relative);
            prop_assert!(relative[0] <= 1e-15, "forces differ by {:e} > 1e-15", relative[0]);
            prop_assert!(relative[1] <= 1e-14, "moments by {:e} m > 1e-14 m", relative[1]);
            Ok(())
        })
        .unwrap();
    let (worst, touched) = (worst.get(), touched.get());
    println!(
        "{touched} contacts: forces differ by {:.1e} (limit 1e-15), moments by {:.1e} m (1e-14)",
        worst[0], worst[1]
    );
    assert!(touched > 16, "only {touched} of 64 in contact");
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
        joint.cylinder.point.y *= -1.0;
        joint.rod.point.y *= -1.0;
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

/// Every number of every row, bit by bit.
fn bits(mechanism: &Mechanism) -> Vec<u64> {
    let mut bits = Vec::new();
    let schedule = Schedule { duration: 0.05, interval: 1e-4 };
    run(mechanism, StepControl::Fixed(STEP), schedule, &mut |instant: &Instant| {
        let Instant { t, states, evaluation, tallies, .. } = instant;
        let mut push = |value: f64| bits.push(value.to_bits());
        push(*t);
        for state in *states {
            state.position.iter().chain(&state.twist).for_each(|v| push(*v));
            push(state.rotation.re);
            push(state.rotation.im);
        }
        evaluation
            .accelerations
            .iter()
            .chain(&evaluation.wrenches)
            .flatten()
            .for_each(|v| push(*v));
        evaluation.lengths.iter().chain(&evaluation.drive_forces).for_each(|v| push(*v));
        for (contact, tally) in evaluation.contacts.iter().zip(*tallies) {
            contact.eccentricity.iter().for_each(|v| push(*v));
            push(contact.penetration);
            push(contact.normal_force);
            push(contact.friction_force);
            push(tally.peak);
            push(tally.contact_time);
        }
    })
    .unwrap();
    bits
}

#[test]
fn runs_repeat_bit_by_bit() {
    for case in [Case::default(), Case { gravity: -9.81, friction: 0.1, ..Case::default() }] {
        let mechanism = case.mechanism();
        let first = bits(&mechanism);
        assert!(first == bits(&mechanism), "{case:?}: the same mechanism moved differently");
        assert!(first == bits(&case.mechanism()), "{case:?}: built again, it moved differently");
        println!("{case:?}: {} numbers equal to the bit, three times", first.len());
    }
}
