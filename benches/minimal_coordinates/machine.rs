//! The machine: the parameters that can be chosen, and the fixed geometry and masses.

use std::f64::consts::{FRAC_PI_6, PI, TAU};

use super::trigonometry::sin_cos;

/// How the leg lengths are driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// `q_i(t)` follows the inverse kinematics exactly.
    Prescribed,
    /// `F_i = k_p (q_cmd − q) + k_d (q̇_cmd − q̇)`.
    Servo,
}

/// What can be chosen about a run. The default is the paper's machine.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Bearing radius less journal radius, in metres, the same in all six joints.
    pub clearance: f64,
    /// How the leg lengths are driven.
    pub drive: Drive,
    /// Gravity, in m/s².
    pub gravity: [f64; 2],
    /// Coefficient of Coulomb friction in the contacts.
    pub friction: f64,
    /// Angle of the platform's centre on its circle at t = 0.
    pub phase: f64,
    /// Damping of a contact deeper than `d_max`, in N·s/m.
    pub c_max: f64,
    /// Penetration at which the damping is fully there, in metres.
    pub d_max: f64,
}

impl Default for Machine {
    fn default() -> Self {
        Self {
            clearance: 5e-4,
            drive: Drive::Prescribed,
            gravity: [0.0; 2],
            friction: 0.0,
            phase: 0.0,
            c_max: 500.0,
            d_max: 1e-5,
        }
    }
}

pub const SERVO_STIFFNESS: f64 = 5e5;
pub const SERVO_DAMPING: f64 = 300.0;
pub const BEARING_RADIUS: f64 = 0.010;
pub const PLATFORM_MASS: f64 = 0.2;
pub const PLATFORM_INERTIA: f64 = PLATFORM_MASS * PLATFORM_SIDE * PLATFORM_SIDE / 12.0;
pub const PLATFORM_ANGLE: f64 = FRAC_PI_6;
/// The platform's angular rate on its circle: one turn a second.
pub const RATE: f64 = TAU;

const BASE_SIDE: f64 = 0.660;
const PLATFORM_SIDE: f64 = 0.100;
const PATH_RADIUS: f64 = 0.050;
const YOUNG: f64 = 73e9;
const POISSON: f64 = 0.3;

/// A round bar of the legs' material, 0.2 m long.
pub struct Bar {
    radius: f64,
}

pub const CYLINDER: Bar = Bar { radius: 0.010 };
pub const ROD: Bar = Bar { radius: 0.006 };

impl Bar {
    pub const LENGTH: f64 = 0.200;
    const DENSITY: f64 = 2270.0;

    pub const fn mass(&self) -> f64 {
        Self::DENSITY * PI * self.radius * self.radius * Self::LENGTH
    }

    /// Inertia about the centre of mass, `m L²/12 + m r²/4`.
    pub const fn inertia(&self) -> f64 {
        self.mass() * (Self::LENGTH * Self::LENGTH / 12.0 + self.radius * self.radius / 4.0)
    }
}

/// Vertex `i` of an equilateral triangle about the origin: side/√3 · \[cos, sin\](angle + 7π/6 + 2π/3 i).
fn corner(side: f64, angle: f64, i: usize) -> [f64; 2] {
    let direction = angle + 7.0 * FRAC_PI_6 + TAU / 3.0 * i as f64;
    let radius = side / 3f64.sqrt();
    [radius * direction.cos(), radius * direction.sin()]
}

/// Three points, x and y apart. The fourth lane is padding: it keeps vector registers full.
pub type Points = [[f64; 4]; 2];

/// A corner for each leg, and one for the padding lane too: nothing there may divide by zero.
fn corners(side: f64, angle: f64) -> Points {
    let corner: [[f64; 2]; 4] = std::array::from_fn(|i| corner(side, angle, i.min(2)));
    [corner.map(|p| p[0]), corner.map(|p| p[1])]
}

