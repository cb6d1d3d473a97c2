//! Where the runs of a model begin.

use super::kept::KeptStarts;
use super::problem::{RigProblem, Start, Stopped};
use crate::calibrate::sensed::motion::at_rest::let_go_at;
use crate::calibrate::sensed::motion::released::{Released, released, released_near};
use crate::effects::Setting;
use crate::mechanism::Mechanism;
use rayon::prelude::*;
use std::sync::atomic::Ordering;
use std::sync::{MutexGuard, PoisonError};

impl RigProblem {
    /// The machine with these effects as it was let go in run `index`.
    pub(super) fn released(&self, effects: &[Setting], index: usize) -> Result<Released, Stopped> {
        let key = self.key(effects, index);
        if let Some(machine) = self.kept().get(&key) {
            return Ok(machine);
        }
        let mut machine = released(&self.rig, effects, &self.runs[index].recording, self.control)?;
        let kicks = self.kicks()[index];
        if let Some(kicks) = kicks {
            machine = machine.with_kicks(&kicks, self.control)?;
        }
        if self.kept().keep(key, machine.clone()) {
            self.work.fetch_add(machine.steps, Ordering::Relaxed);
        }
        Ok(machine)
    }

    fn kept(&self) -> MutexGuard<'_, KeptStarts> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Knows from now on where the machine with these effects was let go in run `index`: near `coordinates`, where that does
    /// more of what was recorded.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn let_go_near(
        &self,
        effects: &[Setting],
        index: usize,
        coordinates: &[f64],
    ) -> Result<(), Stopped> {
        let known = (self.released(effects, index)?, coordinates);
        let recording = &self.runs[index].recording;
        let near = released_near(&self.rig, effects, recording, known, self.control)?;
        self.work.fetch_add(near.steps, Ordering::Relaxed);
        self.kept().keep(self.key(effects, index), near);
        Ok(())
    }

    fn key(&self, effects: &[Setting], index: usize) -> String {
        format!("{index} {:?} {:?} {effects:?}", self.kicks()[index], self.rig.effects)
    }

    /// The machine with the `drawn` effects about where the model that begins at `start` was let go in run `index`, as
    /// far as nobody knows that: it is as uncertain whatever their values, and costs more than a simulation to find.
    pub(super) fn let_go_like(
        &self,
        start: &Start,
        drawn: &[Setting],
        index: usize,
        replica: u64,
    ) -> Result<Mechanism, Stopped> {
        if start.released.coordinates.is_empty() {
            return Ok(self.released(drawn, index)?.machine);
        }
        self.at_rest(drawn, index, &start.released.drawn(replica))
    }

    /// The machine with these effects, which nothing holds, let go at these coordinates in run `index`.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub(super) fn at_rest(
        &self,
        effects: &[Setting],
        index: usize,
        coordinates: &[f64],
    ) -> Result<Mechanism, Stopped> {
        let recording = &self.runs[index].recording;
        let held = let_go_at(&self.rig, effects, recording, coordinates, self.control)?;
        self.work.fetch_add(held.steps(), Ordering::Relaxed);
        Ok(held.machine)
    }

    /// Where the runs of a model with these effects begin as it is let go, whatever swing was recorded.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn let_go(&self, effects: &[Setting]) -> Result<Vec<Start>, Stopped> {
        let start = |run| {
            let released = self.released(effects, run)?;
            Ok(Start { run, released, effects: effects.to_vec(), still: None })
        };
        (0..self.runs.len()).into_par_iter().map(start).collect()
    }

    /// Whether nothing holds the machine with these effects in some run.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn falls(&self, effects: &[Setting]) -> Result<bool, Stopped> {
        Ok(self.let_go(effects)?.iter().any(Start::is_fitted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Which starts are still kept hangs on the order of threads, and is found again; the work for it counts once.
    #[test]
    fn work_for_a_start_that_is_kept_no_longer_counts_once() {
        let problem = RigProblem::planar("planar-4");
        problem.let_go(&[]).unwrap();
        let before = problem.work();
        problem.kept().clear();
        let again = problem.let_go(&[]).unwrap();
        assert!(before > 0 && again[0].steps() > 0 && problem.work() == before);
    }
}
