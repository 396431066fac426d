//! Physical groups: in MSH 1 and 2 a tag of each element, in MSH 4 a property of the entity that its block belongs to.
//! What is wrong in these sections is no reason to refuse a mesh: then groups go without names, or entities without
//! groups.

use std::collections::{HashMap, HashSet};

use super::Version;
use super::rows::Rows;
use super::walk::Walk;
use super::words::Binary;
use crate::error::Result;
use crate::formats::ElementSink;
use crate::mesh::ElementType;

/// Most entities that are kept.
const MOST_ENTITIES: usize = 1 << 20;
/// Most names that are kept, and the longest line that holds one.
const MOST_NAMES: usize = 1 << 16;
const LONGEST_LINE: usize = 1 << 10;

/// What the file says about groups and entities.
#[derive(Debug, Default)]
pub(super) struct Groups {
    /// Names by dimension and tag of the group.
    names: HashMap<(u8, i64), String>,
    /// The first group of an entity, by dimension and tag of the entity.
    entities: HashMap<(u8, i64), i64>,
    /// Entities whose elements are those of other partitions.
    ghosts: HashSet<(u8, i64)>,
}

impl Groups {
    /// Reads `$PhysicalNames`, up to the line that ends it: `dimension tag "name"`.
    pub(super) fn read_names(&mut self, walk: &mut Walk<'_>, end: &str) -> Result<()> {
        let from = walk.at();
        walk.skip_to(end)?;
        let window = walk.source.window(from..walk.at());
        let lines = window.split(|b| *b == b'\n').skip(1);
        for line in lines.filter(|line| line.len() <= LONGEST_LINE) {
            let text = String::from_utf8_lossy(line);
            let mut parts = text.trim().splitn(3, [' ', '\t']);
            let numbers =
                (parts.next().and_then(|n| n.parse().ok()), parts.next().and_then(|n| n.parse().ok()));
            if let ((Some(dimension), Some(tag)), Some(name)) = (numbers, parts.next())
                && self.names.len() < MOST_NAMES
            {
                self.names.insert((dimension, tag), name.trim().trim_matches('"').to_owned());
            }
        }
        Ok(())
    }

    /// Reads `$Entities` or `$PartitionedEntities` of MSH 4, up to the line that ends it.
    pub(super) fn read_entities(
        &mut self,
        walk: &mut Walk<'_>,
        (version, binary): (Version, Option<Binary>),
        are_parts: bool,
        end: &str,
    ) -> Result<()> {
        let from = walk.at();
        walk.skip_to(end)?;
        let window = walk.source.window(from..walk.at() - end.len() as u64);
        let complete = match binary {
            Some(binary) => self.binary_entities(&window, binary, are_parts).is_some(),
            None => self.text_entities(&mut Rows::new(from, &window), version, are_parts).is_ok(),
        };
        if !complete {
            tracing::warn!(
                "the section $Entities is not as it should be: physical groups may be missing, ghosts be taken for elements"
            );
        }
        Ok(())
    }

