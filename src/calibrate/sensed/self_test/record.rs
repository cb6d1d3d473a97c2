//! A trial's rig, and recordings of the machine that it declares with something hidden in it.

use super::Trial;
use super::hidden::Hidden;
use super::motion::like;
use super::rig::rig;
use crate::calibrate::record::clean;
use crate::calibrate::results::result::control;
use crate::calibrate::sensed::motion::simulate::with_noise;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Stopped};
use crate::effects::Setting;
use crate::engine::StepControl;
use crate::mechanism::{Mechanism, Sensor};
use crate::model::parts_of;
use crate::scenario::Scenario;

/// A rig and what its runs are recorded like.
pub(super) struct TrialBench {
    /// What its maker declares.
    pub rig: Scenario,
    /// The machine as declared at the first row of a run.
    pub declared: Mechanism,
    control: StepControl,
    likes: [Recording; 2],
    seed: u64,
}

impl TrialBench {
    /// The bench of a trial.
    ///
    /// # Errors
    /// A rig that cannot be put together.
    pub fn new(trial: &Trial) -> Result<Self, Stopped> {
        let rig = rig(trial)?;
        let parts = parts_of(&rig)?;
        let likes = [0, 1].map(|run| like(trial, &parts, run));
        let declared = machine(&rig, &[], &likes[0])?;
        Ok(Self { control: control(&rig), rig, declared, likes, seed: trial.seed })
    }

    /// What sensors without noise show of run `run` with these effects, so many replicas.
    ///
    /// # Errors
    /// Effects that the machine cannot take, a run that broke down.
    pub fn clean(
        &self,
        effects: &[Setting],
        run: usize,
        replicas: u64,
    ) -> Result<Vec<Recording>, Stopped> {
        let like = &self.likes[run];
        // What falls is let go where the first row says; nothing else of it is known yet.
        let first = if self.declared.actuators.is_empty() {
            like.first(like.interval)
        } else {
            like.clone()
        };
        clean((&self.rig, effects), &first, like, self.control, replicas)
    }

    /// The recording of run `run` that a clean one comes to by the noise of these sensors.
    pub fn noisy(&self, clean: &Recording, sensors: &[Sensor], run: usize) -> Recording {
        with_noise(clean, sensors, (self.seed << 1) + run as u64)
    }

    /// A problem of these recordings.
    ///
    /// # Errors
    /// Sensors that do not say how the machine stands.
    pub fn of(&self, recordings: Vec<Recording>) -> Result<RigProblem, Stopped> {
        RigProblem::new(self.rig.clone(), recordings, self.control)
    }

    /// What a user would calibrate: both runs with what is hidden.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn problem(&self, hidden: &Hidden) -> Result<RigProblem, Stopped> {
        let recorded = |run: usize| {
            let clean = self.clean(&hidden.effects, run, 1)?;
            Ok::<_, Stopped>(self.noisy(&clean[0], &hidden.sensors, run))
        };
        self.of(vec![recorded(0)?, recorded(1)?])
    }
}
