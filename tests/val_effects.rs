//! Every effect against a closed form, an invariant, or the same thing declared another way; and what
//! is said of wrong ones.

mod cli_common;

use cli_common::Place;
use freeplay::contact::{Clearance, Frame, HertzStep, OutOfRound};
use freeplay::effects::{ALL, Joints, Kind, Setting, named};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::motion::PathPoint;
use freeplay::mechanism::three_rpr::{Geometry, LegBars, ideal_states};
use freeplay::mechanism::{
    BodyState, Command, Commands, Drive, Dynamics, Evaluation, Mechanism, Situation,
};
use freeplay::scenario::Scenario;
use freeplay::simulate::{Machine, assemble};
use nalgebra::{Rotation2, UnitComplex, Vector2, Vector3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const GEOMETRY: Geometry = Geometry { base_side: 0.66, platform_side: 0.1 };
const BARS: LegBars = LegBars { density: 2270.0, cylinder: [0.2, 0.02], rod: [0.2, 0.012] };

/// A motion in x, y and φ, and gravity: everything that a load can be confused with is there.
const LIVELY: &str = "motion = { kind = \"multisine\", center = [0.01, -0.01, 0.6], terms = [\n\
    { amplitude = [0.02, 0.01, 0.1], frequency = 1.1, phase = 0.3 },\n\
    { amplitude = [-0.01, 0.02, 0.05], frequency = 2.3, phase = 1.1 }] }\n\
    environment = { gravity = [0.7, -9.81] }\nmechanism = { kind = \"3rpr\" }\n";

fn assembled(text: &str, sets: &[&str]) -> Machine {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scenario = Scenario::from_text(text, "test.toml", &sets).unwrap_or_else(|e| panic!("{e}"));
    assemble(&scenario).unwrap_or_else(|e| panic!("{e}"))
}

/// The machine without clearance on [`LIVELY`], with one effect.
fn ideal(effect: &str, sets: &[&str]) -> Machine {
    assembled(&format!("{LIVELY}{effect}"), &[sets, &["contact.law=ideal"]].concat())
}

fn effect(kind: &str, keys: &str) -> String {
    format!("[[effect]]\nkind = \"{kind}\"\n{}\n", keys.replace("; ", "\n"))
}

/// A mechanism put together as it is commanded at `t`, and what acts there.
fn at(mechanism: &Mechanism, t: f64) -> (Mechanism, Evaluation) {
    let mut mechanism = mechanism.clone();
    mechanism.epoch = t;
    mechanism.close(0.0).unwrap_or_else(|gap| panic!("open by {gap}"));
    let states = starts(&mechanism);
    let now = evaluate(&mechanism, &states);
    (mechanism, now)
}

fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|b| b.start).collect()
}

fn evaluate(mechanism: &Mechanism, states: &[BodyState]) -> Evaluation {
    let mut now = Evaluation::new(mechanism);
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.forces(mechanism, 0.0, states, &mut now);
    dynamics.accelerations(mechanism, states, &mut now);
    now
}

fn pose(mechanism: &Mechanism, states: &[BodyState]) -> Vector3<f64> {
    let state = mechanism.output_state(states);
    Vector3::new(state.position.x, state.position.y, state.rotation.angle())
}

/// Drive forces that balance a wrench (N, N, N·m about C) on the platform: `Jᵀ F = −w`.
fn balance(pose: Vector3<f64>, wrench: Vector3<f64>) -> Vector3<f64> {
    GEOMETRY.jacobian(pose).transpose().lu().solve(&-wrench).expect("not singular")
}

/// The wrench on the platform that does the virtual work of wrenches on all bodies.
fn reduced(pose: Vector3<f64>, wrenches: &[Vector3<f64>]) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| {
        let mut rate = Vector3::zeros();
        rate[axis] = 1.0;
        let point = PathPoint { pose, rate, ..PathPoint::default() };
        let states = ideal_states(&GEOMETRY, &BARS, &point);
        states.iter().zip(wrenches).map(|(state, w)| state.twist.dot(w)).sum::<f64>()
    })
}

const INSTANTS: [f64; 4] = [0.0, 0.13, 0.31, 0.77];

