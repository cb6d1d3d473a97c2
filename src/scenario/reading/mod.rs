//! From a text to typed sections: a tree of values that know where they were written ([`document`]), readers of sections and
//! lists of them, values that nothing here can use.

pub(super) mod document;
pub(super) mod lists;
pub(super) mod read;
pub(super) mod read_motion;
pub(super) mod reader;
pub(super) mod unusable;
