//! A mechanism without clearance along a motion that leaves it no freedom: states by Newton's method from
//! the ones before, so that it stays on the branch on which it was put together.

use super::assembly::matrix;
use super::factors::Factors;
use super::rows::Row;
use crate::mechanism::motion::Motion;
use crate::mechanism::{Attachment, Body, BodyState, Command, Mechanism, angle_near};
use nalgebra::{DMatrix, DVector, Dim, Matrix, RawStorage, UnitComplex, Vector2, Vector3};
use std::sync::Arc;

/// Gaps in m and rad at which a state is closed: what Newton's method leaves on a machine of a metre.
const CLOSED: f64 = 1e-12;

/// How far in rad, or in sizes of the mechanism, Newton's method may move a predicted state. The two
/// branches of a loop are farther apart wherever it does not nearly lock.
const TRUSTED: f64 = 0.05;

/// How far in rad a body may turn in one step: well within the half turn from which a rotation alone no longer says how often
/// it went round.
const TURN: f64 = 1.0;

/// Shortest step in s, in shares of what is asked for, below which a mechanism cannot go on.
const SHORTEST: f64 = 1e-7;

/// What determines the motion.
///
/// [`Tracker`] has an example.
#[derive(Clone, Debug)]
pub enum Imposed {
    /// The commands of the drives.
    Drives,
    /// A body's axes, or a point only.
    Target {
        /// The origin of the axes, or the point.
        point: Attachment,
        /// Angle (rad) of the axes in those of their body; none of a point.
        angle: Option<f64>,
        /// Where they go: x, y and, of axes, φ.
        motion: Arc<dyn Motion>,
    },
    /// The same commands, each of a place of the machine: coordinates of the drives follow.
    Places(Vec<Place>),
}

/// A number that says where a part of a mechanism is.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// The coordinate of a drive, by its index, in m or rad.
    Drive(usize),
    /// World coordinate x of a point, m.
    X(Attachment),
    /// World coordinate y of a point, m.
    Y(Attachment),
    /// Angle of the axes of the body that carries a point, turned by a constant, rad.
    Angle(Attachment, f64),
}

impl Place {
    /// By how much a place that no drive has is off `asked`, in m or rad, and the row by which it moves.
    pub(super) fn row(&self, states: &[BodyState], asked: f64) -> Option<(Row, f64)> {
        let along = |point: &Attachment, e: Vector2<f64>| {
            let frame = point.frame(states);
            let jacobian = Vector3::new(e.x, e.y, frame.arm.perp(&e));
            let bias = (frame.arm * -(frame.spin * frame.spin)).dot(&e);
            (on(point.body, jacobian, bias), frame.centre.dot(&e) - asked)
        };
        match self {
            Place::Drive(_) => None,
            Place::X(point) => Some(along(point, Vector2::x())),
            Place::Y(point) => Some(along(point, Vector2::y())),
            Place::Angle(point, angle) => {
                let rotation = point.rotation(states) * UnitComplex::new(*angle);
                let off = UnitComplex::new(asked).rotation_to(&rotation).angle();
                Some((on(point.body, Vector3::z(), 0.0), off))
            }
        }
    }
}

/// What closes joints from one instant to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// Newton's steps, each with the derivatives where it begins: to the last digit.
    Newton,
    /// Steps with the derivatives of the instant before, as long as each leaves a tenth at most of what there was (the chord
    /// method: C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations, 5.4): a third of the time, and gaps of
    /// 1e-12 m, which is nothing beside what sensors see.
    Chord,
}

/// Largest share of a gap that a step with old derivatives may leave: what leaves more takes more of them than new ones cost.
const SLOW: f64 = 0.1;

/// A mechanism at one instant of its motion.
///
/// ```
/// use freeplay::mechanism::{Imposed, Tracker};
/// use freeplay::prelude::*;
///
/// let mut machine = assemble(&Scenario::load(None, &[])?)?;
/// let tight = machine.mechanism.without_clearance();
/// let states = machine.ideal.states(0.0).unwrap();
/// let mut tracker = Tracker::new(tight, Imposed::Drives, states, 0.0).unwrap();
/// tracker.advance(0.02).unwrap();
/// let [tracked, known] = [tracker.states().to_vec(), machine.ideal.states(0.02).unwrap()]
///     .map(|states| machine.mechanism.output_state(&states).position);
/// assert!((tracked - known).norm() < 1e-8, "both say where the platform is");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tracker {
    mechanism: Mechanism,
    imposed: Imposed,
    closing: Closing,
    /// Size of the mechanism in m: its largest distance of two points of a body.
    size: f64,
    t: f64,
    states: Vec<BodyState>,
    /// Angle of each body in rad, whole turns included.
    angles: Vec<f64>,
    accelerations: DVector<f64>,
    /// The rows that determine the present state, and their factors.
    rows: Vec<Row>,
    factors: Factors,
}

/// Where a mechanism cannot follow its motion any further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuck {
    /// Time in s of the last state that could be reached.
    pub t: f64,
}

