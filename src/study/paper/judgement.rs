//! What the simulations say of the paper's claims.

use super::claims::Claim;
use super::claims::ClaimLimit::{self, Above, Below};
use super::claims::Test::{EveryStep, Mean, Power, Ratio};
use super::estimate::Estimate;
use super::items::Item;
use super::result::CaseResult;
use super::variants::{LARGE, SMALL};
use super::verdict::{ClaimVerdict, JudgedClaim};
use crate::report::{length, number};
use crate::study::compare::in_words;

impl ClaimLimit {
    /// What an interval says of a claim with this limit.
    fn verdict(self, [low, high]: [f64; 2]) -> ClaimVerdict {
        let (holds, fails) = match self {
            Above(limit) => (low > limit, high < limit),
            Below(limit) => (high < limit, low > limit),
        };
        match (holds, fails) {
            (true, _) => ClaimVerdict::Supported,
            (_, true) => ClaimVerdict::Contradicted,
            _ => ClaimVerdict::Undecided,
        }
    }
}

/// Judges a claim by the cases of one variant, which has one for each clearance of the study.
pub fn judge(claim: &Claim, cases: &[CaseResult]) -> JudgedClaim {
    let (estimate, evidence) = match claim.test {
        Mean(item, c) => (mean_of(cases, item, c).estimate(), said(cases, item, c)),
        Ratio([(a, c), (b, d)]) => (
            mean_of(cases, a, c).over(mean_of(cases, b, d)),
            format!("{} against {}", said(cases, a, c), said(cases, b, d)),
        ),
        EveryStep(item) => every_step(cases, item),
        Power(item, between) => power(cases, item, between),
    };
    let verdict = match claim.test {
        // One pair that surely falls contradicts; all must surely rise to support.
        EveryStep(item) => steps(cases, item)
            .map(|(_, ratio)| claim.limit.verdict(ratio.ci95))
            .reduce(worse)
            .unwrap_or(ClaimVerdict::Undecided),
        _ => claim.limit.verdict(estimate.ci95),
    };
    JudgedClaim { key: claim.key, verdict, estimate, evidence }
}

fn worse(a: ClaimVerdict, b: ClaimVerdict) -> ClaimVerdict {
    use ClaimVerdict::{Contradicted, Supported, Undecided};
    match (a, b) {
        (Contradicted, _) | (_, Contradicted) => Contradicted,
        (Undecided, _) | (_, Undecided) => Undecided,
        (Supported, Supported) => Supported,
    }
}

/// The mean of an item at a clearance of the study.
fn mean_of(cases: &[CaseResult], item: Item, clearance: f64) -> &super::estimate::RunMean {
    // Claims name clearances of the study only.
    let case = cases.iter().find(|case| case.clearance_m == clearance).unwrap_or(&cases[0]);
    case.mean(item)
}

/// "platform acceleration, peak at 500 µm: 178 m/s² ± 9 m/s²".
fn said(cases: &[CaseResult], item: Item, clearance: f64) -> String {
    let quantity = item.quantity();
    let mean = mean_of(cases, item, clearance);
    let at = match item {
        Item::IdealForceJump | Item::IdealPeakAcceleration | Item::IdealPeakActuatorForce => {
            String::new()
        }
        _ => format!(" at {}", length(clearance)),
    };
    format!("{}{at}: {}", quantity.label, mean.in_words(quantity))
}

/// Each pair of neighbouring clearances: the smaller one in m, and the ratio of the larger one's value
/// to its own.
fn steps(cases: &[CaseResult], item: Item) -> impl Iterator<Item = (f64, Estimate)> {
    cases
        .windows(2)
        .map(move |pair| (pair[0].clearance_m, pair[1].mean(item).over(pair[0].mean(item))))
}

fn every_step(cases: &[CaseResult], item: Item) -> (Estimate, String) {
    let least = steps(cases, item).min_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let nothing = Estimate { value: f64::NAN, ci95: [f64::NAN; 2] };
    let (from, least) = least.unwrap_or((f64::NAN, nothing));
    let quantity = item.quantity();
    let means: Vec<String> = cases
        .iter()
        .map(|case| {
            format!("{} at {}", in_words(quantity, case.mean(item).mean), length(case.clearance_m))
        })
        .collect();
    let whole = mean_of(cases, item, LARGE).over(mean_of(cases, item, SMALL));
    let evidence = format!(
        "{}: {}; {} times from {} to {}; least from {} to the next",
        quantity.label,
        means.join(", "),
        number(whole.value),
        length(SMALL),
        length(LARGE),
        length(from)
    );
    (least, evidence)
}

