//! The exact ring geometry as rapier sees it, and who computes the force of a pair.

mod common;

use common::hertz;
use freeplay::contact::Clearance;
use freeplay::engine::{ClearanceJoint, ClearanceJoints, JointColliders, Solver, physics_world};
use nalgebra::Vector2;
use rapier2d_f64::dynamics::{MassProperties, RigidBodyBuilder, RigidBodyHandle};
use rapier2d_f64::math::Vector;
use rapier2d_f64::pipeline::PhysicsWorld;
use std::sync::Arc;

const STEP: f64 = 1e-5;
const BEARING: f64 = 0.01;
const CLEARANCE: f64 = 5e-4;

/// A ring on a fixed body and a journal on a free one of 0.1 kg, both off their bodies' centres.
struct Pair {
    world: PhysicsWorld,
    ring: RigidBodyHandle,
    journal: RigidBodyHandle,
    /// Ring and journal in their bodies' axes.
    points: [Vector; 2],
}

impl Pair {
    /// The journal starts centred, moving at 0.1 m/s and turning at `spin` rad/s.
    fn new(spin: f64) -> Self {
        let mut world = physics_world(STEP);
        let points = [Vector::new(0.03, -0.02), Vector::new(-0.04, 0.01)];
        let ring = world
            .bodies
            .insert(RigidBodyBuilder::fixed().translation(Vector::new(0.2, 0.1)).rotation(0.8));
        let centre = world.bodies[ring].position() * points[0];
        // A journal at p turning with the body moves at ω × p more than the centre of mass.
        let arm = points[1];
        let velocity = Vector::new(0.06, 0.08) - Vector::new(-arm.y, arm.x) * spin;
        let journal = world.bodies.insert(
            RigidBodyBuilder::dynamic()
                .translation(centre - arm)
                .linvel(velocity)
                .angvel(spin)
                .additional_mass_properties(MassProperties::new(Vector::ZERO, 0.1, 1e-4))
                .can_sleep(false)
                .allow_fast_rotation(true),
        );
        Self { world, ring, journal, points }
    }

    fn colliders(&mut self, solver: Solver) -> JointColliders {
        let mut colliders = JointColliders::default();
        colliders.insert(
            &mut self.world,
            [self.ring, self.journal],
            self.points.map(|p| Vector2::new(p.x, p.y)),
            [BEARING, BEARING - CLEARANCE],
            0.0,
            solver,
        );
        colliders
    }

    /// |e| − c in m, from the bodies' poses.
    fn penetration(&self) -> f64 {
        let [ring, journal] = [(self.ring, self.points[0]), (self.journal, self.points[1])]
            .map(|(body, point)| self.world.bodies[body].position() * point);
        (journal - ring).length() - CLEARANCE
    }
}

#[test]
fn rapier_reads_the_closed_form_and_leaves_a_law_alone() {
    let mut pair = Pair::new(1.5);
    let colliders = pair.colliders(Solver::Law);
    let [ring, journal] = colliders.pair(0).unwrap();
    let start = *pair.world.bodies[pair.journal].position();
    let velocity = pair.world.bodies[pair.journal].linvel();
    let (mut worst, mut deepest, mut seen) = (0.0f64, f64::NEG_INFINITY, 0);
    let steps = 1000;
    for _ in 0..steps {
        // A step looks for contacts first, where the bodies stand before it.
        let expected = -pair.penetration();
        pair.world.step_with_events(&colliders, &());
        let contact = pair.world.narrow_phase.contact_pair(ring, journal).expect("found");
        assert_eq!(contact.total_impulse_magnitude(), 0.0, "an impulse on a law's pair");
        for manifold in contact.manifolds() {
            assert!(manifold.data.solver_contacts.is_empty(), "a solver contact on a law's pair");
            for point in &manifold.points {
                worst = worst.max((point.dist - expected).abs());
                deepest = deepest.max(-point.dist);
                seen += 1;
            }
        }
    }
    println!(
        "manifold distance over {seen} steps, {:.2} mm deep: off by {worst:.1e} m (limit 1e-15)",
        1e3 * deepest
    );
    assert_eq!(seen, steps, "one contact point in every step");
    assert!(deepest > 1e-4, "the journal never reached the ring: {deepest:e} m");
    assert!(worst <= 1e-15, "manifold distance off by {worst:e} m > 1e-15 m");
    let body = &pair.world.bodies[pair.journal];
    let free = start.translation + velocity * (f64::from(steps) * STEP);
    let error = (body.translation() - free).length();
    println!("through the ring: off the free path by {error:.1e} m (limit 1e-15 per step)");
    assert_eq!(body.linvel(), velocity, "the velocity of a free body changed");
    assert_eq!(body.angvel(), 1.5, "the spin of a free body changed");
    assert!(error <= 1e-15 * f64::from(steps), "off the free path by {error:e} m > 1e-12 m");
}

