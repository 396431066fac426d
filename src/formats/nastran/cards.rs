//! The cards that matter, by name: which are nodes, which are elements, and which fields of theirs are nodes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock};

use super::lines::Name;
use crate::mesh::{Class, ElementType, IN_ORDER, Shape};

/// An element card.
#[derive(Debug)]
pub(super) enum Card {
    /// One that is measured.
    Measured(Measured),
    /// One that is counted.
    Counted(Counted),
}

/// Where a measured card has its nodes, and what they make.
#[derive(Debug)]
pub(super) struct Measured {
    /// The field of the first node.
    pub(super) first: usize,
    /// The most nodes; those that are not corners may be blank.
    pub(super) most: usize,
    /// For each corner, its place among the nodes.
    pub(super) corners: &'static [u8],
    /// What the card is where it names corners alone.
    pub(super) plain: Arc<ElementType>,
    /// What the card is where it names other nodes too.
    pub(super) curved: Arc<ElementType>,
}

/// A card that is counted.
#[derive(Debug)]
pub(super) struct Counted {
    pub(super) kind: Arc<ElementType>,
    /// The fields of its nodes.
    pub(super) nodes: &'static [u8],
    /// Every whole number from this field on is a node too.
    pub(super) rest: Option<usize>,
}

/// Corners of triangles whose nodes alternate round them.
const ALTERNATING: [u8; 3] = [0, 2, 4];

/// Name, shape, most nodes, field of the first node. Nodes beyond the corners make the order 2.
static BY_NODES: &[(&str, Shape, usize, usize)] = &[
    ("CTETRA", Shape::Tetrahedron, 10, 2),
    ("CPYRAM", Shape::Pyramid, 13, 2),
    ("CPYRA", Shape::Pyramid, 13, 2),
    ("CPENTA", Shape::Wedge, 15, 2),
    ("CHEXA", Shape::Hexahedron, 20, 2),
    ("CTRIA3", Shape::Triangle, 3, 2),
    ("CTRIAR", Shape::Triangle, 3, 2),
    ("CTRAX3", Shape::Triangle, 3, 2),
    ("CTRIAX", Shape::Triangle, 6, 2),
    ("CPLSTN3", Shape::Triangle, 3, 2),
    ("CPLSTS3", Shape::Triangle, 3, 2),
    ("PLOTEL3", Shape::Triangle, 3, 1),
    ("CQUAD4", Shape::Quadrilateral, 4, 2),
    ("CQUADR", Shape::Quadrilateral, 4, 2),
    ("CQUADX4", Shape::Quadrilateral, 4, 2),
    ("CQUAD", Shape::Quadrilateral, 9, 2),
    ("CQUADX", Shape::Quadrilateral, 9, 2),
    ("CPLSTN4", Shape::Quadrilateral, 4, 2),
    ("CPLSTS4", Shape::Quadrilateral, 4, 2),
    ("CSHEAR", Shape::Quadrilateral, 4, 2),
    ("PLOTEL4", Shape::Quadrilateral, 4, 1),
];

/// The same of cards that are of order 2 whatever of their nodes is blank.
static SECOND_ORDER: &[(&str, Shape, usize, usize)] = &[
    ("CTRIA6", Shape::Triangle, 6, 2),
    ("CTRAX6", Shape::Triangle, 6, 2),
    ("CTRIAX6", Shape::Triangle, 6, 2),
    ("CPLSTN6", Shape::Triangle, 6, 2),
    ("CPLSTS6", Shape::Triangle, 6, 2),
    ("PLOTEL6", Shape::Triangle, 6, 1),
    ("CQUAD8", Shape::Quadrilateral, 8, 2),
    ("CQUADX8", Shape::Quadrilateral, 8, 2),
    ("CPLSTN8", Shape::Quadrilateral, 8, 2),
    ("CPLSTS8", Shape::Quadrilateral, 8, 2),
    ("PLOTEL8", Shape::Quadrilateral, 8, 1),
];

