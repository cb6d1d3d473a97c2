//! Forces and accelerations of a mechanism at a given state, without any engine.
//!
//! Bodies that rigid joints hold together form a group; in each group the constrained
//! accelerations follow from Gauss' principle,
//!
//! `a = M⁻¹ (f + Jᵀ λ)`, `(J M⁻¹ Jᵀ) λ = −bias − J M⁻¹ f`
//!
//! (e.g. Featherstone, *Rigid Body Dynamics Algorithms*, 2008, §3.2). Groups touch each other
//! through clearance joints only, so each is a small dense system: a leg has three rows.

use super::rows::{PrismaticState, Row, revolute_rows};
use super::{Bearing, BodyState, Command, Drive, Mechanism, state_of};
use crate::contact::Contact;
use nalgebra::Vector3;

/// The equations of motion of a mechanism, with the workspace that evaluating them needs.
#[derive(Clone, Debug)]
pub struct Dynamics {
    inverse_masses: Vec<Vector3<f64>>,
    weights: Vec<Vector3<f64>>,
    /// Joints of each group, the joints of a group side by side.
    groups: Vec<Vec<RigidJoint>>,
    /// State of each prismatic joint at the state last asked for.
    prismatics: Vec<PrismaticState>,
    rows: Vec<Row>,
    matrix: Vec<f64>,
    multipliers: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
enum RigidJoint {
    Prismatic(usize),
    Revolute(usize),
}

/// Everything that is known of a mechanism at one instant beside its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Command of each prismatic joint.
    pub commands: Vec<Command>,
    /// Wrench of gravity, contacts and servos on each body, about its centre of mass.
    pub wrenches: Vec<Vector3<f64>>,
    /// Acceleration of each body.
    pub accelerations: Vec<Vector3<f64>>,
    /// Contact in each revolute joint; of an ideal one the size of its force.
    pub contacts: Vec<Contact>,
    /// Length of each prismatic joint in m.
    pub lengths: Vec<f64>,
    /// Force of each drive on its rod in N, positive when it pushes outward.
    pub drive_forces: Vec<f64>,
}

impl Evaluation {
    /// An evaluation of the right size, all zero.
    pub fn new(mechanism: &Mechanism) -> Self {
        let bodies = mechanism.bodies.len();
        let drives = mechanism.prismatics.len();
        Self {
            commands: vec![Command::default(); drives],
            wrenches: vec![Vector3::zeros(); bodies],
            accelerations: vec![Vector3::zeros(); bodies],
            contacts: vec![Contact::default(); mechanism.revolutes.len()],
            lengths: vec![0.0; drives],
            drive_forces: vec![0.0; drives],
        }
    }
}

impl Dynamics {
    /// The equations of motion of `mechanism`.
    pub fn new(mechanism: &Mechanism) -> Self {
        let inverse = |mass: f64, inertia: f64| Vector3::new(1.0 / mass, 1.0 / mass, 1.0 / inertia);
        let g = mechanism.gravity;
        let starts: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        Self {
            inverse_masses: mechanism.bodies.iter().map(|b| inverse(b.mass, b.inertia)).collect(),
            weights: mechanism
                .bodies
                .iter()
                .map(|b| Vector3::new(b.mass * g.x, b.mass * g.y, 0.0))
                .collect(),
            groups: groups(mechanism),
            prismatics: mechanism
                .prismatics
                .iter()
                .map(|joint| PrismaticState::new(joint, &starts))
                .collect(),
            rows: Vec::new(),
            matrix: Vec::new(),
            multipliers: Vec::new(),
        }
    }

    /// M⁻¹ of each body as the diagonal (1/kg, 1/kg, 1/(kg·m²)).
    pub fn inverse_masses(&self) -> &[Vector3<f64>] {
        &self.inverse_masses
    }

    /// Fills `out` with commands, wrenches, contacts, lengths and servo forces at time `t` (s) and
    /// the given states. Accelerations and prescribed drive forces are
    /// [`accelerations`](Self::accelerations)' business, for the same states.
    pub fn forces(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        mechanism.commands.at(t, &mut out.commands);
        out.wrenches.copy_from_slice(&self.weights);
        let wrenches = &mut out.wrenches;
        let mut add = |body: Option<usize>, wrench: Vector3<f64>| {
            if let Some(i) = body {
                wrenches[i] += wrench;
            }
        };
        for (joint, contact) in mechanism.revolutes.iter().zip(&mut out.contacts) {
            let ring = state_of(states, &joint.ring).frame(joint.ring.point);
            let journal = state_of(states, &joint.journal).frame(joint.journal.point);
            if let Bearing::Clearance(clearance) = &joint.bearing {
                let (state, forces) = clearance.forces(&ring, &journal);
                *contact = state;
                if let Some([on_bearing, on_journal]) = forces {
                    add(joint.ring.body, on_bearing);
                    add(joint.journal.body, on_journal);
                }
            } else {
                contact.eccentricity = journal.centre - ring.centre;
            }
        }
        for (i, joint) in mechanism.prismatics.iter().enumerate() {
            if let Drive::Servo { stiffness, damping } = joint.drive {
                let state = &mut self.prismatics[i];
                *state = PrismaticState::new(joint, states);
                let command = &out.commands[i];
                let force = stiffness * (command.length - state.length)
                    + damping * (command.rate - state.rate);
                out.drive_forces[i] = force;
                add(joint.cylinder.body, state.along.jacobians[0] * force);
                add(joint.rod.body, state.along.jacobians[1] * force);
            }
        }
    }

