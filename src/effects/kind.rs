//! What is said of an effect once, whatever machine it acts on.

use super::{Setting, Target, Wrong};
use crate::mechanism::{Bearing, Drive, JointIndex, Mechanism, Reads, Sensor};

/// One number of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name, with the unit at its end, as in `mass_kg`.
    pub name: &'static str,
    /// Unit in words; empty for a pure number.
    pub unit: &'static str,
    /// What it means.
    pub about: &'static str,
    /// Smallest and largest value that make sense.
    pub bounds: [f64; 2],
    /// A small value by its own measure: what a finite difference takes, and about what can be told
    /// from nothing on a machine like the paper's.
    pub step: f64,
    /// Value where none is given; `None` where the effect's own text says what then holds.
    pub default: Option<f64>,
}

/// Beginnings of the names of parameters that only say where, when or how fast what the others are the size of.
const SHAPES: [&str; 14] = [
    "phase",
    "frequency",
    "at_s",
    "per_turn",
    "pitch",
    "direction",
    "com_",
    "anchor_",
    "rest_length",
    "velocity",
    "speed",
    "presliding",
    "lobes",
    "stribeck",
];

impl Parameter {
    /// Whether it only says where, when or how fast an effect acts whose size others say.
    pub fn is_shape(&self) -> bool {
        SHAPES.iter().any(|shape| self.name.starts_with(shape))
    }

    /// A value, or the nearest one that makes sense.
    pub fn clamped(&self, value: f64) -> f64 {
        value.clamp(self.bounds[0], self.bounds[1])
    }

    /// The size of something that is not there at 0, its default, and of which more than `most` makes no
    /// sense.
    pub(super) const fn size(
        name: &'static str,
        unit: &'static str,
        about: &'static str,
        most: f64,
        step: f64,
    ) -> Self {
        Self { name, unit, about, bounds: [0.0, most], step, default: Some(0.0) }
    }
}

/// What an effect acts on: a property of its kind. [`Kind::targets_of`] lists the targets that a machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Targets {
    /// The whole machine.
    Machine,
    /// The commands of all drives together.
    Commands,
    /// One joint, or several with a common cause (key `joint`).
    Joint(JointKinds),
    /// The same, or all of them where none is named.
    JointOrAll(JointKinds),
    /// One moving body (key `body`); the output body where none is named.
    Body,
    /// One named point of a body or of the ground (key `point`).
    Point,
    /// One sensor, or several with a common cause (key `sensor`: columns).
    Sensor(Senses),
    /// All sensors of x, y and angle together.
    Tracker,
}

/// Joints that an effect can be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKinds {
    /// Prismatic ones.
    Prismatic,
    /// Prismatic ones with a drive.
    DrivenPrismatic,
    /// All with a drive.
    Driven,
    /// Those whose drive has a sampled controller.
    Sampled,
    /// Revolute ones.
    Revolute,
    /// Revolute ones with a drive.
    DrivenRevolute,
    /// Revolute ones, for what lies between ring and journal: ideal joints are left as they are.
    Bearing,
    /// Revolute ones whose ring is on the ground.
    Anchor,
    /// All of them.
    Any,
}

/// Sensors that an effect can be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Senses {
    /// All that look at the machine; commands are no measurements.
    Any,
    /// Those of joints' coordinates.
    Coordinate,
    /// The same and those of bodies' angles; a search looks at joints' alone.
    Zeroed,
    /// Those of revolute joints' angles.
    Angle,
    /// Those of drives' forces and torques.
    Effort,
}

impl Targets {
    /// The key that names what the effect acts on, if it takes one.
    pub fn key(self) -> Option<&'static str> {
        match self {
            Targets::Machine | Targets::Commands | Targets::Tracker => None,
            Targets::Joint(_) | Targets::JointOrAll(_) => Some("joint"),
            Targets::Body => Some("body"),
            Targets::Point => Some("point"),
            Targets::Sensor(_) => Some("sensor"),
        }
    }

    /// Whether that key must be given.
    pub fn required(self) -> bool {
        matches!(self, Targets::Joint(_) | Targets::Point | Targets::Sensor(_))
    }

    /// Which joints it takes, if it takes any.
    pub fn joints(self) -> Option<JointKinds> {
        match self {
            Targets::Joint(joints) | Targets::JointOrAll(joints) => Some(joints),
            _ => None,
        }
    }
}

