//! The whole way ([`outcome`]) and the folder of its results: [`evidence`], `summary`, [`report`], `charts`, `unnamed_picture`, `page`,
//! [`result`]; and those of a prediction: [`predict`], [`predicted`], `predict_page`.

pub(super) mod charts;
pub mod evidence;
pub mod outcome;
pub(super) mod page;
pub mod predict;
pub(super) mod predict_page;
pub mod predicted;
pub mod report;
pub mod result;
pub(super) mod summary;
pub(super) mod unnamed_picture;
