//! `freeplay compare --laws`: one motion under several contact laws.

use super::compare_options::{Arguments, warn_of_step};
use crate::cli::shared::failure::{Failure, refuse_errors, warn_of_seed};
use crate::cli::shared::progress::Progress;
use crate::cli::shared::table::{paragraph, table};
use crate::contact::laws::{ALL, LawKind, named};
use crate::measure::spelling::nearest;
use crate::report::number;
use crate::simulate::{assemble, findings};
use crate::study::compare::by_law::{
    FinishedByLaw, LAWS_COMPARED_FILE, compare_laws, simulated_time,
};
use crate::study::compare::{Mean, QUANTITIES, in_words};

/// The comparison of laws with each other.
pub(in crate::cli) fn main(list: &str, arguments: &Arguments) -> Result<(), Failure> {
    let starts = usize::from(arguments.starts);
    let kinds = kinds(list).map_err(|problem| Failure::Input(vec![problem]))?;
    let scenario = arguments.scenario.load()?;
    warn_of_seed(&scenario);
    warn_of_step(&scenario, "laws are compared at simulation.tolerance");
    refuse_errors(findings(&scenario, &mut assemble(&scenario)?))?;
    let simulated = simulated_time(&scenario, &kinds, starts)?;
    let folder = arguments.folder.prepare("compare-laws", &scenario.name, LAWS_COMPARED_FILE)?;
    let (yes, quiet) = (arguments.cost.yes, arguments.print.quiet);
    let done = Progress::during(simulated, yes, quiet, |watch| {
        compare_laws(&scenario, &kinds, starts, folder, watch)
    })?;
    arguments.print.result(&done.json, || text(&done))?;
    Ok(())
}

/// The laws of a list, each once.
///
/// # Errors
/// A name that is none, and what would be one; a single law.
pub fn kinds(list: &str) -> Result<Vec<&'static LawKind>, String> {
    if list.trim() == "all" {
        return Ok(ALL.to_vec());
    }
    let mut kinds: Vec<&'static LawKind> = Vec::new();
    for name in list.split(',').map(str::trim) {
        let Some(kind) = named(name) else {
            let names: Vec<&str> = ALL.iter().map(|kind| kind.name).collect();
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
    match kinds.as_slice() {
        [one] => Err(format!(
            "--laws: `{list}` names one law, {}, which leaves nothing to compare; expected `all`, or two laws or more",
            one.name
        )),
        _ => Ok(kinds),
    }
}

/// The comparison of laws for people.
fn text(done: &FinishedByLaw) -> String {
    let c = &done.compared;
    let counted = format!(
        "{}: {} laws, {} starts of {} s, compared in {} s; hits at {} m/s return {} of their speed under the \
         first law, and the others are matched to that",
        c.provenance.scenario_name,
        c.rows.len(),
        c.starts,
        number(c.duration_s),
        number(c.wall_s),
        number(c.speed_m_s),
        number(c.restitution)
    );
    let mut text = paragraph("", "", &counted) + "\n";
    let chosen = ["rms_path_error_m", "peak_contact_force_N", "contact_fraction", "impacts_per_s"];
    let heads = ["law", "returned", "rms path error", "peak force", "in contact", "impacts/s", ""];
    let rows = c.rows.iter().map(|row| {
        let [path, peak, fraction, impacts] = chosen.map(|key| figure(&row.quantities, key));
        let said = match (row.matched, row.halted) {
            (_, 1..) => "broke down",
            (false, 0) => "not matched",
            (true, 0) => "",
        };
        [row.law.to_owned(), number(row.returned), path, peak, fraction, impacts, said.to_owned()]
    });
    text += &table("lrrrrrl", heads, rows);
    text.push('\n');
    for (found, quantity) in c.dependences.iter().zip(&QUANTITIES) {
        let answer = match (found.depends, found.lowest, found.highest) {
            (true, Some(low), Some(high)) => {
                format!("depends on the law: smallest under {low}, largest under {high}")
            }
            _ => "differs no more than by chance".to_owned(),
        };
        text += &paragraph("  ", "    ", &format!("{}: {answer}", quantity.label));
    }
    let page = done.folder.join("index.html");
    let folder = done.folder.display();
    text + &format!("\nWritten to {folder}; open {}\n", page.display())
}

/// One of the means in words.
pub(super) fn figure(means: &[Mean], key: &str) -> String {
    let found = QUANTITIES.iter().zip(means).find(|(quantity, _)| quantity.key == key);
    found.map_or(String::new(), |(quantity, mean)| in_words(quantity, mean.mean))
}
