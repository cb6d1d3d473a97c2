//! Effects in the actuators: friction, gains, late commands, links that give way.

use super::common::{
    GEOMETRY, GRAVITY, INSTANTS, LIVELY, assembled, at, balance, effect, evaluate, forces_change,
    history, ideal, pose, reduced, same_run, starts, wrench,
};
use freeplay::effects::{Setting, named};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::{Command, Commands, Drive};
use freeplay::simulate::Machine;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// What the drive of one leg has to give more.
fn drive_gives(kind: &str, leg: usize, keys: &str, more: impl Fn(Command) -> f64) {
    let keys = format!("joint = \"P{}\"; {keys}", leg + 1);
    forces_change(kind, &keys, |_, point, _, _| {
        let mut forces = Vector3::zeros();
        forces[leg] = more(GEOMETRY.inverse(point)[leg]);
        forces
    });
}

#[test]
fn friction_of_an_actuator_is_what_its_drive_gives_more() {
    let keys = "coulomb_N = 3; viscous_Ns_m = 20; offset_N = 0.5; velocity_m_s = 0.01";
    drive_gives("actuator-friction", 1, keys, |q| {
        3.0 * (q.rate / 0.01).tanh() + 20.0 * q.rate - 0.5
    });
    let keys = "coulomb_pos_N = 3; coulomb_neg_N = 1; viscous_pos_Ns_m = 10; viscous_neg_Ns_m = 5";
    for leg in 0..3 {
        drive_gives("actuator-friction", leg, keys, |q| {
            let [coulomb, viscous] = if q.rate > 0.0 { [3.0, 10.0] } else { [1.0, 5.0] };
            coulomb * (q.rate / 1e-3).tanh() + viscous * q.rate
        });
    }
    let keys = "coulomb_N = 1; static_N = 4; stribeck_m_s = 0.1; viscous_Ns_m = 7";
    drive_gives("stribeck-friction", 2, keys, |q| {
        let dry = 1.0 + 3.0 * (-(q.rate / 0.1) * (q.rate / 0.1)).exp();
        dry * (q.rate / 1e-3).tanh() + 7.0 * q.rate
    });
    drive_gives("screw-ripple", 0, "amplitude_N = 2; pitch_m = 0.01; phase_rad = 0.3", |q| {
        -2.0 * (TAU * q.position / 0.01 + 0.3).sin()
    });
}

#[test]
fn gains_of_a_servo_are_those_of_the_drive() {
    let declared = ["drive.stiffness=6e5", "drive.damping=150"];
    let keys = "stiffness_relative = 0.2; damping_relative = -0.5";
    same_run("servo-gain", keys, &["drive.mode=servo"], &declared);
}

