//! What a moving picture shows, as plain data: outlines that frames move, joints, signals.

use serde::Serialize;

/// A moving mechanism. [`Frame`](crate::measure::frames::FilmFrame)s go with it: their `values` are x, y
/// (m) and angle (rad) of each body in turn; then for each joint the journal's centre minus the
/// bearing's, x and y (m, world directions); then the tracked point minus where it should be, x and y
/// (m). Their `extremes` are first the contact force of each joint (N), then what `charts` names.
///
/// [`animation_svg`](crate::report::animation_svg) has an example.
#[derive(Debug, Clone, Serialize)]
pub struct Scene {
    /// Heading.
    pub title: String,
    /// What rests, in world coordinates.
    pub ground: Vec<Outline>,
    /// What moves.
    pub bodies: Vec<SceneBody>,
    /// The revolute joints.
    pub joints: Vec<SceneJoint>,
    /// Index of the body that carries the point which leaves a track.
    pub tracked: usize,
    /// That point in the body's axes, m.
    pub tracked_point: [f64; 2],
    /// Curves over time.
    pub charts: Vec<SceneChart>,
}

/// A body.
#[derive(Debug, Clone, Serialize)]
pub struct SceneBody {
    /// What it is called.
    pub name: String,
    /// Its outlines in its own axes.
    pub outlines: Vec<Outline>,
}

/// A polygon, or a line with round ends.
#[derive(Debug, Clone, Serialize)]
pub struct Outline {
    /// Corners [x, y] in m.
    pub points: Vec<[f64; 2]>,
    /// Whether it is a filled polygon.
    pub closed: bool,
    /// Thickness of the line in m.
    pub width_m: f64,
}

/// A revolute joint.
#[derive(Debug, Clone, Serialize)]
pub struct SceneJoint {
    /// What it is called.
    pub name: String,
    /// Index of the body that carries the bearing, `None` for the ground.
    pub body: Option<usize>,
    /// Centre of the bearing in that body's axes, m.
    pub point: [f64; 2],
    /// Inner radius of the bearing in m, or the radius to draw where it has none.
    pub radius_m: f64,
    /// Radial clearance in m, if it has any.
    pub clearance_m: Option<f64>,
}

/// Curves over time with one unit.
#[derive(Debug, Clone, Serialize)]
pub struct SceneChart {
    /// Heading.
    pub title: String,
    /// Unit of all curves.
    pub unit: String,
    /// The curves.
    pub curves: Vec<SceneCurve>,
}

/// A curve over time.
#[derive(Debug, Clone, Serialize)]
pub struct SceneCurve {
    /// What the legend calls it.
    pub name: String,
    /// Index into a frame's `extremes`.
    pub signal: usize,
    /// Drawn thin and dashed: what the ideal machine does.
    pub reference: bool,
}
