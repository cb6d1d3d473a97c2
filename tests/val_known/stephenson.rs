//! A Stephenson III six-bar: torque of the crank and forces of all joints.
//!
//! Case `stephenson_iii_example_2` of the repository PMKS-Web/PMKS_Verification (Newton-Euler solution by
//! MATLAB, commit 5882a1a): joints A to G, links AB, BCE, CD, EF, FG; 50 N in x at the middle of FG; the
//! crank AB turns at 10 rev/min. Its forces are those of the ground on the links at A and G, and of EF on
//! BCE at E.

use super::{body, evaluate, machine, revolute};
use freeplay::mechanism::{Evaluation, Load, Mechanism, Situation};
use freeplay::model::Machine;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

/// 10 rev/min in rad/s.
const SPEED: f64 = PI / 3.0;

/// 50 N in x at the centre of mass of a body.
#[derive(Debug)]
struct Push(usize);

impl Load for Push {
    fn add(&self, _: Situation, wrenches: &mut [Vector3<f64>]) {
        wrenches[self.0].x += 50.0;
    }
}

/// A link in the first pose.
struct Link {
    name: &'static str,
    /// In kg and kg m².
    inertia: [f64; 2],
    /// In m, as the points.
    centre: [f64; 2],
    points: &'static [(&'static str, [f64; 2])],
}

const LINKS: [Link; 5] = [
    Link {
        name: "AB",
        inertia: [5.0, 0.1],
        centre: [6.0, 10.0],
        points: &[("A", [7.0, 4.0]), ("B", [5.0, 16.0])],
    },
    Link {
        name: "BCE",
        inertia: [10.0, 0.2],
        centre: [16.0, 76.0 / 3.0],
        points: &[("B", [5.0, 16.0]), ("C", [25.0, 25.0]), ("E", [18.0, 35.0])],
    },
    Link {
        name: "CD",
        inertia: [5.0, 0.1],
        centre: [24.0, 17.5],
        points: &[("C", [25.0, 25.0]), ("D", [23.0, 10.0])],
    },
    Link {
        name: "EF",
        inertia: [10.0, 0.2],
        centre: [30.5, 33.5],
        points: &[("E", [18.0, 35.0]), ("F", [43.0, 32.0])],
    },
    Link {
        name: "FG",
        inertia: [5.0, 0.1],
        centre: [44.0, 24.5],
        points: &[("F", [43.0, 32.0]), ("G", [45.0, 17.0])],
    },
];

fn link(Link { name, inertia: [mass, inertia], centre, points }: Link) -> String {
    let points: Vec<String> =
        points.iter().map(|(name, place)| format!("{name} = {place:?}")).collect();
    format!(
        "[[body]]\nname = \"{name}\"\nmass = {mass:?}\ninertia = {inertia:?}\n\
         center_of_mass = {centre:?}\npoints = {{ {} }}\n",
        points.join(", ")
    )
}

/// The six-bar under this gravity in m/s². In its first pose the axes of all links are those of the world.
fn six_bar(gravity: f64) -> Machine {
    let text = format!(
        "
        [environment]
        gravity = [0.0, {gravity:?}]
        [ground.points]
        A = [7.0, 4.0]
        D = [23.0, 10.0]
        G = [45.0, 17.0]
        {}
        {}
        [[drive]]
        joint = \"A\"
        kind = \"prescribed\"
        [[motion]]
        joint = \"A\"
        kind = \"line\"
        start = 0.0
        velocity = {SPEED:?}
        ",
        LINKS.map(link).concat(),
        joints(&[
            ("A", "ground", "AB"),
            ("B", "AB", "BCE"),
            ("C", "BCE", "CD"),
            ("D", "ground", "CD"),
            ("E", "EF", "BCE"),
            ("F", "EF", "FG"),
            ("G", "ground", "FG"),
        ]),
    );
    let mut machine = machine(&text);
    let link = body(&machine.mechanism, "FG");
    machine.mechanism.loads.push(Arc::new(Push(link)));
    machine
}

/// Revolute joints at a point that has the joint's name on both bodies.
fn joints(named: &[(&str, &str, &str)]) -> String {
    let joint = |(name, ring, journal): &(&str, &str, &str)| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nring = \"{ring}.{name}\"\n\
             journal = \"{journal}.{name}\"\n"
        )
    };
    named.iter().map(joint).collect()
}

/// The six-bar where its crank has turned by `angle` rad.
fn turned(machine: &mut Machine, angle: f64) -> (Vec<freeplay::mechanism::BodyState>, Evaluation) {
    let t = angle / SPEED;
    let states = machine.ideal.states(t).unwrap();
    let now = evaluate(&machine.mechanism, t, &states);
    (states, now)
}

