//! What type numbers stand for: `ET` binds them to elements of ANSYS's library, known by number. Bricks and
//! quadrilaterals may be degenerate: their nodes tell.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::commands::Command;
use crate::error::{Error, Result};
use crate::formats::degenerate::Variants;
use crate::formats::{ElementSink, text};
use crate::mesh::{Class, ElementType, IN_ORDER, Shape};

/// Most nodes of an element.
pub(super) const MOST_NODES: usize = 64;
/// Most types.
const MOST_TYPES: usize = 4096;
/// Largest number of a type, and of an element of the library.
const LARGEST: u64 = 99_999;

/// What an element of the library is, and how many nodes it has if its records are whole.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// With 8 nodes, or 20.
    Brick(usize),
    /// With 4 nodes, or 10.
    Tetrahedron(usize),
    /// With 4 nodes, or 8; with 3, or 6.
    Surface(usize),
    Counted(&'static str),
}

use Form::{Brick, Counted, Surface, Tetrahedron};

/// Elements of the library by name.
static LIBRARY: &[(&str, Form, &[u64])] = &[
    ("SOLID", Brick(8), &[5, 45, 46, 62, 64, 65, 69, 70, 73, 96, 97, 164, 185, 278]),
    ("SOLID", Brick(20), &[90, 95, 117, 122, 147, 186, 191, 226, 231, 236, 239, 279]),
    ("SOLSH", Brick(8), &[190]),
    ("CPT", Brick(8), &[215]),
    ("CPT", Brick(20), &[216]),
    ("FLUID", Brick(8), &[30, 80, 142]),
    ("FLUID", Brick(20), &[220]),
    ("SOLID", Tetrahedron(10), &[87, 92, 98, 123, 127, 148, 168, 187, 227, 232, 237, 240]),
    ("SOLID", Tetrahedron(4), &[285]),
    ("CPT", Tetrahedron(10), &[217]),
    ("FLUID", Tetrahedron(10), &[221]),
    ("SHELL", Surface(4), &[28, 41, 43, 57, 63, 131, 143, 157, 163, 181]),
    ("SHELL", Surface(8), &[91, 93, 99, 132, 150, 281]),
    ("PLANE", Surface(4), &[13, 25, 42, 55, 67, 75, 162, 182, 222]),
    ("PLANE", Surface(6), &[2, 35, 146]),
    ("PLANE", Surface(8), &[53, 77, 78, 82, 83, 121, 145, 183, 223, 230, 233, 238]),
    ("CPT", Surface(4), &[212]),
    ("CPT", Surface(8), &[213]),
    ("FLUID", Surface(4), &[29, 79, 81, 141]),
    ("LINK", Counted("line"), &[1, 8, 10, 11, 31, 32, 33, 34, 68, 160, 167, 180]),
    ("BEAM", Counted("line"), &[3, 4, 23, 24, 44, 54, 161, 188, 189]),
    ("PIPE", Counted("line"), &[16, 17, 18, 20, 59, 60, 288, 289]),
    ("ELBOW", Counted("line"), &[290]),
    ("SHELL", Counted("line"), &[51, 61, 208, 209]),
    ("FLUID", Counted("line"), &[38, 116, 138]),
    ("MASS", Counted("mass"), &[21, 71, 166]),
    ("COMBIN", Counted("spring"), &[7, 14, 37, 39, 40, 165, 214, 250]),
    ("CONTAC", Counted("contact"), &[12, 52]),
    ("TARGE", Counted("contact"), &[169, 170]),
    ("CONTA", Counted("contact"), &[171, 172, 173, 174, 175, 176, 177, 178]),
    ("PRETS", Counted("pretension"), &[179]),
    ("MPC", Counted("constraint"), &[184]),
    ("SURF", Counted("surface effect"), &[151, 152, 153, 154, 155, 156, 159, 251, 252]),
    ("INTER", Counted("cohesive"), &[192, 193, 194, 195, 202, 203, 204, 205]),
    ("FOLLW", Counted("point"), &[201]),
];

/// The facets of MESH200 by its first key option.
static MESH200: [Form; 12] = [
    Counted("line"),
    Counted("line"),
    Counted("line"),
    Counted("line"),
    Surface(3),
    Surface(6),
    Surface(4),
    Surface(8),
    Tetrahedron(4),
    Tetrahedron(10),
    Brick(8),
    Brick(20),
];

/// How the elements of a type are handed on.
#[derive(Debug)]
struct Kind {
    /// Those that may be degenerate, by number of nodes.
    variants: Vec<(usize, Variants)>,
    plain: Vec<Arc<ElementType>>,
    /// Those with any other number of nodes.
    other: Arc<ElementType>,
}

/// Types by number, as far as they are defined.
#[derive(Debug, Default, Clone)]
pub(super) struct Table {
    /// The element of the library that each stands for, and how its elements are handed on.
    kinds: BTreeMap<u64, (u64, Arc<Kind>)>,
}

impl Table {
    /// `ET`, type number, element. Parameters in the place of numbers stand for nothing that is known.
    pub(super) fn define(&mut self, command: &Command<'_>) -> Result<()> {
        self.set(command.argument(0), command.argument(1))?;
        self.set_option(command.argument(0), b"1", command.argument(2));
        Ok(())
    }