/// Drive forces of the ideal machine with an effect, less those without, against `expected` of the
/// instant: time, motion there, and the plain machine.
fn forces_change(
    kind: &str,
    keys: &str,
    expected: impl Fn(f64, &PathPoint, &Mechanism, &Evaluation) -> Vector3<f64>,
) {
    let (plain, changed) = (ideal("", &[]), ideal(&effect(kind, keys), &[]));
    let mut largest = 0.0f64;
    for t in INSTANTS {
        let ((declared, before), (_, now)) = (at(&plain.mechanism, t), at(&changed.mechanism, t));
        let change = Vector3::from_fn(|i, _| now.drive_forces[i] - before.drive_forces[i]);
        let point = plain.motion.at(t);
        let expected = expected(t, &point, &declared, &before);
        largest = largest.max(expected.amax());
        assert!((change - expected).amax() < 1e-9, "{kind} at {t}: {change} {expected}");
    }
    assert!(largest > 1e-3, "{kind} does nothing here");
}

/// The same when the effect is a wrench on the platform.
fn platform_feels(kind: &str, keys: &str, wrench: impl Fn(f64, &PathPoint) -> Vector3<f64>) {
    forces_change(kind, keys, |t, point, _, _| balance(point.pose, wrench(t, point)));
}

/// Positions of all bodies and drive forces over a short run.
fn history(mechanism: &Mechanism, control: StepControl, duration: f64) -> Vec<f64> {
    let mut values = Vec::new();
    let schedule = Schedule { duration, interval: duration / 20.0 };
    run(mechanism, control, schedule, &mut |instant: &Instant| {
        for state in instant.states {
            values.extend([state.position.x, state.position.y, state.rotation.angle()]);
        }
        values.extend(&instant.evaluation.drive_forces);
    })
    .unwrap();
    values
}

/// Two ways to declare one machine: the same run to rounding.
fn same_run(kind: &str, keys: &str, common: &[&str], declared: &[&str]) {
    let with = assembled(&format!("{LIVELY}{}", effect(kind, keys)), common);
    let mut other = assembled(LIVELY, &[common, declared].concat());
    let plain = assembled(LIVELY, common);
    other.mechanism.close(0.0).unwrap();
    let runs = [with, other, plain].map(|m| history(&m.mechanism, m.control, 0.03));
    let apart =
        |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    let (off, done) = (apart(&runs[0], &runs[1]), apart(&runs[0], &runs[2]));
    assert!(off < 1e-6 && done > 1e3 * off.max(1e-9), "{kind}: {off:e}, does {done:e}");
}

fn turned(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

fn wrench(force: Vector2<f64>, torque: f64) -> Vector3<f64> {
    Vector3::new(force.x, force.y, torque)
}

const GRAVITY: Vector2<f64> = Vector2::new(0.7, -9.81);

#[test]
fn a_payload_weighs_and_resists_where_it_sits() {
    let (mass, local) = (0.3, Vector2::new(0.02, -0.013));
    platform_feels("payload", "mass_kg = 0.3; com_x_m = 0.02; com_y_m = -0.013", |_, point| {
        let r = Rotation2::new(point.pose.z) * local;
        let (omega, alpha) = (point.rate.z, point.acceleration.z);
        let a = point.acceleration.xy() + turned(r) * alpha - r * (omega * omega);
        let force = (GRAVITY - a) * mass;
        wrench(force, r.perp(&force))
    });
}

#[test]
fn a_payload_at_the_centre_is_platform_mass() {
    let declared = ["mechanism.platform_mass=0.5", "mechanism.platform_inertia=2e-4"];
    let common = ["mechanism.platform_inertia=2e-4"];
    same_run("payload", "mass_kg = 0.3", &common, &declared);
}

#[test]
fn heavier_legs_weigh_and_resist_everywhere() {
    forces_change("leg-density", "relative = 0.25", |_, point, declared, before| {
        let mut wrenches: Vec<_> = declared
            .bodies
            .iter()
            .zip(&before.accelerations)
            .map(|(b, a)| wrench((GRAVITY - a.xy()) * b.mass, -a.z * b.inertia) * 0.25)
            .collect();
        wrenches[declared.output] = Vector3::zeros();
        balance(point.pose, reduced(point.pose, &wrenches))
    });
}

#[test]
fn gravity_is_the_environments() {
    same_run("gravity", "gx_m_s2 = 1.5; gy_m_s2 = -3", &[], &["environment.gravity=[1.5,-3]"]);
    // What is not given stays as declared.
    same_run("gravity", "gx_m_s2 = 1.5", &[], &["environment.gravity=[1.5,-9.81]"]);
}

#[test]
fn a_shaking_base_moves_legs_and_platform() {
    let keys = "ax_m_s2 = 2; ay_m_s2 = -1; frequency_Hz = 7; phase_rad = 0.4";
    forces_change("base-vibration", keys, |t, point, declared, _| {
        let a = Vector2::new(2.0, -1.0) * (TAU * 7.0 * t + 0.4).sin();
        let wrenches: Vec<_> = declared.bodies.iter().map(|b| wrench(-a * b.mass, 0.0)).collect();
        balance(point.pose, reduced(point.pose, &wrenches))
    });
}

#[test]
fn tether_drag_and_rotor_act_on_the_platform() {
    let anchor = Vector2::new(0.3, 0.1);
    let keys = "stiffness_N_m = 40; anchor_x_m = 0.3; anchor_y_m = 0.1; rest_length_m = 0.29";
    let pull = |point: &PathPoint| {
        let d = anchor - point.pose.xy();
        d.normalize() * (40.0 * (d.norm() - 0.29).max(0.0))
    };
    platform_feels("tether", keys, |_, point| wrench(pull(point), 0.0));
    let machine = ideal("", &[]);
    let taut = INSTANTS.map(|t| pull(&machine.motion.at(t)).norm() > 0.0);
    assert!(taut.contains(&true) && taut.contains(&false), "taut and slack: {taut:?}");

    platform_feels("drag", "force_Ns_m = 12; torque_Nms = 0.05", |_, point| {
        wrench(-12.0 * point.rate.xy(), -0.05 * point.rate.z)
    });
    let keys = "mass_radius_kg_m = 2e-3; frequency_Hz = 9; phase_rad = 0.2";
    platform_feels("unbalance", keys, |t, _| {
        let omega = TAU * 9.0;
        let (sin, cos) = (omega * t + 0.2).sin_cos();
        wrench(Vector2::new(cos, sin) * (2e-3 * omega * omega), 0.0)
    });
}

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
        -2.0 * (TAU * q.length / 0.01 + 0.3).sin()
    });
}

