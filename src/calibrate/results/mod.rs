//! What all ways of calibrating and predicting write alike: [`verdict`], parts of the [`report`] and of the page (`page`, `charts`,
//! `unnamed_picture`), [`result`], the folder of all of it; of a prediction [`predicted`] and `predict_page`.

pub(super) mod charts;
pub(super) mod page;
pub(super) mod predict_page;
pub mod predicted;
pub mod report;
pub mod result;
pub(super) mod unnamed_picture;
pub mod verdict;
