//! Equations of motion in minimal coordinates: `q̈ = a(t, q, q̇)` in closed form.
//!
//! A leg is two bars on one line, cylinder (m₁, I₁) and rod (m₂, I₂), with centres of mass `L = q − ℓ`
//! apart (ℓ = the bars' length). Its coordinates are its common centre of mass G, its angle θ and, with
//! the servo, its length q. With m = m₁ + m₂, μ = m₁m₂/m, u = \[cos θ, sin θ\], n = \[−sin θ, cos θ\]:
//!
//! * pivots `P = G − s u`, `Q = G + (q − s) u` with `s = (m₁ ℓ/2 + m₂ (q − ℓ/2))/m`, `ṡ = (m₂/m) q̇`;
//! * momentum: `m G̈ = F_P + F_Q + m g`;
//! * angular momentum about G, `J ω` with `J = I₁ + I₂ + μ L²`:
//!   `J α + 2 μ L L̇ ω = −s n·F_P + (q − s) n·F_Q` (+ friction moments);
//! * the centres' distance, `r₂ − r₁ = L u`:
//!   `μ (L̈ − ω² L) = F_d + μ u·(F_Q/m₂ − F_P/m₁)`, F_d the drive's push.
//!
//! Prescribed, L(t) is known: the leg is one rigid body of changing length, and the last line gives the
//! reaction F_d. With the servo it gives q̈. The platform is a rigid body about its centre of mass.
//!
//! Coordinates are stored as lanes \[leg 1, leg 2, leg 3, platform\] of x, y and angle, then (servo)
//! the three lengths and a padding zero: 12 or 16 numbers.

use super::contact::{ContactLaw, Load, Meeting};
use super::machine::{
    Bar, CYLINDER, Machine, PLATFORM_ANGLE, PLATFORM_INERTIA, PLATFORM_MASS, Path, PathPoint, ROD,
    SERVO_DAMPING, SERVO_STIFFNESS,
};
use super::trigonometry::sin_cos;

/// Coordinates of the prescribed drive.
pub const PRESCRIBED: usize = 12;
/// Coordinates of the servo drive.
pub const SERVO: usize = 16;

const Y: usize = 4;
const ANGLE: usize = 8;
const LENGTH: usize = 12;
const PLATFORM: usize = 3;

const M1: f64 = CYLINDER.mass();
const M2: f64 = ROD.mass();
const LEG_MASS: f64 = M1 + M2;
const REDUCED_MASS: f64 = M1 * M2 / LEG_MASS;
const LEG_INERTIA: f64 = CYLINDER.inertia() + ROD.inertia();
/// `s = ARM + ARM_RATE · q`.
const ARM: f64 = 0.5 * Bar::LENGTH * (M1 - M2) / LEG_MASS;
const ARM_RATE: f64 = M2 / LEG_MASS;

/// The right-hand side; `N` is [`PRESCRIBED`] or [`SERVO`].
pub struct Dynamics<const N: usize> {
    path: Path,
    law: ContactLaw,
    gravity: [f64; 2],
}

/// Everything that follows from the coordinates alone, and the leg lengths' rates.
pub struct Pose {
    point: PathPoint,
    pub length: [f64; 4],
    rate: [f64; 4],
    cos: [f64; 4],
    sin: [f64; 4],
    /// From the pivot P to the centre of mass.
    arm: [f64; 4],
    /// Platform corners from its centre.
    corner: [[f64; 4]; 2],
    /// Journal less bearing centre in A1 A2 A3 and C1 C2 C3.
    base: [[f64; 4]; 2],
    top: [[f64; 4]; 2],
}

/// What the joints and drives do to each body.
pub struct Loads {
    force: [[f64; 4]; 2],
    moment: [f64; 4],
    /// `u·(F_Q/m₂ − F_P/m₁)`.
    stretch: [f64; 3],
    pub normal: [f64; 6],
}

impl<const N: usize> Dynamics<N> {
    pub fn new(machine: &Machine) -> Self {
        Self {
            path: Path::new(machine.phase),
            law: ContactLaw::new(machine),
            gravity: machine.gravity,
        }
    }

