//! `freeplay effects`: what can act on a machine beside what is declared.

use crate::cli::shared::catalogue::Catalogue;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use crate::cli::shared::table::paragraph;
use crate::effects::{ALL, JointKinds, Kind, Parameter, Senses, Targets, named};
use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Explain the effects that a scenario can give a machine
///
/// An effect is something that acts on a machine although its declaration does not say so: a payload,
/// a worn joint, a servo that lags. For each: what it is, its equation and where that comes from, where
/// its trace shows in measured data, what it can act on, and its parameters with unit, bounds,
/// default and meaning. With a NAME, that one alone, with an example.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
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
  freeplay run --set 'effect=[{kind=\"payload\",mass_kg=0.5}]'   with one
  freeplay sweep my.toml --vary effect.0.mass_kg=0..1:20   one effect, varied";

const INTRODUCTION: &str = "An effect acts on a machine beside what its scenario declares. A scenario has any number of them, \
     each an [[effect]] with its kind and its parameters; they apply in their order, on top of each \
     other. What a run calls ideal is the machine as declared, without effects.";

/// What is printed.
const CATALOGUE: Catalogue<Kind> =
    Catalogue { all: ALL, introduction: INTRODUCTION, explained, example, described };

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let one = arguments.name.as_deref().and_then(named);
    Ok(output::print(&CATALOGUE.text(one, arguments.json))?)
}

/// An effect for people.
fn explained(kind: &Kind) -> String {
    let mut text = format!("{}\n", kind.name);
    text += &paragraph("  ", "  ", kind.summary);
    for (label, content) in [
        ("equation", kind.equation),
        ("source", kind.source),
        ("trace", kind.trace),
        (kind.targets.key().unwrap_or("acts on"), rule(kind.targets)),
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
    let rows = kind.parameters.iter().map(|parameter| (columns(parameter), parameter.about));
    text + &output::parameters(&rows.collect::<Vec<_>>())
}

/// An `[[effect]]` that can be pasted into a scenario for the built-in machine.
fn example(kind: &Kind) -> String {
    let mut text = format!("Example:\n\n    [[effect]]\n    kind = \"{}\"\n", kind.name);
    text += match kind.targets {
        Targets::Machine | Targets::Commands | Targets::Tracker => "",
        Targets::Joint(joints) => match joints {
            JointKinds::Prismatic | JointKinds::DrivenPrismatic | JointKinds::Driven => {
                "    joint = \"P1\"\n"
            }
            JointKinds::Anchor | JointKinds::Any => "    joint = \"A1\"\n",
            JointKinds::Revolute | JointKinds::Bearing => "    joint = \"C1\"\n",
            JointKinds::DrivenRevolute => "    joint = \"O\"\n",
            JointKinds::Sampled => "    joint = \"P1\"               # of a drive stage\n",
        },
        Targets::JointOrAll(joints) => match joints {
            JointKinds::Prismatic | JointKinds::DrivenPrismatic | JointKinds::Driven => {
                "    joint = \"P1\"              # without this line: all of them\n"
            }
            _ => "    joint = \"C1\"              # without this line: all of them\n",
        },
        Targets::Body => "    body = \"platform\"         # without this line: the output body\n",
        Targets::Point => "    point = \"platform.C1\"\n",
        Targets::Sensor(Senses::Effort) => "    sensor = \"T_O\"\n",
        Targets::Sensor(_) => "    sensor = \"q_O\"\n",
    };
    // Of an effect that no calibration seeks in some form of it all parameters.
    let shown = |parameter: &&Parameter| {
        kind.variants.first().is_none_or(|variant| variant.contains(&parameter.name))
    };
    for parameter in kind.parameters.iter().filter(shown) {
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

fn rule(targets: Targets) -> &'static str {
    match targets {
        Targets::Machine => "none: it acts on the whole machine",
        Targets::Commands => "none: it acts on the commands of all drives",
        Targets::Joint(joints) => rule_of_joint(joints),
        Targets::JointOrAll(joints) => rule_of_joint_or_all(joints),
        Targets::Body => {
            "a moving body, such as \"platform\"; the output body, whose motion is the machine's result, when \
             none is named"
        }
        Targets::Point => {
            "a named point of a body or of the ground, such as \"rocker.B\" or \"ground.S\""
        }
        Targets::Sensor(senses) => rule_of_sensor(senses),
        Targets::Tracker => "none: it acts on every sensor of x, y or angle",
    }
}

fn rule_of_joint(joints: JointKinds) -> &'static str {
    match joints {
        JointKinds::Prismatic => {
            "a prismatic joint, such as \"P1\", or a list of some with a common cause"
        }
        JointKinds::DrivenPrismatic => {
            "a prismatic joint with a drive, such as \"P1\", or a list of some with a common cause"
        }
        JointKinds::Driven => {
            "a joint with a drive, such as \"P1\", or a list of some with a common cause"
        }
        JointKinds::Sampled => {
            "a joint whose drive has a sampled controller, such as \"P1\" of a drive stage, or a list of \
                 some with a common cause"
        }
        JointKinds::Revolute | JointKinds::Bearing => {
            "a revolute joint, such as \"A1\" or \"C1\", or a list of some with a common cause"
        }
        JointKinds::DrivenRevolute => {
            "a revolute joint with a drive, such as \"O\" of a four-bar, or a list of some with a common \
                 cause"
        }
        JointKinds::Anchor => {
            "a revolute joint whose bearing is on the base, such as \"A1\", or a list of some with a \
                 common cause"
        }
        JointKinds::Any => {
            "a joint, prismatic or revolute, such as \"P1\" or \"A1\", or a list of some with a common \
                 cause"
        }
    }
}

fn rule_of_joint_or_all(joints: JointKinds) -> &'static str {
    match joints {
        JointKinds::Prismatic | JointKinds::DrivenPrismatic => {
            "a prismatic joint with a drive, such as \"P1\", or a list of some; all of them when none is \
                 named"
        }
        JointKinds::Driven => {
            "a joint with a drive, such as \"P1\", or a list of some; all of them when none is named"
        }
        _ => {
            "a revolute joint, such as \"A1\" or \"C1\", or a list of some; all of them when none is named"
        }
    }
}

