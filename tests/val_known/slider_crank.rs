//! An offset slider-crank: motion and torque of the crank in closed form.
//!
//! With the crank pin at `r (cos θ, sin θ)` and the slider at (x, e), the rod's angle ψ and x follow from
//! `r sin θ + l sin ψ = e`, `x = r cos θ + l cos ψ`, and their derivatives at constant speed ω from
//! `ψ' = −r cos θ/(l cos ψ)`, `ψ'' = (r sin θ/l + sin ψ ψ'²)/cos ψ`, primes being derivatives by θ. The
//! torque is what virtual power asks for: `τ ω = Σ (m (a − g)·v + I α w)` over the three bodies.

use super::{evaluate, machine};
use freeplay::mechanism::{Imposed, JointIndex, Tracker};
use nalgebra::Vector2;
use std::f64::consts::TAU;

const CRANK: f64 = 0.05;
const ROD: f64 = 0.13;
const OFFSET: f64 = 0.02;
const SPEED: f64 = 40.0;
/// Masses in kg, inertias in kg m² and centres of mass in m of crank and rod; mass of the slider.
const MASSES: [f64; 3] = [0.3, 0.21, 0.14];
const INERTIAS: [f64; 2] = [1e-4, 2.5e-4];
const CENTRES: [[f64; 2]; 2] = [[0.015, 0.002], [0.055, -0.004]];

fn text(gravity: f64) -> String {
    format!(
        "
        [environment]
        gravity = [0.0, {gravity:?}]
        [ground.points]
        O = [0.0, 0.0]
        S = [0.0, {OFFSET:?}]
        [[body]]
        name = \"crank\"
        mass = {:?}
        inertia = {:?}
        center_of_mass = {:?}
        points = {{ O = [0.0, 0.0], A = [{CRANK:?}, 0.0] }}
        [[body]]
        name = \"rod\"
        mass = {:?}
        inertia = {:?}
        center_of_mass = {:?}
        points = {{ A = [0.0, 0.0], B = [{ROD:?}, 0.0] }}
        start = [0.05, 0.0, 0.15]
        [[body]]
        name = \"slider\"
        mass = {:?}
        inertia = 3e-5
        points = {{ B = [0.0, 0.0] }}
        start = [0.18, {OFFSET:?}, 0.0]
        [[joint]]
        name = \"O\"
        kind = \"revolute\"
        ring = \"ground.O\"
        journal = \"crank.O\"
        [[joint]]
        name = \"A\"
        kind = \"revolute\"
        ring = \"crank.A\"
        journal = \"rod.A\"
        [[joint]]
        name = \"B\"
        kind = \"revolute\"
        ring = \"rod.B\"
        journal = \"slider.B\"
        [[joint]]
        name = \"slide\"
        kind = \"prismatic\"
        base = \"ground.S\"
        slider = \"slider.B\"
        [[drive]]
        joint = \"O\"
        kind = \"prescribed\"
        [[motion]]
        joint = \"O\"
        kind = \"line\"
        start = 0.0
        velocity = {SPEED:?}
        ",
        MASSES[0], INERTIAS[0], CENTRES[0], MASSES[1], INERTIAS[1], CENTRES[1], MASSES[2],
    )
}

/// A vector of the body's axes in the world's, and its first and second derivative by θ; the body's angle
/// has the derivatives `rate` and `bend`.
fn turned(v: [f64; 2], angle: f64, rate: f64, bend: f64) -> [Vector2<f64>; 3] {
    let (sin, cos) = angle.sin_cos();
    let here = Vector2::new(v[0] * cos - v[1] * sin, v[0] * sin + v[1] * cos);
    let across = Vector2::new(-here.y, here.x);
    [here, across * rate, across * bend - here * (rate * rate)]
}

