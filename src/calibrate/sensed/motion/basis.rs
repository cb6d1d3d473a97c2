//! Which sensors say how a machine stands, and how the machine without clearance moves as they show.
//!
//! A body whose place and angle a tracker shows, and that leaves the machine no other freedom, is known better
//! than the joints' encoders know it: between them lies the play of joints, and a body that floats in it
//! accelerates otherwise than any encoder does. Without one, sensors and commands of joints
//! say it, and, where these do not, angles and places of bodies (`sources.rs`).

use super::shown::{
    MeasuredCommands, MeasuredCoordinate, MeasuredPose, commanded, coordinate, placed, pose,
};
use super::sources::{CoordinateSource, freedoms, place, sources, starts};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::mechanism::{
    Actuator, Bearing, Drive, Idle, Imposed, JointIndex, Mark, Mechanism, Place, Reads, Tracker,
};
use nalgebra::UnitComplex;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// What says how a machine without clearance stands, and the coordinates along which efforts are looked at.
#[derive(Clone, Debug)]
pub struct Basis {
    /// As many joints as the machine has freedoms: those with drives first.
    pub joints: Vec<JointIndex>,
    /// What shows the motion.
    shown: Shown,
    /// How far journals are taken to lean on their rings under the forces that are measured, as a share of that.
    pub lean: f64,
}

#[derive(Clone, Debug)]
enum Shown {
    /// What says the coordinate of each of the joints.
    Coordinates(Vec<CoordinateSource>),
    /// Sensors of x, y and angle of one body.
    Pose([usize; 3]),
}

impl Basis {
    /// What of a recording determines the machine; none where nothing does.
    pub fn of(mechanism: &Mechanism, recording: &Recording) -> Option<Self> {
        Self::tracked(mechanism, recording).or_else(|| {
            let (joints, sources) = sources(mechanism, recording)?.into_iter().unzip();
            Some(Self { joints, shown: Shown::Coordinates(sources), lean: 1.0 })
        })
    }

    /// A tracked body that determines a machine whose joints have play.
    fn tracked(mechanism: &Mechanism, recording: &Recording) -> Option<Self> {
        let play = |bearing: &Bearing| !matches!(bearing, Bearing::Ideal);
        if !mechanism.revolutes.iter().any(|joint| play(&joint.bearing)) {
            return None;
        }
        let joints = freedoms(mechanism)?;
        let read = |reads: &dyn Fn(&Reads) -> bool| {
            let mut sensors = mechanism.sensors.iter().enumerate();
            let found = |(i, sensor): &(usize, &crate::mechanism::Sensor)| {
                recording.get(*i).is_some() && reads(&sensor.reads)
            };
            sensors.find(found).map(|(i, _)| i)
        };
        let mut bodies = 0..mechanism.bodies.len();
        let pose = bodies.find_map(|body| {
            let of = |mark: &Mark| mark.body == Some(body);
            let x = read(&|reads| matches!(reads, Reads::X(mark) if of(mark)))?;
            let Reads::X(point) = mechanism.sensors[x].reads else { return None };
            let same = |mark: &Mark| of(mark) && mark.point == point.point;
            let y = read(&|reads| matches!(reads, Reads::Y(mark) if same(mark)))?;
            let angle = read(&|reads| matches!(reads, Reads::Angle(Some(of), _) if *of == body))?;
            Some([x, y, angle])
        })?;
        let basis = Self { joints, shown: Shown::Pose(pose), lean: 1.0 };
        // Three numbers determine three freedoms, if they can be imposed.
        (basis.joints.len() == 3 && basis.holds(mechanism)).then_some(basis)
    }

    /// Whether the machine can be put at its own first pose by what is shown of it.
    fn holds(&self, mechanism: &Mechanism) -> bool {
        let states = starts(mechanism);
        let Some((point, angle, offset)) = self.target(mechanism) else { return false };
        let place = point.attachment(mechanism).frame(&states).centre;
        let rotation = states[offset].rotation * UnitComplex::new(angle);
        let at = place.push(rotation.angle());
        let still = MeasuredPose {
            interval: 1.0,
            columns: [0, 1, 2].map(|k| [vec![at[k]; 2], vec![0.0; 2], vec![0.0; 2]]),
        };
        let ideal = self.ideal(mechanism);
        let (imposed, states) = (imposed(&ideal, point, angle, still), starts(&ideal));
        Tracker::new(ideal, imposed, states, 0.0).is_ok()
    }