fn close_to(what: &str, found: Vector2<f64>, expected: [f64; 2]) {
    let expected = Vector2::from(expected);
    let error = (found - expected).norm() / expected.norm();
    println!("{what}: relative error {error:.1e}");
    assert!(error < 1e-8, "{what}: {found:?}, expected {expected:?}, relative error {error:.1e}");
}

#[test]
fn torque_and_forces_are_those_of_another_program() {
    let pair = |torque: f64| [torque, 0.0];
    let along = |torque: f64| Vector2::new(torque, 0.0);

    let mut machine = six_bar(-9.81);
    let [a, e, g] = ["A", "E", "G"].map(|joint| revolute(&machine.mechanism, joint));
    let (_, now) = turned(&mut machine, 0.0);
    close_to("torque", along(now.drive_forces[0]), pair(-243.854_392_953_2));
    // The force of the ground on the crank.
    close_to("A", now.reactions[a], [25.763_681_188_2, -8.129_890_652_6]);
    close_to("G", now.reactions[g], [-18.446_342_964_345_8, -33.697_807_972_190]);
    // Some five degrees before a toggle.
    let (_, now) = turned(&mut machine, 36f64.to_radians());
    close_to("G at 36°", now.reactions[g], [754.824_390_075_91, -791.498_601_800_584]);

    let mut machine = six_bar(0.0);
    let (_, now) = turned(&mut machine, 0.0);
    close_to("torque without gravity", along(now.drive_forces[0]), pair(-117.627_641_521_5));
    close_to("E without gravity", now.reactions[e], [18.276_514_023_508_7, 79.446_869_942_020_7]);
}

/// The principle of virtual power with the velocities of the machine itself: gravity, push and torque take
/// what the bodies' inertia asks for. The forces of the joints have no part in it.
#[test]
fn powers_balance() {
    let mut worst = 0.0f64;
    for gravity in [-9.81, 0.0] {
        let mut machine = six_bar(gravity);
        for degrees in -57..=40 {
            let (states, now) = turned(&mut machine, f64::from(degrees).to_radians());
            let mut powers = vec![now.drive_forces[0] * SPEED];
            let mechanism: &Mechanism = &machine.mechanism;
            for ((body, state), a) in mechanism.bodies.iter().zip(&states).zip(&now.accelerations) {
                let push = if body.name == "FG" { 50.0 } else { 0.0 };
                powers.push(push * state.twist.x);
                powers.push(body.mass * gravity * state.twist.y);
                powers.push(-body.mass * a.xy().dot(&state.twist.xy()));
                powers.push(-body.inertia * a.z * state.twist.z);
            }
            let size: f64 = powers.iter().map(|power| power.abs()).sum();
            let left = powers.iter().sum::<f64>().abs() / size;
            worst = worst.max(left);
            assert!(left < 1e-10, "{gravity} m/s², {degrees}°: {left:.1e}");
        }
    }
    println!("powers balance to {worst:.1e}");
}

/// Newton's and Euler's equations of each body with the reported forces: those of the joints, on the
/// journal's body as reported and on the ring's reversed, gravity, push, and the torque on the crank.
#[test]
fn forces_balance_on_each_body() {
    let mut worst = 0.0f64;
    for gravity in [-9.81, 0.0] {
        let mut machine = six_bar(gravity);
        for degrees in -57..=40 {
            let (states, now) = turned(&mut machine, f64::from(degrees).to_radians());
            let mechanism = &machine.mechanism;
            for (i, body) in mechanism.bodies.iter().enumerate() {
                let a = now.accelerations[i];
                let mut terms =
                    vec![-Vector3::new(body.mass * a.x, body.mass * a.y, body.inertia * a.z)];
                terms.push(Vector3::new(0.0, body.mass * gravity, 0.0));
                match body.name.as_str() {
                    "FG" => terms.push(Vector3::new(50.0, 0.0, 0.0)),
                    "AB" => terms.push(Vector3::new(0.0, 0.0, now.drive_forces[0])),
                    _ => {}
                }
                for (joint, force) in mechanism.revolutes.iter().zip(&now.reactions) {
                    for (end, force) in [(&joint.journal, *force), (&joint.ring, -force)] {
                        if end.body == Some(i) {
                            let arm = end.frame(&states).centre - states[i].position;
                            terms.push(Vector3::new(force.x, force.y, arm.perp(&force)));
                        }
                    }
                }
                for (k, what) in ["in x", "in y", "about the centre"].into_iter().enumerate() {
                    let size: f64 = terms.iter().map(|term| term[k].abs()).sum();
                    let left = terms.iter().map(|term| term[k]).sum::<f64>().abs() / size;
                    worst = worst.max(left);
                    assert!(left < 1e-10, "{} at {degrees}°, {what}: {left:.1e}", body.name);
                }
            }
        }
    }
    println!("forces balance to {worst:.1e}");
}
