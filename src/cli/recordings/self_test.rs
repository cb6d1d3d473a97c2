//! `freeplay calibrate --self-test`: hidden effects, and which of them are found.

use crate::calibrate::sensed::problem::RigProblem;
use crate::calibrate::sensed::self_test::{NOISE, Trial, TriedTrial, machines, rates, run, trials};
use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use crate::cli::shared::parts::{PartOptions, list, named};
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::signals;
use crate::effects;
use crate::report::number;
use crate::study::sweep::Shard;
use sha2::{Digest, Sha256};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Which trials, and what becomes of them.
#[derive(Debug)]
pub(in crate::cli) struct SelfTest<'a> {
    /// Kinds to hide; all if empty.
    pub only: &'a [String],
    /// Machines to try; all if empty.
    pub machines: &'a [String],
    /// How many trials.
    pub count: usize,
    /// Everything random follows from it.
    pub seed: u64,
    /// Where finished trials are kept; of a part, under its name.
    pub table: Option<&'a Path>,
    /// Other tables whose trials are taken as well.
    pub from: &'a [PathBuf],
    /// Which part of the trials, and what is to be known of the parts.
    pub parts: &'a PartOptions,
    /// Where rigs and recordings are kept.
    pub keep: Option<&'a Path>,
    pub json: bool,
    pub quiet: bool,
}

/// Tries what is not in the table yet, prints what became of each and the rates. Without trials to do, the rates of
/// the table.
pub(in crate::cli) fn main(test: &SelfTest) -> Result<(), Failure> {
    refuse_strangers(test)?;
    let name = |shard| test.table.map(|table| named(table, shard));
    if let Some(shards) = test.parts.asked_for("--trials", test.table)? {
        return print_missing(test, &shards, &name);
    }
    let table = name(test.parts.shard);
    let known = tables(test, table.as_deref())?;
    if test.parts.dry_run {
        return print_forecast(test, &known);
    }
    let tried = match test.count {
        0 => known,
        _ => all_tried(test, table.as_deref(), known)?,
    };
    let text = if test.json {
        serde_json::to_string_pretty(&tried).map_err(|error| Failure::Other(error.to_string()))?
            + "\n"
    } else {
        format!("\n{}", rates(&tried))
    };
    Ok(output::print(&text)?)
}

/// The trials of the table and of those that are taken as well, each once.
fn tables(test: &SelfTest, table: Option<&Path>) -> Result<Vec<TriedTrial>, Failure> {
    let mut all = table.map(read).transpose()?.unwrap_or_default();
    for other in test.from {
        if !other.exists() {
            let message = format!("--from: `{}` is not there", other.display());
            return Err(Failure::Input(vec![message]));
        }
        for tried in read(other)? {
            if !all.iter().any(|known| known.trial.seed == tried.trial.seed) {
                all.push(tried);
            }
        }
    }
    Ok(all)
}

/// The trials of one part.
fn wanted(test: &SelfTest, shard: Shard) -> Result<Vec<Trial>, Failure> {
    let all = trials(test.seed, test.count, test.machines, test.only);
    if all.is_empty() {
        let message = format!("--hidden: {} is hidden in no trial of these", test.only.join(", "));
        return Err(Failure::Input(vec![message]));
    }
    let numbered = all.into_iter().enumerate();
    Ok(numbered.filter(|(number, _)| shard.holds(*number)).map(|(_, trial)| trial).collect())
}

/// Those of the wanted trials that no table has.
fn missing<'a>(wanted: &'a [Trial], known: &[TriedTrial]) -> Vec<&'a Trial> {
    let there = |trial: &Trial| known.iter().any(|tried| tried.trial.seed == trial.seed);
    wanted.iter().filter(|trial| !there(trial)).collect()
}

/// Prints which parts have to be made, as a job array takes them.
fn print_missing(
    test: &SelfTest,
    shards: &[Shard],
    name: &dyn Fn(Shard) -> Option<PathBuf>,
) -> Result<(), Failure> {
    let mut numbers = Vec::new();
    for &shard in shards {
        let known = tables(test, name(shard).as_deref())?;
        if !missing(&wanted(test, shard)?, &known).is_empty() {
            numbers.push(shard.index());
        }
    }
    Ok(output::print(&(list(&numbers) + "\n"))?)
}

/// Trials that are named where many are missing.
const NAMED: usize = 5;

