//! What ways of stepping have in common.

use super::adaptive::Adaptive;
use super::fixed::Fixed;
use super::run::Stepper;
use super::world::World;
use crate::contact::{Clearance, CoulombFriction, HertzStep};
use crate::mechanism::motion::Circle;
use crate::mechanism::three_rpr::{Geometry, InverseKinematics, LegBars, build};
use crate::mechanism::{Bearing, BodyState, Drive, Mechanism};
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::sync::Arc;

/// The paper's machine with friction, upright, so that joints hit, slide and stay loaded.
fn machine(drive: Drive) -> Mechanism {
    let motion =
        Circle { center: Vector2::zeros(), radius: 0.05, period: 1.0, phase: 0.0, phi: PI / 6.0 };
    let kinematics = InverseKinematics {
        geometry: Geometry { base_side: 0.66, platform_side: 0.1 },
        motion: Arc::new(motion),
    };
    let law = HertzStep { stiffness: 3.7e9, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
    let bearing = Bearing::Clearance(Clearance {
        bearing_radius: 0.01,
        journal_radius: 0.0095,
        law: Arc::new(law),
        friction: Some(CoulombFriction { coefficient: 0.1, velocity: 1e-3 }),
    });
    let bars = LegBars { density: 2270.0, cylinder: [0.2, 0.02], rod: [0.2, 0.012] };
    let joints = std::array::from_fn(|_| bearing.clone());
    build(kinematics, (0.2, 1.7e-4), bars, joints, drive, Vector2::new(0.0, -9.81))
}

/// States after 0.1 s, the number of steps, and how many steps saw a contact.
fn go(stepper: &mut dyn Stepper, mechanism: &Mechanism) -> (Vec<BodyState>, usize, usize) {
    let (mut t, mut steps, mut touching) = (0.0, 0, 0);
    while t < 0.1 {
        stepper.synchronise(mechanism, t);
        let contacts = &stepper.evaluation().contacts;
        touching += usize::from(contacts.iter().any(|contact| contact.normal_force > 0.0));
        t = stepper.advance(mechanism, t, 0.1);
        steps += 1;
    }
    stepper.synchronise(mechanism, t);
    (stepper.states().to_vec(), steps, touching)
}

#[test]
fn colliders_do_not_show_in_the_trajectory() {
    for drive in [Drive::Prescribed, Drive::Servo { stiffness: 5e5, damping: 300.0 }] {
        let mechanism = machine(drive);
        let crowded = || World::new(&mechanism, true);
        assert!((0..6).all(|joint| crowded().colliders.pair(joint).is_some()));

        let mut fixed = [(); 2].map(|()| Fixed::new(&mechanism, 1e-5));
        fixed[1].world = crowded();
        let [without, with] = fixed.each_mut().map(|stepper| go(stepper, &mechanism));
        assert!(without.2 > 1000, "{drive:?}: contact in {} steps only", without.2);
        assert_eq!(without, with, "{drive:?}, fixed step");

        let mut adaptive = [(); 2].map(|()| Adaptive::new(&mechanism, 1e-5));
        adaptive[1].world = crowded();
        let [without, with] = adaptive.each_mut().map(|stepper| go(stepper, &mechanism));
        assert!(without.2 > 100, "{drive:?}: contact in {} steps only", without.2);
        assert_eq!(without, with, "{drive:?}, error control");
    }
}
