//! Ways of stepping, each a [`Stepper`](stepper::Stepper), and what they have in common: where they looked ([`looks`]), what lies
//! between a step's ends ([`between`]), the balance of [`energy`].

pub(super) mod adaptive;
pub(super) mod between;
pub(super) mod direct;
pub(super) mod energy;
pub(super) mod fixed;
pub(super) mod looks;
pub(super) mod native;
pub(super) mod stepper;
