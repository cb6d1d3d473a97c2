//! Rigid bodies, their states, and points on them.

use crate::contact::Frame;
use nalgebra::{UnitComplex, Vector2, Vector3};

/// Where a body is and how it moves: position and velocity of its centre of mass.
///
/// ```
/// use freeplay::mechanism::BodyState;
/// use nalgebra::{Vector2, Vector3};
///
/// let state = BodyState { twist: Vector3::new(0.0, 0.0, 2.0), ..BodyState::ground() };
/// assert_eq!(state.at(Vector2::new(0.5, 0.0)).twist.y, 1.0, "a rim of 0.5 m at 2 rad/s");
/// let fallen = state.moved(Vector3::new(0.0, -9.81, 0.0), Vector3::zeros(), 1.0);
/// assert!((fallen.position.y + 9.81 / 2.0).abs() < 1e-12 && (fallen.rotation.angle() - 2.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass in m.
    pub position: Vector2<f64>,
    /// Rotation of the body's own axes against the world's.
    pub rotation: UnitComplex<f64>,
    /// Velocity (m/s, m/s) and angular velocity (rad/s).
    pub twist: Vector3<f64>,
}

impl BodyState {
    /// The ground: at the origin, at rest.
    pub fn ground() -> Self {
        Self {
            position: Vector2::zeros(),
            rotation: UnitComplex::identity(),
            twist: Vector3::zeros(),
        }
    }

    /// The state `tau` s away on the path `x + vτ + aτ²/2 + jτ³/6`, with acceleration `a` and jerk
    /// `j` (linear m/s², m/s³; angular rad/s², rad/s³).
    pub fn moved(&self, a: Vector3<f64>, j: Vector3<f64>, tau: f64) -> Self {
        let shift = (self.twist + (a / 2.0 + j * (tau / 6.0)) * tau) * tau;
        Self {
            position: self.position + shift.xy(),
            rotation: self.rotation * turn(shift.z),
            twist: self.twist + (a + j * (tau / 2.0)) * tau,
        }
    }

    /// The same body shifted (m, m) and turned (rad), with the same twist.
    #[inline]
    pub fn displaced(&self, by: Vector3<f64>) -> Self {
        let rotation = self.rotation * turn(by.z);
        Self { position: self.position + by.xy(), rotation, twist: self.twist }
    }

    /// The state of a point of the body, given in the body's own axes from its centre of mass (m).
    pub fn at(&self, local: Vector2<f64>) -> Self {
        let frame = self.frame(local);
        let twist = Vector3::new(frame.velocity.x, frame.velocity.y, frame.spin);
        Self { position: frame.centre, twist, ..*self }
    }

    /// Acceleration of that point, `a + α × r − ω² r`, and α (m/s², m/s², rad/s²), from that of the body.
    pub fn acceleration_at(&self, a: Vector3<f64>, local: Vector2<f64>) -> Vector3<f64> {
        let r = self.rotation * local;
        let omega2 = self.twist.z * self.twist.z;
        Vector3::new(a.x - a.z * r.y - omega2 * r.x, a.y + a.z * r.x - omega2 * r.y, a.z)
    }

    /// Position, arm and velocity of a point given in the body's own axes (m, from its centre of
    /// mass).
    #[inline]
    pub fn frame(&self, local: Vector2<f64>) -> Frame {
        let arm = self.rotation * local;
        let spin = self.twist.z;
        Frame {
            centre: self.position + arm,
            arm,
            velocity: self.twist.xy() + Vector2::new(-arm.y, arm.x) * spin,
            spin,
        }
    }
}

/// The rotation by `angle` rad. Steps turn bodies by far less than 0.01 rad, where seven terms of
/// the series are exact to the last digit and cost a fifth of a sine and a cosine.
#[inline]
pub fn turn(angle: f64) -> UnitComplex<f64> {
    if angle.abs() > 0.01 {
        return UnitComplex::new(angle);
    }
    let s = angle * angle;
    let cos = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0));
    let sin = angle * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)));
    UnitComplex::from_cos_sin_unchecked(cos, sin)
}

/// A rigid body and its state at the start.
///
/// [`Revolute`](crate::mechanism::Revolute) has an example.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name for messages and tables.
    pub name: String,
    /// Mass in kg.
    pub mass: f64,
    /// Moment of inertia about the centre of mass in kg·m².
    pub inertia: f64,
    /// State at t = 0.
    pub start: BodyState,
    /// Angle at t = 0 in rad, whole turns included: angles of joints count from it.
    pub angle: f64,
    /// The point in the body's own axes, from its centre of mass (m), whose motion is the body's where
    /// it is an output: where the centre of mass was before anything was put on it.
    pub reference: Vector2<f64>,
}

impl Body {
    /// A body whose output is its centre of mass; mass in kg, inertia about that centre in kg·m².
    pub fn new(name: &str, mass: f64, inertia: f64, start: BodyState) -> Self {
        let angle = start.rotation.angle();
        Self { name: name.to_owned(), mass, inertia, start, angle, reference: Vector2::zeros() }
    }
}

/// A point of a body, or of the ground.
///
/// [`Revolute`](crate::mechanism::Revolute) has an example.
#[derive(Clone, Copy, Debug)]
pub struct Attachment {
    /// Index of the body, or `None` for the ground.
    pub body: Option<usize>,
    /// The point in the body's own axes, from its centre of mass (ground: world coordinates), m.
    pub point: Vector2<f64>,
}

impl Attachment {
    /// Rotation of the body that carries the point.
    pub fn rotation(&self, states: &[BodyState]) -> UnitComplex<f64> {
        self.body.map_or(UnitComplex::identity(), |i| states[i].rotation)
    }

    /// Angular velocity in rad/s of the body that carries the point.
    pub fn spin(&self, states: &[BodyState]) -> f64 {
        self.body.map_or(0.0, |i| states[i].twist.z)
    }

    /// Where the point is, given the states of all bodies.
    #[inline]
    pub fn centre(&self, states: &[BodyState]) -> Vector2<f64> {
        self.body.map_or(self.point, |i| states[i].position + states[i].rotation * self.point)
    }

    /// Where the point is and how it moves, given the states of all bodies.
    #[inline]
    pub fn frame(&self, states: &[BodyState]) -> Frame {
        match self.body {
            Some(i) => states[i].frame(self.point),
            None => {
                Frame { centre: self.point, arm: self.point, velocity: Vector2::zeros(), spin: 0.0 }
            }
        }
    }
}
