//! The machine without clearance along its motion, before anything is simulated: inverse kinematics, reach,
//! singular poses, branches, and joints that do not close.

use super::commands::Tabulated;
use super::ideal::Ideal;
use crate::mechanism::{
    BodyState, Command, Commands, Drive, Hold, Imposed, JointIndex, Loop, Mechanism, OpenJoint,
    Stuck, Tracker, angle_near,
};
use crate::scenario::{Problem, Scenario};

/// Largest part of a turn, in rad, or of the mechanism's size, that a drive goes between two poses that are
/// looked at: a toggle of a loop is broader than this.
const STRIDE: f64 = 0.02;

/// Most poses that are looked at.
const MOST: usize = 20_000;

/// Fewest poses that are looked at, for motions that nothing is known of beforehand.
const FEWEST: usize = 400;

/// What the machine without clearance goes through.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenPath {
    /// Smallest and largest coordinate (m, rad) of each drive's joint.
    pub used: Vec<[f64; 2]>,
    /// Largest rate of each (m/s, rad/s).
    pub fastest: Vec<f64>,
    /// Where a drive leaves its joint's declared range the farthest: drive, time (s), coordinate.
    pub breaches: Vec<(usize, f64, f64)>,
    /// How well the drives hold the machine where they hold it worst.
    pub singular: Option<Singular>,
    /// Loops whose signed area changes sign, and when (s).
    pub turned: Vec<(Loop, f64)>,
    /// Time (s) beyond which the drives cannot go on, and the coordinate of each there.
    pub stuck: Option<(f64, Vec<f64>)>,
}

/// Where the drives hold a machine worst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singular {
    /// Time in s.
    pub t: f64,
    /// See [`Hold::share`].
    pub share: f64,
    /// The drive in question.
    pub drive: usize,
}

impl DrivenPath {
    /// Looks at `ideal` over `duration` s; `ranges` are those that drives' joints are declared to have.
    pub(super) fn of(ideal: &mut Ideal, duration: f64, ranges: &[Option<[f64; 2]>]) -> Self {
        let mechanism = ideal.mechanism().clone();
        let drives = mechanism.actuators.len();
        let mut found = Self {
            used: vec![[f64::INFINITY, f64::NEG_INFINITY]; drives],
            fastest: vec![0.0; drives],
            breaches: Vec::new(),
            singular: None,
            turned: Vec::new(),
            stuck: None,
        };
        let mut loops: Vec<Loop> = mechanism.loops();
        loops.retain(|of| mechanism.has_branches(of));
        let mut areas: Vec<f64> = Vec::new();
        let mut before: Option<Hold> = None;
        let mut worst: Vec<Option<(f64, f64, f64)>> = vec![None; drives];
        let mut last = Vec::new();
        for t in instants(&mechanism, duration) {
            let Some(states) = ideal.states(t) else {
                found.stuck = Some((t, last));
                break;
            };
            let commands = commands_at(&mechanism, t);
            for (i, command) in commands.iter().enumerate() {
                if mechanism.actuators[i].drive == Drive::Effort {
                    continue;
                }
                found.reached(i, t, command, ranges.get(i).copied().flatten(), &mut worst[i]);
            }
            last = commands.iter().map(|command| command.position).collect();
            if let Some(hold) = mechanism.hold(&states) {
                found.held(t, hold, before);
                before = Some(hold);
            }
            for (i, of) in loops.iter().enumerate() {
                let area = mechanism.signed_area(of, &states);
                match areas.get(i) {
                    None => areas.push(area),
                    Some(first)
                        if first * area < 0.0
                            && !found.turned.iter().any(|(turned, _)| turned == of) =>
                    {
                        found.turned.push((of.clone(), t));
                    }
                    Some(_) => {}
                }
            }
        }
        let breach = |(i, worst): (usize, &Option<(f64, f64, f64)>)| {
            worst.map(|(_, t, coordinate)| (i, t, coordinate))
        };
        found.breaches = worst.iter().enumerate().filter_map(breach).collect();
        found
    }

    fn reached(
        &mut self,
        drive: usize,
        t: f64,
        command: &Command,
        range: Option<[f64; 2]>,
        worst: &mut Option<(f64, f64, f64)>,
    ) {
        let [low, high] = &mut self.used[drive];
        *low = low.min(command.position);
        *high = high.max(command.position);
        self.fastest[drive] = self.fastest[drive].max(command.rate.abs());
        let Some([shortest, longest]) = range else { return };
        let excess = (shortest - command.position).max(command.position - longest);
        if excess > 0.0 && worst.is_none_or(|(most, ..)| excess > most) {
            *worst = Some((excess, t, command.position));
        }
    }

    /// A change of sign between two poses counts as a passage through a singular one.
    fn held(&mut self, t: f64, hold: Hold, before: Option<Hold>) {
        let passes = before.is_some_and(|before| before.sign * hold.sign < 0.0);
        let share = if passes { 0.0 } else { hold.share };
        if self.singular.is_none_or(|worst| share < worst.share) {
            self.singular = Some(Singular { t, share, drive: hold.drive });
        }
    }
}

