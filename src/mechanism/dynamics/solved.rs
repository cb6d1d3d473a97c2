//! The accelerations and joint forces of rigid joints that are solved together.

use super::Dynamics;
use crate::mechanism::equations::constraints::{Constraints, Rigid};
use crate::mechanism::equations::rows::{angle_row, prismatic_rows, revolute_rows};
use crate::mechanism::{BodyState, Evaluation, Mechanism};
use nalgebra::Vector2;

impl Dynamics {
    /// Accelerations and joint forces of one group.
    pub(super) fn solve_group(
        &mut self,
        g: usize,
        mechanism: &Mechanism,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        let rows = &mut self.constraints.rows;
        rows.clear();
        for joint in &self.groups[g].joints {
            match *joint {
                Rigid::Prismatic(i) => {
                    let [side, angle, mut along] =
                        prismatic_rows(&self.prismatics[i], mechanism.prismatics[i].bodies());
                    rows.extend([side, angle]);
                    if let Some(drive) = self.prescribed[i] {
                        along.bias -= out.commands[drive].acceleration;
                        rows.push(along);
                    }
                }
                Rigid::Revolute(i) => rows.extend(revolute_rows(&mechanism.revolutes[i], states)),
                Rigid::Rotor(i) => {
                    let rotor = &mechanism.rotors[i];
                    rows.push(rotor.row(&mechanism.revolutes[rotor.joint]));
                }
                Rigid::Angle { drive, joint } => {
                    let mut row = angle_row(&mechanism.revolutes[joint]);
                    row.bias -= out.commands[drive].acceleration;
                    rows.push(row);
                }
            }
        }
        self.constraints.usual = self.groups[g].weakest();
        self.constraints.solve(&self.inverse_masses, &mut out.accelerations);
        let Constraints { rank, weakest, .. } = self.constraints;
        self.singular |= self.groups[g].nearly_singular(rank, weakest);
        let mut multipliers = self.constraints.multipliers.iter();
        let mut next = || multipliers.next().copied().unwrap_or_default();
        for joint in &self.groups[g].joints {
            match *joint {
                Rigid::Prismatic(i) => {
                    let _side_and_angle = [next(), next()];
                    if let Some(drive) = self.prescribed[i] {
                        out.drive_forces[drive] = next();
                    }
                }
                Rigid::Revolute(i) => {
                    let force = Vector2::new(next(), next());
                    out.reactions[i] = force;
                    out.contacts[i].normal_force = force.norm();
                }
                Rigid::Rotor(_) => {
                    let _torque = next();
                }
                Rigid::Angle { drive, .. } => out.drive_forces[drive] = next(),
            }
        }
    }
}
