use super::*;
use crate::mechanism::{Actuator, Attachment, Body, Command, Commands};
use nalgebra::UnitComplex;
use std::sync::Arc;

#[derive(Debug)]
struct Constant;

impl Commands for Constant {
    fn at(&self, _t: f64, commands: &mut [Command]) {
        commands.fill(Command { position: 0.3, rate: 0.2, acceleration: 7.0 });
    }
}

/// Two bars in one line of motion whose centres of mass lie beside the axis.
fn bars(drive: Drive) -> Mechanism {
    let rotation = UnitComplex::new(0.7);
    let spin = 1.3;
    let at = Vector2::new(0.2, -0.03);
    let apart = rotation * at;
    let sliding = rotation * Vector2::new(0.2, 0.0);
    let turned = Vector2::new(-apart.y, apart.x) * spin;
    let body = |name: &str, mass, inertia, position: Vector2<f64>, v: Vector2<f64>| {
        let twist = Vector3::new(v.x, v.y, spin);
        Body::new(name, mass, inertia, BodyState { position, rotation, twist })
    };
    let attachment = |i, x| Attachment { body: Some(i), point: Vector2::new(x, 0.01) };
    let bodies = vec![
        body("cylinder", 0.14, 4e-4, Vector2::zeros(), Vector2::new(0.1, 0.3)),
        body("rod", 0.05, 2e-4, apart, Vector2::new(0.1, 0.3) + sliding + turned),
    ];
    Mechanism {
        prismatics: vec![Prismatic {
            name: "P1".into(),
            base: attachment(0, -0.1),
            slider: attachment(1, 0.1),
            axes: [UnitComplex::identity(); 2],
            play: false,
        }],
        actuators: vec![Actuator::new("P1", JointIndex::Prismatic(0), drive)],
        commands: Arc::new(Constant),
        gravity: Vector2::new(0.5, -9.81),
        ..Mechanism::free(bodies)
    }
}

/// The closed form of a telescope against the general rows of the same joint.
#[test]
fn telescope_and_rows_agree() {
    for drive in [Drive::Prescribed, Drive::Servo { stiffness: 1e3, damping: 10.0 }] {
        let mechanism = bars(drive);
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let mut closed = Dynamics::new(&mechanism);
        let mut general = closed.clone();
        assert_eq!(general.telescopes.len(), 1);
        general.telescopes.clear();
        (general.passive, general.unpaired) = (vec![0], vec![0, 1]);
        general.groups.push(JointGroup::new(vec![Rigid::Prismatic(0)]));
        let [a, b] = [&mut closed, &mut general].map(|dynamics| {
            let mut now = Evaluation::new(&mechanism);
            dynamics.forces(&mechanism, 0.0, &states, &mut now);
            now.wrenches[0] += Vector3::new(1.0, -2.0, 0.3);
            now.wrenches[1] += Vector3::new(-3.0, 0.5, -0.1);
            dynamics.accelerations(&mechanism, &states, &mut now);
            now
        });
        for (a, b) in a.accelerations.iter().zip(&b.accelerations) {
            assert!((a - b).norm() < 1e-10 * b.norm(), "{drive:?}: {a} {b}");
        }
        assert!((a.drive_forces[0] - b.drive_forces[0]).abs() < 1e-12, "{drive:?}");
    }
}

/// What pushes plain servos alone against what pushes drives of all kinds: the same to the last bit.
#[test]
fn plain_servos_push_as_any_drive_does() {
    let mechanism = bars(Drive::Servo { stiffness: 1e3, damping: 10.0 });
    let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
    let mut plain = Dynamics::new(&mechanism);
    assert_eq!(plain.servos.as_ref().map(Vec::len), Some(1));
    let mut any = Dynamics { servos: None, ..plain.clone() };
    let [a, b] = [&mut plain, &mut any].map(|dynamics| {
        let mut now = Evaluation::new(&mechanism);
        dynamics.forces(&mechanism, 0.0, &states, &mut now);
        dynamics.accelerations(&mechanism, &states, &mut now);
        now
    });
    assert!(a.drive_forces[0] != 0.0);
    assert_eq!(format!("{a:?}"), format!("{b:?}"));

    let mut pushed = mechanism;
    pushed.actuators[0].drive = Drive::Effort;
    assert!(Dynamics::new(&pushed).servos.is_none(), "no servo");
}

/// Bodies put to where the coordinates say are where these came from, move as they say, and go on as under the forces on
/// the bodies themselves.
#[test]
fn coordinates_and_bodies_agree() {
    for drive in [Drive::Prescribed, Drive::Servo { stiffness: 1e3, damping: 10.0 }] {
        let mut mechanism = bars(drive);
        // On the axis, and where the command has it.
        mechanism.prismatics[0].slider.point += Vector2::new(-0.1, 0.03);
        let start: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let mut dynamics = Dynamics::new(&mechanism);
        let mut now = Evaluation::new(&mechanism);
        dynamics.forces(&mechanism, 0.0, &start, &mut now);
        dynamics.accelerations(&mechanism, &start, &mut now);
        let count = if drive == Drive::Prescribed { 3 } else { 4 };
        assert_eq!(dynamics.coordinates(), count);
        let [mut rates, mut row] = [vec![0.0; count], vec![0.0; count]];
        dynamics.start(&start, &now.accelerations, &mut rates, &mut row);
        let mut at = |ways: &[f64]| {
            let (mut states, mut there) = (start.clone(), Evaluation::new(&mechanism));
            let to = (&mut states[..], &mut there);
            dynamics.place(&mechanism, 0.0, &start, [ways, &rates], to);
            let mut own = vec![0.0; count];
            dynamics.act(&mechanism, &states, &mut there, (&mut own, true));
            (states, there, own)
        };
        let (states, there, own) = at(&vec![0.0; count]);
        for i in 0..2 {
            assert!((states[i].position - start[i].position).norm() < 1e-15, "{drive:?}");
            assert!((states[i].twist - start[i].twist).norm() < 1e-14, "{drive:?}");
            let [a, b] = [there.accelerations[i], now.accelerations[i]];
            assert!((a - b).norm() < 1e-12 * b.norm(), "{drive:?}: {a} {b}");
        }
        for (a, b) in own.iter().zip(&row) {
            assert!((a - b).abs() < 1e-12 * b.abs().max(1.0), "{drive:?}: {own:?} {row:?}");
        }
        if drive == Drive::Prescribed {
            continue; // its length does not move at one instant
        }
        let ways: Vec<f64> = rates.iter().map(|rate| 1e-7 * rate).collect();
        for (i, state) in at(&ways).0.iter().enumerate() {
            let moved = (state.position - start[i].position) / 1e-7;
            assert!((moved - start[i].twist.xy()).norm() < 1e-6, "{moved} {}", start[i].twist);
        }
    }
}
