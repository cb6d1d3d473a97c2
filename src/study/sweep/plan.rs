//! A sweep before it is run: every run's scenario, checked; and one of its runs made.

use super::doubts::doubts;
use super::rows::record::{hexadecimal, sha256};
use super::rows::row;
use super::{Design, Identity, Shard, Vary};
use crate::measure::bounded;
use crate::model::SharedIdeal;
use crate::scenario::{Location, Problem, Scenario, Source};
use crate::simulate::unacting;
use crate::simulate::{Machine, Provenance, Severity, assemble, findings, listed_until};
use crate::study::StudyError;
use rayon::prelude::*;
use sha2::{Digest, Sha256};
use std::io::Read as _;
use std::sync::atomic::AtomicBool;

/// A sweep whose every run has a scenario that makes sense by itself.
///
/// ```
/// use freeplay::scenario::Source;
/// use freeplay::study::sweep::{Plan, Shard};
/// use std::sync::atomic::AtomicBool;
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let vary = ["joints.clearance=1e-4,2e-4".to_owned()];
/// let plan = Plan::new(Source::read(None)?, &sets, &vary, Shard::WHOLE)?;
/// assert_eq!(plan.identity().runs, 2);
/// let row = plan.row(1, &AtomicBool::new(false)).unwrap();
/// assert_eq!(row.len(), plan.identity().columns.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Plan {
    source: Source,
    sets: Vec<String>,
    base: Scenario,
    design: Design,
    identity: Identity,
    /// Columns of this machine's own.
    more: Vec<String>,
    shard: Shard,
    warnings: Vec<String>,
    /// The mark of each run ([`Plan::mark`]), once they were checked.
    marks: Vec<u64>,
    /// The machine without clearance, which most runs share.
    ideal: SharedIdeal,
}

/// What is known of a run beforehand.
struct Checked {
    /// SHA-256 of its scenario and the file that it reads.
    hash: String,
    /// Why the machine cannot do it.
    refused: Option<String>,
    /// What is doubtful about it.
    warning: Option<String>,
    /// Keys that were set or varied and that its machine does not look at, in words.
    idle: Vec<String>,
}

impl Plan {
    /// Plans the sweep of `source` with the overrides `sets` over the `PATH=…` of `vary`, of which
    /// this process is to run the part `shard`. Every run of every part is checked, on all threads.
    ///
    /// # Errors
    /// [`StudyError`] if a `--vary` makes no sense, a run's scenario is refused (unknown path, value
    /// out of range), or the machine can do none of the runs.
    pub fn new(
        source: Source,
        sets: &[String],
        vary: &[String],
        shard: Shard,
    ) -> Result<Plan, StudyError> {
        let mut plan = Self::unchecked(source, sets, vary, shard)?;
        plan.check()?;
        Ok(plan)
    }

    /// The same without a look at any run: for a worker that makes some runs of a plan that was checked
    /// elsewhere. It stands for no folder, as nothing says what its runs are.
    ///
    /// # Errors
    /// [`StudyError`] if the scenario or a `--vary` makes no sense.
    pub fn unchecked(
        source: Source,
        sets: &[String],
        vary: &[String],
        shard: Shard,
    ) -> Result<Plan, StudyError> {
        let base = source.scenario(sets)?;
        let varied = vary.iter().map(|text| Vary::parse(text)).collect::<Result<Vec<_>, _>>()?;
        let design = Design::new(varied, base.seed)?;
        let more = row::more(&base);
        let identity = Identity {
            provenance: Provenance::of(&base),
            seed: base.seed,
            vary: design.varied().iter().map(Vary::to_string).collect(),
            runs: design.runs(),
            columns: row::columns(design.varied(), &more),
            runs_hash: String::new(),
        };
        let sets = sets.to_vec();
        let (warnings, marks) = (Vec::new(), Vec::new());
        let ideal = SharedIdeal::default();
        Ok(Plan { source, sets, base, design, identity, more, shard, warnings, marks, ideal })
    }

