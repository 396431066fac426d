//! Element cards.

use std::ops::Range;
use std::sync::Arc;

use super::cards::{self, Card, Counted, Measured};
use super::fields::Fields;
use super::lines::{Cards, Name};
use crate::error::Result;
use crate::formats::{ElementLayout, ElementSink, text};
use crate::input::{Source, Spot};
use crate::mesh::ElementType;

/// Decodes the element cards of a stretch.
pub(super) struct Elements {
    pub(super) source: Arc<Source>,
}

impl ElementLayout for Elements {
    fn source(&self) -> &Source {
        &self.source
    }

    fn decode(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<()> {
        let window = self.source.window(span.clone());
        let mut reader =
            Reader { cards: Cards::new(&window), fields: Fields::new(), ids: Vec::with_capacity(32) };
        let mut last = (*b"        ", None);
        while let Some((name, line)) = reader.cards.next_card() {
            if last.0 != name {
                last = (name, cards::element(&name));
            }
            out.at = Spot::Text(span.start + reader.cards.at as u64);
            match last.1 {
                Some(Card::Measured(card)) => reader.measured(card, line, out)?,
                Some(Card::Counted(card)) => reader.counted(card, line, out)?,
                None if cards::may_be_element(&name) => reader.unknown(&name, line, out)?,
                None => {}
            }
        }
        Ok(())
    }
}

struct Reader<'w> {
    cards: Cards<'w>,
    fields: Fields<'w>,
    ids: Vec<u64>,
}

impl<'w> Reader<'w> {
    #[inline]
    fn measured(&mut self, card: &Measured, line: &'w [u8], out: &mut ElementSink<'_>) -> Result<()> {
        self.fields.read(line, &mut self.cards, card.first + card.most)?;
        let label = self.fields.positive(0, "an element number")?;
        let kind = nodes(card, &self.fields, &mut self.ids)?;
        if out.wants_regions() {
            // A blank property is that of the element's own number.
            let property = text::integer(self.fields.get(1)).unwrap_or(label);
            out.region(property, || property.to_string())?;
        }
        out.element(label, kind, &self.ids)
    }

    /// Counts a card, and notes the nodes that it uses.
    fn counted(&mut self, card: &Counted, line: &'w [u8], out: &mut ElementSink<'_>) -> Result<()> {
        let wanted = card.nodes.last().map_or(1, |last| usize::from(*last) + 1);
        self.fields.read(line, &mut self.cards, wanted)?;
        let fields = &self.fields;
        self.ids.clear();
        self.ids.extend(card.nodes.iter().filter_map(|field| text::integer(fields.get(usize::from(*field)))));
        out.element(0, &card.kind, &self.ids)?;
        let Some(mut from) = card.rest else { return Ok(()) };
        loop {
            self.ids.clear();
            self.ids.extend(self.fields.cells().iter().skip(from).filter_map(|cell| text::integer(cell)));
            out.mark_used(&self.ids);
            let Some(line) = self.cards.continuation() else { return Ok(()) };
            from = self.fields.read_on(line)?;
        }
    }

    /// Counts a card that is not known under its own name, if it begins as elements do: with the numbers of itself, of
    /// its property and of two nodes.
    #[cold]
    fn unknown(&mut self, name: &Name, line: &'w [u8], out: &mut ElementSink<'_>) -> Result<()> {
        let is_number = |cell: &[u8]| text::integer(cell).is_some_and(|n| n > 0);
        if self.fields.read(line, &mut self.cards, 4).is_ok() && (0..4).all(|k| is_number(self.fields.get(k)))
        {
            out.count(&cards::unknown(name), 1);
        }
        Ok(())
    }
}

/// The nodes of a card and the type that they make it. A blank node between others is filled with a corner: what is not
/// a corner is only asked whether it exists.
#[inline]
fn nodes<'c>(card: &'c Measured, fields: &Fields<'_>, ids: &mut Vec<u64>) -> Result<&'c Arc<ElementType>> {
    ids.clear();
    let mut blank = false;
    for place in 0..card.most {
        let field = card.first + place;
        let id = match fields.get(field) {
            [] | b"0" if !card.corners.contains(&(place as u8)) => 0,
            _ => fields.positive(field, "a node number")?,
        };
        blank |= id == 0;
        ids.push(id);
    }
    if blank {
        let named = ids.iter().rposition(|id| *id > 0).map_or(0, |last| last + 1);
        ids.truncate(named);
        let filler = ids[0];
        ids.iter_mut().filter(|id| **id == 0).for_each(|id| *id = filler);
    }
    Ok(if ids.len() > card.corners.len() { &card.curved } else { &card.plain })
}
