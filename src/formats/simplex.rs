//! Triangle's and TetGen's meshes: elements in an `.ele` file, nodes in the `.node` file beside it. Both are rows of text
//! after a row of counts; `#` starts a comment. The first number of each row is the record's own; the files of one mesh
//! agree whether numbers begin with 0 or 1. Corners stand first in second-order elements, too.

use std::ffi::OsString;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use crate::error::{Error, Result};
use crate::formats::text::{self, LineReader};
use crate::formats::words::Words;
use crate::formats::{
    ElementLayout, ElementSink, Format, NodeBatch, NodeLayout, Outline, PIECE_BYTES, Piece,
};
use crate::input::{Input, Limits, Siblings, Source, Spot, mesh_name};
use crate::mesh::{ElementType, Shape};

/// One of the two generators.
pub(super) struct Simplex {
    name: &'static str,
    title: &'static str,
    looks_for: &'static str,
    /// First and second order.
    types: LazyLock<[Arc<ElementType>; 2]>,
}

/// J. R. Shewchuk's Triangle.
pub(super) static TRIANGLE: Simplex = Simplex {
    name: "triangle",
    title: "Triangle .ele with its .node beside it: triangles of first and second order",
    looks_for: "Triangle's number of triangles, 3 or 6, number of attributes, and rows that fit",
    types: LazyLock::new(|| {
        [("triangle", 1, 3), ("triangle 6", 2, 6)]
            .map(|(name, order, nodes)| ElementType::measured(name, Shape::Triangle, order, nodes).into())
    }),
};

/// H. Si's TetGen.
pub(super) static TETGEN: Simplex = Simplex {
    name: "tetgen",
    title: "TetGen .ele with its .node beside it: tetrahedra of first and second order",
    looks_for: "TetGen's number of tetrahedra, 4 or 10, number of attributes, and rows that fit",
    types: LazyLock::new(|| {
        [("tetrahedron", 1, 4), ("tetrahedron 10", 2, 10)]
            .map(|(name, order, nodes)| ElementType::measured(name, Shape::Tetrahedron, order, nodes).into())
    }),
};

impl Format for Simplex {
    fn name(&self) -> &'static str {
        self.name
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["ele"]
    }

    fn looks_for(&self) -> &'static str {
        self.looks_for
    }

    /// The counts, and the first two rows, which are numbered in turn from 0 or 1.
    fn detect(&self, head: &[u8]) -> bool {
        let mut rows = text::lines(0, head).filter_map(|line| {
            let mut words = Words::new(0, line.bytes);
            let row: Vec<_> =
                std::iter::from_fn(|| Some(words.word()).filter(|w| !w.is_empty())).take(64).collect();
            (!row.is_empty()).then_some(row)
        });
        let numbers = |row: &[&[u8]]| row.iter().map(|w| text::integer(w)).collect::<Option<Vec<_>>>();
        let header = rows.next().and_then(|row| numbers(&row));
        let Some(&[count, nodes, attributes]) = header.as_deref() else { return false };
        let known = self.types.iter().any(|kind| kind.nodes as u64 == nodes);
        if !known || count == 0 || attributes > 32 {
            return false;
        }
        let (nodes, columns) = (nodes as usize, (1 + nodes + attributes) as usize);
        let mut row = || rows.next().filter(|r| r.len() == columns).and_then(|r| numbers(&r[..=nodes]));
        match (row(), count) {
            (Some(first), 1) => first[0] <= 1,
            (Some(first), _) => first[0] <= 1 && row().is_some_and(|second| second[0] == first[0] + 1),
            (None, _) => false,
        }
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        // A file that is no .ele file is told so, and not that it lacks a .node file.
        let (kind, elements) = self.elements_table(input)?;
        let nodes = open_nodes(input)?;
        let (dimension, table) = nodes_table(&nodes, &input.limits)?;
        let layout: Arc<dyn NodeLayout> = Arc::new(NodeRows { source: Arc::clone(&nodes), dimension });
        table.cut("nodes", |span| out.nodes(Piece { layout: Arc::clone(&layout), span }))?;

        if kind.shape() == Some(Shape::Tetrahedron) && dimension < 3 {
            let error = Error::malformed("nodes with 3 coordinates for tetrahedra", format!("{dimension}"));
            return Err(nodes.place(error, Spot::Text(0)));
        }
        let source = Arc::clone(&input.source);
        let layout: Arc<dyn ElementLayout> = Arc::new(ElementRows { source, kind });
        elements.cut("elements", |span| out.elements(Piece { layout: Arc::clone(&layout), span }))
    }
}

impl Simplex {
    fn elements_table<'i>(&self, input: &'i Input) -> Result<(Arc<ElementType>, Table<'i>)> {
        let (at, [count, nodes], table) =
            Table::open(&input.source, &input.limits, "elements, nodes of each")?;
        let Some(kind) = self.types.iter().find(|kind| kind.nodes as u64 == nodes) else {
            let [first, second] = [0, 1].map(|k| self.types[k].nodes);
            let error =
                Error::malformed(format!("{first} or {second} nodes of each element"), format!("{nodes}"));
            return Err(input.source.place(error, Spot::Text(at)));
        };
        Ok((Arc::clone(kind), Table { count, ..table }))
    }
}

