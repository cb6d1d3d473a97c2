//! A machine with an effect, what its drives give, and what they should give by virtual work.

use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::motion::{Motion, PathPoint};
use freeplay::mechanism::three_rpr::Geometry;
use freeplay::mechanism::{BodyState, Dynamics, Evaluation, Mechanism, TelescopicLegs};
use freeplay::scenario::Scenario;
use freeplay::simulate::{Machine, assemble};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

pub(super) const GEOMETRY: Geometry = Geometry { base_side: 0.66, platform_side: 0.1 };

/// A motion in x, y and φ, and gravity: everything that a load can be confused with is there.
pub(super) const LIVELY: &str = "motion = { kind = \"multisine\", center = [0.01, -0.01, 0.6], terms = [\n\
    { amplitude = [0.02, 0.01, 0.1], frequency = 1.1, phase = 0.3 },\n\
    { amplitude = [-0.01, 0.02, 0.05], frequency = 2.3, phase = 1.1 }] }\n\
    environment = { gravity = [0.7, -9.81] }\nmechanism = { kind = \"3rpr\" }\n";

pub(super) fn assembled(text: &str, sets: &[&str]) -> Machine {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scenario = Scenario::from_text(text, "test.toml", &sets).unwrap_or_else(|e| panic!("{e}"));
    assemble(&scenario).unwrap_or_else(|e| panic!("{e}"))
}

/// The machine without clearance on [`LIVELY`], with one effect.
pub(super) fn ideal(effect: &str, sets: &[&str]) -> Machine {
    assembled(&format!("{LIVELY}{effect}"), &[sets, &["contact.law=ideal"]].concat())
}

pub(super) fn effect(kind: &str, keys: &str) -> String {
    format!("[[effect]]\nkind = \"{kind}\"\n{}\n", keys.replace("; ", "\n"))
}

/// A mechanism put together as it is commanded at `t`, and what acts there.
pub(super) fn at(mechanism: &Mechanism, t: f64) -> (Mechanism, Evaluation) {
    let mut mechanism = mechanism.clone();
    mechanism.epoch = t;
    mechanism.close(0.0).unwrap_or_else(|gap| panic!("open by {gap}"));
    let states = starts(&mechanism);
    let now = evaluate(&mechanism, &states);
    (mechanism, now)
}

pub(super) fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|b| b.start).collect()
}

pub(super) fn evaluate(mechanism: &Mechanism, states: &[BodyState]) -> Evaluation {
    let mut now = Evaluation::new(mechanism);
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.forces(mechanism, 0.0, states, &mut now);
    dynamics.accelerations(mechanism, states, &mut now);
    now
}

pub(super) fn pose(mechanism: &Mechanism, states: &[BodyState]) -> Vector3<f64> {
    let state = mechanism.output_state(states);
    Vector3::new(state.position.x, state.position.y, state.rotation.angle())
}

/// Drive forces that balance a wrench (N, N, N·m about C) on the platform: `Jᵀ F = −w`.
pub(super) fn balance(pose: Vector3<f64>, wrench: Vector3<f64>) -> Vector3<f64> {
    GEOMETRY.jacobian(pose).transpose().lu().solve(&-wrench).expect("not singular")
}

/// One point of a motion, at all times.
#[derive(Debug)]
struct At(PathPoint);

impl Motion for At {
    fn at(&self, _: f64) -> PathPoint {
        self.0
    }
}

/// The wrench on the platform that does the virtual work of wrenches on all bodies.
pub(super) fn reduced(pose: Vector3<f64>, wrenches: &[Vector3<f64>]) -> Vector3<f64> {
    let mechanism = ideal("", &[]).mechanism;
    let platform = mechanism.output;
    Vector3::from_fn(|axis, _| {
        let mut rate = Vector3::zeros();
        rate[axis] = 1.0;
        let point = PathPoint { pose, rate, ..PathPoint::default() };
        let motion = Arc::new(At(point));
        let legs = TelescopicLegs::of(&mechanism, platform, Vector2::zeros(), motion).unwrap();
        let states = legs.states(0.0);
        states.iter().zip(wrenches).map(|(state, w)| state.twist.dot(w)).sum::<f64>()
    })
}

pub(super) const INSTANTS: [f64; 4] = [0.0, 0.13, 0.31, 0.77];

/// Drive forces of the ideal machine with an effect, less those without, against `expected` of the
/// instant: time, motion there, and the plain machine.
pub(super) fn forces_change(
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
pub(super) fn platform_feels(
    kind: &str,
    keys: &str,
    wrench: impl Fn(f64, &PathPoint) -> Vector3<f64>,
) {
    forces_change(kind, keys, |t, point, _, _| balance(point.pose, wrench(t, point)));
}

/// Positions of all bodies and drive forces over a short run.
pub(super) fn history(mechanism: &Mechanism, control: StepControl, duration: f64) -> Vec<f64> {
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
pub(super) fn same_run(kind: &str, keys: &str, common: &[&str], declared: &[&str]) {
    let with = assembled(&format!("{LIVELY}{}", effect(kind, keys)), common);
    let mut other = assembled(LIVELY, &[common, declared].concat());
    let mut plain = assembled(LIVELY, common);
    for machine in [&mut other, &mut plain] {
        machine.mechanism.close(0.0).unwrap();
    }
    let runs = [with, other, plain].map(|m| history(&m.mechanism, m.control, 0.03));
    let apart =
        |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    let (off, done) = (apart(&runs[0], &runs[1]), apart(&runs[0], &runs[2]));
    assert!(off < 1e-6 && done > 1e3 * off.max(1e-9), "{kind}: {off:e}, does {done:e}");
}

pub(super) fn turned(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

pub(super) fn wrench(force: Vector2<f64>, torque: f64) -> Vector3<f64> {
    Vector3::new(force.x, force.y, torque)
}

pub(super) const GRAVITY: Vector2<f64> = Vector2::new(0.7, -9.81);
