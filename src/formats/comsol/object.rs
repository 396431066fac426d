//! The grammar: a file's objects, and the fields of a mesh by the version of its class.

use std::sync::Arc;

use super::entities::Entities;
use super::layouts::{Elements, NUMBERS, Points};
use super::reader::{Number, Reader};
use super::types;
use crate::error::{Error, Result};
use crate::formats::{Outline, Piece};

/// Reads all objects.
pub(super) fn outline(mut reader: Reader<'_>, out: &mut dyn Outline) -> Result<()> {
    let version = (reader.integer("the file's version, 0 1")?, reader.integer("the file's version, 0 1")?);
    if version != (0, 1) {
        let what = format!("COMSOL file version {} {} is not read (0 1 is)", version.0, version.1);
        return Err(reader.place(Error::unsupported(what)));
    }
    strings(&mut reader, "tags")?;
    let objects = strings(&mut reader, "types")?;
    let mut found = Found::default();
    for _ in 0..objects {
        object(&mut reader, &mut found, out)?;
    }
    reader.end()?;
    if found.meshes == 0 {
        return Err(reader.wrong("an object of class Mesh", format!("{objects} objects of other classes")));
    }
    Ok(())
}

/// What has been found so far.
#[derive(Default)]
struct Found {
    meshes: u64,
    elements: u64,
}

/// A list of strings, of which only the length is wanted.
fn strings(reader: &mut Reader<'_>, what: &str) -> Result<u64> {
    let count = reader.count(&format!("the number of {what}"))?;
    for _ in 0..count {
        reader.string(&format!("one of the {count} {what}"))?;
    }
    Ok(count)
}

fn object(reader: &mut Reader<'_>, found: &mut Found, out: &mut dyn Outline) -> Result<()> {
    for known in [0, 0, 1] {
        reader.one_of(known..known + 1, "the start of an object, 0 0 1")?;
    }
    let class = reader.string("the class of an object")?;
    match class.as_str() {
        "Mesh" => mesh(reader, found, out),
        "Selection" => selection(reader),
        _ => Err(reader.place(Error::unsupported(format!(
            "a COMSOL object of class \"{}\" is not read (Mesh and Selection are)",
            class.escape_debug()
        )))),
    }
}

/// A named set of entities.
fn selection(reader: &mut Reader<'_>) -> Result<()> {
    reader.one_of(0..1, "version 0 of the class Selection")?;
    reader.string("the label of a selection")?;
    reader.string("the tag of a selection's mesh")?;
    reader.one_of(0..4, "the dimension of a selection, 0 to 3")?;
    let entities = reader.count("the number of entities of a selection")?;
    reader.skip((entities, 1), Number::Integer, "entities of a selection")
}

fn mesh(reader: &mut Reader<'_>, found: &mut Found, out: &mut dyn Outline) -> Result<()> {
    let version = reader.integer("the version of the class Mesh")?;
    if !matches!(version, 1 | 2 | 4 | 8) {
        let what = format!("version {version} of COMSOL's class Mesh is not read (1, 2, 4 and 8 are)");
        return Err(reader.place(Error::unsupported(what)));
    }
    let this = found.meshes * NUMBERS;
    found.meshes += 1;
    let dimension = reader.one_of(0..4, "the space dimension, 0 to 3")?;
    if dimension == 0 {
        return Ok(());
    }
    if version == 8 {
        geometric_model(reader, dimension)?;
    }
    let nodes = reader.count("the number of mesh vertices")?;
    let lowest = if version < 8 { reader.count("the lowest mesh vertex index")? } else { 0 };
    if lowest >= NUMBERS || nodes >= NUMBERS - lowest {
        return Err(reader.wrong(&format!("mesh vertex indices below {NUMBERS}"), lowest));
    }
    let (source, encoding) = (Arc::clone(&reader.input.source), reader.encoding());
    let dimension = dimension as usize;
    reader.rows((nodes, dimension as u64), Number::Real, "mesh vertices", |span, row| {
        let first = this + lowest + row;
        let layout = Points { source: Arc::clone(&source), encoding, dimension, first };
        out.nodes(Piece { layout: Arc::new(layout), span })
    })?;
    for _ in 0..reader.count("the number of element types")? {
        elements(reader, version, (this, dimension), found, out)?;
    }
    Ok(())
}