impl JointKinds {
    /// Whether a joint of `mechanism` is one of them.
    pub fn include(self, mechanism: &Mechanism, joint: JointIndex) -> bool {
        let driven = || mechanism.actuators.iter().any(|drive| drive.joint == joint);
        match (self, joint) {
            (JointKinds::Any, _)
            | (JointKinds::Prismatic, JointIndex::Prismatic(_))
            | (JointKinds::Revolute | JointKinds::Bearing, JointIndex::Revolute(_)) => true,
            (JointKinds::Sampled, _) => mechanism
                .actuators
                .iter()
                .any(|drive| drive.joint == joint && matches!(drive.drive, Drive::Sampled(_))),
            (JointKinds::Driven, _)
            | (JointKinds::DrivenPrismatic, JointIndex::Prismatic(_))
            | (JointKinds::DrivenRevolute, JointIndex::Revolute(_)) => driven(),
            (JointKinds::Anchor, JointIndex::Revolute(i)) => {
                mechanism.revolutes[i].ring.body.is_none()
            }
            _ => false,
        }
    }
}

impl Senses {
    /// Whether a sensor is one of them.
    pub fn include(self, sensor: &Sensor) -> bool {
        match self {
            Senses::Any => !sensor.tells(),
            Senses::Coordinate => matches!(sensor.reads, Reads::Position(_)),
            Senses::Zeroed => matches!(sensor.reads, Reads::Position(_) | Reads::Angle(..)),
            Senses::Angle => matches!(sensor.reads, Reads::Position(JointIndex::Revolute(_))),
            Senses::Effort => matches!(sensor.reads, Reads::Effort(_)),
        }
    }
}

/// How a repeating effect is found: over which period or frequency, and by which phase. At each
/// frequency the response is linear in amplitude times sine and cosine of the phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scan {
    /// The parameter that is scanned.
    pub over: &'static str,
    /// The parameter that is a phase in rad.
    pub phase: &'static str,
    /// What is tried.
    pub range: ScanRange,
}

/// Values that a [`Scan`] tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanRange {
    /// Frequencies in Hz.
    Frequencies,
    /// Periods `1/k` for wave numbers k from the first to the second by steps of the third.
    WaveNumbers([f64; 3]),
    /// From the first to the second by steps of the third: waves in a turn.
    Orders([f64; 3]),
}

/// An effect by name, with everything that a user and a search need to know of it.
///
/// ```
/// use freeplay::effects::named;
/// use freeplay::prelude::*;
///
/// let machine = assemble(&Scenario::load(None, &[])?)?;
/// let wear = named("joint-wear").unwrap();
/// // Each of six joints, and those of one make.
/// assert!(wear.joints_of(&machine.mechanism).contains(&"A1".to_owned()));
/// assert!(wear.candidates(&machine.mechanism).len() >= 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Kind {
    /// Its name in files.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Where the equation comes from.
    pub source: &'static str,
    /// Where its trace shows in measured data.
    pub trace: &'static str,
    /// What it acts on.
    pub targets: Targets,
    /// Its numbers.
    pub parameters: &'static [Parameter],
    /// Sets of parameters that a search leaves free together, from the simplest on; the others keep
    /// their defaults.
    pub variants: &'static [&'static [&'static str]],
    /// The values (of a variant's parameters) at which the effect changes nothing; empty where none do.
    pub neutral: fn(&Mechanism, &Setting) -> Vec<f64>,
    /// Where a search on a machine starts beside the neutral point, for parameters in which the machine's response
    /// is not linear: values of a setting's parameters, whatever it has now ([`Setting::starts`]). Empty where neutral is enough.
    pub starts: fn(&Mechanism, &Setting) -> Vec<Vec<f64>>,
    /// How to find a repeating effect, if it is one.
    pub scan: Option<Scan>,
    /// Changes a mechanism as the effect does.
    pub apply: fn(&Setting, &mut Mechanism) -> Result<(), Wrong>,
}