    /// Point, angle (rad) of the written axes in the body's, and the body of what is tracked.
    fn target(&self, mechanism: &Mechanism) -> Option<(Mark, f64, usize)> {
        let Shown::Pose([x, _, angle]) = &self.shown else { return None };
        match (mechanism.sensors[*x].reads, mechanism.sensors[*angle].reads) {
            (Reads::X(point), Reads::Angle(Some(body), angle)) => Some((point, angle, body)),
            _ => None,
        }
    }

    /// Whether the motion is taken from a sensor.
    pub fn needs(&self, sensor: usize) -> bool {
        match &self.shown {
            Shown::Coordinates(sources) => sources.iter().any(|source| match source {
                CoordinateSource::Sensor(own) | CoordinateSource::Place(own) => *own == sensor,
                CoordinateSource::Command(_) => false,
            }),
            Shown::Pose(sensors) => sensors.contains(&sensor),
        }
    }

    /// The geometry of a machine, its joints of the basis prescribed.
    fn ideal(&self, mechanism: &Mechanism) -> Mechanism {
        let mut ideal = mechanism.geometry();
        ideal.loads.clear();
        ideal.epoch = 0.0;
        ideal.commands = Arc::new(Idle);
        let actuator = |&joint: &JointIndex| {
            let drive = mechanism.actuators.iter().find(|drive| drive.joint == joint);
            let mut actuator =
                drive.cloned().unwrap_or_else(|| Actuator::new("", joint, Drive::Prescribed));
            actuator.drive = Drive::Prescribed;
            actuator.transmission = None;
            actuator
        };
        ideal.actuators = self.joints.iter().map(actuator).collect();
        ideal
    }

    /// The geometry of a machine and what moves it as a view shows: readings are corrected for what the
    /// mechanism's sensors and drives are known to get wrong.
    pub fn moved(&self, view: &View, mechanism: &Mechanism) -> Moved {
        let mut ideal = self.ideal(mechanism);
        let mut columns = DefaultHasher::new();
        view.interval.to_bits().hash(&mut columns);
        match (&self.shown, self.target(mechanism)) {
            (Shown::Pose(sensors), Some((point, angle, _))) => {
                let motion = pose(view, mechanism, *sensors);
                motion.columns.iter().for_each(|column| hash(column, &mut columns));
                let imposed = imposed(&ideal, point, angle, motion);
                Moved { ideal, imposed, columns: columns.finish() }
            }
            // A pose has a target: `tracked` found it.
            (Shown::Pose(_), None) => {
                Moved { ideal, imposed: Imposed::Drives, columns: columns.finish() }
            }
            (Shown::Coordinates(sources), _) => {
                let joints = self.joints.iter().zip(sources);
                let measured: Vec<MeasuredCoordinate> = joints
                    .map(|(joint, source)| match source {
                        CoordinateSource::Sensor(sensor) => {
                            coordinate(view, mechanism, *joint, *sensor)
                        }
                        CoordinateSource::Command(drive) => commanded(view, mechanism, *drive),
                        CoordinateSource::Place(sensor) => placed(view, mechanism, *sensor),
                    })
                    .collect();
                measured.iter().for_each(|columns_of| hash(columns_of, &mut columns));
                ideal.commands =
                    Arc::new(MeasuredCommands { interval: view.interval, columns: measured });
                let imposed = of_places(&ideal, sources);
                Moved { ideal, imposed, columns: columns.finish() }
            }
        }
    }
}

/// A machine's geometry and what moves it.
#[derive(Debug)]
pub struct Moved {
    /// The geometry.
    pub ideal: Mechanism,
    /// What moves it.
    pub imposed: Imposed,
    /// Digest of how.
    columns: u64,
}

