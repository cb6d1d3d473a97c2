//! What native contacts may be used for, by stated criteria.

use super::quantities::{ComparedQuantity, QUANTITIES, index};
use super::result::{Comparison, RowResult};
use super::statistics::{Behaviour, Mean, Trend};
use super::usable::{NativeUse, QuantityVerdict};
use crate::measure::student::NORMAL95;
use crate::report::{length, number};
use crate::scenario::Law;

/// Difference from the law, as a share of the law's value, within which a value may be used.
const CLOSE: f64 = 0.1;

/// Factor between native and law within which a value may be used as a size.
const SIZE: f64 = 1.5;

/// Number of standard errors of the difference that count as scatter.
const SCATTER: f64 = 2.0;

/// The criteria in words, as the page states them.
pub fn criteria() -> String {
    format!(
        "Criteria: \"yes\" where the native value has a limit as the step shrinks, and this limit \
         differs from the law's value by at most {} % or {SCATTER} standard errors of the \
         difference; \"as a size\" where it has a limit within a factor of {SIZE}; \"no\" where the \
         limit is farther off or there is none (over the shorter half of the steps the \
         value follows a power whose exponent differs from zero by more than 0.2 and three standard \
         errors); \"unclear\" where the scatter over the starts is too large to tell.",
        number(100.0 * CLOSE)
    )
}

/// Judges every quantity that the machine has: one that no row has a value of, such as the actuator
/// forces of a machine without actuators, is none of it.
pub fn verdicts(comparison: &Comparison) -> Vec<QuantityVerdict> {
    let judge = |(i, quantity): (usize, &ComparedQuantity)| {
        comparison.rows.iter().find(|row| row.quantities[i].mean.is_finite())?;
        let law = comparison.best(Law::HertzStep)?.quantities[i];
        if !touches(comparison) {
            let reason = "no journal touched its ring: nothing can be told".to_owned();
            return Some(QuantityVerdict {
                quantity: quantity.key,
                usable: NativeUse::Unclear,
                reason,
            });
        }
        let native: Vec<(f64, Mean)> = comparison
            .rows_of(Law::Native)
            .filter_map(|row| Some((row.step_s?, row.quantities[i])))
            .collect();
        let trend = comparison.trend(Law::Native, quantity.key)?;
        let (usable, reason) = verdict(quantity, law, &native, trend);
        Some(QuantityVerdict { quantity: quantity.key, usable, reason })
    };
    QUANTITIES.iter().enumerate().filter_map(judge).collect()
}

/// Whether journals touch their rings at all, under the law or in native contacts; no figure of it is none that says no.
fn touches(comparison: &Comparison) -> bool {
    let share =
        |row: &RowResult| index("contact_fraction").map_or(f64::NAN, |i| row.quantities[i].mean);
    let law = comparison.best(Law::HertzStep).into_iter();
    law.chain(comparison.rows_of(Law::Native)).any(|row| share(row) != 0.0)
}

fn verdict(
    quantity: &ComparedQuantity,
    law: Mean,
    native: &[(f64, Mean)],
    trend: &Trend,
) -> (NativeUse, String) {
    let value = |v: f64| in_words(quantity, v);
    let expected = format!("the law says {} ± {}", value(law.mean), value(law.sem));
    let ends = native.first().zip(native.last());
    if let (Behaviour::Grows | Behaviour::Shrinks, Some(((coarse, first), (fine, last)))) =
        (trend.behaviour, ends)
    {
        let reason = format!(
            "no limit: {} at a step of {} s, {} at {} s, like step^({} ± {}); {expected}",
            value(first.mean),
            number(*coarse),
            value(last.mean),
            number(*fine),
            number(trend.power),
            number(trend.power_std),
        );
        return (NativeUse::No, reason);
    }
    let (Some(limit), Some([low, high])) = (trend.limit, trend.ci95) else {
        return (NativeUse::Unclear, format!("too few steps to see a limit; {expected}"));
    };
    let sem = (high - low) / (2.0 * NORMAL95);
    let reason =
        format!("tends to {} ({} to {}); {expected}", value(limit), value(low), value(high));
    let difference = (limit - law.mean).abs();
    let scatter = SCATTER * sem.hypot(law.sem);
    let ratio = limit / law.mean;
    let usable = if !difference.is_finite() {
        NativeUse::Unclear
    } else if difference <= CLOSE * law.mean.abs() {
        NativeUse::Yes
    } else if scatter > (SIZE - 1.0) * law.mean.abs() {
        NativeUse::Unclear
    } else if difference <= scatter {
        NativeUse::Yes
    } else if (1.0 / SIZE..=SIZE).contains(&ratio) {
        NativeUse::Size
    } else {
        NativeUse::No
    };
    (usable, reason)
}

/// A value with its unit.
pub fn in_words(quantity: &ComparedQuantity, value: f64) -> String {
    match quantity.unit {
        "m" => length(value),
        "" => number(value),
        unit => format!("{} {unit}", number(value)),
    }
}

/// The answer: one sentence for each kind of use, one about the cost, one about what can be predicted.
pub fn answer(comparison: &Comparison) -> Vec<String> {
    if !touches(comparison) {
        return vec![
            "No journal touched its ring: nothing can be told of native contacts (a longer --duration may show hits).".to_owned(),
        ];
    }
    let named = |usable: NativeUse| -> Vec<&str> {
        let verdicts = comparison.verdicts.iter().filter(|v| v.usable == usable);
        verdicts
            .filter_map(|v| QUANTITIES.iter().find(|q| q.key == v.quantity))
            .map(|q| q.label)
            .collect()
    };
    let sentences = [
        (NativeUse::Yes, "In this machine, native contacts may be used for"),
        (NativeUse::Size, "They may be used to tell the size, not the value, of"),
        (NativeUse::No, "They may not be used for"),
        (
            NativeUse::Unclear,
            "Too few steps or too much scatter to tell (more --steps, more --starts or a longer --duration would):",
        ),
    ];
    let mut answer: Vec<String> = sentences
        .into_iter()
        .filter_map(|(usable, start)| {
            let names = named(usable);
            (!names.is_empty()).then(|| format!("{start} {}.", names.join("; ")))
        })
        .collect();
    if named(NativeUse::Yes).is_empty() {
        let told = comparison.verdicts.iter().any(|verdict| verdict.usable != NativeUse::Unclear);
        let first = match told {
            true => "In this machine, native contacts may be used for nothing compared here.",
            false => {
                "This comparison cannot tell what native contacts may be used for in this machine."
            }
        };
        answer.insert(0, first.into());
    }
    if let Some(hits) = &comparison.first_hits
        && let (Some([order, _]), Some([power, _])) = (hits.law_order, hits.native_power)
    {
        answer.push(format!(
            "The first hit, which no chaos disturbs, shows why: as the step h shrinks, the law's peak \
             force tends to {} N with an error like h^{}, the native one goes like h^({}).",
            number(hits.exact.mean),
            number(order),
            number(power),
        ));
    }
    if let (Some(law), Some(native)) =
        (comparison.best(Law::HertzStep), comparison.best(Law::Native))
    {
        answer.push(format!(
            "A simulated second costs {} s under the law at its tolerance, and {} s with native \
             contacts at their shortest step.",
            number(law.wall_s_per_simulated_s),
            number(native.wall_s_per_simulated_s),
        ));
    }
    answer
}
