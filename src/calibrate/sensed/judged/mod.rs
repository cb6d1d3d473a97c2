//! What is said of a model that was found: what it leaves ([`left`]), which of its values are needed ([`simpler`]), what would explain
//! as much ([`rivals`]), what the recordings could not show ([`limits`]), and what has no name ([`unnamed`], `central`, by
//! `table_fits`).

mod central;
pub mod left;
pub mod limits;
pub(super) mod rivals;
pub(super) mod simpler;
mod table_fits;
pub mod unnamed;