    /// The scenario that is varied.
    pub fn base(&self) -> &Scenario {
        &self.base
    }

    /// What makes this sweep the one it is.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The part of it that this process is to run.
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// What is doubtful about its runs, or cannot be done, one line a kind.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The mark of run `run`: the beginning of the hash of its scenario and of the files that it reads. None of
    /// a run that does not exist, or of a plan that was not checked.
    pub fn mark(&self, run: usize) -> Option<u64> {
        self.marks.get(run).copied()
    }

    /// Makes run `run` without a folder: its row of the table. None once `stop` is true.
    pub fn row(&self, run: usize, stop: &AtomicBool) -> Option<Vec<String>> {
        Some(match self.machine(run) {
            Ok((scenario, mut machine)) => {
                let settle = scenario.simulation.settle();
                self.ideal.begin(&mut machine.ideal, machine.schedule, settle);
                let summary = listed_until(&scenario, &mut machine, stop, &mut |_, _, _| {});
                if summary.interrupted {
                    return None;
                }
                if summary.halted.is_none() {
                    self.ideal.end(machine.ideal);
                }
                row::of_summary(self.values(run), &summary, &self.more)
            }
            Err(reason) => row::refused(self.values(run), &reason, &self.more),
        })
    }

    /// [`Plan::row`] for somebody else's plan, who says what the run's mark is there.
    ///
    /// # Errors
    /// [`StudyError::Input`] where the run is another one here: a file that its scenario reads differs.
    pub fn row_of_mark(
        &self,
        run: usize,
        mark: u64,
        stop: &AtomicBool,
    ) -> Result<Option<Vec<String>>, StudyError> {
        let here = match self.checked(run) {
            Ok(checked) => mark_of(&checked.hash),
            Err(problem) => return Err(StudyError::input(self.in_words(&problem))),
        };
        if here != mark {
            return Err(StudyError::input(format!(
                "{} is not the same here and where the sweep was planned: a file that the scenario reads \
                 differs, or is not there; workers need the same files",
                self.name(run)
            )));
        }
        Ok(self.row(run, stop))
    }

    /// The value of each varied key in run `run`, as TOML.
    pub(super) fn values(&self, run: usize) -> Vec<String> {
        self.design.values(run)
    }

    /// The machine of run `run`, or in words why it cannot do what is asked.
    pub(super) fn machine(&self, run: usize) -> Result<(Scenario, Machine), String> {
        let scenario = self.scenario(run).map_err(|problem| self.in_words(&problem))?;
        let mut machine = assemble(&scenario).map_err(|problem| self.in_words(&problem))?;
        let found = findings(&scenario, &mut machine);
        match found.iter().find(|finding| finding.severity == Severity::Error) {
            Some(error) => Err(self.in_words(&error.problem)),
            None => Ok((scenario, machine)),
        }
    }

    fn scenario(&self, run: usize) -> Result<Scenario, Problem> {
        let values = self.values(run);
        let varied = self.design.varied().iter().zip(&values);
        let replaced = |set: &&String| {
            let path = set.split_once('=').map_or("", |(path, _)| path.trim());
            self.design.varied().iter().any(|vary| vary.path == path)
        };
        let mut sets: Vec<String> =
            self.sets.iter().filter(|set| !replaced(set)).cloned().collect();
        sets.extend(varied.map(|(vary, value)| format!("{}={value}", vary.path)));
        // One complaint is enough: the runs share their mistakes.
        self.source.scenario(&sets).map_err(|mut problems| problems.0.swap_remove(0))
    }

