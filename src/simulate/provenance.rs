//! Where a result comes from.

use crate::engine::{Engine, RAPIER_VERSION};
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};

/// The first keys of every JSON file that a scenario's results are written into.
///
/// ```
/// use freeplay::scenario::Scenario;
/// use freeplay::simulate::Provenance;
///
/// let scenario = Scenario::load(None, &[])?;
/// let made_by = Provenance::of(&scenario);
/// assert_eq!((made_by.program.as_str(), made_by.scenario_hash), ("freeplay", scenario.hash()));
/// # Ok::<(), freeplay::scenario::Problems>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The program that wrote this: how a result is told from other files.
    pub program: String,
    /// Its version.
    pub version: String,
    /// Version of the physics engine underneath.
    pub rapier_version: String,
    /// What stepped the machine, where it was not the physics engine.
    #[serde(default, skip_serializing_if = "Engine::is_default")]
    pub engine: Engine,
    /// Name of the scenario.
    pub scenario_name: String,
    /// SHA-256 of the effective scenario, overrides included.
    pub scenario_hash: String,
}

impl Provenance {
    /// Of what this program makes of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            program: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            rapier_version: RAPIER_VERSION.to_owned(),
            engine: scenario.simulation.engine,
            scenario_name: scenario.name.clone(),
            scenario_hash: scenario.hash(),
        }
    }

    /// The same as (label, value) for a page, and `more` below. The page calls the scenario `what`
    /// ("rig", "model"), and may have it `beside` it as a file.
    pub fn lines<const N: usize>(
        &self,
        what: &str,
        beside: Option<&str>,
        more: [(&str, String); N],
    ) -> Vec<(String, String)> {
        let Self { program, version, rapier_version, engine, scenario_name, scenario_hash } = self;
        let stepped = match engine {
            Engine::Rapier => format!("on rapier2d-f64 {rapier_version}"),
            Engine::Direct => {
                "its equations of motion integrated directly, without the physics engine".to_owned()
            }
        };
        let (first, rest) = what.split_at(1);
        let name = beside.map_or_else(
            || scenario_name.clone(),
            |file| format!("{scenario_name} ({file} beside this page)"),
        );
        let lines = [
            ("Program".to_owned(), format!("{program} {version}, {stepped}")),
            (first.to_uppercase() + rest, name),
            (format!("SHA-256 of the {what}"), scenario_hash.clone()),
        ];
        let more = more.map(|(label, value)| (label.to_owned(), value));
        lines.into_iter().chain(more).collect()
    }
}
