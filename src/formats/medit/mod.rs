//! MEDIT (GMF): `.mesh`, text, and `.meshb`, binary of either byte order, versions 1 to 4. A file is a list of keywords, most
//! with a table; those of vertices and elements are read, in any order, and all others are passed over.
//!
//! Elements have no numbers: theirs is their position in the file, from 1, over all tables of triangles, quadrilaterals
//! and solids in file order. Edges are counted as lines, polygons and polyhedra as such; they take no part in it.

mod binary;
mod keywords;
#[cfg(test)]
mod tests;
mod text;

use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::{Format, Outline};
use crate::input::{Input, Source, Spot};

/// The format's row in the table of formats.
pub(super) struct Medit;

impl Format for Medit {
    fn name(&self) -> &'static str {
        "medit"
    }

    fn title(&self) -> &'static str {
        "MEDIT (GMF) .mesh, text, and .meshb, binary of either byte order, versions 1-4, up to fourth order"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["mesh", "meshb"]
    }

    fn looks_for(&self) -> &'static str {
        "MeshVersionFormatted, or the number 1, a version and the keyword 3 in binary"
    }

    fn detect(&self, head: &[u8]) -> bool {
        binary::endian(head).is_some() || text::is_text(head)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("references")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        match binary::endian(input.source.peek(0..12)) {
            Some(endian) => binary::outline(input, endian, out),
            None => text::outline(input, out),
        }
    }
}

/// What was found of a mesh so far.
#[derive(Debug)]
struct Found {
    dimension: Option<usize>,
    /// Number of vertices, once there is a table of them.
    vertices: Option<u64>,
    /// Number of the next element.
    label: u64,
    /// Tables of elements that some keyword gives an order of its own to.
    tables: Vec<&'static str>,
    ordered: Vec<String>,
}

impl Found {
    fn new() -> Self {
        Self { dimension: None, vertices: None, label: 1, tables: Vec::new(), ordered: Vec::new() }
    }

    fn set_dimension(&mut self, dimension: u64) -> Result<()> {
        match dimension {
            2 | 3 => self.dimension = Some(dimension as usize),
            other => return Err(Error::malformed("a dimension, 2 or 3", other.to_string())),
        }
        Ok(())
    }

    fn dimension(&self) -> Result<usize> {
        self.dimension.ok_or_else(|| Error::malformed("Dimension before Vertices", "none"))
    }

    /// Numbers of the nodes of `count` more vertices; gives the first.
    fn add_vertices(&mut self, count: u64) -> u64 {
        let before = self.vertices.unwrap_or(0);
        self.vertices = Some(before.saturating_add(count));
        before + 1
    }

    /// Numbers `count` more elements; gives the first.
    fn add_elements(&mut self, keyword: &keywords::Keyword, count: u64) -> u64 {
        self.tables.push(keyword.name);
        let first = self.label;
        if keyword.is_measured() {
            self.label = first.saturating_add(count);
        }
        first
    }

    /// What must hold at the end.
    fn check(&self, source: &Source, end: Spot) -> Result<()> {
        if self.vertices.is_none() {
            return Err(source.place(Error::malformed("Vertices", "none in the file"), end));
        }
        match self.ordered.iter().find(|name| self.tables.contains(&name.as_str())) {
            Some(name) => {
                let what = format!("{name}Ordering gives the nodes an order of its own, which is not read");
                Err(source.place(Error::unsupported(what), end))
            }
            None => Ok(()),
        }
    }
}

/// Byte orders, told by the number 1 with which a binary file begins.
const COOKIES: [(Endian, [u8; 4]); 2] = [(Endian::Little, [1, 0, 0, 0]), (Endian::Big, [0, 0, 0, 1])];
