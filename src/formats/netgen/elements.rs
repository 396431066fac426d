//! Rows of elements: some properties, the number of points, the points, and for surfaces perhaps their parameters.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use super::COMMENT;
use crate::error::{Error, Result};
use crate::formats::rows::Numbers;
use crate::formats::{ElementLayout, ElementSink, text};
use crate::input::Source;
use crate::mesh::ElementType;
use crate::mesh::Shape::{self, Hexahedron, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// A section of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    /// Surface number, boundary condition, domains on either side.
    Surface,
    /// Material.
    Volume,
}

/// Rows of elements; a span is a range of bytes.
#[derive(Debug)]
pub(super) struct ElementLines {
    pub(super) source: Arc<Source>,
    pub(super) section: Section,
    /// Number of the first element.
    pub(super) first: u64,
}

impl ElementLayout for ElementLines {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let (properties, types) = match self.section {
            Section::Surface => (4, &*SURFACE),
            Section::Volume => (1, &*VOLUME),
        };
        let mut label = self.first;
        let mut ids = Vec::new();
        let mut last: Option<&'static Arc<ElementType>> = None;
        for line in text::lines(span.start, &window) {
            let mut numbers = Numbers::new(line.at, line.bytes, COMMENT);
            if !numbers.more() {
                continue;
            }
            out.at = numbers.spot();
            let mut region = 0;
            for k in 0..properties {
                let property = numbers.reference("a property of an element")?;
                // Of a volume the material; of a surface the boundary condition, which comes second.
                region = if k < 2 { property } else { region };
            }
            out.region(region as u64, || region.to_string())?;
            let nodes = numbers.integer("the number of an element's points")?;
            let kind = match last {
                Some(kind) if kind.nodes as u64 == nodes => kind,
                _ => find(types, nodes)?,
            };
            last = Some(kind);
            ids.resize(kind.nodes, 0);
            for id in &mut ids {
                *id = numbers.integer("the number of a point")?;
            }
            if self.section == Section::Volume && numbers.more() {
                return Err(numbers.unlike_here("the end of the row"));
            }
            out.element(label, kind, &ids)?;
            label += 1;
        }
        Ok(())
    }
}

#[cold]
fn unknown(types: &[Arc<ElementType>], nodes: u64) -> Error {
    let known: Vec<_> = types.iter().map(|kind| kind.nodes.to_string()).collect();
    Error::malformed(format!("the number of an element's points ({})", known.join(", ")), nodes.to_string())
}

fn find(types: &'static [Arc<ElementType>], nodes: u64) -> Result<&'static Arc<ElementType>> {
    types.iter().find(|kind| kind.nodes as u64 == nodes).ok_or_else(|| unknown(types, nodes))
}

type Row = (&'static str, usize, u8, Shape);

/// Netgen names types by the number of their points. Corners stand first.
static SURFACE: LazyLock<Vec<Arc<ElementType>>> = LazyLock::new(|| {
    types(&[
        ("TRIG", 3, 1, Triangle),
        ("QUAD", 4, 1, Quadrilateral),
        ("TRIG6", 6, 2, Triangle),
        ("QUAD8", 8, 2, Quadrilateral),
    ])
});

static VOLUME: LazyLock<Vec<Arc<ElementType>>> = LazyLock::new(|| {
    types(&[
        ("TET", 4, 1, Tetrahedron),
        ("PYRAMID", 5, 1, Pyramid),
        ("PRISM", 6, 1, Wedge),
        ("HEX", 8, 1, Hexahedron),
        ("TET10", 10, 2, Tetrahedron),
        ("PRISM12", 12, 2, Wedge),
        ("PYRAMID13", 13, 2, Pyramid),
        ("PRISM15", 15, 2, Wedge),
        ("HEX20", 20, 2, Hexahedron),
    ])
});

fn types(rows: &[Row]) -> Vec<Arc<ElementType>> {
    let kind =
        |&(name, nodes, order, shape): &Row| Arc::new(ElementType::measured(name, shape, order, nodes));
    rows.iter().map(kind).collect()
}
