//! # freeplay
//!
//! Planar mechanisms whose revolute joints have clearance (free play): a journal flies and hits
//! inside its bearing ring, and the motion turns chaotic. Links are rapier2d rigid bodies, journals
//! and rings collide through a force law of their own choosing (Hertz plus STEP damping by
//! default), prismatic drives follow the inverse kinematics.
//!
//! The rooms, bottom to top (each uses only what stands before it):
//!
//! | room | holds |
//! |---|---|
//! | [`measure`] | thinning of long signals, interpolation, statistics |
//! | [`contact`] | force laws as plain functions, and the forces in one clearance joint |
//! | [`mechanism`] | bodies, joints, drives, motions as plain data; the 3-RPR; equations of motion |
//! | [`effects`] | what may act on a machine undeclared: payloads, friction, worn joints, late servos |
//! | [`engine`] | the only room that knows rapier: ring shape, contact hook, stepping |
//! | [`scenario`] | the TOML file, validated |
//! | [`model`] | scenario → bodies, joints, drives → a machine put together |
//! | [`simulate`] | scenario → mechanism → samples and summary |
//! | [`report`] | pictures and the page, from plain data |
//! | [`study`] | what users come for: a run and its files, sweeps |
//! | [`calibrate`] | what a declared model lacks, by recorded runs of the machine |
//! | [`cli`] | one file per command |
//!
//! SI units everywhere.

pub mod calibrate;
pub mod cli;
pub mod contact;
pub mod effects;
pub mod engine;
pub mod measure;
pub mod mechanism;
pub mod model;
pub mod report;
pub mod scenario;
pub mod simulate;
pub mod study;
