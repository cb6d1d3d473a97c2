//! Error control on mechanisms other than the 3-RPR: pendulums and slider-cranks, against conserved
//! energy, closed forms and their own limit.
//!
//! Small and fast mechanisms are taken where the order of convergence is asked for: a slow one is
//! exact to rounding at the longest step that a tolerance may choose.

mod common;

use common::{hertz, kinetic_energy};
use freeplay::contact::{Clearance, HertzStep};
use freeplay::engine::{Instant, Schedule, StepControl, Work, run};
use freeplay::mechanism::{
    Actuator, Attachment, Bearing, Body, BodyState, Command, Commands, Drive, JointIndex,
    Mechanism, Prismatic, Revolute,
};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

const LADDER: [f64; 5] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

/// A bar from `from` to `to` (m) that turns with `spin` rad/s, its start moving with `velocity`.
fn bar(mass: f64, from: Vector2<f64>, to: Vector2<f64>, velocity: Vector2<f64>, spin: f64) -> Body {
    let along = to - from;
    let twist = velocity + Vector2::new(-along.y, along.x) * (spin / 2.0);
    let start = BodyState {
        position: (from + to) / 2.0,
        rotation: UnitComplex::new(along.y.atan2(along.x)),
        twist: Vector3::new(twist.x, twist.y, spin),
    };
    Body::new("bar", mass, mass * along.norm_squared() / 12.0, start)
}

fn at(body: usize, x: f64) -> Attachment {
    Attachment { body: Some(body), point: Vector2::new(x, 0.0) }
}

const GROUND: Attachment = Attachment { body: None, point: Vector2::new(0.0, 0.0) };

fn joint(ring: Attachment, journal: Attachment, bearing: Bearing) -> Revolute {
    Revolute { name: "joint".into(), ring, journal, bearing, out_of_round: None }
}

/// A mechanism without drives.
fn free(bodies: Vec<Body>, revolutes: Vec<Revolute>, gravity: f64) -> Mechanism {
    Mechanism { revolutes, gravity: Vector2::new(0.0, gravity), ..Mechanism::free(bodies) }
}

/// A contact without losses.
fn lossless(clearance: f64) -> HertzStep {
    HertzStep { c_max: 0.0, ..hertz(0.01, 0.01 - clearance) }
}

fn play(clearance: f64) -> Bearing {
    Bearing::Clearance(Clearance {
        bearing_radius: 0.01,
        journal_radius: 0.01 - clearance,
        law: Arc::new(lossless(clearance)),
        friction: None,
    })
}

/// Kinetic energy, height and what the contacts' springs store, `K δ^2.5/2.5`, in J.
fn energy(mechanism: &Mechanism, instant: &Instant) -> f64 {
    let height: f64 = mechanism
        .bodies
        .iter()
        .zip(instant.states)
        .map(|(body, state)| -body.mass * mechanism.gravity.dot(&state.position))
        .sum();
    let contacts = mechanism.revolutes.iter().zip(&instant.evaluation.contacts);
    let springs: f64 = contacts
        .filter_map(|(joint, contact)| {
            let Bearing::Clearance(clearance) = &joint.bearing else { return None };
            let law = lossless(clearance.radial());
            Some(law.stiffness * contact.penetration.max(0.0).powf(2.5) / 2.5)
        })
        .sum();
    kinetic_energy(mechanism, instant.states) + height + springs
}

/// What a run did: positions of the output body, largest change of energy relative to `scale` J, and
/// what it took.
struct Done {
    rows: Vec<Vector2<f64>>,
    energy_error: f64,
    work: Work,
    impacts: u64,
}

fn go(mechanism: &Mechanism, tolerance: f64, schedule: Schedule, scale: f64) -> Done {
    let (mut rows, mut first, mut energy_error, mut impacts) = (Vec::new(), None, 0.0f64, 0);
    let work = run(mechanism, StepControl::Tolerance(tolerance), schedule, &mut |instant| {
        rows.push(instant.states[mechanism.output].position);
        let now = energy(mechanism, instant);
        energy_error = energy_error.max((now - *first.get_or_insert(now)).abs() / scale);
        impacts = instant.tallies.iter().map(|tally| tally.impacts).sum();
    })
    .unwrap();
    Done { rows, energy_error, work, impacts }
}

