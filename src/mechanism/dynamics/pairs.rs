//! Pairs of bodies on one slide, solved in closed form.

use crate::mechanism::equations::constraints::Rigid;
use crate::mechanism::equations::telescope::{PairMasses, PairMotion, Slideway, Telescope};
use crate::mechanism::{
    Actuator, BodyState, Command, Drive, Evaluation, JointIndex, Mechanism, Prismatic,
};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// Two moving bodies on one prismatic joint, which no other rigid joint holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Index of the joint.
    pub joint: usize,
    /// Base and slider.
    pub bodies: [usize; 2],
    pub masses: PairMasses,
    /// The drive that prescribes the length.
    pub prescribed: Option<usize>,
    /// Whether the joint's state follows from no drive's force.
    pub passive: bool,
    way: Slideway,
}

/// Where a pair is at the start of a step: its common centre of mass, and L, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairStart {
    pub centre: Vector2<f64>,
    pub length: f64,
}

/// A servo whose drive reads right and is rigidly connected, on a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlainServo {
    /// Index of the drive.
    pub drive: usize,
    /// Index of the joint.
    pub joint: usize,
    /// Base and slider.
    pub bodies: [usize; 2],
    /// Stiffness in N/m, damping in N s/m.
    pub gains: [f64; 2],
    way: Slideway,
}

impl Pair {
    /// The pair, if a group is nothing else.
    pub fn of(mechanism: &Mechanism, group: &[Rigid]) -> Option<Self> {
        let [Rigid::Prismatic(joint)] = *group else { return None };
        let Prismatic { base, slider, .. } = &mechanism.prismatics[joint];
        let bodies = [base.body?, slider.body?];
        let masses = PairMasses::new(bodies.map(|body| &mechanism.bodies[body]));
        let prescribes = |actuator: &Actuator| {
            actuator.joint == JointIndex::Prismatic(joint) && actuator.drive == Drive::Prescribed
        };
        let prescribed = mechanism.actuators.iter().position(prescribes);
        let driven = |actuator: &Actuator| actuator.joint == JointIndex::Prismatic(joint);
        let passive = prescribed.is_some() || !mechanism.actuators.iter().any(driven);
        let way = Slideway::new(&mechanism.prismatics[joint]);
        Some(Self { joint, bodies, masses, prescribed, passive, way })
    }

    /// The joint at these states.
    #[inline(always)]
    pub fn telescope(&self, states: &[BodyState]) -> Telescope {
        let [base, slider] = self.bodies;
        Telescope::between(&self.way, &states[base], &states[slider])
    }

    /// The joint from the base's rotation, L in m with its rate, and the angular velocity of both in rad/s.
    #[inline(always)]
    pub fn reaching(&self, base: UnitComplex<f64>, along: [f64; 2], spin: f64) -> Telescope {
        Telescope::reaching(&self.way, base, along, spin)
    }

    /// L of the joint with that length, in m.
    #[inline(always)]
    pub fn reach(&self, length: f64) -> f64 {
        let [base, slider] = self.way.points;
        length - slider.x + base.x
    }

    /// How it goes on under these wrenches; `out` is given the force of a drive that prescribes the length.
    #[inline(always)]
    pub fn go_on(
        &self,
        state: &Telescope,
        wrenches: &[Vector3<f64>; 2],
        out: &mut Evaluation,
    ) -> PairMotion {
        let extension = self.prescribed.map(|drive| out.commands[drive].acceleration);
        let motion = state.motion(&self.masses, wrenches, extension);
        if let Some(drive) = self.prescribed {
            out.drive_forces[drive] = motion.force;
        }
        motion
    }
}

impl PlainServo {
    /// All drives as plain servos, unless any of them is something else that pushes.
    pub fn all(mechanism: &Mechanism, pairs: &[Pair]) -> Option<Vec<Self>> {
        let pushing = mechanism.actuators.iter().enumerate();
        let pushing = pushing.filter(|(_, actuator)| actuator.drive != Drive::Prescribed);
        let plain = pushing.map(|(drive, actuator)| {
            let (Drive::Servo { stiffness, damping }, JointIndex::Prismatic(joint)) =
                (actuator.drive, actuator.joint)
            else {
                return None;
            };
            let rigid = actuator.reading_errors.is_empty() && actuator.transmission.is_none();
            let Pair { bodies, way, .. } =
                *pairs.iter().find(|pair| rigid && pair.joint == joint)?;
            Some(Self { drive, joint, bodies, gains: [stiffness, damping], way })
        });
        plain.collect()
    }

    /// The joint at these states.
    #[inline(always)]
    pub fn telescope(&self, states: &[BodyState]) -> Telescope {
        let [base, slider] = self.bodies;
        Telescope::between(&self.way, &states[base], &states[slider])
    }

    /// Adds what it does to the joint in this state; `out` has the commands.
    #[inline(always)]
    pub fn push(&self, state: &Telescope, out: &mut Evaluation) {
        let Self { drive, bodies: [base, slider], gains: [stiffness, damping], .. } = *self;
        let Command { position, rate, .. } = out.commands[drive];
        let (error, error_rate) = (position - state.length, rate - state.length_rate);
        let effort = stiffness * error + damping * error_rate;
        out.coordinates[drive] = state.length;
        out.drive_forces[drive] = effort;
        let [on_base, on_slider] = state.drive(effort);
        out.wrenches[base] += on_base;
        out.wrenches[slider] += on_slider;
    }
}
