//! Hertz' law: an elastic contact.

use super::kind::{ELASTIC, LawKind, Losses};
use super::loss::Loss;

/// `F = K δⁿ`, K as in [`hertz_stiffness`](crate::contact::hertz_stiffness).
pub(super) static KIND: LawKind = LawKind {
    name: "hertz",
    summary: "the elastic contact of smooth bodies, without loss",
    equation: "K d^n",
    source: "H. Hertz, J. reine angew. Math. 92 (1881) 156-171",
    validity: "contacts that are small against the bodies, slow hits without loss",
    parameters: ELASTIC,
    losses: Losses::Elastic,
    build: |given| given.power(Loss::None),
};
