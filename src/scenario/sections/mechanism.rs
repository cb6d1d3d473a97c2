//! `[mechanism]`: which machine it is.

use super::templates::*;
use super::{Described, Joint, Motion};
use crate::scenario::reading::reader::Reader;
use schemars::JsonSchema;
use serde::Serialize;
use toml::Table;

/// The list of templates: the enum, the names of its kinds, and how they are read.
macro_rules! mechanisms {
    ($($(#[$doc:meta])* $name:ident = $kind:literal),+ $(,)?) => {
        /// The machine, by its `kind`, the only key of a scenario without a default: a file that does not
        /// say what it describes is more likely a mistake than a 3-RPR.
        #[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
        #[serde(tag = "kind")]
        pub enum Mechanism {
            $($(#[$doc])* #[serde(rename = $kind)] $name($name),)+
            /// No kind: the file describes its bodies and joints itself.
            #[serde(skip)]
            Described(Box<Described>),
        }

        impl Mechanism {
            /// All kinds.
            pub const KINDS: [&'static str; [$($kind),+].len()] = [$($kind),+];

            /// Reads `[mechanism]` of a kind; of none that is known, as a 3-RPR.
            pub(in crate::scenario) fn read(kind: &str, reader: &mut Reader<'_>, table: Table) -> Self {
                match kind {
                    $($kind => Self::$name(reader.read("mechanism", table)),)+
                    _ => Self::ThreeRpr(reader.read("mechanism", table)),
                }
            }

            /// What is known of its kind; none of a machine that its file describes itself.
            pub fn template(&self) -> Option<&dyn Template> {
                match self {
                    $(Self::$name(machine) => Some(machine),)+
                    Self::Described(_) => None,
                }
            }
        }
    };
}

mechanisms! {
    /// `kind = "3rpr"`: the planar parallel manipulator with three legs, each R-P-R.
    ThreeRpr = "3rpr",
    /// `kind = "drive-stage"`: one load on one driven prismatic joint.
    DriveStage = "drive-stage",
    /// `kind = "pendulum"`: one arm on one revolute joint.
    Pendulum = "pendulum",
    /// `kind = "slider-crank"`: crank, rod and slider.
    SliderCrank = "slider-crank",
    /// `kind = "four-bar"`: crank, coupler and rocker.
    FourBar = "four-bar",
    /// `kind = "five-bar"`: two cranks that carry a point by two rods.
    FiveBar = "five-bar",
    /// `kind = "3rrr"`: the planar parallel manipulator with three driven cranks.
    ThreeRrr = "3rrr",
    /// `kind = "double-pendulum"`: an arm on an arm.
    DoublePendulum = "double-pendulum",
}

impl Mechanism {
    /// Names of the revolute joints, in the order of lists that hold a value for each.
    pub fn revolute_names(&self) -> Vec<&str> {
        if let Some(template) = self.template() {
            return template.revolutes().to_vec();
        }
        let revolute = |joint: &&Joint| matches!(joint, Joint::Revolute(_));
        let joints = self.described().map_or(&[][..], |described| &described.joints);
        joints.iter().filter(revolute).map(Joint::name).collect()
    }

    /// Whether the motion is that of a crank's angle, the coordinate of the joint O.
    pub(in crate::scenario) fn has_crank(&self) -> bool {
        self.template().is_some_and(Template::has_crank)
    }

    /// The motion where none is asked for.
    pub(in crate::scenario) fn default_motion(&self) -> Motion {
        self.template().map_or_else(Motion::default, Template::default_motion)
    }

    /// Whether the file describes its mechanism itself.
    pub fn described(&self) -> Option<&Described> {
        match self {
            Mechanism::Described(described) => Some(described),
            _ => None,
        }
    }

    /// Whether its recordings are read by `[[sensor]]`s: its file's own, or those that the template makes of
    /// `[columns]`.
    pub fn has_sensors(&self) -> bool {
        self.uses("columns")
    }

    /// The sections beside those of every machine that this one has a use for.
    pub(crate) fn uses(&self, section: &str) -> bool {
        let own = match self.template() {
            Some(template) => template.sections(),
            None => &["motion", "drive", "columns"],
        };
        !["motion", "drive", "legs", "sensors", "columns"].contains(&section)
            || own.contains(&section)
    }
}
