//! Element types by grammar: family, number of nodes, letters.
//!
//! `C3D10MH` is the family `C3D`, 10 nodes, and letters for its formulation. A name that does not fit is counted under
//! itself and never guessed at. Cohesive and gasket elements (`COH`, `GK`) are counted: their thickness may be zero by
//! design, which every measure would call degenerate. `F3D4` is counted too: it is a surface in Abaqus and a
//! tetrahedron in CalculiX.

use std::borrow::Cow;
use std::sync::Arc;

use crate::mesh::{Class, ElementType, IN_ORDER, Shape};

/// How records of one type are read.
#[derive(Debug, Clone)]
pub(super) struct Kind {
    /// The type; its number of nodes is 0 where only the commas tell.
    pub(super) of: Arc<ElementType>,
    /// Fewest nodes of a record: less than the type's where trailing ones may be left out.
    pub(super) least: usize,
}

/// The numbers of nodes that a family comes with.
type Counts = &'static [usize];

const SOLIDS: Counts = &[4, 5, 6, 8, 10, 13, 15, 20, 27];
const SURFACES: Counts = &[3, 4, 6, 8, 9];

/// Families of solids.
static SOLID_FAMILIES: &[(&str, Counts)] = &[
    ("C3D", SOLIDS),
    ("DC3D", SOLIDS),
    ("DCC3D", &[8]),
    ("AC3D", SOLIDS),
    ("Q3D", SOLIDS),
    ("EC3D", &[8]),
    ("EMC3D", SOLIDS),
    ("FC3D", SOLIDS),
    ("F3D", &[6, 8]),
    ("SC", &[6, 8]),
    ("CSS", &[8]),
    ("CIN3D", &[8]),
];

/// Families of plane, axisymmetric, shell, membrane and rigid surface elements.
static SURFACE_FAMILIES: &[(&str, Counts)] = &[
    ("CPS", SURFACES),
    ("CPE", SURFACES),
    ("CPEG", SURFACES),
    ("CAX", SURFACES),
    ("CGAX", SURFACES),
    ("AC2D", SURFACES),
    ("ACAX", &[3, 4, 6, 8]),
    ("DC2D", SURFACES),
    ("DCAX", &[3, 4, 6, 8]),
    ("DCC2D", &[4]),
    ("DCCAX", &[4]),
    ("EMC2D", SURFACES),
    ("WARP2D", &[3, 4]),
    ("CINPE", &[4]),
    ("CINPS", &[4]),
    ("CINAX", &[4]),
    ("S", SURFACES),
    ("STRI", &[3]),
    ("DS", SURFACES),
    ("M3D", SURFACES),
    ("SFM3D", SURFACES),
    ("R3D", &[3, 4]),
];

/// How a counted family tells its number of nodes.
#[derive(Clone, Copy)]
enum Nodes {
    /// It stands in the name: `T3D2`.
    Written,
    /// The order stands in the name: `SAX2` has three nodes.
    Order,
    /// As for beams, where `B33` is cubic with two nodes.
    Beam,
}

/// Families that are counted, and the name they are counted under.
static COUNTED_FAMILIES: &[(&str, &str, Nodes)] = &[
    ("T2D", "line", Nodes::Written),
    ("T3D", "line", Nodes::Written),
    ("B2", "line", Nodes::Beam),
    ("B3", "line", Nodes::Beam),
    ("PIPE2", "line", Nodes::Beam),
    ("PIPE3", "line", Nodes::Beam),
    ("ELBOW3", "line", Nodes::Beam),
    ("SAX", "line", Nodes::Order),
    ("DSAX", "line", Nodes::Order),
    ("MAX", "line", Nodes::Order),
    ("MGAX", "line", Nodes::Order),
    ("SFMAX", "line", Nodes::Order),
    ("SFMGAX", "line", Nodes::Order),
    ("AC1D", "line", Nodes::Written),
    ("DC1D", "line", Nodes::Written),
    ("DCC1D", "line", Nodes::Written),
    ("DCCAX", "line", Nodes::Written),
    ("R2D", "rigid", Nodes::Written),
    ("RAX", "rigid", Nodes::Written),
    ("RB2D", "rigid", Nodes::Written),
    ("RB3D", "rigid", Nodes::Written),
    ("CONN2D", "connector", Nodes::Written),
    ("CONN3D", "connector", Nodes::Written),
];