/// Names, what they are counted as, fields of nodes.
static COUNTED: &[(&str, &str, &[u8])] = &[
    ("CBAR CBEAM CBEND CROD CTUBE", "line", &[2, 3]),
    ("CBEAM3", "line", &[2, 3, 4]),
    ("CONROD PLOTEL", "line", &[1, 2]),
    ("CCONEAX", "line", &[]),
    ("CELAS1 CELAS2", "spring", &[2, 4]),
    ("CELAS3 CELAS4", "spring", &[2, 3]),
    ("CDAMP1 CDAMP2", "damper", &[2, 4]),
    ("CDAMP3 CDAMP4 CDAMP5 CVISC", "damper", &[2, 3]),
    ("CMASS1 CMASS2", "mass", &[2, 4]),
    ("CMASS3 CMASS4", "mass", &[2, 3]),
    ("CONM1 CONM2", "mass", &[1]),
    ("CGAP", "gap", &[2, 3]),
    ("CBUSH CBUSH1D CBUSH2D", "bushing", &[2, 3]),
    ("CWELD CFAST CSEAM", "connector", &[]),
    ("RBAR RBAR1 RROD RJOINT", "rigid", &[1, 2]),
    ("RTRPLT RTRPLT1", "rigid", &[1, 2, 3]),
    ("RBE1", "rigid", &[1, 3, 5]),
    ("RBE2", "rigid", &[1]),
    ("RBE2GS RSPLINE RSSCON", "rigid", &[]),
    ("RBE3", "rigid", &[2]),
    ("GENEL", "general", &[]),
    ("CHBDYE CHBDYG CHBDYP", "boundary", &[]),
    ("CHACAB CHACBR CAABSF", "absorber", &[]),
    ("CIFQUAD CIFHEX CIFPENT CIFQDX", "cohesive", &[]),
    ("CAERO1 CAERO2 CAERO3 CAERO4 CAERO5 CAERO7", "aerodynamic", &[]),
    ("PLOTTET PLOTPYR PLOTPEN PLOTHEX", "plot", &[]),
];

/// Cards whose names begin as those of elements do.
const NO_ELEMENTS: &str = "CEND CAMPBLL CBARAO CLOAD CMETHOD CMSMETH CNGRNT CONCTL CONTACT CONTRLT CONV CONV3 CONVM \
    CCRSFIL COUPMAS COUPGEN CREEP CSCALE CSET CSET1 CSSCHD CSUPER CSUPEXT CYAX CYJOIN CYSUP CYSYM CTLSET CONTPRM CNTPRM";

static CARDS: LazyLock<HashMap<Name, Card>> = LazyLock::new(|| {
    let by_nodes = BY_NODES.iter().map(|row| (row, 1));
    let second_order = SECOND_ORDER.iter().map(|row| (row, 2));
    let measured = by_nodes.chain(second_order).map(|(row, order)| (key(row.0), measured(row, order)));
    let counted = COUNTED.iter().flat_map(|(names, what, nodes)| {
        names.split(' ').map(|name| {
            let rest = (name == "RBE2").then_some(3);
            let kind = Arc::new(ElementType::counted(name, what, nodes.len()));
            (key(name), Card::Counted(Counted { kind, nodes, rest }))
        })
    });
    measured.chain(counted).collect()
});

fn measured(&(name, shape, most, first): &(&'static str, Shape, usize, usize), order: u8) -> Card {
    let corners = if name == "CTRIAX6" { &ALTERNATING } else { IN_ORDER.split_at(shape.corners()).0 };
    let of_order = |order| Arc::new(ElementType::permuted(name, shape, order, most, corners));
    Card::Measured(Measured { first, most, corners, plain: of_order(order), curved: of_order(2) })
}

fn key(name: &str) -> Name {
    let mut key = [b' '; 8];
    key[..name.len()].copy_from_slice(name.as_bytes());
    key
}

/// The element card of that name, where it is known.
pub(super) fn element(name: &Name) -> Option<&'static Card> {
    CARDS.get(name)
}

/// Whether a card that is not known may be an element: then its fields must tell.
pub(super) fn may_be_element(name: &Name) -> bool {
    let text = name.escape_ascii().to_string();
    name[0] == b'C'
        && !text.starts_with("CORD")
        && !NO_ELEMENTS.split_ascii_whitespace().any(|n| n == text.trim_end())
}

/// The type of an element that is not known: counted under its own name.
pub(super) fn unknown(name: &Name) -> Arc<ElementType> {
    let name: Cow<'static, str> = name.trim_ascii_end().escape_ascii().to_string().into();
    Arc::new(ElementType { name: name.clone(), nodes: 0, class: Class::Counted(name) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cards_by_name() {
        let Some(Card::Measured(brick)) = element(b"CHEXA   ") else { panic!("measured") };
        assert_eq!((brick.first, brick.most, brick.corners.len()), (2, 20, 8));
        let Some(Card::Measured(ring)) = element(b"CTRIAX6 ") else { panic!("measured") };
        assert_eq!((ring.corners, &ring.plain), (&[0u8, 2, 4][..], &ring.curved));
        let Some(Card::Counted(mass)) = element(b"CONM2   ") else { panic!("counted") };
        assert_eq!(mass.kind.class, Class::Counted("mass".into()));
        assert!(element(b"CORD2R  ").is_none() && element(b"GRID    ").is_none());
        for (name, may) in
            [(b"CORD2R  ", false), (b"CREEP   ", false), (b"CSET    ", false), (b"CIHEX1  ", true)]
        {
            assert_eq!(may_be_element(name), may);
        }
        assert_eq!(unknown(b"CIHEX1  ").name, "CIHEX1");
    }
}
