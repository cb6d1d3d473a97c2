//! Oil in the gap between journal and bearing.

use super::kind::{defaults, linear};
use super::{Joints, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Load, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind {
    name: "lubricant-film",
    summary: "oil in the gap between journal and bearing: it resists being squeezed out",
    equation: "force on the journal -C (1 + 2 eps^2)/(1 - eps^2)^(5/2) along the line of centres and \
               -C/(1 - eps^2)^(3/2) across, times the velocity of its centre in axes that turn with the \
               mean of both bodies; eps = eccentricity/clearance, taken as at most eps_max; \
               C = pi mu R L^3/c^3 for viscosity mu, radius R, width L, clearance c",
    source: "short bearing, full film: Ocvirk, NACA TN 2808 (1952); Booker, J. Basic Eng. 87 (1965) 537-546",
    trace: "rattle: slower and softer hits; forces of the joints with the speed of their journals",
    targets: Targets::JointOrAll(Joints::Bearing),
    parameters: &[
        Parameter::size(
            "damping_Ns_m",
            "N s/m",
            "C, the damping of a centred journal: 25 for oil of 0.1 Pa s in a bearing with R = L = 10 mm and \
             c = 0.5 mm",
            1e5,
            0.2,
        ),
        Parameter {
            name: "eccentricity_max",
            unit: "",
            about: "eps_max, from which the film grows no stiffer: surfaces are rough, and films tear; steps shorten with its stiffness there",
            bounds: [0.0, 0.99],
            step: 0.01,
            default: Some(0.8),
        },
    ],
    variants: &[&["damping_Ns_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// The film of one revolute joint.
#[derive(Debug)]
struct Film {
    joint: usize,
    damping: f64,
    eccentricity_max: f64,
}

/// Radial clearance in m; an ideal joint has no gap for a film.
fn gap(bearing: &Bearing) -> Option<f64> {
    match bearing {
        Bearing::Ideal => None,
        Bearing::Clearance(clearance) => Some(clearance.radial()),
        Bearing::Native { bearing_radius, journal_radius, .. } => {
            Some(bearing_radius - journal_radius)
        }
    }
}

impl Film {
    /// Damping in N·s/m along and across the line of centres, at the eccentricity ratio `ratio`.
    fn coefficients(&self, ratio: f64) -> [f64; 2] {
        let square = ratio.min(self.eccentricity_max).powi(2);
        let closing = 1.0 - square;
        let across = self.damping / (closing * closing.sqrt());
        [across * (1.0 + 2.0 * square) / closing, across]
    }
}

impl Load for Film {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let joint = &at.mechanism.revolutes[self.joint];
        let Some(clearance) = gap(&joint.bearing) else { return };
        let (ring, journal) = (joint.ring.frame(at.states), joint.journal.frame(at.states));
        let e = journal.centre - ring.centre;
        let turned = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let velocity =
            journal.velocity - ring.velocity - turned(e) * (0.5 * (ring.spin + journal.spin));
        let [along, across] = self.coefficients(e.norm() / clearance);
        let n = e.try_normalize(0.0).unwrap_or(Vector2::x());
        let radial = n * velocity.dot(&n);
        let force = -radial * along - (velocity - radial) * across;
        // Through the journal's centre, on both: no moment is made or lost.
        let pushes =
            [(joint.journal.body, journal.arm, force), (joint.ring.body, ring.arm + e, -force)];
        for (body, arm, force) in pushes {
            if let Some(body) = body {
                wrenches[body] += Vector3::new(force.x, force.y, arm.perp(&force));
            }
        }
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let joint = &mechanism.revolutes[self.joint];
        let [stiffest, _] = self.coefficients(1.0);
        let felt = gap(&joint.bearing).is_some() && stiffest > 0.0;
        felt.then(|| mechanism.joint_mass(joint) / stiffest)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for joint in setting.revolutes(mechanism)? {
        mechanism.loads.push(Arc::new(Film {
            joint,
            damping: setting.number("damping_Ns_m"),
            eccentricity_max: setting.number("eccentricity_max"),
        }));
    }
    Ok(())
}