#[test]
fn friction_in_the_journals_is_that_of_the_joints() {
    let friction = "joints.friction=[0,0,0,0.2,0,0]";
    same_run("journal-friction", "mu = 0.2; joint = \"C1\"", &[], &[friction]);
    same_run("journal-friction", "mu = 0.2", &[], &["joints.friction=0.2"]);
}

#[test]
fn a_worn_joint_has_another_clearance() {
    let common = ["contact.stiffness=3.7e9"];
    let clearance = "joints.clearance=[5e-4,2e-4,5e-4,5e-4,5e-4,5e-4]";
    same_run("joint-wear", "joint = \"A2\"; clearance_m = 2e-4", &common, &[clearance]);
}

#[test]
fn damping_of_hits_is_that_of_the_law() {
    same_run("contact-damping", "relative = -0.5", &[], &["contact.c_max=250"]);
}

#[test]
fn gains_of_a_servo_are_those_of_the_drive() {
    let declared = ["drive.stiffness=6e5", "drive.damping=150"];
    let keys = "stiffness_relative = 0.2; damping_relative = -0.5";
    same_run("servo-gain", keys, &["drive.mode=servo"], &declared);
}

/// Lengths that the pose really has, from the centres of the joints, against what `true_length` makes of
/// the commands; the encoder shows the commands, and the rates are as the lengths are.
fn closes(keys: &str, kind: &str, anchor: Vector2<f64>, true_length: impl Fn(f64) -> f64) {
    let machine = ideal(
        &effect(kind, &format!("joint = \"{}1\"; {keys}", if anchor.x == 0.0 { "P" } else { "A" })),
        &[],
    );
    for t in INSTANTS {
        let (mechanism, now) = at(&machine.mechanism, t);
        let states = starts(&mechanism);
        let pose = pose(&mechanism, &states);
        let rate = mechanism.output_state(&states).twist;
        let commands = GEOMETRY.inverse(&machine.motion.at(t));
        for (leg, command) in commands.iter().enumerate() {
            let d = GEOMETRY.leg(pose, leg) - if leg == 0 { anchor } else { Vector2::zeros() };
            let arm = Rotation2::new(pose.z) * GEOMETRY.corner(leg);
            let length_rate = d.normalize().dot(&(rate.xy() + turned(arm) * rate.z));
            let truth = |q: f64| if leg == 0 { true_length(q) } else { q };
            let slope = (truth(command.length + 1e-6) - truth(command.length - 1e-6)) / 2e-6;
            assert!((d.norm() - truth(command.length)).abs() < 1e-12, "{kind} at {t}, leg {leg}");
            assert!((length_rate - slope * command.rate).abs() < 1e-7, "{kind} at {t}, leg {leg}");
            assert!((mechanism.encoder(leg, &now) - command.length).abs() < 1e-12, "{kind} at {t}");
        }
        let moved = (pose - machine.motion.at(t).pose).norm();
        assert!(moved > 1e-5, "{kind} at {t} moves the platform by {moved:e}");
    }
}

