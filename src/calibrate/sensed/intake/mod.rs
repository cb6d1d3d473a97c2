//! From a rig and its files to a problem: everything that speaks against them ([`prepare`], [`followed`]), and noise other than
//! declared ([`noise`]).

pub(super) mod followed;
pub mod noise;
pub(in crate::calibrate) mod prepare;
