//! The machine solved without a physics engine, as fast as we know how: minimal coordinates, the equations
//! of motion in closed form, an adaptive explicit Runge–Kutta pair. It knows this one machine on its
//! default circle, and a slider-crank (`slider_crank`), and nothing else.
//!
//! `tolerance` is the error in m/s that one step may add to the velocities.

mod contact;
mod dynamics;
mod integrator;
mod machine;
mod pose;
pub mod slider_crank;
mod system;
mod trigonometry;
mod tsitouras;

pub use integrator::Work;
pub use machine::{Drive, Machine};

use dynamics::Dynamics;
use integrator::integrate;
use pose::{ANGLE, PLATFORM, PRESCRIBED, Pose, SERVO, Y};

/// The machine at one time. Joints are A1 A2 A3 C1 C2 C3.
#[derive(Clone, Debug)]
pub struct Sample {
    pub t: f64,
    pub x: f64,
    pub y: f64,
    pub phi: f64,
    pub vx: f64,
    pub vy: f64,
    pub omega: f64,
    pub ax: f64,
    pub ay: f64,
    pub alpha: f64,
    pub lengths: [f64; 3],
    /// Of the drive on the rod, positive outward.
    pub drive_forces: [f64; 3],
    /// Normal forces.
    pub contact_forces: [f64; 6],
    /// Distances of journal and bearing centres.
    pub eccentricities: [f64; 6],
}

/// Runs `machine` from the ideal pose and velocity at t = 0, its journals centred, through the increasing
/// `times`, none before 0, and shows `observe` each of them. Outputs do not change the steps.
pub fn simulate(
    machine: &Machine,
    tolerance: f64,
    times: &[f64],
    observe: impl FnMut(&Sample),
) -> Work {
    match machine.drive {
        Drive::Prescribed => run::<PRESCRIBED>(machine, tolerance, times, observe),
        Drive::Servo => run::<SERVO>(machine, tolerance, times, observe),
    }
}

fn run<const N: usize>(
    machine: &Machine,
    tolerance: f64,
    times: &[f64],
    mut observe: impl FnMut(&Sample),
) -> Work {
    let dynamics = Dynamics::new(machine);
    integrate::<N, _>(&dynamics, tolerance, times, |t, q, v| observe(&sample(&dynamics, t, &q, &v)))
}

fn sample<const N: usize>(dynamics: &Dynamics, t: f64, q: &[f64; N], v: &[f64; N]) -> Sample {
    let pose = Pose::new(&dynamics.path, t, q, v);
    let loads = dynamics.loads(v, &pose);
    let a = dynamics.accelerations(v, &pose, &loads);
    let platform =
        |values: &[f64; N]| [values[PLATFORM], values[Y + PLATFORM], values[ANGLE + PLATFORM]];
    let ([x, y, phi], [vx, vy, omega], [ax, ay, alpha]) = (platform(q), platform(v), platform(&a));
    Sample {
        t,
        x,
        y,
        phi,
        vx,
        vy,
        omega,
        ax,
        ay,
        alpha,
        lengths: std::array::from_fn(|i| pose.length[i]),
        drive_forces: std::array::from_fn(|i| dynamics.drive_force(v, &pose, &loads, i)),
        contact_forces: loads.normal,
        eccentricities: pose.eccentricities(),
    }
}