#[test]
fn lengths_and_pose_close_with_what_the_encoders_miss() {
    let none = Vector2::zeros();
    closes("relative = 0.02", "actuator-scale", none, |q| q + 0.02 * (q - 0.32));
    closes("offset_m = -2e-3", "sensor-offset", none, |q| q - 2e-3);
    closes("amplitude_m = 3e-4; pitch_m = 0.02; phase_rad = 1", "screw-ripple", none, |q| {
        q + 3e-4 * (TAU * q / 0.02 + 1.0).sin()
    });
    closes("dx_m = 2e-3; dy_m = -3e-3", "anchor-offset", Vector2::new(2e-3, -3e-3), |q| q);
}

/// The accelerations that a prescribed drive with a wrong encoder imposes are those of the lengths.
#[test]
fn a_run_with_a_wrong_encoder_follows_the_true_lengths() {
    let keys = effect("screw-ripple", "joint = \"P1\"; amplitude_m = 3e-4; pitch_m = 0.02");
    for law in ["contact.law=ideal", "contact.law=hertz-step"] {
        let Machine { mechanism, motion, .. } = assembled(&format!("{LIVELY}{keys}"), &[law]);
        let schedule = Schedule { duration: 0.1, interval: 0.005 };
        run(&mechanism, StepControl::Fixed(1e-5), schedule, &mut |instant: &Instant| {
            let read = GEOMETRY.inverse(&motion.at(instant.t))[0].length;
            let truth = read + 3e-4 * (TAU * read / 0.02).sin();
            let length = instant.evaluation.lengths[0];
            assert!((length - truth).abs() < 1e-9, "{law} at {}: {length} {truth}", instant.t);
        })
        .unwrap();
    }
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
        commands.fill(Command { length: 0.3 + 0.05 * t, rate: 0.05, acceleration: 0.0 });
        let (sin, cos) = (OMEGA * t).sin_cos();
        commands[1] =
            Command { length: sin, rate: OMEGA * cos, acceleration: -OMEGA * OMEGA * sin };
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
        assert!((commands[0].length - (0.3 + 0.05 * (t - tau))).abs() < 1e-13);
        assert!((commands[0].rate - 0.05).abs() < 1e-13);
        let (sin, cos) = (OMEGA * t + phase).sin_cos();
        assert!((commands[1].length - gain * sin).abs() < 1e-7);
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
            let given = commands[leg].length - now.lengths[leg];
            let due = force * (servo + compliance) + 0.5 * play * force.signum();
            assert!((given - due).abs() < 1e-9, "{what}: gives {given:e}, expected {due:e}");
            // The encoder sits at the drive: what it misses of the command is the servo's own give.
            let missed = commands[leg].length - readings[leg];
            assert!((missed - force * servo).abs() < 1e-9, "{what}: encoder off by {missed:e}");
        }
        assert!(now.drive_forces.iter().any(|f| f.abs() > 1.0));
    }
}

#[test]
fn within_its_play_a_drive_gives_nothing() {
    let keys = effect("drive-backlash", "play_m = 2e-4");
    let mut machine = ideal(&keys, &["drive.mode=servo"]).mechanism;
    for joint in &mut machine.prismatics {
        assert!(matches!(joint.drive, Drive::Servo { .. }));
    }
    let (machine, _) = at(&machine, 0.13);
    for (shift, free) in [(-9e-5, true), (9e-5, true), (-3e-4, false), (3e-4, false)] {
        let mut states = starts(&machine);
        // The rod of leg 1, along its axis.
        let along = states[1].rotation * Vector2::new(shift, 0.0);
        states[1].position += along;
        let now = evaluate(&machine, &states);
        let e = now.commands[0].length - now.lengths[0];
        assert!((e + shift).abs() < 1e-12);
        let force = if free { 0.0 } else { 5e5 * (e - 1e-4 * e.signum()) };
        // The rates agree to rounding, so that damping has no part.
        assert!((now.drive_forces[0] - force).abs() < 1e-6, "{shift}: {}", now.drive_forces[0]);
        let read = machine.encoder(0, &now);
        let expected =
            if free { now.commands[0].length } else { now.lengths[0] + 1e-4 * e.signum() };
        assert!((read - expected).abs() < 1e-12, "{shift}");
    }
}

