//! VTK's XML files: unstructured grids, polygonal data, structured, rectilinear and uniform grids; and files that name
//! others as their pieces or blocks, which are then one mesh.
//!
//! The tags say where the arrays stand ([`document`]): as text or base64 between tags, or behind `AppendedData`, where the
//! file stops being XML and offsets rule ([`data_array`]). A file may have several pieces; the numbers of points start anew
//! in each. Cells that are marked as another piece's, or as hidden, are left out.

mod attributes;
mod data_array;
mod document;
mod piece;
mod section;

use std::path::Path;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::array::Unpacked;
use crate::formats::array::regions::InRegions;
use crate::formats::{Format, Outline};
use crate::input::{Input, Sibling, Siblings, Spot};
use crate::mesh::Shape;

use document::{Document, Reference};
use piece::First;

/// VTK's XML files.
#[derive(Debug)]
pub struct Vtu;

/// Deepest nesting of files that name others.
const DEEPEST: usize = 4;

impl Format for Vtu {
    fn name(&self) -> &'static str {
        "vtu"
    }

    fn title(&self) -> &'static str {
        "VTK XML: unstructured, polygonal, structured, rectilinear and image data, in one file or in pieces and blocks; ascii, binary and appended, plain or compressed by zlib, LZ4 or LZMA"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &[
            "vtu", "vtp", "vts", "vtr", "vti", "pvtu", "pvtp", "pvts", "pvtr", "pvti", "vtm", "vtpc", "vtpd",
            "pvd",
        ]
    }

    fn looks_for(&self) -> &'static str {
        "the XML element <VTKFile"
    }

    fn own_orientation(&self) -> &'static [Shape] {
        super::cells::OWN_ORIENTATION
    }

    fn regions(&self) -> Option<&'static str> {
        Some("blocks, or cell data of a material, region, block or part")
    }

    fn detect(&self, head: &[u8]) -> bool {
        let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        head.trim_ascii_start().starts_with(b"<") && memchr::memmem::find(head, b"<VTKFile").is_some()
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let siblings = Siblings::new(input);
        let main = siblings.main();
        let mut walk = Walk { input, siblings, first: First::default(), out };
        walk.file(&main, None, 0)
    }
}

/// Goes through the files of a mesh.
struct Walk<'i, 'o> {
    input: &'i Input,
    siblings: Siblings<'i>,
    /// Numbers that go on from piece to piece.
    first: First,
    out: &'o mut dyn Outline,
}

impl Walk<'_, '_> {
    /// A file, which may be the block `block` of another one; `depth` files lead to it.
    fn file(&mut self, file: &Sibling, block: Option<&str>, depth: usize) -> Result<()> {
        let mut input = self.input.clone();
        input.source = Arc::clone(&file.source);
        let document = Document::read(&input)?;
        for reference in &document.references {
            let place = |error: Error| input.source.place(error, Spot::Text(reference.at));
            if depth == DEEPEST {
                return Err(place(Error::limit("nesting of files that name others", DEEPEST)));
            }
            let Reference { name, block: inner, .. } = reference;
            let named = self.siblings.open(file, Path::new(name)).map_err(place)?;
            self.file(&named, inner.as_deref().or(block), depth + 1)?;
        }
        let mut unpacked = Unpacked::new(&input);
        let pieces = document.pieces.iter().map(|piece| piece.unpack(&input, &document, &mut unpacked));
        let pieces = pieces.collect::<Result<Vec<_>>>()?;
        let stores = unpacked.finish()?;
        self.first.several |= depth > 0 || pieces.len() > 1;
        let block = block.map_or(InRegions::Unknown, InRegions::named);
        pieces
            .into_iter()
            .try_for_each(|piece| piece.outline(&input, &stores, &block, &mut self.first, self.out))
    }
}
