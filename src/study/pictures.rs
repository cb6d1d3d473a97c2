//! The pictures of a run: signals gathered row by row in constant memory, drawn at the end.

use super::recent::Recent;
use crate::engine::{Instant, Schedule};
use crate::measure::envelope::Envelope;
use crate::mechanism::{JointIndex, Mechanism};
use crate::report::{
    Curve, Orbit, Panel, Picture, ReportError, Style, length, number, orbits_svg, panels_svg,
    path_svg,
};
use crate::simulate::{IdealInstant, radial_clearance};

/// Stretches that a signal is kept in: about one per pixel of a picture's width.
const STRETCHES: usize = 800;

/// Rows that a path is kept of, at its end: ten turns of the default circle.
const PATH_ROWS: usize = 20_000;

/// Points of a path that are drawn: enough for a smooth curve of several turns.
const PATH_POINTS: usize = 4000;

/// Rows that an orbit is kept of, at its end, and drawn: more would hide each other.
const ORBIT_ROWS: usize = 4000;

/// What the pictures show.
#[derive(Debug)]
pub(super) struct Gallery {
    /// Name of the output body.
    body: String,
    interval: f64,
    path: Recent,
    ideal_path: Recent,
    path_error: Envelope,
    /// a_x, a_y, α of the output body.
    accelerations: [Envelope; 3],
    /// |(a_x, a_y)|, peak since the row before.
    peak_acceleration: Envelope,
    /// Of the row; what a machine without clearance does has no peaks between rows.
    ideal_acceleration: Envelope,
    ideal_accelerations: [Envelope; 3],
    drives: Vec<DriveCurves>,
    joints: Vec<JointCurves>,
}

#[derive(Debug)]
struct DriveCurves {
    name: String,
    /// Title of the panel and label of its axis.
    title: String,
    label: &'static str,
    force: Envelope,
    ideal: Envelope,
}

#[derive(Debug)]
struct JointCurves {
    name: String,
    clearance: Option<f64>,
    /// Peak since the row before.
    force: Envelope,
    orbit: Recent,
}

impl Gallery {
    /// Nothing gathered yet.
    pub fn new(mechanism: &Mechanism, schedule: Schedule) -> Self {
        let envelope = || Envelope::new(STRETCHES);
        let path = || Recent::new(PATH_ROWS);
        let drives = mechanism.actuators.iter().map(|joint| DriveCurves {
            name: joint.name.clone(),
            title: format!("Actuator {}", joint.name),
            label: match joint.joint {
                JointIndex::Revolute(_) => TORQUE,
                JointIndex::Prismatic(_) => "force (N)",
            },
            force: envelope(),
            ideal: envelope(),
        });
        let joints = mechanism.revolutes.iter().map(|joint| JointCurves {
            name: joint.name.clone(),
            clearance: radial_clearance(&joint.bearing),
            force: envelope(),
            orbit: Recent::new(ORBIT_ROWS),
        });
        Self {
            body: mechanism.bodies[mechanism.output].name.clone(),
            interval: schedule.interval,
            path: path(),
            ideal_path: path(),
            path_error: envelope(),
            accelerations: [(); 3].map(|()| envelope()),
            peak_acceleration: envelope(),
            ideal_acceleration: envelope(),
            ideal_accelerations: [(); 3].map(|()| envelope()),
            drives: drives.collect(),
            joints: joints.collect(),
        }
    }

