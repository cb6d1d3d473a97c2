//! Equations of motion in minimal coordinates: `q̈ = a(t, q, q̇)` in closed form.
//!
//! A leg is two bars on one line, cylinder (m₁, I₁) and rod (m₂, I₂), their centres of mass `L = q − ℓ`
//! apart. Its coordinates are its common centre of mass G, its angle θ and, with the servo, its length q.
//! Forces F_P and F_Q act at its pivots P and Q (see `pose`). With m = m₁ + m₂, μ = m₁m₂/m:
//!
//! * momentum: `m G̈ = F_P + F_Q + m g`;
//! * angular momentum about G, `J ω` with `J = I₁ + I₂ + μ L²`:
//!   `J α + 2 μ L L̇ ω = −s n·F_P + (q − s) n·F_Q` (+ friction moments);
//! * the centres' distance, `r₂ − r₁ = L u`, along u:
//!   `μ (L̈ − ω² L) = F_d + μ u·(F_Q/m₂ − F_P/m₁)`, F_d the drive's push on the rod.
//!
//! Prescribed, L(t) is known: the leg is one rigid body of changing length, and the last line gives the
//! reaction F_d. With the servo it gives q̈. The platform is a rigid body about its centre of mass.
//! G is used rather than P because it has no part in the leg's turning: between impacts it moves ballistically.

use super::contact::{ContactLaw, Load};
use super::machine::{
    BEARING_RADIUS, Bar, CYLINDER, Machine, PLATFORM_INERTIA, PLATFORM_MASS, Path, ROD,
    SERVO_DAMPING, SERVO_STIFFNESS,
};
use super::pose::{ANGLE, LENGTH, PLATFORM, Pose, SERVO, Y, squares, start};
use super::system::{Onset, System};

const M1: f64 = CYLINDER.mass();
const M2: f64 = ROD.mass();
const LEG_MASS: f64 = M1 + M2;
const REDUCED_MASS: f64 = M1 * M2 / LEG_MASS;
const LEG_INERTIA: f64 = CYLINDER.inertia() + ROD.inertia();

/// The right-hand side, for either number of coordinates.
pub struct Dynamics {
    pub path: Path,
    law: ContactLaw,
    gravity: [f64; 2],
}

/// What the joints do to each body.
pub struct Loads {
    force: [[f64; 4]; 2],
    moment: [f64; 4],
    /// `u·(F_Q/m₂ − F_P/m₁)`.
    stretch: [f64; 3],
    pub normal: [f64; 6],
}

/// Angular rates count as speeds at these radii: half a leg, and the platform's corners.
const LEG_RADIUS: f64 = 0.3;
const PLATFORM_RADIUS: f64 = 0.058;

impl<const N: usize> System<N> for Dynamics {
    type Pose = Pose;

    const ENTRY: f64 = 3e-4;

    fn start(&self) -> ([f64; N], [f64; N]) {
        start(&self.path)
    }

    fn radii(&self) -> [f64; N] {
        std::array::from_fn(|n| match n {
            _ if n == ANGLE + PLATFORM => PLATFORM_RADIUS,
            _ if (ANGLE..ANGLE + PLATFORM).contains(&n) => LEG_RADIUS,
            _ => 1.0,
        })
    }

    #[inline(always)]
    fn evaluate(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Pose) {
        let pose = Pose::new(&self.path, t, q, v);
        let a = self.accelerations(v, &pose, &self.loads(v, &pose));
        (a, pose)
    }

    #[inline(always)]
    fn next_onset(&self, v: &[f64; N], pose: &Pose) -> Onset {
        let limit = self.law.clearance * self.law.clearance;
        let (base, top) = (squares(&pose.base), squares(&pose.top));
        let mut next = Onset::NEVER;
        for i in 0..3 {
            if base[i] <= limit {
                next.or(&pose.base_meeting(v, i), base[i], self.law.clearance);
            }
            if top[i] <= limit {
                next.or(&pose.top_meeting(v, i), top[i], self.law.clearance);
            }
        }
        next
    }
}

impl Dynamics {
    pub fn new(machine: &Machine) -> Self {
        Self {
            path: Path::new(machine.phase),
            law: ContactLaw::new(
                BEARING_RADIUS,
                machine.clearance,
                [machine.c_max, machine.d_max],
                machine.friction,
            ),
            gravity: machine.gravity,
        }
    }

    #[inline(always)]
    pub fn loads<const N: usize>(&self, v: &[f64; N], pose: &Pose) -> Loads {
        let mut loads =
            Loads { force: [[0.0; 4]; 2], moment: [0.0; 4], stretch: [0.0; 3], normal: [0.0; 6] };
        let limit = self.law.clearance * self.law.clearance;
        let (base, top) = (squares(&pose.base), squares(&pose.top));
        for i in 0..3 {
            if base[i] > limit {
                let load = self.law.load(&pose.base_meeting(v, i));
                loads.add_to_leg(&load, pose, i, -pose.arm[i], -1.0 / M1);
                loads.normal[i] = load.normal;
            }
            if top[i] > limit {
                let load = self.law.load(&pose.top_meeting(v, i));
                loads.add_to_leg(&load, pose, i, pose.length[i] - pose.arm[i], 1.0 / M2);
                loads.add_to_platform(&load, [pose.corner[0][i], pose.corner[1][i]]);
                loads.normal[3 + i] = load.normal;
            }
        }
        loads
    }

    /// The drive's push on the rod, positive outward.
    pub fn drive_force<const N: usize>(
        &self,
        v: &[f64; N],
        pose: &Pose,
        loads: &Loads,
        i: usize,
    ) -> f64 {
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
    pub fn accelerations<const N: usize>(
        &self,
        v: &[f64; N],
        pose: &Pose,
        loads: &Loads,
    ) -> [f64; N] {
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
