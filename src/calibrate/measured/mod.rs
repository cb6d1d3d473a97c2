//! A recording of a 3-RPR, and what it says without a search: files and what speaks against them ([`recording`], `mistaken`); whether
//! the machine is chaotic ([`rattle`]); its commands and its sensors ([`commands`], [`replica`]); the swing with which it begins
//! ([`start`]); its residuals ([`lens`], `measured_dynamics`) and their noise by frequency ([`spectrum`], `draws`).

pub mod commands;
pub(super) mod draws;
pub mod lens;
pub(super) mod measured_dynamics;
pub(super) mod mistaken;
pub mod rattle;
pub mod recording;
pub mod replica;
pub mod spectrum;
pub mod start;