/// The force of an elastic contact on an uneven ring against the slope of its energy `K δ^2.5/2.5`, by
/// place of the journal and by turn of the ring.
#[test]
fn an_uneven_ring_keeps_energy() {
    let law = HertzStep { stiffness: 3.7e9, exponent: 1.5, c_max: 0.0, d_max: 1e-5, clip: true };
    let clearance = Clearance {
        bearing_radius: 0.01,
        journal_radius: 0.0095,
        law: Arc::new(law),
        friction: None,
    };
    let shape = OutOfRound { amplitude: 2e-4, lobes: 3.0, direction: 0.4 };
    let frame =
        |centre: Vector2<f64>, arm| Frame { centre, arm, velocity: Vector2::zeros(), spin: 0.0 };
    let arms = [Vector2::new(0.03, -0.02), Vector2::new(-0.1, 0.05)];
    let depth = |e: Vector2<f64>, turn: f64| {
        e.norm() - (5e-4 + 2e-4 * (3.0 * (e.y.atan2(e.x) - turn - 0.4)).cos())
    };
    let energy = |e, turn| 3.7e9 * depth(e, turn).max(0.0).powf(2.5) / 2.5;
    for k in 0..12 {
        let (direction, turn) = (0.37 + 0.5 * f64::from(k), 0.9);
        let n = Vector2::new(direction.cos(), direction.sin());
        let e = n * (5e-4 + 2e-4 * (3.0 * (direction - turn - 0.4)).cos() + 8e-6);
        let (ring, journal) = (frame(Vector2::zeros(), arms[0]), frame(e, arms[1]));
        let rotation = UnitComplex::new(turn);
        let (contact, wrenches) = shape.forces(&clearance, rotation, &ring, &journal);
        assert!((contact.penetration - 8e-6).abs() < 1e-15);
        let [on_ring, on_journal] = wrenches.expect("in contact");
        let h = 1e-9;
        let slope =
            |d: Vector2<f64>| (energy(e + d * h, turn) - energy(e - d * h, turn)) / (2.0 * h);
        let push = Vector2::new(-slope(Vector2::x()), -slope(Vector2::y()));
        assert!((on_journal.xy() - push).norm() < 1e-5 * push.norm(), "{on_journal} {push}");
        assert!((on_ring.xy() + on_journal.xy()).norm() < 1e-12 * push.norm());
        // Turning the ring about its own centre works against the same energy.
        let torque = on_ring.z - arms[0].perp(&on_ring.xy());
        let h = 1e-6;
        let twist = -(energy(e, turn + h) - energy(e, turn - h)) / (2.0 * h);
        assert!((torque - twist).abs() < 1e-5 * push.norm() * 5e-4, "{torque} {twist}");
        // The journal is round: nothing turns it.
        assert!((on_journal.z - arms[1].perp(&on_journal.xy())).abs() < 1e-12 * push.norm());
        // The rate is the depth's derivative, the ring's own turning included.
        let (velocity, spin) = (Vector2::new(0.3, -0.2), 4.0);
        let moving = Frame { spin, ..ring };
        let (contact, _) =
            shape.forces(&clearance, rotation, &moving, &Frame { velocity, ..journal });
        let h = 1e-8;
        let later = |h: f64| depth(e + velocity * h, turn + spin * h);
        let rate = (later(h) - later(-h)) / (2.0 * h);
        assert!((contact.rate - rate).abs() < 1e-6, "{} {rate}", contact.rate);
    }
}

#[test]
fn an_uneven_ring_turns_with_its_body() {
    let keys = "joint = \"C2\"; amplitude_m = 2e-4; lobes = 2; direction_rad = 0.3";
    let machine = assembled(&format!("{LIVELY}{}", effect("out-of-round", keys)), &[]);
    let (machine, _) = at(&machine.mechanism, 0.31);
    let mut states = starts(&machine);
    let turn = states[6].rotation.angle();
    // The platform moves by −e against its journals.
    let e = Vector2::from([0.2e-3, -0.4e-3]);
    states[6].position -= e;
    let now = evaluate(&machine, &states);
    let theta = e.y.atan2(e.x) - turn;
    let uneven = e.norm() - (5e-4 + 2e-4 * (2.0 * (theta - 0.3)).cos());
    assert!((now.contacts[4].penetration - uneven).abs() < 1e-12);
    assert!((now.contacts[3].penetration - (e.norm() - 5e-4)).abs() < 1e-12);
}

