//! Exodus II: meshes of Cubit, SEACAS, MOOSE, libMesh and others, as variables of a NetCDF file.
//!
//! `coordx`, `coordy`, `coordz` (or one `coord`) hold the nodes; each block of elements has a variable `connectN` whose
//! attribute `elem_type` names their type in free words. Corners stand first and in our order.

#[cfg(test)]
mod tests;
mod types;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::array::elements::{Elements, Labels, NodeRange, UsedNodes};
use crate::formats::array::nodes::Coordinates;
use crate::formats::array::regions::InRegions;
use crate::formats::array::table::Table;
use crate::formats::array::{Array, Stored, Stores, Unpacked};
use crate::formats::netcdf::{self, Variable, Variables};
use crate::formats::{Format, HEAD_BYTES, Outline};
use crate::input::{Input, Spot};
use crate::mesh::ElementType;

/// Most nodes of one element.
const MOST_NODES: u64 = 4096;
/// Most blocks whose numbers are looked at.
const MOST_BLOCKS: u64 = 1 << 20;

/// The format's row in the table of formats.
pub(super) struct Exodus;

impl Format for Exodus {
    fn name(&self) -> &'static str {
        "exodus"
    }

    fn title(&self) -> &'static str {
        "Exodus II in NetCDF files: CDF-1, CDF-2, CDF-5 and NetCDF-4"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["e", "exo", "ex2", "exii", "g", "gen"]
    }

    fn looks_for(&self) -> &'static str {
        "a NetCDF file with the dimensions num_nodes and num_dim"
    }

    fn detect(&self, head: &[u8]) -> bool {
        let names: [&[u8]; 2] = [b"num_nodes", b"num_dim"];
        netcdf::detect(head) && names.iter().all(|name| memchr::memmem::find(head, name).is_some())
    }

    fn knows(&self, input: &Input) -> bool {
        let head = input.source.peek(0..HEAD_BYTES as u64);
        let has_mesh = |file: &dyn Variables| {
            Ok(file.find("num_nodes").is_some()
                && ["coord", "coordx"].iter().any(|name| file.find(name).is_some()))
        };
        self.detect(head) || netcdf::detect(head) && netcdf::open(input, has_mesh).unwrap_or(false)
    }

    fn regions(&self) -> Option<&'static str> {
        Some("element blocks")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        netcdf::open(input, |file| outline(input, file, out))
    }
}

/// A block of elements of one type.
struct Block {
    kind: Arc<ElementType>,
    count: u64,
    /// Where the numbers of its nodes stand, unless it lists faces.
    nodes: Option<Stored>,
    name: String,
    /// What the user calls it.
    region: String,
}

fn outline(input: &Input, file: &dyn Variables, out: &mut dyn Outline) -> Result<()> {
    let mut unpacked = Unpacked::new(input);
    let coordinates = coordinates(input, file, &mut unpacked)?;
    let mut blocks = Vec::new();
    let names = block_names(file)?;
    for (number, variable) in block_variables(file) {
        let found = block(input, file, variable, coordinates.len(), &mut unpacked)?;
        let place = usize::try_from(number.wrapping_sub(1)).unwrap_or(usize::MAX);
        let region = names.get(place).cloned().unwrap_or_else(|| number.to_string());
        blocks.extend(found.map(|block| Block { region, ..block }));
    }
    let mut faces = Vec::new();
    if blocks.iter().any(|block| block.nodes.is_none()) {
        for variable in file.variables().iter().filter(|variable| variable.name.starts_with("fbconn")) {
            faces.push(file.store(variable, &mut unpacked)?);
        }
    }
    let total = blocks.iter().fold(0, |sum: u64, block| sum.saturating_add(block.count));
    let labels = match file.find("elem_num_map") {
        Some(map) if map.len() == total => Some(file.store(map, &mut unpacked)?),
        _ => None,
    };
    let stores = unpacked.finish()?;
    let arrays = coordinates.into_iter().map(|stored| stores.array(stored, "coordinates"));
    let table = Table::Columns(arrays.collect::<Result<_>>()?);
    Coordinates { file: Arc::clone(&stores.file), table, first: 1 }.outline(out)?;
    for stored in faces {
        used(&stores, stored, "the nodes of faces", out)?;
    }
    let labels = labels.map(|stored| stores.array(stored, "elem_num_map")).transpose()?;
    hand_out(blocks, labels.as_ref(), &stores, out)
}

/// Hands out the blocks, one after another.
fn hand_out(
    blocks: Vec<Block>,
    labels: Option<&Array>,
    stores: &Stores,
    out: &mut dyn Outline,
) -> Result<()> {
    let mut first = 0;
    for Block { kind, count, nodes, name, region } in blocks {
        match nodes {
            Some(nodes) if nodes.count == count.saturating_mul(kind.nodes as u64) => {
                let labels = match labels {
                    Some(array) => Labels::Listed(array.part(first..first + count)),
                    None => Labels::From(first + 1),
                };
                let nodes = Table::Rows(stores.array(nodes, &name)?, kind.nodes);
                let (file, range) = (Arc::clone(&stores.file), NodeRange::default());
                let regions = InRegions::named(region);
                Elements { file, kind, nodes, labels, range, regions }.outline(out)?;
            }
            Some(nodes) => {
                out.count(&kind, count)?;
                used(stores, nodes, &name, out)?;
            }
            None => out.count(&kind, count)?,
        }
        first += count;
    }
    Ok(())
}

