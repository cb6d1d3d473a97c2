//! `sweep.json`: what sweep a folder belongs to, and how far it has come.

use crate::simulate::Provenance;
use crate::study::StudyError;
use crate::study::sweep::varied::design::MOST_RUNS;
use crate::study::sweep::{Shard, Vary};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Display;
use std::fs;
use std::path::Path;

/// The JSON file of a sweep, by which its folder is known.
pub const RECORD_FILE: &str = "sweep.json";

/// What makes two sweeps the same: then their rows agree to the last digit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// Program, versions, scenario that is varied.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of the random sample.
    pub seed: u64,
    /// What is varied, in the order of the columns.
    pub vary: Vec<String>,
    /// Number of runs, all shards together.
    pub runs: usize,
    /// Header of the table.
    pub columns: Vec<String>,
    /// SHA-256 of the scenarios of all runs and of the files that they read.
    pub runs_hash: String,
}

/// What `sweep.json` holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    /// Which sweep.
    #[serde(flatten)]
    pub identity: Identity,
    /// Which part of it, `1/1` for all of it.
    pub shard: Shard,
    /// Runs of this part.
    pub runs_of_shard: usize,
    /// Rows of them that are there.
    pub finished: usize,
    /// Runs that reached their end.
    pub ok: usize,
    /// Runs that broke down on the way.
    pub halted: usize,
    /// Runs that the machine cannot do.
    pub refused: usize,
    /// Whether all rows of this part are in the table.
    pub complete: bool,
    /// SHA-256 of `sweep.csv`, once it is written.
    pub table_sha256: Option<String>,
    /// The folder, as the user called it.
    pub folder: String,
    /// What may stand beside this file.
    pub files: Vec<String>,
}

impl Identity {
    /// SHA-256 in hexadecimal; each row of the journal is sealed with it.
    pub fn hash(&self) -> String {
        // Names, numbers and texts always become JSON.
        sha256(&serde_json::to_vec(self).unwrap_or_default())
    }

    /// What differs from the sweep that is `here`, in words.
    pub fn differences(&self, here: &Identity) -> Vec<String> {
        let mut found = Vec::new();
        let mut compare = |what: &str, there: &dyn Display, here: &dyn Display| {
            let (there, here) = (there.to_string(), here.to_string());
            if there != here {
                found.push(format!("{what} {there} there, {here} here"));
            }
        };
        let (from, to) = (&self.provenance, &here.provenance);
        compare("freeplay", &from.version, &to.version);
        compare("rapier", &from.rapier_version, &to.rapier_version);
        compare("--vary", &self.vary.join(" --vary "), &here.vary.join(" --vary "));
        compare("scenario", &from.scenario_name, &to.scenario_name);
        compare("scenario hash", &short(&from.scenario_hash), &short(&to.scenario_hash));
        compare("seed", &self.seed, &here.seed);
        if found.is_empty() && self != here {
            found.push(
                "its columns, the scenarios of its runs, or a file that these read".to_owned(),
            );
        }
        found
    }
}

impl Record {
    /// Reads the record of a folder.
    ///
    /// # Errors
    /// [`StudyError::Input`] if there is none or it is no record.
    pub fn read(folder: &Path) -> Result<Record, StudyError> {
        let file = folder.join(RECORD_FILE);
        let file = file.display();
        let text = fs::read_to_string(folder.join(RECORD_FILE)).map_err(|error| {
            StudyError::input(format!(
                "`{file}` cannot be read: {error}; expected the folder of a sweep"
            ))
        })?;
        let wrong = |what: &str| {
            StudyError::input(format!(
                "`{file}` is no record of a sweep: {what}; it was truncated or edited. Nothing was \
                 changed; restore it, or choose another folder with --out"
            ))
        };
        let record: Record =
            serde_json::from_str(&text).map_err(|error| wrong(&error.to_string()))?;
        let identity = &record.identity;
        if !(1..=MOST_RUNS).contains(&identity.runs) {
            let runs = identity.runs;
            return Err(wrong(&format!("{runs} runs, and from 1 to {MOST_RUNS} are possible")));
        }
        let path = |vary: &String| Vary::parse(vary).ok().map(|vary| vary.path);
        let varied: Option<Vec<String>> = identity.vary.iter().map(path).collect();
        if varied.is_none_or(|varied| !identity.columns.starts_with(&varied)) {
            return Err(wrong("its columns do not begin with what is varied"));
        }
        Ok(record)
    }

    /// Pretty JSON with a line break at the end.
    pub fn to_json(&self) -> String {
        // Names, numbers and texts always become JSON.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// The beginning of a hash: enough to tell two apart.
fn short(hash: &str) -> String {
    hash.chars().take(12).collect()
}

/// SHA-256 in hexadecimal.
pub(in crate::study::sweep) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Bytes as hexadecimal digits.
pub(in crate::study::sweep) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
