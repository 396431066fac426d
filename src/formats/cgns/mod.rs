//! CGNS in HDF5 files: bases, zones, sections of elements.
//!
//! A node of the CGNS tree is a group with a label in its attributes; its data stand in a dataset called ` data`, with the
//! dimensions turned round. An unstructured zone has sections of elements; a structured one is a block of vertices that
//! implies its hexahedra or quadrilaterals. Vertices count from 1 in each zone. The older container, ADF, is refused by
//! name.

#[cfg(test)]
mod tests;
mod tree;
mod types;
mod zone;

use crate::error::{Error, Result};
use crate::formats::array::Unpacked;
use crate::formats::hdf5::{self, Hdf5};
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::{Input, Spot};
use tree::children;
use zone::{First, Zone};

/// The group of the version.
const VERSION: &str = "CGNSLibraryVersion";
/// What a file in the older container starts with.
const ADF: &[u8] = b"@(#)ADF Database Version";

/// The format's row in the table of formats.
pub(super) struct Cgns;

impl Format for Cgns {
    fn name(&self) -> &'static str {
        "cgns"
    }

    fn title(&self) -> &'static str {
        "CGNS in HDF5 files: structured and unstructured zones"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["cgns"]
    }

    fn looks_for(&self) -> &'static str {
        "an HDF5 file with the group CGNSLibraryVersion"
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.starts_with(ADF)
            || hdf5::detect(head) && memchr::memmem::find(head, VERSION.as_bytes()).is_some()
    }

    fn knows(&self, input: &Input) -> bool {
        let head = input.source.peek(0..HEAD_BYTES as u64);
        let has_version = |file: Hdf5| Ok(file.root()?.group(VERSION)?.is_some());
        self.detect(head) || hdf5::detect(head) && Hdf5::open(input).and_then(has_version).unwrap_or(false)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("sections, and structured zones")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        if input.source.peek(0..ADF.len() as u64) == ADF {
            let what = "CGNS in the ADF container is not read, only in HDF5: convert it by adf2hdf";
            return Err(input.source.place(Error::unsupported(what), Spot::Binary(0)));
        }
        let file = Hdf5::open(input)?;
        let root = file.root()?;
        let (mut unpacked, mut zones) = (Unpacked::new(input), Vec::new());
        for base in children(&root, "CGNSBase_t")? {
            for zone in children(&base, "Zone_t")? {
                zones.push(Zone::find(input, &zone, &mut unpacked)?);
            }
        }
        if zones.is_empty() {
            return Err(root.malformed("a base with a zone", "none"));
        }
        let stores = unpacked.finish()?;
        let mut first = First { node: 1, several: zones.len() > 1 };
        zones.into_iter().try_for_each(|zone| zone.outline(&stores, &mut first, out))
    }
}
