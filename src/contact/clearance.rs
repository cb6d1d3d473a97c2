//! One clearance joint: a round journal inside a round bearing ring, both of them rigid apart from
//! the local give that the force law describes.

use super::{After, ForceLaw, Friction, Touch};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// Largest half width a of a contact as a share of the journal's radius R for which laws after Hertz hold
/// to some per cent: they take the contact for small against the bodies.
const LARGEST_HALF_WIDTH: f64 = 0.3;

/// Penetration δ in m beyond which no law of this room holds for a journal of `journal_radius` R:
/// `a = √(R δ)` reaches 0.3 R at `δ = 0.09 R`. A journal that is farther out has left its ring.
pub fn valid_penetration(journal_radius: f64) -> f64 {
    LARGEST_HALF_WIDTH * LARGEST_HALF_WIDTH * journal_radius
}

/// What a clearance joint is made of.
///
/// ```
/// use freeplay::contact::{Clearance, Frame, HertzStep};
/// use nalgebra::Vector2;
/// use std::sync::Arc;
///
/// let law = HertzStep { stiffness: 1.6e10, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
/// let joint = Clearance { bearing_radius: 10e-3, journal_radius: 9.5e-3, law: Arc::new(law), friction: None };
/// let at = |x| Frame { centre: Vector2::new(x, 0.0), arm: Vector2::zeros(), velocity: Vector2::zeros(), spin: 0.0 };
/// // The journal's centre is 0.501 mm from the ring's: 1 µm in the wall, at rest.
/// let (contact, wrenches) = joint.forces(&at(0.0), &at(0.501e-3));
/// assert!((contact.penetration - 1e-6).abs() < 1e-12);
/// let [on_bearing, on_journal] = wrenches.unwrap();
/// assert!((on_bearing.x - 16.0).abs() < 1e-3 && on_journal.x == -on_bearing.x);
/// ```
#[derive(Clone, Debug)]
pub struct Clearance {
    /// Inner radius of the bearing ring in m.
    pub bearing_radius: f64,
    /// Radius of the journal in m, smaller than the bearing's.
    pub journal_radius: f64,
    /// Normal force as a function of penetration and its rate.
    pub law: Arc<dyn ForceLaw>,
    /// Friction at the contact point, if any.
    pub friction: Option<Friction>,
}

impl Clearance {
    /// Radial clearance c in m: how far the journal's centre can move before it touches.
    #[inline]
    pub fn radial(&self) -> f64 {
        self.bearing_radius - self.journal_radius
    }
}

/// Where a ring or a journal is, and how it moves, in world coordinates.
///
/// [`Clearance`] has an example.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Centre of the ring or journal in m.
    pub centre: Vector2<f64>,
    /// The centre's position relative to its body's centre of mass, in m.
    pub arm: Vector2<f64>,
    /// Velocity of the centre in m/s.
    pub velocity: Vector2<f64>,
    /// Angular velocity of the body in rad/s.
    pub spin: f64,
}

/// State of one clearance joint at one instant.
///
/// [`Clearance`] has an example.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Eccentricity vector e: journal centre − bearing centre, in m, world directions.
    pub eccentricity: Vector2<f64>,
    /// Penetration δ = |e| − c in m, negative while the journal flies.
    pub penetration: f64,
    /// Its rate δ̇ in m/s, positive while the centres part: outward, towards the ring.
    pub rate: f64,
    /// Normal force in N, zero while the journal flies.
    pub normal_force: f64,
    /// How fast the journal slides on its ring in m/s, along the normal turned by +90°; zero while it flies.
    pub sliding: f64,
    /// Friction force in N on the bearing, along the normal turned by +90°.
    pub friction_force: f64,
}

impl Contact {
    /// The friction power in W that a coefficient of 1 would have here, `F_N |v_t|`.
    #[inline]
    pub fn rubbing_power(&self) -> f64 {
        self.normal_force * self.sliding.abs()
    }
}

/// A circle inside a ring, in closed form: penetration δ = |e| − c (m, negative inside) and the
/// outward normal n = e/|e|, where e is the eccentricity vector and c the radial clearance.
///
/// With centred circles every direction is as good as any other; +x is returned. Both the force
/// law and the collision shape of the engine rest on this one function.
///
/// ```
/// use freeplay::contact::circle_in_ring;
/// use nalgebra::Vector2;
///
/// let (penetration, normal) = circle_in_ring(Vector2::new(0.0, -0.6e-3), 0.5e-3);
/// assert!((penetration - 0.1e-3).abs() < 1e-12);
/// assert_eq!(normal, Vector2::new(0.0, -1.0));
/// ```
#[inline]
pub fn circle_in_ring(eccentricity: Vector2<f64>, clearance: f64) -> (f64, Vector2<f64>) {
    let distance = eccentricity.norm();
    let normal = if distance > 0.0 { eccentricity / distance } else { Vector2::x() };
    (distance - clearance, normal)
}

