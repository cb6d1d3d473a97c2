//! Bodies carried by telescopic legs: each a base that turns about a point of the ground, a slider on
//! it, and a pin at the carried body. Such machines (3-RPR, Stewart-like platforms in the plane) have their
//! inverse kinematics in closed form.

use super::motion::{Motion, PathPoint};
use super::{Attachment, BodyState, Command, Commands, JointIndex, Mechanism, Revolute};
use nalgebra::{Rotation2, UnitComplex, Vector2, Vector3};
use std::sync::Arc;

/// One leg. Its drive's coordinate is the distance of its two pins plus a constant.
#[derive(Clone, Copy, Debug)]
struct Leg {
    /// Pin on the ground, in m.
    anchor: Vector2<f64>,
    /// Pin on the carried body, in that body's own axes, in m.
    corner: Vector2<f64>,
    /// What the coordinate exceeds the distance of the pins by, in m.
    excess: f64,
    /// Base and slider: the body, its pin from its centre of mass, and the axis in its own axes.
    parts: [(usize, Vector2<f64>, UnitComplex<f64>); 2],
}

/// A body on telescopic legs, and the motion that it is to make.
///
/// ```
/// use freeplay::mechanism::TelescopicLegs;
/// use freeplay::prelude::*;
/// use nalgebra::Vector2;
///
/// let Machine { mechanism, motion, .. } = assemble(&Scenario::load(None, &[])?)?;
/// let legs = TelescopicLegs::of(&mechanism, mechanism.output, Vector2::zeros(), motion.clone()).unwrap();
/// let platform = mechanism.output_state(&legs.states(0.1));
/// assert!((platform.position - motion.at(0.1).pose.xy()).norm() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TelescopicLegs {
    legs: Vec<Leg>,
    /// The carried body, and its centre of mass in its own axes (m).
    carried: usize,
    centre: Vector2<f64>,
    bodies: usize,
    motion: Arc<dyn Motion>,
    /// The carried body's rotation, if the motion keeps it.
    kept: Option<Rotation2<f64>>,
}

impl TelescopicLegs {
    /// The legs of `mechanism`, if it is nothing else: every drive stands in a leg that carries the body
    /// `carried`, whose axes have their origin at the point `origin` (m, from the centre of mass) and follow
    /// `motion`.
    pub fn of(
        mechanism: &Mechanism,
        carried: usize,
        origin: Vector2<f64>,
        motion: Arc<dyn Motion>,
    ) -> Option<Self> {
        let legs = mechanism
            .actuators
            .iter()
            .map(|actuator| match actuator.joint {
                JointIndex::Prismatic(joint) => leg(mechanism, joint, carried, origin),
                JointIndex::Revolute(_) => None,
            })
            .collect::<Option<Vec<Leg>>>()?;
        let mut parts: Vec<usize> =
            legs.iter().flat_map(|leg| leg.parts.map(|(body, ..)| body)).chain([carried]).collect();
        parts.sort_unstable();
        parts.dedup();
        let bodies = mechanism.bodies.len();
        let whole = parts.len() == bodies
            && legs.len() == 3
            && mechanism.prismatics.len() == 3
            && mechanism.revolutes.len() == 6;
        let kept = motion.kept_angle().map(Rotation2::new);
        whole.then_some(Self { legs, carried, centre: -origin, bodies, motion, kept })
    }

    /// States of all bodies at one point of the motion, joints closed. With u the leg's direction and
    /// d from its anchor to its corner, the leg turns at `(d × ḋ)/|d|²`.
    pub fn states(&self, t: f64) -> Vec<BodyState> {
        let point = &self.motion.at(t);
        let turned = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let rotation = Rotation2::new(point.pose.z);
        let mut states = vec![BodyState::ground(); self.bodies];
        for leg in &self.legs {
            let arm = rotation * leg.corner;
            let d = leg.span(point.pose);
            let end = point.pose.xy() + arm;
            let end_rate = point.rate.xy() + turned(arm) * point.rate.z;
            let u = d.normalize();
            let spin = d.perp(&end_rate) / d.norm_squared();
            let pins = [(leg.anchor, Vector2::zeros()), (end, end_rate)];
            for ((body, pin, axis), (place, rate)) in leg.parts.into_iter().zip(pins) {
                let rotation = UnitComplex::from_cos_sin_unchecked(u.x, u.y) * axis.inverse();
                let to_centre = -(rotation * pin);
                let velocity = rate + turned(to_centre) * spin;
                states[body] = BodyState {
                    position: place + to_centre,
                    rotation,
                    twist: Vector3::new(velocity.x, velocity.y, spin),
                };
            }
        }
        let arm = rotation * self.centre;
        let velocity = point.rate.xy() + turned(arm) * point.rate.z;
        states[self.carried] = BodyState {
            position: point.pose.xy() + arm,
            rotation: UnitComplex::new(point.pose.z),
            twist: Vector3::new(velocity.x, velocity.y, point.rate.z),
        };
        states
    }
}

