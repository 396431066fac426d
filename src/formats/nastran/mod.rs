//! Nastran bulk data (`.bdf`, `.dat`, `.nas`), as MSC, NX, OptiStruct, Femap, Patran and Gmsh write it.
//!
//! Cards stand in any order, so a stretch of the file may hold nodes, elements and whatever else at once: it is yielded
//! as a piece of nodes, of elements, or of both, and each layout skips the other's cards. What stands before
//! `BEGIN BULK` is forgotten once that line is met; a punch file has none. Coordinate systems are collected before the
//! first node is decoded, for they may stand after the nodes that use them. Refused by name: replicated cards (`=`),
//! superelement sections, includes by logical symbols, continuations out of order.

mod cards;
mod detect;
mod elements;
mod fields;
mod frame;
mod grids;
mod include;
mod lines;
mod systems;
mod walk;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::formats::{Format, Outline, Piece};
use crate::input::{Input, Spot};
use crate::mesh::Shape;

use elements::Elements;
use grids::Grids;
use systems::Systems;
use walk::Walk;

/// What some editors put before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Nastran bulk data.
pub struct Nastran;

impl Format for Nastran {
    fn name(&self) -> &'static str {
        "nastran"
    }

    fn title(&self) -> &'static str {
        "Nastran bulk data: small, large and free field, whole decks and punch files, with includes"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["bdf", "nas", "dat", "fem", "pch"]
    }

    fn looks_for(&self) -> &'static str {
        "BEGIN BULK, or cards as GRID and CTETRA"
    }

    fn detect(&self, head: &[u8]) -> bool {
        detect::is_bulk_data(head)
    }

    fn own_orientation(&self) -> &'static [Shape] {
        // Decks whose CHEXA all stand the other way round than their CPENTA are in use.
        &[Shape::Hexahedron]
    }

    fn regions(&self) -> Option<&'static str> {
        Some("property numbers")
    }

    fn outline(&self, input: &Input, out: &mut dyn Outline) -> Result<()> {
        let stretches = Walk::of(input)?;
        let end = |expected: &str| {
            let error = Error::malformed(expected, "the end of the file");
            input.source.place(error, Spot::Text(input.source.len()))
        };
        if !stretches.iter().any(|s| s.holds.nodes) {
            return Err(end("GRID cards"));
        }
        if !stretches.iter().any(|s| s.holds.elements) {
            // ENDDATA may be missing: a deck without elements was cut off, or is a part of another.
            return Err(end("element cards, as CTETRA or CQUAD4"));
        }
        let systems = Arc::new(Systems::collect(&stretches)?);
        for stretch in stretches {
            let (source, span) = (&stretch.source, stretch.span);
            if stretch.holds.nodes {
                let layout = Arc::new(Grids { source: Arc::clone(source), systems: Arc::clone(&systems) });
                out.nodes(Piece { layout, span: span.clone() })?;
            }
            if stretch.holds.elements {
                out.elements(Piece { layout: Arc::new(Elements { source: Arc::clone(source) }), span })?;
            }
        }
        Ok(())
    }
}
