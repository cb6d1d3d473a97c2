//! Values that are surely wrong by themselves: here those of sections, in [`described`] those of a described machine, with a file
//! for each of its parts. What is merely unusual passes.

pub(super) mod connected;
pub(super) mod described;
pub(super) mod guides;
pub(super) mod laws;
pub(super) mod names;
pub(super) mod revolute;
pub(super) mod shape;

use super::{Mechanism, Motion, PerJoint, Problem, Problems, Scenario};
use crate::engine::Engine;

impl Scenario {
    /// All values that cannot be right.
    pub(super) fn validate(&self) -> Result<(), Problems> {
        let mut checks = Checks { scenario: self, problems: Vec::new() };
        checks.mechanism();
        checks.legs();
        checks.joints();
        checks.contact();
        checks.problems.extend(laws::problems(self));
        checks.native();
        checks.drive();
        checks.sensors();
        checks.motion();
        checks.simulation();
        if checks.problems.is_empty() { Ok(()) } else { Err(Problems(checks.problems)) }
    }
}

/// Longest motion in s: an hour of some machines takes a day to simulate already.
const LONGEST: f64 = 86_400.0;

struct Checks<'a> {
    scenario: &'a Scenario,
    problems: Vec<Problem>,
}

impl Checks<'_> {
    fn mechanism(&mut self) {
        let mechanism = &self.scenario.mechanism;
        if let Mechanism::Described(described) = mechanism {
            self.problems.extend(super::validate::described::problems(self.scenario, described));
        }
        let Some(template) = mechanism.template() else { return };
        let lengths = template.lengths().into_iter().map(|(key, value)| (key, value, "m"));
        let masses = template.masses().into_iter().map(|(key, value)| (key, value, "kg"));
        for (key, value, unit) in template.inertia().into_iter().chain(lengths).chain(masses) {
            self.positive(&format!("mechanism.{key}"), value, unit);
        }
        // What is made of good numbers may be none itself.
        if let Some((key, value, unit)) = template.derived_inertia()
            && self.problems.is_empty()
            && !(0.0 < value && value < f64::INFINITY)
        {
            let message = format!("makes an inertia of {value} {unit}");
            let help = "expected a length whose square times a mass is neither 0 nor infinite";
            self.complain(&format!("mechanism.{key}"), message, help);
        }
    }

    fn legs(&mut self) {
        let legs = &self.scenario.legs;
        self.positive("legs.density", legs.density, "kg/m³");
        self.positive("legs.cylinder_length", legs.cylinder_length, "m");
        self.positive("legs.cylinder_diameter", legs.cylinder_diameter, "m");
        self.positive("legs.rod_length", legs.rod_length, "m");
        self.positive("legs.rod_diameter", legs.rod_diameter, "m");

        let [shortest, longest] = legs.stroke;
        if !(0.0 <= shortest && shortest < longest) {
            self.complain(
                "legs.stroke",
                format!("is [{shortest}, {longest}]"),
                "expected two increasing lengths in m, such as [0.2, 0.4]",
            );
        }
        let reach = legs.cylinder_length + legs.rod_length;
        // 1e-12 m forgives the rounding of a sum such as 0.1 + 0.2.
        if longest > reach + 1e-12 {
            self.complain(
                "legs.stroke",
                format!("ends at {longest} m, where the rod has left the cylinder"),
                &format!("expected at most cylinder_length + rod_length = {reach} m"),
            );
        }
    }

    fn joints(&mut self) {
        let joints = &self.scenario.joints;
        let radius = joints.bearing_radius;
        self.positive("joints.bearing_radius", radius, "m");
        if let Some(clearance) = &joints.clearance {
            self.each_joint(
                "joints.clearance",
                clearance,
                |c| 0.0 < c && c < radius,
                &format!("expected above 0 and below the bearing radius, {radius} m"),
            );
        }
        self.each_joint("joints.friction", &joints.friction, |mu| mu >= 0.0, "expected 0 or more");
    }

    fn contact(&mut self) {
        let contact = &self.scenario.contact;
        self.positive("contact.youngs_modulus", contact.youngs_modulus, "Pa");
        let nu = contact.poisson_ratio;
        if !(0.0..0.5).contains(&nu) {
            self.complain(
                "contact.poisson_ratio",
                format!("is {nu}"),
                "expected from 0 to below 0.5",
            );
        }
        if contact.exponent < 1.0 {
            self.complain(
                "contact.exponent",
                format!("is {}", contact.exponent),
                "expected 1 (linear) or more; Hertz is 1.5",
            );
        }
        self.not_negative("contact.c_max", contact.c_max, "N s/m");
        self.positive("contact.d_max", contact.d_max, "m");
        if let Some(stiffness) = contact.stiffness {
            self.positive("contact.stiffness", stiffness, "N/m^1.5");
        }
        self.positive("contact.friction_velocity", contact.friction_velocity, "m/s");
        if let Some(coefficient) = contact.wear_coefficient {
            self.not_negative("contact.wear_coefficient", coefficient, "1/Pa");
        }
    }

    fn native(&mut self) {
        let native = &self.scenario.native;
        if !(0.0..=1.0).contains(&native.restitution) {
            self.complain(
                "native.restitution",
                format!("is {}", native.restitution),
                "expected from 0 (no rebound) to 1 (lossless)",
            );
        }
        if let Some(frequency) = native.frequency {
            self.positive("native.frequency", frequency, "Hz");
        }
        if let Some(ratio) = native.damping_ratio {
            self.not_negative("native.damping_ratio", ratio, "");
        }
        if !(1..=100).contains(&native.iterations) {
            self.complain(
                "native.iterations",
                format!("is {}", native.iterations),
                "expected from 1 to 100 sweeps a step",
            );
        }
    }

    fn drive(&mut self) {
        let drive = &self.scenario.drive;
        self.positive("drive.stiffness", drive.stiffness, "N/m");
        self.positive("drive.damping", drive.damping, "N s/m");
        if let Some(sampled) = &drive.sampled {
            self.positive("drive.sampled.position_gain", sampled.position_gain, "1/s");
            self.positive("drive.sampled.velocity_gain", sampled.velocity_gain, "V s/m");
            self.positive("drive.sampled.interval", sampled.interval, "s");
            self.positive("drive.sampled.limit", sampled.limit, "V");
            self.positive("drive.sampled.force_gain", sampled.force_gain, "N/V");
            self.not_negative("drive.sampled.lag", sampled.lag, "s");
        }
    }

    fn sensors(&mut self) {
        let Some(sensors) = &self.scenario.sensors else {
            return;
        };
        self.not_negative("sensors.pose_std", sensors.pose_std, "m");
        self.not_negative("sensors.angle_std", sensors.angle_std, "rad");
        self.not_negative("sensors.length_resolution", sensors.length_resolution, "m");
        self.not_negative("sensors.force_std", sensors.force_std, "N");
        self.not_negative("sensors.force_lowpass", sensors.force_lowpass, "Hz");
    }

    fn motion(&mut self) {
        match &self.scenario.motion {
            Motion::Circle(circle) => {
                self.not_negative("motion.radius", circle.radius, "m");
                self.positive("motion.period", circle.period, "s");
            }
            Motion::Line(_) => {}
            Motion::Quintic(quintic) => self.positive("motion.time", quintic.time, "s"),
            Motion::Multisine(multisine) => {
                for (i, term) in multisine.terms.iter().enumerate() {
                    let path = format!("motion.terms.{i}.frequency");
                    self.not_negative(&path, term.frequency, "Hz");
                }
            }
            Motion::Table(table) if table.file.is_empty() => self.complain(
                "motion.file",
                "names no file".to_owned(),
                "expected a CSV file with the columns t,x,y,phi",
            ),
            Motion::Table(_) | Motion::Joints(_) | Motion::Rest => {}
        }
    }

    fn simulation(&mut self) {
        let simulation = &self.scenario.simulation;
        let duration = simulation.duration;
        self.positive("simulation.duration", duration, "s");
        if duration > LONGEST {
            self.complain(
                "simulation.duration",
                format!("is {duration}"),
                &format!("expected at most {LONGEST} s, a day"),
            );
        }
        self.positive("simulation.output_interval", simulation.output_interval, "s");
        if simulation.output_interval > duration && duration > 0.0 {
            self.complain(
                "simulation.output_interval",
                format!("is {}", simulation.output_interval),
                &format!(
                    "expected at most simulation.duration, {duration} s: simulate longer, or ask \
                     for rows more often"
                ),
            );
        }
        if let Some(settle) = simulation.settle {
            self.not_negative("simulation.settle", settle, "s");
            if settle >= duration && duration > 0.0 {
                self.complain(
                    "simulation.settle",
                    format!("is {settle}, which leaves nothing to look at"),
                    &format!("expected below simulation.duration, {duration} s"),
                );
            }
        }
        if let Some(step) = simulation.step {
            self.positive("simulation.step", step, "s");
            if simulation.engine == Engine::Direct {
                self.complain(
                    "simulation.step",
                    "does not go with simulation.engine = \"direct\", which controls its error"
                        .into(),
                    "expected simulation.tolerance, such as 1e-5",
                );
            }
        }
        if let Some(tolerance) = simulation.tolerance {
            self.positive("simulation.tolerance", tolerance, "");
            if simulation.step.is_some() {
                let step_location = self.scenario.origins.locate("simulation.step");
                self.complain(
                    "simulation.tolerance",
                    format!("stands beside `simulation.step` ({step_location})"),
                    "keep one: `step` for fixed steps, `tolerance` for adaptive ones",
                );
            }
        }
    }

    fn positive(&mut self, path: &str, value: f64, unit: &str) {
        if value <= 0.0 {
            let help = format!("expected above 0 {unit}");
            self.complain(path, format!("is {value}"), help.trim_end());
        }
    }

    fn not_negative(&mut self, path: &str, value: f64, unit: &str) {
        if value < 0.0 {
            let help = format!("expected 0 {unit} or more");
            self.complain(path, format!("is {value}"), &help);
        }
    }

    /// One complaint that names every joint whose value is out of range.
    fn each_joint(
        &mut self,
        path: &str,
        values: &PerJoint,
        in_range: impl Fn(f64) -> bool,
        help: &str,
    ) {
        let names = self.scenario.mechanism.revolute_names();
        let listed = values.values().len();
        if listed != 1 && listed != names.len() {
            let (count, names) = (names.len(), names.join(" "));
            self.complain(
                path,
                format!("found a list of {listed}"),
                &format!("expected one number for all joints or {count} ({names})"),
            );
            return;
        }
        let values = names.iter().enumerate().map(|(i, name)| (name, values.at(i)));
        let outside: Vec<String> = values
            .filter(|(_, value)| !in_range(*value))
            .map(|(joint, value)| format!("{value} at {joint}"))
            .collect();
        if !outside.is_empty() {
            self.complain(path, format!("is {}", outside.join(", ")), help);
        }
    }

    fn complain(&mut self, path: &str, message: String, help: &str) {
        self.problems.push(self.scenario.problem(path, message, help));
    }
}
