//! A start that a recording shows: nobody knows how a machine was let go, but its swing is measured.
//!
//! Where loads keep the joints in contact, the platform swings in their play for seconds, and how far a
//! journal leans, on average too, depends on that swing. A machine that has come to rest under its first
//! command, and is kicked twice a quarter of a swing apart just before the log begins, swings with any
//! amplitude and phase along x, y and φ: six numbers, found by Gauss and Newton from the measured pose.

use super::commands::LEAD;
use super::rattle::noise;
use super::replica::Simulator;
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::engine::{Halt, Schedule};
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log};
use crate::mechanism::{Load, Mechanism, Situation};
use crate::scenario::Sensors;
use nalgebra::{DMatrix, DVector, SVector, Vector3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Swing in Hz that dies fastest while a machine comes to rest, critically damped: light platforms in
/// play of 0.1 mm swing at 30–60 Hz.
const SWING: f64 = 40.0;

/// Time in s from rest to the log's first row, and of each kick, a half sine; the last ends with it.
const SHORT: f64 = 0.03;
const PULSE: f64 = 0.012;
const PULSES: usize = 2;
const APART: f64 = 0.25 / SWING;

/// Sizes of kicks, as velocities that the free platform would take up (m/s, m/s, rad/s): a tenth of a
/// release's swing.
const SIZES: [f64; 3] = [1e-3, 1e-3, 2e-2];

/// Time in s from the first row over which a swing is seen, until most of it has died, and shorter times
/// before: a swing's frequency hangs on its amplitude, which takes a few periods to be seen.
const SEEN: f64 = 0.6;
const FIRST: [f64; 2] = [0.1, 0.25];

/// Steps of Gauss and Newton over the whole time, at most, and the share of the squares that one has to
/// promise to be tried, and to bring for another to be.
const STEPS: usize = 3;
const WORTH: f64 = 0.01;

/// What keeps kicks that do nothing at nothing: far below what one size does.
const RIDGE: f64 = 1e-3;

/// Mean square in units of noise up to which a release shows the recorded swing, and the share of its
/// squares that a kicked start has to leave to be the better one.
pub const SHOWN: f64 = 1.1;
const SLACK: f64 = 0.95;

/// Share of the squares that a machine at rest and a released one leave together up to which kicks
/// show the recorded swing. A model whose swing has another frequency lost its phase: kicks bring it
/// nothing, rest leaves the recorded swing, a release two swings.
const TRACKED: f64 = 0.25;

/// Share of a platform's swing that a model may be wrong by before its values are settled: a frequency
/// that is off by a thousandth has lost the phase after some seconds. A start that misses more of the
/// recorded swing has lost it.
pub const MISSED: f64 = 0.3;

/// Numbers of kicks of one start.
pub const KICKS: usize = 3 * PULSES;

/// Kicks along x, y and φ, pulse by pulse, as multiples of their sizes.
pub type Kicks = SVector<f64, KICKS>;

/// How a recorded machine swings when its log begins.
#[derive(Clone, Debug)]
pub struct SwingStart {
    /// The kicks, or none where the machine was let go as it is said to have been.
    pub kicks: Option<Kicks>,
    /// The machine with that start.
    pub machine: Mechanism,
    /// The machine at rest, without a swing.
    pub still: Mechanism,
    /// Whether the machine swings as recorded, rather than with another frequency or phase.
    pub shown: bool,
    /// What else is known of kicks.
    seen: Option<KickedMachine>,
}

/// What is nearly the same for all models of a machine that is kicked.
#[derive(Clone, Debug)]
struct KickedMachine {
    /// What kicks change of what is not met of the recorded swing.
    response: DMatrix<f64>,
    /// Squares of what a release and a machine at rest leave of it.
    let_go: f64,
    quiet: f64,
}

impl KickedMachine {
    /// Whether kicks that leave so much, as a square, are of the recorded swing.
    fn tracked(&self, left: f64) -> bool {
        left < TRACKED * (self.quiet + self.let_go)
    }

    /// Whether a start that leaves so much, as a square, swings as recorded.
    fn shown(&self, left: f64) -> bool {
        left < MISSED * MISSED * self.quiet
    }
}

impl SwingStart {
    /// A start that nothing is known of, but how the machine was let go.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn let_go(simulator: &Simulator, machine: Mechanism) -> Result<Self, Halt> {
        let still = still(simulator, &machine)?;
        Ok(Self { kicks: None, still, machine, shown: true, seen: None })
    }

    /// The same with this machine, as it was let go.
    pub fn without_kicks(&self, machine: Mechanism) -> Self {
        let still = self.still.clone();
        Self { kicks: None, still, machine, shown: true, seen: None }
    }
}

#[derive(Debug)]
struct Kicked {
    /// Impulses over their times, N, N, N·m, pulse by pulse.
    forces: [Vector3<f64>; PULSES],
}

