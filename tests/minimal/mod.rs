//! The solver in minimal coordinates that the benches race against, as a second opinion where no
//! reference curve exists: other start phases, friction, other clearances.

#[path = "../../benches/minimal_coordinates/mod.rs"]
#[allow(dead_code)] // each test or bench reads what it needs of a sample
mod minimal_coordinates;

use minimal_coordinates::simulate;

use crate::common::Case;
use freeplay::mechanism::Drive;
use minimal_coordinates::Machine;

/// The same case for that solver.
pub fn machine(case: &Case) -> Machine {
    Machine {
        clearance: case.clearance,
        drive: match case.drive {
            Drive::Prescribed => minimal_coordinates::Drive::Prescribed,
            Drive::Servo { .. } => minimal_coordinates::Drive::Servo,
            Drive::Sampled(_) | Drive::Effort => unreachable!("no case has such a drive"),
        },
        gravity: [0.0, case.gravity],
        friction: case.friction,
        phase: case.phase,
        ..Machine::default()
    }
}

/// Platform positions (m) at the given times (s), and how often the equations of motion were asked.
pub fn positions(case: &Case, tolerance: f64, times: &[f64]) -> (Vec<[f64; 2]>, u64) {
    let mut rows = Vec::with_capacity(times.len());
    let machine = machine(case);
    let work = simulate(&machine, tolerance, times, |sample| rows.push([sample.x, sample.y]));
    (rows, work.evaluations)
}
