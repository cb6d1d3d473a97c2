//! A model and the runs it is held against.

use crate::calibrate::measured::commands::{LEAD, LoggedCommands};
use crate::calibrate::measured::lens::Lens;
use crate::calibrate::measured::rattle;
use crate::calibrate::measured::replica::Simulator;
use crate::calibrate::measured::spectrum::{Signal, transform};
use crate::calibrate::measured::start::{SwingStart, as_seen};
use crate::effects::Setting;
use crate::engine::{Halt, StepControl};
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use crate::scenario::{Problem, Scenario, Sensors};
use crate::simulate::{close, driven};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Step in s by which simulations are counted: a position servo's damping leaves 125 µs to light legs, impacts
/// take more steps.
const USUAL_STEP: f64 = 1e-4;

/// A recorded run, ready to be explained.
#[derive(Debug)]
pub struct LegsRun {
    /// The log.
    pub log: Log,
    /// What models say of it.
    pub lens: Lens,
    /// Its commands.
    pub commands: Arc<LoggedCommands>,
    pose: Vector3<f64>,
}

impl LegsRun {
    /// Prepares a log that has commands, lengths, forces and pose; or the missing channel.
    pub fn new(log: Log) -> Result<Self, Channel> {
        let commands = Arc::new(LoggedCommands::new(&log, 3)?);
        let missing = Channel::all(3).into_iter().find(|c| log.get(*c).is_none());
        if let Some(channel) = missing {
            return Err(channel);
        }
        let lens = Lens::new(&log).ok_or(Channel::Pose(0))?;
        let first = |k| log.get(Channel::Pose(k)).map_or(0.0, |values| values[0]);
        let pose = Vector3::new(first(0), first(1), first(2));
        Ok(Self { lens, commands, pose, log })
    }

    /// The machine of a scenario with these effects, driven by this run's commands, to be looked at.
    pub fn machine(&self, rig: &Scenario, effects: &[Setting]) -> Result<Mechanism, Problem> {
        let mut scenario = rig.clone();
        scenario.effects = effects.to_vec();
        driven(&scenario, self.pose, Arc::clone(&self.commands) as _, -LEAD)
    }

    /// The machine of a scenario with these effects as this run begins, let go.
    ///
    /// # Errors
    /// An effect that the machine cannot take, commands that no pose meets.
    pub fn released(&self, rig: &Scenario, effects: &[Setting]) -> Result<Mechanism, Problem> {
        released(rig, self.pose, &self.commands, effects)
    }

    /// Rows that residuals can be had of.
    pub fn rows(&self) -> Range<usize> {
        self.lens.rows()
    }
}

/// The machine of a rig with these effects as recordings begin: at rest, journals centred, lengths as
/// first commanded, near `pose` (m, m, rad).
///
/// # Errors
/// An effect that the machine cannot take, commands that no pose meets.
pub fn released(
    rig: &Scenario,
    pose: Vector3<f64>,
    commands: &Arc<LoggedCommands>,
    effects: &[Setting],
) -> Result<Mechanism, Problem> {
    let mut scenario = rig.clone();
    scenario.effects = effects.to_vec();
    let mut machine = driven(&scenario, pose, Arc::clone(commands) as _, -LEAD)?;
    close(rig, &mut machine)?;
    Ok(machine)
}

/// More replicas of each run.
fn extend(logs: &mut [Vec<Log>], more: Vec<Vec<Log>>) {
    logs.iter_mut().zip(more).for_each(|(logs, more)| logs.extend(more));
}

/// Why a search cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum SearchError {
    /// The rig cannot be simulated as declared.
    #[error("{0}")]
    Model(#[from] Problem),
    /// A simulation broke down.
    #[error("{0}")]
    Halted(#[from] Halt),
}

/// A stretch of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LegsSegment {
    /// Which run.
    pub run: usize,
    /// Which of its rows.
    pub rows: Range<usize>,
}

