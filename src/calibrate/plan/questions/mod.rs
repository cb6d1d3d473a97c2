//! What is asked, and how well a motion answers it: how far apart it brings models, as the machine's sensors see them.

pub mod answer;
pub mod asked;
pub mod instruments;
pub mod separation;
pub mod sight;
