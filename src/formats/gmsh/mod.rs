//! Gmsh's MSH: versions 1, 2.0 to 2.2, 4.0 and 4.1. A file is a list of sections `$Name ... $EndName`; those of nodes
//! and elements are read, all others are passed over.

mod binary_elements;
mod binary_nodes;
mod groups;
mod rows;
#[cfg(test)]
mod tests;
mod text_elements;
mod text_nodes;
mod types;
mod walk;
mod words;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::binary::Endian;
use crate::formats::{Format, Outline, text};
use crate::input::Input;
use groups::Groups;
use rows::Rows;
use text_nodes::Columns;
use walk::Walk;
use words::Binary;

/// The format's row in the table of formats.
pub(super) struct Gmsh;

impl Format for Gmsh {
    fn name(&self) -> &'static str {
        "gmsh"
    }

    fn title(&self) -> &'static str {
        "Gmsh MSH 1, 2.0-2.2, 4.0 and 4.1, text; 2.0-2.2 and 4.1, binary of either byte order"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["msh"]
    }

    fn looks_for(&self) -> &'static str {
        "$MeshFormat or $NOD"
    }

    fn detect(&self, head: &[u8]) -> bool {
        head.trim_ascii_start().starts_with(b"$")
            && text::lines(0, head)
                .any(|line| matches!(line.bytes.trim_ascii_end(), b"$MeshFormat" | b"$NOD"))
    }

    fn regions(&self) -> Option<&'static str> {
        Some("physical groups")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let mut walk = Walk::new(input);
        let mut header = None;
        let mut groups = Groups::default();
        let (mut nodes, mut elements) = (false, false);
        while let Some(name) = walk.section()? {
            let first = matches!(name.as_str(), "NOD" | "ELM");
            let end = format!("${}{name}", if first { "END" } else { "End" });
            let known = if first { Some(Header::FIRST) } else { header };
            match name.as_str() {
                "MeshFormat" => header = Some(Header::read(&mut walk)?),
                "NOD" | "Nodes" | "ParametricNodes" => {
                    let parametric = name == "ParametricNodes";
                    let columns = if parametric { Columns::Entity } else { Columns::Parameters(0) };
                    outline_nodes(&mut walk, known, columns, out)?;
                    nodes = true;
                }
                "ELM" | "Elements" => {
                    outline_elements(&mut walk, known, std::mem::take(&mut groups), out)?;
                    elements = true;
                }
                "PhysicalNames" => {
                    groups.read_names(&mut walk, &end)?;
                    continue;
                }
                "Entities" | "PartitionedEntities" if header.is_some_and(Header::has_entities) => {
                    let Header { version, binary } = self::known(header, &walk)?;
                    groups.read_entities(&mut walk, (version, binary), name != "Entities", &end)?;
                    continue;
                }
                _ => {
                    walk.skip_to(&end)?;
                    continue;
                }
            }
            walk.end(&end)?;
        }
        match (nodes, elements) {
            (true, true) => Ok(()),
            (false, _) => Err(walk.truncated("a section $Nodes")),
            (true, false) => Err(walk.truncated("a section $Elements")),
        }
    }
}

/// The header, which must stand before nodes and elements.
fn known(header: Option<Header>, walk: &Walk<'_>) -> Result<Header> {
    header.ok_or_else(|| {
        let error = Error::malformed("a section $MeshFormat before nodes and elements", "none");
        walk.place(error, walk.at() - 1)
    })
}

fn outline_nodes(
    walk: &mut Walk<'_>,
    header: Option<Header>,
    columns: Columns,
    out: &mut dyn Outline,
) -> Result<()> {
    let header = known(header, walk)?;
    match (header.version, header.binary) {
        (Version::V1 | Version::V2, None) => text_nodes::outline_rows(walk, columns, out),
        (Version::V40 | Version::V41, None) => text_nodes::outline_blocks(walk, header.version, out),
        (Version::V1 | Version::V2, Some(binary)) => match columns {
            Columns::Parameters(_) => binary_nodes::outline_records(walk, binary, out),
            Columns::Entity => binary_nodes::outline_parametric(walk, binary, out),
        },
        (Version::V40 | Version::V41, Some(binary)) => binary_nodes::outline_blocks(walk, binary, out),
    }
}

