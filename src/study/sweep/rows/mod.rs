//! What runs came to, as rows: their journal and record on the disk, the table and its statistics, pictures and the page.

pub(super) mod journal;
pub(super) mod page;
#[cfg(feature = "parquet")]
pub(super) mod parquet;
pub(super) mod pictures;
pub(super) mod record;
pub(in crate::study) mod row;
pub(super) mod statistics;