    /// `KEYOP`, type number, option, value.
    pub(super) fn option(&mut self, command: &Command<'_>) {
        self.set_option(command.argument(0), command.argument(1), command.argument(2));
    }

    /// Binds a type to an element: `185`, or `SOLID185`.
    pub(super) fn set(&mut self, number: &[u8], element: &[u8]) -> Result<()> {
        let letters = element.iter().take_while(|b| b.is_ascii_alphabetic()).count();
        if let (Some(number), Some(element)) = (text::integer(number), text::integer(&element[letters..])) {
            if number > LARGEST || element > LARGEST {
                return Err(Error::limit("number of an element type", LARGEST));
            }
            if self.kinds.len() == MOST_TYPES {
                return Err(Error::limit("number of element types", MOST_TYPES));
            }
            self.kinds.insert(number, (element, Arc::new(Kind::new(element, 0))));
        }
        Ok(())
    }

    /// Sets a key option; only the first matters, and only to MESH200.
    pub(super) fn set_option(&mut self, number: &[u8], option: &[u8], value: &[u8]) {
        let known = text::integer(number).and_then(|number| self.kinds.get_mut(&number));
        if let (Some((200, kind)), b"1", Some(value)) = (known, option, text::integer(value)) {
            *kind = Arc::new(Kind::new(200, value));
        }
    }

    /// Hands on an element. `undefined` keeps the types of a piece that no `ET` defines.
    #[inline]
    pub(super) fn put(
        &self,
        number: u64,
        label: u64,
        ids: &[u64],
        undefined: &mut Vec<(u64, Arc<ElementType>)>,
        out: &mut ElementSink<'_>,
    ) -> Result<()> {
        if let Some((_, kind)) = self.kinds.get(&number) {
            return kind.put(label, ids, out);
        }
        if number > LARGEST {
            return Err(Error::limit("number of an element type", LARGEST));
        }
        let place = undefined.iter().position(|(known, _)| *known == number).unwrap_or_else(|| {
            undefined.push((number, counted(format!("type {number} without ET"), None)));
            undefined.len() - 1
        });
        out.element(label, &undefined[place].1, ids)
    }
}

impl Kind {
    fn new(element: u64, option: u64) -> Self {
        let row = LIBRARY.iter().find(|(_, _, numbers)| numbers.contains(&element));
        let (family, form) = match (row, element) {
            (_, 200) => ("MESH", MESH200.get(option as usize).copied()),
            (Some((family, form, _)), _) => (*family, Some(*form)),
            (None, _) => ("ELEMENT", None),
        };
        let own = format!("{family}{element}");
        let name = |whole: usize, nodes: usize| match nodes == whole {
            true => own.clone(),
            false => format!("{own} of {nodes} nodes"),
        };
        let measured = |whole, shape: Shape, order, nodes| {
            let class = Class::Measured { shape, order, corners: &IN_ORDER[..shape.corners()] };
            Arc::new(ElementType { name: Cow::Owned(name(whole, nodes)), nodes, class })
        };
        let (mut variants, mut plain) = (Vec::new(), Vec::new());
        let mut other = counted(format!("{own} of another number of nodes"), None);
        match form {
            Some(Brick(whole)) => variants.extend(
                [(8, 1), (20, 2)].map(|(nodes, o)| (nodes, Variants::brick(&name(whole, nodes), o, nodes))),
            ),
            Some(Surface(whole)) => {
                variants.extend([(4, 1), (8, 2)].map(|(nodes, order)| {
                    (nodes, Variants::quadrilateral(&name(whole, nodes), order, nodes))
                }));
                plain.extend([(3, 1), (6, 2)].map(|(n, order)| measured(whole, Shape::Triangle, order, n)));
            }
            Some(Tetrahedron(whole)) => {
                plain.extend([(4, 1), (10, 2)].map(|(n, o)| measured(whole, Shape::Tetrahedron, o, n)));
            }
            Some(Counted(what)) => other = counted(own.clone(), Some(what)),
            None => other = counted(own.clone(), None),
        }
        Self { variants, plain, other }
    }

    #[inline]
    fn put(&self, label: u64, ids: &[u64], out: &mut ElementSink<'_>) -> Result<()> {
        if let Some((_, variants)) = self.variants.iter().find(|(nodes, _)| *nodes == ids.len()) {
            return variants.put(label, ids, out);
        }
        match self.plain.iter().find(|kind| kind.nodes == ids.len()) {
            // Middle nodes may be left out: 0 stands in their places.
            Some(kind) if ids.contains(&0) => {
                let given: Vec<u64> = ids.iter().copied().filter(|id| *id != 0).collect();
                out.element(label, kind, &given)
            }
            Some(kind) => out.element(label, kind, ids),
            None => out.element(label, &self.other, ids),
        }
    }
}

fn counted(name: String, what: Option<&'static str>) -> Arc<ElementType> {
    let class = Class::Counted(what.map_or_else(|| Cow::Owned(name.clone()), Cow::Borrowed));
    Arc::new(ElementType { name: Cow::Owned(name), nodes: 0, class })
}
