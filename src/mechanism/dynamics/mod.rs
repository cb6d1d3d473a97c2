//! Forces and accelerations of a mechanism at a given state, without any engine.
//!
//! Bodies that rigid joints hold together form a group; in each group the constrained
//! accelerations follow from Gauss' principle (`constraints.rs`). Groups touch each other
//! through clearance joints only, so each is a small dense system: a leg has three rows.

mod contacts;
mod coordinates;
mod drives;
mod groups;
mod pairs;
mod projection;
mod remembered;
mod solved;

use self::contacts::{Flight, Touched, reached, touch, touches};
use self::groups::JointGroup;
use self::pairs::{Pair, PairStart, PlainServo};
use super::equations::constraints::{Constraints, Rigid, groups};
use super::equations::telescope::{Slideway, Telescope};
use super::{
    BodyState, Drive, Evaluation, Held, JointIndex, Mechanism, Memory, Prismatic, Situation,
    angle_near,
};
use crate::contact::{Contact, Touch};
use nalgebra::{Vector2, Vector3};

/// The equations of motion of a mechanism, with the workspace that evaluating them needs.
///
/// ```
/// use freeplay::mechanism::{Body, BodyState, Dynamics, Evaluation, Mechanism};
/// use nalgebra::Vector2;
///
/// let mut mechanism = Mechanism::free(vec![Body::new("stone", 2.0, 0.1, BodyState::ground())]);
/// mechanism.gravity = Vector2::new(0.0, -9.81);
/// let states = [mechanism.bodies[0].start];
/// let (mut dynamics, mut now) = (Dynamics::new(&mechanism), Evaluation::new(&mechanism));
/// dynamics.forces(&mechanism, 0.0, &states, &mut now);
/// dynamics.accelerations(&mechanism, &states, &mut now);
/// assert!((now.wrenches[0].y + 2.0 * 9.81).abs() < 1e-12);
/// assert!((now.accelerations[0].y + 9.81).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct Dynamics {
    inverse_masses: Vec<Vector3<f64>>,
    weights: Vec<Vector3<f64>>,
    masses: Vec<Vector3<f64>>,
    /// Prismatic joints that alone hold two moving bodies, and these: solved in closed form.
    telescopes: Vec<Pair>,
    /// Where each of them was when a step [started](Self::start).
    starts: Vec<PairStart>,
    /// Joints with clearance.
    flights: Vec<Flight>,
    /// The other rigid joints, group by group.
    groups: Vec<JointGroup>,
    /// Bodies that none of these holds.
    unpaired: Vec<usize>,
    /// All drives that push, where each is a plain servo on one of the pairs.
    servos: Option<Vec<PlainServo>>,
    /// Whether a group was nearly singular since that was last forgotten.
    singular: bool,
    coupled: bool,
    /// Whether any drive prescribes its coordinate.
    prescribes: bool,
    /// What of each prismatic joint stays.
    ways: Vec<Slideway>,
    /// Each prismatic joint at the state last asked for.
    prismatics: Vec<Telescope>,
    /// The drive that prescribes each prismatic joint's length.
    prescribed: Vec<Option<usize>>,
    /// Prismatic joints whose state no drive's force asks for, but those of pairs.
    passive: Vec<usize>,
    /// Angle of each driven revolute joint at the last step's end, in rad: whole turns are counted.
    angles: Vec<f64>,
    /// What each drive's sampled controller holds.
    held: Vec<Held>,
    /// What each load remembers of the end of the last step.
    memories: Vec<Memory>,
    /// What each revolute joint remembers of its contact; none at all where no law asks for it.
    touches: Vec<Touch>,
    /// Time in s of that memory.
    touched: f64,
    /// Workspace of a group.
    constraints: Constraints,
}

/// Prismatic joints that alone hold two moving bodies, and the other groups of bodies that rigid joints hold together.
fn pairs_and_groups(mechanism: &Mechanism) -> (Vec<Pair>, Vec<JointGroup>) {
    let (mut pairs, mut others) = (Vec::new(), Vec::new());
    for group in groups(mechanism) {
        match Pair::of(mechanism, &group) {
            Some(pair) => pairs.push(pair),
            None => others.push(JointGroup::new(group)),
        }
    }
    (pairs, others)
}