fn apart(a: &[Vector2<f64>], b: &[Vector2<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// `K(k) = π / (2 agm(1, √(1 − k²)))` (Abramowitz & Stegun, 17.6.3).
fn elliptic_k(k: f64) -> f64 {
    let (mut a, mut g) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..10 {
        (a, g) = (0.5 * (a + g), f64::sqrt(a * g));
    }
    FRAC_PI_2 / a
}

/// A bar that hangs on the ground, let go level: the period is `4 K(sin(π/4)) √(2L/3g)`.
fn pendulum(length: f64, gravity: f64, bearing: Bearing, sag: f64) -> (Mechanism, f64) {
    let from = Vector2::new(sag, 0.0);
    let body = bar(0.1, from, from + Vector2::new(length, 0.0), Vector2::zeros(), 0.0);
    let joints = vec![joint(GROUND, at(0, -length / 2.0), bearing)];
    let period = 4.0 * elliptic_k((PI / 4.0).sin()) * (2.0 * length / (3.0 * gravity)).sqrt();
    (free(vec![body], joints, -gravity), period)
}

/// Angle from the vertical at odd quarters of the period, where it passes the bottom, as a distance
/// of the centre in m; and steps.
fn phase_error(mechanism: &Mechanism, period: f64, tolerance: f64) -> (f64, u64) {
    let schedule = Schedule { duration: 3.25 * period, interval: period / 4.0 };
    let done = go(mechanism, tolerance, schedule, 1.0);
    let bottoms = done.rows.iter().skip(1).step_by(2);
    (bottoms.map(|p| p.x.abs()).fold(0.0, f64::max), done.work.steps)
}

#[test]
fn a_pendulum_keeps_the_period_of_the_elliptic_integral() {
    // Ten millimetres of bar under 100 g: 12 periods a second, so that the tolerance rules.
    let (mechanism, period) = pendulum(0.01, 981.0, Bearing::Ideal, 0.0);
    let found = LADDER.map(|tolerance| phase_error(&mechanism, period, tolerance));
    let (errors, steps) = (found.map(|(error, _)| error), found.map(|(_, steps)| steps as f64));
    let order = order(&errors[..3], &steps[..3]);
    println!(
        "period {period:.4} s, errors {} m in {steps:?} steps: order {order:.2}",
        short(&errors)
    );
    falls(&errors, 1e-10);
    assert!(order >= 3.0, "order {order}");
}

#[test]
fn a_pendulum_with_play_keeps_energy_and_nearly_the_period() {
    let clearance = 2e-4;
    let (mechanism, _) = pendulum(0.1, 9.81, play(clearance), -clearance);
    let schedule = Schedule { duration: 0.3, interval: 1e-3 };
    let scale = 0.1 * 9.81 * 0.05;
    let found = LADDER.map(|tolerance| go(&mechanism, tolerance, schedule, scale).energy_error);
    let impacts = go(&mechanism, 1e-6, schedule, scale).impacts;
    println!("c = 0.2 mm: energy errors {}, {impacts} hits", short(&found));
    assert!(impacts > 20, "nothing hits: {impacts}");
    falls(&found, 1e-7);

    let clearance = 1e-6;
    let (mechanism, period) = pendulum(0.1, 9.81, play(clearance), 0.0);
    let (error, _) = phase_error(&mechanism, period, 1e-5);
    println!("c = 1 µm: {error:.1e} m from the period of a tight joint");
    // The play lengthens the pendulum: 8e-6 of the period, over three of them, at 0.86 m/s.
    assert!(error < 40.0 * clearance, "{error} m");
}

/// Numbers with one digit, for a line of output.
fn short(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:.1e} ")).collect()
}

/// Each error is smaller than the one before, and the last as small as asked for.
fn falls(errors: &[f64], last: f64) {
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "does not fall: {errors:?}");
    assert!(errors[errors.len() - 1] < last, "{errors:?}, not below {last:e}");
}

/// Errors against the limit of a run's own, energy errors, and order of the former over the ladder.
fn converge(
    mechanism: &Mechanism,
    ladder: &[f64],
    schedule: Schedule,
    scale: f64,
) -> [Vec<f64>; 3] {
    let limit = go(mechanism, ladder[ladder.len() - 1] * 1e-3, schedule, scale);
    let runs: Vec<Done> = ladder.iter().map(|t| go(mechanism, *t, schedule, scale)).collect();
    [
        runs.iter().map(|run| apart(&run.rows, &limit.rows)).collect(),
        runs.iter().map(|run| run.energy_error).collect(),
        runs.iter().map(|run| run.work.steps as f64).collect(),
    ]
}

