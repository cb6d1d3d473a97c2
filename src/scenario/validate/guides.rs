//! Prismatic joints with clearance: what they need, and what belongs to them alone.

use super::described::DescribedChecks;
use crate::scenario::{JointDrive, Law, Prismatic};

impl DescribedChecks<'_> {
    /// The clearance of a prismatic joint at `path`, and the keys that go with it.
    pub(super) fn guides(&mut self, path: &str, joint: &Prismatic) {
        let at = |key: &str| format!("{path}.{key}");
        let numbers = [
            ("length", joint.length),
            ("height", joint.height),
            ("corner_radius", joint.corner_radius),
            ("friction", joint.friction),
            ("stiffness", joint.stiffness),
            ("restitution", joint.restitution),
            ("damping", joint.damping),
        ];
        let Some(clearance) = joint.clearance else {
            let law = joint.law.map(|_| "law");
            let written =
                numbers.into_iter().filter(|(_, value)| value.is_some()).map(|(key, _)| key);
            for key in written.chain(law) {
                let message =
                    "belongs to a slider with clearance, and this joint is ideal".to_owned();
                self.complain(&at(key), message, "give the joint a clearance, or take this out");
            }
            return;
        };
        if clearance < 0.0 {
            self.complain(&at("clearance"), format!("is {clearance}"), "expected 0 m or more");
        }
        for (key, value) in numbers {
            match (key, value) {
                ("length" | "height", None) => {
                    let message =
                        format!("is missing for the slider \"{}\" with clearance", joint.name);
                    self.complain(&at(key), message, &format!("write {key} = … (m) of the slider"));
                }
                ("length" | "height" | "corner_radius" | "stiffness", Some(value)) => {
                    self.above_zero(&at(key), value);
                }
                // What a law takes of the others is checked with the laws.
                ("friction", Some(value)) => self.not_negative(&at(key), value),
                _ => {}
            }
        }
        self.law_of_guides(path, joint);
        let prescribed = |drive: &JointDrive| matches!(drive, JointDrive::Prescribed(_));
        let mut drives = self.described.drives.iter();
        let place = drives.position(|drive| drive.joint() == joint.name && prescribed(drive));
        if let Some(i) = place.filter(|_| joint.play().is_some()) {
            let message =
                format!("prescribes the length of \"{}\", which has clearance", joint.name);
            let help = "take another kind of drive: its slider is not held along one line";
            self.complain(&format!("drive.{i}.kind"), message, help);
        }
    }

    /// Laws that are made for journals in rings.
    fn law_of_guides(&mut self, path: &str, joint: &Prismatic) {
        let law = joint.law.unwrap_or(self.scenario.contact.law);
        let key =
            if joint.law.is_some() { format!("{path}.law") } else { "contact.law".to_owned() };
        if law == Law::Native {
            let message = format!("is \"native\", and \"{}\" has clearance", joint.name);
            let help = "the physics engine's own contacts are made for rings: take another law";
            self.complain(&key, message, help);
        } else if law.kind().is_some_and(|kind| kind.takes("length")) {
            let message = format!(
                "is a law of conformal contact, and the corners of \"{}\" hit flat guides",
                joint.name
            );
            let help = "write law = \"hertz-step\", or another law after Hertz, in that joint";
            self.complain(&key, message, help);
        }
    }
}
