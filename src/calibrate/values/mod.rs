//! Numbers from residuals: spectra in units of noise ([`spectrum`], [`draws`]), values by least squares ([`least_squares`], `normal`),
//! of what is `rough`, and without the pull of what rattles ([`instrument`]), and by how much predictions miss ([`errors`]).

pub mod draws;
pub mod errors;
pub mod instrument;
pub mod least_squares;
pub(super) mod normal;
pub(super) mod rough;
pub mod spectrum;
