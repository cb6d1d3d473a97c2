//! What can be wrong or doubtful about a scenario, and how bad it is.

use crate::scenario::Problem;
use std::fmt;

/// How bad a [`Finding`] is.
///
/// [`Finding`] has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The results would be worthless: nothing is simulated.
    Error,
    /// The results need care.
    Warning,
}

/// Something wrong or doubtful about a scenario, with the key that it hangs on.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::simulate::{Severity, findings};
///
/// let far = Scenario::load(None, &["motion.radius=0.5".to_owned()])?;
/// let found = findings(&far, &mut assemble(&far)?);
/// assert!(found.iter().any(|finding| finding.severity == Severity::Error), "legs are not that long");
/// let paper = Scenario::load(None, &[])?;
/// assert!(findings(&paper, &mut assemble(&paper)?).iter().all(|finding| finding.severity != Severity::Error));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it stops a run.
    pub severity: Severity,
    /// What, where, and what would be right.
    pub problem: Problem,
}

impl Finding {
    /// A finding that stops a run.
    pub fn error(problem: Problem) -> Self {
        Self { severity: Severity::Error, problem }
    }

    /// A finding that does not.
    pub fn warning(problem: Problem) -> Self {
        Self { severity: Severity::Warning, problem }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{severity}: {}", self.problem)
    }
}
