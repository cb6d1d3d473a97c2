//! Dry friction in a pivot that holds: before it slides it gives way like bristles.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Memory, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "bristle-friction",
    summary: "dry friction in a revolute joint with true rest: an arm that stops stays, held by bristles that \
              have bent",
    equation: "torque -(s0 z + s1 exp(-(w/w_d)^2) dz/dt) between the two bodies, dz/dt = w - |w| z/d, s0 = \
               T_c/d, w_d = d sqrt(s0/J); w the rate at which the joint turns, J its inertia",
    source: "Dahl, A solid friction model, Aerospace Corporation TOR-0158 (1968), of ball bearings; the damping \
             s1: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419-425, and \
             its fading: Olsson et al., European J. of Control 4 (1998) 176-195",
    trace: "free swings: the amplitude falls by the same angle each time, and the arm comes to rest; the \
            smallest swings are a little fast",
    targets: Targets::JointOrAll(JointKinds::Revolute),
    parameters: &[
        Parameter::size("coulomb_Nm", "N m", "dry friction torque T_c", 1e3, 1e-4),
        Parameter {
            name: "presliding_rad",
            unit: "rad",
            about: "angle d over which the bristles bend before the joint slides: a ball bearing's are \
                    fractions of a degree",
            bounds: [1e-6, 0.1],
            step: 1e-4,
            default: Some(1e-3),
        },
        Parameter {
            name: "damping_Nms",
            unit: "N m s",
            about: "damping s1 of the bristles; where not given, 2 sqrt(s0 J): an arm on bent bristles comes to \
                    rest without swinging on",
            bounds: [0.0, 1e3],
            step: 1e-5,
            default: None,
        },
    ],
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// The bristles of one revolute joint. Their memory is the joint's angle in rad and the deflection z in
/// rad, both at the end of the last step.
#[derive(Debug)]
struct Bristles {
    joint: usize,
    coulomb: f64,
    presliding: f64,
    damping: f64,
    /// w_d in rad/s.
    fading: f64,
}

impl Bristles {
    /// Angle in rad of the journal's body against the ring's.
    fn angle(&self, at: Situation) -> f64 {
        let joint = &at.mechanism.revolutes[self.joint];
        let rotation = joint.ring.rotation(at.states).inverse() * joint.journal.rotation(at.states);
        rotation.angle()
    }

    /// Deflection after the joint has turned to `angle` one way: `dz/dθ = 1 − z/(±d)` solved exactly.
    fn deflection(&self, angle: f64, [before, z]: Memory) -> f64 {
        let half = std::f64::consts::PI;
        let turned = (angle - before + half).rem_euclid(2.0 * half) - half;
        let end = self.presliding.copysign(turned);
        z + (z - end) * (-turned.abs() / self.presliding).exp_m1()
    }

    fn push(&self, at: Situation, z: f64, wrenches: &mut [Vector3<f64>]) {
        let rate = at.turning(self.joint);
        let bending = rate - rate.abs() * z / self.presliding;
        let damping = self.damping * (-(rate / self.fading).powi(2)).exp();
        let torque = self.coulomb * z / self.presliding + damping * bending;
        at.push_turn(self.joint, -torque, wrenches);
    }

    /// Deflection of a joint that has long turned as it does now.
    fn settled(&self, at: Situation) -> f64 {
        let rate = at.turning(self.joint);
        if rate == 0.0 { 0.0 } else { self.presliding.copysign(rate) }
    }
}

impl Load for Bristles {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        self.push(at, self.settled(at), wrenches);
    }

    /// What moves has moved like that before; what rests has bristles that stand upright.
    fn begin(&self, at: Situation) -> Memory {
        [self.angle(at), self.settled(at)]
    }

    fn remember(&self, at: Situation, memory: Memory) -> Memory {
        let angle = self.angle(at);
        [angle, self.deflection(angle, memory)]
    }

    fn add_after(&self, at: Situation, memory: Memory, wrenches: &mut [Vector3<f64>]) {
        self.push(at, self.deflection(self.angle(at), memory), wrenches);
    }

    /// A spring s0 and a damper of twice s1 (when the bristles are bent back) on J: `h ≤ √(J/s0)`,
    /// `h ≤ J/(2 s1)`.
    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let lightness = mechanism.joint_lightness(self.joint);
        let stiff = (self.coulomb / self.presliding * lightness).sqrt();
        let steepest = stiff.max(2.0 * self.damping * lightness);
        (steepest > 0.0).then(|| 1.0 / steepest)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [coulomb, presliding] = ["coulomb_Nm", "presliding_rad"].map(|name| setting.number(name));
    for joint in setting.revolutes(mechanism)? {
        let stiffness = coulomb / presliding;
        let lightness = mechanism.joint_lightness(joint);
        let damping =
            setting.value("damping_Nms").unwrap_or_else(|| 2.0 * (stiffness / lightness).sqrt());
        // Without friction there is nothing to fade.
        let fading = (presliding * (stiffness * lightness).sqrt()).max(f64::MIN_POSITIVE);
        mechanism.loads.push(Arc::new(Bristles { joint, coulomb, presliding, damping, fading }));
    }
    Ok(())
}
