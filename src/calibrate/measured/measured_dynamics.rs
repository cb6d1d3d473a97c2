//! A 3-RPR without clearance at measured poses: the forces that its motion takes, and which way journals lean under them.

use crate::contact::Friction;
use crate::mechanism::{Bearing, Body, BodyState, Mechanism, Revolute, Situation};
use nalgebra::{Matrix3, UnitComplex, Vector2, Vector3};

/// A 3-RPR at measured poses.
pub struct MeasuredMachine<'a> {
    mechanism: &'a Mechanism,
    states: Vec<BodyState>,
    wrenches: Vec<Vector3<f64>>,
}

/// What the dynamics say at one instant.
pub struct DynamicsLook {
    /// Force of each drive by inverse dynamics, N.
    pub forces: [f64; 3],
    /// By how much the journals' leaning lengthens each leg as a vector, m.
    pub leans: [Vector2<f64>; 3],
}

/// Pose (m, m, rad) of the platform's reference point, its rate and acceleration.
#[derive(Clone, Copy)]
pub struct PlatformMotion {
    pub pose: Vector3<f64>,
    pub rate: Vector3<f64>,
    pub acceleration: Vector3<f64>,
}

impl PlatformMotion {
    /// Position, velocity and acceleration of a point that is fixed to the platform, by its place (m) from the reference
    /// point.
    fn of(&self, point: Vector2<f64>) -> [Vector2<f64>; 3] {
        let Self { pose, rate, acceleration } = self;
        let arm = UnitComplex::new(pose.z) * point;
        let velocity = rate.xy() + turned(arm) * rate.z;
        let second = acceleration.xy() + turned(arm) * acceleration.z - arm * rate.z.powi(2);
        [pose.xy() + arm, velocity, second]
    }
}

/// Measured acceleration of a leg's rod in m/s² as encoders read it, and what it truly is; none where nobody reads it.
type Rod = Option<[f64; 2]>;

/// How a leg lies and turns at one instant.
#[derive(Clone, Copy)]
struct MeasuredLeg {
    /// Unit vectors along it and across.
    axes: [Vector2<f64>; 2],
    /// From ring to ring in m, and its rates.
    span: f64,
    span_rate: f64,
    span_second: f64,
    /// Rate of turning in rad/s, and its rate.
    spin: f64,
    spin_rate: f64,
}

impl MeasuredLeg {
    /// The leg that leads to a corner of the platform with this motion from a base at rest.
    fn between(base: Vector2<f64>, [corner, rate, second]: [Vector2<f64>; 3]) -> Self {
        let d = corner - base;
        let q = d.norm();
        let u = d / q;
        let n = turned(u);
        let (q_rate, omega) = (rate.dot(&u), rate.dot(&n) / q);
        let q_second = second.dot(&u) + q * omega * omega;
        let alpha = (second.dot(&n) - 2.0 * q_rate * omega) / q;
        Self {
            axes: [u, n],
            span: q,
            span_rate: q_rate,
            span_second: q_second,
            spin: omega,
            spin_rate: alpha,
        }
    }
}

/// What friction in joints makes of the balance at one instant.
struct JointRubbing<'a> {
    /// Forces of each leg's joints in N, base and top.
    joint_forces: &'a [[Vector2<f64>; 2]; 3],
    /// The platform's rate of turning in rad/s.
    platform_spin: f64,
}

/// What keeps bodies in balance.
struct BodyBalance {
    /// Force of each rod's end on the platform, along and across its leg, N.
    along: Vector3<f64>,
    across: [f64; 3],
}

fn turned(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}

impl<'a> MeasuredMachine<'a> {
    pub fn new(mechanism: &'a Mechanism) -> Self {
        let bodies = mechanism.bodies.len();
        Self {
            mechanism,
            states: vec![BodyState::ground(); bodies],
            wrenches: vec![Vector3::zeros(); bodies],
        }
    }

    /// From ring to ring in m: C_i − A_i at a pose (m, m, rad) of the platform's reference point.
    fn span(&self, leg: usize, pose: Vector3<f64>) -> Vector2<f64> {
        let platform = &self.mechanism.bodies[self.mechanism.output];
        let [base, top] = [leg, leg + 3].map(|joint| self.mechanism.revolutes[joint].ring.point);
        pose.xy() + UnitComplex::new(pose.z) * (top - platform.reference) - base
    }

