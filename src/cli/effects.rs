//! `freeplay effects`: what can act on a machine beside what is declared.

use super::failure::Failure;
use super::output;
use crate::effects::{ALL, Joints, Kind, Parameter, named};
use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Explain the effects that a scenario can give a machine
///
/// An effect is something that acts on a machine although its declaration does not say so: a payload,
/// a worn joint, a servo that lags. For each: what it is, its equation and where that comes from, where
/// its trace shows in measured data, which joints it can be given, and its parameters with unit, bounds,
/// default and meaning. With a NAME, that one alone, with an example.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    /// Name of one effect
    #[arg(value_parser = PossibleValuesParser::new(ALL.iter().map(|kind| kind.name)))]
    #[arg(hide_possible_values = true)]
    name: Option<String>,
    /// Print JSON: a list of all effects, or one object
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  freeplay effects                              all of them
  freeplay effects payload                      one, with an example
  freeplay effects --json | jq '.[].name'
  freeplay run --set effect=[{kind=\"payload\",mass_kg=0.5}]      the built-in machine with one
  freeplay sweep my.toml --vary effect.0.mass_kg=0..1:20        the first effect of a file, varied";

/// Columns of a line of text.
const WIDTH: usize = 100;

const INTRODUCTION: &str = "An effect acts on a machine beside what its scenario declares. A scenario has any number of them, \
     each an [[effect]] with its kind and its parameters; they apply in their order, on top of each \
     other. What a run calls ideal is the machine as declared, without effects.";

pub(super) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let one = arguments.name.as_deref().and_then(named);
    let text = match (one, arguments.json) {
        (Some(kind), false) => format!("{}\n{}", explained(kind), example(kind)),
        (None, false) => {
            let all: Vec<String> = ALL.iter().map(|kind| explained(kind)).collect();
            format!("{}\n{}", paragraph("", "", INTRODUCTION), all.join("\n"))
        }
        (Some(kind), true) => format!("{:#}\n", described(kind)),
        (None, true) => {
            format!("{:#}\n", Value::Array(ALL.iter().map(|kind| described(kind)).collect()))
        }
    };
    Ok(output::print(&text)?)
}

/// An effect for people.
fn explained(kind: &Kind) -> String {
    let mut text = format!("{}\n", kind.name);
    text += &paragraph("  ", "  ", kind.summary);
    for (label, content) in [
        ("equation", kind.equation),
        ("source", kind.source),
        ("trace", kind.trace),
        ("joint", joint_rule(kind.joints)),
    ] {
        text += &paragraph(&format!("    {label:<10}"), &" ".repeat(14), content);
    }
    text.push('\n');
    let columns = |p: &Parameter| {
        let [low, high] = p.bounds.map(number);
        let default = p.default.map_or_else(|| "none".to_owned(), number);
        [
            p.name.to_owned(),
            if p.unit.is_empty() { "-" } else { p.unit }.to_owned(),
            format!("{low} to {high}"),
            format!("default {default}"),
        ]
    };
    let rows: Vec<[String; 4]> = kind.parameters.iter().map(columns).collect();
    let width = |i: usize| rows.iter().map(|row| row[i].len()).max().unwrap_or(0);
    for (row, parameter) in rows.iter().zip(kind.parameters) {
        let mut line = String::from("    ");
        for (i, cell) in row.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = write!(line, "{cell:<width$}  ", width = width(i));
        }
        let start = line.chars().count();
        text += &paragraph(&line, &" ".repeat(start), parameter.about);
    }
    text
}

/// Words after `first`, lines after the first one after `next`.
fn paragraph(first: &str, next: &str, words: &str) -> String {
    let (mut text, mut line) = (String::new(), first.to_owned());
    let mut empty = true;
    for word in words.split_whitespace() {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            text += line.trim_end();
            text.push('\n');
            next.clone_into(&mut line);
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line += word;
        empty = false;
    }
    text + line.trim_end() + "\n"
}

/// An `[[effect]]` that can be pasted into a scenario for the built-in machine.
fn example(kind: &Kind) -> String {
    let mut text = format!("Example:\n\n    [[effect]]\n    kind = \"{}\"\n", kind.name);
    text += match kind.joints {
        Joints::None => "",
        Joints::Prismatic => "    joint = \"P1\"\n",
        Joints::PrismaticOrAll => {
            "    joint = \"P1\"              # without this line: all of them\n"
        }
        Joints::Anchor => "    joint = \"A1\"\n",
        Joints::Revolute => "    joint = \"C1\"\n",
        Joints::RevoluteOrAll => {
            "    joint = \"C1\"              # without this line: all of them\n"
        }
    };
    let names = kind.variants.first().copied().unwrap_or_default();
    for parameter in names.iter().filter_map(|name| kind.parameter(name)) {
        let assignment = format!("{} = {:?}", parameter.name, telling(parameter));
        let comment = if parameter.unit.is_empty() { "" } else { parameter.unit };
        let line =
            if comment.is_empty() { assignment } else { format!("{assignment:<26}  # {comment}") };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    {line}");
    }
    text
}

/// A value that shows: the default where it is one that does, else ten times what just can be told from
/// nothing.
fn telling(parameter: &Parameter) -> f64 {
    let [low, high] = parameter.bounds;
    let value = parameter.default.filter(|v| *v != 0.0).unwrap_or(10.0 * parameter.step);
    // Three digits, without what rounding left behind them.
    let rounded = format!("{value:.2e}").parse().unwrap_or(value);
    f64::clamp(rounded, low, high)
}

fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

fn joint_rule(joints: Joints) -> &'static str {
    match joints {
        Joints::None => "none: it acts on the whole machine",
        Joints::Prismatic => "one prismatic joint, such as \"P1\"",
        Joints::PrismaticOrAll => {
            "one prismatic joint, such as \"P1\", or all of them when none is named"
        }
        Joints::Anchor => "one revolute joint whose bearing is on the base, such as \"A1\"",
        Joints::Revolute => "one revolute joint, such as \"A1\" or \"C1\"",
        Joints::RevoluteOrAll => {
            "one revolute joint, such as \"A1\" or \"C1\", or all of them when none is named"
        }
    }
}

/// An effect for programs.
fn described(kind: &Kind) -> Value {
    let (joints, required) = match kind.joints {
        Joints::None => ("none", false),
        Joints::Prismatic => ("prismatic", true),
        Joints::PrismaticOrAll => ("prismatic", false),
        Joints::Anchor => ("anchor", true),
        Joints::Revolute => ("revolute", true),
        Joints::RevoluteOrAll => ("revolute", false),
    };
    let parameters = kind.parameters.iter().map(|p| {
        json!({
            "name": p.name, "unit": p.unit, "bounds": p.bounds, "default": p.default, "about": p.about,
        })
    });
    json!({
        "name": kind.name,
        "summary": kind.summary,
        "equation": kind.equation,
        "source": kind.source,
        "trace": kind.trace,
        "joints": joints,
        "joint_required": required,
        "parameters": parameters.collect::<Vec<_>>(),
    })
}
