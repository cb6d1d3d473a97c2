//! From the coordinates to the joints: where every journal is in its bearing, and how it moves.
//!
//! Coordinates are stored as lanes \[leg 1, leg 2, leg 3, platform\] of x, y and angle, then (servo)
//! the three lengths and a padding zero: 12 or 16 numbers. A leg's x and y are those of the common centre
//! of mass G of its two bars, cylinder (m₁, ℓ long) and rod (m₂, ℓ long), u = \[cos θ, sin θ\],
//! n = \[−sin θ, cos θ\]:
//!
//!     P = G − s u,   Q = G + (q − s) u,   s = (m₁ ℓ/2 + m₂ (q − ℓ/2))/m,   ṡ = (m₂/m) q̇
//!
//! P is the journal's centre in A_i, Q the one in C_i.

use super::contact::Meeting;
use super::machine::{Bar, CYLINDER, PLATFORM_ANGLE, Path, PathPoint, ROD};
use super::trigonometry::sin_cos;

/// Coordinates of the prescribed drive.
pub const PRESCRIBED: usize = 12;
/// Coordinates of the servo drive.
pub const SERVO: usize = 16;

pub const Y: usize = 4;
pub const ANGLE: usize = 8;
pub const LENGTH: usize = 12;
/// The platform's lane.
pub const PLATFORM: usize = 3;

/// `s = ARM + ARM_RATE · q`.
const ARM: f64 =
    0.5 * Bar::LENGTH * (CYLINDER.mass() - ROD.mass()) / (CYLINDER.mass() + ROD.mass());
const ARM_RATE: f64 = ROD.mass() / (CYLINDER.mass() + ROD.mass());

/// Everything that follows from the coordinates alone, and the leg lengths' rates.
pub struct Pose {
    pub point: PathPoint,
    pub length: [f64; 4],
    pub rate: [f64; 4],
    pub cos: [f64; 4],
    pub sin: [f64; 4],
    /// From the pivot P to the centre of mass.
    pub arm: [f64; 4],
    /// Platform corners from its centre.
    pub corner: [[f64; 4]; 2],
    /// Journal less bearing centre in A1 A2 A3 and C1 C2 C3.
    pub base: [[f64; 4]; 2],
    pub top: [[f64; 4]; 2],
}

/// The ideal pose and velocity at t = 0: every journal centred.
pub fn start<const N: usize>(path: &Path) -> ([f64; N], [f64; N]) {
    let start = path.start();
    let (mut q, mut v) = ([0.0; N], [0.0; N]);
    for i in 0..3 {
        let (length, rate) = (start.point.length[i], start.point.rate[i]);
        let (sin, cos) = start.angle[i].sin_cos();
        let (arm, arm_rate) = (ARM + ARM_RATE * length, ARM_RATE * rate);
        q[i] = path.anchors[0][i] + arm * cos;
        q[Y + i] = path.anchors[1][i] + arm * sin;
        q[ANGLE + i] = start.angle[i];
        v[i] = arm_rate * cos - arm * start.spin[i] * sin;
        v[Y + i] = arm_rate * sin + arm * start.spin[i] * cos;
        v[ANGLE + i] = start.spin[i];
        if N == SERVO {
            q[LENGTH + i] = length;
            v[LENGTH + i] = rate;
        }
    }
    q[PLATFORM] = start.centre[0];
    q[Y + PLATFORM] = start.centre[1];
    q[ANGLE + PLATFORM] = PLATFORM_ANGLE;
    v[PLATFORM] = start.velocity[0];
    v[Y + PLATFORM] = start.velocity[1];
    (q, v)
}