impl Kind {
    /// The parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// Whether the effect lasts, rather than begins at an instant (`at_s`).
    pub fn lasts(&self) -> bool {
        self.parameter("at_s").is_none()
    }

    /// Whether it is an error of an instrument, not of the machine.
    pub fn is_instrument(&self) -> bool {
        matches!(self.targets, Targets::Sensor(_) | Targets::Tracker)
    }

    /// Names of the joints of `mechanism` that this effect can be given one of.
    pub fn joints_of(&self, mechanism: &Mechanism) -> Vec<String> {
        let Some(joints) = self.targets.joints() else { return Vec::new() };
        let of = mechanism.joints().filter(|(_, joint)| joints.include(mechanism, *joint));
        of.map(|(name, _)| name.to_owned()).collect()
    }

    /// Everything on `mechanism` that the effect can act on, one at a time, then all of them at once where
    /// it may be given none. Common causes follow: joints of one sort, for they are of one make; sensors that
    /// read the same quantity, for they may share an instrument. Joints without clearance are left out
    /// where the effect would leave them as they are.
    pub fn targets_of(&self, mechanism: &Mechanism) -> Vec<Target> {
        let worn = |name: &String| {
            let mut joints = mechanism.revolutes.iter();
            let joint = joints.find(|joint| joint.name == *name);
            joint.is_none_or(|joint| !matches!(joint.bearing, Bearing::Ideal))
        };
        match self.targets {
            Targets::Machine => vec![Target::Machine],
            // An effort that is given is recorded as it is given.
            Targets::Commands => {
                let follows = mechanism.actuators.iter().any(|drive| drive.drive != Drive::Effort);
                follows.then_some(Target::Machine).into_iter().collect()
            }
            Targets::Joint(joints) | Targets::JointOrAll(joints) => {
                let mut names = self.joints_of(mechanism);
                names.retain(|name| joints != JointKinds::Bearing || worn(name));
                let all = matches!(self.targets, Targets::JointOrAll(_)) && names.len() > 1;
                let groups = if all || !self.has_common_causes() {
                    Vec::new()
                } else {
                    of_one_make(mechanism, &names)
                };
                let each = names.into_iter().map(|name| vec![name]).chain(groups);
                each.map(Target::Joints).chain(all.then_some(Target::Machine)).collect()
            }
            // Parts of one moving body are one target.
            Targets::Body if mechanism.names.bodies.is_empty() => vec![Target::Machine],
            Targets::Body => {
                let bodies = mechanism.bodies.iter();
                bodies.map(|body| Target::Body(body.name.clone())).collect()
            }
            Targets::Point => {
                let points = mechanism.names.points.iter();
                let used = points.filter(|(_, point)| point.holds_a_joint());
                used.map(|(name, _)| Target::Point(name.clone())).collect()
            }
            Targets::Sensor(Senses::Zeroed) => sensors_of(mechanism, Senses::Coordinate),
            Targets::Sensor(senses) => sensors_of(mechanism, senses),
            Targets::Tracker => {
                let tracked = mechanism.sensors.iter().any(Sensor::tracks);
                tracked.then_some(Target::Machine).into_iter().collect()
            }
        }
    }

    /// Whether joints of one make may have it alike: not what is placed otherwise in each, as the phase of a
    /// wave or the place of a point is, nor clearances, which are declared joint by joint.
    fn has_common_causes(&self) -> bool {
        let placed = |parameter: &Parameter| parameter.name.contains("phase");
        !matches!(self.targets.joints(), Some(JointKinds::Anchor | JointKinds::Bearing))
            && self.scan.is_none()
            && !self.parameters.iter().any(placed)
    }

