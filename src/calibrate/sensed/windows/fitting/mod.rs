//! Values fitted over windows: the machine and its runs ([`bench`]), windows and their starts ([`window`], [`pose`], [`roll`]), what is
//! sought, and Gauss and Newton's method on all of it.

pub mod bench;
pub mod eliminate;
pub mod fits;
pub mod inputs;
pub mod pose;
pub mod roll;
pub mod shooting;
pub mod sought;
pub mod window;
