//! What a run saw of its own errors: the balance of its energy, joints that came apart, steps that missed
//! their tolerance, and how far it is from the same run with a tenth of the error.

use crate::engine::Work;
use serde::Serialize;

/// Share of the energy that changed hands by which a balance may be off.
///
/// The machines and effects of the tests stay below 1e-4 under error control and 1e-3 at fixed steps; a
/// run whose hits are not resolved gains or loses several per cent.
const LARGEST_IMBALANCE: f64 = 0.01;

/// How far rigid joints may come apart, in m: a tenth of the smallest clearance that is common. (They stay
/// closed to 1e-10 m.)
const LARGEST_DRIFT: f64 = 1e-6;

/// Share of all steps that may be forced.
const MOST_FORCED: f64 = 0.01;

/// Hits that a run must predict, within its own error, for single ones to be taken at their word.
const FEWEST_HITS: u64 = 3;

/// Share of the largest contact force by which peaks of contact forces may differ from those with a tenth of the
/// error while positions still agree.
const LARGEST_FORCE_ERROR: f64 = 0.5;

/// What a run saw of its own errors.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Watched {
    /// What does not balance, in words; a run with any of these ends with exit code 1.
    pub faults: Vec<String>,
    /// What is doubtful, in words.
    pub doubts: Vec<String>,
    /// Where the energy went; none of native contacts, whose forces are known as impulses only.
    pub energy: Option<Balance>,
    /// How far rigid joints came apart, in m.
    pub constraint_drift_m: f64,
    /// Steps that were taken although their error exceeded the tolerance.
    pub forced_steps: u64,
    /// Rows at which the machine without clearance cannot be: figures that compare with it are `null`.
    pub rows_without_ideal: u64,
    /// How far the run is from one with a tenth of the error; none where nobody looked.
    pub own_error: Option<OwnError>,
}

/// Where the energy of a run went: `put_in = kinetic + gravity + taken`, but for the imbalance at its end.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Balance {
    /// Work of the drives in J.
    #[serde(rename = "put_in_J")]
    pub put_in: f64,
    /// Growth of the kinetic energy in J.
    #[serde(rename = "kinetic_J")]
    pub kinetic: f64,
    /// Growth of the potential energy of gravity in J.
    #[serde(rename = "gravity_J")]
    pub gravity: f64,
    /// What contacts, friction, springs and other loads dissipated or stored, in J.
    #[serde(rename = "taken_J")]
    pub taken: f64,
    /// How much energy changed hands, `∫ |dT/dt| dt`, in J.
    #[serde(rename = "turned_over_J")]
    pub turned_over: f64,
    /// Largest error of the balance of a row in J.
    #[serde(rename = "imbalance_J")]
    pub imbalance: f64,
    /// The same as a share of what changed hands.
    pub imbalance_share: f64,
}

/// How far a run is from the same run with a tenth of the error (a tenth of the tolerance; half the step),
/// as long as the two are less than 1 µm apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OwnError {
    /// Until when that is so, in s; at most the time that was looked at.
    pub until_s: f64,
    /// Whether it is so all the time that was looked at.
    pub to_the_end: bool,
    /// Largest difference at the output body until then, in m.
    pub position_m: f64,
    /// Largest difference of a joint's peak contact force until then, in N.
    #[serde(rename = "contact_force_N")]
    pub contact_force: f64,
    /// Largest contact force until then, in N.
    #[serde(rename = "largest_contact_force_N")]
    pub largest_contact_force: f64,
    /// Hits until then.
    pub hits: u64,
}

/// Whether a value is above its bound, or no number.
fn beyond(value: f64, most: f64) -> bool {
    value.is_nan() || value > most
}

impl Watched {
    /// Of a run that took `work`, with so many rows without an ideal machine.
    pub fn new(work: &Work, rows_without_ideal: u64) -> Self {
        let energy = work.energy.map(|energy| Balance {
            put_in: energy.put_in,
            kinetic: energy.kinetic,
            gravity: energy.gravity,
            taken: energy.taken,
            turned_over: energy.turned_over,
            imbalance: energy.imbalance,
            imbalance_share: energy.share(),
        });
        let mut watched = Self {
            energy,
            constraint_drift_m: work.drift,
            forced_steps: work.forced_steps,
            rows_without_ideal,
            ..Self::default()
        };
        watched.faults = watched.faults(work.steps);
        watched
    }

    fn faults(&self, steps: u64) -> Vec<String> {
        let mut faults = Vec::new();
        if let Some(energy) = self.energy
            && beyond(energy.imbalance_share, LARGEST_IMBALANCE)
        {
            faults.push(format!(
                "the energy is off by {:.1e} J, {:.1} % of what changed hands (at most {} %): hits, drives or \
                 loads are not resolved; try a smaller simulation.tolerance or step",
                energy.imbalance,
                100.0 * energy.imbalance_share,
                100.0 * LARGEST_IMBALANCE
            ));
        }
        if beyond(self.constraint_drift_m, LARGEST_DRIFT) {
            faults.push(format!(
                "rigid joints came apart by {:.1e} m (at most {LARGEST_DRIFT:e} m): forces beyond what \
                 they are solved for; try a smaller simulation.tolerance or step",
                self.constraint_drift_m
            ));
        }
        if self.forced_steps as f64 > MOST_FORCED * steps as f64 {
            faults.push(format!(
                "{} of {steps} steps missed their tolerance: a pose stays nearly singular",
                self.forced_steps
            ));
        }
        if self.rows_without_ideal > 0 {
            faults.push(format!(
                "the machine without clearance cannot be at {} rows: figures that compare with it are \
                 null; `freeplay check` says where its motion leads",
                self.rows_without_ideal
            ));
        }
        faults
    }

    /// Takes what was seen of the run's own error.
    pub fn compared(&mut self, own: OwnError) {
        if !own.to_the_end && own.hits < FEWEST_HITS {
            self.doubts.push(format!(
                "the run's own error at the output passes 1 µm at t = {:.4} s, after {} hits: single hits are not \
                 resolved, and what follows is a guess; try a smaller simulation.tolerance",
                own.until_s, own.hits
            ));
        }
        if own.contact_force > LARGEST_FORCE_ERROR * own.largest_contact_force {
            self.doubts.push(format!(
                "peaks of contact forces differ by up to {:.1e} of {:.1e} N from those with a tenth of the error, \
                 before t = {:.4} s: single hits are not resolved; try a smaller simulation.tolerance",
                own.contact_force, own.largest_contact_force, own.until_s
            ));
        }
        self.own_error = Some(own);
    }
}
