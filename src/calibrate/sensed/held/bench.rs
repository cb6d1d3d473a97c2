//! A machine that sampled controllers hold, its recordings, and what is left of its efforts along the measured motion.

use super::terms::{HeldTerm, is_sought};
use crate::calibrate::sensed::intake::noise;
use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::motion::motions::Motions;
use crate::calibrate::sensed::motion::simulate;
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::{View, output_sensor, position_sensor};
use crate::calibrate::sensed::residuals::residual::{ResidualKind, residuals};
use crate::calibrate::sensed::thresholds::{OUTPUT_FILTER, OUTPUT_TRIM, RATE};
use crate::effects::Setting;
use crate::engine::{Halt, StepControl};
use crate::measure::filter::{ZeroPhase, derivative};
use crate::mechanism::{Bearing, Drive, JointIndex, Mechanism};
use crate::scenario::{Problem, Scenario};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Whether a machine is calibrated so: nothing rattles in it, and sampled controllers whose outputs are recorded hold it.
pub fn suits(mechanism: &Mechanism) -> bool {
    let ideal = mechanism.revolutes.iter().all(|joint| matches!(joint.bearing, Bearing::Ideal));
    let mut drives = mechanism.actuators.iter().enumerate();
    let held = drives.all(|(index, drive)| {
        matches!(drive.drive, Drive::Sampled(_)) && output_sensor(mechanism, index).is_some()
    });
    ideal && held && !mechanism.actuators.is_empty()
}

/// A machine and its recordings.
#[derive(Debug)]
pub struct HeldBench {
    /// What its file says, with those of its effects whose values are not sought.
    pub rig: Scenario,
    /// The others, as declared.
    pub declared: Vec<Setting>,
    /// The machine without what is sought.
    pub machine: Mechanism,
    /// What was recorded.
    pub runs: Vec<HeldRun>,
    /// How to step.
    pub control: StepControl,
    /// Sensors of the outputs of joints, and the size of each in N or N·m: its root mean square in the first run.
    outputs: Vec<(usize, f64)>,
    basis: Basis,
    /// Whether drives give at once what they are asked for, as published models have it.
    at_once: bool,
    simulations: AtomicUsize,
}

/// A recorded run.
#[derive(Debug)]
pub struct HeldRun {
    /// What was recorded.
    pub recording: Recording,
    view: View,
    motions: Motions,
    filter: ZeroPhase,
    /// What was asked of drives, in their sizes.
    asked: Vec<f64>,
    /// What the machine without what is sought leaves of it.
    left: Vec<f64>,
    columns: Mutex<HashMap<String, Arc<Vec<f64>>>>,
}

impl HeldBench {
    /// A rig, declared or calibrated, and recordings of it; `at_once` where drives are to give at once what they are
    /// asked for.
    ///
    /// # Errors
    /// A rig that cannot be put together, recordings that do not say how it moved or what was asked of its drives.
    pub fn new(
        rig: &Scenario,
        recordings: Vec<Recording>,
        control: StepControl,
        at_once: bool,
    ) -> Result<Self, Problem> {
        let mut plain = rig.clone();
        let (declared, fixed): (Vec<_>, Vec<_>) = plain.effects.into_iter().partition(is_sought);
        plain.effects = fixed;
        let built = machine(&plain, &[], &recordings[0])?;
        let help = "add a [[sensor]] of quantity \"position\" for each freedom, and one of quantity \"output\" for \
                    each drive";
        let unknown = || {
            let message = "do not say how the machine moved and what was asked of its drives";
            rig.problem("sensor", message, help)
        };
        let basis = Basis::of(&built, &recordings[0]).ok_or_else(unknown)?;
        let mut outputs = Vec::new();
        for &joint in &basis.joints {
            let drive = built.actuators.iter().position(|drive| drive.joint == joint);
            let sensor = drive.and_then(|drive| output_sensor(&built, drive));
            let recorded = |sensor: &usize| recordings.iter().all(|r| r.get(*sensor).is_some());
            outputs.push((sensor.filter(recorded).ok_or_else(unknown)?, 1.0));
        }
        let runs =
            recordings.into_iter().map(|recording| HeldRun::new(recording, &built)).collect();
        let simulations = AtomicUsize::new(0);
        let machine = built;
        let mut bench = Self {
            rig: plain,
            declared,
            machine,
            runs,
            control,
            outputs,
            basis,
            at_once,
            simulations,
        };
        bench.prepare()?;
        Ok(bench)
    }

