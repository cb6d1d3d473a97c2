//! What journals do to their rings, and what is to be remembered of it.

use crate::contact::{After, Contact, Touch, circle_in_ring};
use crate::mechanism::{Attachment, Bearing, BodyState, Mechanism, Revolute};
use nalgebra::{Vector2, Vector3};

/// Where the contact of a joint is described, the force on its journal, and the wrenches that it adds to.
pub(super) struct Touched<'a> {
    pub contact: &'a mut Contact,
    pub reaction: &'a mut Vector2<f64>,
    pub wrenches: &'a mut [Vector3<f64>],
}

/// Describes a revolute joint, and adds what its contact does; `memory` is what it remembers.
#[inline]
pub(super) fn touch(joint: &Revolute, memory: Option<After>, states: &[BodyState], out: Touched) {
    let Touched { contact, reaction, wrenches } = out;
    let (ring, journal) = (joint.ring.frame(states), joint.journal.frame(states));
    let Bearing::Clearance(clearance) = &joint.bearing else {
        contact.eccentricity = journal.centre - ring.centre;
        if let Bearing::Native { bearing_radius, journal_radius, .. } = joint.bearing {
            let clearance = bearing_radius - journal_radius;
            let (penetration, normal) = circle_in_ring(contact.eccentricity, clearance);
            contact.penetration = penetration;
            contact.rate = (journal.velocity - ring.velocity).dot(&normal);
        }
        return;
    };
    let (state, forces) = match (&joint.out_of_round, memory) {
        (None, None) => clearance.forces(&ring, &journal),
        (None, Some(memory)) => clearance.forces_after(memory, &ring, &journal),
        (Some(shape), memory) => {
            shape.forces(clearance, memory, joint.ring.rotation(states), &ring, &journal)
        }
    };
    *contact = state;
    *reaction = Vector2::zeros();
    if let Some([on_bearing, on_journal]) = forces {
        *reaction = on_journal.xy();
        add(wrenches, joint.ring.body, on_bearing);
        add(wrenches, joint.journal.body, on_journal);
    }
}

/// What of a joint with clearance says whether its journal flies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    /// Index of the joint.
    pub joint: usize,
    /// Centres of ring and journal.
    ring: Attachment,
    journal: Attachment,
    /// Square of the distance in m² up to which it flies; negative where only the whole description says so.
    reach: f64,
}

impl Flight {
    /// Those of all joints with clearance.
    pub fn all(mechanism: &Mechanism) -> Vec<Self> {
        let joints = mechanism.revolutes.iter().enumerate();
        let flight = |(joint, revolute): (usize, &Revolute)| {
            let Bearing::Clearance(clearance) = &revolute.bearing else { return None };
            let round = revolute.out_of_round.is_none();
            let reach = if round { clearance.radial().powi(2) } else { -1.0 };
            Some(Self { joint, ring: revolute.ring, journal: revolute.journal, reach })
        };
        joints.filter_map(flight).collect()
    }

    /// Whether it does at these states.
    #[inline(always)]
    pub fn flies(&self, states: &[BodyState]) -> bool {
        let eccentricity = self.journal.centre(states) - self.ring.centre(states);
        eccentricity.norm_squared() <= self.reach
    }
}

/// What the joints remember at the start of a run; nothing where no law asks for it.
pub(super) fn touches(mechanism: &Mechanism, starts: &[BodyState]) -> Vec<Touch> {
    let remembers = |joint: &Revolute| match &joint.bearing {
        Bearing::Clearance(clearance) => clearance.remembers(),
        Bearing::Ideal | Bearing::Native { .. } => false,
    };
    if !mechanism.revolutes.iter().any(remembers) {
        return Vec::new();
    }
    let begin = |joint| {
        let Contact { penetration, rate, .. } = contact(joint, starts);
        Touch::begin(penetration, rate)
    };
    mechanism.revolutes.iter().map(begin).collect()
}

/// What a joint remembers of its contact at these states.
pub(super) fn reached(joint: &Revolute, memory: After, states: &[BodyState]) -> Touch {
    let contact = contact(joint, states);
    match &joint.bearing {
        Bearing::Clearance(clearance) => {
            clearance.reached(memory, &contact, || joint.sliding(states).map_or(0.0, |[_, v]| v))
        }
        Bearing::Ideal | Bearing::Native { .. } => {
            memory.reached(contact.penetration, contact.rate)
        }
    }
}

/// Where the journal of a joint stands; flying in one that no law acts in.
pub(super) fn contact(joint: &Revolute, states: &[BodyState]) -> Contact {
    let Bearing::Clearance(clearance) = &joint.bearing else { return Contact::default() };
    let (ring, journal) = (joint.ring.frame(states), joint.journal.frame(states));
    let (contact, _) = match &joint.out_of_round {
        None => clearance.forces(&ring, &journal),
        Some(shape) => shape.forces(clearance, None, joint.ring.rotation(states), &ring, &journal),
    };
    contact
}

/// Adds a wrench to that of a body; the ground takes any.
pub(super) fn add(wrenches: &mut [Vector3<f64>], body: Option<usize>, wrench: Vector3<f64>) {
    if let Some(i) = body {
        wrenches[i] += wrench;
    }
}
