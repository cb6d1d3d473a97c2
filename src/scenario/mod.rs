//! Scenario files: the text in which a user describes a machine, its motion and a simulation.
//!
//! A scenario is TOML; every key has a default but `mechanism.kind`. [`Scenario::load`] reads one
//! (or the built-in default), applies `--set PATH=VALUE` overrides, and either returns a scenario
//! whose every number makes sense by itself, or says what is wrong, where (file and line, or which
//! `--set`), and what would be right. What needs the mechanism to judge (reach, singularities,
//! step against stiffness) is judged later, by way of [`Scenario::problem`].
//!
//! SI units throughout: m, kg, s, N, rad.

mod document;
mod problem;
mod reader;
mod sections;
#[cfg(test)]
mod tests;
mod validate;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

pub use problem::{Location, Problem, Problems};
pub use sections::*;

use crate::effects::{Setting, Wrong};
use document::{Document, Origins};
use reader::Reader;

/// The text of the scenario that is used when no file is given.
pub const DEFAULT_TOML: &str = include_str!("../../assets/default.toml");

/// What stands for the file's name in messages about [`DEFAULT_TOML`].
const DEFAULT_SOURCE: &str = "built-in default";

/// Fixed step of the physics engine's own contacts where none is given, s: short against the time
/// that journals of the paper's machine take from hit to hit.
const NATIVE_STEP: f64 = 1e-5;

/// The text of a scenario, read once: however many variants are made of it, all are made of the same.
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
        let text = std::fs::read_to_string(path).map_err(|error| Problem {
            path: String::new(),
            message: format!("cannot be read: {error}"),
            help: "a scenario is a text file in TOML".to_owned(),
            location: Location::File { name: name.clone(), line: None, column: None },
        })?;
        Ok(Source { text, name, folder: path.parent().unwrap_or(Path::new("")).to_owned() })
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

/// A validated scenario: what the file and the overrides say, the rest filled with defaults.
#[derive(Debug, Clone, Serialize)]
pub struct Scenario {
    /// What the results are called. Default "default".
    pub name: String,
    /// Seed of all random numbers, 0 to 2⁶³ − 1 (the range of TOML). Default 1: any would do, as
    /// long as it is the same each time.
    pub seed: u64,
    /// `[mechanism]`
    pub mechanism: Mechanism,
    /// `[legs]`
    pub legs: Legs,
    /// `[joints]`
    pub joints: Joints,
    /// `[contact]`
    pub contact: Contact,
    /// `[native]`
    pub native: Native,
    /// `[drive]`
    pub drive: Drive,
    /// `[environment]`
    pub environment: Environment,
    /// `[sensors]`; absent unless a rig declares its instruments.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensors: Option<Sensors>,
    /// `[columns]`; absent unless a rig says what its logs' columns are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub columns: Option<Columns>,
    /// `[motion]`
    pub motion: Motion,
    /// `[simulation]`
    pub simulation: Simulation,
    /// `[[effect]]`, any number of them: what acts on the machine beside what is declared above.
    #[serde(rename = "effect", skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<Setting>,
    #[serde(skip)]
    folder: PathBuf,
    #[serde(skip)]
    origins: Origins,
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
        let refused: Vec<Problem> =
            sets.iter().filter_map(|assignment| document.set(assignment).err()).collect();
        if !refused.is_empty() {
            return Err(Problems(refused));
        }
        let scenario = read(document)?;
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

    /// The scenario as TOML with every default filled in. It loads back to the same scenario from
    /// any folder, and two files that say the same give the same text. Left out is only what has
    /// no value: `[sensors]` that are not there, and `contact.stiffness` when it follows from E,
    /// ν and the radii.
    pub fn to_toml(&self) -> String {
        let mut full = self.clone();
        if let Mechanism::ThreeRpr(machine) = &mut full.mechanism {
            machine.platform_inertia = Some(machine.platform_inertia());
        }
        if self.drive.mode == DriveMode::Sampled {
            full.drive.sampled = Some(self.drive.sampled());
        }
        full.simulation.settle = Some(full.simulation.settle());
        full.simulation.set_step_control(self.step_control());
        full.effects = self.effects.iter().map(Setting::filled).collect();
        if let Motion::Table(table) = &mut full.motion {
            let file = self.resolve(&table.file);
            let file = std::path::absolute(&file).unwrap_or(file);
            table.file = file.to_string_lossy().into_owned();
        }
        // No input makes this fail: no field has a type that TOML cannot express.
        toml::to_string(&full).expect("tables, lists, numbers and words are TOML")
    }

