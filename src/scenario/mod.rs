//! Scenario files: the text in which a user describes a machine, its motion and a simulation.
//!
//! A scenario is TOML; every key has a default but `mechanism.kind`. [`Scenario::load`] reads one
//! (or the built-in default), applies `--set PATH=VALUE` overrides, and either returns a scenario
//! whose every number makes sense by itself, or says what is wrong, where (file and line, or which
//! `--set`), and what would be right. What needs the mechanism to judge (reach, singularities,
//! step against stiffness) is judged later, by way of [`Scenario::problem`].
//!
//! `reading` makes sections of a text, `sections` says what they are, `validate` what is wrong with them; `write`, `annotate` and
//! `schema` are texts of them again. SI units throughout: m, kg, s, N, rad.

mod annotate;
mod problem;
mod reading;
mod schema;
mod sections;
#[cfg(test)]
mod tests;
mod validate;
mod write;

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

pub use annotate::annotated;
pub use problem::{Location, Problem, Problems};
pub use schema::schema;
pub use sections::*;

use crate::effects::Setting;
use crate::measure::bounded;
use reading::document::{Document, Origins};

/// The text of the scenario that is used when no file is given.
pub const DEFAULT_TOML: &str = include_str!("../../assets/default.toml");

/// What stands for the file's name in messages about [`DEFAULT_TOML`].
const DEFAULT_SOURCE: &str = "built-in default";

/// Fixed step of the physics engine's own contacts where none is given, s: short against the time
/// that journals of the paper's machine take from hit to hit.
const NATIVE_STEP: f64 = 1e-5;

/// Clearance in m of machines with a kind where none is given: the paper's.
const PAPER_CLEARANCE: f64 = 5e-4;

/// The text of a scenario, read once: however many variants are made of it, all are made of the same.
///
/// ```
/// use freeplay::scenario::Source;
///
/// let source = Source::read(None)?;
/// let runs: Vec<_> = ["1e-4", "2e-4"].map(|c| source.scenario(&[format!("joints.clearance={c}")])).into();
/// assert!(runs.iter().zip([1e-4, 2e-4]).all(|(run, c)| run.as_ref().is_ok_and(|run| run.clearance(0) == c)));
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
#[derive(Debug, Clone)]
pub struct Source {
    text: String,
    name: String,
    folder: PathBuf,
}

impl Source {
    /// Reads the scenario file at `path`, or takes the built-in default.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read(path: Option<&Path>) -> Result<Source, Problems> {
        let Some(path) = path else {
            let (text, name) = (DEFAULT_TOML.to_owned(), DEFAULT_SOURCE.to_owned());
            return Ok(Source { text, name, folder: PathBuf::new() });
        };
        let name = path.display().to_string();
        let text = bounded::text(path, bounded::SCENARIO).map_err(|error| Problem {
            path: String::new(),
            message: format!("cannot be read: {error}"),
            help: help_of_unreadable(path),
            location: Location::File { name: name.clone(), line: None, column: None },
        })?;
        Ok(Source { text, name, folder: path.parent().unwrap_or(Path::new("")).to_owned() })
    }

    /// A text in memory; messages call it `name`, and relative files in it are sought in `folder`.
    pub fn of(text: &str, name: &str, folder: &Path) -> Source {
        Source { text: text.to_owned(), name: name.to_owned(), folder: folder.to_owned() }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What messages call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where relative files in it are sought.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The scenario, with `PATH=VALUE` overrides applied in their order.
    ///
    /// # Errors
    /// Everything wrong with the text and the overrides.
    pub fn scenario(&self, sets: &[String]) -> Result<Scenario, Problems> {
        let mut scenario = Scenario::from_text(&self.text, &self.name, sets)?;
        scenario.folder.clone_from(&self.folder);
        Ok(scenario)
    }
}

/// What would be right in place of a file that cannot be read: of a folder with a result, the scenario in it.
fn help_of_unreadable(path: &Path) -> String {
    let inside = path.join("scenario.toml");
    if inside.is_file() {
        return format!("a result's scenario is the file `{}`", inside.display());
    }
    "a scenario is a text file in TOML".to_owned()
}

