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
