//! Reading a dataset in slabs of bounded size, in the order of its entries: chunk after chunk where the chunks are whole
//! rows, so that each is unpacked once.

use hdf5_reader::messages::layout::DataLayout;
use hdf5_reader::{H5Type, SliceInfo, SliceInfoElem};

use super::Dataset;
use crate::error::{Error, Result};
use crate::formats::array::Number;

/// Bytes that a slab aims at.
const SLAB: u64 = 8 << 20;
/// Most bytes of a slab that is as high as the chunks.
const HIGHEST_SLAB: u64 = 32 << 20;

/// Where `count` numbers start, if the layout is one plain run of them that was written.
pub(super) fn plain_run(layout: &DataLayout, count: u64) -> Option<u64> {
    match layout {
        DataLayout::Contiguous { address, size } if *address < u64::MAX >> 1 && *size > 0 && count > 0 => {
            Some(*address)
        }
        _ => None,
    }
}

/// Reads all numbers of a dataset and hands them on in their order, as bytes in the machine's own byte order.
pub(super) fn read(
    dataset: &Dataset<'_>,
    number: Number,
    mut take: impl FnMut(&[u8]) -> Result<()>,
) -> Result<()> {
    each_slab(dataset, number.width(), |slab| {
        macro_rules! numbers {
            ($type:ty) => {
                bytemuck::cast_slice(&values::<$type>(dataset, slab)?).to_vec()
            };
        }
        let bytes: Vec<u8> = match number {
            Number::I8 => numbers!(i8),
            Number::U8 => numbers!(u8),
            Number::I16 => numbers!(i16),
            Number::U16 => numbers!(u16),
            Number::I32 => numbers!(i32),
            Number::U32 => numbers!(u32),
            Number::I64 => numbers!(i64),
            Number::U64 => numbers!(u64),
            Number::F32 => numbers!(f32),
            Number::F64 => numbers!(f64),
        };
        take(&bytes)
    })
}

fn values<T: H5Type>(dataset: &Dataset<'_>, slab: &SliceInfo) -> Result<Vec<T>> {
    let found = dataset.inner.read_slice::<T>(slab).map_err(|error| dataset.wrong(error))?;
    let expected = found.len();
    let (values, offset) = found.into_raw_vec_and_offset();
    if offset.unwrap_or(0) != 0 || values.len() != expected {
        return Err(dataset.malformed("a slab of numbers", "another arrangement"));
    }
    Ok(values)
}

/// Goes through a dataset slab by slab: of the outer dimensions one index each, of one dimension a run of indices, of
/// the inner ones all.
fn each_slab(
    dataset: &Dataset<'_>,
    width: u64,
    mut slab: impl FnMut(&SliceInfo) -> Result<()>,
) -> Result<()> {
    let shape = dataset.shape();
    if shape.contains(&0) {
        return Ok(());
    }
    // A dataset without dimensions is one number.
    if shape.is_empty() {
        return slab(&SliceInfo { selections: Vec::new() });
    }
    let too_large = || dataset.placed(Error::limit(format!("the size of {}", dataset.name()), "2^63 bytes"));
    let bytes = shape.iter().try_fold(width, |all, n| all.checked_mul(*n));
    bytes.filter(|bytes| *bytes < 1 << 63).ok_or_else(too_large)?;
    let inner = |axis: usize| shape[axis + 1..].iter().product::<u64>() * width;
    let axis = (0..shape.len()).find(|axis| inner(*axis) <= SLAB).unwrap_or(shape.len() - 1);
    let step = step(inner(axis), chunk_rows(dataset, axis));
    let mut outer = vec![0; axis];
    loop {
        let mut from = 0;
        while from < shape[axis] {
            let to = shape[axis].min(from.saturating_add(step));
            let mut selections: Vec<_> = outer.iter().map(|k| range(*k, k + 1)).collect();
            selections.push(range(from, to));
            selections.extend(shape[axis + 1..].iter().map(|n| range(0, *n)));
            slab(&SliceInfo { selections })?;
            from = to;
        }
        // The next index of the outer dimensions, the last one fastest.
        let Some(turn) = (0..axis).rev().find(|k| outer[*k] + 1 < shape[*k]) else { return Ok(()) };
        outer[turn] += 1;
        outer[turn + 1..].fill(0);
    }
}

fn range(start: u64, end: u64) -> SliceInfoElem {
    SliceInfoElem::Slice { start, end, step: 1 }
}

/// How many indices of a dimension one chunk spans.
fn chunk_rows(dataset: &Dataset<'_>, axis: usize) -> u64 {
    dataset.inner.chunks().and_then(|chunks| chunks.get(axis).copied()).map_or(1, u64::from).max(1)
}

/// How many rows make a slab: whole chunks where that is no matter of memory.
fn step(row_bytes: u64, chunk_rows: u64) -> u64 {
    let rows = (SLAB / row_bytes.max(1)).max(1);
    if chunk_rows <= rows {
        return rows - rows % chunk_rows;
    }
    if chunk_rows.saturating_mul(row_bytes) <= HIGHEST_SLAB { chunk_rows } else { rows }
}
