//! A drive whose force comes later than its controller asks for it.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Drive, Mechanism};

pub(in crate::effects) const KIND: Kind = Kind {
    name: "drive-lag",
    summary: "a drive whose force follows what its sampled controller asks for later than declared",
    equation: "(lag + lag_s) dF/dt + F = G u, u what the controller holds",
    source: "a current loop of first order",
    trace: "what the controller asks for, against the motion: with the jerk",
    targets: Targets::Joint(JointKinds::Sampled),
    parameters: &[Parameter {
        name: "lag_s",
        unit: "s",
        about: "lag beyond the declared one; what would leave less than none leaves none",
        bounds: [-0.1, 0.1],
        step: 1e-5,
        default: Some(0.0),
    }],
    variants: &[&["lag_s"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for joint in setting.joints(mechanism)? {
        for actuator in mechanism.actuators.iter_mut().filter(|drive| drive.joint == joint) {
            if let Drive::Sampled(cascade) = &mut actuator.drive {
                cascade.lag = (cascade.lag + setting.number("lag_s")).max(0.0);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::mechanism::Drive;
    use crate::model::assemble;
    use crate::scenario::Scenario;

    #[test]
    fn the_lag_is_the_declared_one_and_more() {
        let stage = include_str!("../../../assets/drive-stage.toml");
        let effect = "[[effect]]\nkind = \"drive-lag\"\njoint = \"P1\"\nlag_s = 3e-4\n";
        let rig = Scenario::from_text(&format!("{stage}\n{effect}"), "rig", &[]).unwrap();
        let Drive::Sampled(cascade) = assemble(&rig).unwrap().mechanism.actuators[0].drive else {
            panic!("a sampled controller");
        };
        assert!((cascade.lag - 5e-4).abs() < 1e-12);
    }
}
