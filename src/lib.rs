//! Streaming, out-of-core finite-element mesh quality.

pub mod error;
pub mod formats;
pub mod generate;
pub mod input;
pub mod measures;
pub mod mesh;

pub use error::{Error, Result};