fn nodes_table<'s>(source: &'s Source, limits: &Limits) -> Result<(usize, Table<'s>)> {
    let (at, [count, dimension], table) = Table::open(source, limits, "nodes, dimensions")?;
    if !(2..=3).contains(&dimension) {
        let error = Error::malformed("2 or 3 dimensions", format!("{dimension}"));
        return Err(source.place(error, Spot::Text(at)));
    }
    Ok((dimension as usize, Table { count, ..table }))
}

/// Opens the `.node` file of the mesh: packed as the `.ele` file is, or not at all.
fn open_nodes(input: &Input) -> Result<Arc<Source>> {
    let path = input.source.path();
    let mut siblings = Siblings::new(input);
    let main = siblings.main();
    let mut name: OsString = mesh_name(path, &["ele"]);
    name.push(".node");
    let mut packed = name.clone();
    packed.push(".");
    packed.push(path.extension().unwrap_or_default());
    let plain = siblings.open(&main, Path::new(&name));
    let opened = match plain {
        Err(error) if input.compression.is_some() => {
            siblings.open(&main, &PathBuf::from(packed)).map_err(|_| error)
        }
        other => other,
    };
    match opened {
        Ok(sibling) => Ok(sibling.source),
        Err(error) => Err(input.source.place(error, Spot::Text(0))),
    }
}

/// Rows that are counted by the first of them.
struct Table<'s> {
    source: &'s Source,
    lines: LineReader<'s>,
    count: u64,
}

impl<'s> Table<'s> {
    /// Reads the row of counts: where it stands, the first two, and what follows.
    fn open(source: &'s Source, limits: &Limits, what: &str) -> Result<(u64, [u64; 2], Self)> {
        let mut lines = LineReader::new(source, limits, 0);
        let expected = format!("numbers of {what}");
        while let Some(line) = lines.next_line()? {
            let mut words = Words::new(line.at, line.bytes);
            if !words.more() {
                continue;
            }
            let mut number = || words.integer(&expected);
            let counts = number().and_then(|first| Ok([first, number()?]));
            let counts = counts.map_err(|e| source.place(e, Spot::Text(line.at)))?;
            return Ok((line.at, counts, Self { source, lines, count: 0 }));
        }
        Err(source.malformed_text(source.len(), expected))
    }

    /// Cuts the rows into pieces. There are as many as the count says, and no more.
    fn cut(mut self, what: &str, mut piece: impl FnMut(Range<u64>) -> Result<()>) -> Result<()> {
        let (mut found, mut from) = (0, self.lines.position());
        while let Some(line) = self.lines.next_line()? {
            let blank = line.bytes.iter().find(|b| !b.is_ascii_whitespace()).is_none_or(|&b| b == b'#');
            if blank {
                continue;
            }
            if found == self.count {
                let expected = format!("the end of the file after {found} {what}");
                return Err(self.source.malformed_text(line.at, expected));
            }
            found += 1;
            let at = self.lines.position();
            // A number that is cut short is still a number.
            if at > self.source.len() {
                let expected = format!("the end of the line of one of the {} {what}", self.count);
                return Err(self.source.malformed_text(self.source.len(), expected));
            }
            if found == self.count || at - from >= PIECE_BYTES {
                piece(from..at)?;
                from = at;
            }
        }
        if found < self.count {
            let expected = format!("{} {what}, and not only {found}", self.count);
            return Err(self.source.malformed_text(self.source.len(), expected));
        }
        Ok(())
    }
}

/// Rows `number x y [z] attributes ...`; a span is a range of bytes.
#[derive(Debug)]
struct NodeRows {
    source: Arc<Source>,
    dimension: usize,
}

impl NodeLayout for NodeRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        for line in text::lines(span.start, &window) {
            let mut words = Words::new(line.at, line.bytes);
            if !words.more() {
                continue;
            }
            out.at = words.spot();
            let id = words.integer("a node's number")?;
            let mut point = [0.0; 3];
            for x in &mut point[..self.dimension] {
                *x = words.real("a node's coordinate")?;
            }
            out.push(id, point)?;
        }
        Ok(())
    }
}

/// Rows `number nodes ... attributes ...`; a span is a range of bytes.
#[derive(Debug)]
struct ElementRows {
    source: Arc<Source>,
    kind: Arc<ElementType>,
}

impl ElementLayout for ElementRows {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut ids = vec![0; self.kind.nodes];
        for line in text::lines(span.start, &window) {
            let mut words = Words::new(line.at, line.bytes);
            if !words.more() {
                continue;
            }
            out.at = words.spot();
            let label = words.integer("an element's number")?;
            for id in &mut ids {
                *id = words.integer("the number of an element's node")?;
            }
            out.element(label, &self.kind, &ids)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
