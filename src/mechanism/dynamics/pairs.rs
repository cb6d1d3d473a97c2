//! Pairs of bodies on one slide, solved in closed form.

use crate::mechanism::constraints::Rigid;
use crate::mechanism::telescope::PairMasses;
use crate::mechanism::{Actuator, Drive, JointIndex, Mechanism, Prismatic};

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
        Some(Self { joint, bodies, masses, prescribed })
    }
}
