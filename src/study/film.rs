//! The moving pictures of a run: frames gathered row by row in constant memory, drawn at the end.

use crate::engine::Instant;
use crate::measure::frames::{Frame, Frames};
use crate::mechanism::{Attachment, Bearing, Mechanism};
use crate::report::{
    Outline, Scene, SceneBody, SceneChart, SceneCurve, SceneJoint, animation_svg, player_html,
};
use crate::simulate::{IdealInstant, radial_clearance};

/// Frames of the player: every row of 2 s at the default interval, in a page below 2 MB.
const PLAYER_FRAMES: usize = 4000;

/// How much of the start the animation shows, in s: the first flights and some ten hits a joint.
const ANIMATED: f64 = 0.15;

/// Frames of the animation: every row at the default interval.
const ANIMATION_FRAMES: usize = 400;

/// Radius in m at which a joint without clearance is drawn.
const PIN_RADIUS: f64 = 0.008;

/// Thickness in m of the links as drawn: a bar that carries a slide, a bar that slides, a plate's
/// edge. Mechanisms say nothing about the shape of their bodies.
const CYLINDER: f64 = 0.02;
const ROD: f64 = 0.012;
const EDGE: f64 = 0.003;

/// What the moving pictures show.
#[derive(Debug)]
pub(super) struct Film {
    scene: Scene,
    player: Frames,
    animation: Frames,
}

impl Film {
    /// Nothing gathered yet.
    pub fn new(name: &str, mechanism: &Mechanism) -> Self {
        Self {
            scene: scene(name, mechanism),
            player: Frames::new(PLAYER_FRAMES),
            animation: Frames::new(ANIMATION_FRAMES),
        }
    }

    /// Takes the next row. The order of the numbers is that of [`Scene`] and of `charts`.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant, ideal: &IdealInstant) {
        let now = instant.evaluation;
        let mut values = Vec::with_capacity(3 * instant.states.len() + 2 * now.contacts.len() + 2);
        let mut put = |numbers: &[f64]| values.extend(numbers.iter().map(|number| *number as f32));
        for state in instant.states {
            put(&[state.position.x, state.position.y, state.rotation.angle()]);
        }
        for contact in &now.contacts {
            put(&[contact.eccentricity.x, contact.eccentricity.y]);
        }
        let deviation = instant.states[mechanism.output].position - ideal.position;
        put(&[deviation.x, deviation.y]);

        let forces = instant.tallies.iter().map(|tally| tally.peak);
        let drives = now.drive_forces.iter().chain(ideal.drive_forces).copied();
        let output =
            [instant.peaks.acceleration, ideal.acceleration.xy().norm(), 1e3 * deviation.norm()];
        let signals = forces.chain(drives).chain(output);
        let extremes = signals.map(|value| [value as f32; 2]).collect();
        let frame = Frame { t: instant.t, values, extremes };
        if instant.t <= ANIMATED {
            self.animation.push(frame.clone());
        }
        self.player.push(frame);
    }

    /// The page that plays the run.
    pub fn player(&self) -> String {
        player_html(&self.scene, &self.player)
    }

    /// The start of the run as a picture that moves.
    pub fn animation(&self) -> String {
        animation_svg(&self.scene, &self.animation)
    }
}

fn scene(name: &str, mechanism: &Mechanism) -> Scene {
    let joints = mechanism.revolutes.iter().map(|joint| SceneJoint {
        name: joint.name.clone(),
        body: joint.ring.body,
        point: joint.ring.point.into(),
        radius_m: match &joint.bearing {
            Bearing::Ideal => PIN_RADIUS,
            Bearing::Clearance(clearance) => clearance.bearing_radius,
            Bearing::Native { bearing_radius, .. } => *bearing_radius,
        },
        clearance_m: radial_clearance(&joint.bearing),
    });
    let bodies = mechanism.bodies.iter().enumerate().map(|(i, body)| SceneBody {
        name: body.name.clone(),
        outlines: vec![outline(mechanism, Some(i))],
    });
    Scene {
        title: format!("Run: {name}"),
        ground: vec![outline(mechanism, None)],
        bodies: bodies.collect(),
        joints: joints.collect(),
        tracked: mechanism.output,
        charts: charts(mechanism),
    }
}

/// A body as its joints show it: a polygon through three of them or more, a bar between two, and a
/// bar on both sides of the centre of mass where all joints are at one end.
fn outline(mechanism: &Mechanism, body: Option<usize>) -> Outline {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut width_m = EDGE;
    let mut add = |attachment: &Attachment| {
        let point: [f64; 2] = attachment.point.into();
        let near = |other: &[f64; 2]| (other[0] - point[0]).hypot(other[1] - point[1]) < 1e-9;
        if attachment.body == body && !points.iter().any(near) {
            points.push(point);
        }
        attachment.body == body
    };
    for joint in &mechanism.revolutes {
        add(&joint.ring);
        add(&joint.journal);
    }
    for joint in &mechanism.prismatics {
        if add(&joint.slider) {
            width_m = ROD;
        }
        if add(&joint.base) {
            width_m = CYLINDER;
        }
    }
    if let (&[[x, y]], Some(_)) = (&points[..], body) {
        points.push([-x, -y]);
    }
    if points.len() == 2 && width_m == EDGE {
        width_m = ROD;
    }
    Outline { closed: points.len() > 2, points, width_m }
}

/// The curves: forces in the joints, of the drives and what the ideal machine's take, acceleration
/// of the output and of the ideal machine's, path error.
fn charts(mechanism: &Mechanism) -> Vec<SceneChart> {
    let (joints, drives) = (mechanism.revolutes.len(), mechanism.actuators.len());
    let curve = |name: &str, signal: usize, reference: bool| SceneCurve {
        name: name.to_owned(),
        signal,
        reference,
    };
    let contacts = mechanism.revolutes.iter().enumerate();
    let contacts = contacts.filter(|(_, joint)| radial_clearance(&joint.bearing).is_some());
    let actuators = mechanism.actuators.iter().enumerate().flat_map(|(i, drive)| {
        let ideal = format!("{}, ideal", drive.name);
        [curve(&drive.name, joints + i, false), curve(&ideal, joints + drives + i, true)]
    });
    let output = joints + 2 * drives;
    let body = &mechanism.bodies[mechanism.output].name;
    let chart = |title: &str, unit: &str, curves: Vec<SceneCurve>| SceneChart {
        title: title.into(),
        unit: unit.into(),
        curves,
    };
    let mut charts = vec![
        chart(
            "Contact forces, peaks",
            "N",
            contacts.map(|(i, joint)| curve(&joint.name, i, false)).collect(),
        ),
        chart("Actuator forces", "N", actuators.collect()),
        chart(
            &format!("Acceleration of the {body}, peaks"),
            "m/s²",
            vec![curve(body, output, false), curve("ideal", output + 1, true)],
        ),
        chart("Path error", "mm", vec![curve(body, output + 2, false)]),
    ];
    charts.retain(|chart| !chart.curves.is_empty());
    charts
}
