//! From a description to a mechanism that is not yet put together: bodies with their masses, joints, drives, springs, names.

pub(super) mod build;
pub(super) mod declared_drives;
pub(super) mod guides;
pub(super) mod layout;
pub(super) mod material;
pub(super) mod names;
pub(super) mod parts;
pub(super) mod shape;
