//! From the text of a scenario to its sections: keys and types, not yet the sense of the values.

use super::document::Document;
use super::lists::{Many, OneOrMany, each, few, kind};
use super::read_motion::{described_motion, motion};
use super::reader::Reader;
use crate::effects::{Setting, Wrong};
use crate::scenario::{
    Body, Described, Drive, Fixed, Force, Ground, Joint, JointDrive, Mechanism, On, Prismatic,
    Problems, Revolute, SampledDrive, Scenario, Sensor, Servo, Stop,
};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::path::PathBuf;
use toml::Table;

/// The sections of a file before each is read by itself.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct TopLevel {
    name: String,
    seed: u64,
    mechanism: Option<Table>,
    ground: Option<Table>,
    body: Many,
    joint: Many,
    spring: Many,
    stop: Many,
    output: Many,
    sensor: Many,
    legs: Option<Table>,
    joints: Option<Table>,
    contact: Table,
    native: Table,
    drive: Option<OneOrMany>,
    environment: Table,
    sensors: Option<Table>,
    columns: Option<Table>,
    motion: Option<OneOrMany>,
    simulation: Table,
    effect: Vec<Table>,
}

impl Default for TopLevel {
    fn default() -> Self {
        TopLevel {
            name: "default".to_owned(),
            seed: 1,
            mechanism: None,
            ground: None,
            body: Many::default(),
            joint: Many::default(),
            spring: Many::default(),
            stop: Many::default(),
            output: Many::default(),
            sensor: Many::default(),
            legs: None,
            joints: None,
            contact: Table::new(),
            native: Table::new(),
            drive: None,
            environment: Table::new(),
            sensors: None,
            columns: None,
            motion: None,
            simulation: Table::new(),
            effect: Vec::new(),
        }
    }
}

/// Gives the document its meaning.
pub(in crate::scenario) fn scenario(document: Document) -> Result<Scenario, Problems> {
    let mut reader = Reader::new(&document.origins);
    for (path, message, help) in document.unusable() {
        reader.complain(&path, message, help.to_owned());
    }
    let mut top: TopLevel = reader.read("", document.table);
    let mechanism = mechanism(&mut reader, &mut top);
    let described = mechanism.described().is_some();
    let drive = match top.drive {
        None => Drive::default(),
        Some(OneOrMany::One(ref table)) => reader.read("drive", table.clone()),
        Some(OneOrMany::Many(_)) if described => Drive::default(),
        Some(OneOrMany::Many(_)) => {
            let help = "write [drive]: it is for all drives of this machine";
            reader.complain("drive", "is a list".to_owned(), help.to_owned());
            Drive::default()
        }
    };
    let present = [
        ("legs", top.legs.is_some()),
        ("sensors", top.sensors.is_some()),
        ("columns", top.columns.is_some()),
        ("motion", top.motion.is_some()),
        ("drive", top.drive.is_some()),
    ];
    let (motion, target) = match described {
        true => described_motion(&mut reader, top.motion),
        false => (motion(&mut reader, &mechanism, top.motion), None),
    };
    let scenario = Scenario {
        name: top.name,
        seed: top.seed,
        unused: present
            .into_iter()
            .filter(|(section, there)| *there && !mechanism.uses(section))
            .map(|(section, _)| section)
            .collect(),
        mechanism,
        legs: reader.read("legs", top.legs.unwrap_or_default()),
        joints: reader.read("joints", top.joints.unwrap_or_default()),
        contact: reader.read("contact", top.contact),
        native: reader.read("native", top.native),
        drive,
        environment: reader.read("environment", top.environment),
        sensors: top.sensors.map(|table| reader.read("sensors", table)),
        columns: top.columns.map(|table| reader.read("columns", table)),
        motion,
        target,
        simulation: reader.read("simulation", top.simulation),
        effects: effects(&mut reader, top.effect),
        folder: PathBuf::new(),
        origins: document.origins.clone(),
    };
    if reader.problems.is_empty() { Ok(scenario) } else { Err(Problems(reader.problems)) }
}