/// Names without a number of nodes in them.
static COUNTED_NAMES: &[(&str, &str, usize)] = &[
    ("FRAME2D", "line", 2),
    ("FRAME3D", "line", 2),
    ("SPRING1", "spring", 1),
    ("SPRING2", "spring", 2),
    ("SPRINGA", "spring", 2),
    ("DASHPOT1", "dashpot", 1),
    ("DASHPOT2", "dashpot", 2),
    ("DASHPOTA", "dashpot", 2),
    ("GAPUNI", "gap", 2),
    ("GAPUNIT", "gap", 2),
    ("GAPCYL", "gap", 2),
    ("GAPSPHER", "gap", 2),
    ("DGAP", "gap", 2),
    ("JOINTC", "joint", 2),
    ("JOINT2D", "joint", 2),
    ("JOINT3D", "joint", 2),
    ("MASS", "mass", 1),
    ("ROTARYI", "mass", 1),
    ("HEATCAP", "heat capacitance", 1),
    ("DCOUP2D", "coupling", 1),
    ("DCOUP3D", "coupling", 1),
    ("PC3D", "particle", 1),
    ("PD3D", "particle", 1),
    ("D", "fluid network", 3),
];

/// Families of many layouts: what follows the prefix does not matter, commas tell where a record ends.
static COUNTED_PREFIXES: &[(&str, &str)] = &[
    ("COH", "cohesive"),
    ("GK", "gasket"),
    ("CIN", "infinite"),
    ("ACIN", "infinite"),
    ("ASI", "acoustic interface"),
    ("PSI", "pipe-soil"),
    ("ITT", "contact"),
    ("ITS", "contact"),
    ("ISL", "contact"),
    ("IRS", "contact"),
];

/// The type that a deck calls `name`, in capitals.
pub(super) fn resolve(name: &str) -> Kind {
    solid(name)
        .or_else(|| surface(name))
        .or_else(|| counted(name))
        .unwrap_or_else(|| counted_as(name, None, 0))
}

/// A user element with that many nodes a record; 0 where only the commas tell.
pub(super) fn user(name: &str, nodes: usize) -> Kind {
    counted_as(name, None, nodes)
}

fn solid(name: &str) -> Option<Kind> {
    let (nodes, letters) = SOLID_FAMILIES.iter().find_map(|(family, counts)| fits(name, family, counts))?;
    let (shape, order) = match nodes {
        4 => (Shape::Tetrahedron, 1),
        5 => (Shape::Pyramid, 1),
        6 => (Shape::Wedge, 1),
        8 => (Shape::Hexahedron, 1),
        10 => (Shape::Tetrahedron, 2),
        13 => (Shape::Pyramid, 2),
        15 => (Shape::Wedge, 2),
        _ => (Shape::Hexahedron, 2),
    };
    // C3D15V may have up to three nodes on its quadrilateral faces, C3D27 may lack those on its faces.
    Some(match nodes {
        15 if letters.contains('V') => measured(name, shape, order, 18, 15),
        27 => measured(name, shape, order, 27, 21),
        _ => measured(name, shape, order, nodes, nodes),
    })
}

fn surface(name: &str) -> Option<Kind> {
    if name == "STRI65" {
        return Some(measured(name, Shape::Triangle, 2, 6, 6));
    }
    let (nodes, _) = SURFACE_FAMILIES.iter().find_map(|(family, counts)| fits(name, family, counts))?;
    let shape = if matches!(nodes, 3 | 6) { Shape::Triangle } else { Shape::Quadrilateral };
    Some(measured(name, shape, if nodes < 5 { 1 } else { 2 }, nodes, nodes))
}

fn counted(name: &str) -> Option<Kind> {
    if let Some((_, class, nodes)) = COUNTED_NAMES.iter().find(|(known, ..)| *known == name) {
        return Some(counted_as(name, Some(class), *nodes));
    }
    let family = |(family, class, rule): &(&str, &'static str, Nodes)| {
        let (number, letters) = number_and_letters(name, family)?;
        let nodes = match rule {
            Nodes::Written => number,
            Nodes::Order => number + 1,
            Nodes::Beam => 2 + usize::from(number == 2),
        };
        let known = (1..=3).contains(&number) && letters.chars().all(|c| "BCDEHOPRST".contains(c));
        known.then(|| counted_as(name, Some(class), nodes))
    };
    COUNTED_FAMILIES.iter().find_map(family).or_else(|| {
        let row = COUNTED_PREFIXES.iter().find(|(prefix, _)| name.starts_with(prefix) && name != *prefix)?;
        Some(counted_as(name, Some(row.1), 0))
    })
}

/// The number of nodes and the letters of a name that is of the family.
fn fits<'n>(name: &'n str, family: &str, counts: Counts) -> Option<(usize, &'n str)> {
    let (nodes, letters) = number_and_letters(name, family)?;
    (counts.contains(&nodes) && letters.chars().all(|c| "DEHIMPRSTVW5".contains(c)))
        .then_some((nodes, letters))
}

