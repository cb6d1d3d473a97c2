//! What says the coordinates of a machine's joints: sensors of them, commands of drives whose joints nobody measures, and, where
//! these leave it a freedom, angles and places of bodies.

use crate::calibrate::sensed::recorded::recording::Recording;
use crate::mechanism::{
    Actuator, Attachment, BodyState, Drive, JointIndex, Mechanism, Place, Reads,
};

/// What says a coordinate, or a place that it follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CoordinateSource {
    /// A sensor of it.
    Sensor(usize),
    /// The command of a drive whose joint nobody measures, less what the drive yields under its effort.
    Command(usize),
    /// A sensor of a body's angle or of a point's place.
    Place(usize),
}

/// As many joints as the machine has freedoms, and what says how they stand: sensors of joints, and commands of drives whose
/// joints have none, those of driven joints first, then others, then [places](places), each if it adds something.
pub(super) fn sources(
    mechanism: &Mechanism,
    recording: &Recording,
) -> Option<Vec<(JointIndex, CoordinateSource)>> {
    let read = |reads: &dyn Fn(&Reads) -> bool| {
        let mut sensors = mechanism.sensors.iter().enumerate();
        sensors.find(|(i, sensor)| recording.get(*i).is_some() && reads(&sensor.reads))
    };
    let drives = mechanism.actuators.iter().enumerate().filter_map(|(index, drive)| {
        let holds = matches!(drive.drive, Drive::Servo { .. } | Drive::Prescribed);
        let told = read(&|reads| matches!(reads, Reads::Command(of) if *of == index));
        let seen = read(&|reads| matches!(reads, Reads::Position(joint) if *joint == drive.joint));
        (holds && told.is_some() && seen.is_none())
            .then_some((drive.joint, CoordinateSource::Command(index)))
    });
    let sensors = mechanism.sensors.iter().enumerate();
    let joints = sensors.filter_map(|(i, sensor)| match sensor.reads {
        Reads::Position(joint) => recording.get(i).map(|_| (joint, CoordinateSource::Sensor(i))),
        _ => None,
    });
    let mut from: Vec<_> = drives.chain(joints).collect();
    driven_first(mechanism, &mut from);
    let mut held = mechanism.without_clearance();
    held.actuators.clear();
    let mut found = added(mechanism, &mut held, from);
    let states = starts(mechanism);
    let seen = places(mechanism, recording);
    let (sensors, seen): (Vec<usize>, Vec<Place>) = seen.into_iter().unzip();
    let chosen = held.determining(&states, &seen)?;
    let others = added(mechanism, &mut held, mechanism.joints().map(|(_, joint)| (joint, ())));
    let place =
        |((joint, ()), i): ((JointIndex, ()), usize)| (joint, CoordinateSource::Place(sensors[i]));
    if others.len() != chosen.len() {
        return None;
    }
    found.extend(others.into_iter().zip(chosen).map(place));
    Some(found)
}

/// As many of a machine's joints as it has freedoms, driven ones first.
pub(super) fn freedoms(mechanism: &Mechanism) -> Option<Vec<JointIndex>> {
    let mut joints: Vec<_> = mechanism.joints().map(|(_, joint)| (joint, ())).collect();
    driven_first(mechanism, &mut joints);
    let mut held = mechanism.without_clearance();
    held.actuators.clear();
    let found = added(mechanism, &mut held, joints);
    held.determining(&starts(mechanism), &[])?;
    Some(found.into_iter().map(|(joint, ())| joint).collect())
}

/// Where a sensor of a body's angle or of a point's place says that it is; none of other sensors.
pub(super) fn place(mechanism: &Mechanism, sensor: usize) -> Option<Place> {
    match mechanism.sensors[sensor].reads {
        Reads::X(mark) => Some(Place::X(mark.attachment(mechanism))),
        Reads::Y(mark) => Some(Place::Y(mark.attachment(mechanism))),
        Reads::Angle(body, angle) => {
            Some(Place::Angle(Attachment { body, point: Default::default() }, angle))
        }
        _ => None,
    }
}

/// The sensor of a point's other coordinate, if a sensor is of one and the other was recorded.
pub(super) fn partner(
    mechanism: &Mechanism,
    sensor: usize,
    recorded: impl Fn(usize) -> bool,
) -> Option<usize> {
    let mut others = mechanism.sensors.iter().enumerate();
    let found = others.find(|(i, other)| match (mechanism.sensors[sensor].reads, other.reads) {
        (Reads::X(a), Reads::Y(b)) | (Reads::Y(a), Reads::X(b)) => {
            a.body == b.body && a.point == b.point && recorded(*i)
        }
        _ => false,
    });
    found.map(|(i, _)| i)
}

/// What sensors of places recorded, and where: angles, then points of which a tracker shows both coordinates, for its frame
/// may be turned.
fn places(mechanism: &Mechanism, recording: &Recording) -> Vec<(usize, Place)> {
    let recorded = |sensor: usize| recording.get(sensor).is_some();
    let all = (0..mechanism.sensors.len()).filter(|&sensor| recorded(sensor));
    let all = all.filter_map(|sensor| Some((sensor, place(mechanism, sensor)?)));
    let is_angle = |place: &Place| matches!(place, Place::Angle(..));
    let (angles, points): (Vec<_>, Vec<_>) = all.partition(|(_, place)| is_angle(place));
    let whole = |(sensor, _): &(usize, Place)| partner(mechanism, *sensor, recorded).is_some();
    angles.into_iter().chain(points.into_iter().filter(whole)).collect()
}

fn driven_first<T>(mechanism: &Mechanism, joints: &mut [(JointIndex, T)]) {
    let driven = |joint| mechanism.actuators.iter().any(|drive| drive.joint == joint);
    joints.sort_by_key(|(joint, _)| !driven(*joint));
}

/// Those joints that leave the machine with what is held so far a freedom less, which are held from then on.
fn added<T>(
    mechanism: &Mechanism,
    held: &mut Mechanism,
    from: impl IntoIterator<Item = (JointIndex, T)>,
) -> Vec<(JointIndex, T)> {
    let states = starts(mechanism);
    let mut adds = |(joint, _): &(JointIndex, T)| {
        if held.actuators.iter().any(|own| own.joint == *joint) {
            return false;
        }
        held.actuators.push(Actuator::new("", *joint, Drive::Prescribed));
        let adds = held.freedoms(&states).overdriven.is_empty();
        if !adds {
            held.actuators.pop();
        }
        adds
    };
    from.into_iter().filter(|joint| adds(joint)).collect()
}

/// States of a mechanism's bodies as they start.
pub(super) fn starts(mechanism: &Mechanism) -> Vec<BodyState> {
    mechanism.bodies.iter().map(|body| body.start).collect()
}