fn outline_elements(
    walk: &mut Walk<'_>,
    header: Option<Header>,
    groups: Groups,
    out: &mut dyn Outline,
) -> Result<()> {
    let groups = Arc::new(groups);
    let header = known(header, walk)?;
    match (header.version, header.binary) {
        (Version::V1 | Version::V2, None) => text_elements::outline_rows(walk, header.version, groups, out),
        (Version::V40 | Version::V41, None) => {
            text_elements::outline_blocks(walk, header.version, groups, out)
        }
        (_, Some(binary)) => binary_elements::outline(walk, header.version, binary, groups, out),
    }
}

/// What `$MeshFormat` says.
#[derive(Debug, Clone, Copy)]
struct Header {
    version: Version,
    /// `None` stands for text.
    binary: Option<Binary>,
}

/// The versions of the format, as far as they differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    /// 1: `$NOD` and `$ELM`.
    V1,
    /// 2.0 to 2.2.
    V2,
    /// 4.0: blocks, with a node's tag before its point.
    V40,
    /// 4.1: blocks, with all tags before all points.
    V41,
}

impl Header {
    const FIRST: Header = Header { version: Version::V1, binary: None };

    /// Whether a section `$Entities` says which groups the blocks of elements are in.
    fn has_entities(self) -> bool {
        matches!(self.version, Version::V40 | Version::V41)
    }

    fn read(walk: &mut Walk<'_>) -> Result<Self> {
        let what = "version, file type (0 or 1) and data size";
        let (version, file_type, size) = walk.row(what, |row| {
            Ok((row.real("a version")?, row.integer("a file type")?, row.integer("a data size")?))
        })?;
        let unsupported =
            |what: String, walk: &Walk<'_>| Err(walk.place(Error::unsupported(what), walk.at() - 1));
        let version = match version {
            2.0 | 2.1 | 2.2 => Version::V2,
            4.0 => Version::V40,
            4.1 => Version::V41,
            other => {
                let read = "(1, 2.0 to 2.2, 4.0 and 4.1 are)";
                return unsupported(format!("Gmsh MSH version {other} is not read {read}"), walk);
            }
        };
        let (word, most) = match (file_type, version, size) {
            (0, ..) => return Ok(Self { version, binary: None }),
            (1, Version::V2, 8) => (4, i32::MAX as u64),
            (1, Version::V41, 4) => (4, u64::from(u32::MAX)),
            (1, Version::V41, 8) => (8, i64::MAX as u64),
            (1, Version::V40, _) => return unsupported("binary Gmsh MSH 4.0 is not read".into(), walk),
            (1, ..) => return unsupported(format!("binary Gmsh MSH of data size {size} is not read"), walk),
            (other, ..) => {
                let error = Error::malformed("a file type, 0 for text or 1 for binary", format!("{other}"));
                return Err(walk.place(error, walk.at() - 1));
            }
        };
        walk.binary = true;
        let at = walk.at();
        let one = walk.bytes(4, "the number 1 of four bytes")?;
        let endian = match one {
            [1, 0, 0, 0] => Endian::Little,
            [0, 0, 0, 1] => Endian::Big,
            _ => return Err(walk.malformed(at, "the number 1 of four bytes")),
        };
        Ok(Self { version, binary: Some(Binary { endian, word, most }) })
    }
}

fn no_dimension(found: i64) -> Error {
    Error::malformed("the dimension of an entity, 0 to 3", format!("{found}"))
}

impl Version {
    /// The first line of a section of MSH 4: numbers of blocks and of records, and from 4.1 on the smallest and largest
    /// tag, which Gmsh itself does not rely on.
    fn block_counts(self, row: &mut Rows<'_>) -> Result<(u64, u64)> {
        let counts = (row.integer("the number of blocks")?, row.integer("the number of nodes or elements")?);
        if self == Version::V41 {
            row.integer("the smallest tag")?;
            row.integer("the largest tag")?;
        }
        Ok(counts)
    }

    /// The entity that a block belongs to: its dimension and its tag.
    fn entity(self, row: &mut Rows<'_>) -> Result<(u64, i64)> {
        let what = "the tag of an entity";
        let mut tag = if self == Version::V40 { row.signed(what)? } else { 0 };
        let dimension = row.integer("the dimension of an entity")?;
        if dimension > 3 {
            return Err(no_dimension(dimension as i64));
        }
        if self == Version::V41 {
            tag = row.signed(what)?;
        }
        Ok((dimension, tag))
    }

    /// Number of rows that a node takes in a block of MSH 4.
    fn rows_a_node(self) -> usize {
        if self == Version::V41 { 2 } else { 1 }
    }
}
