//! What trials come to: rates by requirement and by machine, each with what chance leaves open.

use super::trial::HiddenValue;
use super::{Case, TrialAnswer, TriedTrial};
use crate::calibrate::results::verdict::Verdict;
use crate::measure::student::NORMAL95;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Floors above which what is hidden must be found.
const LARGE: f64 = 3.0;

/// A requirement: its words, what is asked, and what counts of a trial.
type Requirement = (&'static str, &'static str, fn(&TriedTrial, &TrialAnswer) -> Vec<bool>);

/// What is asked of the method.
const ROWS: &[Requirement] = &[
    ("one effect above three floors: named, and nothing beside it", "≥ 90 %", |t, a| {
        when(t.trial.case == Case::One && a.floors > LARGE, a.right)
    }),
    ("a wrong instrument above three floors: the same", "≥ 90 %", |t, a| {
        when(t.trial.case == Case::Instrument && !lacks_none(t) && a.floors > LARGE, a.right)
    }),
    (
        "two effects, each above three floors: both named, and nothing beside them",
        "≥ 90 %",
        |t, a| {
            when(t.trial.case == Case::Two && a.least.is_some_and(|least| least > LARGE), a.right)
        },
    ),
    ("explained by a name that is not hidden", "≤ 3 %", |_, a| vec![a.wrong_name]),
    ("the same, and what is hidden is not held for as good", "", |_, a| {
        vec![a.wrong_name && !a.as_good]
    }),
    ("nothing hidden, but not `nothing-missing`", "≤ 3 %", |t, a| {
        when(lacks_none(t), a.verdict != Verdict::NothingMissing)
    }),
    ("an effect that is no candidate: `unexplained`", "≥ 90 %", |t, a| {
        when(t.trial.case == Case::Withheld && a.floors > LARGE, a.right)
    }),
    ("values of right answers inside their 95 % intervals", "90–99 %", |_, a| {
        a.values.iter().filter(|_| a.right).map(covered).collect()
    }),
    (
        "values of right answers above three floors within 10 %, phases and zeros aside",
        "",
        |_, a| {
            let counts = a.right && a.floors > LARGE;
            let sized = a.values.iter().filter(|v| counts && !is_phase(v) && v.truth != 0.0);
            sized.map(near).collect()
        },
    ),
    ("one effect or instrument below three floors: named, and nothing beside it", "", |t, a| {
        let single = matches!(t.trial.case, Case::One | Case::Instrument) && !lacks_none(t);
        when(single && a.floors <= LARGE, a.right)
    }),
    ("two effects, one of them below three floors: the same of both", "", |t, a| {
        when(t.trial.case == Case::Two && a.least.is_some_and(|least| least <= LARGE), a.right)
    }),
    ("an effect below three floors that is no candidate: `unexplained`", "", |t, a| {
        when(t.trial.case == Case::Withheld && a.floors <= LARGE, a.right)
    }),
    ("a sensor noisier than declared: `nothing-missing`, and its name", "", |t, a| {
        when(t.trial.case == Case::Instrument && lacks_none(t), a.right)
    }),
    ("anything above three floors: named, or held for as good as what was named", "", |t, a| {
        let above = a.least.unwrap_or(a.floors) > LARGE;
        when(above && !lacks_none(t) && t.trial.case != Case::Withheld, a.right || a.as_good)
    }),
];

/// One answer where it counts.
fn when(counts: bool, answer: bool) -> Vec<bool> {
    if counts { vec![answer] } else { Vec::new() }
}

/// Whether nothing is missing in a trial: at most noise is not as declared.
fn lacks_none(tried: &TriedTrial) -> bool {
    tried.trial.hidden.iter().all(|kind| kind == super::NOISE)
}

/// Markdown tables of rates with their 95 % intervals and of times, over all machines and for each; below them all
/// trials whose answer was wrong.
pub fn rates(all: &[TriedTrial]) -> String {
    let machines: BTreeSet<&str> = all.iter().map(|tried| tried.trial.machine.as_str()).collect();
    let answered = |machine: Option<&str>| -> Vec<(&TriedTrial, &TrialAnswer)> {
        let own = all.iter().filter(|t| machine.is_none_or(|name| t.trial.machine == name));
        own.filter_map(|tried| tried.answer.as_ref().map(|answer| (tried, answer))).collect()
    };
    let columns: Vec<Option<&str>> =
        std::iter::once(None).chain(machines.iter().copied().map(Some)).collect();
    let line = |first: &str, asked: &str, cell: &dyn Fn(Option<&str>) -> String| {
        let cells: Vec<String> = columns.iter().map(|machine| cell(*machine)).collect();
        format!("| {first} | {asked} | {} |\n", cells.join(" | "))
    };
    let mut text = line("", "asked", &|machine| machine.unwrap_or("all").to_owned());
    text += &line("---", "---", &|_| "---".to_owned());
    for (heading, asked, counts) in ROWS {
        text += &line(heading, asked, &|machine| {
            let marks: Vec<bool> =
                answered(machine).into_iter().flat_map(|(t, a)| counts(t, a)).collect();
            share(&marks)
        });
    }
    text += &line("seconds of a calibration: median, largest", "", &|machine| {
        middle_and_most(answered(machine).iter().map(|(_, answer)| answer.seconds))
    });
    text += &line("simulations of a calibration: median, largest", "", &|machine| {
        middle_and_most(answered(machine).iter().map(|(_, answer)| answer.simulations as f64))
    });
    let versions: BTreeSet<&str> = all.iter().map(|tried| tried.version.as_str()).collect();
    let versions: Vec<&str> = versions.into_iter().collect();
    let unasked: Vec<&TriedTrial> = all.iter().filter(|tried| tried.answer.is_none()).collect();
    let asked = all.len() - unasked.len();
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(text, "\n{asked} trials of {}.", versions.join(", "));
    if !unasked.is_empty() {
        text += "\nNot asked:\n";
    }
    for tried in unasked {
        let trial = &tried.trial;
        let why = tried.unasked.as_deref().unwrap_or_default();
        let hidden = trial.hidden.join(", ");
        let _ = writeln!(
            text,
            "* {} {} × {:.2}, {hidden}: {why}",
            trial.seed, trial.machine, trial.size
        );
    }
    text + &wrong(all)
}

