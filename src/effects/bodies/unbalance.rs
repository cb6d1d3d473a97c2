//! A rotor out of balance on a body.

use crate::effects::kind::{Scan, ScanRange, defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "unbalance",
    summary: "a rotor out of balance at the centre of mass of a body (the platform, where none is named): a spindle, \
              a fan",
    equation: "force m r w^2 [cos, sin](w t + phase) at the centre of mass as declared, w = 2 pi f",
    source: "centrifugal force",
    trace: "actuator forces: one frequency, a force on the body that goes round",
    targets: Targets::Body,
    parameters: &[
        Parameter::size(
            "mass_radius_kg_m",
            "kg m",
            "mass times its distance from the axis",
            1.0,
            1e-6,
        ),
        Parameter {
            name: "frequency_Hz",
            unit: "Hz",
            about: "turns per second",
            bounds: [0.1, 500.0],
            step: 1e-3,
            default: Some(10.0),
        },
        Parameter {
            name: "phase_rad",
            unit: "rad",
            about: "direction at t = 0",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["mass_radius_kg_m", "frequency_Hz", "phase_rad"]],
    neutral: defaults,
    starts: linear,
    scan: Some(Scan { over: "frequency_Hz", phase: "phase_rad", range: ScanRange::Frequencies }),
    apply,
};

#[derive(Debug)]
struct UnbalancedRotor {
    centre: Mark,
    mass_radius: f64,
    omega: f64,
    phase: f64,
}

impl Load for UnbalancedRotor {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let (sin, cos) = (self.omega * at.t + self.phase).sin_cos();
        let force = Vector2::new(cos, sin) * (self.mass_radius * self.omega * self.omega);
        at.push_point(self.centre, force, 0.0, wrenches);
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(UnbalancedRotor {
        centre,
        mass_radius: setting.number("mass_radius_kg_m"),
        omega: TAU * setting.number("frequency_Hz"),
        phase: setting.number("phase_rad"),
    }));
    Ok(())
}
