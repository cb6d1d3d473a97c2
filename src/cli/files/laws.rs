//! `freeplay laws`: the contact laws, what they are and what they do in one hit.

use crate::cli::shared::catalogue::Catalogue;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::options::{FolderOptions, Sets};
use crate::cli::shared::output;
use crate::cli::shared::table::paragraph;
use crate::contact::laws::{ALL, LawKind, LawParameter, Losses, named};
use crate::study::laws::{LAWS_FILE, LawFigures, figures, law_of, write_laws};
use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Explain the contact laws that a scenario can choose from
///
/// A contact law is the normal force between a journal and its bearing over penetration and its rate. For
/// each: what it is, its equation and where that comes from, where it holds, and its parameters with unit,
/// range, default and meaning. With a NAME, that one alone, with an example. With --out, what one hit of
/// 0.1 kg at 0.1 m/s does under it in the first joint of the built-in machine: force over penetration, and
/// the share of the speed that hits return, as pictures and as JSON.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Name of one law
    #[arg(value_parser = PossibleValuesParser::new(ALL.iter().map(|kind| kind.name)))]
    #[arg(hide_possible_values = true)]
    name: Option<String>,
    /// Print JSON: a list of all laws, or one object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    sets: Sets,
    #[command(flatten)]
    folder: FolderOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay laws                                  all of them
  freeplay laws hunt-crossley                    one, with an example
  freeplay laws --json | jq '.[].name'
  freeplay laws --out laws                       pictures of one hit under each
  freeplay laws flores --set contact.restitution=0.5 --out flores
  freeplay run --set contact.law=hunt-crossley --set contact.damping=0.3";

const INTRODUCTION: &str = "A contact law is chosen by contact.law, for one joint by its law = …; its parameters stand beside \
     it. d is the penetration (m), rate its rate (m/s, positive while surfaces approach), impact_speed that \
     rate when they touched, K = 4/(3 pi (h_i + h_j)) sqrt(Ri Rj/(Ri + Rj)) with h = (1 - nu^2)/(pi E), E* \
     the composite modulus, L the bearing's length, dR = Ri - Rj the radial clearance. Laws by restitution \
     take an impact speed of at least 1e-3 m/s, and the fastest approach of a contact that lasts. Beside \
     these, law = \"native\" leaves contacts to the physics engine, and law = \"ideal\" has no clearance.";

/// What is printed.
const CATALOGUE: Catalogue<LawKind> =
    Catalogue { all: ALL, introduction: INTRODUCTION, explained, example, described };

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let one = arguments.name.as_deref().and_then(named);
    let chosen: Vec<&'static LawKind> = one.map_or_else(|| ALL.to_vec(), |kind| vec![kind]);
    if arguments.folder.out.is_some() {
        return draw(arguments, &chosen);
    }
    let mut unused = arguments.sets.given();
    unused.extend(arguments.folder.force.then_some("--force"));
    if !unused.is_empty() {
        let message = format!("{}: only pictures take it: give --out DIR, too", unused.join(", "));
        return Err(Failure::Input(vec![message]));
    }
    Ok(output::print(&CATALOGUE.text(one, arguments.json))?)
}

/// Writes the pictures.
fn draw(arguments: &Arguments, chosen: &[&'static LawKind]) -> Result<(), Failure> {
    let all: Vec<LawFigures> = chosen
        .iter()
        .map(|kind| Ok(figures(kind, &*law_of(kind, &arguments.sets.all())?)))
        .collect::<Result<_, Failure>>()?;
    let folder = arguments.folder.prepare("laws", "default", LAWS_FILE)?;
    let drawn = write_laws(&all, folder)?;
    let text = if arguments.json {
        drawn.json
    } else {
        format!("Written to {}: {}\n", drawn.folder.display(), drawn.files.join(", "))
    };
    Ok(output::print(&text)?)
}

/// A law for people.
fn explained(kind: &LawKind) -> String {
    let mut text = format!("{}\n", kind.name);
    text += &paragraph("  ", "  ", kind.summary);
    for (label, content) in
        [("force", kind.equation), ("source", kind.source), ("holds for", kind.validity)]
    {
        text += &paragraph(&format!("    {label:<10}"), &" ".repeat(14), content);
    }
    text.push('\n');
    let columns = |p: &LawParameter| {
        let unit = if p.unit.is_empty() { "-" } else { p.unit };
        [p.name, unit, p.range.in_words(), &format!("default {}", p.default)].map(str::to_owned)
    };
    let rows = kind.parameters.iter().map(|parameter| (columns(parameter), parameter.about));
    text + &output::parameters(&rows.collect::<Vec<_>>())
}

/// A `[contact]` that can be pasted into a scenario.
fn example(kind: &LawKind) -> String {
    let mut text = format!("Example:\n\n    [contact]\n    law = \"{}\"\n", kind.name);
    let keys: &[&str] = match kind.losses {
        Losses::Elastic => &[],
        Losses::Restitution => &["restitution"],
        Losses::Damping => &["damping"],
        Losses::Step => &["c_max", "d_max"],
    };
    for parameter in kind.parameters.iter().filter(|p| keys.contains(&p.name)) {
        let assignment = format!("{} = {}", parameter.name, parameter.default);
        let line = match parameter.unit {
            "" => assignment,
            unit => format!("{assignment:<26}  # {unit}"),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    {line}");
    }
    text
}

/// A law for programs.
pub fn described(kind: &LawKind) -> Value {
    let parameters = kind.parameters.iter().map(|p| {
        json!({
            "name": p.name, "unit": p.unit, "range": p.range.in_words(), "default": p.default,
            "about": p.about,
        })
    });
    json!({
        "name": kind.name,
        "summary": kind.summary,
        "equation": kind.equation,
        "source": kind.source,
        "validity": kind.validity,
        "losses": match kind.losses {
            Losses::Elastic => "none",
            Losses::Restitution => "restitution",
            Losses::Damping => "damping",
            Losses::Step => "c_max",
        },
        "parameters": parameters.collect::<Vec<_>>(),
    })
}
