//! What a recording says against a model without simulating it: residuals with names, as many as there are.
//!
//! * **law** of a drive: its measured effort less what its command and the measured coordinate make it;
//! * **dynamics** of each joint of the [`Basis`]: the effort that acts on it less what the measured
//!   motion takes by inverse dynamics; where no drive acts that is an effort of zero;
//! * **closure**: each other measured position less where the bodies are, journals leaning on their rings as far as
//!   noise allows;
//! * **acceleration**: each measured one less that of the measured motion.

use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::motion::law::ServoLaw;
use crate::calibrate::sensed::motion::motions::Motions;
use crate::calibrate::sensed::recorded::view::{View, effort_sensor, output_sensor};
use crate::calibrate::sensed::thresholds::{DYNAMICS_BAND, PLAIN_BAND};
use crate::calibrate::values::spectrum::Signal;
use crate::mechanism::{
    BodyState, Command, Drive, Evaluation, JointIndex, Mechanism, Posed, Reads, Sensor, Taken,
    angle_near,
};
use std::ops::Range;

/// Which residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ResidualKind {
    /// A drive against its own command.
    Law,
    /// Efforts against the motion.
    Dynamics,
    /// A redundant position.
    Closure,
    /// A measured acceleration.
    Acceleration,
}

impl ResidualKind {
    /// As reports spell it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Law => "law",
            Self::Dynamics => "dynamics",
            Self::Closure => "closure",
            Self::Acceleration => "acceleration",
        }
    }
}

/// A residual by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// Which.
    pub kind: ResidualKind,
    /// Of which joint or column.
    pub of: String,
    /// Unit.
    pub unit: &'static str,
}

/// Residuals of a recording: names, and samples in the same order.
#[derive(Clone, Debug, Default)]
pub struct Residuals {
    /// What they are.
    pub names: Vec<Name>,
    /// Their samples at the rows that were looked at.
    pub signals: Vec<Signal>,
}

/// Where an effort along a coordinate comes from.
enum EffortSource<'a> {
    /// Samples of a sensor, plain and slow, to be corrected for its errors.
    Measured(usize, &'a [f64], &'a [f64]),
    /// What a sampled drive gives when it is asked for its recorded outputs.
    Asked(usize),
    /// The law of a drive.
    Law(usize),
    /// Nothing acts.
    None,
}

/// A model beside a view of a recording, and what of the one is read beside the other.
struct Look<'a> {
    view: &'a View,
    mechanism: &'a Mechanism,
    basis: &'a Basis,
    /// What each drive makes of its command, if it is a servo with a recorded encoder.
    servos: Vec<Option<ServoLaw<'a>>>,
    /// What each drive with a sampled controller gives by its recorded outputs.
    asked: Vec<Option<Vec<f64>>>,
    /// Drives whose law can be held against their measured effort, with the sensor of that.
    laws: Vec<(usize, usize)>,
    /// Where the effort of each joint of the basis comes from, if anybody knows it.
    efforts: Vec<Option<EffortSource<'a>>>,
    /// The same of drives that the basis does not read.
    outside: Vec<(JointIndex, EffortSource<'a>)>,
    /// Measured positions that the basis does not need, and accelerations: the sensor, and how late and how large it shows
    /// what it reads, its waves among that.
    others: Vec<(usize, Sensor)>,
}

/// The residuals of a view under a mechanism on some rows; none where the measured motion leads it where it
/// cannot be.
pub fn residuals(
    view: &View,
    mechanism: &Mechanism,
    basis: &Basis,
    rows: Range<usize>,
    motions: &Motions,
) -> Option<Residuals> {
    let look = Look::new(view, mechanism, basis);
    let mut found = Residuals::default();
    look.names(&mut found);
    let poses = motions.of(view, mechanism, basis, rows.clone())?;
    let mut now = Evaluation::new(mechanism);
    for (row, pose) in rows.step_by(view.stride).zip(poses.iter()) {
        look.row(pose, row, &mut now, &mut found.signals)?;
    }
    Some(found)
}

/// Efforts of drives with sampled controllers, out of what these were recorded to ask for.
fn asked(view: &View, mechanism: &Mechanism) -> Vec<Option<Vec<f64>>> {
    let of = |(index, drive): (usize, &crate::mechanism::Actuator)| {
        let Drive::Sampled(cascade) = drive.drive else { return None };
        let sensor = output_sensor(mechanism, index)?;
        let (errors, read) = (&mechanism.sensors[sensor], view.plain(sensor)?);
        let outputs: Vec<f64> = (0..read.len()).map(|row| view.shown(errors, read, row)).collect();
        Some(cascade.forces(&outputs, view.interval))
    };
    mechanism.actuators.iter().enumerate().map(of).collect()
}

