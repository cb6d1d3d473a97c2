//! Forces and accelerations of a mechanism at a given state, without any engine.
//!
//! Bodies that rigid joints hold together form a group; in each group the constrained
//! accelerations follow from Gauss' principle (`constraints.rs`). Groups touch each other
//! through clearance joints only, so each is a small dense system: a leg has three rows.

use super::constraints::{Constraints, RigidJoint, groups};
use super::rows::{prismatic_rows, revolute_rows};
use super::telescope::Telescope;
use super::{
    Bearing, BodyState, Command, Drive, Evaluation, Held, Mechanism, Memory, Prismatic, Situation,
};
use crate::contact::circle_in_ring;
use nalgebra::Vector3;

/// The equations of motion of a mechanism, with the workspace that evaluating them needs.
#[derive(Clone, Debug)]
pub struct Dynamics {
    inverse_masses: Vec<Vector3<f64>>,
    weights: Vec<Vector3<f64>>,
    masses: Vec<Vector3<f64>>,
    /// Prismatic joints that alone hold two moving bodies, and these: solved in closed form.
    telescopes: Vec<(usize, [usize; 2])>,
    /// The other rigid joints, group by group.
    groups: Vec<Vec<RigidJoint>>,
    coupled: bool,
    /// Each prismatic joint at the state last asked for.
    prismatics: Vec<Telescope>,
    /// What each prismatic joint's sampled controller holds.
    held: Vec<Held>,
    /// What each load remembers of the end of the last step.
    memories: Vec<Memory>,
    /// Workspace of a group.
    constraints: Constraints,
}

fn add(wrenches: &mut [Vector3<f64>], body: Option<usize>, wrench: Vector3<f64>) {
    if let Some(i) = body {
        wrenches[i] += wrench;
    }
}

impl Dynamics {
    /// The equations of motion of `mechanism`.
    pub fn new(mechanism: &Mechanism) -> Self {
        let inverse = |mass: f64, inertia: f64| Vector3::new(1.0 / mass, 1.0 / mass, 1.0 / inertia);
        let g = mechanism.gravity;
        let starts: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let bodies = &mechanism.bodies;
        let (mut telescopes, mut others) = (Vec::new(), Vec::new());
        for group in groups(mechanism) {
            if let [RigidJoint::Prismatic(i)] = group[..]
                && let joint = &mechanism.prismatics[i]
                && let (Some(cylinder), Some(rod)) = (joint.cylinder.body, joint.rod.body)
            {
                telescopes.push((i, [cylinder, rod]));
            } else {
                others.push(group);
            }
        }
        let beside = |joint: &Prismatic| joint.cylinder.point.y != joint.rod.point.y;
        Self {
            coupled: !others.is_empty() || mechanism.prismatics.iter().any(beside),
            inverse_masses: bodies.iter().map(|b| inverse(b.mass, b.inertia)).collect(),
            masses: bodies.iter().map(|b| Vector3::new(b.mass, b.mass, b.inertia)).collect(),
            weights: mechanism
                .bodies
                .iter()
                .map(|b| Vector3::new(b.mass * g.x, b.mass * g.y, 0.0))
                .collect(),
            telescopes,
            groups: others,
            prismatics: mechanism
                .prismatics
                .iter()
                .map(|joint| Telescope::new(joint, &starts))
                .collect(),
            held: vec![Held::default(); mechanism.prismatics.len()],
            memories: mechanism
                .loads
                .iter()
                .map(|load| {
                    load.begin(Situation { t: mechanism.epoch, mechanism, states: &starts })
                })
                .collect(),
            constraints: Constraints::default(),
        }
    }

    /// Whether rigid joints act on each other: where they share a body, or a prismatic joint's axis
    /// is not that of its two centres of mass. Joints solved one after another then miss the forces.
    pub fn coupled(&self) -> bool {
        self.coupled
    }

    /// M⁻¹ of each body as the diagonal (1/kg, 1/kg, 1/(kg·m²)).
    pub fn inverse_masses(&self) -> &[Vector3<f64>] {
        &self.inverse_masses
    }

