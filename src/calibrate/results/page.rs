//! The page of a calibration: the verdict first, then how it came about.

use super::charts::{Charts, OVER};
use super::outcome::{LegsOutcome, Verdict};
use super::report::{EffectReport, LegsReport};
use crate::calibrate::rounds::left::is_noise;
use crate::calibrate::rounds::way::{LegsRound, name as in_words};
use crate::calibrate::sensed::unnamed::DescribedEfforts;
use crate::calibrate::values::errors::{ChannelError, worst};
use crate::calibrate::values::model::LegsCase;
use crate::effects::{Efforts, Setting};
use crate::report::{Fact, PagePart, PageTable, document, known_to, length, number};

/// Candidates of a round that the page lists; the others are in `report.json`.
const LISTED: usize = 8;

/// The page as HTML.
pub fn page(
    case: &LegsCase,
    outcome: &LegsOutcome,
    report: &LegsReport,
    charts: &Charts,
) -> String {
    let facts = facts(outcome, report);
    let equations = equations(report);
    let provenance = provenance(case, report);
    let mut parts = vec![PagePart::Facts(&facts)];
    if !outcome.effects.is_empty() {
        parts.push(PagePart::Table(values(outcome, report)));
        parts.push(PagePart::Text { id: "why", title: "Why these", paragraphs: &equations });
    }
    parts.push(PagePart::Table(errors_table(&report.errors, ERRORS_NOTE)));
    parts.push(PagePart::Pictures(&charts.runs));
    parts.push(PagePart::Table(dependence(charts)));
    parts.push(PagePart::Pictures(&charts.over));
    parts.push(PagePart::Table(candidates(outcome)));
    parts.push(PagePart::Table(residuals(report)));
    parts.push(PagePart::Provenance(&provenance));
    let title = format!("Calibration of {}: {}", case.rig.name, verdict(outcome.verdict));
    document(&title, &report.summary, &parts)
}

/// The verdict in a word or two.
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Explained => "explained",
        Verdict::NothingMissing => "nothing missing",
        Verdict::Unexplained => "unexplained",
    }
}

fn facts(outcome: &LegsOutcome, report: &LegsReport) -> Vec<Fact> {
    let fact = |label: &str, value: String, note: String| Fact { label: label.into(), value, note };
    let note = match outcome.verdict {
        Verdict::Explained => {
            "named effects bring every residual down to noise on data not used for fits"
        }
        Verdict::NothingMissing => "the declared model's residuals are noise",
        Verdict::Unexplained if is_noise(&outcome.after) => {
            "simulations miss recordings that the same model seems to explain without simulation"
        }
        Verdict::Unexplained => {
            "residuals stand above noise, and no effect with a name explains them"
        }
    };
    let mut facts = vec![fact("Verdict", verdict(outcome.verdict).to_owned(), note.to_owned())];
    for (effect, estimates) in &outcome.effects {
        let values: Vec<String> = estimates
            .iter()
            .map(|e| format!("{} = {} ± {}", e.name, known_to(e.value, e.std), number(e.std)))
            .collect();
        facts.push(fact("Found", in_words(effect), values.join(", ")));
    }
    if let Some(error) = worst(&report.errors) {
        facts.push(fact(
            "Worst channel",
            format!("{} times its floor", number(error.after / error.floor)),
            format!(
                "{} of {}: {} under the declared model, {} calibrated, {} is left to any model",
                error.channel,
                error.run,
                quantity(error.before, error.unit),
                quantity(error.after, error.unit),
                quantity(error.floor, error.unit)
            ),
        ));
    }
    let rattle = &report.rattle;
    facts.push(fact(
        "Rattle",
        if rattle.chaotic { "beyond the sensors' noise" } else { "below the sensors' noise" }
            .to_owned(),
        format!(
            "two runs of the declared model that start a hair apart differ in {} by {} times its \
             sensor's noise; models are compared by means over {} run(s)",
            rattle.channel,
            number(rattle.difference),
            rattle.replicas
        ),
    ));
    facts
}

fn values(outcome: &LegsOutcome, report: &LegsReport) -> PageTable {
    let mut rows = Vec::new();
    for ((effect, _), found) in outcome.effects.iter().zip(&report.effects) {
        for (name, fitted) in &found.params {
            let about = effect.kind.parameter(name).map_or("", |p| p.about);
            let [low, high] = fitted.ci95.map(|end| known_to(end, fitted.std));
            rows.push(vec![
                in_words(effect),
                (*name).to_owned(),
                known_to(fitted.value, fitted.std),
                number(fitted.std),
                format!("{low} to {high}"),
                about.to_owned(),
            ]);
        }
        if let Some(table) = effect.efforts() {
            let [count, meaning] = coefficients(table);
            let none = || "–".to_owned();
            rows.push(vec![
                in_words(effect),
                "coefficients".to_owned(),
                count,
                none(),
                none(),
                meaning,
            ]);
        }
    }
    PageTable {
        id: "effects",
        title: "What the model was given".into(),
        header: ["effect", "parameter", "value", "± standard deviation", "95 % interval", "meaning"]
            .map(str::to_owned)
            .into(),
        rows,
        note: "SI units, as each name says. calibrated.toml holds the rig with these effects: `freeplay \
               run calibrated.toml` simulates it, `freeplay predict calibrated.toml --data RUN.csv` holds \
               it against another recording."
            .into(),
    }
}

