//! Forces and accelerations of a mechanism at a given state, without any engine.
//!
//! Bodies that rigid joints hold together form a group; in each group the constrained
//! accelerations follow from Gauss' principle (`constraints.rs`). Groups touch each other
//! through clearance joints only, so each is a small dense system: a leg has three rows.

use super::constraints::{Constraints, Rigid, groups};
use super::rows::{angle_row, prismatic_rows, revolute_rows};
use super::telescope::Telescope;
use super::{
    Bearing, BodyState, Command, Drive, Evaluation, Held, JointIndex, Mechanism, Memory, Prismatic,
    Situation, angle_near,
};
use crate::contact::circle_in_ring;
use nalgebra::{Vector2, Vector3};

/// The equations of motion of a mechanism, with the workspace that evaluating them needs.
#[derive(Clone, Debug)]
pub struct Dynamics {
    inverse_masses: Vec<Vector3<f64>>,
    weights: Vec<Vector3<f64>>,
    masses: Vec<Vector3<f64>>,
    /// Prismatic joints that alone hold two moving bodies, and these: solved in closed form.
    telescopes: Vec<(usize, [usize; 2])>,
    /// The other rigid joints, group by group.
    groups: Vec<Group>,
    /// Whether a group was nearly singular since that was last forgotten.
    singular: bool,
    coupled: bool,
    /// Each prismatic joint at the state last asked for.
    prismatics: Vec<Telescope>,
    /// The drive that prescribes each prismatic joint's length.
    prescribed: Vec<Option<usize>>,
    /// Prismatic joints whose state no drive's force asks for.
    passive: Vec<usize>,
    /// Angle of each driven revolute joint at the last step's end, in rad: whole turns are counted.
    angles: Vec<f64>,
    /// What each drive's sampled controller holds.
    held: Vec<Held>,
    /// What each load remembers of the end of the last step.
    memories: Vec<Memory>,
    /// Workspace of a group.
    constraints: Constraints,
}

/// How much closer than usual to a lower rank a group's rows are where it counts as nearly singular: a
/// thousandth of a radian away from the singular pose of a common linkage.
const NEARLY_SINGULAR: f64 = 1e-6;

/// Rigid joints that are solved together.
#[derive(Clone, Debug)]
struct Group {
    joints: Vec<Rigid>,
    /// Highest rank of the rows so far, and the farthest that they were from a lower one.
    rank: usize,
    weakest: f64,
}

impl Group {
    fn new(joints: Vec<Rigid>) -> Self {
        Self { joints, rank: 0, weakest: 0.0 }
    }