/// ln(value ratio)/ln(clearance ratio), with the interval of the ratio.
fn power(cases: &[CaseResult], item: Item, [from, to]: [f64; 2]) -> (Estimate, String) {
    let ratio = mean_of(cases, item, to).over(mean_of(cases, item, from));
    let power = |ratio: f64| ratio.ln() / (to / from).ln();
    let estimate = Estimate { value: power(ratio.value), ci95: ratio.ci95.map(power) };
    let evidence = format!(
        "{}, {}; a clearance twice as large changes it by {} %",
        said(cases, item, from),
        said(cases, item, to),
        number(100.0 * (estimate.value.exp2() - 1.0))
    );
    (estimate, evidence)
}

#[cfg(test)]
mod tests {
    use super::super::claims::{CLAIMS, SENSITIVE, Test};
    use super::super::items::COUNT;
    use super::super::probe::PaperMeasured;
    use super::super::variants::CLEARANCES;
    use super::Item::PathError;
    use super::*;

    /// Cases whose values are all `value(clearance)`, from eight starts that differ by ±`spread`.
    fn cases(value: impl Fn(f64) -> f64, spread: f64) -> Vec<CaseResult> {
        let case = |c: f64| {
            let runs: Vec<Option<_>> = (0..8)
                .map(|k| if k % 2 == 0 { 1.0 + spread } else { 1.0 - spread })
                .map(|factor| [factor * value(c); COUNT])
                .map(|values| Some(PaperMeasured { values, faults: Vec::new() }))
                .collect();
            CaseResult::new(c, &runs)
        };
        CLEARANCES.map(case).into()
    }

    fn judged(test: Test, limit: ClaimLimit, cases: &[CaseResult]) -> JudgedClaim {
        let claim = Claim { key: "", label: "", quote: "", place: "", test, limit };
        judge(&claim, cases)
    }

    #[test]
    fn an_interval_decides() {
        let cases = cases(|_| 10.0, 0.2);
        let verdict = |limit| judged(Mean(PathError, LARGE), limit, &cases).verdict;
        assert_eq!(verdict(Above(5.0)), ClaimVerdict::Supported);
        assert_eq!(verdict(Above(10.5)), ClaimVerdict::Undecided);
        assert_eq!(verdict(Above(20.0)), ClaimVerdict::Contradicted);
        assert_eq!(verdict(Below(20.0)), ClaimVerdict::Supported);
        assert_eq!(verdict(Below(5.0)), ClaimVerdict::Contradicted);
    }

    #[test]
    fn growth_must_hold_at_every_step() {
        let grows = cases(f64::sqrt, 0.1);
        let j = judged(EveryStep(PathError), Above(1.0), &grows);
        assert_eq!(j.verdict, ClaimVerdict::Supported);
        assert!((j.estimate.value - 5f64.sqrt()).abs() < 1e-9, "1e-4 to 5e-4: {j:?}");
        let dips = cases(|c| if c == 1e-5 { 1e-9 } else { c }, 0.1);
        assert_eq!(
            judged(EveryStep(PathError), Above(1.0), &dips).verdict,
            ClaimVerdict::Contradicted
        );
        let level = cases(|_| 1.0, 0.1);
        assert_eq!(
            judged(EveryStep(PathError), Above(1.0), &level).verdict,
            ClaimVerdict::Undecided
        );
    }

    #[test]
    fn powers_are_found() {
        let cases = cases(|c| 3.0 * c.powf(0.4), 0.01);
        let j = judged(Power(PathError, [1e-6, LARGE]), Above(SENSITIVE), &cases);
        assert!((j.estimate.value - 0.4).abs() < 1e-9 && j.verdict == ClaimVerdict::Supported);
    }

    #[test]
    fn without_data_nothing_is_decided() {
        let nothing: Vec<_> =
            CLEARANCES.iter().map(|&c| CaseResult::new(c, &[None, None])).collect();
        for claim in &CLAIMS {
            assert_eq!(judge(claim, &nothing).verdict, ClaimVerdict::Undecided, "{}", claim.key);
        }
    }
}