fn order(errors: &[f64], steps: &[f64]) -> f64 {
    let last = errors.len() - 1;
    (errors[0] / errors[last]).ln() / (steps[last] / steps[0]).ln()
}

#[test]
fn a_double_pendulum_converges_and_keeps_its_energy() {
    let (length, gravity) = (0.01, 981.0);
    let [a, b] = [1.0, 2.0].map(|k| Vector2::new(k * length, 0.0));
    let bodies = vec![
        bar(0.1, Vector2::zeros(), a, Vector2::zeros(), 0.0),
        bar(0.1, a, b, Vector2::zeros(), 0.0),
    ];
    let joints = vec![
        joint(GROUND, at(0, -length / 2.0), Bearing::Ideal),
        joint(at(0, length / 2.0), at(1, -length / 2.0), Bearing::Ideal),
    ];
    let mechanism = free(bodies, joints, -gravity);
    let schedule = Schedule { duration: 0.04, interval: 4e-3 };
    let [errors, energies, steps] = converge(&mechanism, &LADDER, schedule, 0.1 * gravity * length);
    let order = order(&errors[..4], &steps[..4]);
    let (off, lost) = (short(&errors), short(&energies));
    println!("errors {off} m, energy {lost}, steps {steps:?}: order {order:.2}");
    falls(&errors, 1e-10);
    falls(&energies, 1e-7);
    assert!(order >= 3.0, "order {order}");
}

const CRANK: f64 = 0.01;
const ROD: f64 = 0.03;
const MASSES: [f64; 3] = [0.1, 0.05, 0.1];

/// A slider-crank that turns freely in the ground; crank pin and slider pin as given.
fn slider_crank(bearing: Bearing, speed: f64) -> Mechanism {
    let pin = Vector2::new(0.0, CRANK);
    let slider = Vector2::new((ROD * ROD - CRANK * CRANK).sqrt(), 0.0);
    // The crank stands upright, where the rod only shifts.
    let velocity = Vector2::new(-CRANK * speed, 0.0);
    let start = BodyState {
        position: slider,
        rotation: UnitComplex::identity(),
        twist: Vector3::new(velocity.x, 0.0, 0.0),
    };
    let block = Body::new("slider", MASSES[2], 1e-5, start);
    let bodies = vec![
        bar(MASSES[0], Vector2::zeros(), pin, Vector2::zeros(), speed),
        bar(MASSES[1], pin, slider, velocity, 0.0),
        block,
    ];
    let joints = vec![
        joint(GROUND, at(0, -CRANK / 2.0), Bearing::Ideal),
        joint(at(0, CRANK / 2.0), at(1, -ROD / 2.0), bearing.clone()),
        joint(at(2, 0.0), at(1, ROD / 2.0), bearing),
    ];
    let guide = Prismatic {
        name: "guide".into(),
        base: GROUND,
        slider: at(2, 0.0),
        axes: [UnitComplex::identity(); 2],
        play: false,
    };
    Mechanism { prismatics: vec![guide], ..free(bodies, joints, 0.0) }
}

/// Moment of inertia that a slider-crank without play opposes to its crank at `angle` rad, from the
/// geometry alone: `Σ m |dr/dθ|² + I (dψ/dθ)²`.
fn inertia(angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let slope = -CRANK / ROD * sin;
    let along = (1.0 - slope * slope).sqrt();
    let turn = -CRANK / ROD * cos / along;
    let slider = -CRANK * sin - ROD * slope * turn;
    let centre = [-CRANK * sin - ROD / 2.0 * slope * turn, CRANK * cos + ROD / 2.0 * along * turn];
    MASSES[0] * CRANK * CRANK / 3.0
        + MASSES[1] * (centre[0].powi(2) + centre[1].powi(2) + ROD * ROD / 12.0 * turn * turn)
        + MASSES[2] * slider * slider
}

/// Time in s that the crank takes from upright to `angle` rad: `∫ √(J(θ)/J₀)/ω₀ dθ`, as its energy
/// stays; Simpson's rule.
fn time_to(angle: f64, speed: f64) -> f64 {
    const PARTS: usize = 2000;
    let h = (angle - FRAC_PI_2) / PARTS as f64;
    let f = |k: usize| (inertia(FRAC_PI_2 + k as f64 * h) / inertia(FRAC_PI_2)).sqrt() / speed;
    let inner: f64 = (1..PARTS).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum();
    (f(0) + inner + f(PARTS)) * h / 3.0
}