impl Clearance {
    /// Forces in the joint: its [`Contact`], and the wrenches (N, N, N·m about each centre of mass)
    /// on the bearing's and on the journal's body.
    ///
    /// `F_N` acts along the line of centres, −n on the journal and +n on the bearing; friction at
    /// the journal's surface point, with arms `R_j` from the journal's centre and `R_j + |e|` from
    /// the bearing's. Both forces are opposite, so momentum and moment of momentum are kept.
    ///
    /// Of a law that remembers, the force of a hit that begins now; [`forces_after`](Self::forces_after) has
    /// its memory.
    #[inline]
    pub fn forces(&self, bearing: &Frame, journal: &Frame) -> (Contact, Option<[Vector3<f64>; 2]>) {
        self.forces_by(
            None,
            |penetration, rate| self.law.normal_force(penetration, rate),
            bearing,
            journal,
        )
    }

    /// The same with what a law that [remembers](ForceLaw::remembers) remembers of the joint.
    pub fn forces_after(
        &self,
        memory: After,
        bearing: &Frame,
        journal: &Frame,
    ) -> (Contact, Option<[Vector3<f64>; 2]>) {
        let force = |penetration, rate| self.normal_force_after(memory, penetration, rate);
        self.forces_by(Some(memory), force, bearing, journal)
    }

    /// Whether what acts in the joint depends on what has happened in its contact: the force law or the friction remembers.
    pub fn remembers(&self) -> bool {
        self.law.remembers() || self.friction.is_some_and(|friction| friction.remembers())
    }

    /// What is remembered of a contact that has been reached since `memory`; `sliding` says how fast the journal
    /// [slides](Self::slide) there, and is asked for only where friction remembers.
    pub fn reached(
        &self,
        memory: After,
        contact: &Contact,
        sliding: impl FnOnce() -> f64,
    ) -> Touch {
        let Contact { penetration, rate, .. } = *contact;
        let mut touch = memory.reached(penetration, rate);
        if let Some(friction) = self.friction.filter(Friction::remembers) {
            touch.sliding = sliding();
            touch.bent = friction.bent(memory, penetration, touch.sliding);
        }
        touch
    }

    #[inline(always)]
    fn forces_by(
        &self,
        memory: Option<After>,
        normal_force: impl FnOnce(f64, f64) -> f64,
        bearing: &Frame,
        journal: &Frame,
    ) -> (Contact, Option<[Vector3<f64>; 2]>) {
        let eccentricity = journal.centre - bearing.centre;
        let (penetration, normal) = circle_in_ring(eccentricity, self.radial());
        let relative = journal.velocity - bearing.velocity;
        let rate = relative.dot(&normal);
        let mut contact = Contact { eccentricity, penetration, rate, ..Contact::default() };
        if penetration <= 0.0 {
            return (contact, None);
        }
        contact.normal_force = normal_force(penetration, rate);
        let to_surface = self.to_surface(penetration);
        let arms = to_surface.map(|radius| normal * radius);
        let wrenches =
            self.press(memory, &mut contact, [bearing, journal], normal, to_surface, arms);
        (contact, Some(wrenches))
    }

    /// From the centres of ring and journal to where the journal's surface touches, in m.
    #[inline(always)]
    pub(super) fn to_surface(&self, penetration: f64) -> [f64; 2] {
        [self.journal_radius + penetration + self.radial(), self.journal_radius]
    }

    /// Force in N of a law that remembers, at a penetration (m) and its rate (m/s).
    pub(super) fn normal_force_after(&self, memory: After, penetration: f64, rate: f64) -> f64 {
        let impact_speed = memory.impact_speed(penetration, rate);
        self.law.normal_force_after(penetration, rate, impact_speed)
    }

