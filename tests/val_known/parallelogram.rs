//! A parallelogram with three parallel cranks: one holds what the two others hold already.
//!
//! Grübler's count finds no freedom, the rank of the joints' rows one; the forces in the three cranks are
//! not determined, the motion and the torque are. In closed form, with m the mass of the coupler, M and I
//! mass and inertia of all cranks together: `τ = (I + M l²/4 + m l²) φ̈ + (M/2 + m) g l cos φ`.

use super::{machine, simulate};
use freeplay::engine::Schedule;
use freeplay::model::Machine;

const LENGTH: f64 = 0.12;
const MASS: f64 = 0.08;
const INERTIA: f64 = 2e-4;
const COUPLER: f64 = 0.5;
const GRAVITY: f64 = 9.81;

/// Cranks at these places on the ground (m), each as heavy as so many.
fn parallelogram(cranks: &[(f64, f64)]) -> Machine {
    let mut ground = "[ground.points]\n".to_owned();
    let (mut bodies, mut joints, mut ends) = (String::new(), String::new(), Vec::new());
    for (i, (place, share)) in cranks.iter().enumerate() {
        ground += &format!("A{i} = [{place:?}, 0.0]\n");
        ends.push(format!("B{i} = [{place:?}, 0.0]"));
        bodies += &format!(
            "
            [[body]]
            name = \"crank{i}\"
            mass = {:?}
            inertia = {:?}
            center_of_mass = [{:?}, 0.0]
            points = {{ A = [0.0, 0.0], B = [{LENGTH:?}, 0.0] }}
            start = [{place:?}, 0.0, 1.0]
            ",
            share * MASS,
            share * INERTIA,
            LENGTH / 2.0,
        );
        joints += &format!(
            "
            [[joint]]
            name = \"A{i}\"
            kind = \"revolute\"
            ring = \"ground.A{i}\"
            journal = \"crank{i}.A\"
            [[joint]]
            name = \"B{i}\"
            kind = \"revolute\"
            ring = \"crank{i}.B\"
            journal = \"coupler.B{i}\"
            "
        );
    }
    machine(&format!(
        "
        [environment]
        gravity = [0.0, {:?}]
        {ground}
        {bodies}
        [[body]]
        name = \"coupler\"
        mass = {COUPLER:?}
        inertia = 3e-3
        center_of_mass = [0.2, 0.03]
        points = {{ {} }}
        start = [0.06, 0.1, 0.0]
        {joints}
        [[drive]]
        joint = \"A0\"
        kind = \"prescribed\"
        [[motion]]
        joint = \"A0\"
        kind = \"multisine\"
        center = 1.2
        terms = [{{ amplitude = 0.7, frequency = 1.5, phase = 0.4 }}, {{ amplitude = 0.1, frequency = 4.0 }}]
        ",
        -GRAVITY,
        ends.join(", "),
    ))
}

const THREE: [(f64, f64); 3] = [(0.0, 1.0), (0.15, 1.0), (0.4, 1.0)];
/// Without the middle crank, its mass on the last one.
const TWO: [(f64, f64); 2] = [(0.0, 1.0), (0.4, 2.0)];

#[test]
fn freedoms_name_the_redundant_joints() {
    let of = |machine: &Machine| {
        let mechanism = &machine.mechanism;
        let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
        let freedoms = mechanism.freedoms(&states);
        let mut names: Vec<String> = freedoms
            .redundant
            .iter()
            .map(|joint| mechanism.joint_name(*joint).to_owned())
            .collect();
        names.sort();
        (freedoms.counted, freedoms.free, freedoms.driven, freedoms.overdriven, names)
    };
    let [a0, a1, a2, b0, b1, b2] = ["A0", "A1", "A2", "B0", "B1", "B2"].map(str::to_owned);
    assert_eq!(of(&parallelogram(&THREE)), (0, 1, 1, vec![], vec![a0, a1, a2, b0, b1, b2]));
    assert_eq!(of(&parallelogram(&TWO)), (1, 1, 1, vec![], vec![]));
}

/// Torque (N m) over time of the ideal machine and of a simulated one; the coupler stays level in both.
fn torques(machine: &mut Machine) -> [Vec<f64>; 2] {
    let mechanism = machine.mechanism.clone();
    let coupler = super::body(&mechanism, "coupler");
    let mut torques = [vec![], vec![]];
    let mut tilt = 0.0f64;
    let schedule = Schedule { duration: 1.0, interval: 0.01 };
    simulate(&mechanism, 1e-7, schedule, &mut |instant| {
        tilt = tilt.max(instant.angles[coupler].abs());
        let finite = |x: &f64| x.is_finite();
        assert!(instant.states.iter().all(|s| s.position.iter().chain(&s.twist).all(finite)));
        assert!(instant.evaluation.reactions.iter().all(|force| force.iter().all(finite)));
        torques[1].push(instant.evaluation.drive_forces[0]);
        let states = machine.ideal.states(instant.t).unwrap();
        tilt = tilt.max(states[coupler].rotation.angle().abs());
        torques[0].push(machine.ideal.at(instant.t).drive_forces[0]);
    });
    println!("the coupler tilts by {tilt:.1e} rad");
    assert!(tilt < 1e-9, "the coupler tilts by {tilt:e} rad");
    torques
}

#[test]
fn a_third_crank_changes_neither_motion_nor_torque() {
    let [three, two] = [&THREE[..], &TWO[..]].map(|cranks| torques(&mut parallelogram(cranks)));
    let schedule = Schedule { duration: 1.0, interval: 0.01 };
    let closed: Vec<f64> = (0..three[0].len())
        .map(|k| {
            let t = schedule.time(k);
            let mut phi = [1.2, 0.0];
            for [amplitude, frequency, phase] in [[0.7, 1.5, 0.4], [0.1, 4.0, 0.0]] {
                let omega = std::f64::consts::TAU * frequency;
                let sine = amplitude * f64::sin(omega * t + phase);
                phi = [phi[0] + sine, phi[1] - omega * omega * sine];
            }
            let square = LENGTH * LENGTH;
            let inertia = 3.0 * INERTIA + 0.75 * MASS * square + COUPLER * square;
            inertia * phi[1] + (1.5 * MASS + COUPLER) * GRAVITY * LENGTH * phi[0].cos()
        })
        .collect();
    let peak = closed.iter().fold(0.0f64, |peak, torque| peak.max(torque.abs()));
    let pairs = [
        ("ideal, three", &three[0]),
        ("ideal, two", &two[0]),
        ("run, three", &three[1]),
        ("run, two", &two[1]),
    ];
    for (what, torques) in pairs {
        let errors = torques.iter().zip(&closed).map(|(a, b)| (a - b).abs());
        let error = errors.fold(0.0, f64::max) / peak;
        println!("{what} cranks: torque up to {peak:.3} N m, error {error:.1e} of it");
        assert!(error < 1e-9, "{what} cranks: {error:e}");
    }
}
