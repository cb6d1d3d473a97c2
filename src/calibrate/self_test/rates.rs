//! What trials come to: rates of right answers, each with what chance leaves open.

use super::{HiddenValue, LegsTried};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Floors above which what is hidden must be found.
const LARGE: f64 = 3.0;

/// The largest relative error of a value that counts as near.
const NEAR: f64 = 0.1;

/// A kind of trial: its heading, and which trials are of it.
type TrialKind = (&'static str, fn(&LegsTried) -> bool);

/// The kinds of trials of which one asks how many were right.
const RIGHT: [TrialKind; 6] = [
    ("one effect above three floors: named, and nothing beside it", |tried| {
        single(tried) && tried.floors > LARGE
    }),
    ("one effect below three floors: the same", |tried| single(tried) && tried.floors <= LARGE),
    ("nothing hidden: `nothing-missing`", |tried| tried.trial.hidden.is_empty()),
    ("two effects, each above three floors: both named, and nothing beside them", |tried| {
        tried.least.is_some_and(|least| least > LARGE)
    }),
    ("two effects, one of them below three floors: the same", |tried| {
        tried.least.is_some_and(|least| least <= LARGE)
    }),
    ("an effect that is no candidate: `unexplained`", |tried| tried.trial.withheld),
];

fn single(tried: &LegsTried) -> bool {
    !tried.trial.withheld && tried.trial.hidden.len() == 1
}

/// A Markdown table of rates, with gravity and without, each with its 95 % interval; below it every
/// trial whose answer was wrong.
pub fn rates(all: &[LegsTried]) -> String {
    let mut text = "| | with gravity | without: joints rattle |\n|---|---|---|\n".to_owned();
    let mut row = |heading: &str, of: &dyn Fn(&LegsTried) -> Vec<bool>| {
        let cell = |gravity: bool| {
            let own = all.iter().filter(|tried| tried.trial.gravity == gravity);
            share(&own.flat_map(of).collect::<Vec<_>>())
        };
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(text, "| {heading} | {} | {} |", cell(true), cell(false));
    };
    for (heading, belongs) in RIGHT {
        row(heading, &|tried| belongs(tried).then_some(tried.right).into_iter().collect());
    }
    row("values of these right answers above three floors within 10 %, phases aside", &|tried| {
        let counts = tried.right && tried.floors > LARGE;
        let values = tried.values.iter().filter(|value| counts && !is_phase(value));
        values.map(near).collect()
    });
    row("values of all right answers inside their 95 % intervals", &|tried| {
        tried.values.iter().filter(|_| tried.right).map(covered).collect()
    });
    let wrong: BTreeMap<(String, String), usize> =
        all.iter().filter(|tried| !tried.right).fold(BTreeMap::new(), |mut counts, tried| {
            *counts.entry((hidden(tried), found(tried))).or_default() += 1;
            counts
        });
    if !wrong.is_empty() {
        text += "\n| hidden | answer where it was wrong | trials |\n|---|---|---|\n";
    }
    for ((hidden, found), count) in wrong {
        let _ = writeln!(text, "| {hidden} | {found} | {count} |");
    }
    text
}

fn hidden(tried: &LegsTried) -> String {
    let gravity = if tried.trial.gravity { "with gravity" } else { "without gravity" };
    let withheld = if tried.trial.withheld { ", no candidate" } else { "" };
    let least =
        tried.least.map_or_else(String::new, |least| format!(", the lesser one {least:.1}"));
    format!("{} ({:.1} floors{least}, {gravity}{withheld})", tried.lacks, tried.floors)
}

fn found(tried: &LegsTried) -> String {
    format!("`{}`: {}", tried.verdict.word(), tried.found)
}

/// Whether a value is a phase, which near another one says nothing of its effect's size.
pub(in crate::calibrate) fn is_phase(value: &HiddenValue) -> bool {
    value.name.ends_with("phase_rad")
}

/// Whether a value was found within 10 %.
pub(in crate::calibrate) fn near(value: &HiddenValue) -> bool {
    (value.value - value.truth).abs() < NEAR * value.truth.abs()
}

/// Whether the true value lies in the 95 % interval of the one that was found.
pub(in crate::calibrate) fn covered(value: &HiddenValue) -> bool {
    value.std.is_some_and(|std| (value.value - value.truth).abs() < 1.96 * std)
}

/// `9 of 10 (90 %, 60–98)`.
pub(in crate::calibrate) fn share(of: &[bool]) -> String {
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
    const Z: f64 = 1.96;
    if of == 0 {
        return None;
    }
    let n = of as f64;
    let share = right as f64 / n;
    let middle = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    Some([middle - half, middle + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newcombe, Statistics in Medicine 17 (1998) 857–872, table I: 81 of 263, 15 of 148, 0 of 20.
    #[test]
    fn intervals_are_published_ones() {
        for (right, of, expected) in
            [(81, 263, [0.2553, 0.3662]), (15, 148, [0.0624, 0.1605]), (0, 20, [0.0, 0.1611])]
        {
            let interval = wilson(right, of).unwrap();
            for (found, expected) in interval.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-4, "{right} of {of}: {interval:?}");
            }
        }
        assert_eq!(wilson(0, 0), None);
    }

    #[test]
    fn the_docs_show_the_table_that_follows_from_the_trials() {
        let trials = include_str!("../../../assets/self-test/trials.jsonl");
        let all: Vec<LegsTried> =
            trials.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let docs = include_str!("../../../docs/calibrate.md");
        let (_, rest) = docs.split_once("<!-- rates -->\n").unwrap();
        let (shown, _) = rest.split_once("<!-- end of rates -->").unwrap();
        assert_eq!(shown, rates(&all));
    }
}
