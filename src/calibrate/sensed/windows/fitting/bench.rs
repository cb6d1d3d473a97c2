//! A machine that nothing holds, its runs, and what is compared.

use super::inputs::{input_sensor, inputs};
use super::pose::{Coordinates, Pose};
use super::shooting::{Shooting, SoughtValue, WindowsFitted};
use super::window::{Shooter, Window, WindowStart, compared, cut};
use crate::calibrate::sensed::events::{Event, FreedomSeries, events};
use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::calibrate::sensed::thresholds::{OWN, ZERO};
use crate::effects::Setting;
use crate::mechanism::{Bearing, Command, Commands, Drive, Idle, JointIndex, Mechanism, Reads};
use crate::model::recorded;
use crate::scenario::{Problem, Scenario};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Whether a machine is calibrated by windows: nothing rattles in it, and no drive holds a coordinate.
pub fn suits(mechanism: &Mechanism) -> bool {
    let ideal = mechanism.revolutes.iter().all(|joint| matches!(joint.bearing, Bearing::Ideal));
    let loose = mechanism.actuators.iter().all(|drive| drive.drive == Drive::Effort);
    ideal && loose && !mechanism.bodies.is_empty()
}

/// A machine and its runs.
#[derive(Debug)]
pub struct Bench {
    /// What its file says, without effects.
    rig: Scenario,
    /// Effects that it declares.
    pub declared: Vec<Setting>,
    /// The machine as declared.
    pub mechanism: Mechanism,
    /// What was recorded.
    pub runs: Vec<Recording>,
    /// What it starts by.
    pub coordinates: Coordinates,
    /// Compared sensors.
    pub sensors: Vec<usize>,
    origin: WindowStart,
}

/// Length and step in s of the windows that a run's own zeros are taken from.
const OWN_WINDOWS: [f64; 2] = [0.3, 0.15];

impl Bench {
    /// A rig, declared or calibrated, and recordings of it.
    ///
    /// # Errors
    /// A rig that cannot be put together, sensors that do not say how it stands, drives of which nobody
    /// recorded what they gave.
    pub fn new(rig: &Scenario, runs: Vec<Recording>) -> Result<Self, Problem> {
        let mut plain = rig.clone();
        let declared = std::mem::take(&mut plain.effects);
        let mechanism = built(&plain, &declared)?;
        let wrong = |message: &str, help: &str| rig.problem("sensor", message, help);
        let coordinates = Coordinates::of(&mechanism).ok_or_else(|| {
            wrong("are not enough: bodies hang loose", "joints have to hold every body")
        })?;
        for (run, drive) in
            runs.iter().flat_map(|run| (0..mechanism.actuators.len()).map(move |d| (run, d)))
        {
            if input_sensor(&mechanism, run, drive).is_none() {
                let message = format!(
                    "of the force or command of {} have no column in {}",
                    mechanism.actuators[drive].name, run.path
                );
                let help = "nobody knows what that drive gave: record its force or its command";
                return Err(wrong(&message, help));
            }
        }
        let sensors = compared(&mechanism, &runs);
        let near = Pose::of(&mechanism);
        let mut values = coordinates.read(&mechanism, &near);
        values.resize(2 * values.len(), 0.0);
        let bench = Self {
            rig: plain,
            declared,
            mechanism,
            runs,
            coordinates,
            sensors,
            origin: WindowStart { values, near },
        };
        let zeros = vec![vec![0.0; bench.sensors.len()]; bench.runs.len()];
        let machines = bench.machines(&bench.declared);
        for (index, run) in bench.runs.iter().enumerate() {
            let windows = cut(index, run, &bench.sensors, [0.1, 0.1], [0.0, 0.3]);
            let started = machines.as_ref().and_then(|machines| {
                bench.starts(machines, &zeros, &windows[..windows.len().min(1)])
            });
            if bench.sensors.is_empty() || started.is_none() {
                return Err(wrong(
                    "do not say how the machine stands: fewer coordinates are measured than it has freedoms",
                    "add a [[sensor]] of quantity \"position\" or \"angle\" for each freedom",
                ));
            }
        }
        Ok(bench)
    }

