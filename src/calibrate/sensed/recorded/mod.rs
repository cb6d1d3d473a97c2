//! Files of recordings, and what they hold: which column is of which sensor ([`heads`]), rows on a grid ([`samples`]), columns of
//! no sensor ([`cells`]), a run as a whole ([`recording`]), and its samples smoothed as needed ([`view`]).

pub(super) mod cells;
pub(super) mod columns;
pub mod recording;
pub(super) mod samples;
pub mod view;
