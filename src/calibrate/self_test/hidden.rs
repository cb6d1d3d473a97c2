//! Effects of random size.

use super::LegsTrial;
use crate::effects::{Setting, named};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// How an effect is hidden: name, joints to choose from, and for each value its smallest size, whether
/// it takes either sign, and whether it grows with the size of the trial.
struct HiddenKind {
    kind: &'static str,
    joints: &'static [&'static str],
    values: &'static [(&'static str, Draw)],
}

/// How a value is drawn.
#[derive(Clone, Copy)]
enum Draw {
    /// At least so much, times the size of the trial.
    Size(f64),
    /// The same, of either sign.
    Either(f64),
    /// As declared (the first) plus a size of either sign.
    Around(f64, f64),
    /// As declared plus a size.
    Above(f64, f64),
    /// Anything between.
    Between(f64, f64),
}

const P: &[&str] = &["P1", "P2", "P3"];
const A: &[&str] = &["A1", "A2", "A3"];
const ALL_JOINTS: &[&str] = &["A1", "A2", "A3", "C1", "C2", "C3"];

use Draw::{Above, Around, Between, Either, Size};

/// Every effect with a name that rigs may hide, at a size of one about three times what sensors and
/// rattle would hide.
const HIDDEN: &[HiddenKind] = &[
    HiddenKind {
        kind: "payload",
        joints: &[],
        values: &[
            ("mass_kg", Size(0.02)),
            ("com_x_m", Between(-0.03, 0.03)),
            ("com_y_m", Between(-0.03, 0.03)),
        ],
    },
    HiddenKind {
        kind: "gravity",
        joints: &[],
        values: &[("gx_m_s2", Either(0.15)), ("gy_m_s2", Around(f64::NAN, 0.15))],
    },
    HiddenKind {
        kind: "actuator-friction",
        joints: P,
        values: &[("coulomb_N", Size(0.3)), ("viscous_Ns_m", Size(1.0))],
    },
    HiddenKind { kind: "journal-friction", joints: &[], values: &[("mu", Size(0.03))] },
    HiddenKind {
        kind: "anchor-offset",
        joints: A,
        values: &[("dx_m", Either(5e-5)), ("dy_m", Either(5e-5))],
    },
    HiddenKind {
        kind: "joint-wear",
        joints: ALL_JOINTS,
        values: &[("clearance_m", Above(1e-4, 4e-5))],
    },
    HiddenKind { kind: "command-delay", joints: &[], values: &[("delay_s", Size(2e-4))] },
    HiddenKind { kind: "servo-lag", joints: &[], values: &[("time_constant_s", Size(4e-4))] },
    HiddenKind { kind: "actuator-scale", joints: P, values: &[("relative", Either(1e-3))] },
    HiddenKind {
        kind: "screw-ripple",
        joints: P,
        values: &[
            ("amplitude_m", Size(1e-5)),
            ("pitch_m", Between(3e-3, 8e-3)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
    HiddenKind {
        kind: "tether",
        joints: &[],
        values: &[
            ("stiffness_N_m", Size(4.0)),
            ("anchor_x_m", Between(-0.3, 0.3)),
            ("anchor_y_m", Between(0.15, 0.4)),
            ("rest_length_m", Between(0.02, 0.12)),
        ],
    },
    HiddenKind {
        kind: "drag",
        joints: &[],
        values: &[("force_Ns_m", Size(0.8)), ("torque_Nms", Size(2e-3))],
    },
    HiddenKind {
        kind: "base-vibration",
        joints: &[],
        values: &[
            ("ax_m_s2", Either(0.2)),
            ("ay_m_s2", Either(0.2)),
            ("frequency_Hz", Between(4.0, 40.0)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
    HiddenKind {
        kind: "unbalance",
        joints: &[],
        values: &[
            ("mass_radius_kg_m", Size(2e-5)),
            ("frequency_Hz", Between(10.0, 40.0)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
];

/// A number between 0 and 1.
pub(super) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// The effect called `name` with values of the trial's size, if it is one that can be hidden.
pub(super) fn hide(name: &str, trial: &LegsTrial, random: &mut ChaCha8Rng) -> Option<Setting> {
    let hidden = HIDDEN.iter().find(|hidden| hidden.kind == name)?;
    let kind = named(hidden.kind)?;
    let joint = (!hidden.joints.is_empty())
        .then(|| hidden.joints[(uniform(random) * hidden.joints.len() as f64) as usize]);
    let mut size = |at_least: f64| at_least * trial.size * (1.0 + 0.5 * uniform(random));
    let mut values = Vec::new();
    let mut signs = ChaCha8Rng::seed_from_u64(trial.seed ^ 0x5151);
    let mut sign = || if uniform(&mut signs) < 0.5 { -1.0 } else { 1.0 };
    let declared_y = if trial.gravity { -9.81 } else { 0.0 };
    for (name, draw) in hidden.values {
        let value = match *draw {
            Size(s) => size(s),
            Either(s) => sign() * size(s),
            Around(declared, s) => {
                let declared = if declared.is_nan() { declared_y } else { declared };
                declared + sign() * size(s)
            }
            Above(declared, s) => declared + size(s),
            Between(low, high) => low + (high - low) * (size(1.0) / trial.size - 1.0) / 0.5,
        };
        values.push((*name, value));
    }
    Some(Setting::new(kind, joint, &values))
}