    fn text_entities(&mut self, rows: &mut Rows<'_>, version: Version, are_parts: bool) -> Result<()> {
        let mut ghosts = Vec::new();
        if are_parts {
            rows.integer("the number of partitions")?;
            rows.end()?;
            let count = rows.integer("the number of ghost entities")?;
            rows.end()?;
            for _ in 0..count {
                ghosts.push(rows.signed("the tag of a ghost entity")?);
                rows.skip(1);
            }
        }
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = rows.integer("a number of entities")?;
        }
        rows.end()?;
        self.add_ghosts(counts, ghosts);
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = rows.signed("the tag of an entity")?;
                let mut parent = None;
                if are_parts {
                    let of = rows.integer("the dimension of an entity")?;
                    parent = Some((of as u8, rows.signed("the tag of an entity")?));
                    for _ in 0..rows.integer("the number of an entity's partitions")? {
                        rows.signed("the tag of a partition")?;
                    }
                }
                // Points of 4.1 have a place, all others a box.
                for _ in 0..if dimension == 0 && version == Version::V41 { 3 } else { 6 } {
                    rows.real("a coordinate")?;
                }
                let groups = rows.integer("the number of physical groups")?;
                let group = if groups > 0 { Some(rows.signed("the tag of a physical group")?) } else { None };
                self.add(dimension, tag, group, parent);
                rows.skip(1);
            }
        }
        Ok(())
    }

    fn binary_entities(&mut self, bytes: &[u8], binary: Binary, are_parts: bool) -> Option<()> {
        let (mut at, word) = (0usize, binary.word);
        let mut take = |count: usize| {
            let taken = bytes.get(at..at.checked_add(count)?)?;
            at += count;
            Some(taken)
        };
        let tag = |bytes: &[u8]| i64::from(binary.endian.u32(bytes) as i32);
        let mut ghosts = Vec::new();
        if are_parts {
            take(word)?;
            for _ in 0..binary.count(take(word)?).ok()? {
                ghosts.push(tag(take(8)?));
            }
        }
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = binary.count(take(word)?).ok()?;
        }
        self.add_ghosts(counts, ghosts);
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let entity = tag(take(4)?);
                let mut parent = None;
                if are_parts {
                    parent = Some((tag(take(4)?) as u8, tag(take(4)?)));
                    let partitions = binary.count(take(word)?).ok()? as usize;
                    take(partitions.checked_mul(4)?)?;
                }
                take(8 * if dimension == 0 { 3 } else { 6 })?;
                let groups = binary.count(take(word)?).ok()? as usize;
                let tags = take(groups.checked_mul(4)?)?;
                self.add(dimension, entity, (groups > 0).then(|| tag(tags)), parent);
                if dimension > 0 {
                    let boundary = binary.count(take(word)?).ok()? as usize;
                    take(boundary.checked_mul(4)?)?;
                }
            }
        }
        Some(())
    }

    /// Ghosts are of the mesh's own dimension, the highest of which there are entities.
    fn add_ghosts(&mut self, counts: [u64; 4], tags: Vec<i64>) {
        let dimension = counts.iter().rposition(|count| *count > 0).unwrap_or(3) as u8;
        self.ghosts.extend(tags.into_iter().take(MOST_ENTITIES).map(|tag| (dimension, tag)));
    }

    /// An entity that is in a group, or a part of one that is.
    fn add(&mut self, dimension: u8, entity: i64, group: Option<i64>, parent: Option<(u8, i64)>) {
        let group = group.or_else(|| self.entities.get(&parent?).copied());
        if let Some(group) = group.filter(|_| self.entities.len() < MOST_ENTITIES) {
            self.entities.insert((dimension, entity), group);
        }
    }

    /// Puts the elements that follow into their physical group; 0 stands for none.
    #[inline]
    pub(super) fn enter(&self, kind: &ElementType, group: i64, out: &mut ElementSink<'_>) -> Result<()> {
        let Some(shape) = kind.shape().filter(|_| out.wants_regions()) else { return Ok(()) };
        let dimension = shape.dimension() as u8;
        out.region(key(dimension, group), || self.name(dimension, group))
    }

    /// Puts the elements that follow into the group of their entity, or into the entity itself where it is in none.
    pub(super) fn enter_entity(&self, dimension: u8, entity: i64, out: &mut ElementSink<'_>) -> Result<()> {
        out.ghosts(self.ghosts.contains(&(dimension, entity)));
        out.region(key(dimension, entity), || match self.entities.get(&(dimension, entity)) {
            // Gmsh turns the sign where a surface stands the other way round.
            Some(group) => self.name(dimension, group.abs()),
            None => {
                let what = ["point", "curve", "surface", "volume"][usize::from(dimension.min(3))];
                format!("{what} {entity}")
            }
        })
    }

    fn name(&self, dimension: u8, group: i64) -> String {
        match self.names.get(&(dimension, group)) {
            Some(name) => name.clone(),
            None if group == 0 => String::new(),
            None => group.to_string(),
        }
    }
}

fn key(dimension: u8, tag: i64) -> u64 {
    ((tag as u64) << 2) | u64::from(dimension)
}