/// The film against the pressure that Reynolds' equation for a short bearing gives,
/// `p = 6 μ ḣ (z² − L²/4)/h³`, integrated round the journal.
#[test]
fn a_film_is_the_integral_of_its_pressure() {
    let (viscosity, width, radius, clearance) = (0.1, 0.01, 0.01, 5e-4);
    let damping = PI * viscosity * radius * f64::powi(width / clearance, 3);
    let keys = format!("joint = \"C1\"; damping_Ns_m = {damping:?}; eccentricity_max = 0.95");
    let machine = assembled(&format!("{LIVELY}{}", effect("lubricant-film", &keys)), &[]).mechanism;
    for (e, v, spins) in [
        ([2e-4, 3e-4], [0.02, -0.01], [0.0, 0.0]),
        ([-4e-4, 1e-4], [-0.03, 0.05], [0.0, 0.0]),
        ([1e-4, -2e-4], [0.01, 0.02], [3.0, -1.0]),
        ([1e-4, -2e-4], [0.0, 0.0], [2.0, 2.0]),
    ] {
        let mut states = starts(&machine);
        let (e, v) = (Vector2::from(e), Vector2::from(v));
        // The ring's centre stands still, the journal passes by.
        let ring_arm = states[6].rotation * GEOMETRY.corner(0);
        let journal_arm = states[1].rotation * Vector2::new(0.1, 0.0);
        states[6].twist = wrench(-turned(ring_arm) * spins[0], spins[0]);
        states[1].position = states[6].position + ring_arm + e - journal_arm;
        states[1].twist = wrench(v - turned(journal_arm) * spins[1], spins[1]);
        let mut wrenches = vec![Vector3::zeros(); 7];
        let at = Situation { t: 0.0, mechanism: &machine, states: &states };
        machine.loads[0].add(at, &mut wrenches);

        let mean = 0.5 * (spins[0] + spins[1]);
        let mut expected = Vector2::zeros();
        let parts = 20_000;
        for k in 0..parts {
            let angle = TAU * f64::from(k) / f64::from(parts);
            let n = Vector2::new(angle.cos(), angle.sin());
            // Height of the gap in direction n and its rate; surfaces drag the film with their mean
            // speed, `∂h/∂t + ω̄ ∂h/∂θ`.
            let height = clearance - e.dot(&n);
            let rate = -v.dot(&n) - mean * e.dot(&turned(n));
            let line = -viscosity * width.powi(3) * rate / height.powi(3);
            expected -= n * (line * radius * TAU / f64::from(parts));
        }
        let force = wrenches[1].xy();
        let scale = expected.norm().max(1e-3);
        assert!((force - expected).norm() < 1e-9 * scale, "{force} {expected}");
        assert!((wrenches[6].xy() + force).norm() < 1e-12 * scale);
        let about_origin = |i: usize| wrenches[i].z + states[i].position.perp(&wrenches[i].xy());
        assert!((about_origin(1) + about_origin(6)).abs() < 1e-12 * scale);
    }
    // Bodies that turn as one, about the ring's centre, leave the film alone.
    let mut states = starts(&machine);
    let centre = states[6].position + states[6].rotation * GEOMETRY.corner(0);
    states[1].position += Vector2::new(1e-4, 2e-4);
    for state in &mut states {
        let around = turned(state.position - centre) * 3.0;
        state.twist = wrench(around, 3.0);
    }
    let mut wrenches = vec![Vector3::zeros(); 7];
    machine.loads[0].add(Situation { t: 0.0, mechanism: &machine, states: &states }, &mut wrenches);
    assert!(wrenches.iter().all(|w| w.amax() < 1e-12));
}

/// Every effect, each of its variants, on each sort of joint that it can be given.
fn settings(mechanism: &Mechanism) -> Vec<Setting> {
    let mut settings = Vec::new();
    for &kind in ALL {
        let mut joints: Vec<Option<String>> =
            kind.joints_of(mechanism).into_iter().map(Some).collect();
        if matches!(kind.joints, Joints::None | Joints::PrismaticOrAll | Joints::RevoluteOrAll) {
            joints.push(None);
        }
        for joint in [joints.first(), joints.last()].into_iter().flatten() {
            for variant in kind.variants {
                let named: Vec<_> = variant.iter().map(|name| (*name, 0.0)).collect();
                let empty = Setting::new(kind, joint.as_deref(), &named);
                let neutral = (kind.neutral)(mechanism, &empty);
                assert_eq!(neutral.len(), variant.len(), "{}", kind.name);
                settings.push(empty.with(&neutral));
            }
        }
    }
    settings
}

#[test]
fn at_its_neutral_values_an_effect_changes_nothing() {
    for sets in [["drive.mode=servo"], ["drive.mode=prescribed"]] {
        let mut machine = assembled(LIVELY, &sets);
        machine.mechanism.close(0.0).unwrap();
        let plain = history(&machine.mechanism, machine.control, 0.01);
        for setting in settings(&machine.mechanism) {
            let mut mechanism = machine.mechanism.clone();
            setting.apply(&mut mechanism).unwrap_or_else(|e| panic!("{setting:?}: {e:?}"));
            mechanism.close(0.0).unwrap();
            let changed = history(&mechanism, machine.control, 0.01);
            let off = plain.iter().zip(&changed).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(
                off < 1e-8,
                "{} {:?}: {off:e}",
                setting.kind.name,
                setting.values().collect::<Vec<_>>()
            );
        }
    }
}

