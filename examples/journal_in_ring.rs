//! A journal in a bearing ring, in a rapier world of your own: drop a 0.1 kg disc into the free play
//! of a fixed bearing and watch it bounce, 20 mm ring, 0.5 mm clearance.
//!
//! `cargo run --release --example journal_in_ring`

use freeplay::contact::{
    Clearance, CoulombFriction, HertzStep, Material, StiffnessForm, hertz_stiffness,
};
use freeplay::engine::{ClearanceJoint, ClearanceJoints, physics_world};
use nalgebra::Vector2;
use rapier2d_f64::dynamics::{MassProperties, RigidBodyBuilder};
use rapier2d_f64::math::Vector;
use std::sync::Arc;

fn main() {
    // A world with a step of 10 µs, a fixed body for the ring and a free one for the journal.
    let mut world = physics_world(1e-5);
    world.gravity = Vector::new(0.0, -9.81);
    let frame = world.bodies.insert(RigidBodyBuilder::fixed());
    let disc = world.bodies.insert(
        RigidBodyBuilder::dynamic()
            .additional_mass_properties(MassProperties::new(Vector::ZERO, 0.1, 4.5e-6))
            .linvel(Vector::new(0.05, 0.0))
            .can_sleep(false),
    );

    // The joint: geometry, force law, friction.
    let (bearing_radius, journal_radius) = (10e-3, 9.5e-3);
    let aluminium = Material { youngs_modulus: 73e9, poisson_ratio: 0.3 };
    let form = StiffnessForm::Printed;
    let law = HertzStep {
        stiffness: hertz_stiffness(form, aluminium, bearing_radius, journal_radius),
        exponent: 1.5,
        c_max: 500.0,
        d_max: 1e-5,
        clip: true,
    };
    let friction = Some(CoulombFriction { coefficient: 0.1, velocity: 1e-3 }.into());
    let mut joints = ClearanceJoints::new();
    let joint = joints.add(
        &mut world,
        ClearanceJoint {
            ring_body: frame,
            ring_point: Vector2::zeros(),
            journal_body: disc,
            journal_point: Vector2::zeros(),
            clearance: Clearance { bearing_radius, journal_radius, law: Arc::new(law), friction },
        },
    );

    // Step the joints in place of the world.
    println!("{:>8} {:>10} {:>10} {:>12} {:>10}", "t (ms)", "x (µm)", "y (µm)", "δ (µm)", "F (N)");
    for step in 0..=20_000 {
        joints.step(&mut world);
        if let (0, Some(contact)) = (step % 1000, joints.contact(joint)) {
            let e = contact.eccentricity * 1e6;
            let (depth, force) = (contact.penetration * 1e6, contact.normal_force);
            println!(
                "{:8.1} {:10.2} {:10.2} {depth:12.3} {force:10.3}",
                step as f64 * 0.01,
                e.x,
                e.y
            );
        }
    }
}
