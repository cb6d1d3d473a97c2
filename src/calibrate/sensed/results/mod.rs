//! The whole way ([`outcome`]) and what is written of it: [`report`], `charts`, `page`, `written`; how each of three ways comes to these
//! (`ways`); a model held against one recording ([`predict`]).

pub(in crate::calibrate) mod charts;
pub mod outcome;
pub(super) mod page;
pub mod predict;
pub mod report;
pub(in crate::calibrate) mod ways;
pub(in crate::calibrate) mod written;
