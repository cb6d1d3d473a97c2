//! What ways of stepping have in common.

use super::control::StepControl;
use super::physics::world::World;
use super::run::{Schedule, run_balanced, run_without_wear};
use super::stepping::adaptive::Adaptive;
use super::stepping::fixed::FixedSteps;
use super::stepping::stepper::Stepper;
use crate::mechanism::{BodyState, Mechanism};
use crate::model::assemble;
use crate::scenario::Scenario;
use std::ops::ControlFlow::Continue;
use std::sync::atomic::AtomicBool;

/// The paper's machine with friction, upright, so that joints hit, slide and stay loaded.
fn machine(drive: &str) -> Mechanism {
    let sets = ["joints.friction=0.1", "environment.gravity=[0,-9.81]", drive].map(str::to_owned);
    let scenario = Scenario::load(None, &sets).expect("right");
    assemble(&scenario).expect("put together").mechanism
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
    for drive in ["drive.mode=prescribed", "drive.mode=servo"] {
        let mechanism = machine(drive);
        let crowded = || World::new(&mechanism, true);
        assert!((0..6).all(|joint| crowded().colliders.pair(joint).is_some()));

        let mut fixed = [(); 2].map(|()| FixedSteps::new(&mechanism, 1e-5, None));
        fixed[1].world = crowded();
        let [without, with] = fixed.each_mut().map(|stepper| go(stepper, &mechanism));
        assert!(without.2 > 1000, "{drive:?}: contact in {} steps only", without.2);
        assert_eq!(without, with, "{drive:?}, fixed step");

        let mut adaptive = [(); 2].map(|()| Adaptive::new(&mechanism, 1e-5, None));
        adaptive[1].world = crowded();
        let [without, with] = adaptive.each_mut().map(|stepper| go(stepper, &mechanism));
        assert!(without.2 > 100, "{drive:?}: contact in {} steps only", without.2);
        assert_eq!(without, with, "{drive:?}, error control");
    }
}

/// What is not counted changes nothing of what is.
#[test]
fn wear_that_is_not_counted_changes_no_figure() {
    let mechanism = machine("drive.mode=servo");
    let schedule = Schedule { duration: 0.05, interval: 1e-3 };
    for control in [StepControl::Direct(1e-5), StepControl::Tolerance(1e-5)] {
        let [counted, without] = [run_balanced, run_without_wear].map(|run| {
            let mut rows = Vec::new();
            let work =
                run(&mechanism, control, schedule, &AtomicBool::new(false), &mut |instant| {
                    rows.push((instant.states.to_vec(), instant.tallies.to_vec()));
                    Continue(())
                });
            (rows, work.expect("runs to its end"))
        });
        assert_eq!(counted.0, without.0, "{control:?}");
        assert_eq!(format!("{:?}", counted.1.energy), format!("{:?}", without.1.energy));
        let rubbed = counted.1.rubbed.expect("counted");
        assert!(rubbed.iter().flatten().sum::<f64>() > 0.0, "{control:?}");
        assert!(without.1.rubbed.is_none(), "{control:?}");
    }
}