/// How many coefficients a table has for each of its efforts, and what they are of.
fn coefficients(table: &Efforts) -> [String; 2] {
    let (each, acts) = if table.depends_on.acts_on_output() {
        ("component", "force along x, force along y and torque on the output")
    } else {
        ("joint", "effort in each joint")
    };
    let count = table.coefficients.first().map_or(0, Vec::len);
    let over = table.depends_on.words();
    [format!("{count} for each {each}"), format!("{acts}, over {over}; in calibrated.toml")]
}

fn equations(report: &LegsReport) -> Vec<String> {
    report.effects.iter().map(why).collect()
}

/// What an effect is and what it rests on, in whole sentences.
pub fn why(effect: &EffectReport) -> String {
    let joint = effect.on.words();
    // Evidence of an effect with a name says what it does, that of a table names what does it.
    let evidence = match (effect.evidence.as_str(), effect.depends_on) {
        ("", _) => String::new(),
        (evidence, None) => format!(" It {evidence}."),
        (evidence, Some(_)) => format!(" What speaks for it: {evidence}."),
    };
    format!("{}{joint}: {}.{evidence}", effect.kind, effect.equation)
}

const ERRORS_NOTE: &str = "Root mean square of measured less predicted, both through a zero-phase low-pass of fourth order at 25 Hz, \
     first and last 60 ms left out. The floor is what sensor noise and the rattle's own unpredictability \
     leave to any model: 1 in the last column is as good as it gets.";

/// Errors by run and channel.
pub fn errors_table(errors: &[ChannelError], note: &str) -> PageTable {
    let rows = errors.iter().map(|e| {
        vec![
            format!("{} ({})", e.run, e.role),
            e.channel.clone(),
            quantity(e.before, e.unit),
            quantity(e.after, e.unit),
            quantity(e.floor, e.unit),
            number(e.after / e.floor),
        ]
    });
    PageTable {
        id: "errors",
        title: "Errors".into(),
        header: ["run", "channel", "before", "after", "floor", "after/floor"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect(),
        note: note.to_owned(),
    }
}

/// A value in m, rad or N for people, in the multiple of its unit that suits it.
pub fn quantity(value: f64, unit: &str) -> String {
    match unit {
        _ if !value.is_finite() => number(value),
        "m" => length(value),
        "rad" => format!("{} mrad", number(1e3 * value)),
        unit => format!("{} {unit}", number(value)),
    }
}

fn dependence(charts: &Charts) -> PageTable {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let rows = charts.shares.iter().enumerate().map(|(leg, shares)| {
        let cells = shares
            .iter()
            .map(|[before, after]| format!("{} → {}", percent(*before), percent(*after)));
        std::iter::once(format!("actuator {}", leg + 1)).chain(cells).collect()
    });
    let over = OVER.iter().map(|(what, _)| format!("over {what}"));
    PageTable {
        id: "depends-on",
        title: "What the residual depends on".into(),
        header: std::iter::once("force not accounted for".to_owned()).chain(over).collect(),
        rows: rows.collect(),
        note: "Share of the variance of the actuator force that inverse dynamics does not account for, \
               that lies between eight bins of each quantity (correlation ratio): declared → calibrated \
               model. Up to a tenth comes by chance; what exceeds it names the family to look in."
            .into(),
    }
}

/// What was tried in a round, which has this number.
fn of_round(number_of_round: usize, round: &LegsRound, outcome: &LegsOutcome) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let mut seen: Vec<&Setting> = Vec::new();
    for scored in &round.ranking {
        if seen.len() == LISTED || seen.iter().any(|other| other.is(&scored.effect)) {
            continue;
        }
        seen.push(&scored.effect);
        let added = round.added.as_ref().is_some_and(|added| added.is(&scored.effect));
        let kept = outcome.effects.iter().any(|(effect, _)| effect.is(&scored.effect));
        rows.push(vec![
            number_of_round.to_string(),
            in_words(&scored.effect),
            format!("{:.1} %", 100.0 * scored.share),
            number(scored.gain),
            if scored.simulated { "yes" } else { "no" }.to_owned(),
            match (added, kept) {
                (true, true) => "kept",
                (true, false) => "taken, not kept in the end",
                _ => "",
            }
            .to_owned(),
        ]);
    }
    if round.added.is_none() {
        rows.push(vec![
            number_of_round.to_string(),
            "none of them".to_owned(),
            String::new(),
            String::new(),
            String::new(),
            "the search ends".to_owned(),
        ]);
    }
    rows
}