impl Load for Kicked {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        for (pulse, force) in self.forces.iter().enumerate() {
            let phase = (at.t + PULSE + pulse as f64 * APART) / PULSE;
            if (0.0..1.0).contains(&phase) {
                let force = force * (PI * phase).sin();
                at.push_output(force.xy(), force.z, wrenches);
            }
        }
    }
}

/// `f = −D v` on the output.
#[derive(Debug)]
struct CalmedOutput {
    damping: Vector3<f64>,
}

impl Load for CalmedOutput {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let force = -self.damping.component_mul(&at.mechanism.output_state(at.states).twist);
        at.push_output(force.xy(), force.z, wrenches);
    }

    fn longest_step(&self, _mechanism: &Mechanism) -> Option<f64> {
        Some(1.0 / (2.0 * TAU * SWING))
    }
}

/// Mass and inertia of the output.
fn inertia(machine: &Mechanism) -> Vector3<f64> {
    let body = &machine.bodies[machine.output];
    Vector3::new(body.mass, body.mass, body.inertia)
}

/// The machine at rest under its first command, shortly before the log begins: its swing is damped away.
///
/// # Errors
/// A run that broke down.
pub fn still(simulator: &Simulator, released: &Mechanism) -> Result<Mechanism, Halt> {
    let mut calmed = released.clone();
    let damping = inertia(released) * (2.0 * TAU * SWING);
    calmed.loads.push(Arc::new(CalmedOutput { damping }));
    let duration = LEAD - SHORT;
    let mut machine = released.clone();
    simulator.run(&calmed, Schedule { duration, interval: duration }, &mut |instant| {
        for (body, state) in machine.bodies.iter_mut().zip(instant.states) {
            body.start = *state;
        }
    })?;
    machine.epoch = -SHORT;
    Ok(machine)
}

/// A machine at rest with these kicks.
pub fn kicked(still: &Mechanism, kicks: &Kicks) -> Mechanism {
    let mut machine = still.clone();
    // A half sine of height 1 has the mean 2/π.
    let unit = inertia(still).component_mul(&Vector3::from(SIZES)) * (FRAC_PI_2 / PULSE);
    let forces = std::array::from_fn(|pulse| {
        unit.component_mul(&kicks.fixed_rows::<3>(3 * (PULSES - 1 - pulse)).into_owned())
    });
    machine.loads.push(Arc::new(Kicked { forces }));
    machine
}

/// How well starts meet the swing that a log shows.
struct SwingJudge<'a> {
    simulator: &'a Simulator,
    log: Log,
}

impl SwingJudge<'_> {
    /// What is not met, in units of noise.
    fn look(&self, machine: &Mechanism) -> Result<DVector<f64>, Halt> {
        let simulated = self.simulator.record(machine, &self.log, 0)?;
        Ok(swing(&self.log, &simulated, &self.simulator.sensors))
    }

    /// What kicks change of what is not met.
    fn response(
        &self,
        still: &Mechanism,
        kicks: &Kicks,
        base: &DVector<f64>,
    ) -> Result<DMatrix<f64>, Halt> {
        let unit = |i: usize| Kicks::from_fn(|k, _| f64::from(u8::from(k == i)));
        let columns = (0..KICKS).into_par_iter().map(|i| {
            let moved = self.look(&kicked(still, &(kicks + unit(i))))?;
            Ok(moved - base)
        });
        Ok(DMatrix::from_columns(&columns.collect::<Result<Vec<_>, Halt>>()?))
    }

    /// Better kicks by one step, if they then show the recorded swing.
    fn first(&self, released: &SwingStart, kicks: Kicks) -> Result<Option<Kicks>, Halt> {
        let SwingStart { machine, still, .. } = released;
        let square = |left: &DVector<f64>| left.norm_squared();
        let limit = TRACKED * (square(&self.look(still)?) + square(&self.look(machine)?));
        let left = self.look(&kicked(still, &kicks))?;
        let better = kicks + step(&self.response(still, &kicks, &left)?, &left);
        let there = self.look(&kicked(still, &better))?;
        let (kicks, left) =
            if there.norm() < left.norm() { (better, there) } else { (kicks, left) };
        Ok((square(&left) < limit).then_some(kicks))
    }

    /// The start with better kicks than these, which leave so much; none where no kicks show the recorded
    /// swing, or a release does not less.
    fn nearer(
        &self,
        still: &Mechanism,
        mut kicks: Kicks,
        mut left: DVector<f64>,
        seen: KickedMachine,
    ) -> Result<Option<SwingStart>, Halt> {
        for _ in 0..STEPS {
            let change = step(&seen.response, &left);
            let promised = (&left + &seen.response * change).norm_squared();
            if promised > (1.0 - WORTH) * left.norm_squared() {
                break;
            }
            let there = self.look(&kicked(still, &(kicks + change)))?;
            let gain = 1.0 - there.norm_squared() / left.norm_squared();
            if gain > 0.0 {
                (left, kicks) = (there, kicks + change);
            }
            if gain < WORTH {
                break;
            }
        }
        let left = left.norm_squared();
        let better = left <= SLACK * seen.let_go && seen.tracked(left);
        Ok(better.then(|| SwingStart {
            kicks: Some(kicks),
            machine: kicked(still, &kicks),
            still: still.clone(),
            shown: seen.shown(left),
            seen: Some(seen),
        }))
    }
}