    /// SHA-256 of [`Scenario::to_toml`] in hexadecimal: the same for files that mean the same.
    pub fn hash(&self) -> String {
        Sha256::digest(self.to_toml()).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The sections of a file before each is read by itself.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct TopLevel {
    name: String,
    seed: u64,
    mechanism: toml::Table,
    legs: toml::Table,
    joints: toml::Table,
    contact: toml::Table,
    native: toml::Table,
    drive: toml::Table,
    environment: toml::Table,
    sensors: Option<toml::Table>,
    columns: Option<toml::Table>,
    motion: toml::Table,
    simulation: toml::Table,
    effect: Vec<toml::Table>,
}

impl Default for TopLevel {
    fn default() -> Self {
        TopLevel {
            name: "default".to_owned(),
            seed: 1,
            mechanism: toml::Table::new(),
            legs: toml::Table::new(),
            joints: toml::Table::new(),
            contact: toml::Table::new(),
            native: toml::Table::new(),
            drive: toml::Table::new(),
            environment: toml::Table::new(),
            sensors: None,
            columns: None,
            motion: toml::Table::new(),
            simulation: toml::Table::new(),
            effect: Vec::new(),
        }
    }
}

/// Gives the document its meaning: keys and types, not yet the sense of the values.
fn read(document: Document) -> Result<Scenario, Problems> {
    let mut reader = Reader::new(&document.origins);
    for (path, number) in document.not_finite() {
        reader.complain(&path, format!("is {number}"), "expected a finite number".to_owned());
    }
    let top: TopLevel = reader.read("", document.table);
    let scenario = Scenario {
        name: top.name,
        seed: top.seed,
        mechanism: read_mechanism(&mut reader, top.mechanism),
        legs: reader.read("legs", top.legs),
        joints: reader.read("joints", top.joints),
        contact: reader.read("contact", top.contact),
        native: reader.read("native", top.native),
        drive: reader.read("drive", top.drive),
        environment: reader.read("environment", top.environment),
        sensors: top.sensors.map(|table| reader.read("sensors", table)),
        columns: top.columns.map(|table| reader.read("columns", table)),
        motion: read_motion(&mut reader, top.motion),
        simulation: reader.read("simulation", top.simulation),
        effects: read_effects(&mut reader, top.effect),
        folder: PathBuf::new(),
        origins: document.origins.clone(),
    };
    if reader.problems.is_empty() { Ok(scenario) } else { Err(Problems(reader.problems)) }
}

// serde's own tagged enums would lose the path of a wrong key, hence the dispatch by hand.
fn read_mechanism(reader: &mut Reader<'_>, mut table: toml::Table) -> Mechanism {
    if !table.contains_key("kind") {
        reader.complain(
            "mechanism.kind",
            "is missing".to_owned(),
            "write kind = \"3rpr\" under [mechanism]".to_owned(),
        );
    }
    match reader.take_kind("mechanism", &mut table, &Mechanism::KINDS) {
        Some("drive-stage") => Mechanism::DriveStage(reader.read("mechanism", table)),
        Some("pendulum") => Mechanism::Pendulum(reader.read("mechanism", table)),
        _ => Mechanism::ThreeRpr(reader.read("mechanism", table)),
    }
}

fn read_effects(reader: &mut Reader<'_>, tables: Vec<toml::Table>) -> Vec<Setting> {
    let mut effects = Vec::new();
    for (i, mut table) in tables.into_iter().enumerate() {
        let section = format!("effect.{i}");
        let Some(kind) = table.remove("kind") else {
            let help = "write kind = \"…\"; `freeplay effects` lists them".to_owned();
            reader.complain(&format!("{section}.kind"), "is missing".to_owned(), help);
            continue;
        };
        let name = kind.as_str().map_or_else(|| kind.to_string(), str::to_owned);
        match Setting::from_table(&name, &table) {
            Ok(setting) => effects.push(setting),
            Err(Wrong { key, message, help }) => {
                reader.complain(&format!("{section}.{key}"), message, help);
            }
        }
    }
    effects
}

fn read_motion(reader: &mut Reader<'_>, mut table: toml::Table) -> Motion {
    let given = table.contains_key("kind");
    match reader.take_kind("motion", &mut table, &Motion::KINDS) {
        Some("line") => Motion::Line(reader.read("motion", table)),
        Some("quintic") => Motion::Quintic(reader.read("motion", table)),
        Some("multisine") => Motion::Multisine(reader.read("motion", table)),
        Some("table") => Motion::Table(reader.read("motion", table)),
        // An unknown kind is reported; its keys belong to nothing that could be checked.
        None if given => Motion::default(),
        _ => Motion::Circle(reader.read("motion", table)),
    }
}
