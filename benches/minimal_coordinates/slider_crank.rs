//! A slider-crank with play in crank pin and slider pin; the crank's pivot and the slide are ideal. A
//! servo turns the crank by a smooth command.
//!
//! Coordinates are the rod's centre of mass G, the slider's place s on the x axis, the rod's angle ψ and
//! the crank's angle θ (and a padding zero): with them the masses are constant and none couples to
//! another, so that every acceleration is a force over a mass. The crank's pivot is the origin, w and u
//! the directions of crank and rod, 2b the rod's length, r the crank's:
//!
//! * crank pin, a journal of the rod in the crank: `e = G − b u − r w`;
//! * slider pin, a journal of the slider in the rod: `e = s − G − b u`.

use super::contact::{ContactLaw, Load, Meeting};
use super::integrator::{Work, integrate};
use super::system::{Onset, System};
use super::trigonometry::sin_cos;

/// Length in m, mass in kg, inertia about the pivot in kg·m² and centre of mass in m from the pivot.
pub const CRANK: f64 = 0.05;
pub const CRANK_MASS: f64 = 0.12;
pub const CRANK_INERTIA: f64 = CENTRAL_CRANK_INERTIA + CRANK_MASS * CRANK_CENTRE * CRANK_CENTRE;
pub const CENTRAL_CRANK_INERTIA: f64 = 1.1e-4;
pub const CRANK_CENTRE: f64 = 0.02;
/// The same of the rod, whose centre of mass is its middle.
pub const ROD: f64 = 0.15;
pub const ROD_MASS: f64 = 0.09;
pub const ROD_INERTIA: f64 = 2.2e-4;
pub const SLIDER_MASS: f64 = 0.25;
/// Servo of the crank, in N·m/rad and N·m·s/rad.
pub const STIFFNESS: f64 = 400.0;
pub const DAMPING: f64 = 1.5;
/// Of both pins, in m.
pub const BEARING_RADIUS: f64 = 0.008;
pub const CLEARANCE: f64 = 2e-4;
/// Along y, in m/s².
pub const GRAVITY: f64 = -9.81;
/// Damping of a contact in N·s/m, and the depth in m at which it is fully there.
const CONTACT_DAMPING: [f64; 2] = [500.0, 1e-5];
/// What the command turns in rad, and in what time in s.
const TURN: f64 = 0.8;
const DURATION: f64 = 0.08;

/// Coordinates, one of them padding.
const N: usize = 6;
const SLIDER: usize = 2;
const ROD_ANGLE: usize = 3;
const CRANK_ANGLE: usize = 4;

/// The crank's angle, its rate and its second rate that are asked for at `t` s by a command that begins at
/// rest at `start` rad: the quintic from rest to rest.
#[inline(always)]
pub fn command(start: f64, t: f64) -> [f64; 3] {
    let s = (t / DURATION).min(1.0);
    let left = 1.0 - s;
    [
        start + TURN * s * s * s * (10.0 - s * (15.0 - 6.0 * s)),
        TURN / DURATION * 30.0 * s * s * left * left,
        TURN / (DURATION * DURATION) * 60.0 * s * left * (1.0 - 2.0 * s),
    ]
}

/// Centre of mass of the rod, its angle, and the slider's place, were there no play.
pub fn ideal(crank: f64) -> ([f64; 2], f64, f64) {
    let pin = [CRANK * crank.cos(), CRANK * crank.sin()];
    let angle = (-pin[1] / ROD).asin();
    let half = 0.5 * ROD * angle.cos();
    ([pin[0] + half, 0.5 * pin[1]], angle, pin[0] + 2.0 * half)
}

/// The mechanism at one time.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Centre of mass of the rod.
    pub rod: [f64; 2],
    /// The slider's place on the x axis.
    pub slider: f64,
}

/// Runs from the ideal pose at rest with the crank at `start` rad through the increasing `times`, and
/// shows `observe` each of them.
pub fn simulate(
    start: f64,
    tolerance: f64,
    times: &[f64],
    mut observe: impl FnMut(Sample),
) -> Work {
    let law = ContactLaw::new(BEARING_RADIUS, CLEARANCE, CONTACT_DAMPING, 0.0);
    integrate(&SliderCrank { start, law }, tolerance, times, |_, q, _| {
        observe(Sample { rod: [q[0], q[1]], slider: q[SLIDER] });
    })
}

