//! Nodes, elements and sets by number and name, within the run's budget of memory.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::Belonging;
use super::elements::Rows;
use super::sets::{Ranges, Set, SetHead};
use crate::error::{Error, Result};
use crate::formats::abaqus::assembly::Block;
use crate::formats::abaqus::elements::ElementLines;
use crate::formats::abaqus::nodes::NodeLines;
use crate::formats::abaqus::placement::Placement;
use crate::formats::abaqus::types::Kind;
use crate::formats::{NodeBatch, NodeLayout};
use crate::input::{Budget, Source};

/// About what a node takes, and an element without its nodes.
const NODE_BYTES: u64 = 72;
const ELEMENT_BYTES: u64 = 96;

/// What keywords draw on.
#[derive(Default)]
pub(super) struct Tables {
    nodes: HashMap<u64, [f64; 3]>,
    elements: HashMap<u64, (Kind, Box<[u64]>)>,
    /// Elements that `*ELGEN` made; they are not listed one by one.
    pub(super) rows: Vec<Arc<Rows>>,
    pub(super) node_sets: HashMap<Vec<u8>, Set>,
    pub(super) element_sets: HashMap<Vec<u8>, Set>,
    pub(super) budget: Option<Budget>,
    taken: u64,
}

impl Tables {
    /// Takes memory of the run's budget.
    pub(super) fn take(&mut self, bytes: u64) -> Result<()> {
        if self.budget.as_ref().is_some_and(|budget| !budget.take(bytes)) {
            return Err(Error::limit(
                "memory for what *NGEN, *NFILL, *NCOPY, *ELGEN and *ELCOPY draw on",
                "the run's budget",
            ));
        }
        self.taken += bytes;
        Ok(())
    }

    pub(super) fn add_node(&mut self, id: u64, point: [f64; 3]) -> Result<()> {
        self.take(NODE_BYTES)?;
        self.nodes.insert(id, point);
        Ok(())
    }

    pub(super) fn add_element(&mut self, label: u64, kind: &Kind, ids: &[u64]) -> Result<()> {
        self.take(ELEMENT_BYTES + 8 * ids.len() as u64)?;
        self.elements.insert(label, (kind.clone(), ids.into()));
        Ok(())
    }

    /// Where a node stands.
    pub(super) fn node(&self, id: u64) -> Result<[f64; 3]> {
        let known = self.nodes.get(&id).copied();
        known.ok_or_else(|| Error::malformed("a node that is defined before", format!("node {id}")))
    }

    /// An element's type and nodes.
    pub(super) fn element(&mut self, label: u64) -> Result<(Kind, Vec<u64>)> {
        if !self.elements.contains_key(&label) {
            self.list_rows()?;
        }
        let known = self.elements.get(&label).map(|(kind, ids)| (kind.clone(), ids.to_vec()));
        known.ok_or_else(|| Error::malformed("an element that is defined before", format!("element {label}")))
    }

    /// Lists the elements of rows one by one.
    fn list_rows(&mut self) -> Result<()> {
        let mut ids = Vec::new();
        for rows in std::mem::take(&mut self.rows) {
            for place in 1..rows.count() {
                let label = rows.at(place, &mut ids);
                self.add_element(label, &rows.kind, &ids)?;
            }
        }
        Ok(())
    }

    pub(super) fn read_nodes(&mut self, block: &Block<Placement>, set: Option<&[u8]>) -> Result<()> {
        let lines = NodeLines { source: Arc::clone(&block.source), placement: block.what, scope: 0 };
        let mut batch = NodeBatch::default();
        for span in &block.spans {
            batch.clear();
            let done = lines.decode(span.clone(), &mut batch);
            done.map_err(|e| block.source.place(e, batch.at))?;
            for (id, point) in batch.ids().iter().zip(batch.rows()) {
                self.add_node(*id, *point)?;
            }
            if let Some(set) = set {
                let ranges = self.ranges_of(batch.ids())?;
                self.node_sets.entry(set.to_vec()).or_default().add(ranges);
            }
        }
        Ok(())
    }

    pub(super) fn read_elements(&mut self, block: &Block<Kind>, set: Option<&[u8]>) -> Result<()> {
        let kind = &block.what;
        let lines = ElementLines {
            source: Arc::clone(&block.source),
            kind: kind.clone(),
            belonging: Belonging { owner: None, set: None, sets: Arc::default() },
            scope: 0,
            instances: None,
        };
        for span in &block.spans {
            let mut labels = Vec::new();
            lines.each(span.clone(), |label, ids| {
                labels.push(label);
                self.add_element(label, kind, ids)
            })?;
            if let Some(set) = set {
                let ranges = self.ranges_of(&labels)?;
                self.element_sets.entry(set.to_vec()).or_default().add(ranges);
            }
        }
        Ok(())
    }

    pub(super) fn read_set(&mut self, head: &SetHead, source: &Source, range: Range<u64>) -> Result<()> {
        let sets = if head.of_nodes { &self.node_sets } else { &self.element_sets };
        let ranges = head.read(source, range, sets)?;
        self.take(ranges.as_ref().map_or(0, |ranges| 24 * ranges.len() as u64))?;
        let sets = if head.of_nodes { &mut self.node_sets } else { &mut self.element_sets };
        sets.entry(head.name.clone()).or_default().add_as(ranges, head.unsorted);
        Ok(())
    }

    /// Numbers as ranges.
    fn ranges_of(&mut self, numbers: &[u64]) -> Result<Ranges> {
        let mut ranges = Ranges::new();
        for &number in numbers {
            match ranges.last_mut() {
                Some([_, last, 1]) if *last + 1 == number => *last = number,
                _ => ranges.push([number, number, 1]),
            }
        }
        self.take(24 * ranges.len() as u64)?;
        Ok(ranges)
    }

    /// The members of a set, in its order.
    pub(super) fn members(&mut self, of_nodes: bool, name: &[u8]) -> Result<Vec<u64>> {
        let sets = if of_nodes { &self.node_sets } else { &self.element_sets };
        let shown = name.escape_ascii();
        let Some(set) = sets.get(name) else {
            return Err(Error::malformed("a set that is defined before", format!("{shown}")));
        };
        let Some(count) = set.count() else {
            return Err(Error::unsupported(format!("the members of the set {shown} are not known")));
        };
        let set = set.clone();
        self.take(8 * count)?;
        Ok(set.members())
    }
}

impl Drop for Tables {
    fn drop(&mut self) {
        if let Some(budget) = &self.budget {
            budget.give_back(self.taken);
        }
    }
}
