//! `[sensors]` of a template, which stands for a `[[sensor]]` of each column of its recordings.

use crate::scenario::{Body, Quantity, Scenario, Sensor, Sensors};

/// Where the tracker looks at the output body: the origin of its axes.
const TRACKED: &str = "C";

/// The sensors that `[sensors]` stands for, none where the section is absent: commands, encoders and forces of
/// the driven `joints`, `q1_cmd`, `q1` and `F1` of the first, and the pose `x`, `y`, `phi` of the output body, at a
/// point that it is given for that.
pub(super) fn of(scenario: &Scenario, output: &mut Body, joints: &[&str]) -> Vec<Sensor> {
    let Some(instruments) = &scenario.sensors else { return Vec::new() };
    let Sensors { pose_std, angle_std, length_resolution, force_std, force_lowpass } = *instruments;
    let sensor = |column: String, quantity, of: &str| Sensor {
        column,
        quantity,
        of: of.to_owned(),
        axis: None,
        std: 0.0,
        resolution: 0.0,
        lowpass: 0.0,
    };
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
}
