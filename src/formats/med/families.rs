//! Families: each element has the number of one, and each may belong to several groups.

use std::collections::HashMap;

use crate::error::Result;
use crate::formats::hdf5::Group;

/// The group of all families.
const FAMILIES: &str = "FAS";
/// Letters of a group's name.
const NAME: usize = 80;
/// Most letters of the names of a family's groups.
const MOST_LETTERS: u64 = 1 << 20;

/// What the families of elements are called, by their numbers: the names of their groups, or their own. The family 0 is
/// that of elements which are in none.
pub(super) fn names(root: &Group<'_>, mesh: &str) -> Result<HashMap<u64, String>> {
    let mut names = HashMap::from([(0, String::new())]);
    let Some(all) = root.group(FAMILIES)? else { return Ok(names) };
    let Some(mesh) = all.group(mesh)? else { return Ok(names) };
    // Before version 3 families of nodes and of elements stood side by side.
    for family in mesh.group("ELEME")?.unwrap_or(mesh).groups()? {
        let Some(number @ ..0) = family.integer("NUM")? else { continue };
        let groups = groups(&family)?;
        let name = if groups.is_empty() { family.name().to_owned() } else { groups.join(", ") };
        names.insert(number.cast_unsigned(), name);
    }
    Ok(names)
}

/// The names of a family's groups.
fn groups(family: &Group<'_>) -> Result<Vec<String>> {
    let Some(group) = family.group("GRO")? else { return Ok(Vec::new()) };
    let Some(list) = group.dataset("NOM")? else { return Ok(Vec::new()) };
    if !list.is_of_numbers() || list.len() > MOST_LETTERS {
        return Ok(Vec::new());
    }
    let letters: Vec<u8> = list.integers(MOST_LETTERS)?.into_iter().map(|letter| letter as u8).collect();
    let name = |raw: &[u8]| {
        let end = memchr::memchr(0, raw).unwrap_or(raw.len());
        String::from_utf8_lossy(&raw[..end]).trim().to_owned()
    };
    Ok(letters.chunks(NAME).map(name).filter(|name| !name.is_empty()).collect())
}
