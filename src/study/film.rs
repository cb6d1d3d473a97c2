//! The moving pictures of a run: frames gathered row by row in constant memory, drawn at the end.

use crate::engine::Instant;
use crate::measure::frames::{FilmFrame, Frames};
use crate::mechanism::{Actuator, Attachment, Bearing, JointIndex, Mechanism};
use crate::model::Layout;
use crate::report::{
    Outline, Scene, SceneBody, SceneChart, SceneCurve, SceneJoint, animation_svg, player_html,
};
use crate::simulate::{IdealInstant, radial_clearance};
use nalgebra::Vector2;

/// Frames of the player: every row of 2 s at the default interval, in a page below 2 MB.
const PLAYER_FRAMES: usize = 4000;

/// How much of the start the animation shows, in s: the first flights and some ten hits a joint.
const ANIMATED: f64 = 0.15;

/// Frames of the animation: every row at the default interval.
const ANIMATION_FRAMES: usize = 400;

/// Radius at which a joint without clearance is drawn, in sizes of the mechanism.
const PIN_RADIUS: f64 = 0.012;

/// Thickness of the links as drawn, in sizes of the mechanism: a bar that carries a slide, a bar that
/// slides or turns, a plate's edge. Mechanisms say nothing about the shape of their bodies.
const CYLINDER: f64 = 0.03;
const ROD: f64 = 0.018;
const EDGE: f64 = 0.0045;

/// What the moving pictures show.
#[derive(Debug)]
pub(super) struct RunFilm {
    scene: Scene,
    player: Frames,
    animation: Frames,
}

impl RunFilm {
    /// Nothing gathered yet.
    pub fn new(name: &str, mechanism: &Mechanism, layout: &Layout) -> Self {
        Self {
            scene: scene(name, mechanism, layout),
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
        let deviation = mechanism.output_state(instant.states).position - ideal.position;
        put(&[deviation.x, deviation.y]);

        let forces = instant.tallies.iter().map(|tally| tally.peak);
        let drives = now.drive_forces.iter().chain(ideal.drive_forces).copied();
        let output =
            [instant.peaks.acceleration, ideal.acceleration.xy().norm(), 1e3 * deviation.norm()];
        let signals = forces.chain(drives).chain(output);
        let extremes = signals.map(|value| [value as f32; 2]).collect();
        let frame = FilmFrame { t: instant.t, values, extremes };
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

fn scene(name: &str, mechanism: &Mechanism, layout: &Layout) -> Scene {
    let size = mechanism.size();
    let joints = mechanism.revolutes.iter().map(|joint| SceneJoint {
        name: joint.name.clone(),
        body: joint.ring.body,
        point: joint.ring.point.into(),
        radius_m: match &joint.bearing {
            Bearing::Ideal => PIN_RADIUS * size,
            Bearing::Clearance(clearance) => clearance.bearing_radius,
            Bearing::Native { bearing_radius, .. } => *bearing_radius,
        },
        clearance_m: radial_clearance(&joint.bearing),
    });
    let bodies = mechanism.bodies.iter().enumerate().map(|(i, body)| SceneBody {
        name: body.name.clone(),
        outlines: vec![outline(mechanism, layout, Some(i))],
    });
    Scene {
        title: format!("Run: {name}"),
        ground: vec![outline(mechanism, layout, None)],
        bodies: bodies.collect(),
        joints: joints.collect(),
        tracked: mechanism.output,
        tracked_point: mechanism.bodies[mechanism.output].reference.into(),
        charts: charts(mechanism),
    }
}

/// A body as its joints and named points show it: a polygon around three of them or more, a bar between
/// two or along a line, and a bar on both sides of the centre of mass where all are at one end.
fn outline(mechanism: &Mechanism, layout: &Layout, body: Option<usize>) -> Outline {
    let mut points: Vec<Vector2<f64>> = Vec::new();
    let mut add = |attachment: &Attachment| {
        let near = |other: &Vector2<f64>| (other - attachment.point).norm() < 1e-9;
        if attachment.body == body && !points.iter().any(near) {
            points.push(attachment.point);
        }
        attachment.body == body
    };
    for joint in &mechanism.revolutes {
        add(&joint.ring);
        add(&joint.journal);
    }
    let mut width = EDGE;
    for joint in &mechanism.prismatics {
        if add(&joint.slider) {
            width = ROD;
        }
        if add(&joint.base) {
            width = CYLINDER;
        }
    }
    for mark in layout.marks.iter().filter(|mark| mark.body == body && body.is_some()) {
        add(&mark.attachment(mechanism));
    }
    if let (&[only], Some(_)) = (&points[..], body) {
        points.push(-only);
    }
    let points = around(points);
    let closed = points.len() > 2;
    if !closed && width == EDGE {
        width = ROD;
    }
    let points = points.into_iter().map(Into::into).collect();
    Outline { closed, points, width_m: width * mechanism.size() }
}

/// Points in order around their middle; the two ends of points that lie on a line.
fn around(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    let middle = points.iter().sum::<Vector2<f64>>() / points.len().max(1) as f64;
    let far = |p: &Vector2<f64>| (p - middle).norm();
    let Some(end) = points.iter().copied().max_by(|a, b| far(a).total_cmp(&far(b))) else {
        return points;
    };
    let along = end - middle;
    let flat = |p: &Vector2<f64>| (p - middle).perp(&along).abs() < 1e-6 * along.norm_squared();
    if points.len() > 2 && points.iter().all(flat) {
        let place = |p: &Vector2<f64>| (p - middle).dot(&along);
        points.sort_by(|a, b| place(a).total_cmp(&place(b)));
        return vec![points[0], points[points.len() - 1]];
    }
    let direction = |p: &Vector2<f64>| (p.y - middle.y).atan2(p.x - middle.x);
    points.sort_by(|a, b| direction(a).total_cmp(&direction(b)));
    points
}

/// The curves: forces in the joints, forces and torques of the drives and what the ideal machine's take,
/// acceleration of the output and of the ideal machine's, path error.
fn charts(mechanism: &Mechanism) -> Vec<SceneChart> {
    let (joints, drives) = (mechanism.revolutes.len(), mechanism.actuators.len());
    let curve = |name: &str, signal: usize, reference: bool| SceneCurve {
        name: name.to_owned(),
        signal,
        reference,
    };
    let contacts = mechanism.revolutes.iter().enumerate();
    let contacts = contacts.filter(|(_, joint)| radial_clearance(&joint.bearing).is_some());
    let efforts = |of_revolutes: bool| {
        let of = move |actuator: &Actuator| {
            matches!(actuator.joint, JointIndex::Revolute(_)) == of_revolutes
        };
        let drives_of = mechanism.actuators.iter().enumerate().filter(move |(_, a)| of(a));
        let curves = drives_of.flat_map(|(i, drive)| {
            let ideal = format!("{}, ideal", drive.name);
            [curve(&drive.name, joints + i, false), curve(&ideal, joints + drives + i, true)]
        });
        curves.collect::<Vec<_>>()
    };
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
        chart("Actuator forces", "N", efforts(false)),
        chart("Actuator torques", "N m", efforts(true)),
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
