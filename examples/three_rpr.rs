//! The built-in 3-RPR machine from Rust: scenario → mechanism → run, with and without clearance.
//!
//! Look at the path error, which is of the size of the clearance, and at the actuator force: in the
//! mean that of the ideal machine, in its peaks up to a hundred times as much. The last line names a
//! picture of the first actuator's force.
//!
//! `cargo run --release --example three_rpr`

use freeplay::engine::run;
use freeplay::report::{Curve, Panel, Style, panels_svg};
use freeplay::scenario::Scenario;
use freeplay::simulate::assemble;
use std::error::Error;

const CLEARANCE: f64 = 5e-4; // m

fn main() -> Result<(), Box<dyn Error>> {
    // Any key of a scenario file can be set; what is not set is as in assets/default.toml.
    let set = |law: &str| {
        [
            format!("contact.law={law}"),
            format!("joints.clearance={CLEARANCE:e}"),
            "simulation.duration=0.5".to_owned(),
        ]
    };
    let loose = simulate(&set("hertz-step"))?;
    let tight = simulate(&set("ideal"))?;

    println!(
        "largest path error {:9.3} µm, without clearance {:.1e} µm",
        loose.path_error * 1e6,
        tight.path_error * 1e6
    );
    println!("largest F₁         {:9.3} N,  without clearance {:.3} N", loose.peak, tight.peak);
    println!("mean F₁            {:9.3} N,  without clearance {:.3} N", loose.mean, tight.mean);
    assert!((1.0..6.0).contains(&(loose.path_error / CLEARANCE)), "of the size of the clearance");
    assert!(tight.path_error < 1e-9, "the ideal machine follows its path");
    assert!(loose.peak > 10.0 * tight.peak, "the actuator feels the hits");
    assert!((loose.mean - tight.mean).abs() < 0.1 * tight.peak, "hits do no lasting work");

    let line = |name: &str, points, style| Curve { name: name.to_owned(), points, style };
    let svg = panels_svg(&[Panel {
        title: "force of actuator 1".to_owned(),
        x_label: "time (s)".into(),
        y_label: "force (N)".into(),
        curves: vec![
            line("c = 0.5 mm", loose.force, Style::Solid),
            line("without clearance", tight.force, Style::Reference),
        ],
    }])?;
    let file = std::env::temp_dir().join("freeplay-three-rpr.svg");
    std::fs::write(&file, svg)?;
    println!("drawn: {}", file.display());
    Ok(())
}

/// What one run came to.
struct Outcome {
    /// Largest distance from the ideal path in m.
    path_error: f64,
    /// Largest |F₁| and mean F₁ in N.
    peak: f64,
    mean: f64,
    /// (t, F₁) of each row, in s and N.
    force: Vec<(f64, f64)>,
}

fn simulate(sets: &[String]) -> Result<Outcome, Box<dyn Error>> {
    let scenario = Scenario::load(None, sets)?;
    let mut machine = assemble(&scenario)?;
    let (mechanism, ideal) = (&machine.mechanism, &mut machine.ideal);
    let mut outcome = Outcome { path_error: 0.0, peak: 0.0, mean: 0.0, force: Vec::new() };
    println!(
        "{:>7} {:>9} {:>9} {:>11} {:>9} {:>11}",
        "t (s)", "x (mm)", "y (mm)", "error (µm)", "F₁ (N)", "ideal (N)"
    );
    // Rows arrive one by one: nothing is kept but what is kept here.
    run(mechanism, machine.control, machine.schedule, &mut |instant| {
        let (now, ideal) = (instant.evaluation, ideal.at(instant.t));
        let position = instant.states[mechanism.output].position;
        let error = (position - ideal.position).norm();
        outcome.path_error = outcome.path_error.max(error);
        outcome.peak = outcome.peak.max(instant.peaks.drive_force);
        outcome.force.push((instant.t, now.drive_forces[0]));
        let row = outcome.force.len() - 1;
        if row.is_multiple_of(100) {
            println!(
                "{:7.3} {:9.3} {:9.3} {:11.3} {:9.3} {:11.3}",
                instant.t,
                position.x * 1e3,
                position.y * 1e3,
                error * 1e6,
                now.drive_forces[0],
                ideal.drive_forces[0]
            );
        }
    })?;
    outcome.mean =
        outcome.force.iter().map(|(_, force)| force).sum::<f64>() / outcome.force.len() as f64;
    Ok(outcome)
}
