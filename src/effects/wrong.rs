//! What is wrong with an effect that a file gives.

/// What is wrong with a [`Setting`](super::Setting): the key, what it is, what would be right.
///
/// [`Setting`](super::Setting) has an example.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// `kind`, `joint` or a parameter.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl Wrong {
    /// A fitted table that names a `thing` which this machine does not have; it has those that are `known`.
    pub(super) fn of_another_machine<'a>(
        key: &str,
        thing: &str,
        name: &str,
        known: impl Iterator<Item = &'a str>,
    ) -> Self {
        let known: Vec<&str> = known.collect();
        Self {
            key: key.to_owned(),
            message: format!("\"{name}\" is not a {thing} of this machine"),
            help: format!(
                "this effect belongs to the machine that it was fitted to; this one has {}",
                if known.is_empty() { "none".to_owned() } else { known.join(", ") }
            ),
        }
    }

    /// A fitted table whose lists do not belong together.
    pub(super) fn torn(key: &str, message: &str) -> Self {
        Self {
            key: key.to_owned(),
            message: message.to_owned(),
            help: "this effect is written by `freeplay calibrate`: copy it whole".to_owned(),
        }
    }
}