impl<'a> Look<'a> {
    fn new(view: &'a View, mechanism: &'a Mechanism, basis: &'a Basis) -> Self {
        let drives = 0..mechanism.actuators.len();
        let servo = |drive| ServoLaw::of(view, mechanism, drive, |sensor| view.plain(sensor));
        let (servos, asked) = (drives.clone().map(servo).collect(), asked(view, mechanism));
        let (laws, efforts, outside, others) = Default::default();
        let mut look =
            Self { view, mechanism, basis, servos, asked, laws, efforts, outside, others };
        look.laws = drives.clone().filter_map(|drive| Some((drive, look.law_of(drive)?))).collect();
        look.efforts = basis.joints.iter().map(|&joint| look.effort(joint)).collect();
        let joints = drives.map(|drive| mechanism.actuators[drive].joint);
        let outside = joints.filter(|joint| !basis.joints.contains(joint));
        look.outside = outside.filter_map(|joint| Some((joint, look.effort(joint)?))).collect();
        let bare = |i: usize| (i, Sensor { waves: Vec::new(), ..mechanism.sensors[i].clone() });
        let others = (0..mechanism.sensors.len()).filter(|&i| look.is_other(i));
        look.others = others.map(bare).collect();
        look
    }

    /// The sensor of a drive's effort, if its law can be held against that.
    fn law_of(&self, drive: usize) -> Option<usize> {
        let known = match self.mechanism.actuators[drive].drive {
            Drive::Servo { .. } => self.servos[drive].is_some(),
            Drive::Effort => true,
            Drive::Prescribed | Drive::Sampled(_) => false,
        };
        let effort = effort_sensor(self.mechanism, drive)?;
        (known && self.view.plain(effort).is_some()).then_some(effort)
    }

    /// Whether a sensor measured a position that the basis does not need, or an acceleration.
    fn is_other(&self, sensor: usize) -> bool {
        let reads = self.mechanism.sensors[sensor].reads;
        let position = !matches!(
            reads,
            Reads::Command(_) | Reads::Added(_) | Reads::Effort(_) | Reads::Output(_)
        );
        position && !self.basis.needs(sensor) && self.view.plain(sensor).is_some()
    }

