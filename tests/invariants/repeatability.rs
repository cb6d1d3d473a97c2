//! A run repeated is the same run.

use crate::STEP;
use crate::common::Case;
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;

/// Every number of every row, bit by bit.
fn bits(mechanism: &Mechanism) -> Vec<u64> {
    let mut bits = Vec::new();
    let schedule = Schedule { duration: 0.05, interval: 1e-4 };
    run(mechanism, StepControl::Fixed(STEP), schedule, &mut |instant: &Instant| {
        let Instant { t, states, evaluation, tallies, .. } = instant;
        let mut push = |value: f64| bits.push(value.to_bits());
        push(*t);
        for state in *states {
            state.position.iter().chain(&state.twist).for_each(|v| push(*v));
            push(state.rotation.re);
            push(state.rotation.im);
        }
        evaluation
            .accelerations
            .iter()
            .chain(&evaluation.wrenches)
            .flatten()
            .for_each(|v| push(*v));
        evaluation.lengths.iter().chain(&evaluation.drive_forces).for_each(|v| push(*v));
        for (contact, tally) in evaluation.contacts.iter().zip(*tallies) {
            contact.eccentricity.iter().for_each(|v| push(*v));
            push(contact.penetration);
            push(contact.normal_force);
            push(contact.friction_force);
            push(tally.peak);
            push(tally.contact_time);
        }
    })
    .unwrap();
    bits
}

#[test]
fn runs_repeat_bit_by_bit() {
    for case in [Case::default(), Case { gravity: -9.81, friction: 0.1, ..Case::default() }] {
        let mechanism = case.mechanism();
        let first = bits(&mechanism);
        assert!(first == bits(&mechanism), "{case:?}: the same mechanism moved differently");
        assert!(first == bits(&case.mechanism()), "{case:?}: built again, it moved differently");
        println!("{case:?}: {} numbers equal to the bit, three times", first.len());
    }
}
