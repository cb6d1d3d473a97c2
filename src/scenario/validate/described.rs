//! What is surely wrong with a described machine by itself: names that nothing has, numbers that no body,
//! joint or drive can have.

use super::connected::body_of;
use crate::scenario::{
    Described, GROUND, Joint, JointDrive, JointPath, Motion, MotionTarget, Problem, Quantity,
    Scenario,
};
use std::collections::BTreeSet;

/// Everything wrong with a described machine.
pub(super) fn problems(scenario: &Scenario, described: &Described) -> Vec<Problem> {
    let mut checks = DescribedChecks { scenario, described, problems: Vec::new() };
    checks.bodies();
    checks.joints();
    checks.drives();
    checks.springs();
    checks.stops();
    checks.outputs();
    checks.sensors();
    checks.columns();
    checks.motion();
    checks.held();
    checks.problems
}

pub(super) struct DescribedChecks<'a> {
    pub(in crate::scenario) scenario: &'a Scenario,
    pub(super) described: &'a Described,
    pub(super) problems: Vec<Problem>,
}

impl DescribedChecks<'_> {
    fn bodies(&mut self) {
        if self.described.bodies.is_empty() {
            self.complain("body", "are none".to_owned(), "describe bodies by [[body]]");
        }
        let mut seen = BTreeSet::from([GROUND]);
        for (i, body) in self.described.bodies.iter().enumerate() {
            let path = format!("body.{i}");
            self.name(&format!("{path}.name"), &body.name, "body", &mut seen);
            self.mass(&path, body);
        }
    }

    fn joints(&mut self) {
        let mut seen = BTreeSet::new();
        for (i, joint) in self.described.joints.iter().enumerate() {
            let path = format!("joint.{i}");
            self.name(&format!("{path}.name"), joint.name(), "joint", &mut seen);
            for (key, point) in joint.points() {
                self.point(&format!("{path}.{key}"), point);
            }
            let [(_, first), (key, second)] = joint.points();
            if let (Some((a, _)), Some((b, _))) = (first.split_once('.'), second.split_once('.'))
                && a == b
            {
                let message = format!("is on \"{b}\", as the other point of the joint");
                self.complain(&format!("{path}.{key}"), message, "a joint connects two bodies");
            }
            self.joint_numbers(&path, joint);
        }
    }

    fn joint_numbers(&mut self, path: &str, joint: &Joint) {
        match joint {
            Joint::Revolute(joint) => self.revolute_numbers(path, joint),
            Joint::Prismatic(joint) => {
                if let Some([low, high]) = joint.range {
                    self.increasing(&format!("{path}.range"), low, high);
                }
                self.guides(path, joint);
            }
            Joint::Fixed(_) => {}
        }
    }

    fn drives(&mut self) {
        let mut seen = BTreeSet::new();
        let mut labels = BTreeSet::new();
        if let Motion::Joints(motions) = &self.scenario.motion {
            let driven = |name: &str| self.described.drives.iter().any(|d| d.joint() == name);
            // Joints that are moved without a drive have its columns too.
            let moved = motions.iter().filter(|motion| !driven(&motion.joint));
            labels.extend(moved.map(|motion| format!("_{}", motion.joint)));
        }
        for (i, drive) in self.described.drives.iter().enumerate() {
            let path = format!("drive.{i}");
            self.movable(&format!("{path}.joint"), drive.joint());
            if !seen.insert(drive.joint()) {
                let message = format!("\"{}\" is driven twice", drive.joint());
                self.complain(&format!("{path}.joint"), message, "keep one drive of each joint");
            } else if !labels.insert(drive.label()) {
                let message = format!("names the columns q{} twice", drive.label());
                self.complain(&path, message, "give one of them another label");
            }
            match drive {
                JointDrive::Servo(servo) => {
                    self.above_zero(&format!("{path}.stiffness"), servo.stiffness);
                    self.above_zero(&format!("{path}.damping"), servo.damping);
                }
                JointDrive::Sampled(sampled) => {
                    let c = &sampled.controller;
                    for (key, value) in [
                        ("position_gain", c.position_gain),
                        ("velocity_gain", c.velocity_gain),
                        ("interval", c.interval),
                        ("limit", c.limit),
                        ("force_gain", c.force_gain),
                    ] {
                        self.above_zero(&format!("{path}.controller.{key}"), value);
                    }
                    self.not_negative(&format!("{path}.controller.lag"), c.lag);
                }
                JointDrive::Force(force) => {
                    if force.column.is_some() && force.file.is_none() {
                        let message = "names a column of no file".to_owned();
                        self.complain(&format!("{path}.column"), message, "write file = \"….csv\"");
                    }
                }
                JointDrive::Prescribed(_) => {}
            }
        }
    }

    fn springs(&mut self) {
        for (i, spring) in self.described.springs.iter().enumerate() {
            let path = format!("spring.{i}");
            match (&spring.between, &spring.joint) {
                (Some(points), None) => {
                    for (k, point) in points.iter().enumerate() {
                        self.point(&format!("{path}.between.{k}"), point);
                    }
                    let [first, second] = points.each_ref().map(|point| body_of(point));
                    if self.described.rigid_with(first).contains(second) {
                        let message =
                            format!("\"{}\" and \"{}\" move as one", points[0], points[1]);
                        let help = "a spring acts between two bodies, or a body and the ground";
                        self.complain(&format!("{path}.between"), message, help);
                    }
                    if spring.free_angle.is_some() {
                        let message = "belongs to a revolute joint".to_owned();
                        self.complain(&format!("{path}.free_angle"), message, "write free_length");
                    }
                }
                (None, Some(joint)) => self.joint_spring(&path, spring, joint),
                _ => self.complain(
                    &path,
                    "does not say where it is".to_owned(),
                    "write between = [\"body.point\", \"body.point\"], or joint = \"…\"",
                ),
            }
            let [stiffness, damping] = ["stiffness", "damping"].map(|key| format!("{path}.{key}"));
            // A zero that is written may be one of many in a sweep.
            if ![&stiffness, &damping].into_iter().any(|key| self.scenario.origins.has(key)) {
                let message = "has neither stiffness nor damping".to_owned();
                let help = "write stiffness = … (N/m, in a revolute joint N m/rad)";
                self.complain(&path, message, help);
            }
            self.not_negative(&stiffness, spring.stiffness);
            self.not_negative(&damping, spring.damping);
        }
    }

    fn joint_spring(&mut self, path: &str, spring: &crate::scenario::Spring, name: &str) {
        self.movable(&format!("{path}.joint"), name);
        let revolute = self
            .described
            .joints
            .iter()
            .any(|joint| joint.name() == name && matches!(joint, Joint::Revolute(_)));
        let (wrong, right) =
            if revolute { ("free_length", "free_angle") } else { ("free_angle", "free_length") };
        let given = if revolute { spring.free_length } else { spring.free_angle };
        if given.is_some() {
            let message = format!("is not a key of a spring in \"{name}\"");
            self.complain(&format!("{path}.{wrong}"), message, &format!("write {right}"));
        }
    }

    fn stops(&mut self) {
        for (i, stop) in self.described.stops.iter().enumerate() {
            let path = format!("stop.{i}");
            self.movable(&format!("{path}.joint"), &stop.joint);
            self.increasing(&format!("{path}.range"), stop.range[0], stop.range[1]);
            self.above_zero(&format!("{path}.stiffness"), stop.stiffness);
            self.not_negative(&format!("{path}.damping"), stop.damping);
            self.above_zero(&format!("{path}.depth"), stop.depth);
        }
    }

    fn outputs(&mut self) {
        let mut seen = BTreeSet::new();
        let still = self.described.rigid_with(GROUND);
        for (i, output) in self.described.outputs.iter().enumerate() {
            let path = format!("output.{i}");
            match (&output.body, &output.point) {
                (Some(body), None) => self.body(&format!("{path}.body"), body),
                (None, Some(point)) => self.point(&format!("{path}.point"), point),
                (body, _) => {
                    let both = body.is_some();
                    let message =
                        if both { "gives both body and point" } else { "does not say of what" };
                    let help = "write body = \"…\" or point = \"body.point\"";
                    self.complain(&path, message.to_owned(), help);
                }
            }
            // There is no body called ground.
            if still.contains(body_of(output.of())) && output.of() != GROUND {
                let message = format!("is of \"{}\", which does not move", output.of());
                self.complain(&path, message, "name a body that joints let move, or its point");
            }
            if !seen.insert(output.label()) {
                let message = format!("names the columns x{} twice", output.label());
                self.complain(&path, message, "give one of them another label");
            }
        }
    }

    fn sensors(&mut self) {
        let mut seen = BTreeSet::new();
        for (i, sensor) in self.described.sensors.iter().enumerate() {
            let path = format!("sensor.{i}");
            let column = sensor.column.as_str();
            if column.is_empty() || !seen.insert(column) {
                let message = format!("two sensors read the column \"{column}\"");
                self.complain(&format!("{path}.column"), message, "one sensor for each column");
            }
            let of = format!("{path}.of");
            match sensor.quantity {
                Quantity::Position => {
                    self.movable(&of, &sensor.of);
                }
                Quantity::Command | Quantity::Force | Quantity::Output | Quantity::Added => {
                    let known = self.movable(&of, &sensor.of);
                    let driven = |drive: &&JointDrive| drive.joint() == sensor.of;
                    let of_controller =
                        matches!(sensor.quantity, Quantity::Output | Quantity::Added);
                    match self.described.drives.iter().find(driven) {
                        None if known => {
                            let message = format!("\"{}\" has no drive to read", sensor.of);
                            self.complain(&of, message, "write a [[drive]] of this joint");
                        }
                        Some(drive)
                            if of_controller && !matches!(drive, JointDrive::Sampled(_)) =>
                        {
                            let message =
                                format!("the drive of \"{}\" has no sampled controller", sensor.of);
                            self.complain(&of, message, "its effort is quantity = \"force\"");
                        }
                        _ => {}
                    }
                }
                Quantity::X | Quantity::Y | Quantity::Angle | Quantity::Acceleration => {
                    self.point(&of, &sensor.of);
                }
            }
            if sensor.axis.is_some() && sensor.quantity != Quantity::Acceleration {
                let message = "belongs to an acceleration".to_owned();
                self.complain(&format!("{path}.axis"), message, "take it out");
            }
            if sensor.scale == 0.0 {
                let message = "is 0: nothing would be left of the column".to_owned();
                let help = "write what its numbers are multiplied by to be in SI units";
                self.complain(&format!("{path}.scale"), message, help);
            }
            self.not_negative(&format!("{path}.std"), sensor.std);
            self.not_negative(&format!("{path}.resolution"), sensor.resolution);
            self.not_negative(&format!("{path}.lowpass"), sensor.lowpass);
        }
    }

    fn columns(&mut self) {
        let Some(columns) = &self.scenario.columns else { return };
        for quantity in columns.quantities() {
            let message = "is not known of a machine that describes itself".to_owned();
            let help = "keep t there, and write a [[sensor]] with the column and its scale";
            self.complain(&format!("columns.{quantity}"), message, help);
        }
    }

    fn motion(&mut self) {
        match &self.scenario.target {
            Some(MotionTarget::Body(body)) => self.body("motion.body", body),
            Some(MotionTarget::Point(point)) => self.point("motion.point", point),
            None => {}
        }
        let Motion::Joints(motions) = &self.scenario.motion else { return };
        let mut seen = BTreeSet::new();
        for (i, motion) in motions.iter().enumerate() {
            // One [motion] or a list of them.
            let path = if self.scenario.is_list("motion") {
                format!("motion.{i}")
            } else {
                "motion".into()
            };
            let joint = motion.joint.as_str();
            self.movable(&format!("{path}.joint"), joint);
            if !seen.insert(joint) {
                let message = format!("\"{joint}\" is moved twice");
                self.complain(&format!("{path}.joint"), message, "keep one motion of each joint");
            }
            let forced = self.described.drives.iter().any(
                |drive| matches!(drive, JointDrive::Force(force) if force.joint == motion.joint),
            );
            if forced {
                let message = format!("\"{joint}\" is driven by a force: it follows no motion");
                let help = "give the drive another kind, or take the motion out";
                self.complain(&format!("{path}.joint"), message, help);
            }
            match &motion.path {
                JointPath::Quintic(quintic) => {
                    self.above_zero(&format!("{path}.time"), quintic.time);
                }
                JointPath::Table(table) if table.file.is_empty() => {
                    let help = "expected a CSV file with a column t";
                    self.complain(&format!("{path}.file"), "names no file".to_owned(), help);
                }
                JointPath::Table(_) | JointPath::Line(_) => {}
                JointPath::Multisine(multisine) => {
                    for (k, term) in multisine.terms.iter().enumerate() {
                        self.not_negative(&format!("{path}.terms.{k}.frequency"), term.frequency);
                    }
                }
            }
        }
    }

    /// Bodies that nothing holds, and machines of which nothing moves.
    fn held(&mut self) {
        for (i, body) in self.described.bodies.iter().enumerate() {
            if !self.described.is_held(&body.name) {
                let message = format!("\"{}\" is free: no joint and no spring holds it", body.name);
                self.complain(&format!("body.{i}"), message, "give it a joint, or take it out");
            }
        }
        let still = self.described.rigid_with(GROUND);
        let all = self.described.bodies.iter().all(|body| still.contains(body.name.as_str()));
        let joints = self.described.joints.iter().enumerate();
        let mut fixed = joints.filter(|(_, joint)| matches!(joint, Joint::Fixed(_)));
        if all && let Some((i, joint)) = fixed.next() {
            let message = format!(
                "\"{}\" leaves nothing that moves: fixed joints hold every body to the ground",
                joint.name()
            );
            let help = "make one of them revolute or prismatic, or add a body that moves";
            self.complain(&format!("joint.{i}"), message, help);
        }
    }
}
