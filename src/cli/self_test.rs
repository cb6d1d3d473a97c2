//! `freeplay calibrate --self-test`: hidden effects, and which of them are found.

use super::failure::Failure;
use super::output;
use super::progress::Spinner;
use crate::calibrate::self_test::{Trial, Tried, rates, run, trials};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Which trials, and what becomes of them.
#[derive(Debug)]
pub(super) struct SelfTest<'a> {
    /// Kinds to hide; all if empty.
    pub only: &'a [String],
    /// Everything random follows from it.
    pub seed: u64,
    /// Where finished trials are kept.
    pub table: Option<&'a Path>,
    pub json: bool,
    pub quiet: bool,
}

/// Tries what is not in the table yet, prints what became of each and the rates.
pub(super) fn main(test: &SelfTest) -> Result<(), Failure> {
    let wanted = trials(test.only, test.seed);
    if wanted.is_empty() {
        let hidden = test.only.join(", ");
        let message = format!(
            "--hidden: {hidden} is hidden in no trial; expected `nothing`, the name of an effect \
             that can be hidden, or two of them with a plus if this seed draws them"
        );
        return Err(Failure::Input(vec![message]));
    }
    let mut all = test.table.map(read).transpose()?.unwrap_or_default();
    let done = |trial: &Trial| all.iter().find(|tried: &&Tried| tried.trial == *trial).cloned();
    let known: Vec<Option<Tried>> = wanted.iter().map(done).collect();
    let missing: Vec<usize> = (0..wanted.len()).filter(|&i| known[i].is_none()).collect();
    let spinner = Spinner::new(test.quiet);
    let finished = AtomicUsize::new(wanted.len() - missing.len());
    let say = || {
        let finished = finished.load(Ordering::Relaxed);
        spinner.tell(&format!("{finished} of {} trials", wanted.len()));
    };
    say();
    let next = AtomicUsize::new(0);
    let results = Mutex::new((known, &mut all));
    let work = || -> Result<(), Failure> {
        while let Some(&i) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
            let tried = run(&wanted[i]).map_err(|error| Failure::Other(error.to_string()))?;
            finished.fetch_add(1, Ordering::Relaxed);
            let (found, all) = &mut *results.lock().unwrap_or_else(PoisonError::into_inner);
            if !test.json && !test.quiet {
                spinner.aside(|| output::print(&line(&tried)))?;
            }
            all.push(tried.clone());
            found[i] = Some(tried);
            if let Some(table) = test.table {
                write(table, all)?;
            }
            say();
        }
        Ok(())
    };
    // What one of them cannot do the others need not try.
    let worker = || work().inspect_err(|_| next.store(missing.len(), Ordering::Relaxed));
    // Each of a trial's steps uses all cores that are free; trials beside each other leave none idle.
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        workers.into_iter().try_for_each(|worker| match worker.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })?;
    spinner.clear();
    let (found, _) = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    let found: Vec<Tried> = found.into_iter().flatten().collect();
    let text = if test.json {
        serde_json::to_string_pretty(&found).map_err(|error| Failure::Other(error.to_string()))?
            + "\n"
    } else {
        format!("\n{}", rates(&found))
    };
    Ok(output::print(&text)?)
}

/// One trial in a line.
fn line(tried: &Tried) -> String {
    format!(
        "{} {}, {:.1} floors{}: hidden {}; {}: {} ({} simulations)\n",
        if tried.right { "right" } else { "WRONG" },
        if tried.trial.gravity { "gravity" } else { "no gravity" },
        tried.floors,
        if tried.trial.withheld { ", withheld" } else { "" },
        tried.lacks,
        tried.verdict.word(),
        tried.found,
        tried.simulations
    )
}

/// The trials of a table; none if there is no such file yet.
fn read(table: &Path) -> Result<Vec<Tried>, Failure> {
    let text = match fs::read_to_string(table) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        text => text.map_err(|error| refused(table, &error))?,
    };
    let row = |(i, line)| {
        serde_json::from_str(line).map_err(|error| {
            let place = format!("{}:{}", table.display(), i + 1);
            let message = format!("{place}: {error}; expected a table of --trials, or a new file");
            Failure::Input(vec![message])
        })
    };
    text.lines().enumerate().map(row).collect()
}

/// Writes the table aside and gives it its name: at no time is there half a table.
fn write(table: &Path, all: &[Tried]) -> Result<(), Failure> {
    let rows: Result<Vec<String>, _> = all.iter().map(serde_json::to_string).collect();
    let rows = rows.map_err(|error| Failure::Other(error.to_string()))?;
    let mut aside = table.as_os_str().to_owned();
    aside.push(".partial");
    let aside = PathBuf::from(aside);
    fs::write(&aside, rows.join("\n") + "\n")
        .and_then(|()| fs::rename(&aside, table))
        .map_err(|error| refused(table, &error))
}

fn refused(table: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(vec![format!("cannot use `{}`: {error}", table.display())])
}
