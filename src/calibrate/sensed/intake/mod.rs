//! From a rig and its files to a problem: everything that speaks against them ([`prepare`], [`followed`], `led`), and noise other than
//! declared ([`noise`]).

pub(super) mod followed;
mod led;
mod mistaken;
pub mod noise;
pub(in crate::calibrate) mod prepare;
