//! Numbers of revolute joints that no joint can have, or that belong to a contact law where there is none.

use super::described::DescribedChecks;
use crate::contact::FEWEST_SAMPLES;
use crate::scenario::{Joint, Law, Revolute};

impl DescribedChecks<'_> {
    /// Numbers of a revolute joint.
    pub(super) fn revolute_numbers(&mut self, path: &str, joint: &Revolute) {
        self.bearing_sizes(path, joint);
        let without = self.without_law(joint);
        if let (Some(help), Some(law)) = (without, joint.law)
            && law != Law::Ideal
        {
            let message = "is a contact law, and this joint is ideal".to_owned();
            self.complain(&format!("{path}.law"), message, help);
        }
        self.law_numbers(path, joint, without);
        if let Some(profile) = &joint.profile {
            self.profile(&format!("{path}.profile"), joint, profile, without);
        }
    }

    /// Bearing radius and clearance.
    fn bearing_sizes(&mut self, path: &str, joint: &Revolute) {
        let radius = joint.bearing_radius.unwrap_or(self.scenario.joints.bearing_radius);
        if radius <= 0.0 {
            let path = format!("{path}.bearing_radius");
            self.complain(&path, format!("is {radius}"), "expected above 0 m");
        }
        if let Some(clearance) = joint.clearance
            && !(0.0..radius).contains(&clearance)
        {
            let message = format!("is {clearance} m in the joint \"{}\"", joint.name);
            let help = format!(
                "expected 0 or more, and below the bearing radius, {radius} m; 0 or no \
                 clearance is an ideal joint"
            );
            self.complain(&format!("{path}.clearance"), message, &help);
        }
    }

    /// What to do about numbers of a contact law where the joint has none.
    fn without_law(&self, joint: &Revolute) -> Option<&'static str> {
        if joint.law == Some(Law::Ideal) {
            Some("take one of both out")
        } else if joint.clearance.is_none() && self.scenario.joints.clearance.is_none() {
            // A clearance of 0 is written on purpose, and may be one of many in a sweep.
            Some("give the joint a clearance, or take this out")
        } else {
            None
        }
    }

    /// Numbers of the contact law; `without` says what to do where the joint has none.
    fn law_numbers(&mut self, path: &str, joint: &Revolute, without: Option<&str>) {
        // What a law takes of restitution and damping is checked with the laws.
        let numbers = [
            ("friction", joint.friction, 0.0),
            ("c_max", joint.c_max, 0.0),
            ("stiffness", joint.stiffness, f64::MIN_POSITIVE),
            ("d_max", joint.d_max, f64::MIN_POSITIVE),
            ("restitution", joint.restitution, f64::NEG_INFINITY),
            ("damping", joint.damping, f64::NEG_INFINITY),
            ("wear_coefficient", joint.wear_coefficient, 0.0),
        ];
        for (key, value, least) in numbers {
            let Some(value) = value else { continue };
            // No friction is right for every joint.
            let some = key != "friction" || value != 0.0;
            if let Some(help) = without.filter(|_| some) {
                let message = "belongs to a contact law, and this joint is ideal".to_owned();
                self.complain(&format!("{path}.{key}"), message, help);
            } else if value < least {
                let help = if least > 0.0 { "expected above 0" } else { "expected 0 or more" };
                self.complain(&format!("{path}.{key}"), format!("is {value}"), help);
            }
        }
    }

    /// The shape of a ring; `without` says what to do where the joint has no contact law.
    fn profile(&mut self, path: &str, joint: &Revolute, profile: &[f64], without: Option<&str>) {
        let clearance = joint.clearance.or_else(|| {
            let revolute = |other: &&Joint| matches!(other, Joint::Revolute(_));
            let mut revolutes = self.described.joints.iter().filter(revolute);
            let index = revolutes.position(|other| other.name() == joint.name)?;
            Some(self.scenario.joints.clearance.as_ref()?.at(index))
        });
        let narrowing = profile.iter().fold(0.0f64, |most, wider| most.max(-wider));
        let law = joint.law.unwrap_or(self.scenario.contact.law);
        if let Some(help) = without {
            let message = "belongs to a contact law, and this joint is ideal".to_owned();
            self.complain(path, message, help);
        } else if law == Law::Native {
            let message = "is not possible under the law \"native\"".to_owned();
            let help =
                "the physics engine's own contacts are made on round rings: take another law";
            self.complain(path, message, help);
        } else if profile.len() < FEWEST_SAMPLES {
            let help = format!("expected {FEWEST_SAMPLES} or more, at equal angles round the ring");
            self.complain(path, format!("has {} values", profile.len()), &help);
        } else if let Some(clearance) = clearance.filter(|clearance| narrowing >= *clearance) {
            let help = format!("expected narrower by less than the clearance, {clearance} m");
            self.complain(path, format!("narrows the ring by {narrowing} m"), &help);
        }
    }
}