/// Tables over one quantity or another that stand in for what has no name.
fn of_tables(described: &DescribedEfforts) -> impl Iterator<Item = Vec<String>> {
    described.others.iter().map(|(depends_on, share)| {
        let table = described.effect.efforts();
        let kept = table.is_some_and(|table| table.depends_on == *depends_on);
        vec![
            "–".to_owned(),
            format!("a table over {}", depends_on.words()),
            format!("{:.1} %", 100.0 * share.max(0.0)),
            "–".to_owned(),
            "no".to_owned(),
            if kept { "kept" } else { "" }.to_owned(),
        ]
    })
}

fn candidates(outcome: &LegsOutcome) -> PageTable {
    let rounds = outcome.rounds.iter().enumerate();
    let mut rows: Vec<Vec<String>> =
        rounds.flat_map(|(i, round)| of_round(i + 1, round, outcome)).collect();
    rows.extend(outcome.described.iter().flat_map(of_tables));
    PageTable {
        id: "candidates",
        title: "Candidates, round by round".into(),
        header: ["round", "candidate", "removes of what is above noise", "gain", "simulated", ""]
            .map(str::to_owned)
            .into(),
        rows,
        note: "Scores on data not used for a candidate's fit. In each round every effect is tried at every \
               joint beside what was taken before; those that promise most are simulated. Gain is the drop \
               of the sum of squares in units of noise, less what a candidate's values bring by chance. \
               The best few of each round; all are in report.json."
            .into(),
    }
}

fn residuals(report: &LegsReport) -> PageTable {
    let rows = report.residuals.iter().map(|r| {
        vec![
            r.residual.to_owned(),
            format!("{} → {}", number(r.mean_square_before), number(r.mean_square_after)),
            number(r.noise_up_to),
            format!("{} → {}", number(r.largest_before), number(r.largest_after)),
        ]
    });
    PageTable {
        id: "residuals",
        title: "Residuals in units of noise".into(),
        header: ["residual", "mean square", "noise up to", "largest"].map(str::to_owned).into(),
        rows: rows.collect(),
        note: "On data not used for fits, under the declared model → with the named effects; 1 is noise. \
               Servo: does the drive obey its own law? Closure: do measured pose and lengths fit the \
               geometry? Dynamics: are the measured forces those that the measured motion takes?"
            .into(),
    }
}

fn provenance(case: &LegsCase, report: &LegsReport) -> Vec<(String, String)> {
    let runs: Vec<&str> = case.runs.iter().map(|run| run.log.name.as_str()).collect();
    let replicas = report.seeds.replicas.len();
    let more = [
        ("Runs", runs.join(", ")),
        (
            "Excluded effects",
            if report.without.is_empty() { "none".to_owned() } else { report.without.join(", ") },
        ),
        ("Seeds", format!("rig {}, replicas 0 to {}", report.seeds.scenario, replicas - 1)),
        ("Error allowed for a step", format!("{} m/s", number(report.tolerance_m_s))),
        ("Simulations of a run", report.simulations.to_string()),
        ("Figures", "report.json beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(report.wall_s))),
    ];
    report.provenance.lines("rig", None, more)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::results::report::Depends;
    use crate::effects::Over;

    #[test]
    fn a_table_is_said_to_act_where_it_acts() {
        let said = |depends_on, joints: &[&str], features| {
            let joints: Vec<String> = joints.iter().map(|joint| (*joint).to_owned()).collect();
            let empty = Efforts::empty(depends_on, joints, &[[0.0, 1.0, 1.0]; 3]);
            coefficients(&Efforts { coefficients: vec![vec![0.0; features]; 3], ..empty })
        };
        let [count, meaning] = said(Over::OutputPosition, &[], 51);
        assert_eq!(count, "51 for each component");
        assert!(meaning.contains("torque on the output, over the output's position"), "{meaning}");
        let [count, meaning] = said(Over::JointPosition, &["P1", "P2", "P3"], 14);
        assert_eq!(count, "14 for each joint");
        assert!(meaning.starts_with("effort in each joint, over the coordinate"), "{meaning}");
    }

    #[test]
    fn evidence_of_either_kind_makes_a_sentence() {
        let effect = |depends_on, evidence: &str| EffectReport {
            kind: "kind",
            on: super::super::report::ActsOn::machine(),
            depends_on,
            params: Vec::new(),
            evidence: evidence.to_owned(),
            as_good: Vec::new(),
            equation: "f = 0",
        };
        assert_eq!(why(&effect(None, "removes it")), "kind: f = 0. It removes it.");
        let map =
            effect(Some(Depends::Efforts(Over::OutputVelocity)), "a force that varies removes it");
        assert_eq!(why(&map), "kind: f = 0. What speaks for it: a force that varies removes it.");
        assert_eq!(why(&effect(None, "")), "kind: f = 0.");
    }
}
