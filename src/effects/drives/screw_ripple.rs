//! A screw that is not quite even: an error, or a force, that repeats with each turn.

use crate::effects::kind::{Scan, ScanRange, defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{JointIndex, Load, Mechanism, ReadingError, Situation};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "screw-ripple",
    summary: "an error of the length, or a force, that repeats with each turn of the actuator's screw",
    equation: "true length = read length + amplitude_m sin(2 pi read/pitch + phase), and a force \
               amplitude_N sin(2 pi read/pitch + phase) on the rod",
    source: "definition",
    trace: "measured pose against measured lengths (or the actuator's force): with the length, periodic",
    targets: Targets::JointOrAll(JointKinds::DrivenPrismatic),
    parameters: &[
        Parameter::size("amplitude_m", "m", "amplitude of the error of the length", 5e-3, 2e-6),
        Parameter::size("amplitude_N", "N", "amplitude of the force", 1e3, 0.05),
        Parameter {
            name: "pitch_m",
            unit: "m",
            about: "length of one turn",
            bounds: [5e-4, 0.1],
            step: 1e-6,
            default: Some(5e-3),
        },
        Parameter {
            name: "phase_rad",
            unit: "rad",
            about: "phase at read length 0",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["amplitude_m", "pitch_m", "phase_rad"], &["amplitude_N", "pitch_m", "phase_rad"]],
    neutral: defaults,
    starts: linear,
    // From 20 mm to 1 mm a turn, finer than a stroke of 0.2 m can tell apart.
    scan: Some(Scan {
        over: "pitch_m",
        phase: "phase_rad",
        range: ScanRange::WaveNumbers([50.0, 1000.0, 4.0]),
    }),
    apply,
};

#[derive(Clone, Copy, Debug)]
struct ScrewRipple {
    joint: usize,
    amplitude: f64,
    pitch: f64,
    phase: f64,
}

impl ScrewRipple {
    /// Value and first and second derivative by the read length.
    fn wave(&self, read: f64) -> [f64; 3] {
        let number = TAU / self.pitch;
        let (sin, cos) = (number * read + self.phase).sin_cos();
        [sin, cos * number, -sin * number * number].map(|x| x * self.amplitude)
    }
}

impl ReadingError for ScrewRipple {
    fn at(&self, read: f64) -> [f64; 3] {
        self.wave(read)
    }
}

impl Load for ScrewRipple {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [length, rate] = at.length(self.joint);
        let read = at.reading(self.joint, [length, rate]);
        at.push_rod(self.joint, self.wave(read)[0], wrenches);
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [length, force, pitch, phase] =
        ["amplitude_m", "amplitude_N", "pitch_m", "phase_rad"].map(|name| setting.number(name));
    for drive in setting.drives(mechanism)? {
        let JointIndex::Prismatic(joint) = mechanism.actuators[drive].joint else { continue };
        let ripple = |amplitude| ScrewRipple { joint, amplitude, pitch, phase };
        if length != 0.0 {
            mechanism.actuators[drive].reading_errors.push(Arc::new(ripple(length)));
        }
        if force != 0.0 {
            mechanism.loads.push(Arc::new(ripple(force)));
        }
    }
    Ok(())
}