    /// The machines of all runs with these effects; none where there is no such machine.
    pub fn machines(&self, effects: &[Setting]) -> Option<Vec<Mechanism>> {
        let lasting: Vec<Setting> =
            effects.iter().filter(|e| e.history().is_none()).cloned().collect();
        let common = built(&self.rig, &lasting).ok()?;
        let run = |run: &Recording| {
            let own = || effects.iter().filter(|e| e.acts_in(&run.name)).cloned();
            let machine = match lasting.len() == effects.len() {
                true => common.clone(),
                false => built(&self.rig, &own().collect::<Vec<_>>()).ok()?,
            };
            Some(Mechanism { commands: inputs(&machine, run)?, ..machine })
        };
        self.runs.iter().map(run).collect()
    }

    /// A shooter along a run.
    pub fn shooter<'a>(&'a self, mechanism: &'a Mechanism, zeros: &'a [f64]) -> Shooter<'a> {
        Shooter { mechanism, coordinates: &self.coordinates, sensors: &self.sensors, zeros }
    }

    /// First guesses of the starts of windows, in their order.
    pub fn starts(
        &self,
        machines: &[Mechanism],
        zeros: &[Vec<f64>],
        windows: &[Window],
    ) -> Option<Vec<WindowStart>> {
        let mut last = self.origin.clone();
        let mut starts = Vec::with_capacity(windows.len());
        for window in windows {
            let shooter = self.shooter(&machines[window.run], &zeros[window.run]);
            let guess = shooter.guess(window, &last);
            last = guess.or_else(|| shooter.guess(window, &self.origin))?;
            starts.push(last.clone());
        }
        Some(starts)
    }

    /// Efforts along a run that machines of all runs do not know of, where zeros are what sensors show too much in
    /// each; none where joints are not measured or the machine cannot be as it was.
    pub fn series(
        &self,
        machines: &[Mechanism],
        zeros: &[Vec<f64>],
        run: usize,
    ) -> Option<FreedomSeries> {
        let recording = &self.runs[run];
        let mut machine = machines[run].clone();
        let first = cut(run, recording, &self.sensors, [0.1, 0.1], [0.0, 0.3]);
        let start = self.starts(machines, zeros, &first[..first.len().min(1)])?.pop()?;
        for ((body, state), angle) in
            machine.bodies.iter_mut().zip(start.near.states).zip(start.near.angles)
        {
            (body.start, body.angle) = (state, angle);
        }
        for (sensor, zero) in self.sensors.iter().zip(&zeros[run]) {
            machine.sensors[*sensor].offset += zero;
        }
        let basis = Basis::of(&machine, recording)?;
        let view = View::new(recording, machine.sensors.len());
        FreedomSeries::of(&recording.name, &view, &machine, &basis)
    }

    /// What does not last in the runs; nothing in those of which efforts cannot be told.
    pub fn events(&self) -> Vec<Event> {
        let Some(machines) = self.machines(&self.declared) else { return Vec::new() };
        let Some(zeros) = self.own_zeros(&self.declared, &self.zeros_of_runs()) else {
            return Vec::new();
        };
        let plain = |run: &Vec<[f64; 2]>| run.iter().map(|[zero, _]| *zero).collect();
        let zeros: Vec<Vec<f64>> = zeros.iter().map(plain).collect();
        let series = (0..self.runs.len()).filter_map(|run| self.series(&machines, &zeros, run));
        events(&series.collect::<Vec<FreedomSeries>>())
    }

    /// Root mean square motion of each compared sensor about its mean over all runs.
    pub fn motion(&self) -> Vec<f64> {
        let of = |i: &usize| {
            let columns = || self.runs.iter().filter_map(|run| run.get(*i));
            let count = columns().map(<[f64]>::len).sum::<usize>().max(1) as f64;
            let squares: f64 = columns()
                .map(|column| {
                    let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
                    column.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
                })
                .sum();
            (squares / count).sqrt().max(f64::MIN_POSITIVE)
        };
        self.sensors.iter().map(of).collect()
    }

    /// Standard deviations of zeros of which nothing is known; 0 of sensors that have none.
    pub fn unknown_zeros(&self) -> Vec<f64> {
        let of = |i: &usize| match self.mechanism.sensors[*i].reads {
            Reads::Position(JointIndex::Revolute(_)) | Reads::Angle(..) => ZERO,
            Reads::Position(JointIndex::Prismatic(_)) => ZERO * self.mechanism.size(),
            _ => 0.0,
        };
        self.sensors.iter().map(of).collect()
    }

    /// How much the zero of each compared sensor differs from run to run, by the rig's effects.
    pub fn zeros_of_runs(&self) -> Vec<f64> {
        let of = |i: &usize| {
            let column = &self.mechanism.sensors[*i].column;
            let named = self.declared.iter().filter(|effect| {
                effect.kind.name == "encoder-zero" && effect.target.names().contains(column)
            });
            named.filter_map(|effect| effect.value("run_std")).fold(0.0, f64::hypot)
        };
        self.sensors.iter().map(of).collect()
    }

    /// Zeros of each run by its first seconds, and their standard deviations; those of a standard deviation 0 stay
    /// where they are.
    pub fn own_zeros(&self, effects: &[Setting], stds: &[f64]) -> Option<Vec<Vec<[f64; 2]>>> {
        let n = self.sensors.len();
        let none = vec![vec![[0.0; 2]; n]; self.runs.len()];
        if stds.iter().all(|std| *std == 0.0) {
            return Some(none);
        }
        let windows: Vec<Window> = self
            .runs
            .iter()
            .enumerate()
            .flat_map(|(i, run)| cut(i, run, &self.sensors, OWN_WINDOWS, [0.0, OWN]))
            .collect();
        let priors: Vec<Vec<[f64; 2]>> =
            vec![stds.iter().map(|std| [0.0, *std]).collect(); self.runs.len()];
        let scales: Vec<f64> = self.motion().iter().map(|motion| 1e-3 * motion).collect();
        let sought: [SoughtValue; 0] = [];
        let machines = |_: &[f64]| self.machines(effects);
        let fitted =
            self.fit(&machines, &windows, &sought, Vec::new(), &priors, scales, 20, false)?;
        let zero = |run: usize, i: usize| {
            let place = run * n + i;
            [fitted.zeros[run][i], fitted.covariance[(place, place)].max(0.0).sqrt()]
        };
        Some((0..self.runs.len()).map(|run| (0..n).map(|i| zero(run, i)).collect()).collect())
    }

    /// Fits values and zeros over windows whose starts are fitted to their first rows before; where it `predicts`,
    /// they stay fitted to these.
    #[expect(clippy::too_many_arguments, reason = "each is one input of one problem")]
    pub fn fit(
        &self,
        machines: &(dyn Fn(&[f64]) -> Option<Vec<Mechanism>> + Sync),
        windows: &[Window],
        sought: &[SoughtValue],
        values: Vec<f64>,
        priors: &[Vec<[f64; 2]>],
        scales: Vec<f64>,
        head: usize,
        predicts: bool,
    ) -> Option<WindowsFitted> {
        let zeros: Vec<Vec<f64>> =
            priors.iter().map(|run| run.iter().map(|[centre, _]| *centre).collect()).collect();
        let built = machines(&values)?;
        let guesses = self.starts(&built, &zeros, windows)?;
        let better = |(window, start): (&Window, WindowStart)| {
            let shooter = self.shooter(&built[window.run], &zeros[window.run]);
            shooter.fitted(window, head, start.clone(), &scales).unwrap_or(start)
        };
        let starts = windows.iter().zip(guesses).map(better).collect();
        let shooter = self.shooter(&self.mechanism, &[]);
        let predicted = predicts.then_some(head);
        let shooting =
            Shooting { machines, shooter, windows, sought, head: predicted, zeros: priors };
        let [covariance, information] = [DMatrix::zeros(0, 0), DMatrix::zeros(0, 0)];
        let squares = f64::INFINITY;
        shooting.fit(WindowsFitted {
            values,
            zeros,
            starts,
            scales,
            squares,
            covariance,
            information,
        })
    }
}

fn built(rig: &Scenario, effects: &[Setting]) -> Result<Mechanism, Problem> {
    let mut scenario = rig.clone();
    scenario.effects = effects.to_vec();
    recorded(&scenario, &mut |mechanism| {
        mechanism.commands =
            if mechanism.actuators.is_empty() { Arc::new(Idle) } else { Arc::new(Slack) };
        mechanism.epoch = 0.0;
    })
}

/// Drives that give nothing.
#[derive(Debug)]
struct Slack;

impl Commands for Slack {
    fn at(&self, _: f64, commands: &mut [Command]) {
        commands.fill(Command::default());
    }
}
