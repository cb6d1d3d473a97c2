//! A base that shakes.

use crate::effects::kind::{Scan, ScanRange, defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

const fn component(name: &'static str, about: &'static str) -> Parameter {
    Parameter {
        name,
        unit: "m/s^2",
        about,
        bounds: [-100.0, 100.0],
        step: 0.02,
        default: Some(0.0),
    }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "base-vibration",
    summary: "a base that shakes; all motion is measured relative to it",
    equation: "the base accelerates with a sin(2 pi f t + phase): force -m a sin(...) on every body",
    source: "inertial force in an accelerated frame",
    trace: "actuator forces: one frequency, on the legs as on the platform, in proportion to mass",
    targets: Targets::Machine,
    parameters: &[
        component("ax_m_s2", "amplitude along x"),
        component("ay_m_s2", "amplitude along y"),
        Parameter {
            name: "frequency_Hz",
            unit: "Hz",
            about: "frequency f",
            bounds: [0.1, 500.0],
            step: 1e-3,
            default: Some(10.0),
        },
        Parameter {
            name: "phase_rad",
            unit: "rad",
            about: "phase at t = 0",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["ax_m_s2", "ay_m_s2", "frequency_Hz", "phase_rad"]],
    neutral: defaults,
    starts: linear,
    scan: Some(Scan { over: "frequency_Hz", phase: "phase_rad", range: ScanRange::Frequencies }),
    apply,
};

#[derive(Debug)]
struct Shaking {
    acceleration: Vector2<f64>,
    frequency: f64,
    phase: f64,
}

impl Load for Shaking {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let a = self.acceleration * (TAU * self.frequency * at.t + self.phase).sin();
        for (wrench, body) in wrenches.iter_mut().zip(&at.mechanism.bodies) {
            *wrench -= Vector3::new(a.x, a.y, 0.0) * body.mass;
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    mechanism.loads.push(Arc::new(Shaking {
        acceleration: Vector2::new(setting.number("ax_m_s2"), setting.number("ay_m_s2")),
        frequency: setting.number("frequency_Hz"),
        phase: setting.number("phase_rad"),
    }));
    Ok(())
}