    /// Lets the sampled controllers compute what they hold from time `t` (s) on.
    pub fn sample(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState]) {
        let mut commands = vec![Command::default(); mechanism.prismatics.len()];
        let now = mechanism.epoch + t;
        mechanism.commands.at(now, &mut commands);
        for (i, joint) in mechanism.prismatics.iter().enumerate() {
            if let Drive::Sampled(cascade) = joint.drive {
                let state = Telescope::new(joint, states);
                let [length, _] = joint.read(state.length, state.length_rate);
                let added = mechanism.commands.added(i, now);
                cascade.sample(&mut self.held[i], t, &commands[i], length, added);
            }
        }
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
        out.t = t;
        out.wrenches.copy_from_slice(&self.weights);
        for (joint, contact) in mechanism.revolutes.iter().zip(&mut out.contacts) {
            let (ring, journal) = (joint.ring.frame(states), joint.journal.frame(states));
            if let Bearing::Clearance(clearance) = &joint.bearing {
                let (state, forces) = match &joint.out_of_round {
                    None => clearance.forces(&ring, &journal),
                    Some(shape) => {
                        shape.forces(clearance, joint.ring.rotation(states), &ring, &journal)
                    }
                };
                *contact = state;
                if let Some([on_bearing, on_journal]) = forces {
                    add(&mut out.wrenches, joint.ring.body, on_bearing);
                    add(&mut out.wrenches, joint.journal.body, on_journal);
                }
            } else {
                contact.eccentricity = journal.centre - ring.centre;
                if let Bearing::Native { bearing_radius, journal_radius, .. } = joint.bearing {
                    let clearance = bearing_radius - journal_radius;
                    let (penetration, normal) = circle_in_ring(contact.eccentricity, clearance);
                    contact.penetration = penetration;
                    contact.rate = (journal.velocity - ring.velocity).dot(&normal);
                }
            }
        }
        for (i, joint) in mechanism.prismatics.iter().enumerate() {
            if let Drive::Sampled(cascade) = joint.drive {
                self.prismatics[i] = Telescope::new(joint, states);
                let force = cascade.force(&self.held[i], t);
                out.drive_forces[i] = force;
                let [on_cylinder, on_rod] = self.prismatics[i].drive(force);
                add(&mut out.wrenches, joint.cylinder.body, on_cylinder);
                add(&mut out.wrenches, joint.rod.body, on_rod);
            }
            if let Drive::Servo { stiffness, damping } = joint.drive {
                let state = &mut self.prismatics[i];
                *state = Telescope::new(joint, states);
                out.command(mechanism);
                let command = &out.commands[i];
                let [length, rate] = joint.read(state.length, state.length_rate);
                let (error, error_rate) = (command.length - length, command.rate - rate);
                let force = match &joint.transmission {
                    None => stiffness * error + damping * error_rate,
                    Some(link) => link.force([stiffness, damping], error, error_rate),
                };
                out.drive_forces[i] = force;
                let [on_cylinder, on_rod] = state.drive(force);
                add(&mut out.wrenches, joint.cylinder.body, on_cylinder);
                add(&mut out.wrenches, joint.rod.body, on_rod);
            }
        }
        let at = Situation { t: mechanism.epoch + t, mechanism, states };
        for (load, memory) in mechanism.loads.iter().zip(&self.memories) {
            load.add_after(at, *memory, &mut out.wrenches);
        }
    }

    /// Lets the loads remember time `t` (s) and these states: what is looked at from now on comes after
    /// them.
    pub fn remember(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState]) {
        let at = Situation { t: mechanism.epoch + t, mechanism, states };
        for (load, memory) in mechanism.loads.iter().zip(&mut self.memories) {
            *memory = load.remember(at, *memory);
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
        for (joint, state) in mechanism.prismatics.iter().zip(&mut self.prismatics) {
            if joint.drive == Drive::Prescribed {
                out.command(mechanism);
                *state = Telescope::new(joint, states);
            }
        }
        for (length, state) in out.lengths.iter_mut().zip(&self.prismatics) {
            *length = state.length;
        }
        for &(i, bodies) in &self.telescopes {
            let prescribed = mechanism.prismatics[i].drive == Drive::Prescribed;
            let extension = prescribed.then_some(out.commands[i].acceleration);
            let masses = bodies.map(|b| self.masses[b]);
            let wrenches = bodies.map(|b| out.wrenches[b]);
            let (accelerations, force) =
                self.prismatics[i].accelerations(masses, wrenches, extension);
            for (body, a) in bodies.into_iter().zip(accelerations) {
                out.accelerations[body] = a;
            }
            if prescribed {
                out.drive_forces[i] = force;
            }
        }
        for g in 0..self.groups.len() {
            self.constraints.rows.clear();
            for joint in &self.groups[g] {
                match *joint {
                    RigidJoint::Prismatic(i) => {
                        let joint = &mechanism.prismatics[i];
                        let bodies = [joint.cylinder.body, joint.rod.body];
                        let [side, angle, mut along] = prismatic_rows(&self.prismatics[i], bodies);
                        self.constraints.rows.extend([side, angle]);
                        if joint.drive == Drive::Prescribed {
                            along.bias -= out.commands[i].acceleration;
                            self.constraints.rows.push(along);
                        }
                    }
                    RigidJoint::Revolute(i) => {
                        self.constraints
                            .rows
                            .extend(revolute_rows(&mechanism.revolutes[i], states));
                    }
                }
            }
            self.constraints.solve(&self.inverse_masses, &mut out.accelerations);
            let mut multipliers = self.constraints.multipliers.as_slice();
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
        for ((w, a), m) in out.wrenches.iter_mut().zip(&out.accelerations).zip(&self.masses) {
            *w = a.component_mul(m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{Attachment, Body, Commands};
    use nalgebra::{UnitComplex, Vector2};
    use std::sync::Arc;

    #[derive(Debug)]
    struct Constant;

    impl Commands for Constant {
        fn at(&self, _t: f64, commands: &mut [Command]) {
            commands.fill(Command { length: 0.3, rate: 0.2, acceleration: 7.0 });
        }
    }

    /// Two bars in one line of motion whose centres of mass lie beside the axis.
    fn bars(drive: Drive) -> Mechanism {
        let rotation = UnitComplex::new(0.7);
        let spin = 1.3;
        let at = Vector2::new(0.2, -0.03);
        let apart = rotation * at;
        let sliding = rotation * Vector2::new(0.2, 0.0);
        let turned = Vector2::new(-apart.y, apart.x) * spin;
        let body = |name: &str, mass, inertia, position: Vector2<f64>, v: Vector2<f64>| Body {
            name: name.into(),
            mass,
            inertia,
            start: BodyState { position, rotation, twist: Vector3::new(v.x, v.y, spin) },
            reference: Vector2::zeros(),
        };
        let attachment = |i, x| Attachment { body: Some(i), point: Vector2::new(x, 0.01) };
        Mechanism {
            bodies: vec![
                body("cylinder", 0.14, 4e-4, Vector2::zeros(), Vector2::new(0.1, 0.3)),
                body("rod", 0.05, 2e-4, apart, Vector2::new(0.1, 0.3) + sliding + turned),
            ],
            revolutes: Vec::new(),
            prismatics: vec![Prismatic {
                name: "P1".into(),
                cylinder: attachment(0, -0.1),
                rod: attachment(1, 0.1),
                drive,
                reading_errors: Vec::new(),
                transmission: None,
            }],
            commands: Arc::new(Constant),
            epoch: 0.0,
            gravity: Vector2::new(0.5, -9.81),
            loads: Vec::new(),
            output: 1,
            native: Default::default(),
        }
    }

    /// The closed form of a telescope against the general rows of the same joint.
    #[test]
    fn telescope_and_rows_agree() {
        for drive in [Drive::Prescribed, Drive::Servo { stiffness: 1e3, damping: 10.0 }] {
            let mechanism = bars(drive);
            let states: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
            let mut closed = Dynamics::new(&mechanism);
            let mut general = closed.clone();
            assert_eq!(general.telescopes.len(), 1);
            general.telescopes.clear();
            general.groups.push(vec![RigidJoint::Prismatic(0)]);
            let [a, b] = [&mut closed, &mut general].map(|dynamics| {
                let mut now = Evaluation::new(&mechanism);
                dynamics.forces(&mechanism, 0.0, &states, &mut now);
                now.wrenches[0] += Vector3::new(1.0, -2.0, 0.3);
                now.wrenches[1] += Vector3::new(-3.0, 0.5, -0.1);
                dynamics.accelerations(&mechanism, &states, &mut now);
                now
            });
            for (a, b) in a.accelerations.iter().zip(&b.accelerations) {
                assert!((a - b).norm() < 1e-10 * b.norm(), "{drive:?}: {a} {b}");
            }
            assert!((a.drive_forces[0] - b.drive_forces[0]).abs() < 1e-12, "{drive:?}");
        }
    }
}
