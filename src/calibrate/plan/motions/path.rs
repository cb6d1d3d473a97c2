//! Whether a machine can follow a motion: it closes all along, stays on its branch and away from singular poses, and its
//! drives are strong enough.

use super::limits::DriveLimits;
use super::motion::{DrivesMotion, Maker};
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::start::machine;
use crate::mechanism::{BodyState, Imposed, Mechanism, Tracker};
use crate::scenario::Scenario;

/// Time in s between two poses that are looked at: a wave of the highest order lasts some seventy of them.
const EVERY: f64 = 5e-3;

/// Sizes at which a motion is tried, as shares of what strokes, speeds and accelerations allow.
const SHARES: [f64; 7] = [1.0, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1];

/// A machine that motions are tried on.
#[derive(Debug)]
pub struct TriedMachine<'a> {
    /// What its maker declares.
    pub rig: &'a Scenario,
    /// The machine as declared.
    pub declared: &'a Mechanism,
    /// Largest gain from a drive's error to the machine's fastest point.
    pub gain: f64,
    /// Sign of the determinant of all rows where the machine is at home: of its branch.
    pub sign: f64,
    /// Time in s between two rows.
    pub interval: f64,
    /// Rows of a motion.
    pub samples: usize,
}

/// Why a motion cannot be followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blocked {
    /// The machine does not close, at a time in s.
    Reach(f64),
    /// A pose is too near a singular one, at a time in s, by this gain.
    Singular(f64, f64),
    /// A drive takes more than it has: its place, and how much.
    Force(usize, f64),
}

impl Blocked {
    /// In words.
    pub fn words(&self, limits: &[DriveLimits]) -> String {
        match self {
            Self::Reach(t) => format!("at t = {t:.3} s the machine does not close"),
            Self::Singular(t, gain) if gain.is_finite() => {
                format!("at t = {t:.3} s a drive's error moves the machine {gain:.0} times as far")
            }
            Self::Singular(t, _) => {
                format!("at t = {t:.3} s the machine is beyond a singular pose")
            }
            Self::Force(drive, force) => {
                let joint = limits.get(*drive).map_or("a drive", |limit| limit.joint.as_str());
                format!("{joint} takes {force:.3} N or N·m already")
            }
        }
    }
}

/// Sign of the rows' determinant and gain at a pose.
pub fn held(mechanism: &Mechanism, states: &[BodyState]) -> Option<(f64, f64)> {
    mechanism.hold(states).map(|hold| (hold.sign, 1.0 / hold.share))
}

impl TriedMachine<'_> {
    /// What a machine is recorded like along a motion.
    pub fn like(&self, motion: &DrivesMotion) -> Recording {
        motion.like(self.declared, "planned", self.interval, self.samples)
    }

    /// The largest motion that numbers stand for which the machine can follow, and what it is recorded like; none where
    /// it can follow none.
    pub fn largest(&self, maker: &Maker, numbers: &[f64]) -> Option<(DrivesMotion, Recording)> {
        SHARES.iter().find_map(|share| {
            let motion = maker.motion(numbers, *share);
            let like = self.like(&motion);
            self.follows(&like, &maker.limits).ok().map(|()| (motion, like))
        })
    }

    /// Whether the machine without clearance can follow a recording's commands.
    ///
    /// # Errors
    /// What is in its way.
    pub fn follows(&self, like: &Recording, limits: &[DriveLimits]) -> Result<(), Blocked> {
        let machine = machine(self.rig, &[], like).map_err(|_| Blocked::Reach(0.0))?;
        let ideal = machine.without_clearance();
        let starts = ideal.bodies.iter().map(|body| body.start).collect();
        let stuck = |t| Blocked::Reach(t);
        let mut tracker =
            Tracker::new(ideal, Imposed::Drives, starts, 0.0).map_err(|s| stuck(s.t))?;
        let rows = ((EVERY / like.interval).round() as usize).max(1);
        for row in (0..like.samples).step_by(rows) {
            let t = row as f64 * like.interval;
            tracker.advance(t).map_err(|s| stuck(s.t))?;
            if let Some((sign, gain)) = held(tracker.mechanism(), tracker.states())
                && (gain.is_nan() || gain > self.gain || sign * self.sign < 0.0)
            {
                return Err(Blocked::Singular(
                    t,
                    if sign * self.sign < 0.0 { f64::INFINITY } else { gain },
                ));
            }
            if limits.iter().all(|limit| limit.force.is_none()) {
                continue;
            }
            let posed = tracker.posed().ok_or(Blocked::Singular(t, f64::INFINITY))?;
            let unknown = vec![None; machine.actuators.len()];
            let taken = posed.taken(&machine, t, &unknown, &[]);
            let efforts = taken.ok_or(Blocked::Singular(t, f64::INFINITY))?.efforts;
            for (drive, (effort, limit)) in efforts.iter().zip(limits).enumerate() {
                if limit.force.is_some_and(|most| effort.abs() > most) {
                    return Err(Blocked::Force(drive, effort.abs()));
                }
            }
        }
        Ok(())
    }
}