#[test]
fn a_late_command_is_the_same_response_later() {
    let common = ["drive.mode=servo"];
    let late =
        assembled(&format!("{LIVELY}{}", effect("command-delay", "delay_s = 0.004")), &common);
    let mut plain = assembled(LIVELY, &common);
    plain.mechanism.epoch = -0.004;
    plain.mechanism.close(0.0).unwrap();
    let [a, b] = [late, plain].map(|m| history(&m.mechanism, m.control, 0.03));
    let off = a.iter().zip(&b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(off < 1e-6, "{off:e}");
}

/// A ramp on the first joint, a sine on the second.
#[derive(Debug)]
struct Signals;

const OMEGA: f64 = 20.0;

impl Commands for Signals {
    fn at(&self, t: f64, commands: &mut [Command]) {
        commands.fill(Command { position: 0.3 + 0.05 * t, rate: 0.05, acceleration: 0.0 });
        let (sin, cos) = (OMEGA * t).sin_cos();
        commands[1] =
            Command { position: sin, rate: OMEGA * cos, acceleration: -OMEGA * OMEGA * sin };
    }
}

#[test]
fn a_lagging_servo_is_a_first_order_filter() {
    let tau = 0.01;
    let mut mechanism = assembled(LIVELY, &[]).mechanism;
    mechanism.commands = Arc::new(Signals);
    let kind = named("servo-lag").unwrap();
    Setting::new(kind, None, &[("time_constant_s", tau)]).apply(&mut mechanism).unwrap();
    // A ramp comes late by τ; a sine with gain 1/√(1 + ω²τ²) and phase −atan ωτ.
    let (gain, phase) = ((1.0 + (OMEGA * tau).powi(2)).powf(-0.5), -(OMEGA * tau).atan());
    for t in INSTANTS {
        let mut commands = [Command::default(); 3];
        mechanism.commands.at(t, &mut commands);
        assert!((commands[0].position - (0.3 + 0.05 * (t - tau))).abs() < 1e-13);
        assert!((commands[0].rate - 0.05).abs() < 1e-13);
        let (sin, cos) = (OMEGA * t + phase).sin_cos();
        assert!((commands[1].position - gain * sin).abs() < 1e-7);
        assert!((commands[1].rate - OMEGA * gain * cos).abs() < 1e-6);
        assert!((commands[1].acceleration + OMEGA * OMEGA * gain * sin).abs() < 1e-4);
    }
}

/// At rest under gravity the drives give what virtual work says, and the lengths give way by it.
#[test]
fn links_between_drive_and_rod_give_way_by_their_load() {
    let still = "motion.kind=line";
    let hold = "[[effect]]\nkind = \"KIND\"\nKEYS\n";
    let cases: [(&str, &str, &str, [f64; 2]); 4] = [
        ("servo", "drive-compliance", "compliance_m_N = 1e-5\ndamping_Ns_m = 50", [0.0, 1e-5]),
        ("prescribed", "drive-compliance", "compliance_m_N = 1e-5\ndamping_Ns_m = 50", [0.0, 1e-5]),
        ("servo", "drive-backlash", "play_m = 2e-4", [2e-4, 0.0]),
        ("prescribed", "drive-backlash", "play_m = 2e-4\nstiffness_N_m = 1e6", [2e-4, 1e-6]),
    ];
    for (mode, kind, keys, [play, compliance]) in cases {
        let hold = hold.replace("KIND", kind).replace("KEYS", keys);
        let mode_set = format!("drive.mode={mode}");
        let sets = [
            mode_set.as_str(),
            "contact.law=ideal",
            still,
            "motion.phi=0.6",
            "motion.velocity=[0,0]",
        ];
        let text = "mechanism = { kind = \"3rpr\" }\nenvironment = { gravity = [0.7, -9.81] }\n";
        let Machine { mechanism, motion, .. } = assembled(&format!("{text}{hold}"), &sets);
        let mut rest = None;
        let schedule = Schedule { duration: 1.0, interval: 1.0 };
        run(&mechanism, StepControl::Tolerance(1e-5), schedule, &mut |instant: &Instant| {
            let now = instant.evaluation;
            let readings = [0, 1, 2].map(|leg| mechanism.encoder(leg, now));
            rest = Some((pose(&mechanism, instant.states), now.clone(), readings));
        })
        .unwrap();
        let (pose, now, readings) = rest.unwrap();
        let weights: Vec<_> =
            mechanism.bodies.iter().map(|b| wrench(GRAVITY * b.mass, 0.0)).collect();
        let expected = balance(pose, reduced(pose, &weights));
        let servo = if mode == "servo" { 1.0 / 5e5 } else { 0.0 };
        let commands = GEOMETRY.inverse(&motion.at(1.0));
        for leg in 0..3 {
            let force = now.drive_forces[leg];
            let what = format!("{kind}, {mode}, leg {leg}: {force} N");
            assert!((force - expected[leg]).abs() < 1e-4, "{what}, expected {}", expected[leg]);
            let given = commands[leg].position - now.lengths[leg];
            let due = force * (servo + compliance) + 0.5 * play * force.signum();
            assert!((given - due).abs() < 1e-9, "{what}: gives {given:e}, expected {due:e}");
            // The encoder sits at the drive: what it misses of the command is the servo's own give.
            let missed = commands[leg].position - readings[leg];
            assert!((missed - force * servo).abs() < 1e-9, "{what}: encoder off by {missed:e}");
        }
        assert!(now.drive_forces.iter().any(|f| f.abs() > 1.0));
    }
}

#[test]
fn within_its_play_a_drive_gives_nothing() {
    let keys = effect("drive-backlash", "play_m = 2e-4");
    let machine = ideal(&keys, &["drive.mode=servo"]).mechanism;
    for actuator in &machine.actuators {
        assert!(matches!(actuator.drive, Drive::Servo { .. }));
    }
    let (machine, _) = at(&machine, 0.13);
    for (shift, free) in [(-9e-5, true), (9e-5, true), (-3e-4, false), (3e-4, false)] {
        let mut states = starts(&machine);
        // The rod of leg 1, along its axis.
        let along = states[1].rotation * Vector2::new(shift, 0.0);
        states[1].position += along;
        let now = evaluate(&machine, &states);
        let e = now.commands[0].position - now.lengths[0];
        assert!((e + shift).abs() < 1e-12);
        let force = if free { 0.0 } else { 5e5 * (e - 1e-4 * e.signum()) };
        // The rates agree to rounding, so that damping has no part.
        assert!((now.drive_forces[0] - force).abs() < 1e-6, "{shift}: {}", now.drive_forces[0]);
        let read = machine.encoder(0, &now);
        let expected =
            if free { now.commands[0].position } else { now.lengths[0] + 1e-4 * e.signum() };
        assert!((read - expected).abs() < 1e-12, "{shift}");
    }
}
