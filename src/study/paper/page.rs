//! The page of the study: the claims and their verdicts first.

use super::estimate::Estimate;
use super::items::QUANTITIES;
use super::result::Paper;
use super::verdict::{ClaimVerdict, JudgedClaim};
use crate::report::{PagePart, PageTable, Picture, document, length, number};
use crate::results::SCENARIO_FILE;

/// The page as HTML.
pub fn page(paper: &Paper, pictures: &[Picture]) -> String {
    let provenance = provenance(paper);
    let open = not_given(paper);
    let parts = [
        PagePart::Table(claims(paper)),
        PagePart::Table(moves(paper)),
        PagePart::Pictures(pictures),
        PagePart::Table(parameters(paper)),
        PagePart::Text {
            id: "not-given",
            title: "What the paper does not give",
            paragraphs: &open,
        },
        PagePart::Table(variants(paper)),
        PagePart::Table(quantities(paper)),
        PagePart::Provenance(&provenance),
    ];
    document("The paper's study, repeated", &lead(paper), &parts)
}

fn lead(p: &Paper) -> String {
    let count =
        |verdict: ClaimVerdict| p.claims.iter().filter(|c| c.judged.verdict == verdict).count();
    let firm = p.claims.iter().filter(|claim| claim.over_variants.agree()).count();
    let refuted: Vec<&str> = p
        .claims
        .iter()
        .filter(|claim| claim.judged.verdict == ClaimVerdict::Contradicted)
        .map(|claim| claim.label)
        .collect();
    let refuted = if refuted.is_empty() {
        String::new()
    } else {
        format!(" Contradicted: {}.", refuted.join("; "))
    };
    format!(
        "Varedi-Koulaei and Bamdad, The Effects of Joint Clearance on the Dynamics of the 3-RPR Planar \
         Parallel Manipulator. Of {} claims, {} are supported, {} contradicted and {} undecided under \
         the assumed values; {} keep their verdict under all {} sets of assumptions about what the \
         paper does not give.{refuted}",
        p.claims.len(),
        count(ClaimVerdict::Supported),
        count(ClaimVerdict::Contradicted),
        count(ClaimVerdict::Undecided),
        firm,
        p.variants.len()
    )
}

fn interval(estimate: &Estimate) -> String {
    let value = |v: f64| if v == f64::INFINITY { "∞".to_owned() } else { number(v) };
    let [low, high] = estimate.ci95.map(value);
    format!("{} ({low} to {high})", value(estimate.value))
}

fn claims(p: &Paper) -> PageTable {
    let rows = p.claims.iter().map(|claim| {
        let moves = &claim.over_variants;
        let of = |count: usize, word: &str| (count > 0).then(|| format!("{count} {word}"));
        let moved: Vec<String> =
            [of(moves.supported, "yes"), of(moves.contradicted, "no"), of(moves.undecided, "open")]
                .into_iter()
                .flatten()
                .collect();
        vec![
            format!("{}: “{}”, {}", claim.label, claim.quote, claim.place),
            claim.judged.verdict.in_words().to_owned(),
            format!("{}; {}", interval(&claim.judged.estimate), claim.limit),
            claim.judged.evidence.clone(),
            moved.join(", "),
        ]
    });
    PageTable {
        id: "claims",
        title: "The paper's claims".into(),
        header: [
            "claim",
            "verdict",
            "value (95 % interval); limit",
            "evidence",
            "over the assumptions",
        ]
        .map(str::to_owned)
        .into(),
        rows: rows.collect(),
        note: format!(
            "Means over {} starts of {} s, ± standard error, the first {} s left out. Supported: the \
             whole 95 % interval (Student's t over the starts) lies on the claim's side of the limit; \
             contradicted: on the other side; undecided: the limit lies within. For growth with the \
             clearance the value is the smallest ratio from one clearance to the next larger one, and \
             every step must surely rise. A jump is the rms change of a signal within 1 ms over √2 \
             times its standard deviation: 0.004 for a smooth turn in 1 s, 1 for noise.",
            p.phases,
            number(p.duration_s),
            number(p.settle_s)
        ),
    }
}

fn cell(judged: &JudgedClaim) -> String {
    let mark = match judged.verdict {
        ClaimVerdict::Supported => "yes",
        ClaimVerdict::Contradicted => "no",
        ClaimVerdict::Undecided => "open",
    };
    format!("{mark} {}", interval(&judged.estimate))
}

