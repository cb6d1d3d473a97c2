//! What measures a mechanism: what each sensor reads, in which column of a recording, and how exactly.

use super::{BodyState, Evaluation, JointIndex, Mark, Mechanism};
use nalgebra::Vector2;

/// What a sensor reads.
#[derive(Clone, Copy, Debug)]
pub enum Reads {
    /// The command of a drive, by its index, in m or rad (of a drive of effort in N or N·m).
    Command(usize),
    /// The coordinate of a joint, in m or rad: of a driven one through its drive's encoder.
    Position(JointIndex),
    /// The effort of a drive, by its index, in N or N·m.
    Effort(usize),
    /// World coordinate x of a point, m.
    X(Mark),
    /// World coordinate y of a point, m.
    Y(Mark),
    /// Angle of a body's written axes, rad: that of the body plus a constant.
    Angle(Option<usize>, f64),
    /// Acceleration of a point along a direction of the world, m/s², without gravity.
    Acceleration(Mark, Vector2<f64>),
}

/// A sensor. What it shows at time t is `scale · y(t − delay) + offset`, y being what it reads, through a
/// low-pass, with white noise, rounded.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Its column in recordings.
    pub column: String,
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
            Reads::Effort(drive) => of(mechanism.actuators[drive].joint, "N", "N·m"),
            Reads::X(_) | Reads::Y(_) => "m",
            Reads::Angle(..) => "rad",
            Reads::Acceleration(..) => "m/s²",
        }
    }

    /// What it reads at an instant, before its own errors; `angles` are those of the bodies with whole turns
    /// counted (rad).
    pub fn reading(
        &self,
        mechanism: &Mechanism,
        states: &[BodyState],
        angles: &[f64],
        now: &Evaluation,
    ) -> f64 {
        let place = |mark: Mark| mark.attachment(mechanism).frame(states).centre;
        match self.reads {
            Reads::Command(drive) => now.commands[drive].position,
            Reads::Position(joint) => {
                let driven = mechanism.actuators.iter().position(|drive| drive.joint == joint);
                match (driven, joint) {
                    (Some(drive), _) => mechanism.encoder(drive, now),
                    (None, JointIndex::Prismatic(i)) => now.lengths[i],
                    (None, JointIndex::Revolute(i)) => {
                        let [ring, journal] = mechanism.revolutes[i]
                            .bodies()
                            .map(|body| body.map_or(0.0, |body| angles[body]));
                        journal - ring
                    }
                }
            }
            Reads::Effort(drive) => now.drive_forces[drive],
            Reads::X(mark) => place(mark).x,
            Reads::Y(mark) => place(mark).y,
            Reads::Angle(body, angle) => body.map_or(0.0, |body| angles[body]) + angle,
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