    /// The variants that make sense on a target: where an effect has numbers for prismatic and for revolute
    /// joints, those that fit.
    pub fn variants_of(
        &self,
        mechanism: &Mechanism,
        target: &Target,
    ) -> Vec<&'static [&'static str]> {
        let names = match target {
            Target::Joints(names) => names.clone(),
            _ => self.joints_of(mechanism),
        };
        let of = |prismatic: bool| {
            let mut joints = mechanism.joints().filter(|(name, _)| names.iter().any(|n| n == name));
            joints.any(|(_, joint)| matches!(joint, JointIndex::Prismatic(_)) == prismatic)
        };
        let fits = |name: &&str| {
            let sort = self.parameter(name).and_then(Parameter::of_prismatic);
            self.targets.joints() != Some(JointKinds::Driven) || sort.is_none_or(of)
        };
        self.variants.iter().copied().filter(|variant| variant.iter().all(fits)).collect()
    }

    /// Every variant of the effect on everything that it can act on, at its neutral values.
    pub fn candidates(&'static self, mechanism: &Mechanism) -> Vec<Setting> {
        let targets = self.targets_of(mechanism);
        let each = |target: Target| {
            let variants = self.variants_of(mechanism, &target);
            variants
                .into_iter()
                .filter_map(move |v| Setting::neutral(self, target.clone(), v, mechanism))
        };
        targets.into_iter().flat_map(each).collect()
    }
}

impl Parameter {
    /// Whether it is a number of prismatic joints, or of revolute ones; none where it is of both.
    fn of_prismatic(&self) -> Option<bool> {
        let both = self.unit.is_empty() || self.unit.contains(" or ");
        (!both).then(|| !self.unit.contains("rad") && !self.unit.contains("N m"))
    }
}

/// Those of some joints that are prismatic or revolute and driven or not alike, where they are several.
fn of_one_make(mechanism: &Mechanism, names: &[String]) -> Vec<Vec<String>> {
    let make = |name: &String| {
        let (_, joint) = mechanism.joints().find(|(known, _)| known == name)?;
        let driven = mechanism.actuators.iter().any(|drive| drive.joint == joint);
        Some((matches!(joint, JointIndex::Prismatic(_)), driven))
    };
    let makes = [(true, true), (true, false), (false, true), (false, false)];
    let of = |sort| names.iter().filter(|name| make(name) == Some(sort)).cloned().collect();
    let groups = makes.map(of).into_iter();
    groups.filter(|group: &Vec<String>| group.len() > 1).collect()
}

/// Each sensor by itself, and those of one quantity together.
fn sensors_of(mechanism: &Mechanism, senses: Senses) -> Vec<Target> {
    let fitting: Vec<&Sensor> =
        mechanism.sensors.iter().filter(|sensor| senses.include(sensor)).collect();
    let columns = |of: &dyn Fn(&Sensor) -> bool| -> Vec<String> {
        let of = fitting.iter().filter(|sensor| of(sensor));
        of.map(|sensor| sensor.column.clone()).collect()
    };
    let each = columns(&|_| true).into_iter().map(|column| vec![column]);
    let groups = [
        columns(&|sensor| matches!(sensor.reads, Reads::Position(_))),
        columns(&|sensor| matches!(sensor.reads, Reads::Effort(_))),
        columns(&Sensor::tracks),
        columns(&|sensor| matches!(sensor.reads, Reads::Acceleration(..))),
    ];
    let groups = groups.into_iter().filter(|group| group.len() > 1);
    each.chain(groups).map(Target::Sensors).collect()
}

/// The neutral point of effects that vanish where all their numbers have their defaults; a number
/// without one takes 0.
pub(super) fn defaults(_: &Mechanism, setting: &Setting) -> Vec<f64> {
    let default = |name| setting.kind.parameter(name).and_then(|p| p.default).unwrap_or(0.0);
    setting.values().map(|(name, _)| default(name)).collect()
}

/// The starts of effects to which the machine responds linearly.
pub(super) fn linear(_: &Mechanism, _: &Setting) -> Vec<Vec<f64>> {
    Vec::new()
}
