//! What was made, as pieces like any others: for each instance of a part it is a copy of its own.

use std::ops::Range;
use std::sync::Arc;

use super::elements::Rows;
use super::tables::Tables;
use super::{Belonging, Store};
use crate::error::{Error, Result};
use crate::formats::abaqus::fields::LARGEST_NUMBER;
use crate::formats::abaqus::placement::Affine;
use crate::formats::abaqus::types::Kind;
use crate::formats::binary::cut_records;
use crate::formats::{ElementLayout, ElementSink, NodeBatch, NodeLayout, Outline, Piece};
use crate::input::{Source, Spot};
use crate::mesh::{Class, Column, ColumnBuilder};

/// Nodes that one keyword made.
#[derive(Clone)]
pub(in crate::formats::abaqus) struct MadeNodes {
    /// Number and bits of x, y, z.
    rows: Arc<Column<[u64; 4]>>,
    source: Arc<Source>,
    at: u64,
}

/// Elements that one keyword made, of one type.
#[derive(Clone)]
pub(in crate::formats::abaqus) struct MadeElements {
    what: Elements,
    source: Arc<Source>,
    at: u64,
}

#[derive(Clone)]
enum Elements {
    Rows(Arc<Rows>),
    /// Number and nodes of each, one after another.
    Copies {
        kind: Kind,
        numbers: Arc<Column<u64>>,
        nodes: usize,
    },
}

/// Nodes that are being made.
pub(super) struct NodeRows<'s> {
    rows: ColumnBuilder<[u64; 4]>,
    store: &'s Store<'s>,
}

impl<'s> NodeRows<'s> {
    pub(super) fn new(store: &'s Store<'s>) -> Self {
        Self { rows: ColumnBuilder::new(store.budget, store.scratch), store }
    }

    /// Adds a node, to the tables too.
    pub(super) fn push(&mut self, tables: &mut Tables, id: u64, point: [f64; 3]) -> Result<()> {
        if !(1..=LARGEST_NUMBER).contains(&id) {
            return Err(Error::malformed(format!("node numbers from 1 to {LARGEST_NUMBER}"), id.to_string()));
        }
        tables.add_node(id, point)?;
        let [x, y, z] = point.map(f64::to_bits);
        self.rows.extend(&[[id, x, y, z]])
    }

    pub(super) fn finish(self) -> Result<MadeNodes> {
        let rows = Arc::new(self.rows.finish()?);
        Ok(MadeNodes { rows, source: Arc::clone(self.store.source), at: self.store.at })
    }
}

impl MadeNodes {
    /// Yields the nodes as those of an instance.
    pub(in crate::formats::abaqus) fn yield_to(
        &self,
        out: &mut dyn Outline,
        scope: u64,
        motion: Affine,
    ) -> Result<()> {
        let layout = Arc::new(Placed { made: self.clone(), scope, motion });
        cut_records(self.rows.rows().len() as u64, 32, |span| {
            out.nodes(Piece { layout: layout.clone(), span })
        })
    }
}

/// Nodes of an instance; a span is a range of their places.
struct Placed {
    made: MadeNodes,
    scope: u64,
    motion: Affine,
}

impl NodeLayout for Placed {
    fn source(&self) -> &Source {
        &self.made.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        out.at = Spot::Text(self.made.at);
        for [id, x, y, z] in &self.made.rows.rows()[span.start as usize..span.end as usize] {
            out.push(self.scope | id, self.motion.apply([x, y, z].map(|bits| f64::from_bits(*bits))))?;
        }
        Ok(())
    }
}

/// Copies of elements that are being made, by type and number of nodes.
pub(super) struct Copies<'s> {
    groups: Vec<(Kind, usize, ColumnBuilder<u64>)>,
    store: &'s Store<'s>,
}

impl<'s> Copies<'s> {
    pub(super) fn new(store: &'s Store<'s>) -> Self {
        Self { groups: Vec::new(), store }
    }

    pub(super) fn push(&mut self, label: u64, kind: &Kind, ids: &[u64]) -> Result<()> {
        let known = self
            .groups
            .iter()
            .rposition(|(of, nodes, _)| Arc::ptr_eq(&of.of, &kind.of) && *nodes == ids.len());
        let place = known.unwrap_or_else(|| {
            let numbers = ColumnBuilder::new(self.store.budget, self.store.scratch);
            self.groups.push((kind.clone(), ids.len(), numbers));
            self.groups.len() - 1
        });
        let numbers = &mut self.groups[place].2;
        numbers.extend(&[label])?;
        numbers.extend(ids)
    }

    pub(super) fn finish(self) -> Result<Vec<MadeElements>> {
        let Self { groups, store } = self;
        let made = groups.into_iter().map(|(kind, nodes, numbers)| {
            let what = Elements::Copies { kind, numbers: Arc::new(numbers.finish()?), nodes };
            Ok(MadeElements { what, source: Arc::clone(store.source), at: store.at })
        });
        made.collect()
    }
}

impl MadeElements {
    pub(super) fn rows(store: &Store<'_>, at: u64, rows: Arc<Rows>) -> Self {
        Self { what: Elements::Rows(rows), source: Arc::clone(store.source), at }
    }

    /// Yields the elements as those of an instance.
    pub(in crate::formats::abaqus) fn yield_to(
        &self,
        out: &mut dyn Outline,
        scope: u64,
        belonging: Belonging,
    ) -> Result<()> {
        let layout = Arc::new(Scoped { made: self.clone(), scope, belonging });
        // Of so many that are only counted nobody looks at the nodes.
        if let Elements::Rows(rows) = &self.what
            && matches!(rows.kind.of.class, Class::Counted(_))
            && rows.count() > 1 << 20
        {
            return out.count(&rows.kind.of, rows.count() - 1);
        }
        // The master of rows is an element already.
        let (first, count, nodes) = match &self.what {
            Elements::Rows(rows) => (1, rows.count(), rows.kind.of.nodes),
            Elements::Copies { numbers, nodes, .. } => {
                (0, (numbers.rows().len() / (nodes + 1)) as u64, *nodes)
            }
        };
        cut_records(count - first, 8 * (nodes as u64 + 1), |span| {
            out.elements(Piece { layout: layout.clone(), span: span.start + first..span.end + first })
        })
    }
}

/// Elements of an instance; a span is a range of their places.
struct Scoped {
    made: MadeElements,
    scope: u64,
    belonging: Belonging,
}

impl ElementLayout for Scoped {
    fn source(&self) -> &Source {
        &self.made.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        out.at = Spot::Text(self.made.at);
        let sets = self.belonging.begin(out)?;
        let mut ids = Vec::new();
        for place in span {
            let (label, kind) = match &self.made.what {
                Elements::Rows(rows) => (rows.at(place, &mut ids), &rows.kind),
                Elements::Copies { kind, numbers, nodes } => {
                    let from = place as usize * (nodes + 1);
                    let record = &numbers.rows()[from..=from + nodes];
                    ids.clear();
                    ids.extend_from_slice(&record[1..]);
                    (record[0], kind)
                }
            };
            if let Some(sets) = &sets {
                self.belonging.enter(sets, label, out)?;
            }
            ids.iter_mut().for_each(|id| *id |= self.scope);
            out.element(label, &kind.of, &ids).map_err(crate::formats::abaqus::elements::plain_number)?;
        }
        Ok(())
    }
}