/// A validated scenario: what the file and the overrides say, the rest filled with defaults.
///
/// ```
/// use freeplay::scenario::Scenario;
///
/// let tight = Scenario::load(None, &["joints.clearance=1e-4".to_owned()])?;
/// assert_eq!(tight.clearance(0), 1e-4);
/// let again = Scenario::from_text(&tight.to_toml(), "again.toml", &[])?;
/// assert_eq!(again.hash(), tight.hash(), "a scenario written is the same scenario read");
/// let problems = Scenario::load(None, &["joints.clearance=-1".to_owned()]).unwrap_err();
/// assert_eq!(problems.0[0].path, "joints.clearance");
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
#[derive(Debug, Clone)]
pub struct Scenario {
    /// What the results are called. Default "default".
    pub name: String,
    /// Seed of all random numbers (noise that `record` adds, random values of a sweep; a run draws none), 0 to 2⁶³ − 1 (the range of TOML). Default 1: any would do, as
    /// long as it is the same each time.
    pub seed: u64,
    /// `[mechanism]`, or the sections that describe one.
    pub mechanism: Mechanism,
    /// `[legs]`
    pub legs: Legs,
    /// `[joints]`
    pub joints: Joints,
    /// `[contact]`
    pub contact: ContactKeys,
    /// `[native]`
    pub native: Native,
    /// `[drive]`: all drives, or those that a described machine's `[[drive]]`s leave out.
    pub drive: Drive,
    /// `[environment]`
    pub environment: Environment,
    /// `[sensors]`; absent unless a rig declares its instruments.
    pub sensors: Option<Sensors>,
    /// `[columns]`; absent unless a rig says what its logs' columns are.
    pub columns: Option<Columns>,
    /// `[motion]`
    pub motion: Motion,
    /// What a described machine's `[motion]` moves.
    pub target: Option<MotionTarget>,
    /// `[simulation]`
    pub simulation: Simulation,
    /// `[[effect]]`, any number of them: what acts on the machine beside what is declared above.
    pub effects: Vec<Setting>,
    folder: PathBuf,
    origins: Origins,
    /// Sections that are there and mean nothing to this machine.
    unused: Vec<&'static str>,
}

/// Complaints about keys that several overrides give a value: nobody knows which one is meant.
fn set_twice(sets: &[String]) -> Vec<Problem> {
    let parts = |set: &String| {
        let (path, value) = set.split_once('=')?;
        Some([path, value].map(|part| part.trim().to_owned()))
    };
    let given: Vec<[String; 2]> = sets.iter().filter_map(parts).collect();
    let complain = |(i, [path, value]): (usize, &[String; 2])| {
        let [_, before] = given[..i].iter().find(|[earlier, _]| earlier == path)?;
        Some(Problem {
            path: path.clone(),
            message: format!("is given twice, as {before} and as {value}"),
            help: "give it once (--duration, --engine and --parameters set keys, too)".to_owned(),
            location: Location::Set { path: path.clone() },
        })
    };
    given.iter().enumerate().filter_map(complain).collect()
}

impl Scenario {
    /// Reads the scenario file at `path`, or the built-in default, with `PATH=VALUE` overrides
    /// applied in their order.
    ///
    /// # Errors
    /// Everything wrong with the file and the overrides.
    pub fn load(path: Option<&Path>, sets: &[String]) -> Result<Scenario, Problems> {
        Source::read(path)?.scenario(sets)
    }

    /// The same from a text in memory; messages call it `source`, and relative files in it are
    /// sought in the working directory.
    ///
    /// # Errors
    /// Everything wrong with the text and the overrides.
    pub fn from_text(text: &str, source: &str, sets: &[String]) -> Result<Scenario, Problems> {
        let mut document = Document::parse(text, source)?;
        let mut refused = set_twice(sets);
        refused.extend(sets.iter().filter_map(|assignment| document.set(assignment).err()));
        if !refused.is_empty() {
            return Err(Problems(refused));
        }
        let scenario = reading::read::scenario(document)?;
        scenario.validate()?;
        Ok(scenario)
    }

