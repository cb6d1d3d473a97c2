//! A rig and the runs that it is held against.

use super::kept::KeptStarts;
use super::residual::{Residuals, residuals};
use super::responses::Responses;
use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::motion::motions::{Motions, Poses};
use crate::calibrate::sensed::motion::released::Released;
use crate::calibrate::sensed::motion::start::{StartError, machine};
use crate::calibrate::sensed::motion::swinging::{OutputKicks, kicks_as_seen};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::calibrate::sensed::thresholds;
use crate::calibrate::values::spectrum::transform;
use crate::effects::Setting;
use crate::engine::{Halt, StepControl};
use crate::measure::log::LogError;
use crate::mechanism::Mechanism;
use crate::scenario::{Problem as Wrong, Scenario};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A recorded run, ready to be explained.
#[derive(Debug)]
pub struct Run {
    /// What was recorded.
    pub recording: Recording,
    /// The same, prepared.
    pub view: View,
}

/// Where a run of a model begins.
#[derive(Clone, Debug)]
pub struct Start {
    /// Which run.
    pub(super) run: usize,
    /// The machine as it was let go.
    pub(super) released: Released,
    /// Effects that it has.
    pub(super) effects: Vec<Setting>,
    /// The same without a swing; none of one that is held at the first row.
    pub(super) still: Option<Mechanism>,
}

impl Start {
    /// The machine there.
    pub fn machine(&self) -> &Mechanism {
        &self.released.machine
    }

    /// Coordinates in m or rad from which a machine that nothing holds is let go.
    pub fn coordinates(&self) -> &[f64] {
        &self.released.coordinates
    }

    /// Steps of bodies that it took to find them.
    pub fn steps(&self) -> u64 {
        self.released.steps
    }

    /// Whether it was fitted to the recording's first rows: nothing held the machine there.
    pub fn is_fitted(&self) -> bool {
        self.released.is_fitted()
    }
}

/// A stretch of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Which run.
    pub run: usize,
    /// Which of its rows.
    pub rows: Range<usize>,
}

/// Which data values are fitted on, and which candidates are judged on.
#[derive(Clone, Debug)]
pub struct Split {
    /// Fitted on.
    pub on: Vec<Segment>,
    /// Judged on.
    pub hold: Vec<Segment>,
}

/// A rig, its recorded runs, and how to simulate them.
#[derive(Debug)]
pub struct RigProblem {
    /// What its maker declares.
    pub rig: Scenario,
    /// The machine as declared.
    pub declared: Mechanism,
    /// What was recorded.
    pub runs: Vec<Run>,
    /// The sensors that determine its pose.
    pub basis: Basis,
    /// How to step.
    pub control: StepControl,
    /// Simulations that a mean is taken of: one, or several where joints rattle.
    pub replicas: usize,
    pub(super) simulations: AtomicUsize,
    /// Rows of all of them.
    pub(super) rows: AtomicU64,
    pub(super) work: AtomicU64,
    /// Steps of bodies in a run of the declared machine; 0 where nobody knows them.
    pub(super) declared_steps: AtomicU64,
    motions: Motions,
    pub(in crate::calibrate::sensed) responses: Responses,
    /// Run by run, what makes a machine that rests swing as was recorded, where it does not as it is let go.
    kicks: Mutex<Vec<Option<OutputKicks>>>,
    /// Machines as they were let go.
    pub(super) kept: Mutex<KeptStarts>,
}

