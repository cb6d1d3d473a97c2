//! What a calibration comes to.

use serde::{Deserialize, Serialize};

/// What a calibration comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Named effects bring the residual down to noise.
    Explained,
    /// The declared model does so by itself.
    NothingMissing,
    /// Something remains that no effect with a name explains.
    Unexplained,
}

impl Verdict {
    /// As reports spell it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Explained => "explained",
            Self::NothingMissing => "nothing-missing",
            Self::Unexplained => "unexplained",
        }
    }
}