#[test]
fn what_is_said_of_an_effect_fits_together() {
    let mechanism = assembled(LIVELY, &[]).mechanism;
    for kind in ALL {
        assert_eq!(ALL.iter().filter(|other| other.name == kind.name).count(), 1);
        let inside = |name: &str, value: f64| {
            let p = kind.parameter(name).unwrap_or_else(|| panic!("{}: {name}", kind.name));
            (p.bounds[0]..=p.bounds[1]).contains(&value)
        };
        for parameter in kind.parameters {
            assert!(
                parameter.default.is_none_or(|d| inside(parameter.name, d)),
                "{}",
                parameter.name
            );
            assert!(parameter.step > 0.0 && parameter.bounds[0] < parameter.bounds[1]);
        }
        for variant in kind.variants {
            for start in (kind.starts)(variant) {
                assert_eq!(start.len(), variant.len(), "{}", kind.name);
                let fits = variant.iter().zip(&start).all(|(name, value)| inside(name, *value));
                assert!(fits, "{}: {start:?}", kind.name);
            }
        }
    }
    for setting in settings(&mechanism) {
        for (name, value) in setting.values() {
            let [low, high] = setting.kind.parameter(name).unwrap().bounds;
            assert!((low..=high).contains(&value), "{} {name} = {value}", setting.kind.name);
        }
    }
}

/// The `[[effect]]` that `freeplay effects NAME` shows.
fn example(place: &Place, kind: &Kind) -> String {
    let text = place.good(&format!("effects {}", kind.name));
    let start = text.find("    [[effect]]").unwrap_or_else(|| panic!("{text}"));
    text[start..].lines().map(|line| format!("{}\n", line.trim_start())).collect()
}

#[test]
fn every_example_runs_and_repeats() {
    let place = Place::new();
    // What has no name is written by a calibration, not by hand.
    for kind in ALL.iter().filter(|kind| kind.name != "unnamed") {
        for mode in ["prescribed", "servo"] {
            let text =
                format!("{LIVELY}drive = {{ mode = \"{mode}\" }}\n{}", example(&place, kind));
            place.write("example.toml", &text);
            place.good("run example.toml --duration 0.01 --quiet --out a --force");
            place.good("run a/scenario.toml --quiet --out b --force");
            assert_eq!(
                place.read("a/timeseries.csv"),
                place.read("b/timeseries.csv"),
                "{}",
                kind.name
            );
            assert_eq!(
                place.read("a/scenario.toml"),
                place.read("b/scenario.toml"),
                "{}",
                kind.name
            );
        }
    }
}

#[test]
fn effects_are_explained_in_full() {
    let place = Place::new();
    let all = place.good("effects");
    let json: serde_json::Value = serde_json::from_str(&place.good("effects --json")).unwrap();
    assert_eq!(json.as_array().unwrap().len(), ALL.len());
    assert!(all.lines().all(|line| line.chars().count() <= 100), "lines fit");
    for (kind, object) in ALL.iter().zip(json.as_array().unwrap()) {
        assert_eq!(object["name"], kind.name);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in [kind.summary, kind.equation, kind.source, kind.trace] {
            assert!(words(&all).contains(&words(part)), "{}: {part}", kind.name);
        }
        for (parameter, entry) in
            kind.parameters.iter().zip(object["parameters"].as_array().unwrap())
        {
            assert!(all.contains(parameter.name));
            assert_eq!(entry["name"], parameter.name);
            assert_eq!(entry["default"].as_f64(), parameter.default);
        }
    }
    let one = place.good("effects payload --json");
    assert_eq!(serde_json::from_str::<serde_json::Value>(&one).unwrap()["name"], "payload");
    place.refused("effects paylod", &["paylod", "'payload'"]);
}

#[test]
fn effects_can_be_set_and_varied() {
    let place = Place::new();
    place.write("my.toml", &format!("{LIVELY}{}", effect("payload", "mass_kg = 0.1")));
    place.good("run my.toml --duration 0.01 --quiet --out a --set effect.0.mass_kg=0.25");
    assert!(place.read("a/scenario.toml").contains("mass_kg = 0.25"));
    place.good("sweep my.toml --duration 0.01 --quiet --out s --vary effect.0.mass_kg=0,1,2");
    let table = place.read("s/sweep.csv");
    assert_eq!(table.lines().count(), 4, "{table}");
    assert!(table.lines().next().unwrap().contains("effect.0.mass_kg"), "{table}");
    place.refused(
        "sweep my.toml --out t --vary effect.0.mass_kg=0,99",
        &["effect.0.mass_kg", "is 99"],
    );
    let set = "--set effect=[{kind=\"drag\",force_Ns_m=3}]";
    place.good(&format!("run --duration 0.01 --quiet --out b {set}"));
    assert!(place.read("b/scenario.toml").contains("force_Ns_m = 3"));
}

