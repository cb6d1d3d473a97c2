//! What does not last: a knock, a push, a load that comes or drops off.
//!
//! The efforts that a recorded motion takes, less those that the model knows of ([`series`]), are cleared of what
//! recurs with the motion (`lasting`), and every stretch of time is held against the same statistic of the rest
//! of the recording ([`scan`](mod@scan)). What stands out becomes a history of efforts in joints ([`found`]).

pub mod found;
mod lasting;
pub mod picture;
pub mod scan;
pub mod search;
pub mod series;
mod spread;

pub use found::{Event, events};
pub use series::FreedomSeries;