    /// Sizes of outputs, and what the machine leaves of them.
    fn prepare(&mut self) -> Result<(), Problem> {
        for k in 0..self.outputs.len() {
            let (sensor, _) = self.outputs[k];
            let filtered = self.runs[0].filtered(sensor);
            let squares: f64 = filtered.iter().map(|value| value * value).sum();
            let size = (squares / filtered.len().max(1) as f64).sqrt();
            self.outputs[k].1 = size.max(f64::MIN_POSITIVE);
        }
        for index in 0..self.runs.len() {
            let run = &self.runs[index];
            let asked: Vec<Vec<f64>> =
                self.outputs.iter().map(|(sensor, _)| run.filtered(*sensor)).collect();
            let asked = self.in_sizes(run, &asked);
            let left = self.look(run, &[]).ok_or_else(|| {
                let message = format!("cannot move as {} says", run.recording.path);
                let help = "is this a recording of this machine?";
                self.rig.problem("mechanism", message, help)
            })?;
            let run = &mut self.runs[index];
            (run.asked, run.left) = (asked, left);
        }
        Ok(())
    }

    /// Filtered samples joint by joint, at the rows that are looked at, in sizes: row after row, joint after joint.
    fn in_sizes(&self, run: &HeldRun, joints: &[Vec<f64>]) -> Vec<f64> {
        let of = |row: usize| {
            joints.iter().zip(&self.outputs).map(move |(values, (_, size))| values[row] / size)
        };
        run.rows().flat_map(of).collect()
    }

    /// What a machine with these effects leaves of what was asked of its drives along the measured motion; none where it
    /// cannot move so.
    fn look(&self, run: &HeldRun, effects: &[Setting]) -> Option<Vec<f64>> {
        let mut machine = machine(&self.rig, effects, &run.recording).ok()?;
        for drive in machine.actuators.iter_mut().filter(|_| self.at_once) {
            if let Drive::Sampled(cascade) = &mut drive.drive {
                (cascade.interval, cascade.lag) = (0.0, 0.0);
            }
        }
        let rows = 0..run.recording.samples;
        let found = residuals(&run.view, &machine, &self.basis, rows, &run.motions)?;
        let named = found.names.iter().zip(&found.signals);
        let dynamics = named.filter(|(name, _)| name.kind == ResidualKind::Dynamics);
        let filtered: Vec<Vec<f64>> =
            dynamics.map(|(_, signal)| run.filter.apply(&signal.values)).collect();
        let seen = self.in_sizes(run, &filtered);
        (filtered.len() == self.outputs.len() && seen.iter().all(|v| v.is_finite())).then_some(seen)
    }

    /// What a unit of a term takes of the efforts that are left of a run, which is linear in it; nothing where the
    /// machine cannot have it.
    pub fn column(&self, run: usize, term: &HeldTerm) -> Arc<Vec<f64>> {
        let run = &self.runs[run];
        let key = term.to_string();
        let kept = || run.columns.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(column) = kept().get(&key) {
            return Arc::clone(column);
        }
        let (effect, step) = term.small();
        let seen = self.look(run, &[effect]);
        let column = seen.map_or_else(
            || vec![0.0; run.left.len()],
            |seen| run.left.iter().zip(seen).map(|(left, seen)| (left - seen) / step).collect(),
        );
        let column = Arc::new(column);
        kept().insert(key, Arc::clone(&column));
        column
    }

    /// Looks at the columns of many terms in a run at once, to be asked for later.
    pub fn look_at(&self, run: usize, terms: &[HeldTerm]) {
        terms.par_iter().for_each(|term| drop(self.column(run, term)));
    }

    /// What was asked of the drives of a run, in sizes.
    pub fn asked(&self, run: usize) -> &[f64] {
        &self.runs[run].asked
    }

    /// What the machine without what is sought leaves of it.
    pub fn left(&self, run: usize) -> &[f64] {
        &self.runs[run].left
    }

    /// Size of the output of the first joint in N or N·m, and its sensor.
    pub fn first_output(&self) -> (usize, f64) {
        self.outputs[0]
    }

    /// All that is looked at of a run.
    pub fn rows(&self, run: usize) -> Range<usize> {
        0..self.runs[run].left.len()
    }

    /// Time in s of a place among what is looked at of a run, after the recording's first row.
    pub fn time(&self, run: usize, place: usize) -> f64 {
        let run = &self.runs[run];
        let row = run.rows().nth(place / self.outputs.len()).unwrap_or_default();
        row as f64 * run.recording.interval
    }

