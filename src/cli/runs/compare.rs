//! `freeplay compare`: one motion under several contact models.

use super::compare_laws::{self, figure};
use super::compare_options::{Arguments, warn_of_step};
use crate::cli::shared::failure::{Failure, refuse_errors, refuse_faults, warn_of_seed};
use crate::cli::shared::output;
use crate::cli::shared::progress::Progress;
use crate::cli::shared::table::{paragraph, table};
use crate::report::number;
use crate::scenario::{Law, Scenario};
use crate::simulate::{Finding, assemble, findings};
use crate::study::compare::{
    COMPARE_FILE, Compared, NativeUse, Options, QUANTITIES, SAMPLE_INTERVAL, compare,
    simulated_time,
};
use std::fmt::Write as _;

/// Steps that a list may have: each is simulated under three models.
const MOST_STEPS: usize = 8;

/// The shortest step: below, a simulated second takes minutes.
const SHORTEST_STEP: f64 = 1e-7;

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(list) = &arguments.laws {
        return compare_laws::main(list, arguments);
    }
    let steps = steps(&arguments.steps).map_err(|problem| Failure::Input(vec![problem]))?;
    let options = Options { steps, starts: arguments.starts.into() };
    let mut scenario = arguments.scenario.load()?;
    let declared = std::mem::replace(&mut scenario.contact.law, Law::HertzStep);
    refuse_errors(findings(&scenario, &mut assemble(&scenario)?))?;
    let simulated = simulated_time(&scenario, &options)?;
    // What cannot be compared is refused without a word of what it would not have used.
    warn_of_seed(&scenario);
    warn_of_law(&scenario, declared);
    warn_of_step(&scenario, "--steps says which fixed steps are compared");
    let folder = arguments.folder.prepare("compare", &scenario.name, COMPARE_FILE)?;

    let (yes, quiet) = (arguments.cost.yes, arguments.print.quiet);
    let compared = Progress::during(simulated, yes, quiet, |watch| {
        compare(&scenario, &options, folder, watch)
    })?;
    arguments.print.result(&compared.json, || text(&compared))?;
    refuse_faults(&compared.comparison.faults())
}

/// Says that the scenario's own law is not the one that is compared with the others.
fn warn_of_law(scenario: &Scenario, law: Law) {
    if law != Law::HertzStep {
        let message = format!(
            "is \"{}\" and is not used, nor are keys that this law alone has: hertz-step, native and ideal are compared",
            law.name()
        );
        let help = "leave it out, or name the laws to compare: --laws hertz-step,flores";
        let problem = scenario.problem("contact.law", message, help);
        output::complain(&Finding::warning(problem).to_string());
    }
}

/// The list of steps, longest first, each once.
///
/// # Errors
/// What is no list of steps, and what would be one.
pub fn steps(list: &str) -> Result<Vec<f64>, String> {
    let range = format!("expected steps in s from {SHORTEST_STEP:e} to {SAMPLE_INTERVAL:e}");
    if list.trim().is_empty() {
        return Err(format!("--steps: is empty; {range}, such as 2e-5,1e-5"));
    }
    let mut steps = Vec::new();
    for item in list.split(',').map(str::trim) {
        let step: f64 =
            item.parse().map_err(|_| format!("--steps: `{item}` is not a number; {range}"))?;
        if !(SHORTEST_STEP..=SAMPLE_INTERVAL).contains(&step) {
            return Err(format!("--steps: {item} is out of range; {range}"));
        }
        steps.push(step);
    }
    steps.sort_by(|a, b| b.total_cmp(a));
    steps.dedup();
    if steps.len() > MOST_STEPS {
        let count = steps.len();
        return Err(format!("--steps: has {count} steps; expected at most {MOST_STEPS}"));
    }
    Ok(steps)
}

/// The result for people.
fn text(compared: &Compared) -> String {
    let c = &compared.comparison;
    let mut text = format!(
        "{}: {} starts of {} s, compared in {} s\n\n",
        c.provenance.scenario_name,
        c.starts,
        number(c.duration_s),
        number(c.wall_s)
    );
    for sentence in &c.answer {
        text += &(paragraph("", "", sentence) + "\n");
    }
    let chosen = ["rms_path_error_m", "peak_contact_force_N", "contact_fraction", "impacts_per_s"];
    let heads = [
        "law",
        "step",
        "rms path error",
        "peak force",
        "in contact",
        "impacts/s",
        "s per sim. s",
        "",
    ];
    let rows = c.rows.iter().map(|row| {
        let step = row.step_s.map_or("tolerance".to_owned(), |step| format!("{step:e} s"));
        let [path, peak, fraction, impacts] = chosen.map(|key| figure(&row.quantities, key));
        let cost = number(row.wall_s_per_simulated_s);
        [
            row.law.name().to_owned(),
            step,
            path,
            peak,
            fraction,
            impacts,
            cost,
            row.remark().unwrap_or_default(),
        ]
    });
    text += &table("llrrrrrl", heads, rows);
    if let Some(chaos) = &c.chaos {
        let rate = chaos.lyapunov_exponent_1_s;
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(
            text,
            "\n  largest Lyapunov exponent {} ± {} 1/s",
            number(rate.mean),
            number(rate.sem)
        );
    }
    text.push('\n');
    for verdict in c.verdicts.iter().filter(|v| v.usable == NativeUse::No) {
        let label = QUANTITIES.iter().find(|q| q.key == verdict.quantity).map(|q| q.label);
        let why = format!("no: {}: {}", label.unwrap_or(verdict.quantity), verdict.reason);
        text += &paragraph("  ", "    ", &why);
    }
    let folder = compared.folder.display();
    let page = compared.folder.join("index.html");
    let _ = writeln!(text, "\nWritten to {folder}; open {}", page.display());
    text
}