struct SliderCrank {
    start: f64,
    law: ContactLaw,
}

struct Pose {
    /// From the crank's pivot to its pin, and from the rod's centre of mass to its slider end.
    pin: [f64; 2],
    half: [f64; 2],
    /// Journal less bearing centre in crank pin and slider pin.
    crank_pin: [f64; 2],
    slider_pin: [f64; 2],
}

impl Pose {
    #[inline(always)]
    fn crank_pin(&self, v: &[f64; N]) -> Meeting {
        let (spin, crank) = (v[ROD_ANGLE], v[CRANK_ANGLE]);
        let (half, pin) = (self.half, self.pin);
        Meeting {
            e: self.crank_pin,
            v: [v[0] + spin * half[1] + crank * pin[1], v[1] - spin * half[0] - crank * pin[0]],
            journal_spin: spin,
            bearing_spin: crank,
        }
    }

    #[inline(always)]
    fn slider_pin(&self, v: &[f64; N]) -> Meeting {
        let (spin, half) = (v[ROD_ANGLE], self.half);
        Meeting {
            e: self.slider_pin,
            v: [v[SLIDER] - v[0] + spin * half[1], -v[1] - spin * half[0]],
            journal_spin: 0.0,
            bearing_spin: spin,
        }
    }
}

impl System<N> for SliderCrank {
    type Pose = Pose;

    const ENTRY: f64 = 3e-4;

    fn start(&self) -> ([f64; N], [f64; N]) {
        let ([x, y], angle, slider) = ideal(self.start);
        ([x, y, slider, angle, self.start, 0.0], [0.0; N])
    }

    fn radii(&self) -> [f64; N] {
        [1.0, 1.0, 1.0, 0.5 * ROD, CRANK, 0.0]
    }

    #[inline(always)]
    fn evaluate(&self, t: f64, q: &[f64; N], v: &[f64; N]) -> ([f64; N], Pose) {
        let (sin, cos) = sin_cos(&[q[ROD_ANGLE], q[CRANK_ANGLE]]);
        let half = [0.5 * ROD * cos[0], 0.5 * ROD * sin[0]];
        let pin = [CRANK * cos[1], CRANK * sin[1]];
        let pose = Pose {
            pin,
            half,
            crank_pin: [q[0] - half[0] - pin[0], q[1] - half[1] - pin[1]],
            slider_pin: [q[SLIDER] - q[0] - half[0], -q[1] - half[1]],
        };
        let limit = self.law.clearance * self.law.clearance;
        let [angle, rate, _] = command(self.start, t);
        let (mut rod, mut rod_moment, mut slider) = ([0.0; 2], 0.0, 0.0);
        let mut crank_moment = STIFFNESS * (angle - q[CRANK_ANGLE])
            + DAMPING * (rate - v[CRANK_ANGLE])
            + CRANK_MASS * CRANK_CENTRE * GRAVITY * cos[1];
        if square(pose.crank_pin) > limit {
            let Load { on_journal: f, journal_moment, bearing_moment, .. } =
                self.law.load(&pose.crank_pin(v));
            rod = f;
            rod_moment = journal_moment - cross(half, f);
            crank_moment += bearing_moment - cross(pin, f);
        }
        if square(pose.slider_pin) > limit {
            let Load { on_journal: f, bearing_moment, .. } = self.law.load(&pose.slider_pin(v));
            slider = f[0];
            rod = [rod[0] - f[0], rod[1] - f[1]];
            rod_moment += bearing_moment - cross(half, f);
        }
        let a = [
            rod[0] * (1.0 / ROD_MASS),
            rod[1] * (1.0 / ROD_MASS) + GRAVITY,
            slider * (1.0 / SLIDER_MASS),
            rod_moment * (1.0 / ROD_INERTIA),
            crank_moment * (1.0 / CRANK_INERTIA),
            0.0,
        ];
        (a, pose)
    }

    #[inline(always)]
    fn next_onset(&self, v: &[f64; N], pose: &Pose) -> Onset {
        let clearance = self.law.clearance;
        let mut next = Onset::NEVER;
        for meeting in [pose.crank_pin(v), pose.slider_pin(v)] {
            let square = square(meeting.e);
            if square <= clearance * clearance {
                next.or(&meeting, square, clearance);
            }
        }
        next
    }
}

#[inline(always)]
fn square([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}

#[inline(always)]
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
