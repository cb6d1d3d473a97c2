//! The rotor of a motor behind a gear.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{JointIndex, Mechanism, Rotor};

pub(in crate::effects) const KIND: Kind = Kind {
    name: "rotor-inertia",
    summary: "a motor's rotor that a revolute joint spins through a gear, its housing on the ring's body",
    equation: "energy 1/2 J (w_j - w_r + coupling w_r)^2 beside the bodies'; J = n^2 I, I the rotor's own inertia, \
               n the gear's ratio, w_r and w_j the rates of the bodies of ring and journal",
    source: "Spong, J. Dyn. Sys. Meas. Control 109 (1987) 310-319, with the term in 1/n that it leaves out",
    trace: "the torque of that drive: with the joint's own acceleration, in whatever pose",
    targets: Targets::Joint(JointKinds::DrivenRevolute),
    parameters: &[
        Parameter::size(
            "inertia_kg_m2",
            "kg m^2",
            "J: the rotor's inertia as the joint feels it",
            1e3,
            1e-5,
        ),
        Parameter {
            name: "coupling",
            unit: "",
            about: "1/n; negative where the gear turns the direction round",
            bounds: [-1.0, 1.0],
            step: 1e-3,
            default: Some(0.0),
        },
    ],
    // Rigs with clearance are searched for a payload; this is fitted where windows of a force-driven machine are.
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [inertia, coupling] = ["inertia_kg_m2", "coupling"].map(|name| setting.number(name));
    if inertia == 0.0 {
        return Ok(());
    }
    for joint in setting.joints(mechanism)? {
        if let JointIndex::Revolute(joint) = joint {
            mechanism.rotors.push(Rotor { joint, inertia, coupling });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{TURNTABLE, closed};
    use crate::mechanism::{Dynamics, Evaluation};

    /// A torque of 0.4 N·m on a table of 0.01 kg m² beside a rotor of 0.03 kg m².
    #[test]
    fn a_rotor_is_an_inertia_of_its_joint() {
        let text = TURNTABLE
            .replace(
                "kind = \"servo\"\nstiffness = 400.0\ndamping = 1.5",
                "kind = \"force\"\nvalue = 0.4",
            )
            .replace(
                "[[motion]]\njoint = \"O\"\nkind = \"line\"\nstart = 0.5\nvelocity = 0.0\n",
                "",
            );
        let rotor = "[[effect]]\nkind = \"rotor-inertia\"\njoint = \"O\"\ninertia_kg_m2 = 0.03\n";
        for (text, inertia) in [(text.clone(), 0.01), (format!("{text}{rotor}"), 0.04)] {
            let rig = closed(&text);
            let mut now = Evaluation::new(&rig.mechanism);
            let mut dynamics = Dynamics::new(&rig.mechanism);
            dynamics.forces(&rig.mechanism, 0.0, &rig.states(), &mut now);
            dynamics.accelerations(&rig.mechanism, &rig.states(), &mut now);
            let turn = now.accelerations[0].z;
            assert!((turn - 0.4 / inertia).abs() < 1e-9, "{turn}");
        }
    }
}
