//! Runs that vary what the machine without clearance does not have look at one such machine once.

use super::ideal::Ideal;
use super::ideal_past::{Past, Said};
use crate::engine::Schedule;
use std::sync::{Arc, Mutex, PoisonError};

/// The machine without clearance of the runs of a sweep: what one says is kept for the next that would say the same.
///
/// ```
/// use freeplay::model::SharedIdeal;
/// use freeplay::prelude::*;
///
/// let shared = SharedIdeal::default();
/// let mut forces = |clearance: &str| -> Result<Vec<f64>, Box<dyn std::error::Error>> {
///     let mut machine = assemble(&Scenario::load(None, &[format!("joints.clearance={clearance}")])?)?;
///     shared.begin(&mut machine.ideal, machine.schedule, 0.0);
///     let forces = machine.ideal.at(0.1).drive_forces.to_vec();
///     shared.end(machine.ideal);
///     Ok(forces)
/// };
/// assert_eq!(forces("1e-4")?, forces("1e-5")?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct SharedIdeal {
    last: Mutex<Option<(String, Arc<Vec<Said>>)>>,
}

impl SharedIdeal {
    /// Before a run of which rows are asked for by `schedule`, and figures from `settle` s on: `ideal` says what the last
    /// one said if nothing differs of which that is a function, and keeps what it says otherwise.
    pub fn begin(&self, ideal: &mut Ideal, schedule: Schedule, settle: f64) {
        // Every number of it, of its motion and its loads, as text that reads back as the same number.
        let key = format!("{schedule:?} {settle:?} {ideal:?}");
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        ideal.past = match &*last {
            Some((known, said)) if *known == key => Past::Known { said: said.clone(), asked: 0 },
            _ => Past::Kept { key, said: Vec::new() },
        };
    }

    /// After a run to its end.
    pub fn end(&self, ideal: Ideal) {
        if let Past::Kept { key, said } = ideal.past {
            let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
            *last = Some((key, Arc::new(said)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Machine, assemble};
    use crate::scenario::Scenario;

    fn machine(set: &str) -> Machine {
        assemble(&Scenario::load(None, &[set.to_owned()]).expect("right"))
            .expect("no table to read")
    }

    /// What a machine with another clearance, law or drive says is known; heavier, or driven otherwise, it is asked itself.
    #[test]
    fn machines_that_differ_in_their_play_share_one_without() {
        let shared = SharedIdeal::default();
        let ask = |set: &str| {
            let mut machine = machine(set);
            shared.begin(&mut machine.ideal, machine.schedule, 0.0);
            let known = matches!(machine.ideal.past, Past::Known { .. });
            let said: Vec<f64> =
                [0.0, 0.01, 0.02].iter().map(|&t| machine.ideal.at(t).drive_forces[1]).collect();
            shared.end(machine.ideal);
            (known, said)
        };
        let (known, said) = ask("joints.clearance=1e-4");
        assert!(!known, "the first one");
        for alike in [
            "joints.clearance=1e-6",
            "contact.law=kelvin-voigt",
            "joints.friction=0.1",
            "drive.mode=servo",
        ] {
            assert_eq!(ask(alike), (true, said.clone()), "{alike}");
        }
        for other in
            ["mechanism.platform_mass=0.3", "motion.period=0.7", "environment.gravity=[0,-1.62]"]
        {
            let (known, said) = ask(other);
            let mut alone = machine(other);
            assert!(!known, "{other}");
            assert_eq!(said[2], alone.ideal.at(0.02).drive_forces[1], "{other}");
        }
    }
}