/// The drive that prescribes each prismatic joint's length, and whether no drive pushes it.
fn prescribed_and_passive(mechanism: &Mechanism) -> (Vec<Option<usize>>, Vec<bool>) {
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
    (prescribed, passive)
}

impl Dynamics {
    /// The equations of motion of `mechanism`.
    pub fn new(mechanism: &Mechanism) -> Self {
        let inverse = |mass: f64, inertia: f64| Vector3::new(1.0 / mass, 1.0 / mass, 1.0 / inertia);
        let g = mechanism.gravity;
        let starts: Vec<BodyState> = mechanism.bodies.iter().map(|b| b.start).collect();
        let at = Situation { t: mechanism.epoch, mechanism, states: &starts, angles: None };
        let bodies = &mechanism.bodies;
        let (telescopes, others) = pairs_and_groups(mechanism);
        let beside = |joint: &Prismatic| {
            let [base, slider] = joint.points();
            base.y != slider.y && !joint.play
        };
        let (prescribed, passive) = prescribed_and_passive(mechanism);
        let angles = mechanism.actuators.iter().map(|actuator| match actuator.joint {
            JointIndex::Revolute(joint) => mechanism.start_angle(joint),
            JointIndex::Prismatic(_) => 0.0,
        });
        Self {
            coupled: !others.is_empty() || mechanism.prismatics.iter().any(beside),
            prescribes: mechanism.actuators.iter().any(|a| a.drive == Drive::Prescribed),
            inverse_masses: bodies.iter().map(|b| inverse(b.mass, b.inertia)).collect(),
            masses: bodies.iter().map(|b| Vector3::new(b.mass, b.mass, b.inertia)).collect(),
            weights: mechanism
                .bodies
                .iter()
                .map(|b| Vector3::new(b.mass * g.x, b.mass * g.y, 0.0))
                .collect(),
            passive: (0..passive.len())
                .filter(|&i| passive[i] && telescopes.iter().all(|pair| pair.joint != i))
                .collect(),
            servos: PlainServo::all(mechanism, &telescopes),
            unpaired: (0..bodies.len())
                .filter(|body| telescopes.iter().all(|pair| !pair.bodies.contains(body)))
                .collect(),
            starts: Vec::with_capacity(telescopes.len()),
            telescopes,
            flights: Flight::all(mechanism),
            groups: others,
            singular: false,
            ways: mechanism.prismatics.iter().map(Slideway::new).collect(),
            prismatics: mechanism
                .prismatics
                .iter()
                .map(|joint| Telescope::new(joint, &starts))
                .collect(),
            prescribed,
            angles: angles.collect(),
            held: vec![Held::default(); mechanism.actuators.len()],
            memories: mechanism.loads.iter().map(|load| load.begin(at)).collect(),
            touches: touches(mechanism, &starts),
            touched: 0.0,
            constraints: Constraints::default(),
        }
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

    /// The drive that prescribes the length of prismatic joint `index`, if one does.
    pub fn prescribed(&self, index: usize) -> Option<usize> {
        self.prescribed[index]
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
        let Evaluation { contacts, reactions, wrenches, .. } = out;
        let joints = mechanism.revolutes.iter().zip(contacts.iter_mut().zip(reactions));
        for (i, (joint, (contact, reaction))) in joints.enumerate() {
            touch(joint, self.memory(i, t), states, Touched { contact, reaction, wrenches });
        }
        self.push(mechanism, t, states, out);
    }

    /// The same at a point of a step's path, where nobody asks where journals in flight are: contacts without
    /// a force are not described.
    pub fn forces_on_path(
        &mut self,
        mechanism: &Mechanism,
        t: f64,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        out.t = t;
        self.touch_on_path(mechanism, t, states, out);
        self.push(mechanism, t, states, out);
    }

    /// Fills `out` with the weights and what contacts add to them, where nobody asks where journals in flight are.
    #[inline]
    fn touch_on_path(
        &self,
        mechanism: &Mechanism,
        t: f64,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        out.wrenches.copy_from_slice(&self.weights);
        let Evaluation { contacts, reactions, wrenches, .. } = out;
        for flight in &self.flights {
            let i = flight.joint;
            let (contact, reaction) = (&mut contacts[i], &mut reactions[i]);
            if !flight.flies(states) {
                let joint = &mechanism.revolutes[i];
                touch(joint, self.memory(i, t), states, Touched { contact, reaction, wrenches });
            } else if contact.normal_force != 0.0 {
                (*contact, *reaction) = (Contact::default(), Vector2::zeros());
            }
        }
    }

    /// Adds what drives and loads do.
    fn push(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState], out: &mut Evaluation) {
        self.drive(mechanism, t, states, out);
        self.load(mechanism, t, states, out);
    }

