//! A description as a [`Mechanism`]: bodies, joints, drives, springs and stops, not yet put together.

use super::declared_drives::add_drives;
use super::guides::{corners, has_play};
use super::layout::{Layout, Written};
use super::material::material;
use super::names::{joint_named, mark, names};
use super::parts::Parts;
use crate::contact::laws::Given;
use crate::contact::{Clearance, HertzStep, RingShape, RingTable};
use crate::mechanism::{
    Attachment, Bearing, JointSpring, Mechanism, OilFilm, PointSpring, Prismatic, Reads, Revolute,
    Sensor, Stop,
};
use crate::scenario::{self, Described, Joint, Law, MotionTarget, Quantity, Scenario, Spring};
use nalgebra::{UnitComplex, Vector2};
use std::ops::Range;
use std::sync::Arc;

/// A described machine before it is put together.
pub(in crate::model) struct Built {
    pub mechanism: Mechanism,
    pub parts: Parts,
    pub layout: Layout,
    /// The default law of each revolute joint with a declared clearance, whatever law it is under: native
    /// contacts are fitted to it.
    pub laws: Vec<Option<HertzStep>>,
}

/// Builds what a scenario describes.
pub(in crate::model) fn build(scenario: &Scenario, described: &Described) -> Built {
    let parts = Parts::of(described);
    let mut mechanism = Mechanism::free(parts.bodies.clone());
    mechanism.gravity = scenario.environment.gravity.into();
    let BuiltJoints { laws, mut declared } =
        add_joints(scenario, described, &parts, &mut mechanism);
    declared.extend(add_corners(scenario, described, &mut mechanism));
    let mut layout = Layout { joints: declared, ..Layout::default() };
    add_drives(scenario, described, &mut mechanism, &mut layout);
    outputs(scenario, described, &parts, &mut mechanism, &mut layout);
    for body in &described.bodies {
        for point in body.points.keys() {
            let name = format!("{}.{point}", body.name);
            layout.marks.push(mark(&mechanism, &parts, &name));
            layout.mark_names.push(name);
        }
    }
    let springs = add_springs(described, &parts, &mut mechanism);
    add_stops(described, &mut mechanism);
    add_films(scenario, described, &mut mechanism);
    mechanism.sensors =
        described.sensors.iter().filter_map(|s| sensor(&mechanism, &parts, s)).collect();
    mechanism.names = names(scenario, described, &parts, &mechanism, &springs);
    Built { mechanism, parts, layout, laws }
}

/// What is to be known of joints that were built.
struct BuiltJoints {
    /// As of [`Built`].
    laws: Vec<Option<HertzStep>>,
    /// Revolute joints with a declared clearance.
    declared: Vec<usize>,
}

fn add_joints(
    scenario: &Scenario,
    described: &Described,
    parts: &Parts,
    mechanism: &mut Mechanism,
) -> BuiltJoints {
    let mut joints = BuiltJoints { laws: Vec::new(), declared: Vec::new() };
    for joint in &described.joints {
        let [first, second] = joint.points().map(|(_, point)| parts.point(point));
        match joint {
            Joint::Revolute(joint) => {
                let index = mechanism.revolutes.len();
                let clearance = clearance(scenario, joint, index);
                let given = clearance.map(|clearance| given(scenario, joint, clearance));
                if clearance.is_some() {
                    joints.declared.push(index);
                }
                let bearing = bearing(scenario, joint, index, given);
                let by_law = matches!(bearing, Bearing::Clearance(_));
                let profile = joint.profile.as_deref().filter(|_| by_law);
                mechanism.revolutes.push(Revolute {
                    name: joint.name.clone(),
                    ring: first.0,
                    journal: second.0,
                    bearing,
                    out_of_round: profile.and_then(RingTable::new).map(RingShape::from),
                });
                joints.laws.push(given.as_ref().map(HertzStep::from));
            }
            Joint::Prismatic(joint) => {
                let ((base, base_angle), (slider, slider_angle)) = (first, second);
                // Where the slider's axes keep another angle than `axis`, the axis is turned in them.
                let turn = joint.angle.map_or(0.0, |angle| joint.axis - angle);
                mechanism.prismatics.push(Prismatic {
                    play: has_play(scenario, joint),
                    name: joint.name.clone(),
                    base,
                    slider,
                    axes: [direction(base_angle + joint.axis), direction(slider_angle + turn)],
                });
            }
            Joint::Fixed(_) => {}
        }
    }
    joints
}