impl Pose {
    #[inline(always)]
    pub fn new<const N: usize>(path: &Path, t: f64, q: &[f64; N], v: &[f64; N]) -> Self {
        let angles = [q[ANGLE], q[ANGLE + 1], q[ANGLE + 2], q[ANGLE + 3], path.angle(t), 0.0];
        let (sin, cos) = sin_cos(&angles);
        let point = path.at(cos[4], sin[4]);
        let (length, rate) = if N == SERVO {
            // the fourth lane is padding
            (
                [q[LENGTH], q[LENGTH + 1], q[LENGTH + 2], 1.0],
                [v[LENGTH], v[LENGTH + 1], v[LENGTH + 2], 0.0],
            )
        } else {
            (point.length, point.rate)
        };
        let (c, s) = (cos[PLATFORM], sin[PLATFORM]);
        let (mut arm, mut corner) = ([0.0; 4], [[0.0; 4]; 2]);
        let (mut base, mut top) = ([[0.0; 4]; 2], [[0.0; 4]; 2]);
        for i in 0..4 {
            arm[i] = ARM + ARM_RATE * length[i];
            let reach = length[i] - arm[i];
            let (rx, ry) = (path.corners[0][i], path.corners[1][i]);
            corner[0][i] = c * rx - s * ry;
            corner[1][i] = s * rx + c * ry;
            base[0][i] = q[i] - arm[i] * cos[i] - path.anchors[0][i];
            base[1][i] = q[Y + i] - arm[i] * sin[i] - path.anchors[1][i];
            top[0][i] = q[i] + reach * cos[i] - q[PLATFORM] - corner[0][i];
            top[1][i] = q[Y + i] + reach * sin[i] - q[Y + PLATFORM] - corner[1][i];
        }
        Self {
            point,
            length,
            rate,
            cos: [cos[0], cos[1], cos[2], cos[3]],
            sin: [sin[0], sin[1], sin[2], sin[3]],
            arm,
            corner,
            base,
            top,
        }
    }

    /// The contact in A_i: `P` moves at `Ġ − ṡ u − s ω n`, the bearing stands still.
    #[inline(always)]
    pub fn base_meeting<const N: usize>(&self, v: &[f64; N], i: usize) -> Meeting {
        let (cos, sin) = (self.cos[i], self.sin[i]);
        let along = ARM_RATE * self.rate[i];
        let across = self.arm[i] * v[ANGLE + i];
        Meeting {
            e: [self.base[0][i], self.base[1][i]],
            v: [v[i] - along * cos + across * sin, v[Y + i] - along * sin - across * cos],
            journal_spin: v[ANGLE + i],
            bearing_spin: 0.0,
        }
    }

    /// The contact in C_i: `Q` moves at `Ġ + (q̇ − ṡ) u + (q − s) ω n`, the bearing with the platform.
    #[inline(always)]
    pub fn top_meeting<const N: usize>(&self, v: &[f64; N], i: usize) -> Meeting {
        let (cos, sin) = (self.cos[i], self.sin[i]);
        let along = (1.0 - ARM_RATE) * self.rate[i];
        let across = (self.length[i] - self.arm[i]) * v[ANGLE + i];
        let spin = v[ANGLE + PLATFORM];
        Meeting {
            e: [self.top[0][i], self.top[1][i]],
            v: [
                v[i] + along * cos - across * sin - v[PLATFORM] + spin * self.corner[1][i],
                v[Y + i] + along * sin + across * cos - v[Y + PLATFORM] - spin * self.corner[0][i],
            ],
            journal_spin: v[ANGLE + i],
            bearing_spin: spin,
        }
    }

    /// Distances of the centres, A1 A2 A3 C1 C2 C3.
    pub fn eccentricities(&self) -> [f64; 6] {
        let (base, top) = (squares(&self.base), squares(&self.top));
        [base[0], base[1], base[2], top[0], top[1], top[2]].map(f64::sqrt)
    }
}

/// Squared lengths, lane by lane.
#[inline(always)]
pub fn squares([x, y]: &[[f64; 4]; 2]) -> [f64; 4] {
    std::array::from_fn(|i| x[i] * x[i] + y[i] * y[i])
}
