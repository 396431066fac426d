//! Takes the elements of one piece from a layout: turns node numbers into rows of the node table, puts the corners into
//! our order, fills chunks and hands on the full ones.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use crate::error::{Error, Kind, Result};
use crate::input::Spot;
use crate::mesh::{Chunk, Class, ElementType, IN_ORDER, NO_REGION, Nodes, Origin, Regions, Shape, Tag};
use crate::width::{Wide, at_widest};

/// The most elements that a decoder hands over at a time.
pub const BLOCK: usize = 128;

/// Where full chunks go and empty ones come from.
pub trait Chunks {
    /// An empty chunk.
    fn empty(&mut self) -> Result<Chunk>;
    /// Hands on a chunk that is full, or the last of its piece.
    fn hand_on(&mut self, chunk: Chunk) -> Result<()>;
}

/// What one piece held besides the chunks.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ledger {
    /// Elements by type, in the order in which the types were met.
    pub types: Vec<TypeCount>,
    /// Measured elements that name a node which the file does not define; they were left out.
    pub missing_nodes: u64,
    /// Measured elements that name one corner node twice.
    pub repeated_nodes: u64,
    /// Elements that another part of the mesh has as its own, or that the file hides; they were left out.
    pub ghost_elements: u64,
}

/// How many elements of a type were met.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TypeCount {
    /// The type's own name in its format.
    pub name: Cow<'static, str>,
    /// What is done with them.
    pub class: Class,
    /// Number of elements.
    pub count: u64,
}

impl Ledger {
    /// Counts elements of a type.
    pub fn count(&mut self, kind: &ElementType, count: u64) {
        let row = self.row(&kind.name, &kind.class);
        self.types[row].count += count;
    }

    /// The place of a type in `types`.
    #[expect(clippy::ptr_arg, reason = "the name of a static type is not copied")]
    fn row(&mut self, name: &Cow<'static, str>, class: &Class) -> usize {
        self.types.iter().position(|t| t.name == *name && t.class == *class).unwrap_or_else(|| {
            self.types.push(TypeCount { name: name.clone(), class: class.clone(), count: 0 });
            self.types.len() - 1
        })
    }

    /// Takes in what another piece held.
    pub fn merge(&mut self, other: &Ledger) {
        for theirs in &other.types {
            let row = self.row(&theirs.name, &theirs.class);
            self.types[row].count += theirs.count;
        }
        self.missing_nodes += other.missing_nodes;
        self.repeated_nodes += other.repeated_nodes;
        self.ghost_elements += other.ghost_elements;
    }
}

/// Takes the elements of one piece.
pub struct ElementSink<'a> {
    /// Where the record stands that is being decoded: set it before each record, and errors will name the place.
    pub at: Spot,
    nodes: &'a Nodes,
    chunks: &'a mut dyn Chunks,
    open: [Option<Chunk>; Shape::ALL.len()],
    origin: Origin,
    allow_missing: bool,
    ledger: Ledger,
    /// The types met so far, each with its row of the ledger; the type at hand is the one at `current`.
    types: Vec<(Arc<ElementType>, usize)>,
    current: usize,
    /// Elements of the type at hand that the ledger does not know of yet.
    run: u64,
    /// What elements are tagged with, where somebody asked for it.
    tags: Option<Tags<'a>>,
    /// Whether the elements that come are left out.
    passes_over: bool,
}

/// The tag of the element that comes next, and the regions of this piece.
struct Tags<'a> {
    regions: &'a Regions,
    next: Tag,
    /// The layout's own key of the region at hand.
    key: Option<u64>,
    /// Numbers of the regions that this piece has met, by key.
    known: HashMap<u64, u32>,
}

impl<'a> ElementSink<'a> {
    /// A sink for the piece with the number `piece`.
    pub fn new(nodes: &'a Nodes, chunks: &'a mut dyn Chunks, piece: u64, allow_missing: bool) -> Self {
        Self {
            at: Spot::Unknown,
            nodes,
            chunks,
            open: [const { None }; Shape::ALL.len()],
            origin: Origin { piece, chunk: 0 },
            allow_missing,
            ledger: Ledger::default(),
            types: Vec::new(),
            current: 0,
            run: 0,
            tags: None,
            passes_over: false,
        }
    }

    /// Tags the elements with their place in the piece and their region.
    pub fn tagging(mut self, regions: Option<&'a Regions>) -> Self {
        let start = |regions| Tags { regions, next: Tag::default(), key: None, known: HashMap::new() };
        self.tags = regions.map(start);
        self
    }

    /// Whether anybody asks for regions: a layout that must work to know them may ask first.
    #[inline]
    pub fn wants_regions(&self) -> bool {
        self.tags.is_some()
    }

    /// Says which region the elements that follow are in, up to the next call. `key` tells the layout's regions apart;
    /// `name` is asked for once a key and piece, and regions of one name are one. A piece starts in no region. Where
    /// nobody asks for regions this costs next to nothing.
    #[inline]
    pub fn region(&mut self, key: u64, name: impl FnOnce() -> String) -> Result<()> {
        match &mut self.tags {
            Some(tags) if tags.key != Some(key) => {
                let done = tags.enter(key, name);
                if done.is_err() {
                    // Which piece meets one too many depends on the threads.
                    self.at = Spot::Unknown;
                }
                done
            }
            _ => Ok(()),
        }
    }

