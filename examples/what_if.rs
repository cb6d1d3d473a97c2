//! What if the joints were tighter, or rubbed? Clearance and friction of the built-in machine varied
//! over all cores, one row a run. (`freeplay sweep` does the same from the command line, with a table
//! that survives interruptions.)
//!
//! Look at the path error, which is of the size of the clearance whatever the friction, and at the
//! forces: without friction they come down to the ideal machine's as the clearance closes. Friction
//! calms a loose machine, and shakes a tight one: journals that would roll and slide stick and slip.
//!
//! `cargo run --release --example what_if`

use freeplay::engine::run;
use freeplay::scenario::Scenario;
use freeplay::simulate::{Recorder, Summary, assemble};
use rayon::prelude::*;
use std::error::Error;

const CLEARANCES: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6]; // m
const FRICTIONS: [f64; 2] = [0.0, 0.1];

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let cases: Vec<[f64; 2]> =
        FRICTIONS.iter().flat_map(|mu| CLEARANCES.map(|clearance| [clearance, *mu])).collect();
    // Runs know nothing of each other, so the table does not depend on the number of threads.
    let summaries: Vec<Summary> =
        cases.par_iter().map(|case| simulate(*case)).collect::<Result<_, _>>()?;

    println!(
        "{:>6} {:>8} {:>15} {:>13} {:>13} {:>11} {:>11}",
        "c (m)",
        "friction",
        "path error (µm)",
        "joint (N)",
        "actuator (N)",
        "impacts/s",
        "in contact"
    );
    for ([clearance, friction], summary) in cases.iter().zip(&summaries) {
        println!(
            "{clearance:6.0e} {friction:8} {:15.2} {:13.2} {:13.2} {:11.0} {:11.2}",
            summary.rms_path_error_m * 1e6,
            summary.peak_contact_force,
            summary.peak_actuator_force,
            summary.impacts_per_s,
            summary.contact_fraction
        );
    }
    let ideal = summaries[0].ideal_peak_actuator_force;
    println!("without clearance the actuators take {ideal:.2} N");

    let (smooth, rubbing) = summaries.split_at(CLEARANCES.len());
    for runs in [smooth, rubbing] {
        for (clearance, run) in CLEARANCES.iter().zip(runs) {
            let error = run.rms_path_error_m / clearance;
            assert!((1.0..6.0).contains(&error), "an error of the size of the clearance");
        }
    }
    let forces =
        |runs: &[Summary]| -> Vec<f64> { runs.iter().map(|run| run.peak_contact_force).collect() };
    let (smooth, rubbing) = (forces(smooth), forces(rubbing));
    assert!(smooth.windows(2).all(|pair| pair[1] < pair[0]), "less play, less force");
    let [loose, tight] = [0, CLEARANCES.len() - 1].map(|i| rubbing[i] / smooth[i]);
    assert!(
        loose < 1.0 && tight > 1.0,
        "friction calms the loose machine and shakes the tight one"
    );
    Ok(())
}

fn simulate([clearance, friction]: [f64; 2]) -> Result<Summary, Box<dyn Error + Send + Sync>> {
    let scenario = Scenario::load(
        None,
        &[
            format!("joints.clearance={clearance:e}"),
            format!("joints.friction={friction}"),
            "simulation.duration=0.6".to_owned(),
        ],
    )?;
    let mut machine = assemble(&scenario)?;
    let (mechanism, ideal) = (&machine.mechanism, &mut machine.ideal);
    let mut recorder = Recorder::new(mechanism, scenario.simulation.settle());
    let work = run(mechanism, machine.control, machine.schedule, &mut |instant| {
        recorder.row(mechanism, instant, &ideal.at(instant.t));
    })?;
    Ok(recorder.finish(&scenario, &machine, &work, f64::NAN, None, Vec::new()))
}