fn moves(p: &Paper) -> PageTable {
    let header = std::iter::once("claim; limit".to_owned());
    let header = header.chain(p.variants.iter().map(|variant| variant.label.to_owned()));
    let rows = p.claims.iter().enumerate().map(|(i, claim)| {
        let name = format!("{}; {}", claim.label, claim.limit);
        let cells = p.variants.iter().map(|variant| cell(&variant.claims[i]));
        std::iter::once(name).chain(cells).collect()
    });
    PageTable {
        id: "assumptions",
        title: "As the assumptions move".into(),
        header: header.collect(),
        rows: rows.collect(),
        note: "One assumption at a time is changed, and every claim judged again: verdict, value and \
               95 % interval. ∞: the ideal machine has nothing to compare with, such as an acceleration \
               on a straight line at constant velocity."
            .into(),
    }
}

fn parameters(p: &Paper) -> PageTable {
    let rows = p.parameters.iter().map(|parameter| {
        vec![
            parameter.name.to_owned(),
            parameter.paper.clone().unwrap_or_else(|| "–".to_owned()),
            parameter.used.clone(),
            parameter.origin.in_words().to_owned(),
            parameter.note.to_owned(),
        ]
    });
    PageTable {
        id: "parameters",
        title: "Parameters".into(),
        header: ["parameter", "paper", "used here", "origin", "where, or why"]
            .map(str::to_owned)
            .into(),
        rows: rows.collect(),
        note: "Assumed: the paper is silent. Every value is a key of scenario.toml.".into(),
    }
}

fn not_given(p: &Paper) -> Vec<String> {
    let moved: Vec<String> = p
        .claims
        .iter()
        .filter(|claim| !claim.over_variants.agree())
        .map(|claim| {
            let moves = &claim.over_variants;
            format!(
                "“{}” is supported by {} sets of assumptions, contradicted by {} and left open by {}; \
                 its value lies between {} and {}.",
                claim.label,
                moves.supported,
                moves.contradicted,
                moves.undecided,
                number(moves.lowest),
                if moves.highest.is_finite() { number(moves.highest) } else { "∞".to_owned() }
            )
        })
        .collect();
    let mut paragraphs = vec![
        "The paper gives neither C_max nor d_max of its contact damping, nor the trajectory beyond \"a \
         constant velocity\", nor the platform's angle phi, nor gravity, nor the bars' diameters. Its \
         curves therefore cannot be reproduced digit by digit by anybody; what can be checked is \
         whether its conclusions depend on these choices."
            .to_owned(),
    ];
    if moved.is_empty() {
        paragraphs.push("No verdict moves with the assumptions tried here.".to_owned());
    }
    paragraphs.extend(moved);
    paragraphs
}

fn variants(p: &Paper) -> PageTable {
    let rows = p.variants.iter().map(|variant| {
        let halted: usize = variant.cases.iter().map(|case| case.halted).sum();
        let faulty: usize = variant.cases.iter().map(|case| case.faulty).sum();
        let sets: Vec<String> = variant.sets.iter().map(|set| format!("--set {set}")).collect();
        vec![
            variant.key.to_owned(),
            variant.label.to_owned(),
            if sets.is_empty() { "–".to_owned() } else { sets.join(" ") },
            halted.to_string(),
            faulty.to_string(),
        ]
    });
    PageTable {
        id: "variants",
        title: "The sets of assumptions".into(),
        header: [
            "key",
            "what is changed",
            "as options of freeplay run",
            "runs that broke down",
            "runs with faults",
        ]
        .map(str::to_owned)
        .into(),
        rows: rows.collect(),
        note: "Runs that break down are left out of all means; those with faults (energy that does not balance, \
               rigid joints that came apart) are not, and end the study with exit code 1."
            .into(),
    }
}

fn quantities(p: &Paper) -> PageTable {
    let cases = &p.variants[0].cases;
    let header = std::iter::once("quantity".to_owned());
    let header = header.chain(cases.iter().map(|case| length(case.clearance_m)));
    let rows = QUANTITIES.iter().enumerate().map(|(i, quantity)| {
        let cells = cases.iter().map(|case| {
            let mean = case.quantities().nth(i).map(|(_, mean)| mean).filter(|mean| mean.runs > 0);
            mean.map_or("–".to_owned(), |mean| mean.in_words(quantity))
        });
        std::iter::once(quantity.label.to_owned()).chain(cells).collect()
    });
    PageTable {
        id: "quantities",
        title: "All quantities under the assumed values".into(),
        header: header.collect(),
        rows: rows.collect(),
        note: format!(
            "Mean ± standard error over {} starts. The same for every set of assumptions stands in \
             paper.json.",
            p.phases
        ),
    }
}

fn provenance(p: &Paper) -> Vec<(String, String)> {
    let more = [
        ("Seed", p.seed.to_string()),
        ("Figures", "paper.json beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(p.wall_s))),
    ];
    p.provenance.lines("scenario", Some(SCENARIO_FILE), more)
}
