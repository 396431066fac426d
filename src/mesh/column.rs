//! A column of equal rows that lives in memory while the budget lasts and in a mapped, unlinked scratch file after.
//! Readers see one slice either way.

use std::fs::File;
use std::marker::PhantomData;
use std::ops::Range;

use bytemuck::Pod;
use memmap2::{MmapMut, UncheckedAdvice};

use crate::error::{Error, Result};
use crate::input::{Budget, Scratch, ScratchFile, ScratchShare};

/// A column that is being filled.
#[derive(Debug)]
pub struct ColumnBuilder<T> {
    rows: Vec<T>,
    taken: u64,
    spilled: Option<ScratchFile>,
    len: usize,
    budget: Budget,
    scratch: Scratch,
}

/// A filled column: a slice, wherever it lives.
#[derive(Debug)]
pub struct Column<T> {
    store: Store<T>,
    /// What to give back to the budget in the end.
    taken: u64,
    budget: Budget,
}

#[derive(Debug)]
enum Store<T> {
    Memory(Vec<T>),
    /// The share of the scratch space goes back with the map.
    Mapped {
        map: MmapMut,
        rows: PhantomData<T>,
        _share: ScratchShare,
    },
}

impl<T: Pod> ColumnBuilder<T> {
    /// An empty column.
    pub fn new(budget: &Budget, scratch: &Scratch) -> Self {
        Self {
            rows: Vec::new(),
            taken: 0,
            spilled: None,
            len: 0,
            budget: budget.clone(),
            scratch: scratch.clone(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Appends rows.
    pub fn extend(&mut self, rows: &[T]) -> Result<()> {
        self.len += rows.len();
        if self.spilled.is_none() && !self.make_room(rows.len()) {
            let mut file = self.scratch.file()?;
            file.write(bytemuck::cast_slice(&self.rows))?;
            self.rows = Vec::new();
            self.budget.give_back(std::mem::take(&mut self.taken));
            self.spilled = Some(file);
        }
        match &mut self.spilled {
            Some(file) => file.write(bytemuck::cast_slice(rows)),
            None => {
                self.rows.extend_from_slice(rows);
                Ok(())
            }
        }
    }

    /// Ends filling.
    pub fn finish(mut self) -> Result<Column<T>> {
        // Room that was not needed was never touched.
        let unused = ((self.rows.capacity() - self.rows.len()) * size_of::<T>()) as u64;
        self.budget.give_back(unused.min(self.taken));
        let (budget, taken) = (self.budget.clone(), self.taken.saturating_sub(unused));
        match self.spilled.take() {
            None => Ok(Column { store: Store::Memory(self.rows), taken, budget }),
            Some(file) => Ok(Column { store: map(file.into_file()?)?, taken, budget }),
        }
    }

    /// Makes room for as many rows in all, if the budget has it and they are in memory: what is not touched costs nothing.
    pub fn expect(&mut self, rows: usize) {
        if self.spilled.is_none() && rows > self.rows.capacity() {
            self.grow(rows);
        }
    }

    /// Makes room in memory, if the budget has it.
    fn make_room(&mut self, more: usize) -> bool {
        let needed = self.rows.len() + more;
        // Half as much again: pages that are not touched yet cost nothing, and growing moves no bytes.
        needed <= self.rows.capacity()
            || self.grow(needed.max(self.rows.capacity() + self.rows.capacity() / 2))
    }

    fn grow(&mut self, capacity: usize) -> bool {
        let bytes = ((capacity - self.rows.capacity()) * size_of::<T>()) as u64;
        if !self.budget.take(bytes) {
            return false;
        }
        self.taken += bytes;
        self.rows.reserve_exact(capacity - self.rows.len());
        ask_for_huge_pages(&mut self.rows);
        true
    }
}

impl<T: Pod> Column<T> {
    /// `len` rows of zero bytes, to be filled in any order.
    pub fn zeroed(len: usize, budget: &Budget, scratch: &Scratch) -> Result<Self> {
        let bytes = (len * size_of::<T>()) as u64;
        if budget.take(bytes) {
            let rows = bytemuck::allocation::zeroed_vec(len);
            return Ok(Self { store: Store::Memory(rows), taken: bytes, budget: budget.clone() });
        }
        Ok(Self { store: map(scratch.zeroed(bytes)?)?, taken: 0, budget: budget.clone() })
    }

    /// The rows.
    #[inline]
    pub fn rows(&self) -> &[T] {
        match &self.store {
            Store::Memory(rows) => rows,
            Store::Mapped { map, .. } => bytemuck::cast_slice(map),
        }
    }

    /// Gives back the memory of rows that were looked at, where they are in a scratch file. They are still there.
    #[expect(
        unsafe_code,
        reason = "memmap2 calls giving pages back unchecked, as it would lose writes of a private map"
    )]
    pub fn release(&self, rows: Range<usize>) {
        if let Store::Mapped { map, .. } = &self.store {
            let end = (rows.end * size_of::<T>()).min(map.len());
            let start = (rows.start * size_of::<T>()).min(end);
            // SAFETY: the map is shared with its file: pages that are dropped come back from there with the same bytes.
            let _ = unsafe { map.unchecked_advise_range(UncheckedAdvice::DontNeed, start, end - start) };
        }
    }

    /// The rows, to be changed.
    pub fn rows_mut(&mut self) -> &mut [T] {
        match &mut self.store {
            Store::Memory(rows) => rows,
            Store::Mapped { map, .. } => bytemuck::cast_slice_mut(map),
        }
    }

    /// Whether the rows live in a scratch file.
    pub fn is_spilled(&self) -> bool {
        matches!(self.store, Store::Mapped { .. })
    }
}

impl<T> Drop for Column<T> {
    fn drop(&mut self) {
        self.budget.give_back(self.taken);
    }
}

/// Rows are read in the order of the elements' corners, all over the column: with pages of 4 KiB each look would cost a
/// search for its page too.
#[expect(unsafe_code, reason = "advice about memory takes a bare address")]
fn ask_for_huge_pages<T>(rows: &mut Vec<T>) {
    const PAGE: usize = 4096;
    let room = rows.spare_capacity_mut();
    let (start, bytes) = (room.as_mut_ptr().cast::<u8>(), size_of_val(room));
    let skip = start.align_offset(PAGE);
    if bytes.saturating_sub(skip) > 4 << 20 {
        // SAFETY: whole pages of memory that the vector owns; the advice changes no byte of them.
        let _ = unsafe {
            rustix::mm::madvise(
                start.wrapping_add(skip).cast(),
                (bytes - skip) / PAGE * PAGE,
                rustix::mm::Advice::LinuxHugepage,
            )
        };
    }
}

/// Maps a scratch file for reading and writing.
#[expect(unsafe_code, reason = "a map cannot be made safely: the file may change under it")]
fn map<T: Pod>((file, share): (File, ScratchShare)) -> Result<Store<T>> {
    if file.metadata().map_err(|e| Error::resource("scratch space", e))?.len() == 0 {
        return Ok(Store::Memory(Vec::new()));
    }
    // SAFETY: the file has no name any more and no other handle: nobody else can change it or cut it.
    let map = unsafe { MmapMut::map_mut(&file) }.map_err(|e| Error::resource("address space", e))?;
    Ok(Store::Mapped { map, rows: PhantomData, _share: share })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_the_same_in_memory_and_in_scratch() {
        let scratch = Scratch::new(&std::env::temp_dir(), 1 << 30);
        for budget in [0, 100, 1 << 20] {
            let budget = Budget::new(budget);
            let mut builder = ColumnBuilder::<u32>::new(&budget, &scratch);
            for i in 0..100u32 {
                builder.extend(&[i, 2 * i]).expect("scratch");
            }
            let column = builder.finish().expect("scratch");
            assert_eq!(column.rows().len(), 200);
            assert!(
                (0..100)
                    .all(|i| column.rows()[2 * i] == i as u32 && column.rows()[2 * i + 1] == 2 * i as u32)
            );
        }
    }
}