    /// Stretches of about `length` s of a run, side by side.
    pub fn stretches(&self, run: usize, length: f64) -> Vec<Range<usize>> {
        let (of, joints) = (&self.runs[run], self.outputs.len());
        let rows = of.left.len() / joints;
        let size =
            (length / (of.stride() as f64 * of.recording.interval)).round().max(1.0) as usize;
        let count = (rows / size).max(1);
        let edge = |k: usize| rows * k / count * joints;
        (0..count).map(|k| edge(k)..edge(k + 1)).collect()
    }

    /// The first and the second half of a run.
    pub fn halves(&self, run: usize) -> [Range<usize>; 2] {
        let joints = self.outputs.len();
        let rows = self.rows(run);
        let middle = rows.end / joints / 2 * joints;
        [0..middle, middle..rows.end]
    }

    /// What the machine would have recorded of a run with these effects beside those that stay.
    ///
    /// # Errors
    /// An effect that it cannot take, a run that broke down.
    pub fn simulated(&self, run: usize, effects: &[Setting]) -> Result<Recording, Broken> {
        let recording = &self.runs[run].recording;
        self.simulations.fetch_add(1, Ordering::Relaxed);
        let released = crate::calibrate::sensed::motion::released::released(
            &self.rig,
            effects,
            recording,
            self.control,
        )?;
        Ok(simulate::record(&released.machine, self.control, recording, 0)?)
    }

    /// The machine with the noise that its sensors show in a run.
    pub fn sensing(&self, run: usize) -> Mechanism {
        let mut machine = self.machine.clone();
        noise::measured(&mut machine.sensors, &self.runs[run].recording);
        machine
    }

    /// Simulations so far.
    pub fn simulations(&self) -> usize {
        self.simulations.load(Ordering::Relaxed)
    }

    /// What a simulation misses of what was asked of the drives of a run, in sizes.
    pub fn missed(&self, run: usize, simulated: &Recording) -> Vec<f64> {
        let of = &self.runs[run];
        let filtered = |(sensor, _): &(usize, f64)| {
            let pair = of.recording.get(*sensor).zip(simulated.get(*sensor));
            let less = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a - b).collect();
            of.filter.apply(&pair.map_or_else(Vec::new, less))
        };
        let joints: Vec<Vec<f64>> = self.outputs.iter().map(filtered).collect();
        self.in_sizes(of, &joints)
    }

    /// Root mean square rate in m/s or rad/s of a joint in the first run; none where nobody measured it.
    pub fn rate(&self, joint: JointIndex) -> Option<f64> {
        let run = &self.runs[0];
        let position = run.view.smooth(position_sensor(&self.machine, joint)?)?;
        let rates = derivative(position, run.recording.interval);
        let squares: f64 = rates.iter().map(|rate| rate * rate).sum();
        Some((squares / rates.len().max(1) as f64).sqrt()).filter(|rate| *rate > 0.0)
    }
}

impl HeldRun {
    fn new(recording: Recording, machine: &Mechanism) -> Self {
        let (order, corner) = OUTPUT_FILTER;
        let filter = ZeroPhase::butterworth(order, corner, recording.interval);
        // Outputs pass one filter, with what the machine makes of the motion.
        let corners = [f64::INFINITY, corner, corner];
        let view = View::through(&recording, machine.sensors.len(), corners, f64::INFINITY);
        let (asked, left) = (Vec::new(), Vec::new());
        let columns = Mutex::default();
        Self { recording, view, motions: Motions::default(), filter, asked, left, columns }
    }

    fn filtered(&self, sensor: usize) -> Vec<f64> {
        self.filter.apply(self.recording.get(sensor).unwrap_or_default())
    }

    /// One row in so many holds all that the filter passes.
    fn stride(&self) -> usize {
        (1.0 / (RATE * self.recording.interval)).floor().max(1.0) as usize
    }

    /// The rows that are looked at: all but the ends.
    fn rows(&self) -> std::iter::StepBy<Range<usize>> {
        let samples = self.recording.samples;
        let trim = ((OUTPUT_TRIM / self.recording.interval).round() as usize).min(samples / 2);
        (trim..samples - trim).step_by(self.stride())
    }
}

/// Why a machine cannot be simulated.
#[derive(Debug, thiserror::Error)]
pub enum Broken {
    /// Its start.
    #[error(transparent)]
    Start(#[from] crate::calibrate::sensed::motion::start::StartError),
    /// What follows.
    #[error(transparent)]
    Halted(#[from] Halt),
}