    /// Length of a leg in m whose journals lean by `lean` (m).
    pub fn length(&self, leg: usize, pose: Vector3<f64>, lean: Vector2<f64>) -> f64 {
        (self.span(leg, pose) + lean).norm()
    }

    /// What the dynamics say at a time (s) of a platform's motion, rods that accelerate like this, and measured forces (N).
    pub fn look(
        &mut self,
        t: f64,
        motion: PlatformMotion,
        rods: [Rod; 3],
        measured: [f64; 3],
    ) -> DynamicsLook {
        let mut needed = vec![Vector3::zeros(); self.mechanism.bodies.len()];
        self.move_platform(&motion, &mut needed);
        let legs = [0, 1, 2].map(|leg| self.move_leg(leg, &motion, rods[leg], &mut needed));
        self.take_off_given(t, &mut needed);
        // Friction in the joints depends on their forces: once without, once with it.
        let mut joint_forces = [[Vector2::zeros(); 2]; 3];
        let mut look = DynamicsLook { forces: [0.0; 3], leans: [Vector2::zeros(); 3] };
        let rubbing = self.mechanism.revolutes.iter().any(|joint| friction(joint).is_some());
        for pass in 0..=usize::from(rubbing) {
            let rubbing = (pass > 0).then_some(JointRubbing {
                joint_forces: &joint_forces,
                platform_spin: motion.rate.z,
            });
            let BodyBalance { along, across } = self.balance(&legs, &needed, rubbing);
            for leg in 0..3 {
                let [u, n] = legs[leg].axes;
                let joint = &self.mechanism.prismatics[leg];
                let rod = joint.slider.body.map_or_else(Vector3::zeros, |b| needed[b]);
                let cylinder = joint.base.body.map_or_else(Vector3::zeros, |b| needed[b]);
                let rod_along = rod.xy().dot(&u);
                // What an error of the encoder adds turns fast: which way journals lean is none of its matter.
                let mass = joint.slider.body.map_or(0.0, |b| self.mechanism.bodies[b].mass);
                let unread = rods[leg].map_or(0.0, |[read, truth]| mass * (truth - read));
                look.forces[leg] = rod_along + unread - along[leg];
                let top = u * (rod_along - measured[leg]) + n * across[leg];
                let base = rod.xy() + cylinder.xy() - top;
                joint_forces[leg] = [base, top];
                look.leans[leg] = self.lean(leg + 3, top) - self.lean(leg, base);
            }
        }
        look
    }

    /// Puts the platform where it was measured, and what it needs as force: M a.
    fn move_platform(&mut self, motion: &PlatformMotion, needed: &mut [Vector3<f64>]) {
        let output = self.mechanism.output;
        let platform = &self.mechanism.bodies[output];
        let [position, velocity, second] = motion.of(-platform.reference);
        let twist = Vector3::new(velocity.x, velocity.y, motion.rate.z);
        self.states[output] =
            BodyState { position, rotation: UnitComplex::new(motion.pose.z), twist };
        needed[output] = Vector3::new(
            platform.mass * second.x,
            platform.mass * second.y,
            platform.inertia * motion.acceleration.z,
        );
    }

    /// The same of the bodies of a leg.
    fn move_leg(
        &mut self,
        leg: usize,
        motion: &PlatformMotion,
        rod: Rod,
        needed: &mut [Vector3<f64>],
    ) -> MeasuredLeg {
        let mechanism = self.mechanism;
        let joint = &mechanism.prismatics[leg];
        let base = mechanism.revolutes[leg].ring.point;
        let top = mechanism.revolutes[leg + 3].ring.point;
        let reference = mechanism.bodies[mechanism.output].reference;
        let moved = MeasuredLeg::between(base, motion.of(top - reference));
        let MeasuredLeg { axes: [u, n], span, spin, spin_rate, .. } = moved;
        let rotation = UnitComplex::from_cos_sin_unchecked(u.x, u.y);
        // Distances of the centres of mass from A, and their rates along the leg.
        let parts = [
            (joint.base.body, -joint.base.point.x, 0.0, 0.0),
            (
                joint.slider.body,
                span - joint.slider.point.x,
                moved.span_rate,
                rod.map_or(moved.span_second, |[read, _]| read),
            ),
        ];
        for (body, s, s_rate, s_second) in parts {
            let Some(body) = body else { continue };
            let velocity = u * s_rate + n * (s * spin);
            let twist = Vector3::new(velocity.x, velocity.y, spin);
            self.states[body] = BodyState { position: base + u * s, rotation, twist };
            let a = u * (s_second - s * spin * spin) + n * (s * spin_rate + 2.0 * s_rate * spin);
            let Body { mass, inertia, .. } = &mechanism.bodies[body];
            needed[body] = Vector3::new(mass * a.x, mass * a.y, inertia * spin_rate);
        }
        moved
    }

