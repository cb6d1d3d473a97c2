//! What measures a mechanism: what each sensor reads, in which column of a recording, and how exactly.

use super::{BodyState, Evaluation, JointIndex, Mark, Mechanism};
use nalgebra::{UnitComplex, Vector2};

/// What a sensor reads.
#[derive(Clone, Copy, Debug)]
pub enum Reads {
    /// The command of a drive, by its index, in m or rad (of a drive of effort in N or N·m).
    Command(usize),
    /// The coordinate of a joint, in m or rad: of a driven one through its drive's encoder.
    Position(JointIndex),
    /// The effort of a drive, by its index, in N or N·m.
    Effort(usize),
    /// What the sampled controller of a drive, by its index, asks of it at its samples, in N or N·m.
    Output(usize),
    /// What is added to the output of a drive's sampled controller, by the drive's index, in V.
    Added(usize),
    /// World coordinate x of a point, m.
    X(Mark),
    /// World coordinate y of a point, m.
    Y(Mark),
    /// Angle of a body's written axes, rad: that of the body plus a constant.
    Angle(Option<usize>, f64),
    /// Acceleration of a point along a direction of the world, m/s², without gravity.
    Acceleration(Mark, Vector2<f64>),
}

/// How the frame of a tracker lies in the world: it shows the point p at `shift + scale · R(rotation) p`, and
/// angles with the rotation added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerFrame {
    /// What it shows for the world's origin, in m.
    pub shift: Vector2<f64>,
    /// In rad.
    pub rotation: f64,
    /// What it multiplies lengths by.
    pub scale: f64,
}

impl TrackerFrame {
    fn of_point(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.shift + UnitComplex::new(self.rotation) * point * self.scale
    }
}

/// A sensor. What it shows at time t is `scale · y(t − delay) + offset`, through a low-pass, with white noise,
/// rounded; y is what [`reading`](Self::reading) says.
///
/// ```
/// use freeplay::mechanism::Reads;
/// use freeplay::model::{instrumented, parts_of};
/// use freeplay::scenario::Scenario;
///
/// // A 3-RPR with [sensors], column by column.
/// let sets = ["sensors.pose_std=4e-6", "sensors.force_std=0.15"].map(str::to_owned);
/// let mechanism = parts_of(&instrumented(&Scenario::load(None, &sets)?)?)?;
/// let force = mechanism.sensors.iter().find(|sensor| sensor.column == "F1").unwrap();
/// assert!(matches!(force.reads, Reads::Effort(0)));
/// assert_eq!((force.std, force.unit(&mechanism)), (0.15, "N"));
/// assert!(!force.tells(), "it measures, as commands do not");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Its column in recordings.
    pub column: String,
    /// What the numbers of that column are multiplied by to be in its unit.
    pub factor: f64,
    /// What it reads.
    pub reads: Reads,
    /// Standard deviation of its white noise, in its unit; 0 where it is exact.
    pub std: f64,
    /// Rounding step in its unit; 0 where it does not round.
    pub resolution: f64,
    /// Corner of its zero-phase second-order low-pass in Hz; 0 where there is none.
    pub lowpass: f64,
    /// How late it shows what was, in s.
    pub delay: f64,
    /// What it multiplies by.
    pub scale: f64,
    /// What it adds, in its unit.
    pub offset: f64,
    /// Waves in what it reads of a joint: amplitude (the joint's unit) and phase (rad) of
    /// `amplitude · sin(q + phase)`, as of an encoder's disk beside its axis. Errors of an encoder that a
    /// drive follows are not among them: the drive sees those, too ([`ReadingError`](super::ReadingError)).
    pub waves: Vec<[f64; 2]>,
    /// The frames, one in the other, in which it shows x, y or an angle.
    pub frames: Vec<TrackerFrame>,
}

impl Sensor {
    /// Its unit.
    pub fn unit(&self, mechanism: &Mechanism) -> &'static str {
        let of = |joint, linear, angular| match joint {
            JointIndex::Prismatic(_) => linear,
            JointIndex::Revolute(_) => angular,
        };
        match self.reads {
            Reads::Command(drive) => of(mechanism.actuators[drive].joint, "m", "rad"),
            Reads::Position(joint) => of(joint, "m", "rad"),
            Reads::Effort(drive) | Reads::Output(drive) => {
                of(mechanism.actuators[drive].joint, "N", "N·m")
            }
            Reads::Added(_) => "V",
            Reads::X(_) | Reads::Y(_) => "m",
            Reads::Angle(..) => "rad",
            Reads::Acceleration(..) => "m/s²",
        }
    }

    /// Whether it says what the machine is told, which is known and no measurement.
    pub fn tells(&self) -> bool {
        matches!(self.reads, Reads::Command(_) | Reads::Added(_))
    }

    /// Whether it is a tracker's: of x, y or an angle.
    pub fn tracks(&self) -> bool {
        matches!(self.reads, Reads::X(_) | Reads::Y(_) | Reads::Angle(..))
    }

    /// The point that it looks at, if it looks at one.
    pub(super) fn mark_mut(&mut self) -> Option<&mut Mark> {
        match &mut self.reads {
            Reads::X(mark) | Reads::Y(mark) | Reads::Acceleration(mark, _) => Some(mark),
            _ => None,
        }
    }

    /// What it reads at an instant, waves and frames included, before scale, delay and offset; `angles` are those of the bodies with whole turns
    /// counted (rad).
    pub fn reading(
        &self,
        mechanism: &Mechanism,
        states: &[BodyState],
        angles: &[f64],
        now: &Evaluation,
    ) -> f64 {
        let place = |mark: Mark| {
            let centre = mark.attachment(mechanism).frame(states).centre;
            self.frames.iter().fold(centre, |point, frame| frame.of_point(point))
        };
        let waves = |q: f64| {
            self.waves.iter().fold(q, |sum, [amplitude, phase]| sum + amplitude * (q + phase).sin())
        };
        match self.reads {
            Reads::Command(drive) => now.commands[drive].position,
            Reads::Position(joint) => {
                let driven = mechanism.actuators.iter().position(|drive| drive.joint == joint);
                match (driven, joint) {
                    (Some(drive), _) => waves(mechanism.encoder(drive, now)),
                    (None, JointIndex::Prismatic(i)) => waves(now.lengths[i]),
                    (None, JointIndex::Revolute(i)) => {
                        let [ring, journal] = mechanism.revolutes[i]
                            .bodies()
                            .map(|body| body.map_or(0.0, |body| angles[body]));
                        waves(journal - ring)
                    }
                }
            }
            // A controller's output is its drive's force but for the drive's lag.
            Reads::Effort(drive) | Reads::Output(drive) => now.drive_forces[drive],
            Reads::Added(_) => 0.0,
            Reads::X(mark) => place(mark).x,
            Reads::Y(mark) => place(mark).y,
            Reads::Angle(body, angle) => {
                let turned: f64 = self.frames.iter().map(|frame| frame.rotation).sum();
                body.map_or(0.0, |body| angles[body]) + angle + turned
            }
            Reads::Acceleration(mark, direction) => {
                let point = mark.attachment(mechanism);
                point.body.map_or(0.0, |body| {
                    let a = now.accelerations[body];
                    states[body].acceleration_at(a, point.point).xy().dot(&direction)
                })
            }
        }
    }
}
