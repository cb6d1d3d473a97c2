//! What is counted along a run: hits and largest values ([`watch`]), what rubs ([`wear`]), what it took ([`work`]).

pub(super) mod watch;
pub(super) mod wear;
pub(super) mod work;
