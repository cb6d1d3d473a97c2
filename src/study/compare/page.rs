//! The page of a comparison: a plain answer, then tables and pictures.

use super::quantities::QUANTITIES;
use super::result::{ChaosResult, Comparison, RowResult};
use super::statistics::Behaviour;
use super::usable::NativeUse;
use super::verdict::{criteria, in_words};
use crate::report::{Fact, PagePart, PageTable, Picture, document, length, number};
use crate::results::SCENARIO_FILE;
use crate::scenario::Law;

/// The page as HTML.
pub fn page(comparison: &Comparison, pictures: &[Picture]) -> String {
    let facts = facts(comparison);
    let provenance = provenance(comparison);
    // The first sentence of the answer leads, the others follow.
    let mut answer = comparison.answer.clone();
    let lead = if answer.is_empty() { String::new() } else { answer.remove(0) };
    answer.push(method(comparison));
    let parts = [
        PagePart::Text { id: "answer", title: "Answer", paragraphs: &answer },
        PagePart::Table(verdicts(comparison)),
        PagePart::Facts(&facts),
        PagePart::Table(side_by_side(comparison)),
        PagePart::Table(law_over_steps(comparison)),
        PagePart::Table(limits(comparison)),
        PagePart::Pictures(pictures),
        PagePart::Provenance(&provenance),
    ];
    let title = format!("Contact models compared: {}", comparison.provenance.scenario_name);
    document(&title, &lead, &parts)
}

/// How it was compared.
fn method(c: &Comparison) -> String {
    format!(
        "The same motion under the contact law (hertz-step), under the contacts that the physics \
         engine itself has (native), and without clearance (ideal). Every figure is a mean over {} \
         starts of {} s, ± its standard error, the first {} s left out.",
        c.starts,
        number(c.duration_s),
        number(c.settle_s)
    )
}

fn facts(c: &Comparison) -> Vec<Fact> {
    let fact = |label: &str, value: String, note: String| Fact { label: label.into(), value, note };
    let n = &c.native;
    let mut facts = vec![
        fact(
            "Native contacts: spring",
            format!("{} Hz, damping ratio {}", number(n.frequency), number(n.damping_ratio)),
            n.origin.clone(),
        ),
        fact(
            "Native contacts: solver",
            format!("{} sweeps a step", n.iterations),
            format!(
                "restitution {} beside the spring; {}",
                number(n.restitution),
                if n.predictive {
                    "journals about to arrive are stopped at the ring (native.predictive)"
                } else {
                    "journals are left alone until they touch (native.predictive = false)"
                }
            ),
        ),
    ];
    if let Some(hits) = &c.first_hits {
        let power = |p: Option<[f64; 2]>| {
            p.map_or("–".to_owned(), |[p, s]| format!("step^({} ± {})", number(p), number(s)))
        };
        facts.push(fact(
            "First hit under the law",
            format!("{} N", number(hits.exact.mean)),
            format!("exact, mean of the starts; error goes like {}", power(hits.law_order)),
        ));
        let finest = hits.rows.iter().rfind(|hit| hit.law == Law::Native);
        facts.push(fact(
            "First hit, native",
            finest.map_or("–".to_owned(), |hit| format!("{} N", number(hit.peak.mean))),
            format!("at the shortest step; goes like {}", power(hits.native_power)),
        ));
    }
    if let Some(chaos) = &c.chaos {
        facts.extend(chaos_facts(chaos));
    }
    facts
}

fn chaos_facts(chaos: &ChaosResult) -> [Fact; 2] {
    let rate = chaos.lyapunov_exponent_1_s;
    [
        Fact {
            label: "Largest Lyapunov exponent".into(),
            value: format!("{} ± {} 1/s", number(rate.mean), number(rate.sem)),
            note: chaos.e_folding_s.map_or_else(
                || "no sure growth: motions that begin alike stay alike".to_owned(),
                |time| format!("small differences grow by e every {} ms", number(1e3 * time)),
            ),
        },
        Fact {
            label: "Predictability horizon".into(),
            value: chaos.predictability_horizon_s.map_or_else(
                || format!("beyond {} s", number(chaos.window_s)),
                |time| format!("{} s", number(time)),
            ),
            note: format!(
                "until then the law's runs at their tolerance are exact to {} at the output body{}",
                length(chaos.horizon_error_m),
                if chaos.e_folding_s.is_some() {
                    "; later digits are one of many motions"
                } else {
                    ""
                }
            ),
        },
    ]
}

fn row_name(row: &RowResult) -> String {
    let how = match (row.step_s, row.tolerance_m_s) {
        (Some(step), _) => format!("{} s", number(step)),
        (None, Some(tolerance)) => format!("tolerance {}", number(tolerance)),
        (None, None) => String::new(),
    };
    let remark = row.remark().map_or(String::new(), |remark| format!(" ({remark})"));
    format!("{}, {how}{remark}", row.law.name())
}

