//! `[simulation]`: how long, how finely, how exactly.

use crate::engine::{Engine, StepControl};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a scenario steps that asks for nothing: 1e-5 m/s of velocity error a step. It follows the
/// default machine to 4e-8 m over 50 ms, and reproduces the statistics of an independent solver for
/// clearances from 1 mm to 10 nm; ten times looser does not.
const DEFAULT_TOLERANCE: f64 = 1e-5;

/// Default of `settle`, s: the largest hits of the centred start come within 40 ms.
const DEFAULT_SETTLE: f64 = 0.2;

/// Time span, output and stepping.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Simulation {
    /// Simulated time, s. Default 1: one turn of the default circle.
    pub duration: f64,
    /// Time between two rows of output, s. Default 5e-4: resolves the rattle's forces up to 1 kHz.
    pub output_interval: f64,
    /// Start left out of peaks, rms and fractions, s. Default 0.2, at most half of the duration: the
    /// largest hits of the centred start come within 40 ms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle: Option<f64>,
    /// What steps the machine. Default: the physics engine.
    #[serde(skip_serializing_if = "Engine::is_default")]
    pub engine: Engine,
    /// Fixed step, s, in place of `tolerance`. Default none: steps follow the tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Velocity error that one step may make, m/s, for clearances of 0.5 mm and more, in proportion
    /// less for smaller ones, down to a fiftieth at 10 µm; with the engine `direct` down to a fifth at
    /// 0.1 mm. Default 1e-5, unless `step` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

impl Default for Simulation {
    fn default() -> Self {
        Simulation {
            duration: 1.0,
            output_interval: 5e-4,
            settle: None,
            engine: Engine::Rapier,
            step: None,
            tolerance: None,
        }
    }
}

impl Simulation {
    /// Start left out of peaks, rms and fractions, s, in which the journals find their rings: as
    /// given, or 0.2 but at most half the duration, so that a short run still has results.
    pub fn settle(&self) -> f64 {
        self.settle.unwrap_or(DEFAULT_SETTLE.min(self.duration / 2.0))
    }

    /// The fixed step or the tolerance that was given (never both: loading refuses that), or the
    /// default, a tolerance of 1e-5 m/s.
    pub fn step_control(&self) -> StepControl {
        let tolerance = self.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        match (self.step, self.engine) {
            (Some(step), _) => StepControl::Fixed(step),
            (None, Engine::Rapier) => StepControl::Tolerance(tolerance),
            (None, Engine::Direct) => StepControl::Direct(tolerance),
        }
    }

    pub(in crate::scenario) fn set_step_control(&mut self, control: StepControl) {
        (self.step, self.tolerance) = (control.step(), control.tolerance());
    }
}
