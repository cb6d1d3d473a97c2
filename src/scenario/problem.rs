//! What is wrong with a scenario, where, and what would be right.

use std::fmt;

/// Where the text stands that a [`Problem`] complains about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// In a file, or in the built-in default.
    File {
        /// The file as the user called it.
        name: String,
        /// Line, counted from 1; `None` when the key and its section are not in the file.
        line: Option<u32>,
        /// Column, counted from 1; known for syntax errors.
        column: Option<u32>,
    },
    /// In a `--set PATH=VALUE` of the command line.
    Set {
        /// The `PATH` of that option.
        path: String,
    },
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Location::File { name, line, column } => {
                f.write_str(name)?;
                for number in [line, column].into_iter().flatten() {
                    write!(f, ":{number}")?;
                }
                Ok(())
            }
            Location::Set { path } => write!(f, "--set {path}"),
        }
    }
}

/// One complaint about a scenario, printed as `file:line: key: what is wrong; what would be right`.
///
/// [`Scenario`](crate::scenario::Scenario) has an example.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct Problem {
    /// Dotted path of the key, such as `joints.clearance`; empty when the file as a whole is meant.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
    /// Where the key was written.
    pub location: Location,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.location)?;
        // The key is named once: not again after `--set KEY`, nor before a message that quotes it.
        let location_names_it =
            matches!(&self.location, Location::Set { path } if *path == self.path);
        let message_names_it = self.message.contains(&format!("`{}`", self.path));
        if !self.path.is_empty() && !location_names_it && !message_names_it {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}; {}", self.message, self.help)
    }
}

/// Everything found wrong in one reading of a scenario, one problem a line.
///
/// [`Scenario`](crate::scenario::Scenario) has an example.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct Problems(pub Vec<Problem>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            problem.fmt(f)?;
        }
        Ok(())
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Problems(vec![problem])
    }
}