/// Position, velocity and acceleration of the slider, and the torque of the crank, in closed form.
fn closed_form(theta: f64, gravity: f64) -> [f64; 4] {
    let (sin, cos) = theta.sin_cos();
    let psi = ((OFFSET - CRANK * sin) / ROD).asin();
    let rate = -CRANK * cos / (ROD * psi.cos());
    let bend = (CRANK * sin / ROD + psi.sin() * rate * rate) / psi.cos();
    let pin = turned([CRANK, 0.0], theta, 1.0, 0.0);
    let sum = |a: [Vector2<f64>; 3], b: [Vector2<f64>; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let slider = sum(pin, turned([ROD, 0.0], psi, rate, bend));
    let centres = [
        turned(CENTRES[0], theta, 1.0, 0.0),
        sum(pin, turned(CENTRES[1], psi, rate, bend)),
        slider,
    ];
    let omega2 = SPEED * SPEED;
    let weight = Vector2::new(0.0, gravity);
    let mut torque = INERTIAS[1] * bend * rate * omega2;
    for (mass, [_, v, a]) in MASSES.into_iter().zip(centres) {
        torque += mass * (a * omega2 - weight).dot(&v);
    }
    [slider[0].x, slider[1].x * SPEED, slider[2].x * omega2, torque]
}

#[test]
fn motion_and_torque_are_those_of_the_closed_form() {
    for gravity in [0.0, -9.81] {
        let mut machine = machine(&text(gravity));
        let mechanism = machine.mechanism.clone();
        let slide = mechanism.joints().find(|(name, _)| *name == "slide").map(|(_, joint)| joint);
        let slide: JointIndex = slide.unwrap();
        let rows: Vec<[[f64; 4]; 2]> = (0..=360)
            .map(|degree| {
                let t = TAU / SPEED * f64::from(degree) / 360.0;
                let states = machine.ideal.states(t).unwrap();
                let now = evaluate(&mechanism, t, &states);
                let torque = machine.ideal.at(t).drive_forces[0];
                assert!((torque - now.drive_forces[0]).abs() < 1e-12, "{degree}°");
                let motion = mechanism.motion_of(slide, &states, |body| now.accelerations[body]);
                let found = [motion.position, motion.rate, motion.acceleration, torque];
                [found, closed_form(SPEED * t, gravity)]
            })
            .collect();
        for (k, what) in ["position", "velocity", "acceleration", "torque"].into_iter().enumerate()
        {
            let peak = rows.iter().map(|[_, closed]| closed[k].abs()).fold(0.0, f64::max);
            let error =
                rows.iter().map(|[found, closed]| (found[k] - closed[k]).abs()).fold(0.0, f64::max);
            println!("{gravity} m/s²: {what} up to {peak:.3}, error {:.1e} of it", error / peak);
            assert!(error < 1e-9 * peak, "{gravity} m/s², {what}: {error:e} of {peak}");
        }
    }
}

/// Inverse dynamics from the motion alone: the torque is the closed form's, the joint forces are those that the
/// equations of motion find.
#[test]
fn inverse_dynamics_takes_the_torque_of_the_closed_form() {
    let mechanism = machine(&text(-9.81)).mechanism.without_clearance();
    let starts = mechanism.bodies.iter().map(|body| body.start).collect();
    let mut tracker = Tracker::new(mechanism.clone(), Imposed::Drives, starts, 0.0).unwrap();
    for degree in 0..=360 {
        let t = TAU / SPEED * f64::from(degree) / 360.0;
        tracker.advance(t).unwrap();
        let taken = tracker.posed().unwrap().taken(&mechanism, t, &[], &[]).unwrap();
        let [.., torque] = closed_form(SPEED * t, -9.81);
        assert!(
            (taken.efforts[0] - torque).abs() < 1e-9,
            "{degree}°: {} {torque}",
            taken.efforts[0]
        );
        let now = evaluate(&mechanism, t, tracker.states());
        for (taken, found) in taken.reactions.iter().zip(&now.reactions) {
            assert!(
                (taken - found).norm() < 1e-7 * (1.0 + found.norm()),
                "{degree}°: {taken} {found}"
            );
        }
        // Without clearance nothing leans.
        for (leaning, state) in taken.leaning.iter().zip(tracker.states()) {
            assert!((leaning.position - state.position).norm() < 1e-12);
        }
    }
}
