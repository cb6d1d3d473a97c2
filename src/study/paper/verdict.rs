//! What the simulations can say of a claim.

use super::estimate::Estimate;
use serde::Serialize;

/// What the simulations say of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ClaimVerdict {
    /// The interval agrees with it.
    Supported,
    /// The interval excludes it.
    Contradicted,
    /// The interval allows both, or there is none.
    Undecided,
}

/// A claim in the light of one variant.
#[derive(Clone, Debug, Serialize)]
pub struct JudgedClaim {
    /// Key of the claim.
    pub key: &'static str,
    /// What the simulations say.
    pub verdict: ClaimVerdict,
    /// The value that the claim is judged by; `null` for a ratio to nothing.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The numbers behind it, in words.
    pub evidence: String,
}

impl ClaimVerdict {
    /// In one word.
    pub fn in_words(self) -> &'static str {
        match self {
            ClaimVerdict::Supported => "supported",
            ClaimVerdict::Contradicted => "contradicted",
            ClaimVerdict::Undecided => "undecided",
        }
    }
}
