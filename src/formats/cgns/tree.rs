//! Nodes of the CGNS tree: a label, a name, children, data.

use crate::error::Result;
use crate::formats::hdf5::{Dataset, Group};

/// The dataset that holds a node's data.
const DATA: &str = " data";
/// Most letters or numbers of a node that is no array.
const MOST: u64 = 4096;

/// The label of a node.
fn label(node: &Group<'_>) -> Result<String> {
    Ok(node.text("label")?.unwrap_or_default())
}

/// The children of a node that have the label.
pub(super) fn children<'f>(node: &Group<'f>, wanted: &str) -> Result<Vec<Group<'f>>> {
    let mut found = Vec::new();
    for child in node.groups()? {
        if label(&child)? == wanted {
            found.push(child);
        }
    }
    Ok(found)
}

/// The first child of a node that has the label.
pub(super) fn child<'f>(node: &Group<'f>, wanted: &str) -> Result<Option<Group<'f>>> {
    Ok(children(node, wanted)?.into_iter().next())
}

/// The data of a node.
pub(super) fn data<'f>(node: &Group<'f>) -> Result<Dataset<'f>> {
    node.needed(DATA)
}

/// The data of the child called `name`, where there is one.
pub(super) fn data_of<'f>(node: &Group<'f>, name: &str) -> Result<Option<Dataset<'f>>> {
    node.group(name)?.map(|child| data(&child)).transpose()
}

/// The whole numbers of a node that has few.
pub(super) fn integers(node: &Group<'_>) -> Result<Vec<i64>> {
    data(node)?.integers(MOST)
}

/// The letters of a node.
pub(super) fn text(node: &Group<'_>) -> Result<String> {
    let letters = data(node)?.integers(MOST)?;
    let bytes: Vec<u8> = letters.into_iter().map(|letter| letter as u8).collect();
    Ok(String::from_utf8_lossy(&bytes).trim_matches(['\0', ' ']).to_owned())
}
