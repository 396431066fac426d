//! Parts and their instances. A part's blocks are kept until its instances are known: every instance is a copy of
//! them, moved, under a number of its own. A deck without any instance was written by a mesher: its parts stand as
//! they are.

use std::cell::Cell;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::elements::ElementLines;
use super::make::{Belonging, Listed, MadeElements, MadeNodes, Maker, SetsOfPart};
use super::nodes::NodeLines;
use super::placement::{Affine, Placement};
use super::types::Kind;
use crate::error::{Error, Result};
use crate::formats::{ElementLayout, NodeLayout, Outline, Piece};
use crate::input::{Source, Spot};

/// The bits of a node's number in the deck; the instance stands above them.
const NUMBER_BITS: u32 = 40;
/// The most instances, with a bit to spare.
pub(super) const MOST_INSTANCES: usize = 1 << 23;

/// A place in a deck, for errors that come later.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) source: Arc<Source>,
    pub(super) at: u64,
}

impl Place {
    /// Adds the place to an error.
    pub(super) fn of(&self, error: Error) -> Error {
        self.source.place(error, Spot::Text(self.at))
    }
}

/// The data of one keyword, cut into pieces.
pub(super) struct Block<T> {
    pub(super) source: Arc<Source>,
    pub(super) spans: Vec<Range<u64>>,
    pub(super) what: T,
}

/// What a part, an instance or the assembly itself holds.
#[derive(Default)]
pub(super) struct Blocks {
    pub(super) nodes: Vec<NodeBlock>,
    pub(super) elements: Vec<ElementBlock>,
    /// What is said of element sets, and what it says once the deck was read to its end.
    pub(super) listed: Listed,
    pub(super) sets: Arc<SetsOfPart>,
    /// What keywords that make others draw on.
    pub(super) maker: Maker,
    /// Why a keyword that makes others could not: an error once the blocks are used.
    pub(super) fault: Cell<Option<Error>>,
}

/// Nodes, as they stand in the deck or were made.
pub(super) enum NodeBlock {
    Lines(Arc<Block<Placement>>),
    Made(MadeNodes),
}

/// Elements, as they stand in the deck or were made.
pub(super) enum ElementBlock {
    /// With the set that they all are in, `ELSET=`.
    Lines(Arc<Block<Kind>>, Option<Arc<str>>),
    Made(MadeElements, Option<Arc<str>>),
}

/// A `*PART`.
pub(super) struct Part {
    pub(super) name: String,
    pub(super) blocks: Blocks,
    pub(super) place: Place,
}

/// An `*INSTANCE`.
pub(super) struct Instance {
    pub(super) part: usize,
    pub(super) name: Option<String>,
    pub(super) own: Blocks,
    pub(super) motion: Affine,
    pub(super) place: Place,
}

impl Blocks {
    /// Yields the pieces as a copy with the given scope and motion; `owner` is the part or the instance.
    pub(super) fn yield_to(
        &self,
        out: &mut dyn Outline,
        owner: Option<&str>,
        scope: u64,
        motion: Affine,
        instances: Option<&Arc<HashMap<Vec<u8>, u64>>>,
    ) -> Result<()> {
        if let Some(error) = self.fault.take() {
            return Err(error);
        }
        for block in &self.nodes {
            let block = match block {
                NodeBlock::Lines(block) => block,
                NodeBlock::Made(made) => {
                    made.yield_to(out, scope, motion)?;
                    continue;
                }
            };
            let placement = Placement { motion, ..block.what };
            let layout: Arc<dyn NodeLayout> =
                Arc::new(NodeLines { source: Arc::clone(&block.source), placement, scope });
            for span in &block.spans {
                out.nodes(Piece { layout: Arc::clone(&layout), span: span.clone() })?;
            }
        }
        let owner: Option<Arc<str>> = owner.map(Arc::from);
        let belonging = |set: &Option<Arc<str>>| Belonging {
            owner: owner.clone(),
            set: set.clone(),
            sets: Arc::clone(&self.sets),
        };
        for block in &self.elements {
            let (block, set) = match block {
                ElementBlock::Lines(block, set) => (block, set),
                ElementBlock::Made(made, set) => {
                    made.yield_to(out, scope, belonging(set))?;
                    continue;
                }
            };
            let layout: Arc<dyn ElementLayout> = Arc::new(ElementLines {
                source: Arc::clone(&block.source),
                kind: block.what.clone(),
                belonging: belonging(set),
                scope,
                instances: instances.cloned(),
            });
            for span in &block.spans {
                out.elements(Piece { layout: Arc::clone(&layout), span: span.clone() })?;
            }
        }
        Ok(())
    }
}

/// The scope of the instance with this number, from 0. Scope 0 is the assembly's own, or that of a flat deck.
pub(super) fn scope(instance: usize) -> u64 {
    (instance as u64 + 1) << NUMBER_BITS
}
