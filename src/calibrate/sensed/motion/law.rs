//! The effort that a servo makes of its command and of what its encoder shows.

use super::simulate::deviation;
use crate::calibrate::sensed::recorded::view::{View, position_sensor};
use crate::measure::filter::derivative;
use crate::mechanism::{Command, Drive, Mechanism, Sensor};

/// A servo with a recorded encoder.
#[derive(Debug)]
pub struct ServoLaw<'a> {
    view: &'a View,
    stiffness: f64,
    damping: f64,
    /// How late the encoder shows: what else it gets wrong its drive gets wrong, too.
    late: Sensor,
    /// Its reading.
    position: &'a [f64],
    /// Rate of that.
    rate: Vec<f64>,
    /// Noise of the effort in N or N·m: what the encoder's makes of it where damping does little.
    pub noise: f64,
}

impl<'a> ServoLaw<'a> {
    /// That of a drive, by one of the `series` of its encoder's samples; none of what is no servo or has no recorded encoder.
    pub fn of(
        view: &'a View,
        mechanism: &Mechanism,
        drive: usize,
        series: impl Fn(usize) -> Option<&'a [f64]>,
    ) -> Option<Self> {
        let actuator = &mechanism.actuators[drive];
        let Drive::Servo { stiffness, damping } = actuator.drive else { return None };
        let sensor = position_sensor(mechanism, actuator.joint)?;
        let position = series(sensor)?;
        let rate = derivative(position, view.interval);
        let shows = mechanism.sensors[sensor].clone();
        let late = Sensor { scale: 1.0, offset: 0.0, waves: Vec::new(), ..shows };
        let noise = stiffness * deviation(&late, position);
        Some(Self { view, stiffness, damping, late, position, rate, noise })
    }

    /// Effort in N or N·m at a row, told that.
    pub fn effort(&self, command: Command, row: usize) -> f64 {
        let [position, rate] =
            [self.position, &self.rate].map(|series| self.view.shown(&self.late, series, row));
        self.stiffness * (command.position - position) + self.damping * (command.rate - rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::motion::start::machine;
    use crate::calibrate::sensed::recorded::view::effort_sensor;
    use crate::calibrate::sensed::residuals::problem::RigProblem;

    /// What a slider-crank's drive gives is known by its encoder as by its torque sensor, to within the noise of both.
    #[test]
    fn an_effort_that_nobody_measured_is_what_the_servo_makes_of_its_encoder() {
        let problem = RigProblem::planar("planar-1");
        let recording = &problem.runs[0].recording;
        let mechanism = machine(&problem.rig, &[], recording).unwrap();
        let view = View::new(recording, mechanism.sensors.len());
        let law = ServoLaw::of(&view, &mechanism, 0, |sensor| view.smooth(sensor)).unwrap();
        let sensor = effort_sensor(&mechanism, 0).unwrap();
        let measured = view.smooth(sensor).unwrap();
        let noise = law.noise.hypot(deviation(&mechanism.sensors[sensor], measured));
        let mut commands = [Command::default()];
        let mut squares = [0.0; 2];
        for row in view.rows() {
            mechanism.commands.at(row as f64 * view.interval, &mut commands);
            squares[0] += (law.effort(commands[0], row) - measured[row]).powi(2);
            squares[1] += measured[row].powi(2);
        }
        let [off, size] = squares.map(|sum| (sum / view.rows().len() as f64).sqrt());
        assert!(off < noise && size > 5.0 * noise, "{off:e} of {size:e}, noise {noise:e} N·m");
    }
}
