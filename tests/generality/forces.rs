//! Newton and Euler: what joints, weights, drives and springs do to each body is its mass times its
//! acceleration, and ideal joints stay closed.

use crate::chain::{Chain, Driven, Form, SPRING, go};
use crate::every_chain;
use crate::sampling::Worst;
use freeplay::engine::Instant;
use freeplay::mechanism::{Attachment, Bearing, Mechanism};
use nalgebra::{Vector2, Vector3};
use std::cell::Cell;

/// Sums of forces (N) and moments about the centre of mass (N m) of a body, and the sum of their sizes.
#[derive(Clone, Copy, Default)]
struct Sum {
    wrench: Vector3<f64>,
    sizes: [f64; 2],
}

impl Sum {
    fn add(&mut self, force: Vector2<f64>, arm: Vector2<f64>) {
        let moment = arm.perp(&force);
        self.wrench += Vector3::new(force.x, force.y, moment);
        self.sizes[0] += force.norm();
        self.sizes[1] += arm.norm() * force.norm();
    }

    fn turn(&mut self, torque: f64) {
        self.wrench.z += torque;
        self.sizes[1] += torque.abs();
    }
}

/// Largest errors of the balances of forces and moments of any body, in shares of the sizes that they are made
/// of, and of the accelerations of the two centres of an ideal joint (m/s², shares of their sizes).
fn errors(chain: &Chain, mechanism: &Mechanism, instant: &Instant) -> [f64; 3] {
    let (states, now) = (instant.states, instant.evaluation);
    let mut sums = vec![Sum::default(); mechanism.bodies.len()];
    for (sum, body) in sums.iter_mut().zip(&mechanism.bodies) {
        sum.add(mechanism.gravity * body.mass, Vector2::zeros());
    }
    for (joint, force) in mechanism.revolutes.iter().zip(&now.reactions) {
        // A normal force acts along the line of both centres: each may stand for its point.
        for (end, force) in [(&joint.journal, *force), (&joint.ring, -*force)] {
            if let Some(body) = end.body {
                sums[body].add(force, end.frame(states).arm);
            }
        }
    }
    for (actuator, effort) in mechanism.actuators.iter().zip(&now.drive_forces) {
        let freeplay::mechanism::JointIndex::Revolute(joint) = actuator.joint else { continue };
        let joint = &mechanism.revolutes[joint];
        for (end, torque) in [(&joint.journal, *effort), (&joint.ring, -effort)] {
            if let Some(body) = end.body {
                sums[body].turn(torque);
            }
        }
    }
    if chain.spring {
        let [from, to] = chain.spring_ends(mechanism, states);
        let along = to - from;
        let force = along.normalize() * (-SPRING[0] * (along.norm() - SPRING[1]));
        let body = chain.spring_body(mechanism);
        sums[body].add(force, to - states[body].position);
    }
    let mut errors = [0.0f64; 3];
    for ((sum, body), a) in sums.iter().zip(&mechanism.bodies).zip(&now.accelerations) {
        let off = sum.wrench.xy() - a.xy() * body.mass;
        let moment = sum.wrench.z - a.z * body.inertia;
        // Of a body that nothing pulls, a micronewton at a millimetre.
        errors[0] = errors[0].max(off.norm() / (sum.sizes[0] + 1e-6));
        errors[1] = errors[1].max(moment.abs() / (sum.sizes[1] + 1e-9));
    }
    for joint in mechanism.revolutes.iter().filter(|j| matches!(j.bearing, Bearing::Ideal)) {
        let [ring, journal] = [&joint.ring, &joint.journal].map(|end: &Attachment| {
            let Some(body) = end.body else { return [Vector2::zeros(); 2] };
            let (a, arm, spin) = (now.accelerations[body], end.frame(states).arm, end.spin(states));
            let turning = Vector2::new(-arm.y, arm.x) * a.z;
            [
                a.xy() + turning - arm * (spin * spin),
                Vector2::repeat(a.xy().norm() + turning.norm()),
            ]
        });
        let size = ring[1].x + journal[1].x + 1e-3;
        errors[2] = errors[2].max((ring[0] - journal[0]).norm() / size);
    }
    errors
}

/// `joint_limit`: of the accelerations in ideal joints. They are solved from J M⁻¹ Jᵀ, whose condition is the square
/// of the joints' own: near a singular pose digits are lost.
fn balanced(cases: u32, joint_limit: f64) {
    let (worst, touching) = (Worst::new(), Cell::new(0));
    every_chain(cases, |chain| {
        let mechanism = chain.machine(&Form { c_max: 300.0, ..Form::default() })?.mechanism;
        let mut found = [0.0f64; 3];
        go(&mechanism, 1e-5, 0.02, 1e-4, |instant| {
            let errors = errors(chain, &mechanism, instant);
            found = std::array::from_fn(|k| found[k].max(errors[k]));
            let joints = mechanism.revolutes.iter().zip(&instant.evaluation.contacts);
            let touches = joints.filter(|(joint, contact)| {
                matches!(joint.bearing, Bearing::Clearance(_)) && contact.normal_force > 0.0
            });
            touching.set(touching.get() + touches.count());
        })?;
        worst.take(found);
        if found[0] <= 1e-9 && found[1] <= 1e-9 && found[2] <= joint_limit {
            Ok(())
        } else {
            Err(format!("{:?} drive: off by {found:?} > 1e-9, {joint_limit:e}", chain.driven))
        }
    });
    let [force, moment, joint] = worst.get();
    println!(
        "{cases} chains, {} contacts: forces off by {force:.1e}, moments by {moment:.1e}, accelerations in \
         ideal joints by {joint:.1e} of their sizes (limits 1e-9, 1e-9, {joint_limit:e})",
        touching.get()
    );
    assert!(touching.get() > 100, "only {} contacts", touching.get());
}

#[test]
fn forces_are_mass_times_acceleration() {
    balanced(96, 1e-9);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn forces_are_mass_times_acceleration_in_many() {
    balanced(2000, 1e-6);
}

/// The drive of a chain acts: without it the check above would not see its sign.
#[test]
fn drives_push() {
    let pushed = Cell::new([0.0f64; 3]);
    every_chain(24, |chain| {
        let kind = match chain.driven {
            Driven::Not => return Ok(()),
            Driven::Prescribed => 0,
            Driven::Servo => 1,
            Driven::Force => 2,
        };
        let mechanism = chain.machine(&Form::default())?.mechanism;
        go(&mechanism, 1e-5, 0.02, 1e-3, |instant| {
            let mut most = pushed.get();
            most[kind] = most[kind].max(instant.evaluation.drive_forces[0].abs());
            pushed.set(most);
        })
        .map(|_| ())
    });
    assert!(pushed.get().iter().all(|torque| *torque > 0.1), "{:?} N m", pushed.get());
}