    /// Takes off what gravity and loads give: the rest is left for joints and drives.
    fn take_off_given(&mut self, t: f64, needed: &mut [Vector3<f64>]) {
        let mechanism = self.mechanism;
        for (wrench, body) in self.wrenches.iter_mut().zip(&mechanism.bodies) {
            *wrench = (mechanism.gravity * body.mass).push(0.0);
        }
        for load in &mechanism.loads {
            load.add(
                Situation { t, mechanism, states: &self.states, angles: None },
                &mut self.wrenches,
            );
        }
        for (needed, given) in needed.iter_mut().zip(&self.wrenches) {
            *needed -= given;
        }
    }

    /// What legs have to do for all bodies to move like this.
    fn balance(
        &self,
        legs: &[MeasuredLeg; 3],
        needed: &[Vector3<f64>],
        rubbing: Option<JointRubbing>,
    ) -> BodyBalance {
        let mechanism = self.mechanism;
        let centre = self.states[mechanism.output].position;
        let mut matrix = Matrix3::zeros();
        let mut rhs = needed[mechanism.output];
        let mut across = [0.0; 3];
        for leg in 0..3 {
            let MeasuredLeg { axes: [u, n], span, spin, .. } = legs[leg];
            let base = mechanism.revolutes[leg].ring.point;
            let mut moment = 0.0;
            let joint = &mechanism.prismatics[leg];
            for body in [joint.base.body, joint.slider.body].into_iter().flatten() {
                let arm = self.states[body].position - base;
                moment += arm.perp(&needed[body].xy()) + needed[body].z;
            }
            if let Some(JointRubbing { joint_forces, platform_spin }) = rubbing {
                let torques =
                    [(leg, spin), (leg + 3, spin - platform_spin)].map(|(joint, slip)| {
                        let force = joint_forces[leg][joint / 3].norm();
                        friction(&mechanism.revolutes[joint])
                            .map_or(0.0, |(law, radius)| -radius * law.force(force, slip * radius))
                    });
                moment -= torques[0] + torques[1];
                rhs.z += torques[1];
            }
            across[leg] = moment / span;
            // The rod's end pushes the platform by −(s u + across n).
            let arm = base + u * span - centre;
            let push = n * across[leg];
            rhs += Vector3::new(push.x, push.y, arm.perp(&push));
            matrix.set_column(leg, &-Vector3::new(u.x, u.y, arm.perp(&u)));
        }
        BodyBalance { along: matrix.lu().solve(&rhs).unwrap_or_default(), across }
    }

    /// By how much a joint's journal leans from its ring's centre under a force (N), m.
    fn lean(&self, joint: usize, force: Vector2<f64>) -> Vector2<f64> {
        let size = force.norm();
        match &self.mechanism.revolutes[joint].bearing {
            Bearing::Clearance(clearance) if size > 0.0 => {
                let depth = clearance.law.resting_penetration(size);
                force * (-(clearance.radial() + depth) / size)
            }
            _ => Vector2::zeros(),
        }
    }
}

/// Friction of a joint and its journal's radius in m, if it rubs.
fn friction(joint: &Revolute) -> Option<(Friction, f64)> {
    match &joint.bearing {
        Bearing::Clearance(clearance) => Some((clearance.friction?, clearance.journal_radius)),
        Bearing::Ideal | Bearing::Native { .. } => None,
    }
}