    /// A file named in the scenario: relative names are relative to the scenario file.
    pub fn resolve(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// The fixed step or the tolerance that was given, or what suits the contact law: the physics
    /// engine's own contacts have no error estimate, so `native` takes a fixed step.
    pub fn step_control(&self) -> StepControl {
        let simulation = &self.simulation;
        if self.contact.law == Law::Native && simulation.tolerance.is_none() {
            StepControl::Fixed(simulation.step.unwrap_or(NATIVE_STEP))
        } else {
            simulation.step_control()
        }
    }

    /// Where `[columns]` says that the time of recordings stands; none where nothing is said.
    pub fn time_column(&self) -> Option<crate::measure::log::ColumnSource> {
        self.columns.as_ref()?.source("t")
    }

    /// Whether the text gives a section as a list.
    pub(crate) fn is_list(&self, section: &str) -> bool {
        self.origins.has(&format!("{section}.0"))
    }

    /// The names of all files that the scenario refers to.
    pub fn files(&self) -> Vec<String> {
        self.clone().files_mut().into_iter().map(|file| file.clone()).collect()
    }

    fn files_mut(&mut self) -> Vec<&mut String> {
        let mut files: Vec<&mut String> = Vec::new();
        match &mut self.motion {
            Motion::Table(table) => files.push(&mut table.file),
            Motion::Joints(joints) => {
                files.extend(joints.iter_mut().filter_map(|joint| match &mut joint.path {
                    JointPath::Table(table) => Some(&mut table.file),
                    _ => None,
                }));
            }
            _ => {}
        }
        if let Mechanism::Described(described) = &mut self.mechanism {
            files.extend(described.drives.iter_mut().filter_map(|drive| match drive {
                JointDrive::Force(force) => force.file.as_mut(),
                _ => None,
            }));
        }
        files
    }

    /// A complaint about the key `path` that says where the key was written.
    pub fn problem(
        &self,
        path: &str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Problem {
        Problem {
            path: path.to_owned(),
            message: message.into(),
            help: help.into(),
            location: self.origins.locate(path),
        }
    }

    /// Radial clearance in m of revolute joint `index` of a machine with a kind: as given, or that of the
    /// paper's machine.
    pub fn clearance(&self, index: usize) -> f64 {
        self.joints.clearance.as_ref().map_or(PAPER_CLEARANCE, |values| values.at(index))
    }

    /// The same scenario about a machine that describes itself.
    pub fn with_described(
        &self,
        described: Described,
        motion: Motion,
        target: Option<MotionTarget>,
    ) -> Scenario {
        let mechanism = Mechanism::Described(Box::new(described));
        Scenario { mechanism, motion, target, ..self.clone() }
    }

    /// The path that an override gave a value, if one did: `key`, or one in the section of that name.
    pub(crate) fn set_by_override<'a>(&'a self, key: &'a str) -> Option<&'a str> {
        let itself = matches!(self.origins.locate(key), Location::Set { path } if path == key);
        if itself { Some(key) } else { self.origins.set_in(key) }
    }

    /// What is there and has no meaning for this machine; what the built-in default says beside it is nobody's
    /// mistake.
    pub fn unused(&self) -> Vec<Problem> {
        let unused = |section: &&str| {
            let path = self.origins.set_in(section).unwrap_or(section);
            self.problem(
                path,
                "is not used: it means nothing to this machine",
                "take it out, or see `freeplay expand` for the sections of this machine",
            )
        };
        let by_user = |problem: &Problem| !matches!(&problem.location, Location::File { name, .. } if name == DEFAULT_SOURCE);
        self.unused.iter().map(unused).filter(by_user).collect()
    }

    /// The scenario as TOML with every default filled in. It loads back to the same scenario from
    /// any folder, and two files that say the same give the same text. Left out is only what has
    /// no value: `[sensors]` that are not there, and `contact.stiffness` when it follows from E,
    /// ν and the radii.
    pub fn to_toml(&self) -> String {
        write::text(self)
    }

    /// The same for a folder that holds copies of the files that the scenario reads: its text, and the files with the
    /// names of their copies. The folder can be carried anywhere.
    pub fn to_toml_beside_files(&self) -> (String, Vec<(PathBuf, String)>) {
        let files = self.files();
        let names: Vec<String> = (1..=files.len()).map(|i| format!("table-{i}.csv")).collect();
        let text = write::text_with_files(self, &names);
        let sources = files.iter().map(|file| self.resolve(file));
        (text, sources.zip(names).collect())
    }

    /// The same for a folder in which the files that the scenario reads have these names, in the order of
    /// [`Scenario::files`].
    pub fn to_toml_with_files(&self, names: &[String]) -> String {
        write::text_with_files(self, names)
    }

    /// SHA-256 of [`Scenario::to_toml`] in hexadecimal: the same for files that mean the same.
    pub fn hash(&self) -> String {
        Sha256::digest(self.to_toml()).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