/// Why a method cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum Stopped {
    /// The rig cannot be simulated as declared.
    #[error("{0}")]
    Model(#[from] Wrong),
    /// A simulation broke down.
    #[error("{0}")]
    Halted(#[from] Halt),
    /// Columns are not what their heads say.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Mistaken(Vec<LogError>),
}

impl From<StartError> for Stopped {
    fn from(error: StartError) -> Self {
        match error {
            StartError::Model(wrong) => wrong.into(),
            StartError::Halted(halt) => halt.into(),
        }
    }
}

impl RigProblem {
    /// A rig and its recordings.
    ///
    /// # Errors
    /// A rig that cannot be put together, or whose sensors do not say how it stands.
    pub fn new(
        rig: Scenario,
        recordings: Vec<Recording>,
        control: StepControl,
    ) -> Result<Self, Stopped> {
        let declared = machine(&rig, &[], &recordings[0])?;
        let basis = Basis::of(&declared, &recordings[0]).ok_or_else(|| {
            let message = "do not say how the machine stands: fewer joints, angles of bodies and points in x and y \
                           are measured than it has freedoms";
            let help = "add a [[sensor]] of quantity \"position\" or \"angle\" for each freedom";
            rig.problem("sensor", message, help)
        })?;
        let sensors = declared.sensors.len();
        let run = |recording: Recording| {
            let view = View::new(&recording, sensors);
            Run { recording, view }
        };
        let runs: Vec<Run> = recordings.into_iter().map(run).collect();
        let kicks = Mutex::new(vec![None; runs.len()]);
        let (simulations, rows, work, motions, responses) = Default::default();
        let problem = Self {
            rig,
            declared,
            runs,
            basis,
            control,
            replicas: 1,
            simulations,
            rows,
            work,
            declared_steps: AtomicU64::new(0),
            motions,
            responses,
            kicks,
            kept: Mutex::default(),
        };
        if problem.names().is_some_and(|names| names.is_empty()) {
            let message = "say nothing that a model could get wrong: how the machine moves, and nothing beside it";
            let help = "record an effort, an acceleration or a redundant position as well";
            return Err(problem.rig.problem("sensor", message.to_owned(), help).into());
        }
        Ok(problem)
    }

    /// The first run to fit on and the others to judge on; the halves of one where there is one alone.
    pub fn split(&self) -> Split {
        let whole = |run: usize| Segment { run, rows: self.runs[run].view.rows() };
        if self.runs.len() > 1 {
            let hold = (1..self.runs.len()).map(whole).collect();
            return Split { on: vec![whole(0)], hold };
        }
        let rows = self.runs[0].view.rows();
        let stride = self.runs[0].view.stride;
        let middle = rows.start + rows.len() / 2 / stride * stride;
        let part = |rows| vec![Segment { run: 0, rows }];
        Split { on: part(rows.start..middle), hold: part(middle..rows.end) }
    }

    /// Simulations so far.
    pub fn simulations(&self) -> usize {
        self.simulations.load(Ordering::Relaxed)
    }

    /// As many simulations of a whole run as theirs come to, of which many go no further than a moment.
    pub fn whole_runs(&self) -> u64 {
        let all: usize = self.runs.iter().map(|run| run.recording.samples).sum();
        self.rows.load(Ordering::Relaxed) * self.runs.len() as u64 / all.max(1) as u64
    }

    /// Steps of bodies in them: what a calibration takes its time for, on any machine and whatever the number of threads.
    pub fn work(&self) -> u64 {
        self.work.load(Ordering::Relaxed)
    }

    /// Steps of bodies that are left before nothing further is begun.
    pub fn left(&self) -> u64 {
        thresholds::WORK.saturating_sub(self.work())
    }

    /// Whether they are so many that nothing further is begun.
    pub fn is_worn_out(&self) -> bool {
        self.left() == 0
    }

    /// Where these runs of a model with these effects begin, with a swing and without one.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn starts(&self, effects: &[Setting], runs: &[usize]) -> Result<Vec<Start>, Stopped> {
        let start = |run: usize| -> Result<Start, Stopped> {
            let released = self.released(effects, run)?;
            let still = released.still(self.control)?;
            Ok(Start { run, released, effects: effects.to_vec(), still })
        };
        runs.par_iter().copied().map(start).collect()
    }

    /// Knows from now on how the machine swings where each run begins, as seen by a model with these effects; whether
    /// somewhere it does so otherwise than it is let go.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn see_swing(&self, effects: &[Setting]) -> Result<bool, Stopped> {
        self.forget_swing();
        let seen = |run: usize| -> Result<Option<OutputKicks>, Stopped> {
            let released = self.released(effects, run)?;
            let Some(still) = released.still(self.control)? else { return Ok(None) };
            let recording = &self.runs[run].recording;
            let record = |machine: &Mechanism, like: &Recording| self.record(machine, like, 0);
            Ok(kicks_as_seen(&released.machine, &still, recording, &record)?)
        };
        let seen = (0..self.runs.len()).into_par_iter().map(seen).collect::<Result<Vec<_>, _>>()?;
        let some = seen.iter().any(Option::is_some);
        *self.kicks() = seen;
        Ok(some)
    }

    /// Knows nothing of that any more.
    pub fn forget_swing(&self) {
        self.kicks().fill(None);
    }

    pub(super) fn kicks(&self) -> MutexGuard<'_, Vec<Option<OutputKicks>>> {
        self.kicks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Residuals of a view of run `segment.run` under a mechanism.
    pub fn residuals(
        &self,
        view: &View,
        mechanism: &Mechanism,
        segment: &Segment,
    ) -> Option<Residuals> {
        residuals(view, mechanism, &self.basis, segment.rows.clone(), &self.motions)
    }

    /// The motion of a mechanism that a view of run `segment.run` shows; none where it leads the machine where it cannot be.
    pub fn poses(&self, view: &View, mechanism: &Mechanism, segment: &Segment) -> Option<Poses> {
        self.motions.of(view, mechanism, &self.basis, segment.rows.clone())
    }

    /// Names of the residuals.
    pub fn names(&self) -> Option<Vec<super::residual::Name>> {
        let view = &self.runs.first()?.view;
        let rows = view.rows().start..view.rows().start + 1;
        Some(residuals(view, &self.declared, &self.basis, rows, &self.motions)?.names)
    }

    /// Their coefficients by frequency.
    pub fn coefficients(
        &self,
        view: &View,
        mechanism: &Mechanism,
        segment: &Segment,
    ) -> Option<Vec<Vec<f64>>> {
        let found = self.residuals(view, mechanism, segment)?;
        let finite = found.signals.iter().flat_map(|s| &s.values).all(|value| value.is_finite());
        finite.then(|| transform(&found.signals, view.interval * view.stride as f64))
    }
}

#[cfg(test)]
impl RigProblem {
    /// The problem after as many simulations as it may take.
    pub fn worn_out(self) -> Self {
        self.work.store(thresholds::WORK, Ordering::Relaxed);
        self
    }

    /// The problem with this recording in place of all.
    pub fn recorded_as(self, recording: Recording) -> Self {
        Self::new(self.rig, vec![recording], self.control).unwrap()
    }

    /// One of the `planar-…` rigs with its first recording.
    pub fn planar(name: &str) -> Self {
        Self::planar_run(name, "run-a.csv")
    }

    /// The same with another one.
    pub fn planar_run(name: &str, run: &str) -> Self {
        Self::of(&format!("rigs-planar/{name}"), run)
    }

    /// A rig among the assets with one of its recordings.
    pub fn of(folder: &str, run: &str) -> Self {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = root.join("assets").join(folder);
        let rig = Scenario::load(Some(&folder.join("rig.toml")), &[]).unwrap();
        let sensors = crate::model::parts_of(&rig).unwrap().sensors;
        let recording = Recording::read(&folder.join(run), &sensors, false).unwrap();
        Self::new(rig, vec![recording], StepControl::Tolerance(1e-5)).unwrap()
    }
}
