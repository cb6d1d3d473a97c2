//! The page of a comparison of laws.

use super::result::{LawRow, LawsCompared};
use crate::report::{
    Curve, Label, PagePart, PageTable, Panel, Picture, Style, document, number, panels_svg,
};
use crate::results::RunError;
use crate::results::SCENARIO_FILE;
use crate::study::compare::probe::CompareMeasured;
use crate::study::compare::quantities::{ComparedQuantity, QUANTITIES, index};
use crate::study::compare::statistics::Mean;
use crate::study::compare::verdict::in_words;

/// Quantities of the first table and of the picture: where the machine is, what its joints and its output feel,
/// how often.
const SHOWN: [&str; 5] = [
    "rms_path_error_m",
    "peak_contact_force_N",
    "peak_platform_acceleration_m_s2",
    "contact_fraction",
    "impacts_per_s",
];

/// The page as HTML.
pub(super) fn page(compared: &LawsCompared, pictures: &[Picture]) -> String {
    let title = format!("Contact laws compared: {}", compared.provenance.scenario_name);
    let method = format!(
        "The same motion under every law, at equal restitution where it can be matched: the parameter of each \
         is such that hits at {} m/s return {} of their speed, as under the scenario's own law, the first. \
         Every figure is a mean over {} starts of {} s, ± its standard error, the first {} s left out.",
        number(compared.speed_m_s),
        number(compared.restitution),
        compared.starts,
        number(compared.duration_s),
        number(compared.settle_s)
    );
    let more = [
        ("Figures", "compare-laws.json, compare-laws.csv beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(compared.wall_s))),
    ];
    let provenance = compared.provenance.lines("scenario", Some(SCENARIO_FILE), more);
    let parts = [
        PagePart::Table(dependences(compared)),
        PagePart::Text { id: "method", title: "How it was compared", paragraphs: &[method] },
        PagePart::Table(laws(compared)),
        PagePart::Pictures(pictures),
        PagePart::Provenance(&provenance),
    ];
    document(&title, &answer(compared), &parts)
}

/// What depends on the law, in words.
fn answer(compared: &LawsCompared) -> String {
    let found = || compared.dependences.iter().zip(&QUANTITIES);
    let depends: Vec<&str> =
        found().filter(|(found, _)| found.depends).map(|(_, quantity)| quantity.label).collect();
    let all = compared.dependences.len();
    match depends.as_slice() {
        [] => format!(
            "Over {} starts, none of {all} quantities depends on the law by more than chance.",
            compared.starts
        ),
        some => format!(
            "{} of {all} quantities depend on the law by more than chance: {}.",
            some.len(),
            some.join("; ")
        ),
    }
}

/// The chosen quantities with their places in the list.
fn shown() -> impl Iterator<Item = (usize, &'static ComparedQuantity)> {
    SHOWN.into_iter().filter_map(|key| index(key).map(|i| (i, &QUANTITIES[i])))
}

fn with_error(quantity: &ComparedQuantity, mean: Mean) -> String {
    format!("{} ± {}", in_words(quantity, mean.mean), in_words(quantity, mean.sem))
}

/// The law's parameter in words.
fn parameter(row: &LawRow) -> String {
    match (row.key, row.value) {
        (Some(key), Some(value)) => format!("{key} = {}", number(value)),
        _ => "as it is".to_owned(),
    }
}

fn laws(compared: &LawsCompared) -> PageTable {
    let rows = compared.rows.iter().map(|row| {
        let matched = if row.matched { "" } else { ", cannot be matched" };
        let halted = match row.halted {
            0 => String::new(),
            runs => format!("; {runs} of {} runs broke down", compared.starts),
        };
        let returned = format!("{}{matched}{halted}", number(row.returned));
        let figures = shown().map(|(i, quantity)| with_error(quantity, row.quantities[i]));
        [row.law.to_owned(), parameter(row), returned].into_iter().chain(figures).collect()
    });
    let header = ["law", "parameter", "returned"].map(str::to_owned).into_iter();
    PageTable {
        id: "laws",
        title: "Law by law".into(),
        header: header.chain(shown().map(|(_, quantity)| quantity.label.to_owned())).collect(),
        rows: rows.collect(),
        note: "Laws that cannot return as much, or lose as much, have their nearest parameter."
            .into(),
    }
}

fn dependences(compared: &LawsCompared) -> PageTable {
    let value = |law: Option<&str>, i: usize| {
        let row = compared.rows.iter().find(|row| Some(row.law) == law);
        row.map_or_else(String::new, |row| {
            format!("{} ({})", in_words(&QUANTITIES[i], row.quantities[i].mean), row.law)
        })
    };
    let rows = compared.dependences.iter().enumerate().map(|(i, found)| {
        let answer = if found.depends { "yes" } else { "no more than by chance" };
        vec![
            QUANTITIES[i].label.to_owned(),
            answer.to_owned(),
            value(found.lowest, i),
            value(found.highest, i),
            found.differing.join(", "),
        ]
    });
    PageTable {
        id: "dependences",
        title: "What depends on the law".into(),
        header: ["quantity", "depends", "smallest", "largest", "differ from the first law"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect(),
        note: "Of laws with equal restitution: a mean differs where it is farther from that under the first law \
               than one and a half times the 95 % interval of their difference over the starts, and than 1 %."
            .into(),
    }
}

/// Every start under every law, so that the scatter shows beside the difference.
pub(super) fn pictures(
    compared: &LawsCompared,
    runs: &[Vec<CompareMeasured>],
) -> Result<Vec<Picture>, RunError> {
    let panel = |(i, quantity): (usize, &ComparedQuantity)| {
        let curves = compared.rows.iter().zip(runs).enumerate().map(|(k, (row, runs))| Curve {
            name: format!("{} {}", k + 1, row.law),
            points: runs.iter().map(|run| ((k + 1) as f64, run.values[i])).collect(),
            style: Style::Dots,
        });
        Panel {
            title: quantity.label.to_owned(),
            x_label: Label::counted("law"),
            y_label: quantity.unit.into(),
            curves: curves.collect(),
        }
    };
    let panels: Vec<Panel> = shown().map(panel).collect();
    Ok(vec![Picture {
        file: "laws.svg".to_owned(),
        title: "Every start under every law".to_owned(),
        caption: "One dot a run. Where the dots of a law lie apart from those of the first, the law matters more \
                  than chaos."
            .to_owned(),
        svg: panels_svg(&panels)?,
    }])
}