fn number_and_letters<'n>(name: &'n str, family: &str) -> Option<(usize, &'n str)> {
    let rest = name.strip_prefix(family)?;
    let letters = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    Some((rest[..rest.len() - letters.len()].parse().ok()?, letters))
}

fn measured(name: &str, shape: Shape, order: u8, nodes: usize, least: usize) -> Kind {
    let class = Class::Measured { shape, order, corners: &IN_ORDER[..shape.corners()] };
    Kind { of: Arc::new(ElementType { name: Cow::Owned(name.into()), nodes, class }), least }
}

fn counted_as(name: &str, class: Option<&'static str>, nodes: usize) -> Kind {
    let class = Class::Counted(class.map_or_else(|| Cow::Owned(name.into()), Cow::Borrowed));
    Kind { of: Arc::new(ElementType { name: Cow::Owned(name.into()), nodes, class }), least: nodes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_nodes_and_letters() {
        use Shape::{Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};
        let rows: &[(&str, Shape, u8)] = &[
            ("C3D4 C3D4H DC3D4 AC3D4 Q3D4 EMC3D4 FC3D4", Tetrahedron, 1),
            ("C3D10 C3D10M C3D10MHT C3D10HS C3D10I DC3D10E AC3D10 Q3D10M", Tetrahedron, 2),
            ("C3D5 AC3D5", Pyramid, 1),
            ("C3D6 DC3D6 SC6R SC6RT F3D6 C3D6PT", Wedge, 1),
            ("C3D15 C3D15H C3D15V C3D15VH DC3D15", Wedge, 2),
            ("C3D8 C3D8R C3D8I C3D8IH C3D8RPHT DC3D8E DCC3D8D SC8R CSS8 F3D8 EC3D8RT CIN3D8", Hexahedron, 1),
            ("C3D20 C3D20R C3D20RHT C3D20RI C3D27 C3D27RH AC3D20 DC3D20", Hexahedron, 2),
            (
                "CPS3 CPE3T CPEG3 CAX3 CGAX3 AC2D3 DC2D3 DCAX3 S3 S3R S3RS STRI3 M3D3 SFM3D3 R3D3 DS3",
                Triangle,
                1,
            ),
            ("CPS6 CPS6M CPE6MH CAX6 S6 STRI65 M3D6 DS6", Triangle, 2),
            ("CPS4 CPS4R CPE4RP CPEG4I CAX4RT S4 S4R S4R5 S4RSW M3D4R R3D4 DCC2D4D CINPE4", Quadrilateral, 1),
            ("CPS8R CPE8 CPE8RP CAX8 S8 S8R S8R5 S8RT S9R5 M3D9R DCAX8", Quadrilateral, 2),
        ];
        for (names, shape, order) in rows {
            for name in names.split(' ') {
                let of = resolve(name).of;
                let Class::Measured { shape: found, order: at, corners } = &of.class else {
                    panic!("{name} is not measured")
                };
                assert_eq!((found, at, corners.len()), (shape, order, shape.corners()), "{name}");
            }
        }
    }

    #[test]
    fn what_has_no_measure_is_counted_by_plain_names() {
        for (names, class, nodes) in [
            ("T3D2 B31 B31H B31OS B33 PIPE31 SAX1 ELBOW31B FRAME3D DC1D2 MAX1", "line", 2),
            ("T3D3 B32 B32R PIPE32H SAX2 DSAX2", "line", 3),
            ("CONN3D2", "connector", 2),
            ("SPRINGA SPRING2", "spring", 2),
            ("MASS ROTARYI", "mass", 1),
            ("D", "fluid network", 3),
            ("R2D2 RAX2 RB3D2", "rigid", 2),
            ("COH3D8 COH2D4 COHAX4 COH3D6P", "cohesive", 0),
            ("GK3D8 GKPS4 GK3D12M", "gasket", 0),
            ("CIN3D12R CINPE5R ACIN3D4", "infinite", 0),
        ] {
            for name in names.split(' ') {
                let kind = resolve(name);
                assert_eq!(kind.of.class, Class::Counted(class.into()), "{name}");
                assert_eq!((kind.of.nodes, kind.of.name.as_ref()), (nodes, name));
            }
        }
    }

    #[test]
    fn a_name_outside_the_grammar_is_never_guessed() {
        let names = "U1 VU4 Z12 C3D8Z C3D7 C3D C3D8RQ CPS5 S5 MASSIVE F3D4 F3D3 SC4 CAXA41 CCL12 US3 B34 COH 8 C3D999999999999999999999";
        for name in names.split(' ') {
            let kind = resolve(name);
            assert_eq!(kind.of.class, Class::Counted(name.to_owned().into()), "{name}");
            assert_eq!(kind.least, 0);
        }
    }
}