    /// Checks every run, and notes what they are.
    fn check(&mut self) -> Result<(), StudyError> {
        let runs = self.design.runs();
        let checked: Vec<Result<Checked, Problem>> =
            (0..runs).into_par_iter().map(|run| self.checked(run)).collect();
        let mut hash = Sha256::new();
        let (mut refused, mut warned) = (Vec::new(), Vec::new());
        let mut idle: Option<Vec<String>> = None;
        for (run, checked) in checked.into_iter().enumerate() {
            let checked = checked.map_err(|problem| {
                StudyError::input(format!("{} ({})", self.in_words(&problem), self.name(run)))
            })?;
            hash.update(&checked.hash);
            self.marks.push(mark_of(&checked.hash));
            if checked.refused.is_none() {
                // What acts in one run is no idle key.
                let here = |key: &String| checked.idle.contains(key);
                let left = idle.take().map(|idle| idle.into_iter().filter(here).collect());
                idle = Some(left.unwrap_or_else(|| checked.idle.clone()));
            }
            refused.extend(checked.refused.map(|reason| (run, reason)));
            warned.extend(checked.warning.map(|warning| (run, warning)));
        }
        self.identity.runs_hash = hexadecimal(&hash.finalize());
        self.warnings.extend(doubts(self.design.varied(), &self.sets, &self.base));
        self.warnings.extend(idle.unwrap_or_default());
        if let Some((run, reason)) = refused.first() {
            let name = self.name(*run);
            if refused.len() == runs {
                return Err(StudyError::input(format!(
                    "the machine can do none of the {runs} runs: {reason} ({name})"
                )));
            }
            let count = refused.len();
            self.warnings.push(format!(
                "{count} of {runs} runs are refused and get a row without figures: {reason} ({name})"
            ));
        }
        if let Some((run, warning)) = warned.first() {
            let (count, name) = (warned.len(), self.name(*run));
            self.warnings.push(format!("{count} of {runs} runs: {warning} ({name})"));
        }
        Ok(())
    }

    fn checked(&self, run: usize) -> Result<Checked, Problem> {
        let scenario = self.scenario(run)?;
        let mut text = scenario.to_toml();
        let mut assembled = assemble(&scenario);
        for file in scenario.files() {
            // A file that cannot be read is among the reasons that `assemble` finds.
            let mut content = Vec::new();
            let file = bounded::open_plain(&scenario.resolve(&file), bounded::TABLE);
            let _unread = file.and_then(|mut file| file.read_to_end(&mut content));
            text += &sha256(&content);
        }
        let hash = sha256(text.as_bytes());
        let (found, idle) = match &mut assembled {
            Ok(machine) => (findings(&scenario, machine), unacting(&scenario, machine)),
            Err(problem) => {
                let refused = Some(self.in_words(problem));
                return Ok(Checked { hash, refused, warning: None, idle: Vec::new() });
            }
        };
        let first = |severity| {
            let finding = found.iter().find(|finding| finding.severity == severity)?;
            Some(self.in_words(&finding.problem))
        };
        let idle = idle.iter().map(|finding| self.in_words(&finding.problem)).collect();
        let (refused, warning) = (first(Severity::Error), first(Severity::Warning));
        Ok(Checked { hash, refused, warning, idle })
    }

    /// A complaint in the words of somebody who wrote `--vary`: to the scenario it is a `--set`.
    fn in_words(&self, problem: &Problem) -> String {
        let text = problem.to_string();
        match &problem.location {
            Location::Set { path } if self.design.varied().iter().any(|v| v.path == *path) => {
                text.replacen("--set", "--vary", 1)
            }
            _ => text,
        }
    }

    /// Run `run` in words.
    fn name(&self, run: usize) -> String {
        let values = self.values(run);
        let varied = self.design.varied().iter().zip(&values);
        let values: Vec<String> =
            varied.map(|(vary, value)| format!("{}={value}", vary.path)).collect();
        format!("run {} of {}: {}", run + 1, self.design.runs(), values.join(" "))
    }
}

/// The first 64 bits of a hash in hexadecimal.
fn mark_of(hash: &str) -> u64 {
    u64::from_str_radix(&hash[..16], 16).unwrap_or_default()
}
