//! What steps a machine, and how the time step is chosen.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the time step is chosen.
///
/// ```
/// use freeplay::engine::StepControl;
///
/// let control = StepControl::Tolerance(1e-6);
/// assert_eq!((control.tolerance(), control.step()), (Some(1e-6), None));
/// assert_eq!(StepControl::Direct(1e-6).with_tolerance_times(0.5), StepControl::Direct(5e-7));
/// assert_eq!(StepControl::Fixed(1e-5).with_tolerance_times(0.5), StepControl::Fixed(1e-5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// A fixed step of at most so many seconds: the longest that divides the row interval.
    Fixed(f64),
    /// As long as this tolerance allows: the velocity error of one step in m/s, in a machine whose
    /// joints have 0.5 mm of clearance or more; in proportion less where they have less, down to a
    /// fiftieth at 10 µm.
    Tolerance(f64),
    /// The same tolerance without the physics engine: the equations of motion integrated directly, down to a fifth of it at
    /// 0.1 mm and below, where longer steps err no more.
    Direct(f64),
}

impl StepControl {
    /// The fixed step in s, if it is one.
    pub fn step(self) -> Option<f64> {
        match self {
            StepControl::Fixed(step) => Some(step),
            StepControl::Tolerance(_) | StepControl::Direct(_) => None,
        }
    }

    /// The velocity error of one step in m/s that it allows, if it looks at errors.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            StepControl::Fixed(_) => None,
            StepControl::Tolerance(tolerance) | StepControl::Direct(tolerance) => Some(tolerance),
        }
    }

    /// The same with the tolerance times `factor`; a fixed step stays.
    pub fn with_tolerance_times(self, factor: f64) -> Self {
        match self {
            StepControl::Fixed(step) => StepControl::Fixed(step),
            StepControl::Tolerance(tolerance) => StepControl::Tolerance(tolerance * factor),
            StepControl::Direct(tolerance) => StepControl::Direct(tolerance * factor),
        }
    }
}

/// What steps a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// The physics engine: every step is one of rapier's.
    #[default]
    Rapier,
    /// The mechanism's own equations of motion, integrated directly.
    Direct,
}

impl Engine {
    /// Whether it is the one that nobody has to ask for.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Speed in m/s at which journals are taken to hit where the step is checked beforehand: hits in
/// the paper's machine come at 0.1–0.3 m/s, and the longest step falls with its fifth root only.
pub const TYPICAL_IMPACT_SPEED: f64 = 0.2;