impl Moved {
    /// A number that is the same where geometry, start and motion are the same to the last bit.
    pub fn digest(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        let Mechanism { revolutes, prismatics, actuators, .. } = &self.ideal;
        let joints = revolutes.iter().map(|joint| (joint.ring, joint.journal));
        let starts = starts(&self.ideal);
        let joints: Vec<_> = joints.collect();
        format!("{joints:?} {prismatics:?} {actuators:?} {starts:?}").hash(&mut hasher);
        match &self.imposed {
            Imposed::Drives => {}
            Imposed::Target { point, angle, .. } => {
                format!("{point:?} {angle:?}").hash(&mut hasher);
            }
            Imposed::Places(places) => format!("{places:?}").hash(&mut hasher),
        }
        self.columns.hash(&mut hasher);
        hasher.finish()
    }
}

/// Rates and accelerations follow from positions.
fn hash([position, ..]: &MeasuredCoordinate, hasher: &mut DefaultHasher) {
    position.iter().for_each(|value| value.to_bits().hash(hasher));
}

/// What the sources of drives' coordinates, in their order, impose on a machine's geometry.
fn of_places(geometry: &Mechanism, sources: &[CoordinateSource]) -> Imposed {
    let places = sources.iter().enumerate().map(|(drive, source)| {
        match source {
            CoordinateSource::Place(sensor) => place(geometry, *sensor),
            CoordinateSource::Sensor(_) | CoordinateSource::Command(_) => None,
        }
        .unwrap_or(Place::Drive(drive))
    });
    let places: Vec<Place> = places.collect();
    match places.iter().all(|place| matches!(place, Place::Drive(_))) {
        true => Imposed::Drives,
        false => Imposed::Places(places),
    }
}

fn imposed(mechanism: &Mechanism, point: Mark, angle: f64, motion: MeasuredPose) -> Imposed {
    let point = point.attachment(mechanism);
    Imposed::Target { point, angle: Some(angle), motion: Arc::new(motion) }
}

#[cfg(test)]
mod tests {
    use super::super::motions::Motions;
    use super::super::start::machine;
    use super::*;
    use crate::calibrate::sensed::recorded::view::effort_sensor;
    use crate::calibrate::sensed::residuals::residual::{ResidualKind, residuals};
    use crate::mechanism::Command;
    use crate::scenario::Scenario;
    use std::path::Path;