    fn effort(&self, joint: JointIndex) -> Option<EffortSource<'a>> {
        let of_joint = |drive: &crate::mechanism::Actuator| drive.joint == joint;
        let Some(drive) = self.mechanism.actuators.iter().position(of_joint) else {
            return Some(EffortSource::None);
        };
        if let Some(sensor) = effort_sensor(self.mechanism, drive)
            && let (Some(smooth), Some(slow)) = (self.view.smooth(sensor), self.view.slow(sensor))
        {
            return Some(EffortSource::Measured(sensor, smooth, slow));
        }
        match self.mechanism.actuators[drive].drive {
            Drive::Servo { .. } if self.servos[drive].is_some() => Some(EffortSource::Law(drive)),
            Drive::Effort => Some(EffortSource::Law(drive)),
            Drive::Sampled(_) if self.asked[drive].is_some() => Some(EffortSource::Asked(drive)),
            // What holds a prescribed coordinate is anything, a servo's effort is unknown without its error, and a
            // sampled controller remembers what nobody recorded.
            Drive::Servo { .. } | Drive::Prescribed | Drive::Sampled(_) => None,
        }
    }

    fn names(&self, found: &mut Residuals) {
        let unit = |joint| match joint {
            JointIndex::Prismatic(_) => "N",
            JointIndex::Revolute(_) => "N·m",
        };
        let mut add = |kind, of: &str, unit, band| {
            found.names.push(Name { kind, of: of.to_owned(), unit });
            found.signals.push(Signal { values: Vec::new(), band });
        };
        for &(drive, _) in &self.laws {
            let actuator = &self.mechanism.actuators[drive];
            add(ResidualKind::Law, &actuator.name, unit(actuator.joint), PLAIN_BAND);
        }
        for (&joint, effort) in self.basis.joints.iter().zip(&self.efforts) {
            if effort.is_some() {
                let name = self.mechanism.joint_name(joint);
                add(ResidualKind::Dynamics, name, unit(joint), DYNAMICS_BAND);
            }
        }
        for (_, of) in &self.others {
            let (kind, band) = match of.reads {
                Reads::Acceleration(..) => (ResidualKind::Acceleration, DYNAMICS_BAND),
                _ => (ResidualKind::Closure, PLAIN_BAND),
            };
            add(kind, &of.column, of.unit(self.mechanism), band);
        }
    }

    /// Effort of a drive by its own law in N or N·m, from its command and what its encoder shows.
    fn law(&self, drive: usize, command: Command, row: usize) -> f64 {
        match self.mechanism.actuators[drive].drive {
            Drive::Effort => command.position,
            _ => self.servos[drive].as_ref().map_or(0.0, |servo| servo.effort(command, row)),
        }
    }

    /// What a joint is given at a row, and the slow part of it.
    fn given(&self, source: &EffortSource, commands: &[Command], row: usize) -> [f64; 2] {
        match *source {
            EffortSource::Measured(sensor, smooth, slow) => {
                [smooth, slow].map(|series| self.looked_at(sensor, series, row))
            }
            EffortSource::Asked(drive) => {
                [self.asked[drive].as_ref().map_or(0.0, |asked| asked[row]); 2]
            }
            EffortSource::Law(drive) => [self.law(drive, commands[drive], row); 2],
            EffortSource::None => [0.0; 2],
        }
    }

    /// What a sensor looked at, at a row of one of its series.
    fn looked_at(&self, sensor: usize, series: &[f64], row: usize) -> f64 {
        self.view.shown(&self.mechanism.sensors[sensor], series, row)
    }

    fn row(
        &self,
        pose: &Posed,
        row: usize,
        now: &mut Evaluation,
        signals: &mut [Signal],
    ) -> Option<()> {
        let t = pose.time();
        let mut commands = vec![Command::default(); self.mechanism.actuators.len()];
        self.mechanism.commands.at(t, &mut commands);
        let mut next = signals.iter_mut();
        let mut push = |value: f64| {
            if let Some(signal) = next.next() {
                signal.values.push(value);
            }
        };
        for &(drive, sensor) in &self.laws {
            let measured = self.looked_at(sensor, self.view.plain(sensor)?, row);
            push(measured - self.law(drive, commands[drive], row));
        }
        let given = |source: &EffortSource| self.given(source, &commands, row);
        let efforts: Vec<Option<[f64; 2]>> =
            self.efforts.iter().map(|source| source.as_ref().map(given)).collect();
        let slow: Vec<Option<f64>> = efforts.iter().map(|e| e.map(|[_, slow]| slow)).collect();
        let outside = self.outside.iter();
        let applied: Vec<(JointIndex, f64)> =
            outside.map(|(joint, source)| (*joint, given(source)[0])).collect();
        let Taken { efforts: taken, mut leaning, .. } =
            pose.taken(self.mechanism, t, &slow, &applied)?;
        let states = pose.states(self.mechanism);
        for (leaning, centred) in leaning.iter_mut().zip(&states) {
            *leaning = between(centred, leaning, self.basis.lean);
        }
        for (effort, taken) in efforts.iter().zip(taken) {
            if let Some([effort, _]) = effort {
                push(effort - taken);
            }
        }
        let turned = leaning.iter().zip(pose.angles());
        let angles: Vec<f64> =
            turned.map(|(state, near)| angle_near(state.rotation, *near)).collect();
        now.commands.copy_from_slice(&commands);
        let smooth = efforts.iter().map(|effort| effort.map_or(0.0, |[smooth, _]| smooth));
        self.driven(self.basis.joints.iter().copied().zip(smooth).chain(applied), now);
        self.fill(pose, &leaning, &angles, now);
        for (sensor, errors) in &self.others {
            let of = &self.mechanism.sensors[*sensor];
            let states = match of.reads {
                Reads::Acceleration(..) => &states,
                _ => &leaning,
            };
            let reading = of.reading(self.mechanism, states, &angles, now);
            push(self.view.shown(errors, self.view.plain(*sensor)?, row) - reading);
        }
        Some(())
    }

    /// What pushes joints, as their drives' encoders see it behind what gives way.
    fn driven(&self, efforts: impl Iterator<Item = (JointIndex, f64)>, now: &mut Evaluation) {
        for (joint, effort) in efforts {
            let own = self.mechanism.actuators.iter().position(|drive| drive.joint == joint);
            if let Some(drive) = own {
                now.drive_forces[drive] = effort;
            }
        }
    }

    /// What else sensors look at beside states and commands.
    fn fill(&self, pose: &Posed, leaning: &[BodyState], angles: &[f64], now: &mut Evaluation) {
        for (i, acceleration) in now.accelerations.iter_mut().enumerate() {
            *acceleration = pose.acceleration(self.mechanism, i);
        }
        for (length, joint) in now.lengths.iter_mut().zip(&self.mechanism.prismatics) {
            *length = joint.length(leaning);
        }
        for (i, drive) in self.mechanism.actuators.iter().enumerate() {
            now.coordinates[i] = match drive.joint {
                JointIndex::Prismatic(k) => now.lengths[k],
                JointIndex::Revolute(k) => {
                    let of = |body: Option<usize>| body.map_or(0.0, |body| angles[body]);
                    let [ring, journal] = self.mechanism.revolutes[k].bodies();
                    of(journal) - of(ring)
                }
            };
        }
    }
}

/// A share of the way from one state to another one near it; at the whole of it that one.
fn between(from: &BodyState, to: &BodyState, share: f64) -> BodyState {
    if share == 1.0 {
        return *to;
    }
    let mut state = *from;
    state.position += (to.position - from.position) * share;
    state.rotation *= (from.rotation.inverse() * to.rotation).powf(share);
    state
}