/// Prints how many trials there are, which are missing, and what those will take where finished ones say it.
fn print_forecast(test: &SelfTest, known: &[TriedTrial]) -> Result<(), Failure> {
    let wanted = wanted(test, test.parts.shard)?;
    let missing = missing(&wanted, known);
    let threads = test.parts.threads().unwrap_or_else(cores);
    let times: Vec<f64> =
        known.iter().filter_map(|tried| Some(tried.answer.as_ref()?.seconds)).collect();
    let trial_s = (!times.is_empty()).then(|| times.iter().sum::<f64>() / times.len() as f64);
    let rest_s = trial_s.map(|seconds| seconds * missing.len().div_ceil(threads) as f64);
    let (count, finished) = (wanted.len(), wanted.len() - missing.len());
    if test.json {
        let seeds: Vec<u64> = missing.iter().map(|trial| trial.seed).collect();
        let json = serde_json::json!({
            "trials": count, "finished": finished, "missing": missing.len(), "seeds": seeds,
            "trial_s": trial_s, "threads": threads, "rest_s": rest_s,
        });
        return Ok(output::print(&format!("{json:#}\n"))?);
    }
    let mut text = format!("{count} trials, {finished} of them done");
    if !missing.is_empty() && finished > 0 {
        let seeds: Vec<String> =
            missing.iter().take(NAMED).map(|trial| trial.seed.to_string()).collect();
        let more = if missing.len() > NAMED { ", …" } else { "" };
        text += &format!("; missing: {}{more}", seeds.join(", "));
    }
    text += &match rest_s {
        Some(rest_s) => format!("; the rest takes {} s on {threads} threads", number(rest_s)),
        None => "; a trial takes a minute or two".to_owned(),
    };
    Ok(output::print(&(text + "\n"))?)
}

/// One for each core.
fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Refuses names of effects and of machines that are none.
fn refuse_strangers(test: &SelfTest) -> Result<(), Failure> {
    let known = |kind: &str| kind == "nothing" || kind == NOISE || effects::named(kind).is_some();
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

/// Refuses tables of another program: it might have answered otherwise.
fn refuse_foreign(test: &SelfTest, table: Option<&Path>, version: &str) -> Result<(), Failure> {
    for file in table.into_iter().chain(test.from.iter().map(PathBuf::as_path)) {
        if let Some(other) = read(file)?.iter().find(|tried| tried.version != version) {
            return Err(Failure::Input(vec![format!(
                "{}: holds trials of {}, and this is {version}; a table is of one program: give another file, or \
                 --count 0 for its rates",
                file.display(),
                other.version
            )]));
        }
    }
    Ok(())
}

/// The wanted trials, those that the table lacks tried.
fn all_tried(
    test: &SelfTest,
    table: Option<&Path>,
    mut all: Vec<TriedTrial>,
) -> Result<Vec<TriedTrial>, Failure> {
    let version = version()?;
    refuse_foreign(test, table, &version)?;
    let wanted = wanted(test, test.parts.shard)?;
    if let Some(table) = table {
        signals::work_is(format!(
            "finished trials are kept in `{}`; the same command goes on from there",
            table.display()
        ));
        if !test.from.is_empty() {
            write(table, &all)?;
        }
    }
    let done = |seed: u64| all.iter().find(|tried| tried.trial.seed == seed).cloned();
    let known: Vec<Option<TriedTrial>> = wanted.iter().map(|trial| done(trial.seed)).collect();
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
            if let Some(table) = table {
                write(table, all)?;
            }
            say();
        }
        Ok(())
    };
    // What one of them cannot do the others need not try.
    let worker = || work().inspect_err(|_| next.store(missing.len(), Ordering::Relaxed));
    // Each of a trial's steps uses all cores that are free; trials beside each other leave none idle.
    let threads = test.parts.threads().unwrap_or_else(cores);
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
fn keep(folder: &Path, problem: &RigProblem) -> Result<(), Failure> {
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
fn line(tried: &TriedTrial) -> String {
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
fn read(table: &Path) -> Result<Vec<TriedTrial>, Failure> {
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
fn write(table: &Path, all: &[TriedTrial]) -> Result<(), Failure> {
    let rows: Result<Vec<String>, _> = all.iter().map(serde_json::to_string).collect();
    let rows = rows.map_err(|error| Failure::Other(error.to_string()))?;
    output::whole(table, &(rows.join("\n") + "\n")).map_err(|error| refused(table, &error))
}

fn refused(table: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(vec![format!("cannot use `{}`: {error}", table.display())])
}
