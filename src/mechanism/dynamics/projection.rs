//! Bodies put back to where rigid joints and prescribed drives hold them.

use super::{Dynamics, Rigid};
use crate::mechanism::equations::rows::{Row, angle_row, prismatic_rows, revolute_rows};
use crate::mechanism::equations::telescope::Telescope;
use crate::mechanism::{BodyState, Command, Evaluation, Mechanism, angle_near};
use nalgebra::Vector3;

/// A condition on places and rates: its derivative by the two bodies' places, by how much it is missed, and
/// the rate that it prescribes.
struct Condition {
    row: Row,
    missed: f64,
    rate: f64,
}

impl Dynamics {
    /// Takes out of places and velocities what integrating accelerations over one step left in the rigid joints
    /// and in drives that prescribe their coordinate: each by the smallest change, measured by the masses (one
    /// Gauss–Newton step; what is left is the square of what was missed). `shifts` is given what the bodies moved
    /// by (m, m, rad), added to what it holds; `out` the commands at time `t` (s). Pairs of bodies on one slide are
    /// where [`place`](Self::place) has put them: on it.
    pub fn project(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        states: &mut [BodyState],
        shifts: &mut [Vector3<f64>],
        out: &mut Evaluation,
    ) {
        out.t = t;
        if self.prescribes {
            out.command(mechanism);
        }
        for g in 0..self.groups.len() {
            self.project_group(g, mechanism, states, shifts, &out.commands);
        }
    }

    fn project_group(
        &mut self,
        g: usize,
        mechanism: &Mechanism,
        states: &mut [BodyState],
        shifts: &mut [Vector3<f64>],
        commands: &[Command],
    ) {
        let conditions = self.conditions(g, mechanism, states, commands);
        let change = |dynamics: &mut Self, bias: &dyn Fn(&Condition) -> f64, from| {
            let rows = conditions.iter().map(|c| Row { bias: bias(c), ..c.row });
            dynamics.constraints.rows.clear();
            dynamics.constraints.rows.extend(rows);
            dynamics.constraints.usual = dynamics.groups[g].weakest();
            let mut changed: Vec<Vector3<f64>> = from;
            dynamics.constraints.solve(&dynamics.inverse_masses, &mut changed);
            changed
        };
        let by = change(self, &|c| c.missed, vec![Vector3::zeros(); states.len()]);
        let twists: Vec<_> = states.iter().map(|state| state.twist).collect();
        let twists = change(self, &|c| -c.rate, twists);
        for (i, state) in states.iter_mut().enumerate() {
            *state = BodyState { twist: twists[i], ..state.displaced(by[i]) };
            shifts[i] += by[i];
        }
    }

    fn conditions(
        &self,
        g: usize,
        mechanism: &Mechanism,
        states: &[BodyState],
        commands: &[Command],
    ) -> Vec<Condition> {
        let mut conditions = Vec::new();
        let mut hold = |row, missed, rate| conditions.push(Condition { row, missed, rate });
        for joint in &self.groups[g].joints {
            match *joint {
                Rigid::Prismatic(i) => {
                    let joint = &mechanism.prismatics[i];
                    let state = Telescope::new(joint, states);
                    let [side, angle, along] = prismatic_rows(&state, joint.bodies());
                    let [across, turned] = joint.come_off(states);
                    hold(side, across, 0.0);
                    hold(angle, turned, 0.0);
                    if let Some(drive) = self.prescribed[i] {
                        hold(along, state.length - commands[drive].position, commands[drive].rate);
                    }
                }
                Rigid::Revolute(i) => {
                    let joint = &mechanism.revolutes[i];
                    let gap = joint.journal.frame(states).centre - joint.ring.frame(states).centre;
                    for (row, missed) in revolute_rows(joint, states).into_iter().zip(gap.iter()) {
                        hold(row, *missed, 0.0);
                    }
                }
                // An inertia, no condition.
                Rigid::Rotor(_) => {}
                Rigid::Angle { drive, joint } => {
                    let joint = &mechanism.revolutes[joint];
                    let Command { position, rate, .. } = commands[drive];
                    let angle = angle_near(joint.rotation(states), position);
                    hold(angle_row(joint), angle - position, rate);
                }
            }
        }
        conditions
    }
}