/// A rig, its recorded runs, and how to simulate them.
#[derive(Debug)]
pub struct LegsCase {
    /// What its maker declares.
    pub rig: Scenario,
    /// What was recorded.
    pub runs: Vec<LegsRun>,
    /// What its machines are simulated with.
    pub simulator: Simulator,
    /// Whether the declared machine's joints rattle: replicas then differ by more than sensors see.
    pub chaotic: bool,
}

/// Simulations of a model.
pub(super) struct Ensemble {
    /// How each run's machine starts.
    pub starts: Vec<SwingStart>,
    /// Noiseless logs: `[run][replica]`.
    pub logs: Vec<Vec<Log>>,
    /// Noiseless logs of each run's machine without a swing.
    pub still: Arc<Vec<Log>>,
    /// Whether replicas differ by more than sensors see; there is one of each run if not.
    pub rattles: bool,
}

/// What saves time in simulating a model.
#[derive(Clone, Copy, Default)]
pub(super) struct Known<'a> {
    /// The starts of a model like it.
    pub starts: Option<&'a [SwingStart]>,
    /// The logs of the same model without a swing at values nearby, and whether its joints rattle.
    pub still: Option<(&'a Arc<Vec<Log>>, bool)>,
}

impl LegsCase {
    /// A rig and its recorded runs; whether its joints rattle is for the caller to find out.
    pub fn new(rig: Scenario, sensors: Sensors, runs: Vec<LegsRun>, control: StepControl) -> Self {
        Self { rig, runs, simulator: Simulator::new(sensors, control), chaotic: false }
    }

    /// Simulations of each run that a floor and a bias of the declared machine are taken from.
    pub fn replicas(&self) -> usize {
        if self.chaotic { rattle::REPLICAS } else { 1 }
    }

    /// Simulations so far, in runs of the mean length of the recorded ones with their lead, in steps of 0.1 ms.
    pub fn simulated(&self) -> f64 {
        let time = |run: &LegsRun| LEAD + (run.log.samples - 1) as f64 * run.log.interval;
        let recorded: f64 = self.runs.iter().map(time).sum();
        self.simulator.steps() as f64 * USUAL_STEP / recorded * self.runs.len() as f64
    }

    /// Coefficients of the residuals of a log under a mechanism.
    pub(super) fn coefficients(
        &self,
        lens: &Lens,
        mechanism: &Mechanism,
        segment: &LegsSegment,
    ) -> Vec<Vec<f64>> {
        let interval = self.runs[segment.run].log.interval * lens.stride() as f64;
        transform(&lens.residuals(mechanism, segment.rows.clone()), interval)
    }

