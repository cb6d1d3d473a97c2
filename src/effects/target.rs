//! What an effect acts on.

use std::fmt;

/// What an effect acts on, by name.
///
/// [`Setting`](crate::effects::Setting) has an example.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// The whole machine, all joints that the effect takes, or the output body: what holds where nothing is
    /// named.
    Machine,
    /// Joints with a common cause.
    Joints(Vec<String>),
    /// A described body.
    Body(String),
    /// A named point, `body.point`.
    Point(String),
    /// Sensors with a common cause, by their columns.
    Sensors(Vec<String>),
}

impl Target {
    /// The key under which a file names it; none of the whole machine.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Target::Machine => None,
            Target::Joints(_) => Some("joint"),
            Target::Body(_) => Some("body"),
            Target::Point(_) => Some("point"),
            Target::Sensors(_) => Some("sensor"),
        }
    }

    /// The names; none of the whole machine.
    pub fn names(&self) -> &[String] {
        match self {
            Target::Machine => &[],
            Target::Joints(names) | Target::Sensors(names) => names,
            Target::Body(name) | Target::Point(name) => std::slice::from_ref(name),
        }
    }
}

/// The names, as in `A1` or `P1, P2`.
impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.names().join(", "))
    }
}
