//! One effect after another ([`search`]), several hypotheses at once, in a [`round`] each: which promise ([`screen`]), those that are
//! simulated ([`hypotheses`]), what residuals hardly see ([`unseen`], [`other_laws`], [`calm`]) or one run alone shows ([`wider`]), values
//! that agree with simulations ([`settle`]); what still stands out ([`rest`]), and effects in [`words`].

pub(super) mod calm;
pub(super) mod hypotheses;
pub(super) mod other_laws;
pub(super) mod rest;
pub mod round;
pub(super) mod screen;
pub mod search;
pub mod settle;
pub(super) mod unseen;
pub(super) mod wider;
pub(super) mod words;
