//! How a machine that drives hold swings in its play where a recording begins.
//!
//! Where loads keep joints in contact, bodies swing in their play for seconds, and how far a journal leans, on average too,
//! depends on that swing. Nobody knows how a machine was let go, but its swing is measured. A machine that has come to rest
//! under its first commands, and whose output is kicked twice, a quarter of a swing apart, just before the first row, swings
//! with any amplitude and phase along x, y and its angle: six numbers, found by Gauss and Newton.

use super::simulate::deviation;
use super::start::SWING;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::ERROR_CORNER;
use crate::calibrate::values::least_squares::{FitEffort, Free, least_squares};
use crate::engine::Halt;
use crate::measure::filter::ZeroPhase;
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::{DVector, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Time in s of each kick, a half sine; the last ends with the first row, the others as much before it as a quarter of a
/// swing takes.
const PULSE: f64 = 0.012;
const PULSES: usize = 2;
const APART: f64 = 0.25 / SWING;

/// Size of a kick, as the speed in m/s that the free output would take up: a fiftieth of a fall through a play of 0.1 mm.
const SIZE: f64 = 1e-3;

/// Times in s from the first row over which a swing is seen, one after another: its frequency hangs on its amplitude, which
/// takes a few periods to be seen, and most of it has died after the last.
const SEEN: [f64; 3] = [0.1, 0.25, 0.6];

/// Steps of the fit over each, at most: kicks that do what journals do on their rings are no linear matter.
const EFFORT: FitEffort = FitEffort { steps: 6, enough: 10.0, secant: true };

/// A kick, in sizes, that counts as one unit of noise: about what a release does. What does nothing stays at nothing.
const FAR: f64 = 30.0;

/// Mean square in units of noise up to which a release shows the recorded swing.
const SHOWN: f64 = 1.1;

/// Share of the squares that a machine at rest and a released one leave together up to which kicks show the recorded swing.
/// A model whose swing has another frequency lost its phase: kicks bring it nothing, rest leaves the recorded swing, a release
/// two swings.
const TRACKED: f64 = 0.25;

/// Numbers of kicks of one start.
const KICKS: usize = 3 * PULSES;

/// Kicks along x, y and the angle, pulse by pulse, as multiples of their sizes.
pub type OutputKicks = [f64; KICKS];

#[derive(Debug)]
struct KickedOutput {
    /// Greatest forces in N, N, N·m, pulse by pulse.
    forces: [Vector3<f64>; PULSES],
}

impl Load for KickedOutput {
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

/// The machine at rest with these kicks.
pub fn kicked(still: &Mechanism, kicks: &OutputKicks) -> Mechanism {
    let mut machine = still.clone();
    let body = &machine.bodies[machine.output];
    // An angular momentum as large as a speed at the radius of gyration makes it. A half sine of height 1 has the mean 2/π.
    let turning = (body.mass * body.inertia).sqrt();
    let unit = Vector3::new(body.mass, body.mass, turning) * (SIZE * FRAC_PI_2 / PULSE);
    let forces = std::array::from_fn(|pulse| {
        let own = &kicks[3 * pulse..][..3];
        unit.component_mul(&Vector3::from_column_slice(own))
    });
    machine.loads.push(Arc::new(KickedOutput { forces }));
    machine
}

/// What the sensors of a machine record of its first rows.
pub type Recorded<'a> = &'a (dyn Fn(&Mechanism, &Recording) -> Result<Recording, Halt> + Sync);

/// The kicks with which a machine that rests swings as was recorded; none where it does so as it was let go, and where no
/// kicks show the recorded swing.
///
/// # Errors
/// A run that broke down.
pub fn kicks_as_seen(
    released: &Mechanism,
    still: &Mechanism,
    recording: &Recording,
    recorded: Recorded,
) -> Result<Option<OutputKicks>, Halt> {
    let look = |machine: &Mechanism, seconds: f64| {
        let part = recording.first(seconds);
        Ok::<_, Halt>(missed(machine, &part, &recorded(machine, &part)?))
    };
    let longest = SEEN[SEEN.len() - 1];
    let release = look(released, longest)?;
    if release.norm_squared() <= SHOWN * release.len() as f64 {
        return Ok(None);
    }
    let let_go = release.norm_squared();
    let quiet = look(still, longest)?.norm_squared();
    let free = [Free { step: 1.0, bounds: [-f64::MAX, f64::MAX] }; KICKS];
    let mut kicks = vec![0.0; KICKS];
    let mut left = f64::INFINITY;
    for seconds in SEEN {
        let of = |kicks: &[f64]| {
            let seen = look(&kicked(still, kicks.try_into().ok()?), seconds).ok()?;
            let hardly = kicks.iter().map(|kick| kick / FAR);
            Some(DVector::from_iterator(seen.len() + KICKS, seen.iter().copied().chain(hardly)))
        };
        let Some(best) = least_squares(&of, &free, kicks, EFFORT, None) else { return Ok(None) };
        left = best.residual.norm_squared();
        kicks = best.values;
    }
    let tracked = left < let_go && left < TRACKED * (quiet + let_go);
    Ok(tracked.then(|| kicks.try_into().ok()).flatten())
}

/// What sensors show of a swing that simulated ones do not, in units of their noise.
fn missed(machine: &Mechanism, recording: &Recording, simulated: &Recording) -> DVector<f64> {
    let filter = ZeroPhase::butterworth(4, ERROR_CORNER, recording.interval);
    let sensors = machine.sensors.iter().enumerate().filter(|(_, sensor)| !sensor.tells());
    let columns = sensors.filter_map(|(i, sensor)| {
        let (measured, simulated) = (recording.get(i)?, simulated.get(i)?);
        let unit = deviation(sensor, measured);
        let difference: Vec<f64> = measured.iter().zip(simulated).map(|(a, b)| a - b).collect();
        Some(filter.faster(&difference).into_iter().map(move |fast| fast / unit))
    });
    DVector::from_vec(columns.flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::motion::simulate::{record, with_noise};
    use crate::calibrate::sensed::motion::start::still;
    use crate::calibrate::sensed::residuals::problem::RigProblem;

    /// A four-bar that was kicked half as hard as it is let go is found to swing as it was recorded, from its sensors alone; as
    /// it is let go it shows what it was not kicked for.
    #[test]
    fn a_recorded_swing_is_found() {
        let problem = RigProblem::planar("planar-2");
        let control = problem.control;
        let released = problem.let_go(&[]).unwrap()[0].machine().clone();
        let still = still(&released, control).unwrap().unwrap();
        let like = &problem.runs[0].recording;
        let recorded = |machine: &Mechanism, like: &Recording| record(machine, control, like, 0);
        let seen = |machine: &Mechanism| {
            with_noise(&recorded(machine, like).unwrap(), &machine.sensors, 1)
        };
        let found =
            |recording: &Recording| kicks_as_seen(&released, &still, recording, &recorded).unwrap();
        assert_eq!(found(&seen(&released)), None, "as it was let go");
        let truth = kicked(&still, &[16.0, -10.0, 4.0, 6.0, 12.0, -8.0]);
        let recording = seen(&truth).first(1.0);
        let left = |machine: &Mechanism| {
            let left = missed(machine, &recording, &recorded(machine, &recording).unwrap());
            left.norm_squared() / left.len() as f64
        };
        let kicks = found(&recording).expect("a swing that shows");
        let (before, after) = (left(&released), left(&kicked(&still, &kicks)));
        assert!(before > 2.0 && after < SHOWN, "{before} {after}");
    }
}
