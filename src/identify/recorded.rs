//! Recordings of machines whose columns a rig names.

use crate::measure::log::{Channel, Log, LogError, Source};
use crate::scenario::Scenario;
use std::path::{Path, PathBuf};

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Missing {
    /// The recording is not there.
    #[error("{0} is not there")]
    Absent(PathBuf),
    /// It is there, and not what it should be.
    #[error(transparent)]
    Log(#[from] LogError),
    /// A simulation broke down.
    #[error(transparent)]
    Halted(#[from] crate::engine::Halt),
    /// Anything else.
    #[error("{0}")]
    Wrong(String),
}

/// A recording and how it was read.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The file as the user called it.
    pub path: String,
    /// What it holds, in SI units.
    pub log: Log,
    /// Where each channel stood.
    pub sources: Vec<(Channel, Source)>,
    /// Columns that nothing asks for, by their heads.
    pub others: Vec<String>,
}

impl Recorded {
    /// Reads a recording of a rig. What `[columns]` names has to be there, but for voltages that were
    /// added, which few recordings have; of what it does not name, a column of the quantity's own name is
    /// taken. All of `needed` have to be found, and nothing but `known` is.
    ///
    /// # Errors
    /// A file that is not there, columns that are not, and what [`Log::read_columns`] finds.
    pub fn read(
        path: &Path,
        rig: &Scenario,
        needed: &[Channel],
        known: &[Channel],
    ) -> Result<Recorded, Missing> {
        let columns = rig.columns.clone().unwrap_or_default();
        let (time, mut sources) = columns.sources(known).map_err(|name| {
            let names: Vec<String> = known.iter().map(Channel::to_string).collect();
            let message = "is not a quantity of this machine's recordings";
            let help = format!("known here: t, {}", names.join(", "));
            Missing::Wrong(rig.problem(&format!("columns.{name}"), message, help).to_string())
        })?;
        if !path.is_file() {
            return Err(Missing::Absent(path.to_owned()));
        }
        let heads = Log::heads(path)?;
        let has = |source: &Source| heads.contains(&source.column);
        sources.retain(|(channel, source)| !matches!(channel, Channel::Added(_)) || has(source));
        for channel in known {
            let own = Source::new(&channel.to_string(), 1.0);
            let named = sources.iter().any(|(c, _)| c == channel);
            if !named && (needed.contains(channel) || has(&own)) {
                sources.push((*channel, own));
            }
        }
        let log = Log::read_columns(path, &time, &sources)?;
        let asked = |head: &String| {
            *head == time.column || sources.iter().any(|(_, source)| source.column == *head)
        };
        let others = heads.into_iter().filter(|head| !asked(head)).collect();
        Ok(Recorded { path: path.display().to_string(), log, sources, others })
    }
}
