//! What all other modules speak in: shapes, element types, chunks of elements, the node table.

mod chunk;
mod element;
mod shape;

pub use chunk::{CHUNK, Chunk, Origin};
pub use element::{Class, ElementType, IN_ORDER};
pub use shape::{Facts, Shape};