    /// A recorded 3-RPR that lacks nothing, without some of its columns.
    fn recorded(without: &[&str]) -> (Mechanism, Recording) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/rigs/rig-4");
        let rig = Scenario::load(Some(&folder.join("rig.toml")), &[]).unwrap();
        let sensors = crate::model::parts_of(&rig).unwrap().sensors;
        let whole = Recording::read(&folder.join("run-a.csv"), &sensors, false).unwrap();
        let kept = |(i, sensor): (usize, &crate::mechanism::Sensor)| {
            let kept = !without.contains(&sensor.column.as_str());
            whole.get(i).filter(|_| kept).map(<[f64]>::to_vec)
        };
        let recording = whole.with(sensors.iter().enumerate().map(kept).collect());
        (machine(&rig, &[], &recording).unwrap(), recording)
    }

    fn needed(mechanism: &Mechanism, recording: &Recording) -> Option<Vec<String>> {
        let basis = Basis::of(mechanism, recording)?;
        let sensors = mechanism.sensors.iter().enumerate();
        let needed = sensors.filter(|(i, _)| basis.needs(*i));
        Some(needed.map(|(_, sensor)| sensor.column.clone()).collect())
    }

    #[test]
    fn a_tracked_body_comes_before_encoders_and_these_before_commands() {
        for (without, expected) in [
            (&[][..], Some("x y phi")),
            (&["q1", "q2", "q3"], Some("x y phi")),
            (&["phi"], Some("q1 q2 q3")),
            // The command of P2 stands in for its encoder.
            (&["q2", "y"], Some("q1 q3")),
        ] {
            let (mechanism, recording) = recorded(without);
            let needed = needed(&mechanism, &recording).map(|columns| columns.join(" "));
            assert_eq!(needed.as_deref(), expected, "without {without:?}");
        }
    }

    /// By either way of knowing the motion the rest of what was measured is where the bodies are, journals
    /// leaning on their rings: within a tenth of the play of 0.1 mm on each side, though they swing in it.
    #[test]
    fn what_the_basis_does_not_need_closes() {
        for (without, of) in [(&[][..], "q1 q2 q3"), (&["phi"][..], "x y")] {
            let (mechanism, recording) = recorded(without);
            let basis = Basis::of(&mechanism, &recording).unwrap();
            let view = View::new(&recording, mechanism.sensors.len());
            let found =
                residuals(&view, &mechanism, &basis, view.rows(), &Motions::default()).unwrap();
            let closures = found.names.iter().zip(&found.signals);
            let closures: Vec<_> =
                closures.filter(|(name, _)| name.kind == ResidualKind::Closure).collect();
            let columns: Vec<&str> = closures.iter().map(|(name, _)| name.of.as_str()).collect();
            assert_eq!(columns.join(" "), of);
            for (name, signal) in closures {
                let squares: f64 = signal.values.iter().map(|v| v * v).sum();
                let rms = (squares / signal.values.len() as f64).sqrt();
                println!("closure of {}: {rms:.2e} m", name.of);
                assert!(rms < 2e-5, "closure of {}: {rms:e} m", name.of);
            }
        }
    }

    /// What gives way between a drive and its joint does so whether an encoder or the command says where the drive's end
    /// is: without the encoder of a drive with a springy link, a wrong servo gain was named in its place.
    #[test]
    fn what_gives_way_behind_a_drive_is_taken_from_commands_too() {
        for without in [&["phi"][..], &["phi", "q2"]] {
            let (mut mechanism, recording) = recorded(without);
            let basis = Basis::of(&mechanism, &recording).unwrap();
            let view = View::new(&recording, mechanism.sensors.len());
            let coordinate = |mechanism: &Mechanism| {
                let moved = basis.moved(&view, mechanism);
                let mut commands = vec![Command::default(); 3];
                moved.ideal.commands.at(1.0, &mut commands);
                // Joints with sensors stand before those with commands alone.
                commands.iter().map(|command| command.position).sum::<f64>()
            };
            let stiff = coordinate(&mechanism);
            let compliance = 1e-6;
            mechanism.actuators[1].transmission =
                Some(crate::mechanism::Transmission { compliance, ..Default::default() });
            let sensor = effort_sensor(&mechanism, 1).unwrap();
            let row = (1.0 / view.interval).round() as usize;
            let force = view.smooth(sensor).unwrap()[row];
            let given = stiff - coordinate(&mechanism);
            assert!(
                (given - compliance * force).abs() < 1e-9 + 1e-3 * given.abs(),
                "without {without:?}: {given} of {}",
                compliance * force
            );
        }
    }

    /// A load swings at the tip of a crane's boom, whose one freedom a cylinder drives.
    #[test]
    fn an_angle_stands_in_for_a_joint_that_nobody_measures() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli_calibrate_mechanism");
        let rig = Scenario::load(Some(&folder.join("crane.toml")), &[]).unwrap();
        let sensors = crate::model::parts_of(&rig).unwrap().sensors;
        let stands = [("q_cmd", 0.2865), ("q", 0.2865), ("F", 0.0), ("th", 0.6), ("al", -1.57)];
        for (columns, expected) in [
            ("q_cmd q th F", None),
            ("q_cmd q th al", Some("q al at P T")),
            ("q_cmd al", Some("al at P T")),
        ] {
            let recorded = |name: &str| columns.split(' ').any(|column| column == name);
            let column = |(name, value)| recorded(name).then(|| vec![value; 8]);
            let recording = Recording::of("run-a", 1e-3, 8, stands.map(column).to_vec());
            let mechanism = machine(&rig, &[], &recording).unwrap();
            let found = Basis::of(&mechanism, &recording).map(|basis| {
                let joints = basis.joints.iter().map(|joint| mechanism.joint_name(*joint));
                let joints = joints.collect::<Vec<_>>().join(" ");
                format!("{} at {joints}", needed(&mechanism, &recording).unwrap().join(" "))
            });
            assert_eq!(found.as_deref(), expected, "{columns}");
            assert!(sensors.iter().zip(stands).all(|(sensor, (name, _))| sensor.column == name));
        }
    }
}
