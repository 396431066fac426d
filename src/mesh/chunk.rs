//! A chunk: a fixed number of elements of one shape, the unit that goes through the pipeline.

use super::Shape;

/// The most elements that one chunk holds.
pub const CHUNK: usize = 4096;

/// At most [`CHUNK`] elements of one shape. Chunks are made once, at the start, and handed round: a chunk never grows.
#[derive(Debug)]
pub struct Chunk {
    shape: Shape,
    /// Number of the piece that the elements came from, and of this chunk within it.
    origin: Origin,
    /// Row of each corner in the node table: `corners` rows an element.
    rows: Vec<u32>,
    /// The element's own number, one an element.
    labels: Vec<u64>,
    /// One an element, where somebody asked for single elements or regions; else none.
    tags: Vec<Tag>,
}

/// What is known of an element besides its number and nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tag {
    /// Its place among the measured elements of its piece, whatever their shape.
    pub ordinal: u32,
    /// The number of its region, [`NO_REGION`](super::NO_REGION) where it is in none.
    pub region: u32,
}

/// Where a chunk stands in the file: what the merge is ordered by.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Origin {
    /// Number of the piece, in file order.
    pub piece: u64,
    /// Number of the chunk within the piece.
    pub chunk: u32,
}

impl Default for Chunk {
    fn default() -> Self {
        Self::new()
    }
}

impl Chunk {
    /// An empty chunk with room for [`CHUNK`] elements of any shape.
    pub fn new() -> Self {
        Self {
            shape: Shape::Tetrahedron,
            origin: Origin::default(),
            rows: Vec::with_capacity(CHUNK * Shape::MAX_CORNERS),
            labels: Vec::with_capacity(CHUNK),
            tags: Vec::new(),
        }
    }

    /// Empties the chunk and makes it one of `shape`.
    pub fn reset(&mut self, shape: Shape, origin: Origin) {
        self.shape = shape;
        self.origin = origin;
        self.rows.clear();
        self.labels.clear();
        self.tags.clear();
    }

    /// Adds an element. `rows` are the shape's corners as rows of the node table.
    #[inline(always)]
    pub fn push(&mut self, label: u64, rows: &[u32]) {
        debug_assert!(rows.len() == self.shape.corners() && !self.is_full());
        self.labels.push(label);
        self.rows.extend_from_slice(rows);
    }

    /// Adds elements, as many as there are labels and no more than [`Chunk::room`]: `rows` are the corners of all.
    pub fn extend(&mut self, labels: &[u64], rows: &[u32]) {
        debug_assert!(labels.len() <= self.room() && rows.len() == labels.len() * self.shape.corners());
        self.labels.extend_from_slice(labels);
        self.rows.extend_from_slice(rows);
    }

    /// Number of elements that still fit.
    pub fn room(&self) -> usize {
        CHUNK - self.labels.len()
    }

    /// Adds what is known of the element that was comes next among those without a tag.
    pub fn tag(&mut self, tag: Tag) {
        debug_assert!(self.tags.len() < self.labels.len());
        self.tags.push(tag);
    }

    /// Whether no further element fits.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.labels.len() >= CHUNK
    }

    /// Whether it holds no element.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// The shape of all its elements.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Where it stands in the file.
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// The elements' own numbers.
    pub fn labels(&self) -> &[u64] {
        &self.labels
    }

    /// The same, to be made rows of another table.
    pub fn rows_mut(&mut self) -> &mut [u32] {
        &mut self.rows
    }

    /// The corners of all elements as rows of the node table, element by element.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// What is known of the elements besides; empty where nobody asked.
    pub fn tags(&self) -> &[Tag] {
        &self.tags
    }
}