impl Leg {
    /// From the anchor to the corner in m, for the carried body's pose (m, m, rad).
    fn span(&self, pose: Vector3<f64>) -> Vector2<f64> {
        pose.xy() + Rotation2::new(pose.z) * self.corner - self.anchor
    }

    /// Coordinate and its first and second time derivative: with d from anchor to corner,
    /// `q = |d|`, `q̇ = d·ḋ/q`, `q̈ = (ḋ·ḋ + d·d̈ − q̇²)/q`.
    fn command(&self, rotation: Rotation2<f64>, point: &PathPoint) -> Command {
        let arm = rotation * self.corner;
        let normal = Vector2::new(-arm.y, arm.x);
        let (omega, alpha) = (point.rate.z, point.acceleration.z);
        let d = point.pose.xy() + arm - self.anchor;
        let rate = point.rate.xy() + normal * omega;
        let acceleration = point.acceleration.xy() + normal * alpha - arm * (omega * omega);
        let length = d.norm();
        let length_rate = d.dot(&rate) / length;
        Command {
            position: length + self.excess,
            rate: length_rate,
            acceleration: (rate.norm_squared() + d.dot(&acceleration) - length_rate * length_rate)
                / length,
        }
    }
}

impl Commands for TelescopicLegs {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let point = self.motion.at(t);
        let rotation = self.kept.unwrap_or_else(|| Rotation2::new(point.pose.z));
        for (command, leg) in commands.iter_mut().zip(&self.legs) {
            *command = leg.command(rotation, &point);
        }
    }
}

/// The leg that prismatic joint `index` is in, if it carries the body `carried` and touches nothing else.
fn leg(mechanism: &Mechanism, index: usize, carried: usize, origin: Vector2<f64>) -> Option<Leg> {
    let joint = &mechanism.prismatics[index];
    let (base, slider) = (joint.base.body?, joint.slider.body?);
    let on = |revolute: &Revolute, body: usize| revolute.bodies().contains(&Some(body));
    let pin = |body: usize, other: Option<usize>| {
        let mut pins = mechanism.revolutes.iter().filter(|revolute| on(revolute, body));
        let revolute = pins.next()?;
        if pins.next().is_some() {
            return None;
        }
        let (own, far): (&Attachment, &Attachment) = if revolute.ring.body == Some(body) {
            (&revolute.ring, &revolute.journal)
        } else {
            (&revolute.journal, &revolute.ring)
        };
        (far.body == other).then_some((own.point, far.point))
    };
    let (base_pin, anchor) = pin(base, None)?;
    let (slider_pin, corner) = pin(slider, Some(carried))?;
    let slides = |body: usize| {
        mechanism.prismatics.iter().filter(|joint| joint.bodies().contains(&Some(body))).count()
    };
    if slides(base) != 1 || slides(slider) != 1 {
        return None;
    }
    // Pins from the points between which the coordinate counts, along and across the axis.
    let [base_point, slider_point] = joint.points();
    let from_base = joint.axes[0].inverse() * base_pin - base_point;
    let from_slider = joint.axes[1].inverse() * slider_pin - slider_point;
    if from_base.y != from_slider.y {
        return None;
    }
    Some(Leg {
        anchor,
        corner: corner - origin,
        excess: from_base.x - from_slider.x,
        parts: [(base, base_pin, joint.axes[0]), (slider, slider_pin, joint.axes[1])],
    })
}