#[test]
fn a_slider_crank_without_play_moves_as_its_energy_says() {
    let speed = 100.0;
    let mut mechanism = slider_crank(Bearing::Ideal, speed);
    mechanism.output = 0;
    let schedule = Schedule { duration: 0.2, interval: 2e-3 };
    let found = LADDER.map(|tolerance| {
        let (mut worst, mut angle) = (0.0f64, FRAC_PI_2);
        run(&mechanism, StepControl::Tolerance(tolerance), schedule, &mut |instant| {
            let seen = instant.states[0].rotation.angle();
            angle += (seen - angle + PI).rem_euclid(2.0 * PI) - PI;
            worst = worst.max((time_to(angle, speed) - instant.t).abs() * speed * CRANK);
        })
        .unwrap();
        worst
    });
    let turns = 0.2 * speed / (2.0 * PI);
    println!("errors of the crank pin {} m after {turns:.1} turns", short(&found));
    falls(&found, 1e-9);
}

#[test]
fn a_slider_crank_with_play_converges_and_keeps_its_energy() {
    let mechanism = slider_crank(play(1e-4), 30.0);
    let scale = 0.5 * inertia(FRAC_PI_2) * 30.0 * 30.0;
    // As far as digits reach: after some more hits, all solvers differ.
    let schedule = Schedule { duration: 0.03, interval: 1e-3 };
    let [errors, energies, steps] = converge(&mechanism, &LADDER, schedule, scale);
    let impacts = go(&mechanism, 1e-6, schedule, scale).impacts;
    let (off, lost) = (short(&errors), short(&energies));
    println!("errors {off} m, energy {lost}, steps {steps:?}, {impacts} hits");
    assert!(impacts > 5, "nothing hits: {impacts}");
    falls(&errors, 1e-8);
    falls(&energies, 1e-6);
}

#[derive(Debug)]
struct AtZero;

impl Commands for AtZero {
    fn at(&self, _: f64, commands: &mut [Command]) {
        commands.fill(Command::default());
    }
}

/// Three bars in one line, free in space and turning, held together by two springs along the line.
#[test]
fn a_chain_of_prismatic_joints_keeps_energy_and_momentum() {
    let stiffness = 2e3;
    let spin = 40.0;
    let bodies: Vec<Body> = (0..3)
        .map(|i| {
            let x = 0.05 * (f64::from(i) - 1.0);
            let from = Vector2::new(x - 0.02, 0.0);
            let velocity = Vector2::new(0.3 * x / 0.05, from.x * spin);
            bar(0.1, from, Vector2::new(x + 0.02, 0.0), velocity, spin)
        })
        .collect();
    let prismatic = |i: usize| Prismatic {
        name: "spring".into(),
        base: at(i, 0.0),
        slider: at(i + 1, 0.0),
        axes: [UnitComplex::identity(); 2],
        play: false,
    };
    let spring = |i: usize| {
        let drive = Drive::Servo { stiffness, damping: 0.0 };
        Actuator::new("spring", JointIndex::Prismatic(i), drive)
    };
    let mechanism = Mechanism {
        prismatics: vec![prismatic(0), prismatic(1)],
        actuators: vec![spring(0), spring(1)],
        commands: Arc::new(AtZero),
        ..free(bodies, vec![], 0.0)
    };
    let schedule = Schedule { duration: 0.1, interval: 1e-3 };
    let found = LADDER.map(|tolerance| {
        let (mut first, mut worst) = (None, [0.0f64; 2]);
        run(&mechanism, StepControl::Tolerance(tolerance), schedule, &mut |instant| {
            let springs: f64 =
                instant.evaluation.lengths.iter().map(|q| 0.5 * stiffness * q * q).sum();
            let moment: f64 = mechanism
                .bodies
                .iter()
                .zip(instant.states)
                .map(|(b, s)| b.mass * s.position.perp(&s.twist.xy()) + b.inertia * s.twist.z)
                .sum();
            let now = [kinetic_energy(&mechanism, instant.states) + springs, moment];
            let start = *first.get_or_insert(now);
            for k in 0..2 {
                worst[k] = worst[k].max((now[k] / start[k] - 1.0).abs());
            }
        })
        .unwrap();
        worst
    });
    let [energies, moments] = [0, 1].map(|k| found.map(|errors| errors[k]));
    println!("energy {}, moment of momentum {}", short(&energies), short(&moments));
    falls(&energies, 1e-7);
    falls(&moments, 1e-7);
}
