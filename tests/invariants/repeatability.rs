//! A run repeated is the same run, and it is so whatever rows are asked for.

use crate::STEP;
use crate::common::{Case, SERVO};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::Mechanism;

/// Every number of every row, bit by bit.
fn rows(mechanism: &Mechanism, control: StepControl, interval: f64) -> Vec<Vec<u64>> {
    let mut rows = Vec::new();
    let schedule = Schedule { duration: 0.05, interval };
    run(mechanism, control, schedule, &mut |instant: &Instant| {
        let Instant { t, states, evaluation, tallies, .. } = instant;
        let mut row = Vec::new();
        let mut push = |value: f64| row.push(value.to_bits());
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
            push(tally.contact_time);
            push(tally.energy);
            push(tally.impacts as f64);
        }
        // Last, because they belong to a row and not to its instant: the largest forces since the row before.
        tallies.iter().for_each(|tally| push(tally.peak));
        rows.push(row);
    })
    .unwrap();
    rows
}

#[test]
fn runs_repeat_bit_by_bit() {
    for case in [Case::default(), Case { gravity: -9.81, friction: 0.1, ..Case::default() }] {
        let mechanism = case.mechanism();
        let bits = |mechanism: &Mechanism| rows(mechanism, StepControl::Fixed(STEP), 1e-4);
        let first = bits(&mechanism);
        assert!(first == bits(&mechanism), "{case:?}: the same mechanism moved differently");
        assert!(first == bits(&case.mechanism()), "{case:?}: built again, it moved differently");
        println!("{case:?}: {} rows equal to the bit, three times", first.len());
    }
}

/// Row times were multiples of the interval as rounding makes them, steps what divided the time from one row to the
/// next, and under error control they ended at rows: other intervals had other last bits, which chaos makes other
/// motions of.
#[test]
fn rows_at_common_instants_are_the_same_whatever_the_interval() {
    let servo = Case { drive: SERVO, ..Case::default() };
    for (case, control) in [
        (Case::default(), StepControl::Fixed(1e-5)),
        (Case::default(), StepControl::Fixed(2e-6)),
        (servo, StepControl::Fixed(1e-5)),
        (Case::default(), StepControl::Tolerance(1e-5)),
        (servo, StepControl::Tolerance(1e-5)),
        (Case::default(), StepControl::Direct(1e-5)),
        (servo, StepControl::Direct(1e-5)),
    ] {
        let mechanism = case.mechanism();
        let peaks = mechanism.revolutes.len();
        let at = |interval: f64, every: usize| -> Vec<Vec<u64>> {
            let kept = rows(&mechanism, control, interval).into_iter().step_by(every);
            kept.map(|row| row[..row.len() - peaks].to_vec()).collect()
        };
        let coarse = at(5e-3, 1);
        for (interval, every) in [(1e-3, 5), (5e-4, 10), (2e-4, 25), (1e-4, 50), (1e-5, 500)] {
            assert!(
                at(interval, every) == coarse,
                "{case:?}, {control:?}: rows each {interval} s moved it"
            );
        }
        assert_eq!(coarse.len(), 11);
    }
}