/// The step of Gauss and Newton.
fn step(response: &DMatrix<f64>, base: &DVector<f64>) -> Kicks {
    let normal = response.transpose() * response + DMatrix::identity(KICKS, KICKS) * RIDGE;
    let solved = normal.cholesky().map(|factor| -factor.solve(&(response.transpose() * base)));
    solved.map_or_else(Kicks::zeros, |step| Kicks::from_iterator(step.iter().copied()))
}

/// The start that a log shows: as let go, if that shows the recorded swing or no kicks do, else kicked;
/// the same log's start under a model that is `like` this one saves most of the search. Of the `same` model
/// at values nearby a release that did not show the swing is not tried again; a model that is complete
/// at last must be seen to show it, better than any kicks.
///
/// # Errors
/// A run that broke down.
pub fn as_seen(
    simulator: &Simulator,
    released: Mechanism,
    log: &Log,
    like: Option<&SwingStart>,
    same: bool,
) -> Result<SwingStart, Halt> {
    let still = still(simulator, &released)?;
    let judge = |seen: f64| {
        let log = log.part(0..((seen / log.interval) as usize).min(log.samples));
        SwingJudge { simulator, log }
    };
    let whole = judge(SEEN);
    let known = like.and_then(|like| Some((like.kicks?, like.seen.clone()?)));
    let met = |left: &DVector<f64>| left.norm_squared() <= SHOWN * left.len() as f64;
    let release = if same && known.is_some() { None } else { Some(whole.look(&released)?) };
    if let Some((kicks, seen)) = known
        && !release.as_ref().is_some_and(met)
    {
        let left = whole.look(&kicked(&still, &kicks))?;
        if seen.tracked(left.norm_squared())
            && let Some(start) = whole.nearer(&still, kicks, left, seen)?
        {
            return Ok(start);
        }
    }
    let left = release.map_or_else(|| whole.look(&released), Ok)?;
    let released = SwingStart { kicks: None, machine: released, still, shown: true, seen: None };
    if met(&left) {
        return Ok(released);
    }
    let (let_go, quiet) = (left.norm_squared(), whole.look(&released.still)?.norm_squared());
    let seen = KickedMachine { response: DMatrix::zeros(0, 0), let_go, quiet };
    let released = SwingStart { shown: seen.shown(let_go), ..released };
    let still = &released.still;
    let mut kicks = Kicks::zeros();
    for judge in FIRST.map(judge) {
        let Some(found) = judge.first(&released, kicks)? else { return Ok(released) };
        kicks = found;
    }
    let left = whole.look(&kicked(still, &kicks))?;
    let seen = KickedMachine { response: whole.response(still, &kicks, &left)?, ..seen };
    Ok(whole.nearer(still, kicks, left, seen)?.unwrap_or(released))
}

/// What a log's pose shows of a swing that a simulated one does not, in units of its sensors' noise.
fn swing(log: &Log, simulated: &Log, sensors: &Sensors) -> DVector<f64> {
    let filter = ZeroPhase::butterworth(4, ERROR_CORNER, log.interval);
    let channels = (0..3).filter_map(|k| {
        let channel = Channel::Pose(k);
        let unit = noise(sensors, channel)?;
        let difference: Vec<f64> =
            log.get(channel)?.iter().zip(simulated.get(channel)?).map(|(a, b)| a - b).collect();
        Some(filter.faster(&difference).into_iter().map(move |fast| fast / unit))
    });
    DVector::from_vec(channels.flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A worn joint beside a ripple that was not yet there left a fifth of the swing's square, and paid for
    /// it twenty times what a model pays that has lost the swing: it was taken for one that shows it.
    #[test]
    fn a_start_that_misses_a_third_of_the_swing_has_lost_it() {
        let seen = |let_go, quiet| KickedMachine { response: DMatrix::zeros(0, 0), let_go, quiet };
        let worn = seen(14_100.0, 63_131.0);
        assert!(worn.tracked(14_100.0) && !worn.shown(14_100.0));
        // Kicks that are of the recorded swing, and leave half of its square.
        let kicked = seen(171_148.0, 71_775.0);
        assert!(kicked.tracked(37_575.0) && !kicked.shown(37_575.0));
        assert!(kicked.shown(0.2f64.powi(2) * 71_775.0));
    }
}
