//! What a file calls an element, and what of it is measured.

use std::borrow::Cow;

use super::Shape;

/// A type of element as a file names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementType {
    /// The type's own name in its format: `C3D10`, `Tetrahedron 10`, `VTK_TETRA`.
    pub name: Cow<'static, str>,
    /// Number of nodes that a record of this type lists.
    pub nodes: usize,
    /// What is done with such elements.
    pub class: Class,
}

/// What is done with the elements of a type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Class {
    /// Measured by its corner nodes.
    Measured {
        /// The shape that the corners make.
        shape: Shape,
        /// Polynomial order: 1 linear, 2 quadratic and so on.
        order: u8,
        /// For each corner of the shape, its place in the file's record. This is the one place where a
        /// format's node order is turned into ours.
        corners: &'static [u8],
    },
    /// Counted under this name and not measured: `line`, `point`, `connector`, `polygon`, a user element's own name.
    Counted(Cow<'static, str>),
}

/// Corners that stand first in the record, in our own order; cut it to the shape's corners.
pub const IN_ORDER: [u8; Shape::MAX_CORNERS] = [0, 1, 2, 3, 4, 5, 6, 7];

impl ElementType {
    /// A type that is measured, its corners first in the record and in our order.
    pub const fn measured(name: &'static str, shape: Shape, order: u8, nodes: usize) -> Self {
        Self::permuted(name, shape, order, nodes, IN_ORDER.split_at(shape.corners()).0)
    }

    /// A type that is measured, with its corners at the given places of the record.
    pub const fn permuted(
        name: &'static str,
        shape: Shape,
        order: u8,
        nodes: usize,
        corners: &'static [u8],
    ) -> Self {
        assert!(corners.len() == shape.corners());
        Self { name: Cow::Borrowed(name), nodes, class: Class::Measured { shape, order, corners } }
    }

    /// A type that is only counted, under the name `what`.
    pub const fn counted(name: &'static str, what: &'static str, nodes: usize) -> Self {
        Self { name: Cow::Borrowed(name), nodes, class: Class::Counted(Cow::Borrowed(what)) }
    }

    /// The shape, where the type is measured.
    pub fn shape(&self) -> Option<Shape> {
        match self.class {
            Class::Measured { shape, .. } => Some(shape),
            Class::Counted(_) => None,
        }
    }
}
