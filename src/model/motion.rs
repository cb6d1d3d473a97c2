//! The motion that a scenario asks for.

use super::commands::NumberSource;
use crate::measure::spline::CubicSpline;
use crate::mechanism::motion::{
    Circle, Line, Motion, MultiSine, Quintic, SineTerm, Table, read_columns,
};
use crate::scenario::{self, JointPath, MotionTarget, Problem, Scenario, Term1};
use nalgebra::Vector2;
use std::sync::Arc;

/// Makes the path of a body or point that a scenario asks for; a table is read from its file.
pub(super) fn path(scenario: &Scenario) -> Result<Arc<dyn Motion>, Problem> {
    let of_point = matches!(scenario.target, Some(MotionTarget::Point(_)));
    let rest = || Line { start: Vector2::zeros(), velocity: Vector2::zeros(), phi: 0.0 };
    if scenario.mechanism.described().is_some() && scenario.target.is_none() {
        return Ok(Arc::new(rest()));
    }
    Ok(match &scenario.motion {
        scenario::Motion::Joints(_) | scenario::Motion::Rest => Arc::new(rest()),
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
            let table = Table::read(&path, of_point).map_err(|error| {
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

fn sines(terms: &[Term1]) -> Vec<[f64; 3]> {
    terms.iter().map(|term| [term.amplitude, term.frequency, term.phase]).collect()
}

/// The coordinate of one joint over time; where its motion does not say where it begins, at `start` (m, rad).
pub(super) fn joint(
    scenario: &Scenario,
    key: &str,
    joint: &str,
    path: &JointPath,
    start: f64,
) -> Result<NumberSource, Problem> {
    Ok(match path {
        JointPath::Line(line) => {
            NumberSource::Line { start: line.start.unwrap_or(start), velocity: line.velocity }
        }
        JointPath::Quintic(quintic) => NumberSource::Quintic {
            from: quintic.from.unwrap_or(start),
            to: quintic.to,
            time: quintic.time,
        },
        JointPath::Multisine(multisine) => NumberSource::Sines {
            center: multisine.center.unwrap_or(start),
            terms: sines(&multisine.terms),
        },
        JointPath::Table(table) => {
            let column = table.column.clone().unwrap_or_else(|| format!("q_{joint}"));
            NumberSource::Spline(column_of(scenario, &format!("{key}.file"), &table.file, &column)?)
        }
    })
}

/// A force or torque over time.
pub(super) fn force(
    scenario: &Scenario,
    key: &str,
    force: &scenario::Force,
) -> Result<NumberSource, Problem> {
    let constant = match force.terms.as_slice() {
        [] => NumberSource::Hold(force.value),
        terms => NumberSource::Sines { center: force.value, terms: sines(terms) },
    };
    let Some(file) = &force.file else { return Ok(constant) };
    let column = force.column.clone().unwrap_or_else(|| format!("F_{}", force.joint));
    let table = column_of(scenario, &format!("{key}.file"), file, &column)?;
    Ok(NumberSource::Sum(Box::new([constant, NumberSource::Spline(table)])))
}

/// The spline through one column of a file over its column `t`.
pub(super) fn column_of(
    scenario: &Scenario,
    key: &str,
    file: &str,
    column: &str,
) -> Result<CubicSpline, Problem> {
    let path = scenario.resolve(file);
    let columns = read_columns(&path, &["t", column]).map_err(|error| {
        scenario.problem(
            key,
            format!("{}: {error}", path.display()),
            format!(
                "expected a CSV file with the columns t,{column}; a relative name starts at the scenario \
                 file's folder"
            ),
        )
    })?;
    // Two names in, one spline over the first out.
    let none = || CubicSpline::natural(&[0.0, 1.0], &[0.0, 0.0]);
    Ok(columns.into_iter().next().unwrap_or_else(none))
}
