//! A four-bar whose coupler and rocker hang in three bearings with 5 mm of play, its crank under a tracking
//! controller: the limit of contacts that return nothing.
//!
//! Example `FourBarLinkageWith3clearance` of siconos-tutorials (commit b6c9bfd), after Akhadkar, Acary and
//! Brogliato, Multibody System Dynamics 38 (2016), 101-136: links of 1, 4 and 2.5 m and 1 kg each on a ground
//! of 3 m, journals of 55 mm in rings of 60 mm, coefficient of restitution 0, of friction 0.1; Moreau's time
//! stepping with 0.1 ms. The crank's angle is to follow 6 sin(0.75 π t) rad. Here the contacts are stiff
//! springs with more than critical damping.

use super::{body, machine, short, simulate};
use freeplay::engine::Schedule;
use freeplay::mechanism::{Load, Situation, angle_near};
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::sync::Arc;

/// Lengths of ground, crank, coupler and rocker in m.
const LENGTHS: [f64; 4] = [3.0, 1.0, 4.0, 2.5];
const GRAVITY: f64 = 9.81;

/// Angle, rate and acceleration that the crank is to have at time `t` (s).
fn desired(t: f64) -> [f64; 3] {
    let omega = 0.75 * PI;
    let (sin, cos) = (omega * t).sin_cos();
    [6.0 * sin, 6.0 * omega * cos, -6.0 * omega * omega * sin]
}

/// The example's controller, a torque on the crank, with e = θ − θ_d:
///
/// `τ = M (θ̈_d − λ ė) + C θ̇ (θ̇ − λ e) − K_p (ė + λ e) + G`
///
/// M, C and G are inertia, half its derivative by θ, and weight of the four-bar without play, all reduced to
/// the crank. As in the example, C counts only half of the rocker's inertia, and is multiplied by the crank's
/// own rate and not by the desired one.
#[derive(Debug)]
struct Tracking {
    crank: usize,
}

impl Tracking {
    fn torque(t: f64, theta: f64, rate: f64) -> f64 {
        let (gain, lambda) = (200.0, 10.0);
        let [l0, l1, l2, l3] = LENGTHS;
        let [asked, asked_rate, asked_acceleration] = desired(t);
        let (e, e_rate) = (theta - asked, rate - asked_rate);
        // The four-bar without play: angles of the rocker and of the coupler, on the branch that is open
        // upwards, and their derivatives by θ.
        let diagonal = [l0 - l1 * theta.cos(), -l1 * theta.sin()];
        let reach = diagonal[0].hypot(diagonal[1]);
        let at_rocker = ((l2 * l2 - l3 * l3 - reach * reach) / (2.0 * l3 * reach)).acos();
        let rocker = diagonal[1].atan2(diagonal[0]) + at_rocker;
        let coupler = (diagonal[1] + l3 * rocker.sin()).atan2(diagonal[0] + l3 * rocker.cos());
        let between = coupler - rocker;
        let (sin, cos) = between.sin_cos();
        let s = l1 * (rocker - theta).sin() / (l2 * sin);
        let r = l1 * (coupler - theta).sin() / (l3 * sin);
        let s_slope = (l1 * (rocker - theta).cos() * (r - 1.0) / l2 - s * cos * (s - r)) / sin;
        let r_slope = (l1 * (coupler - theta).cos() * (s - 1.0) / l3 - r * cos * (s - r)) / sin;
        let (turn, turn_slope) = ((theta - coupler).cos(), -(theta - coupler).sin() * (1.0 - s));
        let inertia = l1 * l1 * (1.0 / 3.0 + 1.0)
            + l2 * l2 / 3.0 * s * s
            + l3 * l3 / 3.0 * r * r
            + l1 * l2 * turn * s;
        let half_slope = l2 * l2 / 3.0 * s * s_slope
            + l3 * l3 / 6.0 * r * r_slope
            + 0.5 * l1 * l2 * (turn_slope * s + turn * s_slope);
        let weight = GRAVITY
            * (1.5 * l1 * theta.cos() + s * 0.5 * l2 * coupler.cos() + r * 0.5 * l3 * rocker.cos());
        inertia * (asked_acceleration - lambda * e_rate) + half_slope * rate * (rate - lambda * e)
            - gain * (e_rate + lambda * e)
            + weight
    }
}

