//! The course of one drive: one that was made of numbers, or the present one.

use super::present::Present;
use super::series::{Extremes, FourierSeries};

/// Where a drive is told to be over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    /// Made of numbers.
    New(FourierSeries),
    /// As it is told at present.
    Present(Present),
}

impl Course {
    /// Coordinate (m, rad) at the start.
    pub fn start(&self) -> f64 {
        match self {
            Self::New(series) => series.start,
            Self::Present(present) => present.start,
        }
    }

    /// The same course, so many times as large, from another coordinate on.
    pub fn scaled(&self, factor: f64, start: f64) -> Self {
        match self {
            Self::New(series) => Self::New(series.scaled(factor, start)),
            Self::Present(present) => Self::Present(present.scaled(factor, start)),
        }
    }

    /// Coordinate (m, rad), rate and acceleration at time `t` (s).
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Self::New(series) => series.at(t),
            Self::Present(present) => present.at(t),
        }
    }

    /// Bounds of the course.
    pub fn extremes(&self) -> Extremes {
        match self {
            Self::New(series) => series.extremes(),
            Self::Present(present) => present.extremes(),
        }
    }
}