    /// Adds an element. `label` is its own number, `ids` are its nodes as they stand in the record.
    #[inline]
    pub fn element(&mut self, label: u64, kind: &Arc<ElementType>, ids: &[u64]) -> Result<()> {
        if self.passes_over {
            self.ledger.ghost_elements += 1;
            self.mark_used(ids);
            return Ok(());
        }
        self.count_run(kind, 1);
        match &kind.class {
            Class::Measured { shape, corners, .. } => self.measured(label, *shape, corners, ids),
            Class::Counted(_) => {
                self.mark_used(ids);
                Ok(())
            }
        }
    }

    /// Adds at most [`BLOCK`] elements of one type as [`Self::element`] would one after another, only faster. `ids` are
    /// `kind.nodes` nodes of each.
    ///
    /// Takes all or none: `false` says that some element wants a closer look, so that all must be added one by one.
    #[must_use = "elements that were not taken must be added one by one"]
    pub fn block(&mut self, kind: &Arc<ElementType>, labels: &[u64], ids: &[u64]) -> Result<bool> {
        debug_assert!(labels.len() <= BLOCK && ids.len() == labels.len() * kind.nodes);
        if self.passes_over {
            self.ledger.ghost_elements += labels.len() as u64;
            self.mark_used(ids);
            return Ok(true);
        }
        let Class::Measured { shape, corners, .. } = &kind.class else { return Ok(false) };
        macro_rules! with_corners {
            ($($count:literal),*) => {
                $(if let Ok(corners) = (*corners).try_into() {
                    return self.block_by::<$count>(kind, *shape, corners, labels, ids);
                })*
            };
        }
        with_corners!(4, 8, 3, 6, 5);
        unreachable!("no shape has {} corners", corners.len())
    }

    fn block_by<const CORNERS: usize>(
        &mut self,
        kind: &Arc<ElementType>,
        shape: Shape,
        corners: &[u8; CORNERS],
        labels: &[u64],
        ids: &[u64],
    ) -> Result<bool> {
        let mut rows = [[0u32; CORNERS]; BLOCK];
        let rows = &mut rows[..labels.len()];
        let known = if kind.nodes == CORNERS && *corners == IN_ORDER[..CORNERS] {
            self.nodes.rows_of(ids, rows.as_flattened_mut())
        } else {
            let mut chosen = [[0u64; CORNERS]; BLOCK];
            for (chosen, ids) in chosen.iter_mut().zip(ids.chunks_exact(kind.nodes)) {
                *chosen = corners.map(|corner| ids[usize::from(corner)]);
            }
            self.nodes.rows_of(chosen[..labels.len()].as_flattened(), rows.as_flattened_mut())
                && ids.iter().all(|id| self.nodes.row(*id).is_some())
        };
        if !known {
            return Ok(false);
        }
        if kind.nodes > CORNERS {
            self.mark_used(ids);
        }
        self.nodes.mark_all_used(rows.as_flattened());
        self.ledger.repeated_nodes += u64::from(at_widest(Repeats(rows)));
        self.count_run(kind, labels.len() as u64);
        let (mut labels, mut rows) = (labels, &*rows);
        while !labels.is_empty() {
            let chunk = self.open(shape)?;
            let step = labels.len().min(chunk.room());
            chunk.extend(&labels[..step], rows[..step].as_flattened());
            self.tag(shape, step);
            (labels, rows) = (&labels[step..], &rows[step..]);
            self.hand_on_full(shape)?;
        }
        Ok(true)
    }

    /// Types come in long runs: the ledger hears of a run when it ends.
    #[inline]
    fn count_run(&mut self, kind: &Arc<ElementType>, elements: u64) {
        if self.types.get(self.current).is_none_or(|(known, _)| !Arc::ptr_eq(known, kind)) {
            self.change_type(kind);
        }
        self.run += elements;
    }

    fn change_type(&mut self, kind: &Arc<ElementType>) {
        self.end_run();
        self.current =
            self.types.iter().position(|(known, _)| Arc::ptr_eq(known, kind)).unwrap_or_else(|| {
                let row = self.ledger.row(&kind.name, &kind.class);
                self.types.push((Arc::clone(kind), row));
                self.types.len() - 1
            });
    }

    fn end_run(&mut self) {
        if let Some((_, row)) = self.types.get(self.current) {
            self.ledger.types[*row].count += std::mem::take(&mut self.run);
        }
    }

    /// Notes that nodes are used: those of a long element that is not measured, whose first nodes came with
    /// [`Self::element`].
    pub fn mark_used(&mut self, ids: &[u64]) {
        ids.iter().filter_map(|id| self.nodes.row(*id)).for_each(|row| self.nodes.mark_used(row));
    }

