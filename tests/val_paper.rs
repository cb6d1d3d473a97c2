//! The numbers of `freeplay paper` against the statistics of an independent solver
//! (`assets/reference/statistics.csv`), at every clearance that the two share, compared as its README
//! says: 32 start phases of 2.2 s, differences in units of the standard errors of both.

mod common;

use common::Curve;
use freeplay::scenario::Source;
use freeplay::study::Watch;
use freeplay::study::paper::{CLEARANCES, Item, case, scenarios};

const PHASES: usize = 32;

const COLUMNS: [(&str, Item); 6] = [
    ("rms_accel_deviation_m_s2", Item::AccelerationDeviation),
    ("peak_contact_force_N", Item::PeakContactForce),
    ("contact_fraction", Item::ContactFraction),
    ("rms_path_error_m", Item::PathError),
    ("rms_actuator_force_deviation_N", Item::ActuatorDeviation),
    ("peak_actuator_force_N", Item::PeakActuatorForce),
];

#[test]
fn statistics_of_the_study_are_those_of_the_independent_solver() {
    let source = Source::read(None).unwrap();
    let sets = ["simulation.duration=2.2".to_owned()];
    let (_, assumed) = scenarios(&source, &sets, PHASES).unwrap().swap_remove(0);
    let table = Curve::read("statistics.csv");
    let (gravity, clearances) = (table.column("gravity_y"), table.column("c_m"));
    let (mut cells, mut outside) = (0, Vec::new());
    for clearance in CLEARANCES {
        let row = (0..clearances.len())
            .find(|&i| gravity[i] == 0.0 && clearances[i] == clearance)
            .expect("every clearance of the study is in the table");
        let case = case(&assumed, clearance, PHASES, &Watch::new(1.0, true, &mut |_| {})).unwrap();
        assert_eq!(case.halted, 0);
        for (name, item) in COLUMNS {
            let (expected, expected_sem) =
                (table.column(name)[row], table.column(&format!("{name}_sem"))[row]);
            let mean = case.mean(item);
            let off = (mean.mean - expected).abs() / mean.sem.hypot(expected_sem);
            println!(
                "{clearance:e} m, {name:<32} {:.5e} ± {:.1e}, expected {expected:.5e} ± \
                 {expected_sem:.1e}: {off:.2}",
                mean.mean, mean.sem
            );
            assert!(off <= 5.0, "{name} at {clearance:e} m: {off:.2} standard errors");
            cells += 1;
            if off > 3.0 {
                outside.push((name, clearance, off));
            }
        }
    }
    // Of the table's 96 cells two may lie outside: of these fewer cells, none.
    assert!(outside.len() <= 2 * cells / 96, "{outside:?}");
}