/// The middle and the largest of some numbers.
fn middle_and_most(numbers: impl Iterator<Item = f64>) -> String {
    let mut sorted: Vec<f64> = numbers.collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.get(sorted.len() / 2);
    middle.zip(sorted.last()).map_or_else(|| "–".to_owned(), |(m, l)| format!("{m:.0}, {l:.0}"))
}

/// Every trial whose answer was wrong.
fn wrong(all: &[TriedTrial]) -> String {
    let wrong = all.iter().filter_map(|tried| {
        let answer = tried.answer.as_ref().filter(|answer| !answer.right)?;
        let trial = &tried.trial;
        let (case, found) = (super::draw::word(trial.case), &answer.found);
        let least =
            answer.least.map_or_else(String::new, |least| format!(", the lesser {least:.1}"));
        Some(format!(
            "| {} | {} × {:.2} | {case}: {} | {:.1}{least} | `{}`: {found} |\n",
            trial.seed,
            trial.machine,
            trial.size,
            answer.lacks,
            answer.floors,
            answer.verdict.word(),
        ))
    });
    let rows: String = wrong.collect();
    if rows.is_empty() {
        return rows;
    }
    format!("\n| seed | machine | hidden | floors | answer |\n|---|---|---|---|---|\n{rows}")
}

/// The largest relative error of a value that counts as near.
const NEAR: f64 = 0.1;

/// Whether a value is a phase, which near another one says nothing of its effect's size.
fn is_phase(value: &HiddenValue) -> bool {
    value.name.ends_with("phase_rad")
}

/// Whether a value was found within 10 %.
fn near(value: &HiddenValue) -> bool {
    (value.value - value.truth).abs() < NEAR * value.truth.abs()
}

/// Whether the true value lies in the 95 % interval of the one that was found.
fn covered(value: &HiddenValue) -> bool {
    value.std.is_some_and(|std| (value.value - value.truth).abs() < NORMAL95 * std)
}

/// `9 of 10 (90 %, 60–98)`.
fn share(of: &[bool]) -> String {
    let right = of.iter().filter(|right| **right).count();
    let Some([low, high]) = wilson(right, of.len()) else { return "–".to_owned() };
    // No minus before a zero.
    let percent = |share: f64| (100.0 * share).round() + 0.0;
    let share = percent(right as f64 / of.len() as f64);
    format!("{right} of {} ({share} %, {}–{})", of.len(), percent(low), percent(high))
}

/// The 95 % interval of a share of `of` independent trials of which `right` were right (Wilson, J. Am.
/// Stat. Assoc. 22 (1927) 209–212); none without trials.
fn wilson(right: usize, of: usize) -> Option<[f64; 2]> {
    if of == 0 {
        return None;
    }
    let n = of as f64;
    let share = right as f64 / n;
    let middle = (share + NORMAL95 * NORMAL95 / (2.0 * n)) / (1.0 + NORMAL95 * NORMAL95 / n);
    let half = NORMAL95 / (1.0 + NORMAL95 * NORMAL95 / n)
        * (share * (1.0 - share) / n + NORMAL95 * NORMAL95 / (4.0 * n * n)).sqrt();
    Some([middle - half, middle + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table that users read is that of the trials beside it, and these are of one version.
    #[test]
    fn the_docs_show_the_table_that_follows_from_the_trials() {
        let trials = include_str!("../../../../assets/self-test/trials.jsonl");
        let all: Vec<TriedTrial> =
            trials.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert!(all.windows(2).all(|pair| pair[0].version == pair[1].version));
        let docs = include_str!("../../../../docs/calibrate.md");
        let (_, rest) = docs.split_once("<!-- rates -->\n").unwrap();
        let (shown, _) = rest.split_once("<!-- end of rates -->").unwrap();
        assert_eq!(shown, rates(&all));
    }
}