    /// Says whether the elements that follow are ghosts: another partition's, which has them too, or such that the file
    /// hides. They are left out and counted.
    #[inline]
    pub fn ghosts(&mut self, are_ghosts: bool) {
        self.passes_over = are_ghosts;
    }

    /// Counts elements of a type that is not measured, where their nodes are not known.
    pub fn count(&mut self, kind: &ElementType, count: u64) {
        self.ledger.count(kind, count);
    }

    #[inline]
    fn measured(&mut self, label: u64, shape: Shape, corners: &[u8], ids: &[u64]) -> Result<()> {
        /// One number of corners after another, so that each has loops of known length.
        macro_rules! with_corners {
            ($($count:literal),*) => {
                $(if let Ok(corners) = corners.try_into() {
                    return self.measured_by::<$count>(label, shape, corners, ids);
                })*
            };
        }
        with_corners!(4, 8, 3, 6, 5);
        unreachable!("no shape has {} corners", corners.len())
    }

    #[inline]
    fn measured_by<const CORNERS: usize>(
        &mut self,
        label: u64,
        shape: Shape,
        corners: &[u8; CORNERS],
        ids: &[u64],
    ) -> Result<()> {
        let mut rows = [0u32; CORNERS];
        for (row, corner) in rows.iter_mut().zip(corners) {
            let Some(&id) = ids.get(*corner as usize) else {
                return Err(Error::malformed(format!("{CORNERS} nodes or more"), format!("{}", ids.len())));
            };
            match self.nodes.row(id) {
                Some(known) => *row = known,
                None => return self.missing(label, id),
            }
        }
        if ids.len() > CORNERS {
            for id in ids {
                match self.nodes.row(*id) {
                    Some(row) => self.nodes.mark_used(row),
                    None => return self.missing(label, *id),
                }
            }
        }
        rows.iter().for_each(|row| self.nodes.mark_used(*row));
        self.ledger.repeated_nodes += u64::from(has_repeats(&rows));
        self.push(label, shape, &rows)
    }

    #[inline(always)]
    fn push(&mut self, label: u64, shape: Shape, rows: &[u32]) -> Result<()> {
        self.open(shape)?.push(label, rows);
        self.tag(shape, 1);
        self.hand_on_full(shape)
    }

    /// Tags the elements that were added last, where somebody asked for it.
    #[inline(always)]
    fn tag(&mut self, shape: Shape, count: usize) {
        if let (Some(tags), Some(chunk)) = (&mut self.tags, &mut self.open[shape.index()]) {
            for _ in 0..count {
                chunk.tag(tags.next);
                tags.next.ordinal += 1;
            }
        }
    }

    /// The open chunk of a shape.
    #[inline(always)]
    fn open(&mut self, shape: Shape) -> Result<&mut Chunk> {
        match &mut self.open[shape.index()] {
            Some(chunk) => Ok(chunk),
            slot => {
                let mut chunk = self.chunks.empty()?;
                chunk.reset(shape, self.origin);
                self.origin.chunk += 1;
                Ok(slot.insert(chunk))
            }
        }
    }

    #[inline(always)]
    fn hand_on_full(&mut self, shape: Shape) -> Result<()> {
        match self.open[shape.index()].take_if(|chunk| chunk.is_full()) {
            Some(full) => self.chunks.hand_on(full),
            None => Ok(()),
        }
    }

    #[cold]
    fn missing(&mut self, element: u64, node: u64) -> Result<()> {
        if self.allow_missing {
            self.ledger.missing_nodes += 1;
            return Ok(());
        }
        Err(Error::new(Kind::MissingNode { element, node }))
    }

    /// Ends the piece: hands on what is left and says what was met. The number of chunks comes with it.
    pub fn finish(mut self) -> Result<(Ledger, u32)> {
        self.end_run();
        for slot in &mut self.open {
            if let Some(chunk) = slot.take() {
                self.chunks.hand_on(chunk)?;
            }
        }
        Ok((self.ledger, self.origin.chunk))
    }
}

impl Tags<'_> {
    #[cold]
    fn enter(&mut self, key: u64, name: impl FnOnce() -> String) -> Result<()> {
        self.next.region = match self.known.get(&key) {
            Some(number) => *number,
            None => {
                let name = name();
                let number = if name.is_empty() { NO_REGION } else { self.regions.number(name)? };
                *self.known.entry(key).or_insert(number)
            }
        };
        self.key = Some(key);
        Ok(())
    }
}

/// How many of at most [`BLOCK`] elements name a row twice.
struct Repeats<'a, const CORNERS: usize>(&'a [[u32; CORNERS]]);

impl<const CORNERS: usize> Wide for Repeats<'_, CORNERS> {
    type Output = u32;

    #[inline(always)]
    fn run(self) -> u32 {
        self.0.iter().fold(0, |count, rows| count + u32::from(has_repeats(rows)))
    }
}

/// Whether some row comes twice.
#[inline(always)]
fn has_repeats<const CORNERS: usize>(rows: &[u32; CORNERS]) -> bool {
    let mut repeats = false;
    for (i, row) in rows.iter().enumerate() {
        for other in &rows[..i] {
            repeats |= row == other;
        }
    }
    repeats
}
