//! One effect after another, several hypotheses at once, until the residuals are white: [`search`], [`screen`], [`beside`], [`way`];
//! what is left ([`left`]), what a model can do without ([`needed`]), and forces without a name ([`unnamed`]).

pub mod beside;
pub mod left;
pub mod needed;
pub mod screen;
pub mod search;
pub mod unnamed;
pub mod way;