impl Load for Tracking {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let state = at.states[self.crank];
        // The error stays far below half a turn.
        let theta = angle_near(state.rotation, desired(at.t)[0]);
        wrenches[self.crank].z += Self::torque(at.t, theta, state.twist.z);
    }
}

/// The four-bar with bearings of this clearance in m, of this stiffness in N/m^1.5 and damping in N s/m.
fn four_bar(clearance: f64, stiffness: f64, damping: f64) -> String {
    let [l0, l1, l2, l3] = LENGTHS;
    let start = [
        [0.5 * l1 * f64::cos(1.570_823_772_407_98), 0.5 * l1, 1.570_823_772_407_98],
        [1.876_454_585_097_65, 1.691_962_091_335_582, 0.353_284_202_062_446],
        [l0 + 0.376_468_619_708_295_8, 1.191_962_183_453_451, 1.264_872_058_968_431],
    ];
    let mut text = format!(
        "
        [environment]
        gravity = [0.0, {:?}]
        [contact]
        stiffness = {stiffness:?}
        c_max = {damping:?}
        [ground.points]
        O = [0.0, 0.0]
        C = [{l0:?}, 0.0]
        [[joint]]
        name = \"O\"
        kind = \"revolute\"
        ring = \"ground.O\"
        journal = \"crank.begin\"
        ",
        -GRAVITY
    );
    let named = ["crank", "coupler", "rocker"].into_iter().zip([l1, l2, l3]).zip(start);
    for ((name, length), start) in named {
        text += &format!(
            "
            [[body]]
            name = \"{name}\"
            mass = 1.0
            inertia = {:?}
            points = {{ begin = [{:?}, 0.0], end = [{:?}, 0.0] }}
            start = {start:?}
            ",
            length * length / 12.0,
            -length / 2.0,
            length / 2.0,
        );
    }
    let joints = [
        ("1", "coupler.begin", "crank.end"),
        ("2", "rocker.end", "coupler.end"),
        ("3", "ground.C", "rocker.begin"),
    ];
    for (name, ring, journal) in joints {
        text += &format!(
            "
            [[joint]]
            name = \"{name}\"
            kind = \"revolute\"
            ring = \"{ring}\"
            journal = \"{journal}\"
            clearance = {clearance:?}
            bearing_radius = 0.06
            friction = 0.1
            "
        );
    }
    text
}

/// Angle of the crank in rad at 0.25, 0.5 and 1 s.
fn crank_angles(text: &str, tolerance: f64) -> [f64; 3] {
    let mut mechanism = machine(text).mechanism;
    let crank = body(&mechanism, "crank");
    mechanism.loads.push(Arc::new(Tracking { crank }));
    let mut angles = Vec::new();
    let schedule = Schedule { duration: 1.0, interval: 0.25 };
    simulate(&mechanism, tolerance, schedule, &mut |instant| angles.push(instant.angles[crank]));
    [angles[1], angles[2], angles[4]]
}

#[test]
fn three_bearings_with_play_follow_the_tracking_controller() {
    let expected = [3.469_428_9, 5.545_613_25, 4.238_455_64];
    let off = |clearance: f64| {
        let found = crank_angles(&four_bar(clearance, 1e10, 2e4), 1e-5);
        let errors: [f64; 3] = std::array::from_fn(|i| (found[i] - expected[i]).abs());
        println!("{} mm of play: off by {} rad", 1e3 * clearance, short(&errors));
        errors
    };
    let errors = off(5e-3);
    assert!(errors.iter().all(|error| *error < 1e-4), "{} rad", short(&errors));
    // Tight bearings are farther off: the figures tell one from the other.
    let tight = off(0.0);
    assert!(tight.iter().all(|error| *error > 1.5e-4), "{} rad", short(&tight));
}
