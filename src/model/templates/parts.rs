//! What templates are made of.

use crate::scenario::{
    Body, Columns, Described, Drive, DriveMode, Ground, Joint, JointDrive, Motion, On, Output,
    Prismatic, Revolute, SampledDrive, Scenario, Servo,
};
use std::collections::BTreeMap;

/// Points by name.
pub(super) fn points(list: &[(&str, [f64; 2])]) -> BTreeMap<String, [f64; 2]> {
    list.iter().map(|(name, point)| ((*name).to_owned(), *point)).collect()
}

/// The ground with these points.
pub(super) fn ground(list: &[(&str, [f64; 2])]) -> Ground {
    Ground { points: points(list) }
}

/// A body with its mass in the origin of its axes.
pub(super) fn body(
    name: &str,
    (mass, inertia): (f64, f64),
    list: &[(&str, [f64; 2])],
    start: [f64; 3],
) -> Body {
    Body {
        name: name.to_owned(),
        mass: Some(mass),
        inertia: Some(inertia),
        center_of_mass: Some([0.0, 0.0]),
        points: points(list),
        start,
        ..Body::default()
    }
}

/// A slender uniform bar of `mass` kg and `length` m along its x axis, from the point `ends[0]` in its origin
/// to `ends[1]`: inertia `m L²/12` about its middle.
pub(super) fn bar(name: &str, mass: f64, length: f64, ends: [&str; 2], start: [f64; 3]) -> Body {
    let list = [(ends[0], [0.0, 0.0]), (ends[1], [length, 0.0])];
    Body {
        center_of_mass: Some([0.5 * length, 0.0]),
        ..body(name, (mass, mass * length * length / 12.0), &list, start)
    }
}

/// Revolute joint `index` of the scenario's machine, with the clearance and friction of its place.
pub(super) fn revolute(
    scenario: &Scenario,
    index: usize,
    name: &str,
    ring: &str,
    journal: &str,
) -> Joint {
    Joint::Revolute(Revolute {
        name: name.to_owned(),
        ring: ring.to_owned(),
        journal: journal.to_owned(),
        clearance: Some(scenario.clearance(index)),
        friction: Some(scenario.joints.friction.at(index)),
        ..Revolute::default()
    })
}

/// A prismatic joint along the x axis of its base.
pub(super) fn prismatic(name: &str, base: &str, slider: &str, range: Option<[f64; 2]>) -> Joint {
    Joint::Prismatic(Prismatic {
        name: name.to_owned(),
        base: base.to_owned(),
        slider: slider.to_owned(),
        range,
        ..Prismatic::default()
    })
}

/// The drive that `[drive]` asks for, on a joint whose columns are called `label`.
pub(super) fn drive(scenario: &Scenario, joint: &str, label: Option<&str>) -> JointDrive {
    let Drive { mode, stiffness, damping, .. } = scenario.drive;
    let (joint, label) = (joint.to_owned(), label.map(str::to_owned));
    match mode {
        DriveMode::Prescribed => JointDrive::Prescribed(On { joint, label }),
        DriveMode::Servo => JointDrive::Servo(Servo { joint, stiffness, damping, label }),
        DriveMode::Sampled => {
            let controller = scenario.drive.sampled();
            JointDrive::Sampled(SampledDrive { joint, controller, label })
        }
    }
}

/// A body whose columns are called `x`, `y`, `phi`, … alone.
pub(super) fn plain_output(body: &str) -> Vec<Output> {
    let (body, label) = (Some(body.to_owned()), Some(String::new()));
    vec![Output { body, label, ..Output::default() }]
}

/// The scenario about a described machine; clearance and friction stand at its joints.
pub(super) fn described(
    scenario: &Scenario,
    described: Described,
    motion: Motion,
    target: Option<crate::scenario::MotionTarget>,
) -> Scenario {
    let mut expanded = scenario.with_described(described, motion, target);
    expanded.columns = scenario.columns.as_ref().and_then(Columns::time_alone);
    expanded.joints.clearance = None;
    expanded.joints.friction = crate::scenario::PerJoint::all(0.0);
    expanded
}

/// The corner of a triangle with two sides known: the point at `a` m from `from` and `b` m from `to`, on the
/// left of the way from one to the other (`side` 1) or on its right (−1); none where they do not reach.
pub(super) fn corner(
    from: [f64; 2],
    to: [f64; 2],
    [a, b]: [f64; 2],
    side: f64,
) -> Option<[f64; 2]> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let d = dx.hypot(dy);
    let along = (a * a - b * b + d * d) / (2.0 * d);
    let height = a * a - along * along;
    (height >= 0.0 && d > 0.0).then(|| {
        let across = side * height.sqrt();
        [from[0] + (along * dx - across * dy) / d, from[1] + (along * dy + across * dx) / d]
    })
}

/// Direction in rad from one point to another.
pub(super) fn direction(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}