    /// Noiseless logs of a model with these effects, so many of each run where its joints rattle. What the
    /// declared machine does says little of it: a tether may keep joints loaded that rattle without.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub(super) fn ensemble(
        &self,
        effects: &[Setting],
        count: usize,
        known: Known,
    ) -> Result<Ensemble, SearchError> {
        let replicas = 2..count as u64;
        let still = |starts: &[SwingStart]| {
            let machines: Vec<Mechanism> = starts.iter().map(|start| start.still.clone()).collect();
            let logs = self.logs(&machines, 0..1)?;
            Ok::<_, Halt>(Arc::new(logs.into_iter().flatten().collect::<Vec<Log>>()))
        };
        if self.chaotic {
            let machines = self.released(effects)?;
            let mut logs = self.logs(&machines, 0..2)?;
            if self.differ(&logs) {
                extend(&mut logs, self.logs(&machines, replicas)?);
                let start = |machine| SwingStart::let_go(&self.simulator, machine);
                let starts: Vec<SwingStart> =
                    machines.into_par_iter().map(start).collect::<Result<_, _>>()?;
                let still = match known.still {
                    Some((logs, true)) => Arc::clone(logs),
                    _ => still(&starts)?,
                };
                return Ok(Ensemble { still, starts, logs, rattles: true });
            }
        }
        let starts = self.starts(effects, known)?;
        let machines: Vec<Mechanism> = starts.iter().map(|start| start.machine.clone()).collect();
        let mut logs = self.logs(&machines, 0..1)?;
        let mut quiet =
            known.still.map_or_else(|| still(&starts), |(logs, _)| Ok(Arc::clone(logs)))?;
        // What is missing may rattle a machine that stays loaded as declared, if only a little: replicas
        // that soon are of one phase no more are as far from each other as from the recording.
        let lasts = |(logs, still): (&Vec<Log>, &Log)| {
            rattle::swing_lasts(&logs[0], still, &self.simulator.sensors)
        };
        let suspect = !self.chaotic && logs.iter().zip(quiet.iter()).any(lasts);
        if suspect {
            extend(&mut logs, self.logs(&machines, 1..2)?);
        }
        let rattles = suspect && self.differ(&logs);
        if rattles {
            extend(&mut logs, self.logs(&machines, replicas)?);
        } else {
            logs.iter_mut().for_each(|logs| logs.truncate(1));
        }
        if known.still.is_some_and(|(_, rattled)| rattled != rattles) {
            quiet = still(&starts)?;
        }
        Ok(Ensemble { starts, logs, still: quiet, rattles })
    }

    /// Whether the first two replicas of a run differ by more than sensors see.
    fn differ(&self, logs: &[Vec<Log>]) -> bool {
        let seen =
            |logs: &Vec<Log>| rattle::difference(&logs[0], &logs[1], &self.simulator.sensors).1;
        logs.iter().map(seen).fold(0.0, f64::max) > rattle::SEEN
    }

    /// Noiseless logs of a model, these replicas of each run.
    pub(super) fn logs(
        &self,
        machines: &[Mechanism],
        replicas: Range<u64>,
    ) -> Result<Vec<Vec<Log>>, Halt> {
        let count = replicas.end.saturating_sub(replicas.start) as usize;
        let jobs: Vec<(usize, u64)> = (0..self.runs.len())
            .flat_map(|run| replicas.clone().map(move |replica| (run, replica)))
            .collect();
        let logs: Result<Vec<Log>, Halt> = jobs
            .into_par_iter()
            .map(|(run, replica)| {
                self.simulator.record(&machines[run], &self.runs[run].log, replica)
            })
            .collect();
        let mut logs = logs?.into_iter();
        Ok(self.runs.iter().map(|_| logs.by_ref().take(count).collect()).collect())
    }

    /// The machine of each run, with these effects, let go.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn released(&self, effects: &[Setting]) -> Result<Vec<Mechanism>, Problem> {
        self.runs.iter().map(|run| run.released(&self.rig, effects)).collect()
    }

    /// How each run's machine with these effects starts where joints stay loaded: as its log shows, which
    /// is soon found from those that are known.
    fn starts(&self, effects: &[Setting], known: Known) -> Result<Vec<SwingStart>, SearchError> {
        let machines = self.released(effects)?.into_par_iter().zip(&self.runs).enumerate();
        let start = |(i, (machine, run)): (usize, (Mechanism, &LegsRun))| {
            let like = known.starts.map(|starts| &starts[i]);
            let same = known.still.is_some();
            as_seen(&self.simulator, machine, &run.log, like, same)
        };
        Ok(machines.map(start).collect::<Result<_, Halt>>()?)
    }

    /// Residuals of the data on a segment as they are, with the measured lengths of the legs.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn plain(
        &self,
        effects: &[Setting],
        segment: &LegsSegment,
    ) -> Result<(Vec<Signal>, [Vec<f64>; 3]), Problem> {
        let run = &self.runs[segment.run];
        let machine = run.machine(&self.rig, effects)?;
        let lengths = [0, 1, 2].map(|i| {
            let whole = run.log.get(Channel::Length(i)).unwrap_or_default();
            whole[segment.rows.clone()].iter().step_by(run.lens.stride()).copied().collect()
        });
        Ok((run.lens.residuals(&machine, segment.rows.clone()), lengths))
    }
}
