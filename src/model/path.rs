//! The machine without clearance along its motion, before anything is simulated: inverse kinematics, reach,
//! singular poses, branches, and joints that do not close.

use super::commands::Tabulated;
use super::ideal::Ideal;
use crate::mechanism::{
    BodyState, Command, Drive, Hold, Imposed, JointIndex, Loop, Mechanism, OpenJoint, Stuck,
    Tracker, angle_near,
};
use crate::scenario::{Problem, Scenario};

/// Largest part of a turn, in rad, or of the mechanism's size, that a drive goes between two poses that are
/// looked at: a toggle of a loop is broader than this.
const STRIDE: f64 = 0.02;

/// Most poses of a small machine that are looked at: some quarter of a minute, and an hour of a crank that turns once
/// a second.
const MOST: f64 = 1_000_000.0;

/// Most of them in a second of the motion: those of a crank that turns 19 000 times a minute.
const MOST_A_SECOND: f64 = 1e5;

/// As many as any motion gets, however short: half a second of computing.
const ANY: f64 = 2e4;

/// Bodies of a small machine. More have fewer poses and samples, for the same work: equations of all bodies are solved
/// for each of them.
const SMALL: f64 = 3.0;

/// Share of a small machine's poses that this one gets.
fn share(mechanism: &Mechanism) -> f64 {
    (SMALL / mechanism.bodies.len() as f64).powi(3).min(1.0)
}

/// Fewest poses that are looked at, for motions that nothing is known of beforehand.
const FEWEST: usize = 400;

/// Instants in a second of the motion at which commands are read to choose the poses: a move that begins and
/// ends between two of them goes unseen.
const READS: f64 = 1000.0;

/// Most of these instants: more than three hours have fewer in a second.
const MOST_READS: f64 = 1e7;

