//! Putting a mechanism together: states in which every joint is closed.

use super::rows::{Row, angle_row, prismatic_rows, revolute_rows};
use crate::mechanism::{Bearing, BodyState, Command, Drive, JointIndex, Mechanism, angle_near};
use nalgebra::{DMatrix, DVector, UnitComplex, Vector2, Vector3};

/// Gaps in m and rad below which a joint is closed: rounding on a machine of a metre.
const CLOSED: f64 = 1e-13;

/// Rows of all joints on the velocities of their bodies, and by how much each is open.
#[derive(Clone, Debug)]
pub(super) struct Closure {
    pub rows: Vec<Row>,
    /// Gaps in m and rad.
    pub gaps: DVector<f64>,
    /// The drive whose command a row compares with, and the command's rate, where it does so.
    pub driven: Vec<Option<usize>>,
    /// The joint that a row belongs to.
    pub joints: Vec<JointIndex>,
}

/// A joint that cannot be closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenJoint {
    /// The joint.
    pub joint: JointIndex,
    /// How far it stays open, in m (rad).
    pub gap: f64,
}

impl Mechanism {
    /// Puts the mechanism together from guessed starts, driven joints at their coordinates `t` s after the
    /// start: least squares on the joints' gaps, damped so that no step leaves the branch that the guess is
    /// nearest to (Levenberg–Marquardt), then [`close`](Self::close).
    ///
    /// # Errors
    /// If the joints cannot be closed from here: the one that stays open the farthest.
    pub fn assemble(&mut self, t: f64) -> Result<(), OpenJoint> {
        let mut commands = vec![Command::default(); self.actuators.len()];
        self.true_commands(t, &mut commands);
        let size = self.size();
        let mut states: Vec<BodyState> = self.bodies.iter().map(|b| b.start).collect();
        let mut closure = self.closure(&states, &commands);
        let mut damping = 1e-3;
        for _ in 0..500 {
            if closure.gaps.is_empty() || closure.gaps.amax() < 1e-9 * size {
                break;
            }
            let Some(shift) = closure.damped_step(states.len(), size, damping) else { break };
            // A step of a radian, or of the whole machine, means nothing: damp it.
            let far = shift.amax() > 0.5 * size;
            let moved: Vec<BodyState> = states
                .iter()
                .enumerate()
                .map(|(i, state)| BodyState {
                    position: state.position + shift.fixed_rows::<2>(3 * i),
                    rotation: state.rotation * UnitComplex::new(shift[3 * i + 2] / size),
                    ..*state
                })
                .collect();
            let next = self.closure(&moved, &commands);
            if !far && next.gaps.norm() < closure.gaps.norm() {
                (states, closure) = (moved, next);
                damping = (damping * 0.3).max(1e-12);
            } else if damping > 1e8 {
                break;
            } else {
                damping *= 4.0;
            }
        }
        for (body, state) in self.bodies.iter_mut().zip(&states) {
            body.angle = angle_near(state.rotation, body.angle);
            body.start = *state;
        }
        self.close(t).map_err(|_| {
            let worst = (0..closure.gaps.len())
                .max_by(|&a, &b| closure.gaps[a].abs().total_cmp(&closure.gaps[b].abs()));
            let joint = worst.map_or(JointIndex::Revolute(0), |row| closure.joints[row]);
            let rows = (0..closure.gaps.len())
                .filter(|&row| closure.joints[row] == joint && closure.driven[row].is_none());
            let gap = rows.fold(0.0, |gap: f64, row| gap.hypot(closure.gaps[row]));
            OpenJoint { joint, gap: if gap > 0.0 { gap } else { closure.gaps.amax() } }
        })
    }

