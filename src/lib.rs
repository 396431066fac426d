//! Is a finite-element mesh fit to be solved? meshgauge scores meshes far larger than memory by the twelve measures of
//! L. Wright's report *Testing Automatic Mesh Generation Software* (NPL, 2007), in one streaming run and a fixed budget.
//!
//! ```no_run
//! use std::path::Path;
//! use meshgauge::mesh::Shape;
//!
//! let summary = meshgauge::score(Path::new("pit.msh.zst"), &meshgauge::Options::default())?;
//! let tetrahedra = &summary.shapes[&Shape::Tetrahedron];
//! let flatness = &tetrahedra.measures["M34"];
//! println!("{} tetrahedra, the flattest is {} with {}", tetrahedra.count, flatness.min_element, flatness.min);
//! # Ok::<(), meshgauge::Error>(())
//! ```
//!
//! Bytes go one way, through layers of which each uses only those below it:
//!
//! ```text
//! pipeline  report  export  generate    the only threads and channels; text and files; model problems
//! compare                               two summaries beside each other
//! formats     measures    statistics    bytes to elements; coordinates to scores; scores to moments and bins
//! summary     mesh        input         the schema; shapes, chunks, the node table; mapped and unpacked files
//! error                                 one error type, with a place in the file
//! ```
//!
//! The library writes nothing to standard output, never exits, and builds without the program's dependencies
//! (`--no-default-features`). What it promises is listed in ARCHITECTURE.md, each promise with the test that holds it.

pub mod compare;
pub mod error;
pub mod export;
pub mod formats;
pub mod generate;
pub mod input;
pub mod measures;
pub mod mesh;
pub mod pipeline;
pub mod report;
pub mod statistics;
pub mod summary;
#[doc(hidden)]
pub mod width;

pub use error::{Error, Result};
pub use pipeline::{Options, Progress, score, score_each, score_reader, score_reader_each};
pub use summary::Summary;
