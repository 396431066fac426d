//! MAT-files of version 7.3: an HDF5 file, its datasets the matrices with their dimensions turned round, its groups the
//! structures.

use super::choose;
use super::contents::{Contents, MOST_DEPTH, MOST_MATRICES};
use super::store::{Matrix, leaf};
use crate::error::{Error, Result};
use crate::formats::array::Unpacked;
use crate::formats::hdf5::{Dataset, Group, Hdf5};
use crate::input::Input;

/// Reads what the file holds; what is chunked, and may be of a mesh, is unpacked to scratch.
pub(super) fn read(input: &Input) -> Result<Contents> {
    let file = Hdf5::open(input)?;
    let (mut contents, mut found) = (Contents::default(), Vec::new());
    walk(&file.root()?, "", 0, &mut found, &mut contents)?;
    let mut unpacked = Unpacked::new(input);
    let mut stored = Vec::new();
    for (path, dataset) in found {
        let &[columns, rows] = dataset.shape() else { continue };
        stored.push((path, rows, columns, dataset.store(input, &mut unpacked)?));
    }
    let stores = unpacked.finish()?;
    for (path, rows, columns, stored) in stored {
        let numbers = stores.array(stored, &path)?;
        contents.matrices.push(Matrix { path, rows, columns, numbers });
    }
    Ok(contents)
}

/// Lists the matrices of a group that may be a mesh's, by their paths.
fn walk<'f>(
    group: &Group<'f>,
    path: &str,
    depth: usize,
    found: &mut Vec<(String, Dataset<'f>)>,
    contents: &mut Contents,
) -> Result<()> {
    let limit = |what, most| Err(group.source().place(Error::limit(what, most), group.spot()));
    if depth > MOST_DEPTH {
        return limit("depth of structures and cells", MOST_DEPTH);
    }
    let (groups, datasets) = group.names()?;
    let inner = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    for name in datasets {
        let path = inner(&name);
        let Some(dataset) = group.dataset(&name)? else { continue };
        match dataset.text("MATLAB_class").unwrap_or_default().as_str() {
            "char" => contents.other(&path, "text"),
            "cell" => contents.other(&path, "a cell array, which is not looked into in version 7.3"),
            _ if dataset.is_of_numbers() && dataset.shape().len() == 2 => {
                if choose::may_be_of_mesh(leaf(&path)) {
                    found.push((path, dataset));
                } else {
                    contents.other(&path, "numbers");
                }
            }
            _ => contents.other(&path, "neither numbers nor a structure"),
        }
        if found.len() > MOST_MATRICES {
            return limit("number of matrices that may be of a mesh", MOST_MATRICES);
        }
    }
    for name in groups {
        let path = inner(&name);
        // References and what they lead to.
        if name.starts_with('#') {
            continue;
        }
        if let Some(group) = group.group(&name)? {
            match group.has("MATLAB_sparse")? {
                true => contents.other(&path, "a sparse matrix"),
                false => walk(&group, &path, depth + 1, found, contents)?,
            }
        }
    }
    Ok(())
}
