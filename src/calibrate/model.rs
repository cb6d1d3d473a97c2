//! A model and the runs it is held against.

use super::commands::LoggedCommands;
use super::lens::Lens;
use super::replica;
use super::spectrum::{Noise, Signal, transform};
use super::start::{Start, as_seen};
use crate::effects::Setting;
use crate::engine::{Halt, StepControl};
use crate::measure::log::{Channel, Log};
use crate::mechanism::Mechanism;
use crate::scenario::{Problem, Scenario, Sensors};
use crate::simulate::{close, driven};
use nalgebra::{DVector, Vector3};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Time in s for which the machine was held at its first command before a log begins.
pub const LEAD: f64 = 0.25;

/// A recorded run, ready to be explained.
#[derive(Debug)]
pub struct Run {
    /// The log.
    pub log: Log,
    /// What models say of it.
    pub lens: Lens,
    /// Its commands.
    pub commands: Arc<LoggedCommands>,
    pose: Vector3<f64>,
}

impl Run {
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
pub struct Segment {
    /// Which run.
    pub run: usize,
    /// Which of its rows.
    pub rows: Range<usize>,
}

/// A rig, its recorded runs, and how to simulate them.
#[derive(Debug)]
pub struct Case {
    /// What its maker declares.
    pub rig: Scenario,
    /// Its instruments.
    pub sensors: Sensors,
    /// What was recorded.
    pub runs: Vec<Run>,
    /// How to step simulations.
    pub control: StepControl,
    /// Simulations of each run that a floor and a bias are taken from.
    pub replicas: usize,
    /// Whether joints rattle: replicas then differ by more than sensors see.
    pub chaotic: bool,
}

/// What simulations of a model say of its own residuals: their mean, which is the lens's fault, and
/// their spread, which is noise.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// One per segment.
    parts: Vec<Part>,
    /// How each run's machine starts.
    pub starts: Vec<Start>,
}

#[derive(Clone, Debug)]
struct Part {
    segment: Segment,
    bias: Vec<Vec<f64>>,
    noise: Noise,
    /// What of the residual is the platform's swing, where joints stay loaded.
    swing: Option<Vec<Vec<f64>>>,
}

/// Draws of sensor noise from which a covariance is taken.
const DRAWS: usize = 16;

/// Share of a platform's swing that a model may be wrong by before its values are settled: a frequency
/// that is off by a thousandth has lost the phase after some seconds.
const SWING: f64 = 0.3;

impl Case {
    /// Coefficients of the residuals of a log under a mechanism.
    fn coefficients(&self, lens: &Lens, mechanism: &Mechanism, segment: &Segment) -> Vec<Vec<f64>> {
        let interval = self.runs[segment.run].log.interval * lens.stride() as f64;
        transform(&lens.residuals(mechanism, segment.rows.clone()), interval)
    }