/// Adds the corners of guides with play, which are revolute joints with clearance; their indices.
fn add_corners(
    scenario: &Scenario,
    described: &Described,
    mechanism: &mut Mechanism,
) -> Range<usize> {
    let first = mechanism.revolutes.len();
    for joint in &described.joints {
        let Joint::Prismatic(joint) = joint else { continue };
        let built = mechanism.prismatics.iter().find(|built| built.name == joint.name);
        let corners = built.map(|built| corners(scenario, joint, built)).unwrap_or_default();
        mechanism.revolutes.extend(corners);
    }
    first..mechanism.revolutes.len()
}

/// Adds springs; of those between points the index of the load, and the points' names.
fn add_springs(
    described: &Described,
    parts: &Parts,
    mechanism: &mut Mechanism,
) -> Vec<(usize, [String; 2])> {
    let mut springs = Vec::new();
    for spring in &described.springs {
        if let Some(points) = &spring.between {
            springs.push((mechanism.loads.len(), points.clone()));
        }
        add_spring(mechanism, parts, spring);
    }
    springs
}

fn add_stops(described: &Described, mechanism: &mut Mechanism) {
    for stop in &described.stops {
        let Some(joint) = joint_named(mechanism, &stop.joint) else { continue };
        let law = HertzStep {
            stiffness: stop.stiffness,
            exponent: 1.0,
            c_max: stop.damping,
            d_max: stop.depth,
            clip: true,
        };
        mechanism.loads.push(Arc::new(Stop { joint, range: stop.range, law }));
    }
}

/// A direction at `angle` rad; exactly along x where that is zero.
fn direction(angle: f64) -> UnitComplex<f64> {
    if angle == 0.0 { UnitComplex::identity() } else { UnitComplex::new(angle) }
}

/// Declared radial clearance of a joint in m; none of an ideal one.
fn clearance(scenario: &Scenario, joint: &scenario::Revolute, index: usize) -> Option<f64> {
    let default = || scenario.joints.clearance.as_ref().map(|values| values.at(index));
    joint.clearance.or_else(default).filter(|clearance| *clearance > 0.0)
}

/// What the law of a joint is built from.
fn given(scenario: &Scenario, joint: &scenario::Revolute, clearance: f64) -> Given {
    let contact = &scenario.contact;
    let bearing_radius = joint.bearing_radius.unwrap_or(scenario.joints.bearing_radius);
    Given {
        bearing_radius,
        journal_radius: bearing_radius - clearance,
        material: material(scenario),
        stiffness_form: contact.stiffness_form,
        stiffness: joint.stiffness.or(contact.stiffness),
        exponent: contact.exponent,
        length: contact.length,
        restitution: joint.restitution.or(contact.restitution),
        damping: joint.damping.or(contact.damping),
        c_max: joint.c_max.unwrap_or(contact.c_max),
        d_max: joint.d_max.unwrap_or(contact.d_max),
        clip: contact.clip,
    }
}

fn bearing(
    scenario: &Scenario,
    joint: &scenario::Revolute,
    index: usize,
    given: Option<Given>,
) -> Bearing {
    let Some(given) = given else { return Bearing::Ideal };
    let Given { bearing_radius, journal_radius, .. } = given;
    let friction = joint.friction.unwrap_or_else(|| scenario.joints.friction.at(index));
    let law = joint.law.unwrap_or(scenario.contact.law);
    match (law, law.kind()) {
        (_, Some(kind)) => Bearing::Clearance(Clearance {
            bearing_radius,
            journal_radius,
            law: (kind.build)(&given),
            friction: (friction > 0.0).then(|| scenario.contact.friction(friction)),
        }),
        (Law::Native, None) => Bearing::Native { bearing_radius, journal_radius, friction },
        (_, None) => Bearing::Ideal,
    }
}

/// The oil in joints with clearance under a law.
fn add_films(scenario: &Scenario, described: &Described, mechanism: &mut Mechanism) {
    let revolutes = described.joints.iter().filter_map(|joint| match joint {
        Joint::Revolute(joint) => Some(joint),
        Joint::Prismatic(_) | Joint::Fixed(_) => None,
    });
    let mut films = Vec::new();
    for (i, (joint, built)) in revolutes.zip(&mechanism.revolutes).enumerate() {
        let Bearing::Clearance(clearance) = &built.bearing else { continue };
        let kind = joint.film.unwrap_or(scenario.contact.film);
        let gap = clearance.radial();
        if let Some(film) = scenario.contact.film(kind, clearance.bearing_radius, gap) {
            films.push(OilFilm { joint: i, film, clearance: Some(gap) });
        }
    }
    for film in films {
        mechanism.loads.push(Arc::new(film));
    }
}

