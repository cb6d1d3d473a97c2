//! How a recorded machine moved: where it begins, driven ([`start`]) or let go at rest ([`released`], [`at_rest`]), and how it swings
//! there ([`swinging`]); what says how it stands ([`basis`], [`sources`]) and
//! along which motions ([`shown`], [`motions`]); what servos make of that ([`law`]); what its sensors would have recorded
//! ([`simulate`]).

pub(super) mod at_rest;
pub mod basis;
pub(super) mod law;
pub(super) mod motions;
pub mod released;
pub(super) mod shown;
pub mod simulate;
pub(super) mod sources;
pub mod start;
pub(super) mod swinging;
