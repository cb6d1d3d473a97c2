//! What a calibration would see along one motion: residuals of the machine's sensors in units of noise.
//!
//! The machine is recorded along the motion as it is declared, clearances and sensor noise included; from this the
//! calibration's own [`Baseline`] takes what noise and rattle make of each residual. How another model differs is then a
//! look at a recording without noise: what its residuals are less those of the declared model.

use crate::calibrate::record::clean;
use crate::calibrate::sensed::baseline::Baseline;
use crate::calibrate::sensed::problem::{RigProblem, Segment, Stopped};
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::residual::Name;
use crate::calibrate::sensed::simulate::{record, with_noise};
use crate::calibrate::sensed::start::{LEAD, machine};
use crate::calibrate::sensed::view::View;
use crate::effects::Setting;
use crate::engine::StepControl;
use crate::mechanism::{Drive, Mechanism};
use crate::scenario::Scenario;
use nalgebra::DVector;

/// Noise of residuals on one motion.
#[derive(Debug)]
pub struct Sight {
    /// The rig, recorded along the motion.
    pub problem: RigProblem,
    /// Noise and rattle of its residuals.
    baseline: Baseline,
    segment: Segment,
    /// What the residuals are.
    pub names: Vec<Name>,
    /// Residual (by its place among the names) of each number of a look.
    places: Vec<usize>,
    /// The recording without noise.
    pub clean: Recording,
}

/// A recording without noise that models are held against.
#[derive(Debug)]
pub struct Seen {
    recording: Recording,
    view: View,
}

impl Seen {
    /// Prepares a recording.
    pub fn new(recording: Recording) -> Self {
        let view = View::new(&recording, recording.sensors());
        Self { recording, view }
    }

    /// What the machine without clearance shows along the commands of `like`, as it is declared.
    ///
    /// # Errors
    /// A machine that does not close there, a run that broke down.
    pub fn ideal(rig: &Scenario, like: &Recording, control: StepControl) -> Result<Self, Stopped> {
        let mut ideal = machine(rig, &[], like)?;
        let drives: Vec<Drive> = ideal.actuators.iter().map(|actuator| actuator.drive).collect();
        ideal = ideal.without_clearance();
        for (actuator, drive) in ideal.actuators.iter_mut().zip(drives) {
            actuator.drive = drive;
        }
        for body in &mut ideal.bodies {
            body.start.twist.fill(0.0);
        }
        ideal.epoch = -LEAD;
        Ok(Self::new(record(&ideal, control, like, 0)?))
    }
}

impl Sight {
    /// Records a rig along the commands of `like` and takes the noise of its residuals.
    ///
    /// # Errors
    /// A rig that cannot be simulated there, or whose sensors do not say how it stands.
    pub fn new(
        rig: &Scenario,
        like: &Recording,
        control: StepControl,
        seed: u64,
    ) -> Result<Self, Stopped> {
        let clean = clean((rig, &[]), like, like, control, 1)?.swap_remove(0);
        let sensors = machine(rig, &[], like)?.sensors;
        let noisy = with_noise(&clean, &sensors, seed);
        let mut problem = RigProblem::new(rig.clone(), vec![noisy], control)?;
        let logs = problem.simulated(&problem.let_go(&[])?, 2)?;
        problem.rattle(&logs);
        problem.lean_as_noise_allows(&logs);
        let segment = Segment { run: 0, rows: problem.runs[0].view.rows() };
        let segments = std::slice::from_ref(&segment);
        let baseline = Baseline::of(&problem, &[], &[], segments)?;
        let places = baseline.places(&problem, segments).into_iter().map(|(c, _)| c).collect();
        let names = problem.names().unwrap_or_default();
        Ok(Self { problem, baseline, segment, names, places, clean })
    }

    /// The machine as declared.
    pub fn declared(&self) -> &Mechanism {
        &self.problem.declared
    }

    /// The recording that it was made for, without noise.
    pub fn own(&self) -> Seen {
        Seen::new(self.clean.clone())
    }

    /// Residuals of a recording under a model with these effects in units of noise; none where such a machine cannot be.
    pub fn look(&self, seen: &Seen, effects: &[Setting]) -> Option<DVector<f64>> {
        let machine = machine(&self.problem.rig, effects, &seen.recording).ok()?;
        let coefficients = self.problem.coefficients(&seen.view, &machine, &self.segment)?;
        let white = self.baseline.whiten(&self.segment, &coefficients)?;
        white.iter().all(|value| value.is_finite()).then_some(white)
    }

    /// Share of the square of a difference of looks in each residual.
    pub fn shares(&self, difference: &DVector<f64>) -> Vec<f64> {
        let mut shares = vec![0.0; self.names.len()];
        for (value, place) in difference.iter().zip(&self.places) {
            shares[*place] += value * value;
        }
        let all = difference.norm_squared().max(f64::MIN_POSITIVE);
        shares.iter_mut().for_each(|share| *share /= all);
        shares
    }
}