/// Notes the nodes of elements that are not measured.
fn used(stores: &Stores, nodes: Stored, name: &str, out: &mut dyn Outline) -> Result<()> {
    let (file, range) = (Arc::clone(&stores.file), NodeRange::default());
    UsedNodes { file, nodes: stores.array(nodes, name)?, range }.outline(out)
}

/// The arrays of coordinates, one an axis.
fn coordinates(input: &Input, file: &dyn Variables, unpacked: &mut Unpacked<'_>) -> Result<Vec<Stored>> {
    if let Some(all) = file.find("coord") {
        let &[axes @ 1..=3, count] = &all.shape[..] else {
            return Err(wrong_shape(input, all, "1 to 3 axes x nodes"));
        };
        let stored = file.store(all, unpacked)?;
        let part = |k: u64| Stored { at: stored.at + k * count * stored.number.width(), count, ..stored };
        return Ok((0..axes).map(part).collect());
    }
    let mut found: Vec<Stored> = Vec::new();
    for name in ["coordx", "coordy", "coordz"] {
        let Some(axis) = file.find(name) else { break };
        let stored = file.store(axis, unpacked)?;
        if axis.shape.len() != 1 || found.first().is_some_and(|first| first.count != stored.count) {
            return Err(wrong_shape(input, axis, "one number for each node"));
        }
        found.push(stored);
    }
    if found.is_empty() {
        let error = Error::malformed("the variable coordx or coord", "none of that name");
        return Err(input.source.place(error, Spot::Binary(0)));
    }
    Ok(found)
}

/// What the user calls each block: its name, or the number that he gave it.
fn block_names(file: &dyn Variables) -> Result<Vec<String>> {
    let mut names = Vec::new();
    if let Some(variable) = file.find("eb_names")
        && let [_, width] = variable.shape[..]
        && width > 0
        && let Some(letters) = file.letters(variable)?
    {
        let name = |raw: &[u8]| {
            let end = memchr::memchr(0, raw).unwrap_or(raw.len());
            String::from_utf8_lossy(&raw[..end]).trim().to_owned()
        };
        names = letters.chunks(usize::try_from(width).unwrap_or(usize::MAX)).map(name).collect();
    }
    if let Some(variable) = file.find("eb_prop1") {
        for (k, id) in file.integers(variable, MOST_BLOCKS)?.into_iter().enumerate() {
            match names.get_mut(k) {
                Some(name) if name.is_empty() => *name = id.to_string(),
                Some(_) => {}
                None => names.push(id.to_string()),
            }
        }
    }
    Ok(names)
}

/// The variables that list the blocks' elements, and the blocks' places among all, from 1, in their order.
fn block_variables(file: &dyn Variables) -> Vec<(u64, &Variable)> {
    let number = |name: &str| {
        let digits = name.strip_prefix("connect").or_else(|| name.strip_prefix("facconn"))?;
        digits.parse::<u64>().ok()
    };
    let mut blocks: Vec<_> =
        file.variables().iter().filter_map(|variable| Some((number(&variable.name)?, variable))).collect();
    blocks.sort_by_key(|block| block.0);
    blocks
}

fn block(
    input: &Input,
    file: &dyn Variables,
    connect: &Variable,
    axes: usize,
    unpacked: &mut Unpacked<'_>,
) -> Result<Option<Block>> {
    let name = connect.name.clone();
    let Some(text) = file.text(connect, "elem_type")? else {
        let error = Error::malformed(format!("{name} with the attribute elem_type"), "none of that name");
        return Err(input.source.place(error, Spot::Binary(connect.at)));
    };
    let (count, kind) = match connect.shape[..] {
        [_, 0] | [0, _] | [0] => return Ok(None),
        [count, width] if width <= MOST_NODES => (count, types::of_block(&text, width as usize, axes)),
        // Polygons and polyhedra: all lists one after another; how long each is stands in another variable.
        [_] => {
            let lengths = name.replace("connect", "ebepecnt").replace("facconn", "ebepecnt");
            let Some(lengths) = file.find(&lengths) else {
                return Err(wrong_shape(
                    input,
                    connect,
                    &format!("elements x nodes, or {lengths} beside it"),
                ));
            };
            (lengths.len(), types::of_lists(&text))
        }
        _ => return Err(wrong_shape(input, connect, &format!("elements x at most {MOST_NODES} nodes"))),
    };
    let nodes = if name.starts_with("facconn") { None } else { Some(file.store(connect, unpacked)?) };
    Ok(Some(Block { kind, count, nodes, name, region: String::new() }))
}

fn wrong_shape(input: &Input, variable: &Variable, expected: &str) -> Error {
    let shape: Vec<_> = variable.shape.iter().map(u64::to_string).collect();
    let error = Error::malformed(
        format!("{} of the shape: {expected}", variable.name),
        format!("the shape ({})", shape.join(" x ")),
    );
    input.source.place(error, Spot::Binary(variable.at))
}
