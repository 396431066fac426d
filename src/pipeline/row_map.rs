//! A small map from rows of the node table to places among the rows that one piece of elements uses.

/// An open hash table that keeps its room.
#[derive(Debug, Default)]
pub(super) struct RowMap {
    /// Row + 1, or 0; and what the row was given.
    slots: Vec<(u32, u32)>,
    /// The rows, in the order in which they came.
    rows: Vec<u32>,
}

impl RowMap {
    /// Takes in a row, if it is new.
    #[inline]
    pub(super) fn insert(&mut self, row: u32) {
        if self.slots.len() < 2 * (self.rows.len() + 1) {
            self.grow();
        }
        let slot = self.slot(row);
        if self.slots[slot].0 == 0 {
            self.slots[slot] = (row + 1, self.rows.len() as u32);
            self.rows.push(row);
        }
    }

    /// How many rows came before this one, which must have been taken in.
    #[inline]
    pub(super) fn place(&self, row: u32) -> u32 {
        self.slots[self.slot(row)].1
    }

    /// The rows that were taken in.
    pub(super) fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Forgets all rows.
    pub(super) fn clear(&mut self) {
        self.slots.fill((0, 0));
        self.rows.clear();
    }

    /// Where a row is, or where it would be.
    #[inline]
    fn slot(&self, row: u32) -> usize {
        let mask = self.slots.len() - 1;
        // The upper bits of the product depend on all bits of the row.
        let mut slot = (u64::from(row).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        while self.slots[slot].0 != 0 && self.slots[slot].0 != row + 1 {
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        let room = (2 * self.slots.len()).max(1 << 12);
        self.slots.clear();
        self.slots.resize(room, (0, 0));
        for (place, row) in std::mem::take(&mut self.rows).into_iter().zip(0..) {
            let slot = self.slot(place);
            self.slots[slot] = (place + 1, row);
            self.rows.push(place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_places_in_which_they_came() {
        let mut map = RowMap::default();
        for _ in 0..2 {
            for k in 0..20_000u32 {
                map.insert(k.wrapping_mul(2_654_435_761) >> 1);
                map.insert(k.wrapping_mul(2_654_435_761) >> 1);
            }
            assert_eq!(map.rows().len(), 20_000);
            assert!(map.rows().iter().zip(0..).all(|(row, place)| map.place(*row) == place));
            map.clear();
        }
        map.insert(u32::MAX - 1);
        assert_eq!(map.place(u32::MAX - 1), 0);
    }
}
