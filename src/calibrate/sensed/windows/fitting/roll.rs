//! A mechanism without clearance rolled along from a start, by the classical method of Runge and Kutta on the
//! states of its bodies: `ẋ = v`, `v̇ = a(x, v, t)`, a by Gauss' principle. Over a window of some seconds joints
//! drift apart by less than 1e-9 of their size.

use super::pose::Pose;
use crate::mechanism::{BodyState, Dynamics, Evaluation, Mechanism};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// Longest step in s: a swing of 5 rad/s is wrong by `(ωh)⁴/120`, 1e-10 of it.
pub const LONGEST: f64 = 2.1e-3;

/// Longest step of a damper in units of what an explicit step of first order stands: this method is stable up
/// to 2.78 of them.
const STIFF: f64 = 2.0;

/// When readings are wanted: at `rows + 1` instants from `first` (s) on.
#[derive(Clone, Copy, Debug)]
pub struct ReadingTimes {
    /// Time of the first reading in s, as commands and loads see it.
    pub first: f64,
    /// Time between two readings in s.
    pub interval: f64,
    /// Intervals.
    pub count: usize,
}

/// Bodies as numbers: positions and angles, then their rates.
type BodyNumbers = Vec<[Vector3<f64>; 2]>;

/// What the sensors with these indices show, row by row; none where the machine breaks down.
pub fn roll(
    mechanism: &Mechanism,
    pose: &Pose,
    rows: ReadingTimes,
    sensors: &[usize],
) -> Option<Vec<f64>> {
    let mut machine = mechanism.clone();
    for (body, (state, angle)) in
        machine.bodies.iter_mut().zip(pose.states.iter().zip(&pose.angles))
    {
        (body.start, body.angle) = (*state, *angle);
    }
    machine.epoch = rows.first;
    let longest = machine.loads.iter().filter_map(|load| load.longest_step(&machine));
    let longest = longest.fold(LONGEST, |least, step| least.min(STIFF * step));
    let steps = (rows.interval / longest).ceil().max(1.0) as usize;
    let h = rows.interval / steps as f64;
    let mut roller = Roller {
        dynamics: Dynamics::new(&machine),
        now: Evaluation::new(&machine),
        states: pose.states.clone(),
        machine: &machine,
    };
    let mut at: BodyNumbers = pose
        .states
        .iter()
        .zip(&pose.angles)
        .map(|(state, angle)| [state.position.push(*angle), state.twist])
        .collect();
    let mut shown = Vec::with_capacity((rows.count + 1) * sensors.len());
    let mut read = |roller: &Roller, at: &BodyNumbers| {
        let angles: Vec<f64> = at.iter().map(|[place, _]| place.z).collect();
        for &i in sensors {
            let sensor = &machine.sensors[i];
            let reading = sensor.reading(&machine, &roller.states, &angles, &roller.now);
            shown.push(sensor.scale * reading + sensor.offset);
        }
    };
    for row in 0..=rows.count {
        for step in 0..steps {
            let t = (row * steps + step) as f64 * h;
            let k1 = roller.rates(t, &at);
            if step == 0 {
                read(&roller, &at);
                if row == rows.count {
                    break;
                }
            }
            let k2 = roller.rates(t + 0.5 * h, &moved(&at, &k1, 0.5 * h));
            let k3 = roller.rates(t + 0.5 * h, &moved(&at, &k2, 0.5 * h));
            let k4 = roller.rates(t + h, &moved(&at, &k3, h));
            for (i, now) in at.iter_mut().enumerate() {
                for k in 0..2 {
                    now[k] += (k1[i][k] + 2.0 * (k2[i][k] + k3[i][k]) + k4[i][k]) * (h / 6.0);
                }
            }
            roller.place(&at);
            roller.dynamics.remember(&machine, t + h, &roller.states);
        }
    }
    shown.iter().all(|value| value.is_finite()).then_some(shown)
}

fn moved(at: &BodyNumbers, rates: &BodyNumbers, h: f64) -> BodyNumbers {
    at.iter().zip(rates).map(|(at, rate)| [at[0] + rate[0] * h, at[1] + rate[1] * h]).collect()
}

struct Roller<'a> {
    machine: &'a Mechanism,
    dynamics: Dynamics,
    now: Evaluation,
    states: Vec<BodyState>,
}

impl Roller<'_> {
    fn place(&mut self, at: &BodyNumbers) {
        for (state, [place, twist]) in self.states.iter_mut().zip(at) {
            let position = Vector2::new(place.x, place.y);
            *state = BodyState { position, rotation: UnitComplex::new(place.z), twist: *twist };
        }
    }

    fn rates(&mut self, t: f64, at: &BodyNumbers) -> BodyNumbers {
        self.place(at);
        self.dynamics.forces(self.machine, t, &self.states, &mut self.now);
        self.dynamics.accelerations(self.machine, &self.states, &mut self.now);
        at.iter().zip(&self.now.accelerations).map(|([_, twist], a)| [*twist, *a]).collect()
    }
}
