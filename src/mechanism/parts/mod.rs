//! What a mechanism is made of, as plain data: bodies and points of them, joints, springs, loads, and their names.

pub(super) mod body;
pub(super) mod joint;
pub(super) mod load;
pub(super) mod mark;
pub(super) mod names;
pub(super) mod oil;
pub(super) mod spring;
