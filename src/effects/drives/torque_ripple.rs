//! A torque that repeats with each turn of a driven joint: cogging of a motor, a gear's teeth.

use crate::effects::kind::{Scan, ScanRange, defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{JointIndex, Load, Mechanism, Memory, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "torque-ripple",
    summary: "a torque that repeats with the angle of a driven joint: cogging of its motor, teeth of its gear",
    equation: "torque amplitude sin(per_turn q + phase) on the journal's body, q the joint's angle",
    source: "a Fourier term of cogging torque: Hanselman, Brushless Permanent Magnet Motor Design (2003)",
    trace: "the torque of that drive: with the angle, periodic, the same at all speeds",
    targets: Targets::Joint(JointKinds::DrivenRevolute),
    parameters: &[
        Parameter::size("amplitude", "N m", "amplitude of the torque", 1e3, 1e-3),
        Parameter {
            name: "per_turn",
            unit: "",
            about: "waves in a turn: of a motor with a gear not always a whole number",
            bounds: [0.1, 1e3],
            step: 1e-3,
            default: Some(6.0),
        },
        Parameter {
            name: "phase_rad",
            unit: "rad",
            about: "phase at angle 0",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["amplitude", "per_turn", "phase_rad"]],
    neutral: defaults,
    starts: linear,
    // A motor without a gear repeats a whole number of times; finer waves than 64 are over before a servo
    // of usual bandwidth feels them.
    scan: Some(Scan {
        over: "per_turn",
        phase: "phase_rad",
        range: ScanRange::Orders([1.0, 64.0, 1.0]),
    }),
    apply,
};

/// The ripple of one joint; its memory is the angle of the last step's end, for whole turns count where a
/// turn is no whole number of waves.
#[derive(Debug)]
struct TorqueRipple {
    joint: JointIndex,
    amplitude: f64,
    per_turn: f64,
    phase: f64,
}

impl Load for TorqueRipple {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        self.add_after(at, self.begin(at), wrenches);
    }

    fn begin(&self, at: Situation) -> Memory {
        [at.counted_from(self.joint), 0.0]
    }

    fn remember(&self, at: Situation, memory: Memory) -> Memory {
        [at.coordinate(self.joint, memory[0])[0], 0.0]
    }

    fn add_after(&self, at: Situation, memory: Memory, wrenches: &mut [Vector3<f64>]) {
        let [angle, _] = at.coordinate(self.joint, memory[0]);
        let torque = self.amplitude * (self.per_turn * angle + self.phase).sin();
        at.push_joint(self.joint, torque, wrenches);
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [amplitude, per_turn, phase] =
        ["amplitude", "per_turn", "phase_rad"].map(|name| setting.number(name));
    for joint in setting.joints(mechanism)? {
        mechanism.loads.push(Arc::new(TorqueRipple { joint, amplitude, per_turn, phase }));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{TURNTABLE, rows};

    /// A drive that turns evenly gives back what the ripple takes.
    #[test]
    fn at_a_steady_turn_the_drive_gives_the_ripple_back() {
        let keys = "joint = \"O\"\namplitude = 0.2\nper_turn = 2.5\nphase_rad = 0.4\n";
        let text = format!("{TURNTABLE}[[effect]]\nkind = \"torque-ripple\"\n{keys}");
        // Twice round within 0.5 s.
        let text = text
            .replace("\"servo\"\nstiffness = 400.0\ndamping = 1.5", "\"prescribed\"")
            .replace("velocity = 0.0", "velocity = 25.0");
        let mut largest = 0.0f64;
        for (t, effort, _) in rows(&text, 0.5) {
            let torque = 0.2 * (2.5 * (0.5 + 25.0 * t) + 0.4).sin();
            assert!((effort + torque).abs() < 1e-6, "{t}: {effort} {torque}");
            largest = largest.max(effort.abs());
        }
        assert!((largest - 0.2).abs() < 1e-2, "{largest}");
    }
}
