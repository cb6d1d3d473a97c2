//! The motion that a scenario asks for.

use crate::mechanism::motion::{Circle, Line, Motion, MultiSine, Quintic, SineTerm, Table};
use crate::scenario::{self, Problem, Scenario};
use std::sync::Arc;

/// Makes the motion of a scenario; a table is read from its file.
pub(super) fn of(scenario: &Scenario) -> Result<Arc<dyn Motion>, Problem> {
    Ok(match &scenario.motion {
        scenario::Motion::Circle(m) => Arc::new(Circle {
            center: m.center.into(),
            radius: m.radius,
            period: m.period,
            phase: m.phase,
            phi: m.phi,
        }),
        scenario::Motion::Line(m) => {
            Arc::new(Line { start: m.start.into(), velocity: m.velocity.into(), phi: m.phi })
        }
        scenario::Motion::Quintic(m) => {
            Arc::new(Quintic { from: m.from.into(), to: m.to.into(), time: m.time })
        }
        scenario::Motion::Multisine(m) => {
            let term = |term: &scenario::Term| SineTerm {
                amplitude: term.amplitude.into(),
                frequency: term.frequency,
                phase: term.phase,
            };
            Arc::new(MultiSine {
                center: m.center.into(),
                terms: m.terms.iter().map(term).collect(),
            })
        }
        scenario::Motion::Table(m) => {
            let path = scenario.resolve(&m.file);
            let table = Table::read(&path).map_err(|error| {
                scenario.problem(
                    "motion.file",
                    format!("{}: {error}", path.display()),
                    "expected a CSV file with the columns t,x,y,phi (s, m, m, rad); a relative \
                     name starts at the scenario file's folder",
                )
            })?;
            Arc::new(table)
        }
    })
}