/// Conditions on the bodies at one instant.
struct System {
    rows: Vec<Row>,
    gaps: DVector<f64>,
    rates: DVector<f64>,
    accelerations: DVector<f64>,
}

/// Closed states, and the conditions on them.
type Closed = (Vec<BodyState>, System);

impl Tracker {
    /// `mechanism` has ideal joints; `states` are near its pose at time `t` (s), and are closed there.
    ///
    /// # Errors
    /// If that pose cannot be reached from there.
    pub fn new(
        mechanism: Mechanism,
        imposed: Imposed,
        states: Vec<BodyState>,
        t: f64,
    ) -> Result<Self, Stuck> {
        let size = mechanism.size();
        let accelerations = DVector::zeros(3 * states.len());
        let turned = |(body, state): (&Body, &BodyState)| angle_near(state.rotation, body.angle);
        let angles = mechanism.bodies.iter().zip(&states).map(turned).collect();
        let factors = Factors::of(DMatrix::zeros(0, 0));
        let (closing, rows) = (Closing::Newton, Vec::new());
        let mut tracker = Self {
            mechanism,
            imposed,
            closing,
            size,
            t,
            states,
            angles,
            accelerations,
            rows,
            factors,
        };
        let closed = tracker.close(tracker.states.clone(), t, f64::INFINITY).ok_or(Stuck { t })?;
        tracker.accept(closed, t).ok_or(Stuck { t })?;
        Ok(tracker)
    }

    /// The same, closed in another way from here on.
    pub fn closing(self, closing: Closing) -> Self {
        Self { closing, ..self }
    }

    /// Time in s of the present state.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// States of all bodies.
    pub fn states(&self) -> &[BodyState] {
        &self.states
    }

    /// Angle of each body in rad, whole turns included: from that of its start on.
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// The mechanism that moves.
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// Acceleration of body `index` (m/s², m/s², rad/s²).
    pub fn acceleration(&self, index: usize) -> Vector3<f64> {
        self.accelerations.fixed_rows::<3>(3 * index).into()
    }

    /// Goes to time `t` in s, forward or back, in steps that Newton's method trusts.
    ///
    /// # Errors
    /// Where the mechanism cannot go on; the tracker then stays at the last state reached.
    pub fn advance(&mut self, t: f64) -> Result<(), Stuck> {
        let whole = (t - self.t).abs();
        let mut step = t - self.t;
        while self.t != t {
            let left = t - self.t;
            if step.abs() >= left.abs() * (1.0 - 1e-9) {
                step = left;
            }
            let next = if step == left { t } else { self.t + step };
            let accepted = self
                .predicted(next - self.t)
                .and_then(|states| self.close(states, next, TRUSTED))
                .and_then(|closed| self.accept(closed, next));
            match accepted {
                Some(()) => step *= 2.0,
                None if step.abs() < SHORTEST * whole => return Err(Stuck { t: self.t }),
                None => step *= 0.5,
            }
        }
        Ok(())
    }

    /// States some time `tau` (s) on as they move now; none where a body turns [too far](TURN) until then.
    fn predicted(&self, tau: f64) -> Option<Vec<BodyState>> {
        let moved = |(i, state): (usize, &BodyState)| {
            let acceleration = self.acceleration(i);
            let turn = (state.twist.z + 0.5 * acceleration.z * tau) * tau;
            (turn.abs() <= TURN).then(|| state.moved(acceleration, Vector3::zeros(), tau))
        };
        self.states.iter().enumerate().map(moved).collect()
    }

    /// Closed states at time `t` near the given ones, if there are any no farther than `trusted`, and the conditions on them.
    fn close(&self, mut states: Vec<BodyState>, t: f64, trusted: f64) -> Option<Closed> {
        let mut moved = DVector::zeros(3 * states.len());
        let (mut own, mut before) = (None, f64::INFINITY);
        for pass in 0..25 {
            let system = self.system(&states, t);
            let gap = system.gaps.amax();
            if gap < CLOSED && pass > 0 {
                return Some((states, system));
            }
            if self.closing == Closing::Newton || gap > SLOW * before {
                own = Some(Factors::of(finite(matrix(&system.rows, states.len()))?));
            }
            before = gap;
            let factors = own.as_ref().unwrap_or(&self.factors);
            let shift = finite(factors.solve(&-&system.gaps)?)?;
            moved += &shift;
            let far = moved.iter().enumerate().fold(0.0f64, |far, (i, x)| {
                far.max(if i % 3 == 2 { x.abs() } else { x.abs() / self.size })
            });
            if !far.is_finite() || far > trusted || far > 1e3 {
                return None;
            }
            for (i, state) in states.iter_mut().enumerate() {
                state.position += shift.fixed_rows::<2>(3 * i);
                state.rotation *= UnitComplex::new(shift[3 * i + 2]);
            }
        }
        None
    }

