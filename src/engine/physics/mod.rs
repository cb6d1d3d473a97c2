//! The rapier side: a mechanism in a rapier world ([`world`], [`inserter`]), whose steps are read as a [`leapfrog`]; bearings as shapes
//! ([`ring`]) with their queries ([`dispatcher`]) and colliders; clearance joints for anybody's world.

pub(super) mod clearance_joints;
pub(super) mod colliders;
pub(super) mod dispatcher;
pub(super) mod inserter;
pub(super) mod leapfrog;
pub(super) mod ring;
pub(super) mod world;
