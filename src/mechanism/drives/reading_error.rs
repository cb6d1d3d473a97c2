//! What makes an encoder read something else than the true coordinate.

use std::fmt::Debug;

/// How a driven joint's true length differs from what its encoder and its drive read.
pub trait ReadingError: Debug + Send + Sync {
    /// `true − read` in m at the read length `read` (m), and its first and second derivative by it.
    fn at(&self, read: f64) -> [f64; 3];
}
