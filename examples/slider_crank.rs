//! A slider-crank with play in both pins of its connecting rod, in a rapier world of your own: the
//! crank turns in an ideal rapier joint, the slider slides in another, two clearance joints hold the
//! rod between them.
//!
//! Look at the slider's distance from where a tight mechanism would have it: it stays within what the
//! two clearances allow, `Δx ≤ (|e₁| + |e₂|)/cos ψ` (ψ the rod's slope), and is near it whenever the
//! rod pulls or pushes. And at the energy: nobody drives, contacts only take.
//!
//! `cargo run --release --example slider_crank`

use freeplay::contact::{Clearance, HertzStep};
use freeplay::engine::{ClearanceJoint, ClearanceJoints, physics_world};
use freeplay::mechanism::BodyState;
use nalgebra::Vector2;
use rapier2d_f64::dynamics::{
    MassProperties, PrismaticJointBuilder, RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle,
};
use rapier2d_f64::math::Vector;
use rapier2d_f64::pipeline::PhysicsWorld;
use std::sync::Arc;

const STEP: f64 = 5e-6; // s, fifty to a hit
const CRANK: f64 = 0.05; // m
const ROD: f64 = 0.15; // m
const SPEED: f64 = 30.0; // rad/s of the crank at the start
const CLEARANCE: f64 = 2e-4; // m
/// Mass in kg and moment of inertia in kg·m² of flywheel with crank, rod, slider.
const INERTIAS: [[f64; 2]; 3] = [[1.0, 2e-3], [0.1, 2e-4], [0.2, 1e-4]];

fn main() {
    let mut world = physics_world(STEP);
    let frame = world.bodies.insert(RigidBodyBuilder::fixed());
    // At the start crank and rod lie in one line: the rod turns backwards, the slider stands still.
    let pin_speed = CRANK * SPEED;
    let rod_spin = -pin_speed / ROD;
    let crank = insert(&mut world, 0, 0.0, [0.0, SPEED]);
    let rod = insert(&mut world, 1, CRANK + ROD / 2.0, [pin_speed / 2.0, rod_spin]);
    let slider = insert(&mut world, 2, CRANK + ROD, [0.0, 0.0]);

    let pivot = RevoluteJointBuilder::new();
    let guide = PrismaticJointBuilder::new(Vector::X);
    world.impulse_joints.insert(frame, crank, pivot, true);
    world.impulse_joints.insert(frame, slider, guide, true);

    let mut joints = ClearanceJoints::new();
    let half = Vector2::new(ROD / 2.0, 0.0);
    let mut pin = |ring_body, ring_point, journal_body, journal_point| {
        let clearance = clearance();
        let joint =
            ClearanceJoint { ring_body, ring_point, journal_body, journal_point, clearance };
        joints.add(&mut world, joint)
    };
    let pins = [
        pin(crank, Vector2::new(CRANK, 0.0), rod, -half),
        pin(slider, Vector2::zeros(), rod, half),
    ];

    println!(
        "{:>7} {:>10} {:>8} {:>9} {:>11} {:>9} {:>9} {:>9}",
        "t (ms)", "crank (°)", "x (mm)", "Δx (µm)", "play (µm)", "F₁ (N)", "F₂ (N)", "E (mJ)"
    );
    let (mut energies, mut peak, mut largest) = (Vec::new(), 0.0f64, 0.0f64);
    for step in 0..=80_000 {
        joints.step(&mut world);
        // The states are those after the step, the contacts those before: 5 µs, which a row does not
        // show.
        let [crank, rod, slider] = [crank, rod, slider].map(|body| joints.state(body));
        let (Some(crank), Some(rod), Some(slider)) = (crank, rod, slider) else { continue };
        let contacts = pins.map(|pin| joints.contact(pin).copied().unwrap_or_default());
        let [f1, f2] = contacts.map(|contact| contact.normal_force);
        peak = peak.max(f1).max(f2);

        let angle = crank.rotation.angle();
        let (without_play, slope) = tight(angle);
        let off = slider.position.x - without_play;
        let play: f64 = contacts.iter().map(|contact| contact.eccentricity.norm()).sum();
        largest = largest.max(off.abs() / (play / slope + 1e-6));

        if step % 4000 == 0 {
            // The contacts' springs hold up to 0.05 mJ more.
            let energy = kinetic_energy([crank, rod, slider]);
            energies.push(energy);
            println!(
                "{:7.1} {:10.1} {:8.2} {:9.1} {:11.1} {f1:9.2} {f2:9.2} {:9.3}",
                step as f64 * STEP * 1e3,
                angle.to_degrees(),
                slider.position.x * 1e3,
                off * 1e6,
                play / slope * 1e6,
                energy * 1e3
            );
        }
    }
    println!("largest force {peak:.1} N; Δx at most {largest:.3} of the play");
    assert!(largest <= 1.0, "the slider left the play of its pins");
    assert!(energies.windows(2).all(|pair| pair[1] < pair[0] + 1e-4), "energy out of nothing");
}

/// Where the slider would be without play at this angle (rad) of the crank, m, and the cosine of the rod's slope.
fn tight(angle: f64) -> (f64, f64) {
    let (sin, cos) = (CRANK / ROD * angle.sin(), angle.cos());
    let slope = (1.0 - sin * sin).sqrt();
    (CRANK * cos + ROD * slope, slope)
}

/// Kinetic energy of crank, rod and slider in J.
fn kinetic_energy(states: [&BodyState; 3]) -> f64 {
    let kinetic = |([mass, inertia], state): (&[f64; 2], &BodyState)| {
        let (v, spin) = (state.twist.xy(), state.twist.z);
        0.5 * (mass * v.norm_squared() + inertia * spin * spin)
    };
    INERTIAS.iter().zip(states).map(kinetic).sum()
}

/// Body `i` with its centre on the x axis, its velocity across it (m/s) and its spin (rad/s).
fn insert(world: &mut PhysicsWorld, i: usize, x: f64, motion: [f64; 2]) -> RigidBodyHandle {
    let [mass, inertia] = INERTIAS[i];
    world.bodies.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(x, 0.0))
            .linvel(Vector::new(0.0, motion[0]))
            .angvel(motion[1])
            .additional_mass_properties(MassProperties::new(Vector::ZERO, mass, inertia))
            .can_sleep(false),
    )
}

fn clearance() -> Clearance {
    let law = HertzStep { stiffness: 3.7e9, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
    let bearing_radius = 10e-3;
    let journal_radius = bearing_radius - CLEARANCE;
    Clearance { bearing_radius, journal_radius, law: Arc::new(law), friction: None }
}
