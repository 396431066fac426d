//! Element types by the number of their descriptor. Parabolic elements go round their rings: corner, middle, corner.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use super::records::Head;
use crate::error::{Error, Result};
use crate::mesh::Shape::{Hexahedron, Quadrilateral, Tetrahedron, Triangle, Wedge};
use crate::mesh::{Class, ElementType};

/// The largest number of a descriptor; those that are not known are counted by number.
const LARGEST: u64 = 999;

/// Most nodes of an element that has another number of nodes than its descriptor says.
const MOST_ODD: usize = 64;

/// Corners of a ring of corners and middles.
const RING: [u8; 4] = [0, 2, 4, 6];

const fn triangle(name: &'static str, order: u8) -> ElementType {
    match order {
        1 => ElementType::measured(name, Triangle, 1, 3),
        _ => ElementType::permuted(name, Triangle, 2, 6, RING.split_at(3).0),
    }
}

const fn quadrilateral(name: &'static str, order: u8) -> ElementType {
    match order {
        1 => ElementType::measured(name, Quadrilateral, 1, 4),
        _ => ElementType::permuted(name, Quadrilateral, 2, 8, &RING),
    }
}

const fn line(name: &'static str) -> ElementType {
    ElementType::counted(name, "line", 0)
}

static KNOWN: [(u64, ElementType); 48] = [
    (11, line("Rod")),
    (21, line("Linear Beam")),
    (22, line("Tapered Beam")),
    (23, line("Curved Beam")),
    (24, line("Parabolic Beam")),
    (31, line("Straight Pipe")),
    (32, line("Curved Pipe")),
    (41, triangle("Plane Stress Linear Triangle", 1)),
    (42, triangle("Plane Stress Parabolic Triangle", 2)),
    (44, quadrilateral("Plane Stress Linear Quadrilateral", 1)),
    (45, quadrilateral("Plane Stress Parabolic Quadrilateral", 2)),
    (51, triangle("Plane Strain Linear Triangle", 1)),
    (52, triangle("Plane Strain Parabolic Triangle", 2)),
    (54, quadrilateral("Plane Strain Linear Quadrilateral", 1)),
    (55, quadrilateral("Plane Strain Parabolic Quadrilateral", 2)),
    (61, triangle("Plate Linear Triangle", 1)),
    (62, triangle("Plate Parabolic Triangle", 2)),
    (64, quadrilateral("Plate Linear Quadrilateral", 1)),
    (65, quadrilateral("Plate Parabolic Quadrilateral", 2)),
    (71, quadrilateral("Membrane Linear Quadrilateral", 1)),
    (72, triangle("Membrane Parabolic Triangle", 2)),
    (74, triangle("Membrane Linear Triangle", 1)),
    (75, quadrilateral("Membrane Parabolic Quadrilateral", 2)),
    (81, triangle("Axisymmetric Solid Linear Triangle", 1)),
    (82, triangle("Axisymmetric Solid Parabolic Triangle", 2)),
    (84, quadrilateral("Axisymmetric Solid Linear Quadrilateral", 1)),
    (85, quadrilateral("Axisymmetric Solid Parabolic Quadrilateral", 2)),
    (91, triangle("Thin Shell Linear Triangle", 1)),
    (92, triangle("Thin Shell Parabolic Triangle", 2)),
    (94, quadrilateral("Thin Shell Linear Quadrilateral", 1)),
    (95, quadrilateral("Thin Shell Parabolic Quadrilateral", 2)),
    (101, ElementType::measured("Thick Shell Linear Wedge", Wedge, 1, 6)),
    (102, ElementType::permuted("Thick Shell Parabolic Wedge", Wedge, 2, 15, &[0, 2, 4, 9, 11, 13])),
    (104, ElementType::measured("Thick Shell Linear Brick", Hexahedron, 1, 8)),
    (
        105,
        ElementType::permuted(
            "Thick Shell Parabolic Brick",
            Hexahedron,
            2,
            20,
            &[0, 2, 4, 6, 12, 14, 16, 18],
        ),
    ),
    (111, ElementType::measured("Solid Linear Tetrahedron", Tetrahedron, 1, 4)),
    (112, ElementType::measured("Solid Linear Wedge", Wedge, 1, 6)),
    (113, ElementType::permuted("Solid Parabolic Wedge", Wedge, 2, 15, &[0, 2, 4, 9, 11, 13])),
    (115, ElementType::measured("Solid Linear Brick", Hexahedron, 1, 8)),
    (116, ElementType::permuted("Solid Parabolic Brick", Hexahedron, 2, 20, &[0, 2, 4, 6, 12, 14, 16, 18])),
    (118, ElementType::permuted("Solid Parabolic Tetrahedron", Tetrahedron, 2, 10, &[0, 2, 4, 9])),
    (121, ElementType::counted("Rigid Bar", "rigid", 0)),
    (122, ElementType::counted("Rigid Element", "rigid", 0)),
    (136, ElementType::counted("Node To Node Translational Spring", "spring", 0)),
    (137, ElementType::counted("Node To Node Rotational Spring", "spring", 0)),
    (141, ElementType::counted("Node To Node Damper", "dashpot", 0)),
    (151, ElementType::counted("Node To Node Gap", "gap", 0)),
    (161, ElementType::counted("Lumped Mass", "mass", 0)),
];