/// What is written, and which of it is the machine's output: what the motion moves, else the first output,
/// else the centre of mass of the body that most joints separate from the ground (of several, the last): it
/// feels the play of all of them.
fn outputs(
    scenario: &Scenario,
    described: &Described,
    parts: &Parts,
    mechanism: &mut Mechanism,
    layout: &mut Layout,
) {
    let asked = described.outputs.iter().map(|output| (output.of().to_owned(), output.label()));
    let mut asked: Vec<(String, String)> = asked.collect();
    if asked.is_empty() {
        let each = |body: &scenario::Body| (body.name.clone(), format!("_{}", body.name));
        asked = described.bodies.iter().map(each).collect();
    }
    let main = match &scenario.target {
        Some(MotionTarget::Body(name) | MotionTarget::Point(name)) => Some(name.as_str()),
        None => described.outputs.first().map(scenario::Output::of),
    };
    if main.is_none() {
        mechanism.output = mechanism.farthest_body();
        mechanism.bodies[mechanism.output].reference = Vector2::zeros();
    }
    // The body's reference point is that of the output.
    if let Some((Attachment { body: Some(body), point }, _)) = main.map(|name| located(parts, name))
    {
        mechanism.output = body;
        mechanism.bodies[body].reference = point;
    }
    for (name, label) in asked {
        let (attachment, angle) = located(parts, &name);
        let Some(body) = attachment.body else { continue };
        let point = attachment.point - mechanism.bodies[body].reference;
        layout.outputs.push(Written { label, name, body, point, angle });
    }
}

/// The origin of a body's axes, or a point, and the angle of those axes.
pub(in crate::model) fn located(parts: &Parts, name: &str) -> (Attachment, f64) {
    if name.contains('.') {
        return parts.point(name);
    }
    let part = parts.part(name);
    (Attachment { body: part.body, point: part.origin }, part.angle)
}

/// A sensor without errors of its own; none of what the machine has not.
fn sensor(mechanism: &Mechanism, parts: &Parts, sensor: &scenario::Sensor) -> Option<Sensor> {
    let drive = || mechanism.actuators.iter().position(|drive| drive.name == sensor.of);
    let reads = match sensor.quantity {
        Quantity::Command => Reads::Command(drive()?),
        Quantity::Position => Reads::Position(joint_named(mechanism, &sensor.of)?),
        Quantity::Force => Reads::Effort(drive()?),
        Quantity::Output => Reads::Output(drive()?),
        Quantity::Added => Reads::Added(drive()?),
        Quantity::X => Reads::X(mark(mechanism, parts, &sensor.of)),
        Quantity::Y => Reads::Y(mark(mechanism, parts, &sensor.of)),
        Quantity::Angle => {
            let (point, angle) = located(parts, &sensor.of);
            Reads::Angle(point.body, angle)
        }
        Quantity::Acceleration => {
            let axis = direction(sensor.axis.unwrap_or_default());
            let axis = Vector2::new(axis.re, axis.im);
            Reads::Acceleration(mark(mechanism, parts, &sensor.of), axis)
        }
    };
    Some(Sensor {
        column: sensor.column.clone(),
        factor: sensor.scale,
        reads,
        std: sensor.std,
        resolution: sensor.resolution,
        lowpass: sensor.lowpass,
        delay: 0.0,
        scale: 1.0,
        offset: 0.0,
        waves: Vec::new(),
        frames: Vec::new(),
    })
}

fn add_spring(mechanism: &mut Mechanism, parts: &Parts, spring: &Spring) {
    let (stiffness, damping) = (spring.stiffness, spring.damping);
    if let Some(points) = &spring.between {
        let spring = PointSpring {
            ends: points.each_ref().map(|point| mark(mechanism, parts, point)),
            stiffness,
            damping,
            free_length: spring.free_length.unwrap_or_default(),
            pull_only: spring.pull_only,
        };
        mechanism.loads.push(Arc::new(spring));
    } else if let Some(joint) =
        spring.joint.as_deref().and_then(|name| joint_named(mechanism, name))
    {
        let free = spring.free_length.or(spring.free_angle).unwrap_or_default();
        mechanism.loads.push(Arc::new(JointSpring { joint, stiffness, damping, free }));
    }
}