/// The inverse kinematics of the default circle: leg lengths and their rates.
pub struct Path {
    pub anchors: Points,
    /// The platform's corners in its own frame.
    pub corners: Points,
    /// Corner less anchor at the path's platform angle, the platform's centre at the origin.
    spans: Points,
    phase: f64,
}

/// Where the path's platform is: its centre's direction on the circle, and the leg lengths.
pub struct PathPoint {
    pub cos: f64,
    pub sin: f64,
    pub length: [f64; 4],
    pub rate: [f64; 4],
}

impl Path {
    pub fn new(phase: f64) -> Self {
        let anchors = corners(BASE_SIDE, 0.0);
        let at_angle = corners(PLATFORM_SIDE, PLATFORM_ANGLE);
        let spans =
            std::array::from_fn(|k| std::array::from_fn(|i| at_angle[k][i] - anchors[k][i]));
        Self { anchors, corners: corners(PLATFORM_SIDE, 0.0), spans, phase }
    }

    /// The angle of the centre on the circle.
    #[inline(always)]
    pub fn angle(&self, t: f64) -> f64 {
        RATE * t + self.phase
    }

    /// `w = C + r − A`, `q = |w|`, `q̇ = w·Ċ/q`; `cos` and `sin` are those of [`Path::angle`].
    #[inline(always)]
    pub fn at(&self, cos: f64, sin: f64) -> PathPoint {
        let (x, y) = (PATH_RADIUS * cos, PATH_RADIUS * sin);
        let (mut length, mut rate) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            let (wx, wy) = (self.spans[0][i] + x, self.spans[1][i] + y);
            length[i] = (wx * wx + wy * wy).sqrt();
            rate[i] = RATE * (wy * x - wx * y) / length[i];
        }
        PathPoint { cos, sin, length, rate }
    }

    /// `q̈ = (Ċ·Ċ + w·C̈ − q̇²)/q`; on a circle about the origin `C̈ = −Ω² C`.
    pub fn second_rate(&self, point: &PathPoint, i: usize) -> f64 {
        let (x, y) = (PATH_RADIUS * point.cos, PATH_RADIUS * point.sin);
        // Ċ·Ċ + w·C̈ = Ω² (C·C − w·C) = −Ω² (w − C)·C
        let along = self.spans[0][i] * x + self.spans[1][i] * y;
        -(RATE * RATE * along + point.rate[i] * point.rate[i]) / point.length[i]
    }

    /// Centre and velocity of the path's platform, and the four-quadrant angle of each leg with its rate.
    pub fn start(&self) -> Start {
        let ([sin], [cos]) = sin_cos(&[self.phase]);
        let point = self.at(cos, sin);
        let (x, y) = (PATH_RADIUS * cos, PATH_RADIUS * sin);
        let centre = [x, y];
        let velocity = [-RATE * y, RATE * x];
        let span = |i: usize| [self.spans[0][i] + x, self.spans[1][i] + y];
        let angle = std::array::from_fn(|i| span(i)[1].atan2(span(i)[0]));
        let spin = std::array::from_fn(|i| {
            let [wx, wy] = span(i);
            (wx * velocity[1] - wy * velocity[0]) / (point.length[i] * point.length[i])
        });
        Start { point, centre, velocity, angle, spin }
    }
}

/// The ideal pose and velocity at t = 0.
pub struct Start {
    pub point: PathPoint,
    pub centre: [f64; 2],
    pub velocity: [f64; 2],
    pub angle: [f64; 3],
    pub spin: [f64; 3],
}

/// Stiffness of the Hertz contact, `K = 4/(3π (h + h)) √(R_b R_j/(R_b + R_j))`, `h = (1 − ν²)/(π E)`.
pub fn contact_stiffness(bearing_radius: f64, journal_radius: f64) -> f64 {
    let h = (1.0 - POISSON * POISSON) / (PI * YOUNG);
    let radii = bearing_radius * journal_radius / (bearing_radius + journal_radius);
    4.0 / (3.0 * PI * (h + h)) * radii.sqrt()
}