    /// The ideal pose and velocity at t = 0: every journal centred.
    pub fn start(&self) -> ([f64; N], [f64; N]) {
        let start = self.path.start();
        let (mut q, mut v) = ([0.0; N], [0.0; N]);
        for i in 0..3 {
            let (length, rate) = (start.point.length[i], start.point.rate[i]);
            let (sin, cos) = start.angle[i].sin_cos();
            let (arm, arm_rate) = (ARM + ARM_RATE * length, ARM_RATE * rate);
            q[i] = self.path.anchors[0][i] + arm * cos;
            q[Y + i] = self.path.anchors[1][i] + arm * sin;
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

    #[inline(always)]
    pub fn pose(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> Pose {
        let angles =
            [q[ANGLE], q[ANGLE + 1], q[ANGLE + 2], q[ANGLE + 3], self.path.angle(t), 0.0];
        let (sin, cos) = sin_cos(&angles);
        let point = self.path.at(cos[4], sin[4]);
        let (length, rate) = if N == SERVO {
            // the padding lane must not be zero: it would divide by it
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
            let (rx, ry) = (self.path.corners[0][i], self.path.corners[1][i]);
            corner[0][i] = c * rx - s * ry;
            corner[1][i] = s * rx + c * ry;
            base[0][i] = q[i] - arm[i] * cos[i] - self.path.anchors[0][i];
            base[1][i] = q[Y + i] - arm[i] * sin[i] - self.path.anchors[1][i];
            top[0][i] = q[i] + reach * cos[i] - q[PLATFORM] - corner[0][i];
            top[1][i] = q[Y + i] + reach * sin[i] - q[Y + PLATFORM] - corner[1][i];
        }
        Pose {
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
    fn base_meeting(&self, v: &[f64; N], pose: &Pose, i: usize) -> Meeting {
        let (cos, sin) = (pose.cos[i], pose.sin[i]);
        let along = ARM_RATE * pose.rate[i];
        let across = pose.arm[i] * v[ANGLE + i];
        Meeting {
            e: [pose.base[0][i], pose.base[1][i]],
            v: [v[i] - along * cos + across * sin, v[Y + i] - along * sin - across * cos],
            journal_spin: v[ANGLE + i],
            bearing_spin: 0.0,
        }
    }

    /// The contact in C_i: `Q` moves at `Ġ + (q̇ − ṡ) u + (q − s) ω n`, the bearing with the platform.
    #[inline(always)]
    fn top_meeting(&self, v: &[f64; N], pose: &Pose, i: usize) -> Meeting {
        let (cos, sin) = (pose.cos[i], pose.sin[i]);
        let along = (1.0 - ARM_RATE) * pose.rate[i];
        let across = (pose.length[i] - pose.arm[i]) * v[ANGLE + i];
        let spin = v[ANGLE + PLATFORM];
        Meeting {
            e: [pose.top[0][i], pose.top[1][i]],
            v: [
                v[i] + along * cos - across * sin - v[PLATFORM] + spin * pose.corner[1][i],
                v[Y + i] + along * sin + across * cos - v[Y + PLATFORM] - spin * pose.corner[0][i],
            ],
            journal_spin: v[ANGLE + i],
            bearing_spin: spin,
        }
    }

    #[inline(always)]
    pub fn loads(&self, v: &[f64; N], pose: &Pose) -> Loads {
        let mut loads =
            Loads { force: [[0.0; 4]; 2], moment: [0.0; 4], stretch: [0.0; 3], normal: [0.0; 6] };
        let limit = self.law.clearance * self.law.clearance;
        let (base, top) = (squares(&pose.base), squares(&pose.top));
        for i in 0..3 {
            if base[i] > limit {
                let load = self.law.load(&self.base_meeting(v, pose, i));
                loads.add_to_leg(&load, pose, i, -pose.arm[i], -1.0 / M1);
                loads.normal[i] = load.normal;
            }
            if top[i] > limit {
                let load = self.law.load(&self.top_meeting(v, pose, i));
                loads.add_to_leg(&load, pose, i, pose.length[i] - pose.arm[i], 1.0 / M2);
                loads.add_to_platform(&load, [pose.corner[0][i], pose.corner[1][i]]);
                loads.normal[3 + i] = load.normal;
            }
        }
        loads
    }

    /// The drive's push on the rod, positive outward.
    pub fn drive_force(&self, v: &[f64; N], pose: &Pose, loads: &Loads, i: usize) -> f64 {
        if N == SERVO {
            servo_force(pose, i)
        } else {
            let spin = v[ANGLE + i];
            let inertial = self.path.second_rate(&pose.point, i)
                - spin * spin * (pose.length[i] - Bar::LENGTH);
            REDUCED_MASS * (inertial - loads.stretch[i])
        }
    }

    #[inline(always)]
    pub fn accelerations(&self, v: &[f64; N], pose: &Pose, loads: &Loads) -> [f64; N] {
        const MASS: [f64; 4] =
            [1.0 / LEG_MASS, 1.0 / LEG_MASS, 1.0 / LEG_MASS, 1.0 / PLATFORM_MASS];
        let mut a = [0.0; N];
        for i in 0..4 {
            a[i] = loads.force[0][i] * MASS[i] + self.gravity[0];
            a[Y + i] = loads.force[1][i] * MASS[i] + self.gravity[1];
            let distance = pose.length[i] - Bar::LENGTH;
            let inertia = LEG_INERTIA + REDUCED_MASS * distance * distance;
            let spin = v[ANGLE + i];
            let coriolis = 2.0 * REDUCED_MASS * distance * pose.rate[i] * spin;
            a[ANGLE + i] = (loads.moment[i] - coriolis) / inertia;
        }
        a[ANGLE + PLATFORM] = loads.moment[PLATFORM] * (1.0 / PLATFORM_INERTIA);
        if N == SERVO {
            for i in 0..3 {
                let spin = v[ANGLE + i];
                a[LENGTH + i] = spin * spin * (pose.length[i] - Bar::LENGTH)
                    + loads.stretch[i]
                    + servo_force(pose, i) * (1.0 / REDUCED_MASS);
            }
        }
        a
    }

    /// EXPERIMENT: time until the next onset of contact.
    #[inline(always)]
    pub fn time_to_contact(&self, t: f64, q: &[f64; N], v: &[f64; N], _a: &[f64; N]) -> (f64, f64) {
        let pose = self.pose(t, q, v);
        let limit = self.law.clearance * self.law.clearance;
        let mut soonest = f64::MAX;
        let mut speed = 0.0;
        for m in [
            self.base_meeting(v, &pose, 0), self.base_meeting(v, &pose, 1), self.base_meeting(v, &pose, 2),
            self.top_meeting(v, &pose, 0), self.top_meeting(v, &pose, 1), self.top_meeting(v, &pose, 2),
        ] {
            let ee = m.e[0] * m.e[0] + m.e[1] * m.e[1];
            if ee < limit {
                let ev = m.e[0] * m.v[0] + m.e[1] * m.v[1];
                let vv = m.v[0] * m.v[0] + m.v[1] * m.v[1] + 1e-300;
                let root = (ev * ev + vv * (limit - ee)).sqrt();
                let time = (limit - ee) / (root + ev);
                if time < soonest {
                    soonest = time;
                    speed = root;
                }
            }
        }
        (soonest, speed / self.law.clearance)
    }

    /// The right-hand side.
    #[inline(always)]
    pub fn evaluate(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> [f64; N] {
        let pose = self.pose(t, q, v);
        self.accelerations(v, &pose, &self.loads(v, &pose))
    }
}

impl Pose {
    /// Distances of the centres, A1 A2 A3 C1 C2 C3.
    pub fn eccentricities(&self) -> [f64; 6] {
        let (base, top) = (squares(&self.base), squares(&self.top));
        [base[0], base[1], base[2], top[0], top[1], top[2]].map(f64::sqrt)
    }
}

impl Loads {
    /// A force on the leg's journal, `arm` along u from the centre of mass, on a bar of mass ±1/`inverse_mass`.
    #[inline(always)]
    fn add_to_leg(&mut self, load: &Load, pose: &Pose, i: usize, arm: f64, inverse_mass: f64) {
        let ([fx, fy], cos, sin) = (load.on_journal, pose.cos[i], pose.sin[i]);
        self.force[0][i] += fx;
        self.force[1][i] += fy;
        self.moment[i] += arm * (cos * fy - sin * fx) + load.journal_moment;
        self.stretch[i] += inverse_mass * (cos * fx + sin * fy);
    }

    /// The same force turned round, on the platform's bearing.
    #[inline(always)]
    fn add_to_platform(&mut self, load: &Load, [rx, ry]: [f64; 2]) {
        let [fx, fy] = load.on_journal;
        self.force[0][PLATFORM] -= fx;
        self.force[1][PLATFORM] -= fy;
        self.moment[PLATFORM] += ry * fx - rx * fy + load.bearing_moment;
    }
}

/// `k_p (q_cmd − q) + k_d (q̇_cmd − q̇)`.
#[inline(always)]
fn servo_force(pose: &Pose, i: usize) -> f64 {
    SERVO_STIFFNESS * (pose.point.length[i] - pose.length[i])
        + SERVO_DAMPING * (pose.point.rate[i] - pose.rate[i])
}

#[inline(always)]
fn squares([x, y]: &[[f64; 4]; 2]) -> [f64; 4] {
    std::array::from_fn(|i| x[i] * x[i] + y[i] * y[i])
}
