//! `[sensors]` and `[columns]` of a template, which stand for a `[[sensor]]` of each column of its recordings.

use crate::measure::log::ColumnSource;
use crate::mechanism::JointIndex;
use crate::scenario::{Body, DriveMode, Mechanism, Problem, Quantity, Scenario, Sensor, Sensors};

/// Where the tracker looks at the output body: the origin of its axes.
const TRACKED: &str = "C";

/// The sensors that `[sensors]` stands for, none where the section is absent: commands, encoders and forces of
/// the driven `joints`, `q1_cmd`, `q1` and `F1` of the first, and the pose `x`, `y`, `phi` of the output body, at a
/// point that it is given for that.
pub(super) fn of(scenario: &Scenario, output: &mut Body, joints: &[&str]) -> Vec<Sensor> {
    let Some(instruments) = &scenario.sensors else { return Vec::new() };
    let Sensors { pose_std, angle_std, length_resolution, force_std, force_lowpass } = *instruments;
    let sensor =
        |column: String, quantity, of: &str| exact(ColumnSource::new(&column, 1.0), quantity, of);
    let columns = |quantity, name: fn(usize) -> String| {
        let joints = joints.iter().enumerate();
        joints.map(move |(i, joint)| sensor(name(i + 1), quantity, joint)).collect::<Vec<Sensor>>()
    };
    let mut sensors = columns(Quantity::Command, |i| format!("q{i}_cmd"));
    for sensor in columns(Quantity::Position, |i| format!("q{i}")) {
        sensors.push(Sensor { resolution: length_resolution, ..sensor });
    }
    for sensor in columns(Quantity::Force, |i| format!("F{i}")) {
        sensors.push(Sensor { std: force_std, lowpass: force_lowpass, ..sensor });
    }
    output.points.insert(TRACKED.to_owned(), [0.0, 0.0]);
    let tracked = format!("{}.{TRACKED}", output.name);
    let pose = [("x", Quantity::X, pose_std), ("y", Quantity::Y, pose_std)];
    for (column, quantity, std) in pose.into_iter().chain([("phi", Quantity::Angle, angle_std)]) {
        sensors.push(Sensor { std, ..sensor(column.to_owned(), quantity, &tracked) });
    }
    sensors
}

/// The sensors of a machine whose recordings hold these quantities: name, what it is, and of what. `[columns]` says
/// which column is which; what it does not name has a column of its own name.
///
/// # Errors
/// A name in `[columns]` that is none of them.
pub(super) fn named(
    scenario: &Scenario,
    known: &[(&str, Quantity, &str)],
) -> Result<Vec<Sensor>, Problem> {
    let columns = scenario.columns.as_ref();
    let strange = |name: &&str| known.iter().all(|(known, ..)| known != name);
    if let Some(name) = columns.and_then(|columns| columns.quantities().find(strange)) {
        let names: Vec<&str> = known.iter().map(|(name, ..)| *name).collect();
        let message = "is not a quantity of this machine's recordings";
        let help = format!("known here: t, {}", names.join(", "));
        return Err(scenario.problem(&format!("columns.{name}"), message, help));
    }
    let sensor = |(name, quantity, of): &(&str, Quantity, &str)| {
        let source = columns.and_then(|columns| columns.source(name));
        exact(source.unwrap_or_else(|| ColumnSource::new(name, 1.0)), *quantity, of)
    };
    Ok(known.iter().map(sensor).collect())
}

/// Noise of the instruments of a good laboratory, as the rigs in `assets/` have them: a tracker's micrometres and
/// microradians, an encoder's steps, a load cell's newtons with its anti-alias filter; torques of small motors.
const LABORATORY: Sensors = Sensors {
    pose_std: 4e-6,
    angle_std: 3e-5,
    length_resolution: 1e-6,
    force_std: 0.15,
    force_lowpass: 400.0,
};
const ANGLE_RESOLUTION: f64 = 2e-5;
const TORQUE_STD: f64 = 0.002;

/// The same of an accelerometer as small as a fingernail: m/s², and the corner of its filter in Hz.
const ACCELERATION_STD: f64 = 0.05;
const ACCELERATION_LOWPASS: f64 = 300.0;

/// A sensor of a quantity, of a revolute joint where it `turns`, with the noise of a good laboratory; a command is exact.
pub fn laboratory(quantity: Quantity, turns: bool, column: &str, of: &str) -> Sensor {
    let bare = exact(ColumnSource::new(column, 1.0), quantity, of);
    let Sensors { pose_std, angle_std, length_resolution, force_std, force_lowpass } = LABORATORY;
    match quantity {
        Quantity::X | Quantity::Y => Sensor { std: pose_std, ..bare },
        Quantity::Angle => Sensor { std: angle_std, ..bare },
        Quantity::Position if turns => Sensor { resolution: ANGLE_RESOLUTION, ..bare },
        Quantity::Position => Sensor { resolution: length_resolution, ..bare },
        Quantity::Force if turns => Sensor { std: TORQUE_STD, lowpass: force_lowpass, ..bare },
        Quantity::Force => Sensor { std: force_std, lowpass: force_lowpass, ..bare },
        Quantity::Acceleration => {
            Sensor { std: ACCELERATION_STD, lowpass: ACCELERATION_LOWPASS, ..bare }
        }
        Quantity::Command | Quantity::Output | Quantity::Added => bare,
    }
}

/// Natural angular frequency in rad/s of a servo that turns a whole machine, 20 Hz, and its damping ratio: those of common
/// drives. The gains of `[drive]` are for prismatic joints.
const STIFF: f64 = 20.0 * std::f64::consts::TAU;
const DAMPING_RATIO: f64 = 0.7;