    /// Adds friction to a contact whose normal force is known, and puts both on bearing and journal: the
    /// normal force along `normal`, at `arms` from the centre of each, whose part along the normal is
    /// `to_surface` (m).
    #[inline]
    pub(super) fn press(
        &self,
        memory: Option<After>,
        contact: &mut Contact,
        [bearing, journal]: [&Frame; 2],
        normal: Vector2<f64>,
        to_surface: [f64; 2],
        arms: [Vector2<f64>; 2],
    ) -> [Vector3<f64>; 2] {
        let tangent = Vector2::new(-normal.y, normal.x);
        let sliding = sliding([bearing, journal], normal, to_surface);
        contact.sliding = sliding;
        if let Some(friction) = &self.friction {
            let (force, penetration) = (contact.normal_force, contact.penetration);
            contact.friction_force = match memory {
                None => friction.force(force, sliding),
                Some(memory) => friction.force_after(memory, penetration, force, sliding),
            };
        }
        let force = normal * contact.normal_force + tangent * contact.friction_force;
        let wrench = |arm: Vector2<f64>, f: Vector2<f64>| Vector3::new(f.x, f.y, arm.perp(&f));
        [wrench(bearing.arm + arms[0], force), wrench(journal.arm + arms[1], -force)]
    }
}

/// How fast the journal slides on its ring in m/s: along the normal turned by +90°, at surface points `to_surface` (m)
/// along it from the centres of ring and journal.
#[inline(always)]
pub(super) fn sliding(
    [bearing, journal]: [&Frame; 2],
    normal: Vector2<f64>,
    to_surface: [f64; 2],
) -> f64 {
    let tangent = Vector2::new(-normal.y, normal.x);
    let relative = journal.velocity - bearing.velocity;
    relative.dot(&tangent) + journal.spin * to_surface[1] - bearing.spin * to_surface[0]
}

#[cfg(test)]
mod tests {
    use super::super::{CoulombFriction, HertzStep};
    use super::*;

    fn joint(friction: Option<CoulombFriction>) -> Clearance {
        let law =
            HertzStep { stiffness: 3.7e9, exponent: 1.5, c_max: 500.0, d_max: 1e-5, clip: true };
        Clearance {
            bearing_radius: 0.01,
            journal_radius: 0.0095,
            law: Arc::new(law),
            friction: friction.map(Friction::from),
        }
    }

    fn frame(centre: [f64; 2], arm: [f64; 2], velocity: [f64; 2], spin: f64) -> Frame {
        Frame { centre: centre.into(), arm: arm.into(), velocity: velocity.into(), spin }
    }

    #[test]
    fn a_flying_journal_feels_nothing() {
        let ring = frame([0.1, 0.2], [0.05, 0.0], [0.0, 0.0], 0.0);
        let journal = frame([0.1003, 0.2], [-0.1, 0.0], [0.3, 0.0], 1.0);
        let (contact, wrenches) = joint(None).forces(&ring, &journal);
        assert!((contact.penetration + 2e-4).abs() < 1e-15);
        assert!(contact.normal_force == 0.0 && wrenches.is_none());
    }

    #[test]
    fn action_equals_reaction_in_force_and_in_moment_about_the_origin() {
        let friction = CoulombFriction { coefficient: 0.2, velocity: 1e-3 };
        let ring = frame([0.1, 0.2], [0.05, -0.02], [0.02, 0.1], 0.7);
        let journal = frame([0.1004, 0.20031], [-0.1, 0.03], [0.3, -0.2], -2.0);
        let (contact, wrenches) = joint(Some(friction)).forces(&ring, &journal);
        let [on_bearing, on_journal] = wrenches.expect("in contact");
        assert!(contact.normal_force > 0.0 && contact.friction_force != 0.0);
        assert!((on_bearing.xy() + on_journal.xy()).norm() < 1e-12);
        let about_origin = |f: &Frame, w: &Vector3<f64>| w.z + (f.centre - f.arm).perp(&w.xy());
        let total = about_origin(&ring, &on_bearing) + about_origin(&journal, &on_journal);
        assert!(total.abs() < 1e-12, "{total}");
    }

    #[test]
    fn friction_takes_energy_at_the_contact_point() {
        let friction = CoulombFriction { coefficient: 0.2, velocity: 1e-3 };
        let ring = frame([0.0, 0.0], [0.0, 0.0], [0.0, 0.0], 0.0);
        for spin in [-3.0, 3.0] {
            let journal = frame([0.000505, 0.0], [0.0, 0.0], [0.0, 0.01], spin);
            let (_, wrenches) = joint(Some(friction)).forces(&ring, &journal);
            let [_, on_journal] = wrenches.expect("in contact");
            let (_, normal_only) = joint(None).forces(&ring, &journal);
            let [_, plain] = normal_only.expect("in contact");
            let extra = on_journal - plain;
            let power = extra.xy().dot(&journal.velocity) + extra.z * spin;
            assert!(power < 0.0, "{power}");
        }
    }
}
