//! Effects in the revolute joints.

use super::common::{
    GEOMETRY, LIVELY, assembled, at, effect, evaluate, same_run, starts, turned, wrench,
};
use freeplay::contact::{Clearance, Frame, HertzStep, OutOfRound, RingShape};
use freeplay::mechanism::Situation;
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

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

/// On the spring of the declared law; laws that a scenario names have the same, Hertz' for the radii.
#[test]
fn another_law_of_contact_is_that_law() {
    let flores = ["contact.law=flores", "contact.restitution=0.6"];
    same_run("contact-law", "restitution = 0.6", &[], &flores);
    let hunt = ["contact.law=hunt-crossley", "contact.damping=3"];
    same_run("contact-law", "hysteresis_s_m = 3.0", &[], &hunt);
    same_run("contact-law", "c_max_Ns_m = 250.0", &[], &["contact.c_max=250"]);
    // The other way round.
    let elastic = ["contact.law=hertz", "contact.exponent=1.5"];
    same_run("contact-law", "restitution = 1.0", &[], &elastic);
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
    let shape = RingShape::from(OutOfRound { amplitude: 2e-4, lobes: 3.0, direction: 0.4 });
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
        let (contact, wrenches) = shape.forces(&clearance, None, rotation, &ring, &journal);
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
            shape.forces(&clearance, None, rotation, &moving, &Frame { velocity, ..journal });
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
        let at = Situation { t: 0.0, mechanism: &machine, states: &states, angles: None };
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
    machine.loads[0].add(
        Situation { t: 0.0, mechanism: &machine, states: &states, angles: None },
        &mut wrenches,
    );
    assert!(wrenches.iter().all(|w| w.amax() < 1e-12));
}
