//! Noiseless recordings of models of a problem.

use super::problem::{RigProblem, Start, Stopped};
use crate::calibrate::sensed::motion::simulate;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{BUDGET, REPLICAS, SEEN, STIFFER, TRIM, WORK};
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::effects::Setting;
use crate::engine::Halt;
use crate::mechanism::Mechanism;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::Ordering;

impl RigProblem {
    /// Noiseless recordings of a model whose runs begin there, so many replicas of each.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn simulated(
        &self,
        starts: &[Start],
        replicas: usize,
    ) -> Result<Vec<Vec<Recording>>, Stopped> {
        self.simulated_about(&[], &[], starts, 0..replicas)
    }

    /// The same of a model with these effects, these of its replicas: the first one with exactly these values, the others
    /// with values as far away as `deviations` say that nobody knows them (none: all exactly), as they are let go.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn simulated_about(
        &self,
        effects: &[Setting],
        deviations: &[f64],
        starts: &[Start],
        replicas: Range<usize>,
    ) -> Result<Vec<Vec<Recording>>, Stopped> {
        let numbers = || replicas.clone().map(|replica| replica as u64);
        let about: Vec<Option<Vec<Setting>>> =
            numbers().map(|replica| drawn(effects, deviations, replica)).collect();
        let jobs: Vec<(&Start, u64)> = starts
            .iter()
            .flat_map(|start| numbers().map(move |replica| (start, replica)))
            .collect();
        let recorded = jobs
            .into_par_iter()
            .map(|(start, replica)| {
                let run = start.run;
                let like = &self.runs[run].recording;
                let record = |machine: &Mechanism| self.record(machine, like, replica);
                // Where joints rattle a hair at the start is another run soon, and what nobody knows of it no hair.
                let open = self.replicas > 1 && replica > 0 && start.released.is_fitted();
                let as_let_go = || record(&start.released.machine);
                let anywhere = |effects: &[Setting]| {
                    record(&self.let_go_like(start, effects, run, replica)?).map_err(Stopped::from)
                };
                match &about[replica as usize - replicas.start] {
                    // Values that the machine cannot have are none that it may have.
                    Some(drawn) => anywhere(drawn).or_else(|_| Ok(as_let_go()?)),
                    None if open => anywhere(&start.effects),
                    None => Ok(as_let_go()?),
                }
            })
            .collect::<Result<Vec<Recording>, Stopped>>()?;
        Ok(recorded.chunks(replicas.len()).map(<[Recording]>::to_vec).collect())
    }

    /// Two noiseless recordings of each run of the declared machine, whose steps say from then on what a
    /// [look](Self::look) at another model is worth.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn simulated_as_declared(&self) -> Result<Vec<Vec<Recording>>, Stopped> {
        let starts = self.let_go(&[])?;
        let before = self.work();
        let simulated = self.simulated(&starts, 2)?;
        let mean = (self.work() - before) / (2 * starts.len() as u64).max(1);
        self.declared_steps.store(mean, Ordering::Relaxed);
        Ok(simulated)
    }

    /// A noiseless recording of run `index` of a model with these effects, some time beyond row `until` of it: a replica.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn one(
        &self,
        effects: &[Setting],
        index: usize,
        until: usize,
        replica: u64,
    ) -> Result<Recording, Stopped> {
        let machine = self.released(effects, index)?.machine;
        Ok(self.recorded(&machine, index, until, replica, u64::MAX)?)
    }

    /// The same of the first replica of a model that is [worth](STIFFER) no more than so many steps.
    ///
    /// # Errors
    /// As of [`Self::one`], and more steps than that.
    pub fn look(
        &self,
        effects: &[Setting],
        index: usize,
        until: usize,
    ) -> Result<Recording, Stopped> {
        let machine = self.released(effects, index)?.machine;
        Ok(self.recorded(&machine, index, until, 0, self.most_steps())?)
    }

    /// The same where the machine, which nothing holds, is let go at these coordinates.
    ///
    /// # Errors
    /// As of [`Self::look`].
    pub fn from(
        &self,
        effects: &[Setting],
        index: usize,
        until: usize,
        coordinates: &[f64],
    ) -> Result<Recording, Stopped> {
        let machine = self.at_rest(effects, index, coordinates)?;
        Ok(self.recorded(&machine, index, until, 0, self.most_steps())?)
    }

    fn recorded(
        &self,
        machine: &Mechanism,
        index: usize,
        until: usize,
        replica: u64,
        most: u64,
    ) -> Result<Recording, Halt> {
        let recording = &self.runs[index].recording;
        // Filters see a little beyond the last row.
        let seconds = until as f64 * recording.interval + 3.0 * TRIM;
        self.record_within(machine, &recording.first(seconds), replica, most)
    }

    /// Steps of bodies that a look at a model is worth.
    fn most_steps(&self) -> u64 {
        match self.declared_steps.load(Ordering::Relaxed) {
            0 => u64::MAX,
            declared => declared.saturating_mul(STIFFER).max(WORK / BUDGET),
        }
    }

    /// What sensors show of a run like this recording, counted among the simulations.
    pub(super) fn record(
        &self,
        machine: &Mechanism,
        like: &Recording,
        replica: u64,
    ) -> Result<Recording, Halt> {
        self.record_within(machine, like, replica, u64::MAX)
    }

    fn record_within(
        &self,
        machine: &Mechanism,
        like: &Recording,
        replica: u64,
        most: u64,
    ) -> Result<Recording, Halt> {
        self.simulations.fetch_add(1, Ordering::Relaxed);
        self.rows.fetch_add(like.samples as u64, Ordering::Relaxed);
        let recorded = simulate::record_counting(machine, self.control, like, replica, most);
        let steps = match &recorded {
            Ok((_, steps)) => *steps,
            Err(halt) => halt.work.steps * machine.bodies.len() as u64,
        };
        self.work.fetch_add(steps, Ordering::Relaxed);
        Ok(recorded?.0)
    }

    /// Finds out whether replicas of the machine with these effects differ by more than sensors see, and by how
    /// much, in units of their noise. Where they do, means are taken of several simulations from now on.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn look_for_rattle(&mut self, effects: &[Setting]) -> Result<f64, Stopped> {
        let logs = self.simulated(&self.let_go(effects)?, 2)?;
        Ok(self.rattle(&logs))
    }

    /// The same of the declared machine, which nothing holds, let go from anywhere that is as likely as where one simulation of it
    /// was: two that part by a hair may fall alike, and others not.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn look_for_rattle_nearby(&mut self) -> Result<f64, Stopped> {
        self.replicas = REPLICAS;
        let largest = self.apart(&self.simulated(&self.let_go(&[])?, REPLICAS)?);
        if largest <= SEEN {
            self.replicas = 1;
        }
        Ok(largest)
    }

    /// The same by simulations of two replicas or more of each run.
    pub fn rattle(&mut self, logs: &[Vec<Recording>]) -> f64 {
        let largest = self.apart(logs);
        if largest > SEEN {
            self.replicas = REPLICAS;
        }
        largest
    }

    /// Largest difference of a replica of a run from the first one, in units of the sensors' noise.
    pub(super) fn apart(&self, logs: &[Vec<Recording>]) -> f64 {
        let sensors = &self.declared.sensors;
        let others = logs.iter().flat_map(|logs| {
            logs[1..].iter().map(|other| simulate::apart(sensors, &logs[0], other))
        });
        others.fold(0.0, f64::max)
    }

    /// Whether joints lift off with these effects that rest as declared: what one simulation leaves is no measure of a model
    /// then. Where several are made of each model, that is known already.
    pub fn lifts_off(&self, effects: &[Setting]) -> bool {
        if self.replicas > 1 || effects.is_empty() {
            return false;
        }
        // What cannot be simulated as it is let go tells nothing.
        let logs = self.let_go(effects).and_then(|starts| self.simulated(&starts, 2));
        logs.is_ok_and(|logs| self.apart(&logs) > SEEN)
    }

    /// Noiseless recordings of a model that begins there without a swing; none of runs whose machine is not held
    /// before they begin.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn still(&self, starts: &[Start]) -> Result<Vec<Option<Recording>>, Stopped> {
        let still = |start: &Start| {
            let Some(machine) = &start.still else { return Ok(None) };
            Ok(Some(self.record(machine, &self.runs[start.run].recording, 0)?))
        };
        starts.par_iter().map(still).collect()
    }
}