    /// Adds what loads do.
    #[inline]
    fn load(&self, mechanism: &Mechanism, t: f64, states: &[BodyState], out: &mut Evaluation) {
        let at = Situation { t: mechanism.epoch + t, mechanism, states, angles: None };
        for (load, memory) in mechanism.loads.iter().zip(&self.memories) {
            load.add_after(at, *memory, &mut out.wrenches);
        }
    }

    /// Lets loads and drives remember time `t` (s) and these states: what is looked at from now on comes
    /// after them.
    pub fn remember(&mut self, mechanism: &Mechanism, t: f64, states: &[BodyState]) {
        let at = Situation { t: mechanism.epoch + t, mechanism, states, angles: None };
        for (load, memory) in mechanism.loads.iter().zip(&mut self.memories) {
            *memory = load.remember(at, *memory);
        }
        for (touch, joint) in self.touches.iter_mut().zip(&mechanism.revolutes) {
            *touch = reached(joint, touch.after(t - self.touched), states);
        }
        self.touched = t;
        for (angle, actuator) in self.angles.iter_mut().zip(&mechanism.actuators) {
            if let JointIndex::Revolute(i) = actuator.joint {
                *angle = angle_near(mechanism.revolutes[i].rotation(states), *angle);
            }
        }
    }

    /// Fills `out.accelerations` from `out.wrenches` and the rigid joints, and, where drives are
    /// prescribed, their coordinates and the efforts that the command takes.
    pub fn accelerations(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        self.accelerate_unpaired(mechanism, states, out);
        for pair in &self.telescopes {
            let state = &mut self.prismatics[pair.joint];
            if pair.passive {
                *state = pair.telescope(states);
            }
            let wrenches = pair.bodies.map(|body| out.wrenches[body]);
            let motion = pair.go_on(state, &wrenches, out);
            let [base, slider] = pair.bodies;
            [out.accelerations[base], out.accelerations[slider]] =
                motion.of_bodies(&pair.masses, &wrenches);
        }
        for (length, state) in out.lengths.iter_mut().zip(&self.prismatics) {
            *length = state.length;
        }
        for (i, actuator) in mechanism.actuators.iter().enumerate() {
            if actuator.drive == Drive::Prescribed {
                out.coordinates[i] = match actuator.joint {
                    JointIndex::Prismatic(joint) => self.prismatics[joint].length,
                    JointIndex::Revolute(_) => self.coordinate(mechanism, i, states)[0],
                };
            }
        }
    }

    /// Accelerations of bodies that no pair holds, and the forces of what holds them together.
    #[inline]
    fn accelerate_unpaired(
        &mut self,
        mechanism: &Mechanism,
        states: &[BodyState],
        out: &mut Evaluation,
    ) {
        for &i in &self.unpaired {
            out.accelerations[i] = out.wrenches[i].component_mul(&self.inverse_masses[i]);
        }
        for &i in &self.passive {
            self.prismatics[i] = Telescope::on(&self.ways[i], states);
        }
        if self.prescribes {
            out.command(mechanism);
        }
        for g in 0..self.groups.len() {
            self.solve_group(g, mechanism, states, out);
        }
    }

    /// Power in W at the instant whose accelerations were asked for last: of everything, `Σ (M a)·v`, and
    /// of the drives, `Σ F q̇`.
    pub fn power(&self, mechanism: &Mechanism, states: &[BodyState], now: &Evaluation) -> [f64; 2] {
        let bodies = self.masses.iter().zip(&now.accelerations).zip(states);
        let total = bodies.map(|((m, a), state)| m.component_mul(a).dot(&state.twist)).sum();
        let drives = mechanism.actuators.iter().zip(&now.drive_forces).map(|(actuator, effort)| {
            let rate = match actuator.joint {
                JointIndex::Prismatic(i) => self.prismatics[i].length_rate,
                JointIndex::Revolute(i) => mechanism.revolutes[i].spin(states),
            };
            effort * rate
        });
        [total, drives.sum()]
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
mod tests;
