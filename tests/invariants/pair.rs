//! Two free bodies with one joint: nothing else can take momentum or energy.

use crate::common::{hertz, kinetic_energy};
use crate::sampling::{config, vector};
use freeplay::contact::{Clearance, CoulombFriction, HertzStep};
use freeplay::mechanism::{Attachment, Bearing, Body, BodyState, Mechanism, Revolute};
use nalgebra::{UnitComplex, Vector2, Vector3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::sync::Arc;

/// Two free bodies, a ring on the first and a journal on the second.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub masses: [f64; 2],
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

/// Hits of at most 0.35 m/s between at least 0.02 kg (as felt at the joint) last 100 µs and more:
/// ten steps.
pub fn pairs() -> impl Strategy<Value = Pair> {
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
    pub fn law(&self, c_max: f64) -> HertzStep {
        HertzStep { c_max, ..hertz(0.01, 0.01 - self.clearance) }
    }

    pub fn mechanism(&self, c_max: f64, friction: Option<CoulombFriction>) -> Mechanism {
        let inertia = |i: usize| self.masses[i] * self.gyration[i].powi(2);
        let body = |i: usize, centre: Vector2<f64>, velocity: Vector2<f64>| {
            let rotation = UnitComplex::new(self.angles[i]);
            let arm = rotation * self.points[i];
            let velocity = velocity - turned(arm) * self.spins[i];
            let start = BodyState {
                position: centre - arm,
                rotation,
                twist: Vector3::new(velocity.x, velocity.y, self.spins[i]),
            };
            Body::new(&format!("body {i}"), self.masses[i], inertia(i), start)
        };
        let journal = self.ring + self.eccentricity * self.clearance;
        let attachment = |i: usize| Attachment { body: Some(i), point: self.points[i] };
        let bodies = vec![
            body(0, self.ring, self.velocity),
            body(1, journal, self.velocity + self.relative),
        ];
        Mechanism {
            revolutes: vec![Revolute {
                name: "joint".into(),
                ring: attachment(0),
                journal: attachment(1),
                bearing: Bearing::Clearance(Clearance {
                    bearing_radius: 0.01,
                    journal_radius: 0.01 - self.clearance,
                    law: Arc::new(self.law(c_max)),
                    friction: friction.map(Into::into),
                }),
                out_of_round: None,
            }],
            ..Mechanism::free(bodies)
        }
    }

    /// Kinetic energy in J of the motion that hits can touch: that relative to the common centre.
    pub fn inner_energy(&self) -> f64 {
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

pub fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|body| body.start).collect()
}

/// Momentum, and moment of momentum about the origin.
pub fn momentum(mechanism: &Mechanism, states: &[BodyState]) -> Vector3<f64> {
    let of = |(body, state): (&Body, &BodyState)| {
        let p = state.twist.xy() * body.mass;
        let moment = state.position.perp(&p) + body.inertia * state.twist.z;
        Vector3::new(p.x, p.y, moment)
    };
    mechanism.bodies.iter().zip(states).map(of).sum()
}

/// The first `n` pairs of the fixed seed.
pub fn sample(n: u32) -> Vec<Pair> {
    let mut runner = TestRunner::new(config(n));
    (0..n).map(|_| pairs().new_tree(&mut runner).unwrap().current()).collect()
}