/// The elements of one type.
fn elements(
    reader: &mut Reader<'_>,
    version: i64,
    (mesh, space): (u64, usize),
    found: &mut Found,
    out: &mut dyn Outline,
) -> Result<()> {
    let name = reader.string("the name of an element type")?;
    let nodes = reader.count("the number of vertices per element")?;
    let known = types::by_name(&name);
    if let Some(kind) = known
        && kind.nodes as u64 != nodes
    {
        return Err(reader.wrong(&format!("{} vertices per element of the type {name}", kind.nodes), nodes));
    }
    let limit = 1 << 16;
    if nodes == 0 || nodes > limit {
        return Err(reader.wrong(&format!("1 to {limit} vertices per element"), nodes));
    }
    let count = reader.count("the number of elements")?;
    let what = format!("elements of the type {name}");
    let mut of_elements = None;
    match known {
        Some(kind) => {
            let (source, encoding) = (Arc::clone(&reader.input.source), reader.encoding());
            let entities = Arc::new(Entities::of(&source, encoding, types::dimension(kind), space));
            of_elements = Some(Arc::clone(&entities));
            reader.rows((count, nodes), Number::Integer, &what, |span, row| {
                let (source, kind, entities) = (Arc::clone(&source), Arc::clone(kind), Arc::clone(&entities));
                let first = found.elements + row;
                let layout = Arc::new(Elements { source, encoding, kind, mesh, first, row, entities });
                out.elements(Piece { layout, span })
            })?;
        }
        None => {
            reader.skip((count, nodes), Number::Integer, &what)?;
            out.count(&types::unknown(name, nodes as usize), count)?;
        }
    }
    found.elements += count;
    if version < 4 {
        let values = reader.count("the number of parameter values per element")?;
        let rows = reader.count("the number of parameters")?;
        reader.skip((rows, values), Number::Real, "parameters")?;
    }
    let entities = reader.count("the number of geometric entity indices")?;
    let mut pieces = Vec::new();
    reader.rows((entities, 1), Number::Integer, "geometric entity indices", |span, row| {
        pieces.push((row, span));
        Ok(())
    })?;
    if let Some(known) = of_elements.filter(|_| entities == count) {
        known.pieces.set(pieces).expect("a list is read once");
    }
    if version < 4 {
        let pairs = reader.count("the number of up/down pairs")?;
        reader.skip((pairs, 2), Number::Integer, "up/down pairs")?;
    }
    Ok(())
}

/// What version 8 says of the geometry before the mesh. What the documentation leaves open is refused.
fn geometric_model(reader: &mut Reader<'_>, dimension: i64) -> Result<()> {
    if reader.one_of(0..2, "0 or 1, whether a geometric model is included")? == 0 {
        return Ok(());
    }
    let dimensions = reader.count("the number of dimensions of geometric entities")?;
    reader.skip((dimensions, 1), Number::Integer, "numbers of geometric entities")?;
    if reader.one_of(0..2, "0 or 1, whether voids are labeled")? == 1 {
        reader.count("the number of finite voids")?;
    }
    let mut lists = vec!["up and down domains of boundaries"];
    if dimension == 3 {
        lists.push("isolated edges in domains");
    }
    if dimension > 1 {
        lists.push("isolated vertices in domains");
    }
    for what in lists {
        if reader.integer(&format!("0, no {what}"))? != 0 {
            let what = format!(
                "a COMSOL mesh of class version 8 with {what} is not read: export it without its geometric model"
            );
            return Err(reader.place(Error::unsupported(what)));
        }
    }
    Ok(())
}
