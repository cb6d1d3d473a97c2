//! Two models, or two results of runs, held beside each other: what differs, and by how much more than chance.

mod models;
mod page;
mod result;
mod results;
mod series;

pub use models::{diff_models, simulated_time};
pub use result::{Diff, FigureRow};
pub use results::diff_results;

use super::run::SUMMARY_FILE;
use crate::results::SCENARIO_FILE;
use crate::scenario::{Problem, Scenario};
use crate::study::StudyError;
use std::path::{Path, PathBuf};

/// The JSON file by which a difference is known.
pub const DIFF_FILE: &str = "diff.json";

const TABLE_FILE: &str = "diff.csv";

/// One of the two.
#[derive(Debug)]
pub enum Side {
    /// The folder of a run, and the scenario that it ran.
    Result(PathBuf, Box<Scenario>),
    /// A scenario, such as a calibrated model.
    Model(Box<Scenario>),
}

impl Side {
    /// Reads a scenario file, or the folder of a run.
    ///
    /// # Errors
    /// What is wrong with the scenario, or a folder that holds no run.
    pub fn read(path: &Path, sets: &[String]) -> Result<Self, StudyError> {
        if !path.is_dir() {
            return Ok(Side::Model(Box::new(Scenario::load(Some(path), sets)?)));
        }
        for file in [SUMMARY_FILE, SCENARIO_FILE] {
            if !path.join(file).is_file() {
                let message = format!(
                    "`{}` holds no {file}: expected the folder of a `freeplay run`, or a scenario file",
                    path.display()
                );
                return Err(StudyError::Input(message));
            }
        }
        let scenario = Scenario::load(Some(&path.join(SCENARIO_FILE)), sets)?;
        Ok(Side::Result(path.to_owned(), Box::new(scenario)))
    }

    /// What was, or is to be, simulated.
    pub fn scenario(&self) -> &Scenario {
        match self {
            Side::Result(_, scenario) | Side::Model(scenario) => scenario,
        }
    }
}

/// A warning where the machines have unlike parts: figures of the one then say little of the other.
fn unlike(sides: &[Side; 2]) -> Result<Option<String>, StudyError> {
    let parts = |side: &Side| -> Result<[Vec<String>; 2], Problem> {
        let machine = crate::model::parts_of(side.scenario())?;
        let bodies = machine.bodies.into_iter().map(|body| body.name).collect();
        Ok([bodies, machine.actuators.into_iter().map(|drive| drive.name).collect()])
    };
    let [a, b] = [parts(&sides[0])?, parts(&sides[1])?];
    let listed = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    let found = ["bodies", "drives"].into_iter().zip(a.iter().zip(&b)).find(|(_, (a, b))| a != b);
    Ok(found.map(|(what, (a, b))| {
        let (a, b) = (listed(a), listed(b));
        format!("The machines are unlike: {what} of the first are {a}; of the second {b}. Figures of one name need not mean the same.")
    }))
}

/// A warning where other times count: sums, shares and quantiles over them then differ whatever the machines are.
fn unlike_times(sides: &[Side; 2]) -> Option<String> {
    let [a, b] = sides.each_ref().map(|side| {
        let simulation = &side.scenario().simulation;
        [simulation.settle(), simulation.duration]
    });
    (a != b).then(|| {
        format!(
            "The times that count are unlike: {} to {} s in the first, {} to {} s in the second (simulation.settle, \
             simulation.duration). Peaks, sums, shares and quantiles differ for that alone.",
            a[0], a[1], b[0], b[1]
        )
    })
}

/// A finished comparison of two.
#[derive(Debug)]
pub struct FinishedDiff {
    /// All figures.
    pub diff: Diff,
    /// The text of `diff.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}