/// A machine as a rig to begin with: with sensors of all drives and of its output, and servos where drives were prescribed. One that reads its recordings by
/// `[columns]` is as it was.
///
/// # Errors
/// A template whose machine cannot be put together.
pub fn instrumented(scenario: &Scenario) -> Result<Scenario, Problem> {
    let mut rig = scenario.clone();
    rig.drive.mode = DriveMode::Servo;
    match &scenario.mechanism {
        Mechanism::ThreeRpr(_) => {
            rig.sensors = Some(LABORATORY);
            Ok(rig)
        }
        Mechanism::DriveStage(_) | Mechanism::Pendulum(_) => Ok(scenario.clone()),
        _ => {
            let built = crate::model::parts_of(&rig)?;
            if built.actuators.iter().all(|drive| matches!(drive.joint, JointIndex::Revolute(_))) {
                let inertia =
                    |body: &crate::mechanism::Body| body.inertia + body.mass * built.size().powi(2);
                let inertia: f64 = built.bodies.iter().map(inertia).sum();
                rig.drive.stiffness = inertia * STIFF * STIFF;
                rig.drive.damping = 2.0 * DAMPING_RATIO * inertia * STIFF;
            }
            let mut rig = super::expand(&rig)?;
            let mechanism = crate::model::parts_of(&rig)?;
            if let Mechanism::Described(described) = &mut rig.mechanism {
                described.sensors = all_sensors(&mechanism);
                let output = &mechanism.bodies[mechanism.output].name;
                let body = described.bodies.iter().find(|body| body.name == *output);
                let point = body.and_then(|body| body.points.keys().next());
                if let Some(point) = point {
                    let tracked = format!("{output}.{point}");
                    let place = [("x", Quantity::X), ("y", Quantity::Y)];
                    let sensor = |(column, quantity)| laboratory(quantity, false, column, &tracked);
                    described.sensors.extend(place.map(sensor));
                }
            }
            Ok(rig)
        }
    }
}

/// A command, an encoder and an effort of each drive; an encoder of each joint of a machine without drives.
fn all_sensors(mechanism: &crate::mechanism::Mechanism) -> Vec<Sensor> {
    let mut sensors = Vec::new();
    for drive in &mechanism.actuators {
        let name = &drive.name;
        let turns = matches!(drive.joint, JointIndex::Revolute(_));
        let letter = if turns { "T" } else { "F" };
        sensors.extend([
            laboratory(Quantity::Command, turns, &format!("q_{name}_cmd"), name),
            laboratory(Quantity::Position, turns, &format!("q_{name}"), name),
            laboratory(Quantity::Force, turns, &format!("{letter}_{name}"), name),
        ]);
    }
    if sensors.is_empty() {
        let joints = mechanism.revolutes.iter();
        sensors.extend(joints.map(|joint| {
            laboratory(Quantity::Position, true, &format!("q_{}", joint.name), &joint.name)
        }));
    }
    sensors
}

/// A sensor of which no noise is declared.
fn exact(ColumnSource { column, scale }: ColumnSource, quantity: Quantity, of: &str) -> Sensor {
    let of = of.to_owned();
    Sensor { column, quantity, of, axis: None, scale, std: 0.0, resolution: 0.0, lowpass: 0.0 }
}

#[cfg(test)]
mod tests {
    use crate::model::{expand, parts_of};
    use crate::scenario::Scenario;

    #[test]
    fn a_rig_has_a_sensor_for_each_column_of_its_recordings() {
        let text =
            "[mechanism]\nkind = \"3rpr\"\n[sensors]\nangle_std = 3e-5\nforce_lowpass = 400.0\n";
        let rig = Scenario::from_text(text, "rig.toml", &[]).unwrap();
        let sensors = parts_of(&rig).unwrap().sensors;
        let columns: Vec<&str> = sensors.iter().map(|sensor| sensor.column.as_str()).collect();
        let expected = "q1_cmd q2_cmd q3_cmd q1 q2 q3 F1 F2 F3 x y phi";
        assert_eq!(columns.join(" "), expected);
        assert_eq!((sensors[6].lowpass, sensors[11].std), (400.0, 3e-5));
        // The file that it stands for says so itself.
        let written = expand(&rig).unwrap().to_toml();
        let again = parts_of(&Scenario::from_text(&written, "written.toml", &[]).unwrap()).unwrap();
        assert_eq!(again.sensors.len(), sensors.len());
        // Nobody measures a machine without the section.
        let bare = Scenario::from_text("[mechanism]\nkind = \"3rpr\"\n", "bare.toml", &[]).unwrap();
        assert!(parts_of(&bare).unwrap().sensors.is_empty());
    }

    #[test]
    fn columns_of_a_template_are_sensors_with_a_scale() {
        let text = "[mechanism]\nkind = \"pendulum\"\n[columns]\nt = { column = \"ms\", scale = 1e-3 }\n\
                    phi = { column = \"deg\", scale = 0.0175 }\n";
        let read = |text: &str| Scenario::from_text(text, "rig.toml", &[]).unwrap();
        let of = |rig: &Scenario| {
            let sensors = parts_of(rig).unwrap().sensors;
            let sensors = sensors.iter().map(|sensor| (sensor.column.clone(), sensor.factor));
            (sensors.collect::<Vec<_>>(), rig.columns.as_ref().unwrap().source("t").unwrap())
        };
        let rig = read(text);
        assert_eq!(of(&rig).0, [("deg".to_owned(), 0.0175)]);
        // The file that it stands for says the same.
        assert_eq!(of(&read(&expand(&rig).unwrap().to_toml())), of(&rig));
        let strange = expand(&read(&text.replace("phi", "q1"))).unwrap_err().to_string();
        assert!(
            strange.contains("columns.q1") && strange.contains("known here: t, phi"),
            "{strange}"
        );
    }
}