/// A run compares with the machine as declared.
#[test]
fn the_ideal_machine_has_no_effects() {
    let plain = ideal("", &[]);
    let mut loaded = ideal(&effect("payload", "mass_kg = 5"), &[]);
    let mut plain = plain;
    for t in INSTANTS {
        assert_eq!(loaded.ideal.at(t).drive_forces, plain.ideal.at(t).drive_forces);
    }
}

#[test]
fn wrong_effects_are_refused_with_file_and_line() {
    let place = Place::new();
    // Line 1 is the mechanism's, line 2 `[[effect]]`, line 3 its kind, and so on.
    let cases: &[(&str, &str, &[&str])] = &[
        ("paylod", "", &["bad.toml:3: effect.0.kind", "\"paylod\" is not an effect", "payload"]),
        ("payload", "mass = 3", &["bad.toml:4: ", "effect.0.mass", "known here: mass_kg"]),
        ("payload", "mass_kg = 30", &["bad.toml:4: effect.0.mass_kg: is 30", "from 0 to 20 kg"]),
        ("payload", "mass_kg = -1", &["bad.toml:4: effect.0.mass_kg: is -1"]),
        ("payload", "mass_kg = \"much\"", &["bad.toml:4: effect.0.mass_kg", "expected a number"]),
        ("payload", "mass_kg = nan", &["bad.toml:4: effect.0.mass_kg: is NaN"]),
        (
            "payload",
            "joint = \"A1\"",
            &["bad.toml:4: ", "`joint` is not a key of the effect payload"],
        ),
        (
            "sensor-offset",
            "offset_m = 1e-3",
            &["bad.toml:2: effect.0.joint: is missing", "joint = "],
        ),
        (
            "sensor-offset",
            "joint = \"A1\"",
            &["bad.toml:4: effect.0.joint", "\"A1\"", "P1, P2, P3"],
        ),
        ("anchor-offset", "joint = \"C1\"", &["bad.toml:4: effect.0.joint", "not on the base"]),
        ("joint-wear", "joint = \"C1\"", &["bad.toml:2: effect.0.clearance_m: is missing"]),
        ("joint-wear", "joint = \"C1\"; clearance_m = 0.01", &["bad.toml:5: effect.0.clearance_m"]),
        (
            "out-of-round",
            "joint = \"C1\"; lobes = 2.5",
            &["bad.toml:5: effect.0.lobes", "whole number"],
        ),
        (
            "out-of-round",
            "joint = \"C1\"; amplitude_m = 6e-4",
            &["bad.toml:5: effect.0.amplitude_m", "below the joint's clearance"],
        ),
        ("servo-gain", "joint = 3", &["bad.toml:4: effect.0.joint", "name of a joint, in quotes"]),
        ("sensor-offset", "joint = \"P1\"; offset_m = 0.05; # far", &[]),
    ];
    for (kind, keys, fragments) in cases {
        let text = format!("mechanism = {{ kind = \"3rpr\" }}\n{}", effect(kind, keys));
        place.write("bad.toml", &text);
        if fragments.is_empty() {
            place.good("check bad.toml --quiet");
        } else {
            place.refused("run bad.toml --out r", fragments);
        }
    }
    place.write("bad.toml", "mechanism = { kind = \"3rpr\" }\n[[effect]]\njoint = \"A1\"\n");
    place.refused("run bad.toml --out r", &["bad.toml:2: effect.0.kind: is missing"]);
    let two = format!("mechanism = {{ kind = \"3rpr\" }}\n{0}{0}bad = 1\n", effect("drag", ""));
    place.write("bad.toml", &two);
    place.refused("run bad.toml --out r", &["bad.toml:8: ", "effect.1.bad"]);
    // The physics engine's own contacts know round rings only.
    let keys = effect("out-of-round", "joint = \"C1\"; amplitude_m = 1e-4");
    place.write("bad.toml", &format!("mechanism = {{ kind = \"3rpr\" }}\n{keys}"));
    let native = "run bad.toml --out r --set contact.law=native";
    place.refused(native, &["bad.toml:3: effect.0.kind", "contact.law"]);
}