// serde's own tagged enums would lose the path of a wrong key, hence the dispatch by hand.
fn mechanism(reader: &mut Reader<'_>, top: &mut TopLevel) -> Mechanism {
    for (section, list) in [("body", &mut top.body), ("joint", &mut top.joint)] {
        list.tables = list.take(reader, section);
        list.single = false;
    }
    let described = !top.body.is_empty() || !top.joint.is_empty() || top.ground.is_some();
    let Some(mut table) = top.mechanism.take() else {
        if described {
            return Mechanism::Described(Box::new(describe(reader, top)));
        }
        no_kind(reader);
        return Mechanism::ThreeRpr(Default::default());
    };
    if described {
        let help = "keep [mechanism] with a kind, or [ground], [[body]] and [[joint]]";
        let message = "stands beside a description by [[body]] and [[joint]]".to_owned();
        reader.complain("mechanism", message, help.to_owned());
    }
    let beside = [
        ("spring", !top.spring.is_empty()),
        ("stop", !top.stop.is_empty()),
        ("output", !top.output.is_empty()),
        ("sensor", !top.sensor.is_empty()),
    ];
    for (section, _) in beside.into_iter().filter(|(_, there)| *there && !described) {
        let message = "belongs to a machine that describes itself".to_owned();
        let help = "`freeplay expand` writes this machine so, to be added to";
        reader.complain(section, message, help.to_owned());
    }
    if !table.contains_key("kind") {
        no_kind(reader);
    }
    let kind = reader.take_kind("mechanism", &mut table, &Mechanism::KINDS).unwrap_or_default();
    Mechanism::read(kind, reader, table)
}

fn no_kind(reader: &mut Reader<'_>) {
    let help =
        "write kind = \"3rpr\" under [mechanism], or describe a machine by [[body]] and [[joint]]";
    reader.complain("mechanism.kind", "is missing".to_owned(), help.to_owned());
}

fn describe(reader: &mut Reader<'_>, top: &mut TopLevel) -> Described {
    let drives = match &top.drive {
        Some(OneOrMany::Many(tables)) => {
            let tables = few(reader, "drive", tables.clone());
            each(reader, "drive", tables, |reader, path, mut table| {
                match kind(reader, path, &mut table, &JointDrive::KINDS, "drive")? {
                    "servo" => reader.required::<Servo>(path, table).map(JointDrive::Servo),
                    "sampled" => {
                        reader.required::<SampledDrive>(path, table).map(JointDrive::Sampled)
                    }
                    "force" => Some(JointDrive::Force(reader.read::<Force>(path, table))),
                    _ => Some(JointDrive::Prescribed(reader.read::<On>(path, table))),
                }
            })
        }
        _ => Vec::new(),
    };
    let joints = top.joint.take(reader, "joint");
    let joints = each(reader, "joint", joints, |reader, path, mut table| {
        Some(match kind(reader, path, &mut table, &Joint::KINDS, "joint")? {
            "prismatic" => Joint::Prismatic(reader.read::<Prismatic>(path, table)),
            "fixed" => Joint::Fixed(reader.read::<Fixed>(path, table)),
            _ => Joint::Revolute(reader.read::<Revolute>(path, table)),
        })
    });
    let [bodies, springs, stops, outputs, sensors] = [
        ("body", &mut top.body),
        ("spring", &mut top.spring),
        ("stop", &mut top.stop),
        ("output", &mut top.output),
        ("sensor", &mut top.sensor),
    ]
    .map(|(section, list)| (section.to_owned(), list.take(reader, section)));
    Described {
        ground: reader.read::<Ground>("ground", top.ground.take().unwrap_or_default()),
        bodies: all::<Body>(reader, bodies),
        joints,
        drives,
        springs: all(reader, springs),
        stops: each(reader, "stop", stops.1, |reader, path, table| {
            reader.required::<Stop>(path, table)
        }),
        outputs: all(reader, outputs),
        sensors: each(reader, "sensor", sensors.1, |reader, path, table| {
            reader.required::<Sensor>(path, table)
        }),
    }
}

fn all<T: DeserializeOwned + Default>(
    reader: &mut Reader<'_>,
    (section, tables): (String, Vec<Table>),
) -> Vec<T> {
    each(reader, &section, tables, |reader, path, table| Some(reader.read(path, table)))
}

fn effects(reader: &mut Reader<'_>, tables: Vec<Table>) -> Vec<Setting> {
    let mut effects = Vec::new();
    for (i, mut table) in few(reader, "effect", tables).into_iter().enumerate() {
        let section = format!("effect.{i}");
        let Some(kind) = table.remove("kind") else {
            let help = "write kind = \"…\"; `freeplay effects` lists them".to_owned();
            reader.complain(&format!("{section}.kind"), "is missing".to_owned(), help);
            continue;
        };
        let name = kind.as_str().map_or_else(|| kind.to_string(), str::to_owned);
        match Setting::from_table(&name, &table) {
            Ok(setting) => effects.push(setting),
            Err(Wrong { key, message, help }) => {
                reader.complain(&format!("{section}.{key}"), message, help);
            }
        }
    }
    effects
}
