//! What a quantity of native contacts can be judged to be good for.

use serde::Serialize;

/// What a native quantity may be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NativeUse {
    /// As it is.
    Yes,
    /// As a size, not as a value.
    Size,
    /// For nothing.
    No,
    /// Too few data to say.
    Unclear,
}

/// A judgement of one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct QuantityVerdict {
    /// Key of the quantity.
    pub quantity: &'static str,
    /// What native may be used for.
    #[serde(rename = "use")]
    pub usable: NativeUse,
    /// Why, with the figures.
    pub reason: String,
}