/// What the machine without clearance goes through.
///
/// ```
/// use freeplay::prelude::*;
///
/// let mut machine = assemble(&Scenario::load(None, &[])?)?;
/// let path = machine.driven_path().unwrap();
/// assert!(path.stuck.is_none() && path.breaches.is_empty(), "three legs reach all of the paper's circle");
/// assert!(path.used.iter().all(|[shortest, longest]| 0.0 < *shortest && shortest < longest));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// When (s) it was looked at.
    pub instants: Vec<f64>,
    /// Time (s) beyond which it was not looked at, because its poses are too many.
    pub unseen: Option<f64>,
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
            instants: Vec::new(),
            unseen: None,
            stuck: None,
        };
        let mut loops: Vec<Loop> = mechanism.loops();
        loops.retain(|of| mechanism.has_branches(of));
        // Signed areas of the loops in the first pose.
        let mut first: Option<Vec<f64>> = None;
        let mut before: Option<Hold> = None;
        let mut worst: Vec<Option<(f64, f64, f64)>> = vec![None; drives];
        let mut last = Vec::new();
        let mut reads = CommandReads::new(&mechanism, duration);
        let most = (MOST_A_SECOND * duration).clamp(ANY, MOST) * share(&mechanism);
        let most = (most as usize).max(2 * FEWEST);
        'path: while reads.advance() {
            for (i, command) in reads.commands.iter().enumerate() {
                if mechanism.actuators[i].drive != Drive::Effort {
                    let range = ranges.get(i).copied().flatten();
                    found.reached(i, reads.t, command, range, &mut worst[i]);
                }
            }
            for t in reads.poses() {
                if found.instants.len() == most {
                    found.unseen = found.instants.last().copied();
                    break 'path;
                }
                let Some(states) = ideal.states(t) else {
                    found.stuck = Some((t, last));
                    break 'path;
                };
                found.instants.push(t);
                last = commands_at(&mechanism, t).iter().map(|command| command.position).collect();
                if let Some(hold) = mechanism.hold(&states) {
                    found.held(t, hold, before);
                    before = Some(hold);
                }
                let now: Vec<f64> =
                    loops.iter().map(|of| mechanism.signed_area(of, &states)).collect();
                found.turn(t, &loops, &now, first.get_or_insert_with(|| now.clone()));
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

    /// Enters loops whose signed area has not the sign that it had at `first`.
    fn turn(&mut self, t: f64, loops: &[Loop], now: &[f64], first: &[f64]) {
        for (of, (now, first)) in loops.iter().zip(now.iter().zip(first)) {
            if first * now < 0.0 && !self.turned.iter().any(|(turned, _)| turned == of) {
                self.turned.push((of.clone(), t));
            }
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

/// Commands read at equal intervals from 0 to the end, which choose poses between which no drive goes farther
/// than a stride, however long and uneven the motion is.
struct CommandReads<'a> {
    mechanism: &'a Mechanism,
    size: f64,
    /// Time of the last read and time between two, s.
    t: f64,
    interval: f64,
    /// Number of the next read, and of the last one.
    next: usize,
    last: usize,
    /// Commands at the last read.
    commands: Vec<Command>,
    /// Strides of the drive that went farthest, and reads, since the last pose.
    way: f64,
    rests: usize,
    /// Strides between the last two reads.
    step: f64,
}

impl<'a> CommandReads<'a> {
    fn new(mechanism: &'a Mechanism, duration: f64) -> Self {
        let last = (READS * duration).ceil().clamp(10.0 * FEWEST as f64, MOST_READS);
        Self {
            mechanism,
            size: mechanism.size(),
            t: 0.0,
            interval: duration / last,
            next: 0,
            last: last as usize,
            commands: commands_at(mechanism, 0.0),
            way: 0.0,
            rests: 0,
            step: 0.0,
        }
    }

    /// Reads the commands once more; false after the last read.
    fn advance(&mut self) -> bool {
        if self.next > self.last {
            return false;
        }
        self.t = self.interval * self.next as f64;
        let commands = commands_at(self.mechanism, self.t);
        let ends = self.mechanism.actuators.iter().zip(self.commands.iter().zip(&commands));
        self.step = ends.fold(0.0f64, |most, (actuator, (a, b))| {
            let scale = match actuator.joint {
                JointIndex::Revolute(_) => STRIDE,
                JointIndex::Prismatic(_) => STRIDE * self.size,
            };
            let way = (b.position - a.position).abs() / scale;
            if actuator.drive == Drive::Effort { most } else { most.max(way) }
        });
        self.way += self.step;
        self.rests += 1;
        self.next += 1;
        self.commands = commands;
        true
    }

    /// The poses to look at since the read before: none yet, one, or several where commands are faster than
    /// they are read.
    fn poses(&mut self) -> impl Iterator<Item = f64> + use<> {
        // Before the next read they would have gone farther than a stride.
        let due = self.way + self.step > 1.0
            || self.rests * FEWEST >= self.last
            || self.next == 1
            || self.next > self.last;
        let pieces = if due { self.step.ceil().max(1.0) as usize } else { 0 };
        if due {
            (self.way, self.rests) = (0.0, 0);
        }
        let (t, part) = (self.t, self.interval / pieces.max(1) as f64);
        (0..pieces).rev().map(move |i| t - part * i as f64)
    }
}

/// Error in m or rad of a table of the inverse kinematics that is aimed at.
const FINE: f64 = 1e-11;

/// Error below which a finer table that is no better is as good as rounding lets it be.
const ROUNDED: f64 = 1e-8;

/// Samples of a table in a second of a motion that lasts long; an hour and a little more of them are the most.
const SAMPLES: f64 = 1024.0;
const MOST_SAMPLES: f64 = 4_194_304.0;

/// Samples in a second of a motion that lasts for 4 to 64 s. Shorter ones have as many as those of 4 s, half a second
/// of computing for each try; longer ones as those of 64 s, until `SAMPLES` are more.
const DENSE: f64 = 16_384.0;
const DENSE_FOR: [f64; 2] = [4.0, 64.0];

/// Fewest samples in a turn of the target that make a table of it: the polynomials of the fifth degree between them
/// miss a circle by (2π/16)⁶/46080 = 8e-8 of its radius.
const SAMPLES_A_TURN: f64 = 16.0;

/// Why there is no table of the inverse kinematics.
pub(super) enum NoTable {
    /// The target goes out of reach.
    Stuck(Stuck),
    /// It turns so many times, and so many times (s) are the most that a table can hold.
    Turns { asked: f64, most: f64 },
}

impl From<Stuck> for NoTable {
    fn from(stuck: Stuck) -> Self {
        Self::Stuck(stuck)
    }
}

/// Commands that carry a target along its path for `duration` s and a little longer, and the states at the
/// start. Samples are taken ever closer until the polynomials between them miss the exact commands by less
/// than 1e-11 m or rad, or by no less than before; the table says what is left.
pub(super) fn inverse_kinematics(
    mechanism: &Mechanism,
    imposed: Imposed,
    duration: f64,
) -> Result<(Tabulated, Vec<BodyState>), NoTable> {
    let ideal = mechanism.without_clearance();
    let starts: Vec<BodyState> = ideal.bodies.iter().map(|body| body.start).collect();
    // Steps look a little beyond the end of a run.
    let until = duration * 1.001 + 1e-3;
    let drives = ideal.actuators.len();
    let dense = DENSE * until.clamp(DENSE_FOR[0], DENSE_FOR[1]) * share(mechanism);
    let most = (SAMPLES * until).max(dense).min(MOST_SAMPLES);
    if let Imposed::Target { motion, .. } = &imposed {
        let turns = until / motion.fastest_turn();
        if turns * SAMPLES_A_TURN > most {
            return Err(NoTable::Turns { asked: turns, most: most / SAMPLES_A_TURN });
        }
    }
    let (mut count, mut before) = (64, f64::INFINITY);
    loop {
        let mut tracker = Tracker::new(ideal.clone(), imposed.clone(), starts.clone(), 0.0)?;
        let first = tracker.states().to_vec();
        let mut near: Vec<f64> =
            (0..drives).map(|i| ideal.start_coordinate(ideal.actuators[i].joint)).collect();
        let interval = until / count as f64;
        let mut table =
            Tabulated { interval, drives, samples: sample(&tracker, &mut near), error: 0.0 };
        for k in 1..=count {
            let half = interval * (k as f64 - 0.5);
            tracker.advance(half)?;
            let exact = sample(&tracker, &mut near);
            tracker.advance(interval * k as f64)?;
            table.samples.extend(sample(&tracker, &mut near));
            for (drive, exact) in exact.iter().enumerate() {
                let found = table.between(k - 1, drive, 0.5);
                table.error = table.error.max((found.position - exact.position).abs());
            }
        }
        let error = table.error;
        let rounded = error < ROUNDED && error > 0.5 * before;
        if error < FINE || rounded || count as f64 >= most {
            return Ok((table, first));
        }
        before = error;
        // The error falls with the sixth power of the interval.
        let finer = (error / FINE).powf(1.0 / 6.0).clamp(1.5, 16.0);
        count = (count as f64 * finer).ceil().min(most.ceil()) as usize;
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