    /// Takes the next row.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant, ideal: &IdealInstant) {
        let t = instant.t;
        let now = instant.evaluation;
        let position = mechanism.output_state(instant.states).position;
        self.path.push(position.into());
        self.ideal_path.push(ideal.position.into());
        self.path_error.push(t, 1e3 * (position - ideal.position).norm());
        let acceleration = mechanism.output_acceleration(instant.states, &now.accelerations);
        for (k, (envelope, ideal_envelope)) in
            self.accelerations.iter_mut().zip(&mut self.ideal_accelerations).enumerate()
        {
            envelope.push(t, acceleration[k]);
            ideal_envelope.push(t, ideal.acceleration[k]);
        }
        self.peak_acceleration.push(t, instant.peaks.acceleration);
        self.ideal_acceleration.push(t, ideal.acceleration.xy().norm());
        for (i, drive) in self.drives.iter_mut().enumerate() {
            drive.force.push(t, now.drive_forces[i]);
            drive.ideal.push(t, ideal.drive_forces[i]);
        }
        for (i, joint) in self.joints.iter_mut().enumerate() {
            joint.force.push(t, instant.tallies[i].peak);
            joint.orbit.push(now.contacts[i].eccentricity.into());
        }
    }

    /// The pictures, in the order of the page.
    pub fn draw(&self) -> Result<Vec<Picture>, ReportError> {
        let plays = self.joints.iter().any(|joint| joint.clearance.is_some());
        let mut pictures = vec![self.path()?];
        // A machine without play follows its ideal path to rounding, and its journals stay where they are.
        if plays || largest(&self.path_error.points()) > SEEN {
            pictures.push(self.path_error()?);
        }
        pictures.push(self.acceleration()?);
        if !self.drives.is_empty() {
            pictures.push(self.actuator_forces()?);
        }
        if self.joints.iter().any(|joint| largest(&joint.force.points()) > 0.0) {
            pictures.push(self.joint_forces()?);
        }
        if plays {
            pictures.push(self.orbits()?);
        }
        Ok(pictures)
    }

    fn path(&self) -> Result<Picture, ReportError> {
        let curves = [
            Curve { name: self.body.clone(), points: pairs(&self.path), style: Style::Solid },
            ideal(pairs(&self.ideal_path)),
        ];
        Ok(Picture {
            file: "path.svg".into(),
            title: format!("Path of the {}", self.body),
            caption: format!(
                "Where the {}'s centre went (blue), and where the ideal machine's would have gone \
                 (dashed). Both axes have the same scale; what clearance does to the path is often too \
                 small to see here and stands in the next figure.",
                self.body
            ) + &self.only_the_end(&self.path, PATH_ROWS),
            svg: path_svg(&format!("Path of the {}'s centre", self.body), &curves)?,
        })
    }

    /// Says so where a picture does not show the whole run.
    fn only_the_end(&self, curve: &Recent, rows: usize) -> String {
        if !curve.truncated {
            return String::new();
        }
        format!(" Shown are the last {} s.", number(self.interval * rows as f64))
    }

    fn path_error(&self) -> Result<Picture, ReportError> {
        let panel = Panel {
            title: format!("Distance of the {} from its ideal position", self.body),
            x_label: TIME.into(),
            y_label: "distance (mm)".into(),
            curves: vec![solid("distance", &self.path_error)],
        };
        Ok(Picture {
            file: "path-error.svg".into(),
            title: "Path error".into(),
            caption: format!(
                "How far the {}'s centre is from where the ideal machine's would be at the same time. \
                 Free play lets it lag, lead and wander, within what the clearances of all joints \
                 together leave it.",
                self.body
            ),
            svg: panels_svg(&[panel])?,
        })
    }

    fn acceleration(&self) -> Result<Picture, ReportError> {
        let titles = [
            ("Acceleration along x", "a_x (m/s²)"),
            ("Acceleration along y", "a_y (m/s²)"),
            ("Angular acceleration", "alpha (rad/s²)"),
        ];
        let mut panels: Vec<Panel> = titles
            .iter()
            .zip(self.accelerations.iter().zip(&self.ideal_accelerations))
            .map(|((title, label), (envelope, ideal_envelope))| Panel {
                title: (*title).into(),
                x_label: TIME.into(),
                y_label: (*label).into(),
                curves: vec![solid(&self.body, envelope), ideal(ideal_envelope.points())],
            })
            .collect();
        panels.push(Panel {
            title: "Peaks: largest |(a_x, a_y)| since the row before".into(),
            x_label: TIME.into(),
            y_label: "|a| (m/s²)".into(),
            curves: vec![
                solid(&self.body, &self.peak_acceleration),
                ideal(self.ideal_acceleration.points()),
            ],
        });
        Ok(Picture {
            file: "acceleration.svg".into(),
            title: format!("Acceleration of the {}", self.body),
            caption: format!(
                "Acceleration of the {}'s centre and angle, and of the ideal machine \
                 (dashed). A spike is a journal that hits its bearing. The first three curves are sampled every {} ms, longer than many \
                 hits, and miss the tips of spikes; the last one misses none.",
                self.body,
                number(1e3 * self.interval)
            ),
            svg: panels_svg(&panels)?,
        })
    }

    fn actuator_forces(&self) -> Result<Picture, ReportError> {
        let panels: Vec<Panel> = self
            .drives
            .iter()
            .map(|drive| Panel {
                title: drive.title.clone(),
                x_label: TIME.into(),
                y_label: drive.label.into(),
                curves: vec![solid(&drive.name, &drive.force), ideal(drive.ideal.points())],
            })
            .collect();
        let turning = self.drives.iter().filter(|drive| drive.label == TORQUE).count();
        let (title, what) = match self.drives.len() - turning {
            0 => (
                "Actuator torques",
                "Torque of each actuator on its joint, counterclockwise positive",
            ),
            sliding if sliding == self.drives.len() => (
                "Actuator forces",
                "Force of each actuator on its rod, positive when it pushes outward",
            ),
            _ => (
                "Actuator forces and torques",
                "Force of each actuator that slides, positive when it pushes outward, and torque of each that turns, \
                 counterclockwise positive",
            ),
        };
        Ok(Picture {
            file: "actuator-forces.svg".into(),
            title: title.into(),
            caption: format!(
                "{what}, and what the ideal machine needs for the same motion (dashed). The hits in the joints \
                      pass straight through to the actuators."
            ),
            svg: panels_svg(&panels)?,
        })
    }

    fn joint_forces(&self) -> Result<Picture, ReportError> {
        let panels: Vec<Panel> = self
            .joints
            .iter()
            .map(|joint| Panel {
                title: format!("Joint {}", joint.name),
                x_label: TIME.into(),
                y_label: "peak force (N)".into(),
                curves: vec![solid(&joint.name, &joint.force)],
            })
            .collect();
        Ok(Picture {
            file: "joint-forces.svg".into(),
            title: "Contact forces in the joints".into(),
            caption:
                "Largest normal force between journal and bearing since the row before, joint \
                      by joint. Where a curve lies on zero the journal flies freely."
                    .into(),
            svg: panels_svg(&panels)?,
        })
    }

    fn orbits(&self) -> Result<Picture, ReportError> {
        let orbits: Vec<Orbit> = self
            .joints
            .iter()
            .filter(|joint| joint.clearance.is_some())
            .map(|joint| Orbit {
                joint: joint.name.clone(),
                clearance_m: joint.clearance.unwrap_or(0.0),
                points: joint.orbit.points(ORBIT_ROWS),
            })
            .collect();
        let clearances = self.joints.iter().filter_map(|joint| joint.clearance);
        let part = self.joints.first().map(|joint| self.only_the_end(&joint.orbit, ORBIT_ROWS));
        let largest = clearances.fold(0.0, f64::max);
        let caption = format!(
            "Where the centre of each journal went inside its bearing, seen from the bearing's \
                 centre. The circle is the clearance (up to {}): a journal on it touches, one \
                 inside flies. The orange dot is the last position.{}",
            length(largest),
            part.unwrap_or_default()
        );
        Ok(Picture {
            file: "orbits.svg".into(),
            title: "Orbits of the journals".into(),
            caption,
            svg: orbits_svg(&orbits)?,
        })
    }
}

/// Path error in mm that is more than rounding and the integrator's own: a nanometre.
const SEEN: f64 = 1e-6;

/// The largest value of a curve.
fn largest(points: &[(f64, f64)]) -> f64 {
    points.iter().fold(0.0, |most, (_, value)| most.max(value.abs()))
}

const TIME: &str = "time (s)";

/// Label of an axis of torques.
const TORQUE: &str = "torque (N m)";

fn solid(name: &str, envelope: &Envelope) -> Curve {
    Curve { name: name.to_owned(), points: envelope.points(), style: Style::Solid }
}

fn ideal(points: Vec<(f64, f64)>) -> Curve {
    Curve { name: "ideal machine".to_owned(), points, style: Style::Reference }
}

fn pairs(path: &Recent) -> Vec<(f64, f64)> {
    path.points(PATH_POINTS).iter().map(|p| (p[0], p[1])).collect()
}