/// Effects with values drawn about their own, within bounds; none where they are exact, as of the first replica.
fn drawn(effects: &[Setting], deviations: &[f64], replica: u64) -> Option<Vec<Setting>> {
    let own = values(effects);
    if replica == 0 || own.is_empty() || deviations.len() != own.len() {
        return None;
    }
    let mut random = ChaCha8Rng::seed_from_u64(replica);
    let drawn = own.iter().zip(deviations).zip(free(effects)).map(|((value, deviation), free)| {
        let normal: f64 = StandardNormal.sample(&mut random);
        let away = if deviation.is_finite() { normal * deviation } else { 0.0 };
        (value + away).clamp(free.bounds[0], free.bounds[1])
    });
    Some(with_values(effects, &drawn.collect::<Vec<f64>>()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target, named};

    #[test]
    fn a_look_that_takes_more_steps_than_it_is_worth_is_given_up() {
        let problem = RigProblem::planar("planar-1");
        let machine = problem.let_go(&[]).unwrap()[0].machine().clone();
        let taken = |most: u64| {
            let before = problem.work();
            let looked = problem.record_within(&machine, &problem.runs[0].recording, 0, most);
            (looked.is_ok(), problem.work() - before)
        };
        let (_, whole) = taken(u64::MAX);
        assert_eq!(taken(whole), (true, whole));
        let (ended, part) = taken(whole / 4);
        assert!(!ended && part > whole / 4 && part < whole / 2, "{part} of {whole}");
    }

    #[test]
    fn moments_of_a_run_count_as_parts_of_one() {
        let problem = RigProblem::planar("planar-1");
        let tenth = problem.runs[0].view.rows().end / 10;
        for _ in 0..10 {
            problem.look(&[], 0, tenth).unwrap();
        }
        assert_eq!(problem.simulations(), 10);
        // Each goes a little further than asked for.
        assert!((1..=2).contains(&problem.whole_runs()), "{}", problem.whole_runs());
    }

    /// What rests in its bearings as declared is thrown about with more on its piston, on the faster one of its runs.
    #[test]
    fn joints_that_rest_lift_off_under_a_load() {
        let problem = RigProblem::planar_run("planar-1", "run-b.csv");
        let payload = |mass: f64| {
            let body = Target::Body("piston".to_owned());
            [Setting::on(named("payload").unwrap(), body, &[("mass_kg", mass)])]
        };
        assert!(problem.lifts_off(&payload(0.06)));
        assert!(!problem.lifts_off(&payload(0.001)) && !problem.lifts_off(&[]));
    }
}