static SHARED: LazyLock<Vec<(u64, Arc<ElementType>)>> =
    LazyLock::new(|| KNOWN.iter().map(|(number, kind)| (*number, Arc::new(kind.clone()))).collect());

/// Whether elements of this descriptor have a line about sections and orientation.
pub(super) fn is_beam(descriptor: u64) -> bool {
    matches!(descriptor, 11 | 21 | 22 | 23 | 24 | 31 | 32)
}

/// The types of one piece.
#[derive(Default)]
pub(super) struct Types {
    /// Those that are not known, by descriptor and number of nodes.
    odd: Vec<(u64, usize, Arc<ElementType>)>,
    last: Option<(u64, usize)>,
}

impl Types {
    /// The type of an element. One with another number of nodes than its descriptor has (Gmsh writes bricks of 27 nodes
    /// as linear ones) is counted by its name and never guessed at.
    #[inline]
    pub(super) fn find(&mut self, head: &Head) -> Result<&Arc<ElementType>> {
        let row = match self.last {
            Some((descriptor, row)) if descriptor == head.descriptor => Some(row),
            _ => SHARED.iter().position(|(number, _)| *number == head.descriptor),
        };
        if let Some(row) = row {
            let kind = &SHARED[row].1;
            if kind.nodes == head.nodes || matches!(kind.class, Class::Counted(_)) {
                self.last = Some((head.descriptor, row));
                return Ok(kind);
            }
            if head.nodes > MOST_ODD {
                let expected = format!("{} nodes of a {}", kind.nodes, kind.name);
                return Err(Error::malformed(expected, head.nodes.to_string()));
            }
        }
        if head.descriptor > LARGEST {
            let expected = format!("an element descriptor up to {LARGEST}");
            return Err(Error::malformed(expected, head.descriptor.to_string()));
        }
        let known =
            |(d, n, _): &(u64, usize, _)| *d == head.descriptor && (*n == head.nodes || row.is_none());
        let place = self.odd.iter().position(known).unwrap_or_else(|| {
            let name = match row {
                Some(row) => format!("{} of {} nodes", SHARED[row].1.name, head.nodes),
                None => format!("descriptor {}", head.descriptor),
            };
            let class = Class::Counted(Cow::Owned(name.clone()));
            let kind = Arc::new(ElementType { name: Cow::Owned(name), nodes: head.nodes, class });
            self.odd.push((head.descriptor, head.nodes, kind));
            self.odd.len() - 1
        });
        Ok(&self.odd[place].2)
    }
}