    /// Moves the bodies' starts as little as it takes to centre every journal and to give every driven
    /// joint the coordinate and rate that it is commanded `t` s after the start (the rate of a joint that is
    /// not prescribed: just before, as a table that begins there rests till then); where nothing holds
    /// a body, it keeps its motion. Newton's method on the joints' gaps, each correction the
    /// smallest that closes the linearised ones.
    ///
    /// # Errors
    /// If the joints cannot be closed from here: what remains, in m.
    pub fn close(&mut self, t: f64) -> Result<(), f64> {
        let mut commands = vec![Command::default(); self.actuators.len()];
        self.true_commands(t, &mut commands);
        let mut states: Vec<BodyState> = self.bodies.iter().map(|b| b.start).collect();
        let mut remains = f64::INFINITY;
        for _ in 0..50 {
            let closure = self.closure(&states, &commands);
            if closure.gaps.is_empty() {
                return Ok(());
            }
            remains = closure.gaps.amax();
            if remains < CLOSED {
                break;
            }
            let Some(shift) = smallest(&closure.rows, states.len(), -closure.gaps) else { break };
            for (i, state) in states.iter_mut().enumerate() {
                state.position += shift.fixed_rows::<2>(3 * i);
                state.rotation *= UnitComplex::new(shift[3 * i + 2]);
            }
        }
        // A millionth of what matters: joints may be closed but for rounding, which grows with the machine.
        if remains.is_nan() || remains > 1e-12 * self.size().max(1.0) {
            return Err(remains);
        }
        // A drive that only pulls cannot have started the machine: it moves as commanded just before.
        let mut before = commands.clone();
        self.true_commands(t - f64::MIN_POSITIVE, &mut before);
        for ((command, before), actuator) in commands.iter_mut().zip(before).zip(&self.actuators) {
            if actuator.drive != Drive::Prescribed {
                command.rate = before.rate;
            }
        }
        let closure = self.closure(&states, &commands);
        let twists: Vec<Vector3<f64>> = states.iter().map(|state| state.twist).collect();
        let rates = closure.missing_rates(&twists, &commands);
        let change = smallest(&closure.rows, states.len(), rates).ok_or(remains)?;
        for (i, (body, state)) in self.bodies.iter_mut().zip(states).enumerate() {
            body.start = BodyState { twist: state.twist + change.fixed_rows::<3>(3 * i), ..state };
            body.angle = angle_near(state.rotation, body.angle);
        }
        Ok(())
    }

    /// The same mechanism with the start of its output body displaced by `shift` (m), as far as rigid joints and
    /// prescribed drives let it: bodies move together, by as little as that takes.
    pub fn displaced(&self, shift: Vector2<f64>) -> Self {
        let states: Vec<BodyState> = self.bodies.iter().map(|b| b.start).collect();
        let closure = self.closure(&states, &vec![Command::default(); self.actuators.len()]);
        let rigid = |i: usize| match (closure.driven[i], closure.joints[i]) {
            (Some(drive), _) => self.actuators[drive].drive == Drive::Prescribed,
            (None, JointIndex::Prismatic(i)) => !self.prismatics[i].play,
            (None, JointIndex::Revolute(i)) => matches!(self.revolutes[i].bearing, Bearing::Ideal),
        };
        let rows: Vec<Row> =
            (0..closure.rows.len()).filter(|&i| rigid(i)).map(|i| closure.rows[i]).collect();
        let held = |row: &Row| row.bodies.contains(&Some(self.output));
        let mut displaced = self.clone();
        if !rows.iter().any(held) {
            displaced.bodies[self.output].start.position += shift;
            return displaced;
        }
        // What is left of the displacement where the rows stay as they are, at its full size.
        let mut motion = DVector::zeros(3 * states.len());
        motion.fixed_rows_mut::<2>(3 * self.output).copy_from(&shift);
        let change = -(matrix(&rows, states.len()) * &motion);
        let Some(correction) = smallest(&rows, states.len(), change) else { return displaced };
        motion += correction;
        if motion.norm() < 1e-3 * shift.norm() {
            return displaced;
        }
        motion *= shift.norm() / motion.norm();
        for (i, body) in displaced.bodies.iter_mut().enumerate() {
            body.start.position += motion.fixed_rows::<2>(3 * i);
            body.start.rotation *= UnitComplex::new(motion[3 * i + 2]);
        }
        displaced
    }

