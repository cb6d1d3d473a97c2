//! What does not last in the recordings of a rig whose joints have clearance.

use super::found::{Event, events};
use super::series::FreedomSeries;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Stopped};
use crate::effects::Setting;

/// Events beside the effects of a model; `simulated` are noiseless recordings of that model, run by run, which say what
/// the look itself gets wrong.
///
/// # Errors
/// An effect that the machine cannot take.
pub fn beside(
    problem: &RigProblem,
    effects: &[Setting],
    simulated: &[Vec<Recording>],
) -> Result<Vec<Event>, Stopped> {
    let sensors = problem.declared.sensors.len();
    let mut all = Vec::new();
    for (run, simulated) in problem.runs.iter().zip(simulated) {
        let machine = machine(&problem.rig, effects, &run.recording)?;
        let name = &run.recording.name;
        let look = |view: &View| FreedomSeries::of(name, view, &machine, &problem.basis);
        let own: Option<Vec<FreedomSeries>> =
            simulated.iter().map(|recording| look(&View::new(recording, sensors))).collect();
        // Where the motion leads this model where it cannot be nothing is looked for.
        let (Some(series), Some(own)) = (look(&run.view), own) else { continue };
        all.push(series.without_bias(&own));
    }
    Ok(events(&all))
}