fn commands_at(mechanism: &Mechanism, t: f64) -> Vec<Command> {
    let mut commands = vec![Command::default(); mechanism.actuators.len()];
    mechanism.commands.at(t, &mut commands);
    commands
}

/// Instants from 0 to `duration` between which no drive goes farther than a stride.
fn instants(mechanism: &Mechanism, duration: f64) -> Vec<f64> {
    let size = mechanism.size();
    let mut way = 0.0;
    let samples = 10 * FEWEST;
    for k in 0..samples {
        let commands = commands_at(mechanism, duration * (k as f64 + 0.5) / samples as f64);
        let fastest = commands.iter().zip(&mechanism.actuators).fold(0.0f64, |most, (c, a)| {
            let scale = match a.joint {
                JointIndex::Revolute(_) => 1.0,
                JointIndex::Prismatic(_) => size,
            };
            if a.drive == Drive::Effort { most } else { most.max(c.rate.abs() / scale) }
        });
        way += fastest * duration / samples as f64;
    }
    let count = ((way / STRIDE).ceil() as usize).clamp(FEWEST, MOST);
    (0..=count).map(|k| duration * k as f64 / count as f64).collect()
}

/// Commands that carry a target along its path for `duration` s and a little longer, and the states at the
/// start. Samples are taken ever closer until the polynomials between them miss the exact commands by less
/// than 1e-11 m or rad.
pub(super) fn inverse_kinematics(
    mechanism: &Mechanism,
    imposed: Imposed,
    duration: f64,
) -> Result<(Tabulated, Vec<BodyState>), Stuck> {
    const FINE: f64 = 1e-11;
    let ideal = mechanism.without_clearance();
    let starts: Vec<BodyState> = ideal.bodies.iter().map(|body| body.start).collect();
    // Steps look a little beyond the end of a run.
    let until = duration * 1.001 + 1e-3;
    let mut count = 64;
    loop {
        let mut tracker = Tracker::new(ideal.clone(), imposed.clone(), starts.clone(), 0.0)?;
        let first = tracker.states().to_vec();
        let mut near: Vec<f64> = (0..ideal.actuators.len())
            .map(|i| ideal.start_coordinate(ideal.actuators[i].joint))
            .collect();
        let interval = until / count as f64;
        let mut samples = vec![sample(&tracker, &mut near)];
        let mut missed = 0.0f64;
        for k in 1..=count {
            let half = interval * (k as f64 - 0.5);
            tracker.advance(half)?;
            let between = sample(&tracker, &mut near);
            tracker.advance(interval * k as f64)?;
            samples.push(sample(&tracker, &mut near));
            let table = Tabulated { interval, samples: samples[k - 1..].to_vec() };
            let mut commands = between.clone();
            table.at(0.5 * interval, &mut commands);
            for (found, exact) in commands.iter().zip(&between) {
                missed = missed.max((found.position - exact.position).abs());
            }
        }
        if missed < FINE || count >= 1 << 16 {
            return Ok((Tabulated { interval, samples }, first));
        }
        // The error falls with the sixth power of the interval.
        let finer = (missed / FINE).powf(1.0 / 6.0).clamp(1.5, 16.0);
        count = (count as f64 * finer).ceil() as usize;
    }
}

/// Coordinate, rate and acceleration of each drive's joint at the tracker's instant.
fn sample(tracker: &Tracker, near: &mut [f64]) -> Vec<Command> {
    let (mechanism, states) = (tracker.mechanism(), tracker.states());
    let commands = mechanism.actuators.iter().zip(near).map(|(actuator, near)| {
        let command = mechanism.motion_of(actuator.joint, states, |i| tracker.acceleration(i));
        match actuator.joint {
            JointIndex::Prismatic(_) => command,
            JointIndex::Revolute(i) => {
                *near = angle_near(mechanism.revolutes[i].rotation(states), *near);
                Command { position: *near, ..command }
            }
        }
    });
    commands.collect()
}

/// What to say of a mechanism that cannot be put together.
pub(super) fn open(scenario: &Scenario, mechanism: &Mechanism, open: OpenJoint) -> Problem {
    let name = mechanism.joint_name(open.joint);
    let place = scenario
        .mechanism
        .described()
        .and_then(|described| described.joints.iter().position(|joint| joint.name() == name));
    let key = place.map_or_else(|| "joint".to_owned(), |i| format!("joint.{i}"));
    let message =
        format!("\"{name}\" does not close: its two points stay {:.3} mm apart", 1e3 * open.gap);
    let help = match mechanism.closing_length(open.joint) {
        Some(closing) => {
            let body = closing.body.map_or("the ground", |i| mechanism.bodies[i].name.as_str());
            let [from, to] = closing.joints.map(|joint| mechanism.joint_name(joint));
            let [shortest, longest] = closing.range.map(|length| 1e3 * length);
            format!(
                "{body} is {:.3} mm long between {from} and {to}; {shortest:.3} to {longest:.3} mm would \
                 close the loop",
                1e3 * closing.length
            )
        }
        None => "other lengths, other `start`s or other first coordinates of the motion".to_owned(),
    };
    scenario.problem(&key, message, help)
}
