//! `freeplay compare --laws`: one motion under several contact laws.

use super::failure::{Failure, refuse_errors};
use super::options::{FolderOptions, PrintOptions, ScenarioOptions};
use super::progress::Progress;
use crate::contact::laws::{ALL, Kind, named};
use crate::measure::spelling::nearest;
use crate::report::number;
use crate::simulate::{assemble, findings};
use crate::study::compare::by_law::{Done, LAWS_COMPARED_FILE, compare_laws, simulated_time};
use crate::study::compare::{Mean, QUANTITIES, in_words};
use std::fmt::Write as _;

/// The comparison of laws with each other.
pub(super) fn main(
    list: &str,
    scenario: &ScenarioOptions,
    starts: usize,
    folder: &FolderOptions,
    print: &PrintOptions,
) -> Result<(), Failure> {
    let kinds = kinds(list).map_err(|problem| Failure::Input(vec![problem]))?;
    let scenario = scenario.load()?;
    refuse_errors(findings(&scenario, &mut assemble(&scenario)?))?;
    let simulated = simulated_time(&scenario, &kinds, starts)?;
    let folder = folder.prepare("compare-laws", &scenario.name, LAWS_COMPARED_FILE)?;
    let mut progress = Progress::new(simulated, print.quiet);
    let done = compare_laws(&scenario, &kinds, starts, folder, &mut |t| progress.reached(t));
    progress.clear();
    let done = done?;
    print.result(&done.json, || text(&done))?;
    Ok(())
}

/// The laws of a list, each once.
fn kinds(list: &str) -> Result<Vec<&'static Kind>, String> {
    if list.trim() == "all" {
        return Ok(ALL.to_vec());
    }
    let mut kinds: Vec<&'static Kind> = Vec::new();
    for name in list.split(',').map(str::trim) {
        let Some(kind) = named(name) else {
            let names = ALL.map(|kind| kind.name);
            let help = match nearest(name, &names) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("expected `all`, or some of {}", names.join(", ")),
            };
            return Err(format!("--laws: `{name}` is not a law; {help}"));
        };
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    Ok(kinds)
}

/// The comparison of laws for people.
fn text(done: &Done) -> String {
    let c = &done.compared;
    let mut text = format!(
        "{}: {} laws, {} starts of {} s, compared in {} s\n\
         hits at {} m/s return {} of their speed under the first law; the others are matched to that\n\n",
        c.provenance.scenario_name,
        c.rows.len(),
        c.starts,
        number(c.duration_s),
        number(c.wall_s),
        number(c.speed_m_s),
        number(c.restitution)
    );
    let chosen = ["rms_path_error_m", "peak_contact_force_N", "contact_fraction", "impacts_per_s"];
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(
        text,
        "  {:<23}{:>10}{:>14}{:>14}{:>12}{:>12}",
        "law", "returned", "rms path err", "peak force", "in contact", "impacts/s"
    );
    for row in &c.rows {
        let [path, peak, fraction, impacts] = chosen.map(|key| figure(&row.quantities, key));
        let _ = writeln!(
            text,
            "  {:<23}{:>10}{path:>14}{peak:>14}{fraction:>12}{impacts:>12}{}{}",
            row.law,
            number(row.returned),
            if row.matched { "" } else { "  not matched" },
            if row.halted > 0 { "  broke down" } else { "" }
        );
    }
    text.push('\n');
    for (found, quantity) in c.dependences.iter().zip(&QUANTITIES) {
        let answer = match (found.depends, found.lowest, found.highest) {
            (true, Some(low), Some(high)) => {
                format!("depends on the law: smallest under {low}, largest under {high}")
            }
            _ => "differs no more than by chance".to_owned(),
        };
        let _ = writeln!(text, "  {}: {answer}", quantity.label);
    }
    let page = done.folder.join("index.html");
    let _ = writeln!(text, "\nWritten to {}; open {}", done.folder.display(), page.display());
    text
}

/// One of the means in words.
pub(super) fn figure(means: &[Mean], key: &str) -> String {
    let found = QUANTITIES.iter().zip(means).find(|(quantity, _)| quantity.key == key);
    found.map_or(String::new(), |(quantity, mean)| in_words(quantity, mean.mean))
}
