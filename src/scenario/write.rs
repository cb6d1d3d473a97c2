//! A scenario as TOML with every default filled in.

use super::validate::laws::used;
use super::{
    Body, ContactKeys, Described, Drive, DriveMode, Environment, Ground, Joint, JointDrive, Joints,
    Legs, Mechanism, Motion, MotionTarget, Native, Output, PerJoint, Scenario, Sensor, Sensors,
    Simulation, Spring, Stop, is_law_key,
};
use crate::effects::Setting;
use crate::scenario::Columns;
use serde::Serialize;
use toml::{Table, Value};

/// The sections in the order of the text.
#[derive(Serialize)]
struct WrittenSections<'a> {
    name: &'a str,
    seed: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    mechanism: Option<&'a Mechanism>,
    #[serde(skip_serializing_if = "Option::is_none")]
    legs: Option<&'a Legs>,
    environment: &'a Environment,
    #[serde(skip_serializing_if = "Option::is_none")]
    ground: Option<&'a Ground>,
    #[serde(skip_serializing_if = "is_empty")]
    body: &'a [Body],
    #[serde(skip_serializing_if = "is_empty")]
    joint: &'a [Joint],
    joints: &'a Joints,
    contact: LawKeys<'a>,
    native: &'a Native,
    #[serde(skip_serializing_if = "Option::is_none")]
    drive: Option<Drives<'a>>,
    #[serde(skip_serializing_if = "is_empty")]
    spring: &'a [Spring],
    #[serde(skip_serializing_if = "is_empty")]
    stop: &'a [Stop],
    #[serde(skip_serializing_if = "Option::is_none")]
    sensors: Option<&'a Sensors>,
    #[serde(skip_serializing_if = "Option::is_none")]
    columns: Option<&'a Columns>,
    #[serde(skip_serializing_if = "is_empty")]
    sensor: &'a [Sensor],
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<Value>,
    #[serde(skip_serializing_if = "is_empty")]
    output: &'a [Output],
    simulation: &'a Simulation,
    #[serde(skip_serializing_if = "is_empty")]
    effect: &'a [Setting],
}

/// `[drive]` or `[[drive]]`.
#[derive(Serialize)]
#[serde(untagged)]
enum Drives<'a> {
    All(&'a Drive),
    Each(&'a [JointDrive]),
}

/// `[contact]`, without the keys that mean nothing to any law of the machine.
#[derive(Serialize)]
#[serde(untagged)]
enum LawKeys<'a> {
    All(&'a ContactKeys),
    Some(Table),
}

fn law_keys(scenario: &Scenario) -> LawKeys<'_> {
    let contact = &scenario.contact;
    let laws = used(scenario);
    let keeps = |key: &str| {
        !is_law_key(key) || contact.asks_for(key) || laws.iter().any(|law| law.takes(key))
    };
    match Table::try_from(contact) {
        Ok(table) if !table.keys().all(|key| keeps(key)) => {
            LawKeys::Some(table.into_iter().filter(|(key, _)| keeps(key)).collect())
        }
        _ => LawKeys::All(contact),
    }
}

fn is_empty<T>(list: &&[T]) -> bool {
    list.is_empty()
}

/// The whole text.
pub(super) fn text(scenario: &Scenario) -> String {
    text_of(&filled(scenario))
}

/// The same with other names of the files that it reads.
pub(super) fn text_with_files(scenario: &Scenario, names: &[String]) -> String {
    let mut full = filled(scenario);
    for (file, name) in full.files_mut().into_iter().zip(names) {
        file.clone_from(name);
    }
    text_of(&full)
}

/// The text of a scenario with every default filled in.
fn text_of(full: &Scenario) -> String {
    let none = Described::default();
    let described = full.mechanism.described();
    let parts = described.unwrap_or(&none);
    let drive = match described {
        Some(described) if !described.drives.is_empty() => Some(Drives::Each(&described.drives)),
        _ => full.mechanism.uses("drive").then_some(Drives::All(&full.drive)),
    };
    let written = WrittenSections {
        name: &full.name,
        seed: full.seed,
        mechanism: described.is_none().then_some(&full.mechanism),
        legs: full.mechanism.uses("legs").then_some(&full.legs),
        environment: &full.environment,
        ground: described.map(|described| &described.ground),
        body: &parts.bodies,
        joint: &parts.joints,
        joints: &full.joints,
        contact: law_keys(full),
        native: &full.native,
        drive,
        spring: &parts.springs,
        stop: &parts.stops,
        sensors: full.sensors.as_ref().filter(|_| full.mechanism.uses("sensors")),
        columns: full.columns.as_ref().filter(|_| full.mechanism.uses("columns")),
        sensor: &parts.sensors,
        motion: motion(full),
        output: &parts.outputs,
        simulation: &full.simulation,
        effect: &full.effects,
    };
    // No input makes this fail: no field has a type that TOML cannot express.
    toml::to_string(&written).expect("tables, lists, numbers and words are TOML")
}

/// The scenario with what is derived where nothing is given, files by their whole names.
fn filled(scenario: &Scenario) -> Scenario {
    let mut full = scenario.clone();
    if let Mechanism::ThreeRpr(machine) = &mut full.mechanism {
        machine.platform_inertia = Some(machine.platform_inertia());
    }
    let joints = full.mechanism.revolute_names().len();
    if full.joints.clearance.is_none() && full.mechanism.described().is_none() && joints > 0 {
        full.joints.clearance = Some(PerJoint::all(scenario.clearance(0)));
    }
    if scenario.drive.mode == DriveMode::Sampled {
        full.drive.sampled = Some(scenario.drive.sampled());
    }
    full.simulation.settle = Some(full.simulation.settle());
    full.simulation.set_step_control(scenario.step_control());
    full.effects = scenario.effects.iter().map(Setting::filled).collect();
    for file in full.files_mut() {
        let path = scenario.resolve(file);
        let path = std::path::absolute(&path).unwrap_or(path);
        *file = path.to_string_lossy().into_owned();
    }
    full
}

/// `[motion]` or `[[motion]]`; none where nothing moves.
fn motion(scenario: &Scenario) -> Option<Value> {
    if !scenario.mechanism.uses("motion") {
        return None;
    }
    match &scenario.motion {
        Motion::Rest => None,
        // A machine with a kind has one motion, of a joint that need not be named.
        Motion::Joints(joints) if scenario.mechanism.described().is_none() => {
            joints.first().map(|joint| Value::Table(table(joint)))
        }
        Motion::Joints(joints) => {
            Some(Value::Array(joints.iter().map(|joint| Value::Table(table(joint))).collect()))
        }
        path => {
            let mut table = table(path);
            match &scenario.target {
                Some(MotionTarget::Body(name)) => {
                    table.insert("body".to_owned(), name.clone().into())
                }
                Some(MotionTarget::Point(name)) => {
                    table.insert("point".to_owned(), name.clone().into())
                }
                None => None,
            };
            if let Some(MotionTarget::Point(_)) = scenario.target {
                table.remove("phi");
            }
            Some(Value::Table(table))
        }
    }
}

/// A section as a table; every type in it is one of TOML's.
fn table(section: &impl Serialize) -> Table {
    Table::try_from(section).unwrap_or_default()
}