    /// Takes closed states, with the velocities and accelerations that belong to them.
    fn accept(&mut self, (mut states, system): Closed, t: f64) -> Option<()> {
        let factors = Factors::of(finite(matrix(&system.rows, states.len()))?);
        let rates = finite(factors.solve(&system.rates)?)?;
        for (i, state) in states.iter_mut().enumerate() {
            state.twist = rates.fixed_rows::<3>(3 * i).into();
        }
        // Biases depend on the velocities, and rows do not.
        let system = self.system(&states, t);
        self.accelerations = finite(factors.solve(&system.accelerations)?)?;
        for ((angle, before), now) in self.angles.iter_mut().zip(&self.states).zip(&states) {
            *angle = angle_near(now.rotation, *angle + before.rotation.angle_to(&now.rotation));
        }
        (self.states, self.t) = (states, t);
        (self.rows, self.factors) = (system.rows, factors);
        Some(())
    }

    /// The rows that determine the present state, those of joints in their order, then what is imposed; and their factors.
    pub(super) fn determining(&self) -> (&[Row], &Factors) {
        (&self.rows, &self.factors)
    }

    /// Whether drives' coordinates impose the motion.
    pub(super) fn by_drives(&self) -> bool {
        matches!(self.imposed, Imposed::Drives)
    }

    fn system(&self, states: &[BodyState], t: f64) -> System {
        let mut commands = vec![Command::default(); self.mechanism.actuators.len()];
        self.mechanism.true_commands(t, &mut commands);
        let closure = self.mechanism.closure(states, &commands);
        let imposed = self.asked(t, &commands);
        let count = closure.rows.len() + imposed.len();
        let mut rows = Vec::with_capacity(count);
        let [mut gaps, mut rates, mut accelerations] = [(); 3].map(|()| Vec::with_capacity(count));
        let mut push = |row: Row, gap: f64, asked: Command| {
            gaps.push(gap);
            rates.push(asked.rate);
            accelerations.push(asked.acceleration - row.bias);
            rows.push(row);
        };
        let all = || closure.rows.iter().zip(&closure.gaps).zip(&closure.driven);
        for ((row, gap), drive) in all() {
            if drive.is_none() || self.by_drives() {
                push(*row, *gap, drive.map(|drive| commands[drive]).unwrap_or_default());
            }
        }
        for (place, asked) in imposed {
            if let Place::Drive(own) = place {
                let own = all().filter(|(_, drive)| **drive == Some(own));
                own.for_each(|((row, gap), _)| push(*row, *gap, asked));
            } else if let Some((row, gap)) = place.row(states, asked.position) {
                push(row, gap, asked);
            }
        }
        let [gaps, rates, accelerations] = [gaps, rates, accelerations].map(DVector::from_vec);
        System { rows, gaps, rates, accelerations }
    }

    /// What is imposed at a time in s beside drives' own coordinates, or in place of them.
    fn asked(&self, t: f64, commands: &[Command]) -> Vec<(Place, Command)> {
        match &self.imposed {
            Imposed::Drives => Vec::new(),
            Imposed::Places(places) => {
                places.iter().copied().zip(commands.iter().copied()).collect()
            }
            Imposed::Target { point, angle, motion } => {
                let at = motion.at(self.mechanism.epoch + t);
                let angle = angle.map(|angle| Place::Angle(*point, angle));
                let places = [Some(Place::X(*point)), Some(Place::Y(*point)), angle];
                let asked = |(k, place): (usize, Option<Place>)| {
                    let [position, rate, acceleration] =
                        [at.pose[k], at.rate[k], at.acceleration[k]];
                    place.map(|place| (place, Command { position, rate, acceleration }))
                };
                places.into_iter().enumerate().filter_map(asked).collect()
            }
        }
    }
}

fn on(body: Option<usize>, jacobian: Vector3<f64>, bias: f64) -> Row {
    Row { bodies: [None, body], jacobians: [Vector3::zeros(), jacobian], bias, softness: 0.0 }
}

/// Numbers, if all of them are finite.
fn finite<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(
    numbers: Matrix<f64, R, C, S>,
) -> Option<Matrix<f64, R, C, S>> {
    numbers.iter().all(|x| x.is_finite()).then_some(numbers)
}

impl Mechanism {
    /// The largest distance in m of two joints on one body, the ground included: a length to measure
    /// others by. 1 where there is none.
    pub fn size(&self) -> f64 {
        let revolutes = self.revolutes.iter().flat_map(|j| [j.ring, j.journal]);
        let prismatics = self.prismatics.iter().flat_map(|j| [j.base, j.slider]);
        let points: Vec<Attachment> = revolutes.chain(prismatics).collect();
        let mut size = 0.0f64;
        for (i, a) in points.iter().enumerate() {
            for b in &points[..i] {
                if a.body == b.body {
                    size = size.max((a.point - b.point).norm());
                }
            }
            if a.body.is_some() {
                size = size.max(a.point.norm());
            }
        }
        if size > 0.0 { size } else { 1.0 }
    }
}
