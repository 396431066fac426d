//! The twelve measures: against values of 25 digits, against themselves under motions that must change nothing,
//! and batch against scalar.

mod golden;
mod invariance;
mod random;
mod table;
mod volume;
mod widths;