    /// Rows of all joints at the given states: prismatic ones, revolute ones, driven angles.
    pub(super) fn closure(&self, states: &[BodyState], commands: &[Command]) -> Closure {
        let count = 2 * (self.prismatics.len() + self.revolutes.len()) + self.actuators.len();
        let mut closure = Closure {
            rows: Vec::with_capacity(count),
            gaps: DVector::zeros(0),
            driven: Vec::with_capacity(count),
            joints: Vec::with_capacity(count),
        };
        let mut gaps = Vec::with_capacity(count);
        let follows = |joint: JointIndex| {
            let mut actuators = self.actuators.iter();
            actuators.position(|a| a.joint == joint && a.drive != Drive::Effort)
        };
        for (i, joint) in self.prismatics.iter().enumerate() {
            let index = JointIndex::Prismatic(i);
            let telescope = joint.telescope(states);
            let [from, to] = [&joint.base, &joint.slider].map(|a| a.frame(states).centre);
            let [a, b] = [(&joint.base, 0), (&joint.slider, 1)]
                .map(|(a, side)| a.rotation(states) * joint.axes[side]);
            let [side, angle, along] = prismatic_rows(&telescope, joint.bodies());
            gaps.extend([(to - from).dot(&telescope.n), a.rotation_to(&b).angle()]);
            closure.push(index, None, [side, angle]);
            if let Some(drive) = follows(index) {
                gaps.push((to - from).dot(&telescope.u) - commands[drive].position);
                closure.push(index, Some(drive), [along]);
            }
        }
        let revolutes =
            || self.revolutes.iter().enumerate().filter(|(_, joint)| !joint.is_corner());
        for (i, joint) in revolutes() {
            let gap = joint.journal.frame(states).centre - joint.ring.frame(states).centre;
            gaps.extend([gap.x, gap.y]);
            closure.push(JointIndex::Revolute(i), None, revolute_rows(joint, states));
        }
        for (i, joint) in revolutes() {
            let index = JointIndex::Revolute(i);
            if let Some(drive) = follows(index) {
                let commanded = UnitComplex::new(commands[drive].position);
                gaps.push(commanded.rotation_to(&joint.rotation(states)).angle());
                closure.push(index, Some(drive), [angle_row(joint)]);
            }
        }
        closure.gaps = DVector::from_vec(gaps);
        closure
    }
}

impl Closure {
    /// The step of least squares on the gaps, damped: `−Jᵀ (J Jᵀ + λ)⁻¹ g`, angles as arcs at `size` m.
    fn damped_step(&self, bodies: usize, size: f64, damping: f64) -> Option<DVector<f64>> {
        let mut jacobian = matrix(&self.rows, bodies);
        for i in 0..bodies {
            jacobian.column_mut(3 * i + 2).scale_mut(1.0 / size);
        }
        let mut gram = &jacobian * jacobian.transpose();
        for i in 0..gram.nrows() {
            gram[(i, i)] += damping;
        }
        if gram.iter().chain(self.gaps.iter()).any(|x| !x.is_finite()) {
            return None;
        }
        let multipliers = gram.cholesky()?.solve(&-&self.gaps);
        Some(jacobian.transpose() * multipliers)
    }

    fn push<const N: usize>(&mut self, joint: JointIndex, drive: Option<usize>, rows: [Row; N]) {
        self.rows.extend(rows);
        self.driven.extend([drive; N]);
        self.joints.extend([joint; N]);
    }

    /// By how much each row's rate falls short of zero, or of its command's rate.
    pub fn missing_rates(&self, twists: &[Vector3<f64>], commands: &[Command]) -> DVector<f64> {
        let rate = |(row, drive): (&Row, &Option<usize>)| {
            let moving =
                row.bodies.iter().zip(&row.jacobians).fold(0.0, |sum, (body, jacobian)| {
                    sum - body.map_or(0.0, |b| jacobian.dot(&twists[b]))
                });
            moving + drive.map_or(0.0, |drive| commands[drive].rate)
        };
        DVector::from_iterator(self.rows.len(), self.rows.iter().zip(&self.driven).map(rate))
    }
}

/// Rows as a matrix on the twists of `bodies` bodies.
pub(super) fn matrix(rows: &[Row], bodies: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(rows.len(), 3 * bodies);
    for (i, row) in rows.iter().enumerate() {
        for (body, jacobian) in row.bodies.iter().zip(&row.jacobians) {
            if let Some(body) = *body {
                let mut place = matrix.fixed_view_mut::<1, 3>(i, 3 * body);
                place += jacobian.transpose();
            }
        }
    }
    matrix
}

/// The smallest motion of `bodies` bodies that changes the rows by `change`.
pub(super) fn smallest(rows: &[Row], bodies: usize, change: DVector<f64>) -> Option<DVector<f64>> {
    let matrix = matrix(rows, bodies);
    if matrix.iter().chain(change.iter()).any(|x| !x.is_finite()) {
        return None;
    }
    let factors = matrix.clone().svd(true, true);
    let mut motion = factors.solve(&change, 1e-12).ok()?;
    // Near a singular pose the factors are not exact: what they leave is solved for again.
    for _ in 0..5 {
        let left = &change - &matrix * &motion;
        if left.norm() <= 1e-13 + 1e-10 * change.norm() {
            break;
        }
        let better = &motion + factors.solve(&left, 1e-12).ok()?;
        if (&change - &matrix * &better).norm() >= left.norm() {
            break;
        }
        motion = better;
    }
    Some(motion)
}