fn rule_of_sensor(senses: Senses) -> &'static str {
    match senses {
        Senses::Any => {
            "the column of a sensor, or a list of some that share a clock; commands are not measured"
        }
        Senses::Coordinate => "the column of a sensor of a joint's position",
        Senses::Zeroed => "the column of a sensor of a joint's position or of a body's angle",
        Senses::Angle => "the column of a sensor of a revolute joint's position",
        Senses::Effort => "the column of a sensor of a drive's force or torque",
    }
}

/// An effect for programs.
pub fn described(kind: &Kind) -> Value {
    let joints = match kind.targets.joints() {
        None => "none",
        Some(JointKinds::Prismatic | JointKinds::DrivenPrismatic) => "prismatic",
        Some(JointKinds::Driven | JointKinds::Sampled) => "driven",
        Some(JointKinds::Revolute | JointKinds::Bearing) => "revolute",
        Some(JointKinds::DrivenRevolute) => "driven-revolute",
        Some(JointKinds::Anchor) => "anchor",
        Some(JointKinds::Any) => "any",
    };
    let target = match kind.targets {
        Targets::Machine | Targets::Commands => "machine",
        Targets::Tracker => "tracker",
        of_one => of_one.key().unwrap_or_default(),
    };
    let sensors = match kind.targets {
        Targets::Sensor(Senses::Any) => Some("any"),
        Targets::Sensor(Senses::Coordinate | Senses::Zeroed) => Some("position"),
        Targets::Sensor(Senses::Angle) => Some("angle"),
        Targets::Sensor(Senses::Effort) => Some("force"),
        _ => None,
    };
    let required = kind.targets.required();
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
        "target": target,
        "target_required": required,
        "joints": joints,
        "joint_required": required && kind.targets.joints().is_some(),
        "sensors": sensors,
        "parameters": parameters.collect::<Vec<_>>(),
    })
}