    /// Whether rows of this rank, so far from a lower one, are nearly singular.
    fn nearly_singular(&mut self, rank: usize, weakest: f64) -> bool {
        self.rank = self.rank.max(rank);
        self.weakest = self.weakest.max(weakest);
        rank < self.rank || weakest < NEARLY_SINGULAR * self.weakest
    }
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
            match Self::telescope(mechanism, &group) {
                Some(telescope) => telescopes.push(telescope),
                None => others.push(Group::new(group)),
            }
        }
        let beside = |joint: &Prismatic| {
            let [base, slider] = joint.points();
            base.y != slider.y
        };
        let mut prescribed = vec![None; mechanism.prismatics.len()];
        let mut passive = vec![true; mechanism.prismatics.len()];
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if let JointIndex::Prismatic(joint) = actuator.joint {
                if actuator.drive == Drive::Prescribed {
                    prescribed[joint] = Some(i);
                } else {
                    passive[joint] = false;
                }
            }
        }
        let angles = mechanism.actuators.iter().map(|actuator| match actuator.joint {
            JointIndex::Revolute(joint) => mechanism.start_angle(joint),
            JointIndex::Prismatic(_) => 0.0,
        });
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
            singular: false,
            prismatics: mechanism
                .prismatics
                .iter()
                .map(|joint| Telescope::new(joint, &starts))
                .collect(),
            prescribed,
            passive: (0..passive.len()).filter(|&i| passive[i]).collect(),
            angles: angles.collect(),
            held: vec![Held::default(); mechanism.actuators.len()],
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

    /// The prismatic joint and its two moving bodies, if a group is nothing else.
    fn telescope(mechanism: &Mechanism, group: &[Rigid]) -> Option<(usize, [usize; 2])> {
        let [Rigid::Prismatic(i)] = group else { return None };
        let joint = &mechanism.prismatics[*i];
        Some((*i, [joint.base.body?, joint.slider.body?]))
    }

    /// Whether rigid joints act on each other: where they share a body, or a prismatic joint's axis
    /// is not that of its two centres of mass. Joints solved one after another then miss the forces.
    pub fn coupled(&self) -> bool {
        self.coupled
    }

    /// Whether rigid joints were solved in a nearly singular pose since this was last forgotten.
    pub fn was_singular(&self) -> bool {
        self.singular
    }

    /// Forgets whether they were.
    pub fn forget_singular(&mut self) {
        self.singular = false;
    }

    /// M⁻¹ of each body as the diagonal (1/kg, 1/kg, 1/(kg·m²)).
    pub fn inverse_masses(&self) -> &[Vector3<f64>] {
        &self.inverse_masses
    }

    /// True coordinate (m or rad, whole turns counted from the last step's end) and rate of the joint of
    /// drive `index`.
    #[inline]
    pub fn coordinate(
        &mut self,
        mechanism: &Mechanism,
        index: usize,
        states: &[BodyState],
    ) -> [f64; 2] {
        match mechanism.actuators[index].joint {
            JointIndex::Prismatic(i) => {
                let state = &mut self.prismatics[i];
                *state = Telescope::new(&mechanism.prismatics[i], states);
                [state.length, state.length_rate]
            }
            JointIndex::Revolute(i) => {
                let joint = &mechanism.revolutes[i];
                [angle_near(joint.rotation(states), self.angles[index]), joint.spin(states)]
            }
        }
    }

    /// The drive that prescribes the length of prismatic joint `index`, if one does.
    pub fn prescribed(&self, index: usize) -> Option<usize> {
        self.prescribed[index]
    }

    /// Lets the sampled controllers that are `due` compute what they hold from time `t` (s) on.
    pub fn sample(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState], due: &[bool]) {
        let mut commands = vec![Command::default(); mechanism.actuators.len()];
        let now = mechanism.epoch + t;
        mechanism.commands.at(now, &mut commands);
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if let Drive::Sampled(cascade) = actuator.drive
                && due[i]
            {
                let [position, rate] = self.coordinate(mechanism, i, states);
                let [position, _] = actuator.read(position, rate);
                let added = mechanism.commands.added(i, now);
                cascade.sample(&mut self.held[i], t, &commands[i], position, added);
            }
        }
    }

    /// Fills `out` with commands, wrenches, contacts, coordinates and drive efforts at time `t` (s) and
    /// the given states. Accelerations and efforts of prescribed drives are
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
        for (i, joint) in mechanism.revolutes.iter().enumerate() {
            let contact = &mut out.contacts[i];
            let (ring, journal) = (joint.ring.frame(states), joint.journal.frame(states));
            if let Bearing::Clearance(clearance) = &joint.bearing {
                let (state, forces) = match &joint.out_of_round {
                    None => clearance.forces(&ring, &journal),
                    Some(shape) => {
                        shape.forces(clearance, joint.ring.rotation(states), &ring, &journal)
                    }
                };
                *contact = state;
                out.reactions[i] = Vector2::zeros();
                if let Some([on_bearing, on_journal]) = forces {
                    out.reactions[i] = on_journal.xy();
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
        self.drive(mechanism, t, states, out);
        let at = Situation { t: mechanism.epoch + t, mechanism, states };
        for (load, memory) in mechanism.loads.iter().zip(&self.memories) {
            load.add_after(at, *memory, &mut out.wrenches);
        }
    }

    /// Adds the efforts of all drives but prescribed ones.
    fn drive(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState], out: &mut Evaluation) {
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if actuator.drive == Drive::Prescribed {
                continue;
            }
            let [position, rate] = self.coordinate(mechanism, i, states);
            out.coordinates[i] = position;
            let effort = match actuator.drive {
                Drive::Prescribed => continue,
                Drive::Sampled(cascade) => cascade.force(&self.held[i], t),
                Drive::Effort => {
                    out.command(mechanism);
                    out.commands[i].position
                }
                Drive::Servo { stiffness, damping } => {
                    out.command(mechanism);
                    let command = &out.commands[i];
                    let [position, rate] = actuator.read(position, rate);
                    let (error, error_rate) = (command.position - position, command.rate - rate);
                    match &actuator.transmission {
                        None => stiffness * error + damping * error_rate,
                        Some(link) => link.force([stiffness, damping], error, error_rate),
                    }
                }
            };
            out.drive_forces[i] = effort;
            match actuator.joint {
                JointIndex::Prismatic(joint) => {
                    let [on_base, on_slider] = self.prismatics[joint].drive(effort);
                    let joint = &mechanism.prismatics[joint];
                    add(&mut out.wrenches, joint.base.body, on_base);
                    add(&mut out.wrenches, joint.slider.body, on_slider);
                }
                JointIndex::Revolute(joint) => {
                    let joint = &mechanism.revolutes[joint];
                    add(&mut out.wrenches, joint.ring.body, Vector3::new(0.0, 0.0, -effort));
                    add(&mut out.wrenches, joint.journal.body, Vector3::new(0.0, 0.0, effort));
                }
            }
        }
    }

    /// Lets loads and drives remember time `t` (s) and these states: what is looked at from now on comes
    /// after them.
    pub fn remember(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState]) {
        let at = Situation { t: mechanism.epoch + t, mechanism, states };
        for (load, memory) in mechanism.loads.iter().zip(&mut self.memories) {
            *memory = load.remember(at, *memory);
        }
        for (angle, actuator) in self.angles.iter_mut().zip(&mechanism.actuators) {
            if let JointIndex::Revolute(i) = actuator.joint {
                *angle = angle_near(mechanism.revolutes[i].rotation(states), *angle);
            }
        }
    }

    /// Fills `out.accelerations` from `out.wrenches` and the rigid joints, and, where drives are
    /// prescribed, the efforts that the command takes.
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
        for &i in &self.passive {
            self.prismatics[i] = Telescope::new(&mechanism.prismatics[i], states);
        }
        for (length, state) in out.lengths.iter_mut().zip(&self.prismatics) {
            *length = state.length;
        }
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if actuator.drive == Drive::Prescribed {
                out.command(mechanism);
                out.coordinates[i] = match actuator.joint {
                    JointIndex::Prismatic(joint) => self.prismatics[joint].length,
                    JointIndex::Revolute(_) => self.coordinate(mechanism, i, states)[0],
                };
            }
        }
        for &(i, bodies) in &self.telescopes {
            let prescribed = self.prescribed[i];
            let extension = prescribed.map(|drive| out.commands[drive].acceleration);
            let masses = bodies.map(|b| self.masses[b]);
            let wrenches = bodies.map(|b| out.wrenches[b]);
            let (accelerations, force) =
                self.prismatics[i].accelerations(masses, wrenches, extension);
            for (body, a) in bodies.into_iter().zip(accelerations) {
                out.accelerations[body] = a;
            }
            if let Some(drive) = prescribed {
                out.drive_forces[drive] = force;
            }
        }
        for g in 0..self.groups.len() {
            self.solve_group(g, mechanism, states, out);
        }
    }

    /// Accelerations and joint forces of one group.
    fn solve_group(
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
                Rigid::Angle { drive, joint } => {
                    let mut row = angle_row(&mechanism.revolutes[joint]);
                    row.bias -= out.commands[drive].acceleration;
                    rows.push(row);
                }
            }
        }
        self.constraints.usual = self.groups[g].weakest;
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
                    out.contacts[i].normal_force = force.x.hypot(force.y);
                }
                Rigid::Angle { drive, .. } => out.drive_forces[drive] = next(),
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
    use crate::mechanism::{Actuator, Attachment, Body, Commands};
    use nalgebra::UnitComplex;
    use std::sync::Arc;

    #[derive(Debug)]
    struct Constant;

    impl Commands for Constant {
        fn at(&self, _t: f64, commands: &mut [Command]) {
            commands.fill(Command { position: 0.3, rate: 0.2, acceleration: 7.0 });
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
        let body = |name: &str, mass, inertia, position: Vector2<f64>, v: Vector2<f64>| {
            let twist = Vector3::new(v.x, v.y, spin);
            Body::new(name, mass, inertia, BodyState { position, rotation, twist })
        };
        let attachment = |i, x| Attachment { body: Some(i), point: Vector2::new(x, 0.01) };
        let bodies = vec![
            body("cylinder", 0.14, 4e-4, Vector2::zeros(), Vector2::new(0.1, 0.3)),
            body("rod", 0.05, 2e-4, apart, Vector2::new(0.1, 0.3) + sliding + turned),
        ];
        Mechanism {
            prismatics: vec![Prismatic {
                name: "P1".into(),
                base: attachment(0, -0.1),
                slider: attachment(1, 0.1),
                axes: [UnitComplex::identity(); 2],
            }],
            actuators: vec![Actuator::new("P1", JointIndex::Prismatic(0), drive)],
            commands: Arc::new(Constant),
            gravity: Vector2::new(0.5, -9.81),
            ..Mechanism::free(bodies)
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
            general.groups.push(Group::new(vec![Rigid::Prismatic(0)]));
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