/// Quantities down; across, what can be compared: the law at its tolerance, native contacts at every
/// step, ideal joints.
fn side_by_side(c: &Comparison) -> PageTable {
    let law = c.best(Law::HertzStep).into_iter();
    let columns: Vec<&RowResult> =
        law.chain(c.rows_of(Law::Native)).chain(c.best(Law::Ideal)).collect();
    PageTable {
        id: "side-by-side",
        title: "Side by side".into(),
        note: "Contact forces are over the time in contact of all joints, sampled every 0.1 ms, peaks \
               over all steps. Energy lost is the work of the normal forces, ∫ F dδ over all steps, \
               exact to a few percent. Native contacts report impulses; their forces are means over a \
               step. Computing time is that of one core while all are busy."
            .into(),
        ..columns_table(&columns)
    }
}

/// The law at all its steps.
fn law_over_steps(c: &Comparison) -> PageTable {
    let columns: Vec<&RowResult> = c.rows_of(Law::HertzStep).collect();
    PageTable {
        id: "law-steps",
        title: "The law at its steps".into(),
        note: "\"Too long\": the step does not resolve the law's hits, or a servo. \"With faults\": runs whose \
               energy does not balance, or whose rigid joints came apart."
            .into(),
        ..columns_table(&columns)
    }
}

fn columns_table(columns: &[&RowResult]) -> PageTable {
    let header = std::iter::once(String::new()).chain(columns.iter().map(|row| row_name(row)));
    let quantities = QUANTITIES.iter().enumerate().map(|(i, quantity)| {
        let cells = columns.iter().map(|row| {
            let mean = row.quantities[i];
            match (mean.mean.is_finite(), mean.sem > 0.0) {
                (false, _) if row.halted == row.starts => "broke down".to_owned(),
                (false, _) => "–".to_owned(),
                (true, false) => in_words(quantity, mean.mean),
                (true, true) => {
                    format!("{} ± {}", in_words(quantity, mean.mean), in_words(quantity, mean.sem))
                }
            }
        });
        std::iter::once(quantity.label.to_owned()).chain(cells).collect()
    });
    let cost = columns.iter().map(|row| number(row.wall_s_per_simulated_s));
    let cost = std::iter::once("computing, s per simulated s".to_owned()).chain(cost).collect();
    PageTable {
        id: "",
        title: String::new(),
        header: header.collect(),
        rows: quantities.chain([cost]).collect(),
        note: String::new(),
    }
}

/// What each quantity converges to.
fn limits(c: &Comparison) -> PageTable {
    let laws = [Law::HertzStep, Law::Native];
    let rows = QUANTITIES.iter().enumerate().map(|(i, quantity)| {
        let mut cells = vec![quantity.label.to_owned()];
        for law in laws {
            let cell = c.trend(law, quantity.key).map_or("–".to_owned(), |trend| {
                let power = format!("step^({} ± {})", number(trend.power), number(trend.power_std));
                match (trend.behaviour, trend.limit, trend.ci95) {
                    (_, Some(limit), Some([low, high])) => format!(
                        "{} ({} to {})",
                        in_words(quantity, limit),
                        in_words(quantity, low),
                        in_words(quantity, high)
                    ),
                    (Behaviour::Grows, ..) => format!("no limit: grows, {power}"),
                    (Behaviour::Shrinks, ..) => format!("no limit yet: shrinks, {power}"),
                    _ => "too few steps".to_owned(),
                }
            });
            cells.push(cell);
        }
        let best = c.best(Law::HertzStep).map(|row| row.quantities[i]);
        cells.push(best.map_or("–".to_owned(), |mean| {
            format!("{} ± {}", in_words(quantity, mean.mean), in_words(quantity, mean.sem))
        }));
        cells
    });
    PageTable {
        id: "limits",
        title: "What each converges to".into(),
        header: ["quantity", "hertz-step, step → 0", "native, step → 0", "hertz-step at its tolerance"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect(),
        note: "Limit and 95 % interval of y = y₀ + b·step² (law) or y₀ + b·step (native), weighted \
               with the scatter over the starts; steps that are too long are left out. Where a power \
               of the step differs from zero surely, it stands instead. The last column does not \
               share a step with the others: it is a check on them."
            .into(),
    }
}

fn verdicts(c: &Comparison) -> PageTable {
    let rows = c.verdicts.iter().map(|verdict| {
        let quantity = QUANTITIES.iter().find(|q| q.key == verdict.quantity);
        let usable = match verdict.usable {
            NativeUse::Yes => "yes",
            NativeUse::Size => "as a size",
            NativeUse::No => "no",
            NativeUse::Unclear => "unclear",
        };
        let label = quantity.map_or(verdict.quantity, |q| q.label);
        vec![label.to_owned(), usable.to_owned(), verdict.reason.clone()]
    });
    PageTable {
        id: "verdicts",
        title: "May native contacts be used?".into(),
        header: ["quantity", "native", "why"].map(str::to_owned).into(),
        rows: rows.collect(),
        note: criteria(),
    }
}

fn provenance(c: &Comparison) -> Vec<(String, String)> {
    let more = [
        ("Seed", c.seed.to_string()),
        ("Figures", "compare.json, compare.csv beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(c.wall_s))),
    ];
    c.provenance.lines("scenario", Some(SCENARIO_FILE), more)
}
