//! Effects in joints: where they are, how wide and how round they are, what rubs in them, and what hits in them lose.

pub(super) mod anchor_offset;
pub(super) mod bristle_friction;
pub(super) mod contact_damping;
pub(super) mod contact_law;
pub(super) mod joint_friction;
pub(super) mod joint_wear;
pub(super) mod journal_friction;
pub(super) mod lubricant_film;
pub(super) mod out_of_round;
pub(super) mod pivot_friction;