    /// Noiseless logs of a model with these effects: `[run][replica]`, to predict with. A search compares
    /// models by the same few replicas; a prediction is better for being the mean of more, and where
    /// joints stay loaded for the best start that a log shows.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn simulate(&self, effects: &[Setting]) -> Result<Vec<Vec<Log>>, SearchError> {
        let starts = self.starts(effects, None)?;
        let machines: Vec<Mechanism> = starts.into_iter().map(|start| start.machine).collect();
        let count = if self.chaotic { 2 } else { 1 } * self.replicas;
        Ok(self.replicas(&machines, count)?)
    }

    /// Noiseless logs of a model, so many of each run.
    fn replicas(&self, machines: &[Mechanism], count: usize) -> Result<Vec<Vec<Log>>, Halt> {
        let jobs: Vec<(usize, u64)> = (0..self.runs.len())
            .flat_map(|run| (0..count as u64).map(move |replica| (run, replica)))
            .collect();
        let logs: Result<Vec<Log>, Halt> = jobs
            .into_par_iter()
            .map(|(run, replica)| {
                let log = &self.runs[run].log;
                replica::simulate(&machines[run], &self.sensors, self.control, log, replica)
            })
            .collect();
        let mut logs = logs?.into_iter();
        Ok(self.runs.iter().map(|_| logs.by_ref().take(count).collect()).collect())
    }

    /// Simulations that a baseline takes, at most.
    pub fn simulations(&self) -> usize {
        self.runs.len() * if self.chaotic { self.replicas } else { self.replicas + 1 }
    }

    /// The machine of each run, with these effects, let go.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn released(&self, effects: &[Setting]) -> Result<Vec<Mechanism>, Problem> {
        self.runs.iter().map(|run| run.released(&self.rig, effects)).collect()
    }

    /// How each run's machine with these effects starts: as let go where joints rattle, else as its log
    /// shows, which is soon found from those of a model that is `like` this one.
    fn starts(
        &self,
        effects: &[Setting],
        like: Option<&Baseline>,
    ) -> Result<Vec<Start>, SearchError> {
        let machines = self.released(effects)?.into_par_iter().zip(&self.runs).enumerate();
        let start = |(i, (machine, run)): (usize, (Mechanism, &Run))| {
            if self.chaotic {
                return Ok(Start::let_go(machine));
            }
            as_seen(
                machine,
                &run.log,
                &self.sensors,
                self.control,
                like.map(|like| &like.starts[i]),
            )
        };
        Ok(machines.map(start).collect::<Result<_, Halt>>()?)
    }

    /// The baseline of a model with these effects, from simulations of it.
    ///
    /// Where joints stay loaded the platform swings in their play, and a lens's fault is to see that
    /// swing: what the same machine does without a swing tells where. Start and swing of a model that is
    /// `like` this one save time.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn baseline(
        &self,
        effects: &[Setting],
        segments: &[Segment],
        like: Option<&Baseline>,
    ) -> Result<Baseline, SearchError> {
        let starts = self.starts(effects, like)?;
        let machines: Vec<Mechanism> = starts.iter().map(|start| start.machine.clone()).collect();
        let logs = self.replicas(&machines, self.replicas)?;
        // The swing of a kicked start is not that of a release.
        let kicked = |starts: &[Start]| -> Vec<bool> {
            starts.iter().map(|start| start.kicks.is_some()).collect()
        };
        let like = like.filter(|like| kicked(&like.starts) == kicked(&starts));
        let still = if self.chaotic || like.is_some() {
            Vec::new()
        } else {
            let still: Vec<Mechanism> = starts.iter().map(|start| start.still.clone()).collect();
            self.replicas(&still, 1)?
        };
        let part = |segment: &Segment| {
            let machine = &machines[segment.run];
            let look = |log: &Log| {
                let lens = Lens::new(log).expect("the channels of the recorded log");
                self.coefficients(&lens, machine, segment)
            };
            let logs = &logs[segment.run];
            let clean: Vec<Vec<Vec<f64>>> = logs.par_iter().map(look).collect();
            let bias = mean(&clean);
            // A replica stands for the data, the mean of the others for the bias: sensor noise, the
            // rattle of one run, and what is left of it in a mean.
            let draws: Vec<Vec<Vec<f64>>> = (0..DRAWS)
                .into_par_iter()
                .map(|draw| {
                    let index = draw % clean.len();
                    let log = replica::with_noise(&logs[index], &self.sensors, draw as u64 + 1000);
                    difference(&look(&log), &without(&bias, &clean[index], clean.len()))
                })
                .collect();
            let seen = still.get(segment.run).map(|logs| {
                let mut swing = difference(&clean[0], &look(&logs[0]));
                swing.iter_mut().flatten().for_each(|value| *value *= SWING);
                swing
            });
            let known = || like?.parts.iter().find(|part| part.segment == *segment)?.swing.clone();
            let swing = seen.or_else(known);
            let noise = Noise::from_draws(&draws, swing.as_deref());
            Part { segment: segment.clone(), bias, noise, swing }
        };
        let parts = segments.iter().map(part).collect();
        Ok(Baseline { parts, starts })
    }

    /// Residuals of the data on a segment as they are, with the measured lengths of the legs.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn plain(
        &self,
        effects: &[Setting],
        segment: &Segment,
    ) -> Result<(Vec<Signal>, [Vec<f64>; 3]), Problem> {
        let run = &self.runs[segment.run];
        let machine = run.machine(&self.rig, effects)?;
        let lengths = [0, 1, 2].map(|i| {
            let whole = run.log.get(Channel::Length(i)).unwrap_or_default();
            whole[segment.rows.clone()].iter().step_by(run.lens.stride()).copied().collect()
        });
        Ok((run.lens.residuals(&machine, segment.rows.clone()), lengths))
    }

    /// Residuals of the data under a model in units of noise, of all segments in a row.
    pub fn white(
        &self,
        baseline: &Baseline,
        effects: &[Setting],
        segments: &[Segment],
    ) -> Result<DVector<f64>, Problem> {
        let mut all = Vec::new();
        for part in baseline.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let run = &self.runs[part.segment.run];
            let machine = run.machine(&self.rig, effects)?;
            let mut coefficients = self.coefficients(&run.lens, &machine, &part.segment);
            for (values, bias) in coefficients.iter_mut().zip(&part.bias) {
                for (value, bias) in values.iter_mut().zip(bias) {
                    *value -= bias;
                }
            }
            all.extend(part.noise.whiten(&coefficients).iter());
        }
        Ok(DVector::from_vec(all))
    }
}

impl Baseline {
    /// Logarithm of the determinant of the noise on segments.
    pub fn log_determinant(&self, on: &[Segment]) -> f64 {
        let parts = self.parts.iter().filter(|part| on.contains(&part.segment));
        parts.map(|part| part.noise.log_determinant()).sum()
    }

    /// Channel (servo, closure, dynamics of each leg) and frequency in Hz of each number of
    /// [`Case::white`] for these segments.
    pub fn places(&self, case: &Case, segments: &[Segment]) -> Vec<(usize, f64)> {
        let parts = self.parts.iter().filter(|part| segments.contains(&part.segment));
        parts
            .flat_map(|part| {
                let rows = part.segment.rows.len() as f64;
                let step = 0.5 / (rows * case.runs[part.segment.run].log.interval);
                part.noise.places().into_iter().map(move |(c, k)| (c, k as f64 * step))
            })
            .collect()
    }
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let channels = a.iter().zip(b);
    channels.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect()
}

/// The mean of `count` draws with one of them left out, if that leaves any.
fn without(mean: &[Vec<f64>], own: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    if count < 2 {
        return own.to_vec();
    }
    let part = 1.0 / count as f64;
    let left = |(all, own): (&f64, &f64)| (all - part * own) / (1.0 - part);
    let channels = mean.iter().zip(own);
    channels.map(|(all, own)| all.iter().zip(own).map(left).collect()).collect()
}

fn mean(draws: &[Vec<Vec<f64>>]) -> Vec<Vec<f64>> {
    let mut sum = draws[0].clone();
    for draw in &draws[1..] {
        for (sum, values) in sum.iter_mut().zip(draw) {
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += value;
            }
        }
    }
    for value in sum.iter_mut().flatten() {
        *value /= draws.len() as f64;
    }
    sum
}
