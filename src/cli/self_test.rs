//! `freeplay calibrate --self-test`: hidden effects, and which of them are found.

use super::failure::Failure;
use super::output;
use super::progress::Spinner;
use crate::calibrate::search::names;
use crate::calibrate::self_test::{Result as Tried, SIZES, Trial, kinds, run};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Rigs that lack nothing, with gravity and without: as many as it takes to see false alarms of one in
/// ten.
const LACKING_NOTHING: u64 = 5;

/// Floors above which what is hidden must be found.
const LARGE: f64 = 3.0;

/// Tries every effect at every size with gravity and without, the same withheld from the candidates at
/// the middle size, and rigs that lack nothing; prints what became of each and the confusion matrix.
pub(super) fn main(only: &[String], seed: u64, json: bool, quiet: bool) -> Result<(), Failure> {
    let trials = trials(only, seed);
    let spinner = Spinner::new(quiet);
    let mut results = Vec::new();
    for (i, trial) in trials.iter().enumerate() {
        let what = if trial.hidden.is_empty() { "nothing" } else { trial.hidden[0] };
        spinner.tell(&format!("trial {} of {}: {what} hidden", i + 1, trials.len()));
        let result = run(trial).map_err(|error| Failure::Other(error.to_string()))?;
        spinner.clear();
        if !json && !quiet {
            output::print(&line(&result))?;
        }
        results.push(result);
    }
    spinner.clear();
    if json {
        let json = serde_json::to_string_pretty(&results)
            .map_err(|error| Failure::Other(error.to_string()))?;
        output::print(&(json + "\n"))?;
    } else {
        output::print(&matrix(&results))?;
    }
    Ok(())
}

fn trials(only: &[String], seed: u64) -> Vec<Trial> {
    let wanted = |kind: &str| only.is_empty() || only.iter().any(|name| name == kind);
    let mut trials = Vec::new();
    for gravity in [true, false] {
        let trial = |hidden: &[&'static str], size: f64, withheld: bool, number: u64| Trial {
            hidden: hidden.to_vec(),
            size,
            gravity,
            withheld,
            seed: seed * 1000 + number,
        };
        if wanted("nothing") {
            trials.extend((0..LACKING_NOTHING).map(|i| trial(&[], 0.0, false, 900 + i)));
        }
        for (i, kind) in kinds().enumerate().filter(|(_, kind)| wanted(kind)) {
            let number = i as u64 * 10;
            let sizes = SIZES.iter().zip(number..);
            trials.extend(sizes.map(|(&size, number)| trial(&[kind], size, false, number)));
            trials.push(trial(&[kind], SIZES[1], true, number + 5));
        }
    }
    trials
}

/// One trial in a line.
fn line(result: &Tried) -> String {
    let verdict = format!("{:?}", result.verdict).to_lowercase();
    let hidden =
        if result.hidden.is_empty() { "nothing".to_owned() } else { names(&result.hidden) };
    let found = if result.found.is_empty() { "nothing".to_owned() } else { names(&result.found) };
    format!(
        "{} {}, {:.1} floors{}: hidden {hidden}; {verdict}: {found} ({} simulations)\n",
        if result.right { "right" } else { "WRONG" },
        if result.gravity { "gravity" } else { "no gravity" },
        result.floors,
        if result.withheld { ", withheld" } else { "" },
        result.simulations
    )
}

/// Hidden against found, and what the rates come to.
fn matrix(results: &[Tried]) -> String {
    let mut cells: BTreeMap<(String, String), usize> = BTreeMap::new();
    let kind = |effects: &[crate::effects::Setting]| match effects {
        [] => "nothing".to_owned(),
        [one] => one.kind.name.to_owned(),
        _ => "several".to_owned(),
    };
    let named = results.iter().filter(|result| !result.withheld);
    for result in named.clone() {
        *cells.entry((kind(&result.hidden), kind(&result.found))).or_default() += 1;
    }
    let mut text = "\nhidden -> found: trials\n".to_owned();
    for ((hidden, found), count) in &cells {
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(text, "  {hidden:<20} -> {found:<20} {count:>4}");
    }
    let mut rate = |what: &str, of: Vec<bool>| {
        if !of.is_empty() {
            let right = of.iter().filter(|right| **right).count();
            let share = 100.0 * right as f64 / of.len() as f64;
            let _ = writeln!(text, "{what:<58} {right:>4} of {:<4} {share:>5.0} %", of.len());
        }
    };
    for (gravity, where_from) in [(true, "with gravity"), (false, "without")] {
        let own = || named.clone().filter(move |r| r.gravity == gravity);
        let right = |of: &dyn Fn(&Tried) -> bool| {
            own().filter(|result| of(result)).map(|result| result.right).collect::<Vec<_>>()
        };
        let large = |r: &Tried| !r.hidden.is_empty() && r.floors > LARGE;
        let small = |r: &Tried| !r.hidden.is_empty() && r.floors <= LARGE;
        rate(&format!("right effects where above three floors, {where_from}"), right(&large));
        rate(&format!("right effects below three floors, {where_from}"), right(&small));
        rate(
            &format!("nothing found where nothing is hidden, {where_from}"),
            right(&|r| r.hidden.is_empty()),
        );
    }
    let withheld = results.iter().filter(|result| result.withheld);
    rate("unexplained where the effect is no candidate", withheld.map(|r| r.right).collect());
    let values = || results.iter().flat_map(|result| &result.values);
    let near =
        |(_, truth, value, _): &(String, f64, f64, f64)| (value - truth).abs() < 0.1 * truth.abs();
    rate("values within 10 %", values().map(near).collect());
    let covered =
        |(_, truth, value, std): &(String, f64, f64, f64)| (value - truth).abs() < 1.96 * std;
    rate("values inside their 95 % intervals", values().map(covered).collect());
    text
}
