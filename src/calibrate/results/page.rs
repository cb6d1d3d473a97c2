//! Parts of a calibration's page that all ways share.

use super::report::EffectReport;
use super::verdict::Verdict;
use crate::calibrate::values::errors::ChannelError;
use crate::report::{PageTable, length, number};

/// The verdict in a word or two.
pub fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Explained => "explained",
        Verdict::NothingMissing => "nothing missing",
        Verdict::Unexplained => "unexplained",
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::results::report::Depends;
    use crate::effects::Over;

    #[test]
    fn evidence_of_either_kind_makes_a_sentence() {
        let effect = |depends_on, evidence: &str| EffectReport {
            kind: "kind",
            on: super::super::report::ActsOn::machine(),
            depends_on,
            params: Vec::new(),
            evidence: evidence.to_owned(),
            as_good: Vec::new(),
            not_ruled_out: Vec::new(),
            equation: "f = 0",
        };
        assert_eq!(why(&effect(None, "removes it")), "kind: f = 0. It removes it.");
        let map =
            effect(Some(Depends::Efforts(Over::OutputVelocity)), "a force that varies removes it");
        assert_eq!(why(&map), "kind: f = 0. What speaks for it: a force that varies removes it.");
        assert_eq!(why(&effect(None, "")), "kind: f = 0.");
    }
}
