//! `freeplay calibrate --self-test`: hidden effects, and which of them are found.

use super::failure::Failure;
use super::output;
use super::progress::Spinner;
use crate::calibrate::sensed::problem::Problem;
use crate::calibrate::sensed::self_test::{NOISE, Tried, machines, rates, run, trials};
use crate::effects::named;
use sha2::{Digest, Sha256};
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
    /// Machines to try; all if empty.
    pub machines: &'a [String],
    /// How many trials.
    pub count: usize,
    /// Everything random follows from it.
    pub seed: u64,
    /// Where finished trials are kept.
    pub table: Option<&'a Path>,
    /// Where rigs and recordings are kept.
    pub keep: Option<&'a Path>,
    pub json: bool,
    pub quiet: bool,
}

/// Tries what is not in the table yet, prints what became of each and the rates. Without trials to do, the rates of
/// the table.
pub(super) fn main(test: &SelfTest) -> Result<(), Failure> {
    refuse_strangers(test)?;
    let table = test.table.map(read).transpose()?.unwrap_or_default();
    let tried = if test.count == 0 { table } else { all_tried(test, table)? };
    let text = if test.json {
        serde_json::to_string_pretty(&tried).map_err(|error| Failure::Other(error.to_string()))?
            + "\n"
    } else {
        format!("\n{}", rates(&tried))
    };
    Ok(output::print(&text)?)
}

/// Refuses names of effects and of machines that are none.
fn refuse_strangers(test: &SelfTest) -> Result<(), Failure> {
    let known = |kind: &str| kind == "nothing" || kind == NOISE || named(kind).is_some();
    let strange = test.only.iter().filter(|only| !only.split('+').all(known)).map(|only| {
        format!(
            "--hidden: {only} is hidden in no trial; expected `nothing`, `{NOISE}`, the name of an effect, or two \
             of them with a plus"
        )
    });
    let all: Vec<&str> = machines().collect();
    let other = test.machines.iter().filter(|name| !all.contains(&name.as_str())).map(|name| {
        format!(
            "--machine: {name} is no machine of the self-test; expected one of {}",
            all.join(", ")
        )
    });
    let wrong: Vec<String> = strange.chain(other).collect();
    if wrong.is_empty() { Ok(()) } else { Err(Failure::Input(wrong)) }
}

/// The wanted trials, those that the table lacks tried.
fn all_tried(test: &SelfTest, mut all: Vec<Tried>) -> Result<Vec<Tried>, Failure> {
    let version = version()?;
    if let Some((table, other)) = test.table.zip(all.iter().find(|t| t.version != version)) {
        return Err(Failure::Input(vec![format!(
            "{}: holds trials of {}, and this is {version}; a table is of one program: give another file, or \
             --count 0 for its rates",
            table.display(),
            other.version
        )]));
    }
    let wanted = trials(test.seed, test.count, test.machines, test.only);
    if wanted.is_empty() {
        let message = format!("--hidden: {} is hidden in no trial of these", test.only.join(", "));
        return Err(Failure::Input(vec![message]));
    }
    let done = |seed: u64| all.iter().find(|tried| tried.trial.seed == seed).cloned();
    let known: Vec<Option<Tried>> = wanted.iter().map(|trial| done(trial.seed)).collect();
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
            let kept = Mutex::new(Ok(()));
            let tried = run(&wanted[i], &version, &|problem| {
                let Some(folder) = test.keep else { return };
                let written = keep(&folder.join(wanted[i].seed.to_string()), problem);
                *kept.lock().unwrap_or_else(PoisonError::into_inner) = written;
            });
            kept.into_inner().unwrap_or_else(PoisonError::into_inner)?;
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
    Ok(found.into_iter().flatten().collect())
}

/// Writes the rig and the recordings of a trial, to be calibrated like any others.
fn keep(folder: &Path, problem: &Problem) -> Result<(), Failure> {
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| refused(&path, &error))
    };
    fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    write("rig.toml", &problem.rig.to_toml())?;
    for (run, name) in problem.runs.iter().zip(["run-a.csv", "run-b.csv"]) {
        write(name, &run.recording.to_csv(&problem.declared.sensors))?;
    }
    Ok(())
}

/// Version of the program, and which build of it: the first digits of its file's hash.
fn version() -> Result<String, Failure> {
    let read = std::env::current_exe().and_then(fs::read);
    let program = read.map_err(|error| Failure::Other(format!("cannot read itself: {error}")))?;
    let hash = Sha256::digest(&program);
    let digits: String = hash.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    Ok(format!("{} ({digits})", env!("CARGO_PKG_VERSION")))
}

/// One trial in a line.
fn line(tried: &Tried) -> String {
    let trial = &tried.trial;
    let machine = format!("{} {} × {:.2}", trial.seed, trial.machine, trial.size);
    let Some(answer) = &tried.answer else {
        let why = tried.unasked.as_deref().unwrap_or_default();
        return format!("      {machine}: {}: {why}\n", trial.hidden.join(", "));
    };
    format!(
        "{} {machine}, {:.1} floors: hidden {}; {}: {} ({} simulations, {:.0} s)\n",
        if answer.right { "right" } else { "WRONG" },
        answer.floors,
        answer.lacks,
        answer.verdict.word(),
        answer.found,
        answer.simulations,
        answer.seconds,
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
