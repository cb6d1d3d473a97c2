//! Putting a mechanism together: states in which every joint is closed.

use super::rows::{Row, prismatic_rows, revolute_rows};
use super::{BodyState, Command, Mechanism};
use nalgebra::{DMatrix, DVector, UnitComplex};

/// Gaps in m and rad below which a joint is closed: rounding on a machine of a metre.
const CLOSED: f64 = 1e-13;

impl Mechanism {
    /// Moves the bodies' starts as little as it takes to centre every journal and to give every
    /// prismatic joint the length and rate that it is commanded `t` s after the start; where nothing holds
    /// a body, it keeps its motion. Newton's method on the joints' gaps, each correction the
    /// smallest that closes the linearised ones.
    ///
    /// # Errors
    /// If the joints cannot be closed from here: what remains, in m.
    pub fn close(&mut self, t: f64) -> Result<(), f64> {
        let mut commands = vec![Command::default(); self.prismatics.len()];
        self.true_commands(t, &mut commands);
        let mut states: Vec<BodyState> = self.bodies.iter().map(|b| b.start).collect();
        let mut remains = f64::INFINITY;
        for _ in 0..50 {
            let (rows, gaps) = self.closure(&states, &commands);
            if gaps.is_empty() {
                return Ok(());
            }
            remains = gaps.amax();
            if remains < CLOSED {
                break;
            }
            let Some(shift) = smallest(&rows, states.len(), -gaps) else { break };
            for (i, state) in states.iter_mut().enumerate() {
                state.position += shift.fixed_rows::<2>(3 * i);
                state.rotation *= UnitComplex::new(shift[3 * i + 2]);
            }
        }
        // A millionth of what matters: joints may be closed but for rounding.
        if remains.is_nan() || remains > 1e-12 {
            return Err(remains);
        }
        let (rows, gaps) = self.closure(&states, &commands);
        let mut rates = DVector::zeros(gaps.len());
        for (rate, row) in rates.iter_mut().zip(&rows) {
            for (body, jacobian) in row.bodies.iter().zip(&row.jacobians) {
                *rate -= body.map_or(0.0, |b| jacobian.dot(&states[b].twist));
            }
        }
        // The last of a prismatic joint's three rows is its length.
        for (command, rate) in commands.iter().zip(rates.as_mut_slice().chunks_mut(3)) {
            rate[2] += command.rate;
        }
        let change = smallest(&rows, states.len(), rates).ok_or(remains)?;
        for (i, (body, state)) in self.bodies.iter_mut().zip(states).enumerate() {
            body.start = BodyState { twist: state.twist + change.fixed_rows::<3>(3 * i), ..state };
        }
        Ok(())
    }

    /// Rows of all joints, prismatic ones first, and by how much each is open (m, rad).
    fn closure(&self, states: &[BodyState], commands: &[Command]) -> (Vec<Row>, DVector<f64>) {
        let (mut rows, mut gaps) = (Vec::new(), Vec::new());
        for (joint, command) in self.prismatics.iter().zip(commands) {
            let bodies = [joint.cylinder.body, joint.rod.body];
            let telescope = joint.telescope(states);
            let [from, to] = [&joint.cylinder, &joint.rod].map(|a| a.frame(states).centre);
            let [a, b] = [&joint.cylinder, &joint.rod].map(|a| a.rotation(states));
            rows.extend(prismatic_rows(&telescope, bodies));
            gaps.extend([
                (to - from).dot(&telescope.n),
                a.rotation_to(&b).angle(),
                (to - from).dot(&telescope.u) - command.length,
            ]);
        }
        for joint in &self.revolutes {
            rows.extend(revolute_rows(joint, states));
            let gap = joint.journal.frame(states).centre - joint.ring.frame(states).centre;
            gaps.extend([gap.x, gap.y]);
        }
        (rows, DVector::from_vec(gaps))
    }
}

/// The smallest motion of `bodies` bodies that changes the rows by `change`.
fn smallest(rows: &[Row], bodies: usize, change: DVector<f64>) -> Option<DVector<f64>> {
    let mut matrix = DMatrix::zeros(rows.len(), 3 * bodies);
    for (i, row) in rows.iter().enumerate() {
        for (body, jacobian) in row.bodies.iter().zip(&row.jacobians) {
            if let Some(body) = *body {
                let mut place = matrix.fixed_view_mut::<1, 3>(i, 3 * body);
                place += jacobian.transpose();
            }
        }
    }
    matrix.svd(true, true).solve(&change, 1e-12).ok()
}
