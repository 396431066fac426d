//! What all other modules speak in: shapes, element types, chunks of elements, the node table.

mod chunk;
mod column;
mod element;
mod frame;
mod nodes;
mod shape;

pub use chunk::{CHUNK, Chunk, Origin};
pub use column::{Column, ColumnBuilder};
pub use element::{Class, ElementType, IN_ORDER};
pub use frame::{Axis, Frame, System, three};
pub use nodes::{Bounds, Nodes, NodesBuilder};
pub use shape::{Facts, Shape};