#[test]
fn rapier_itself_holds_the_journal() {
    for spin in [0.0, 1.5] {
        let mut pair = Pair::new(spin);
        let colliders = pair.colliders(Solver::Native { restitution: 0.0, predictive: true });
        let mut deepest = f64::NEG_INFINITY;
        let mut touched = 0;
        for _ in 0..50_000 {
            pair.world.step_with_events(&colliders, &());
            let penetration = pair.penetration();
            deepest = deepest.max(penetration);
            touched += u32::from(penetration > 0.0);
        }
        println!(
            "native contact, spin {spin}: {:.2e} m deep at most (limit 2e-4), touching in \
             {touched} of 50000 steps",
            deepest
        );
        assert!(touched > 0, "spin {spin}: the journal never reached the ring: {deepest:e} m");
        assert!(deepest <= 2e-4, "spin {spin}: the journal is {deepest:e} m deep > 2e-4 m");
    }
}

/// Position and velocity bits of the journal's body over 0.1 s under `ClearanceJoints`; `strip`
/// takes the colliders out of the world again.
fn bits(strip: bool) -> (Vec<u64>, usize) {
    let mut pair = Pair::new(1.5);
    let (bearing_radius, journal_radius) = (BEARING, BEARING - CLEARANCE);
    let mut joints = ClearanceJoints::new();
    let [ring_point, journal_point] = pair.points.map(|p| Vector2::new(p.x, p.y));
    let joint = joints.add(
        &mut pair.world,
        ClearanceJoint {
            ring_body: pair.ring,
            ring_point,
            journal_body: pair.journal,
            journal_point,
            clearance: Clearance {
                bearing_radius,
                journal_radius,
                law: Arc::new(hertz(bearing_radius, journal_radius)),
                friction: None,
            },
        },
    );
    if strip {
        let handles: Vec<_> = pair.world.colliders.iter().map(|(handle, _)| handle).collect();
        assert_eq!(handles.len(), 2);
        for handle in handles {
            pair.world.remove_collider(handle);
        }
    }
    let (mut bits, mut touching) = (Vec::new(), 0);
    for _ in 0..10_000 {
        joints.step(&mut pair.world);
        touching += usize::from(joints.contact(joint).unwrap().normal_force > 0.0);
        let state = joints.state(pair.journal).unwrap();
        let numbers = state.position.iter().chain(&state.twist);
        bits.extend(numbers.chain([&state.rotation.re, &state.rotation.im]).map(|v| v.to_bits()));
    }
    (bits, touching)
}

#[test]
fn colliders_change_nothing_under_a_law() {
    let (with, touching) = bits(false);
    let (without, _) = bits(true);
    println!("{} numbers, {touching} of 10000 steps in contact", with.len());
    assert!(touching > 100, "only {touching} steps in contact");
    assert!(with == without, "the trajectory changed when the colliders were taken out");
}
