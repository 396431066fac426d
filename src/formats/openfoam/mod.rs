//! OpenFOAM's polyMesh: points, faces, and for each face the cell that owns it and its neighbour. Cells are not written:
//! each is put together from its faces (`cells`), and is a hexahedron, prism, pyramid or tetrahedron if its faces make one
//! (`matching`), as checkMesh finds them too. What they do not make is counted as a polyhedron.
//!
//! The mesh is a folder: `polyMesh` itself, a case with `constant/polyMesh`, or any of the four files. Cells have their
//! numbers in the mesh, from 0.

mod cells;
mod header;
mod lists;
mod matching;
mod points;
mod reader;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::{Format, Outline};
use crate::input::{Compression, Input, Source, Spot};

/// The format's row in the table of formats.
pub(super) struct OpenFoam;

/// The files of a polyMesh that the cells follow from, the one that stands for the mesh first.
const LISTS: [&str; 4] = ["faces", "points", "owner", "neighbour"];

impl Format for OpenFoam {
    fn name(&self) -> &'static str {
        "openfoam"
    }

    fn title(&self) -> &'static str {
        "OpenFOAM polyMesh: a case or its mesh folder, ascii and binary, labels and scalars of 32 and 64 bits"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["foam"]
    }

    fn looks_for(&self) -> &'static str {
        "a FoamFile header of points, faces, owner or neighbour"
    }

    fn detect(&self, head: &[u8]) -> bool {
        header::is_of_mesh(head)
    }

    fn files(&self, path: &Path, is_folder: bool) -> Option<Result<Vec<PathBuf>>> {
        if is_folder {
            return files_of_folder(path);
        }
        let name = path.file_name()?.to_str()?;
        let folder = path.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p })?;
        if name.ends_with(".foam") {
            return files_of_folder(folder);
        }
        let is_list = LISTS.iter().any(|list| unpacked(name) == *list);
        (is_list && is_mesh(folder)).then(|| Ok(LISTS.map(|list| file(folder, list)).to_vec()))
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let [faces, points, owner, neighbour] = &*input.parts else {
            let expected = "the files points, faces, owner and neighbour in one folder";
            let error = Error::malformed(expected, "one that stands alone");
            return Err(input.source.place(error, Spot::Text(0)));
        };
        let source = |part: &Input| Arc::clone(&part.source);
        points::outline(&source(points), out)?;
        cells::outline(input, &source(faces), [&owner.source, &neighbour.source], out)
    }
}

/// A file's name without the extension of a compression.
fn unpacked(name: &str) -> &str {
    let packed = |c: Compression| name.strip_suffix(c.extension())?.strip_suffix('.');
    Compression::ALL.into_iter().find_map(packed).unwrap_or(name)
}

/// The file of that name, or as it is packed, or the name that should be there.
fn file(folder: &Path, name: &str) -> PathBuf {
    let packed = Compression::ALL.into_iter().map(|c| folder.join(format!("{name}.{}", c.extension())));
    let plain = folder.join(name);
    if plain.is_file() {
        return plain;
    }
    packed.into_iter().find(|path| path.is_file()).unwrap_or(plain)
}

/// Whether a folder holds the lists that make cells.
fn is_mesh(folder: &Path) -> bool {
    file(folder, "faces").is_file() && file(folder, "owner").is_file()
}

/// The files of the mesh that a folder is, if it is one.
fn files_of_folder(folder: &Path) -> Option<Result<Vec<PathBuf>>> {
    let places = ["", "constant/polyMesh", "polyMesh"].map(|inner| folder.join(inner));
    if let Some(mesh) = places.iter().find(|place| is_mesh(place)) {
        return Some(Ok(LISTS.map(|list| file(mesh, list)).to_vec()));
    }
    let is_decomposed = is_mesh(&folder.join("processor0/constant/polyMesh"))
        || std::fs::read_dir(folder).ok()?.flatten().any(|entry| is_collated(&entry.path()));
    is_decomposed.then(|| {
        let what = "a decomposed case is not read as one mesh: run reconstructParMesh first, or score its processor \
                    folders one by one";
        Err(Error::unsupported(what).in_file(folder).in_format("openfoam"))
    })
}

/// Whether a folder is that of all processors together: `processors4/constant/polyMesh`.
fn is_collated(folder: &Path) -> bool {
    let number = folder.file_name().and_then(|name| name.to_str()?.strip_prefix("processors"));
    number.is_some_and(|n| n.starts_with(|c: char| c.is_ascii_digit()))
        && is_mesh(&folder.join("constant/polyMesh"))
}

/// The error of a label that no table can hold.
fn too_many(source: &Source, at: u64, what: &str) -> Error {
    source.place(Error::limit(format!("number of {what}"), u32::MAX >> 1), Spot::Text(at))
}
