//! What the integrator asks of a machine in `N` coordinates.

use super::contact::Meeting;

pub trait System<const N: usize> {
    /// What follows from coordinates and rates alone.
    type Pose;

    /// How far a step may reach into a contact that begins within it: `ENTRY (tolerance² / v³)^0.2`.
    /// There the force is K (v τ)^1.5, and a polynomial misses a fixed part of K v^1.5 τ^2.5/m of the
    /// velocity, which is the tolerance at that reach; found by trial for the machine's K and m.
    const ENTRY: f64;

    /// Coordinates and rates at t = 0.
    fn start(&self) -> ([f64; N], [f64; N]);

    /// What turns errors of the rates into speeds: 1, or a radius in m for an angular rate.
    fn radii(&self) -> [f64; N];

    /// Accelerations at time `t`.
    fn evaluate(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Self::Pose);

    /// The next onset of contact if no journal were accelerated from here on.
    fn next_onset(&self, v: &[f64; N], pose: &Self::Pose) -> Onset;
}

/// When the next journal reaches its bearing, and how fast it then closes in.
pub struct Onset {
    pub time: f64,
    pub speed: f64,
}

impl Onset {
    pub const NEVER: Self = Self { time: f64::INFINITY, speed: 0.0 };

    /// The earlier of this onset and that of a journal in flight: `|e + ė τ| = c`, `square` = |e|².
    #[inline(always)]
    pub fn or(&mut self, meeting: &Meeting, square: f64, clearance: f64) {
        let ([ex, ey], [vx, vy]) = (meeting.e, meeting.v);
        let rest = clearance * clearance - square;
        let along = ex * vx + ey * vy;
        let root = (along * along + (vx * vx + vy * vy) * rest).sqrt();
        // a journal at rest in the middle of its bearing never arrives: x/0 = ∞
        let time = rest / (root + along);
        if time < self.time {
            *self = Self { time, speed: root / clearance };
        }
    }
}
