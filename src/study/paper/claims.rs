//! What the paper claims, as comparisons with a limit.

use super::items::Item;
use super::variants::{LARGE, SMALL};
use crate::report::{length, number};

/// One claim of the paper.
#[derive(Debug)]
pub struct Claim {
    /// Name in `paper.json`.
    pub key: &'static str,
    /// The claim in a few words.
    pub label: &'static str,
    /// The paper's words, or the figures that show it.
    pub quote: &'static str,
    /// Where in the paper.
    pub place: &'static str,
    /// What is asked of the simulations.
    pub test: Test,
    /// When it counts as true.
    pub limit: ClaimLimit,
}

/// A value that a claim is judged by.
#[derive(Clone, Copy, Debug)]
pub enum Test {
    /// A mean at a clearance in m.
    Mean(Item, f64),
    /// The ratio of two means, each at its clearance in m.
    Ratio([(Item, f64); 2]),
    /// The smallest ratio from one clearance of the study to the next larger one.
    EveryStep(Item),
    /// The power p of the clearance in value ∝ cᵖ between two clearances in m.
    Power(Item, [f64; 2]),
}

/// When a value makes a claim true. A claim is supported if the whole 95 % interval lies on that side,
/// contradicted if it lies on the other, undecided otherwise.
#[derive(Clone, Copy, Debug)]
pub enum ClaimLimit {
    /// It lies above.
    Above(f64),
    /// It lies below.
    Below(f64),
}

/// A signal that jumps: a tenth of what uncorrelated samples have, 25 times a sine of 1 Hz.
const SHARP: f64 = 0.1;

/// Deviations below a tenth count as nearly ideal.
const NEARLY: f64 = 0.1;

/// "Clearly affected": at least twice the ideal value.
const CLEARLY: f64 = 2.0;

/// "Sensitive": a doubled clearance changes the value by more than a tenth, 2^0.1375 = 1.1.
pub(super) const SENSITIVE: f64 = 0.1375;

use ClaimLimit::{Above, Below};
use Item::{
    AccelerationJump, AngularJump, ForceJump, ForceShare, IdealForceJump, IdealPeakAcceleration,
    IdealPeakActuatorForce, Lyapunov, PathError, PeakAcceleration, PeakActuatorForce,
    PeakContactForce, SmoothForceShare,
};
use Test::{EveryStep, Mean, Power, Ratio};

/// The claims, in the order of the paper.
pub const CLAIMS: [Claim; 14] = [
    Claim {
        key: "acceleration-sharp",
        label: "accelerations change sharply",
        quote: "the magnitudes of the accelerations change sharply in the presence of joints \
                clearances",
        place: "section 4, figures 4 and 5",
        test: Mean(AccelerationJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "angular-acceleration-sharp",
        label: "angular acceleration changes sharply",
        quote: "the angular accelerations of the EE for different clearance sizes are shown",
        place: "section 4, figure 6",
        test: Mean(AngularJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "acceleration-affected",
        label: "clearance clearly affects accelerations",
        quote: "the existence of joint clearance clearly affects the accelerations",
        place: "section 5",
        test: Ratio([(PeakAcceleration, LARGE), (IdealPeakAcceleration, LARGE)]),
        limit: Above(CLEARLY),
    },
    Claim {
        key: "acceleration-grows",
        label: "larger clearance, larger accelerations",
        quote: "the manipulator experiences higher accelerations for the higher clearance sizes",
        place: "section 4",
        test: EveryStep(PeakAcceleration),
        limit: Above(1.0),
    },
    Claim {
        key: "joint-force-grows",
        label: "larger clearance, larger forces in the joints",
        quote: "higher clearance sizes led to higher impulsive accelerations and higher forces in the \
                joints",
        place: "section 5",
        test: EveryStep(PeakContactForce),
        limit: Above(1.0),
    },
    Claim {
        key: "actuator-force-sharp",
        label: "actuator forces change sharply",
        quote: "the required forces experience sharp changes in the case of manipulator with clearance \
                at the joints",
        place: "section 4, figures 7 to 9",
        test: Mean(ForceJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "ideal-force-smooth",
        label: "ideal actuator forces are smooth",
        quote: "while in the ideal case they are very smooth",
        place: "section 4, figures 7 to 9",
        test: Mean(IdealForceJump, LARGE),
        limit: Below(SHARP),
    },
    Claim {
        key: "actuator-force-affected",
        label: "clearance clearly affects actuator forces",
        quote: "the existence of joint clearance clearly affects the accelerations and input required \
                forces",
        place: "section 5",
        test: Ratio([(PeakActuatorForce, LARGE), (IdealPeakActuatorForce, LARGE)]),
        limit: Above(CLEARLY),
    },
    Claim {
        key: "actuator-force-grows",
        label: "larger clearance, larger actuators",
        quote: "the bigger clearance size makes bigger linear actuators in the manipulator",
        place: "section 4",
        test: EveryStep(PeakActuatorForce),
        limit: Above(1.0),
    },
    Claim {
        key: "nearly-ideal",
        label: "nearly ideal at 0.00001 mm",
        quote: "(shown, not said: the curves at C = 0.00001 mm beside those without clearance)",
        place: "figures 7b, 8b, 9b",
        test: Mean(ForceShare, SMALL),
        limit: Below(NEARLY),
    },
    Claim {
        key: "nearly-ideal-smooth",
        label: "nearly ideal at 0.00001 mm, 10 ms means",
        quote: "(the same, with what is faster than 10 ms averaged out)",
        place: "figures 7b, 8b, 9b",
        test: Mean(SmoothForceShare, SMALL),
        limit: Below(NEARLY),
    },
    Claim {
        key: "sensitive",
        label: "dynamics are sensitive to the clearance",
        quote: "the robot dynamics is very sensitive to the magnitude of clearance size",
        place: "section 5",
        // Over the sizes that machines are built with.
        test: Power(PeakAcceleration, [1e-4, LARGE]),
        limit: Above(SENSITIVE),
    },
    Claim {
        key: "chaotic",
        label: "motion is chaotic",
        quote: "it leads to a chaotic behaviour including the impact loads which results in an \
                unpredictable response",
        place: "abstract",
        test: Mean(Lyapunov, LARGE),
        limit: Above(0.0),
    },
    Claim {
        key: "error",
        label: "clearance causes position error",
        quote: "clearance introduces an additional uncontrollable degree of freedom to the \
                manipulator, it causes error",
        place: "abstract",
        test: Ratio([(PathError, LARGE), (PathError, SMALL)]),
        limit: Above(1.0),
    },
];

impl ClaimLimit {
    /// The limit in words.
    pub fn in_words(self) -> String {
        match self {
            Above(limit) => format!("above {}", number(limit)),
            Below(limit) => format!("below {}", number(limit)),
        }
    }
}

impl Test {
    /// What its value is.
    pub fn in_words(self) -> String {
        match self {
            Mean(item, c) => format!("{} at {}", item.quantity().label, length(c)),
            Ratio([(a, c), (b, d)]) => format!(
                "{} at {} over {} at {}",
                a.quantity().label,
                length(c),
                b.quantity().label,
                length(d)
            ),
            EveryStep(item) => format!(
                "{}: smallest ratio from one clearance to the next larger one",
                item.quantity().label
            ),
            Power(item, [from, to]) => format!(
                "{}: power of the clearance from {} to {}",
                item.quantity().label,
                length(from),
                length(to)
            ),
        }
    }
}
