//! What all other modules speak in: shapes, element types, chunks of elements, the node table.

mod chunk;
mod column;
mod element;
mod frame;
mod gather;
mod nodes;
mod region;
mod scored;
mod shape;

pub use chunk::{CHUNK, Chunk, Origin, Tag};
pub use column::{Column, ColumnBuilder};
pub use element::{Class, ElementType, IN_ORDER};
pub use frame::{Axis, Frame, System, three};
pub use gather::{gather, prefetch};
pub use nodes::{Bounds, Nodes, NodesBuilder};
pub use region::{NO_REGION, Regions};
pub use scored::{ElementWriter, ScoredElement};
pub use shape::{Facts, Shape};
