//! GRID cards.

use std::ops::Range;
use std::sync::Arc;

use super::fields::Fields;
use super::lines::Cards;
use super::systems::Systems;
use crate::error::Result;
use crate::formats::{NodeBatch, NodeLayout};
use crate::input::{Source, Spot};

/// The name of the card.
pub(super) const GRID: &[u8; 8] = b"GRID    ";

/// A node in a system of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub(super) id: u64,
    /// The system; `None` stands for that of GRDSET.
    pub(super) system: Option<u64>,
    pub(super) point: [f64; 3],
}

impl Grid {
    /// The node of a card whose first line is `line`.
    #[inline]
    pub(super) fn read<'w>(line: &'w [u8], cards: &mut Cards<'w>, fields: &mut Fields<'w>) -> Result<Grid> {
        fields.read(line, cards, 5)?;
        Ok(Grid {
            id: fields.positive(0, "a node number")?,
            system: fields.optional(1, "the number of a coordinate system")?,
            point: fields.point(2)?,
        })
    }
}

/// Decodes the GRID cards of a stretch.
pub(super) struct Grids {
    pub(super) source: Arc<Source>,
    pub(super) systems: Arc<Systems>,
}

impl NodeLayout for Grids {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut NodeBatch) -> Result<()> {
        let window = self.source.window(span.clone());
        let (mut cards, mut fields) = (Cards::new(&window), Fields::new());
        while let Some((name, line)) = cards.next_card() {
            if name != *GRID {
                continue;
            }
            out.at = Spot::Text(span.start + cards.at as u64);
            let grid = Grid::read(line, &mut cards, &mut fields)?;
            out.push(grid.id, self.systems.to_basic(grid.system, grid.point)?)?;
        }
        Ok(())
    }
}
