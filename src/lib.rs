//! Streaming, out-of-core finite-element mesh quality.

pub mod error;
pub mod formats;
pub mod generate;
pub mod input;
pub mod measures;
pub mod mesh;
pub mod pipeline;
pub mod report;
pub mod statistics;
pub mod summary;

pub use error::{Error, Result};
pub use pipeline::{Options, Progress, score, score_reader};
pub use summary::Summary;