    /// Fills `out.accelerations` from `out.wrenches` and the rigid joints, and, where drives are
    /// prescribed, the drive forces that the command takes.
    pub fn accelerations(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        for ((a, w), m) in out.accelerations.iter_mut().zip(&out.wrenches).zip(&self.inverse_masses)
        {
            *a = w.component_mul(m);
        }
        for g in 0..self.groups.len() {
            self.rows.clear();
            for joint in &self.groups[g] {
                match *joint {
                    RigidJoint::Prismatic(i) => {
                        let joint = &mechanism.prismatics[i];
                        let prescribed = joint.drive == Drive::Prescribed;
                        let state = &mut self.prismatics[i];
                        if prescribed {
                            *state = PrismaticState::new(joint, states);
                        }
                        out.lengths[i] = state.length;
                        self.rows.extend(state.locks);
                        if prescribed {
                            let bias = state.along.bias - out.commands[i].acceleration;
                            self.rows.push(Row { bias, ..state.along });
                        }
                    }
                    RigidJoint::Revolute(i) => {
                        self.rows.extend(revolute_rows(&mechanism.revolutes[i], states));
                    }
                }
            }
            self.constrain(&mut out.accelerations);
            let mut multipliers = self.multipliers.as_slice();
            for joint in &self.groups[g] {
                match *joint {
                    RigidJoint::Prismatic(i)
                        if mechanism.prismatics[i].drive == Drive::Prescribed =>
                    {
                        out.drive_forces[i] = multipliers[2];
                        multipliers = &multipliers[3..];
                    }
                    RigidJoint::Prismatic(_) => multipliers = &multipliers[2..],
                    RigidJoint::Revolute(i) => {
                        out.contacts[i].normal_force = multipliers[0].hypot(multipliers[1]);
                        multipliers = &multipliers[2..];
                    }
                }
            }
        }
    }

    /// Replaces the wrenches by those that alone would give the accelerations, `M a`: the forces of
    /// the rigid joints included.
    pub fn replace_wrenches(&self, out: &mut Evaluation) {
        for ((w, a), m) in out.wrenches.iter_mut().zip(&out.accelerations).zip(&self.inverse_masses)
        {
            *w = a.component_div(m);
        }
    }

    /// Turns free accelerations into those that meet `self.rows`; leaves λ in `self.multipliers`.
    fn constrain(&mut self, accelerations: &mut [Vector3<f64>]) {
        let n = self.rows.len();
        let (rows, masses) = (&self.rows, &self.inverse_masses);
        self.matrix.clear();
        self.matrix.resize(n * n, 0.0);
        self.multipliers.clear();
        for (i, row) in rows.iter().enumerate() {
            let mut rhs = -row.bias;
            for side in 0..2 {
                let Some(body) = row.bodies[side] else { continue };
                rhs -= row.jacobians[side].dot(&accelerations[body]);
                let weighted = row.jacobians[side].component_mul(&masses[body]);
                for (j, other) in rows[..=i].iter().enumerate() {
                    for other_side in 0..2 {
                        if other.bodies[other_side] == Some(body) {
                            self.matrix[i * n + j] += weighted.dot(&other.jacobians[other_side]);
                        }
                    }
                }
            }
            self.multipliers.push(rhs);
        }
        solve_in_place(&mut self.matrix, &mut self.multipliers);
        for (row, &lambda) in rows.iter().zip(&self.multipliers) {
            for side in 0..2 {
                if let Some(body) = row.bodies[side] {
                    accelerations[body] +=
                        row.jacobians[side].component_mul(&masses[body]) * lambda;
                }
            }
        }
    }
}

/// Cholesky solution of a symmetric positive definite system given by its lower triangle (row
/// major); the right-hand side becomes the solution. In place because it runs several times a step
/// on systems of two or three rows, where an allocation would cost more than the solution.
fn solve_in_place(a: &mut [f64], b: &mut [f64]) {
    let n = b.len();
    for j in 0..n {
        for k in 0..j {
            a[j * n + j] -= a[j * n + k] * a[j * n + k];
        }
        let pivot = a[j * n + j].sqrt();
        a[j * n + j] = pivot;
        for i in j + 1..n {
            for k in 0..j {
                a[i * n + j] -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] /= pivot;
        }
        for k in 0..j {
            b[j] -= a[j * n + k] * b[k];
        }
        b[j] /= pivot;
    }
    for j in (0..n).rev() {
        for i in j + 1..n {
            b[j] -= a[i * n + j] * b[i];
        }
        b[j] /= a[j * n + j];
    }
}

/// The rigid joints, grouped by the bodies that they connect. The ground connects nothing: it does
/// not move.
fn groups(mechanism: &Mechanism) -> Vec<Vec<RigidJoint>> {
    let prismatics = mechanism.prismatics.iter().enumerate();
    let revolutes = mechanism.revolutes.iter().enumerate();
    let joints =
        prismatics.map(|(i, j)| (RigidJoint::Prismatic(i), [j.cylinder.body, j.rod.body])).chain(
            revolutes
                .filter(|(_, j)| matches!(j.bearing, Bearing::Ideal))
                .map(|(i, j)| (RigidJoint::Revolute(i), [j.ring.body, j.journal.body])),
        );
    let mut groups: Vec<(Vec<usize>, Vec<RigidJoint>)> = Vec::new();
    for (joint, bodies) in joints {
        let bodies: Vec<usize> = bodies.into_iter().flatten().collect();
        let (touching, mut rest): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|(members, _)| members.iter().any(|m| bodies.contains(m)));
        let mut merged = (Vec::new(), Vec::new());
        for (members, joints) in touching {
            merged.0.extend(members);
            merged.1.extend(joints);
        }
        merged.0.extend(bodies);
        merged.1.push(joint);
        rest.push(merged);
        groups = rest;
    }
    groups.into_iter().map(|(_, joints)| joints).collect()
}
