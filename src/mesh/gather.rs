//! Brings the corners of elements from all over the node table side by side.
//!
//! It moves numbers and works out none. The unsafe code here reads rows whose places were checked for the whole block, eight
//! at a time: one after another, with a store for each number, it takes as long as a third of what is measured.

/// All x, all y, all z of one corner of many elements.
type Corner<const LANES: usize> = [[f64; LANES]; 3];

/// Puts the corners of a block of elements side by side: `rows` are the corners of an element after those of another, as
/// rows of `points`, for `LANES` elements or less; `out` has at least `CORNERS` corners. Lanes without an element keep
/// what they had.
///
/// # Panics
///
/// If a row is not in `points`.
pub fn gather<const CORNERS: usize, const LANES: usize>(
    rows: &[u32],
    points: &[[f64; 3]],
    out: &mut [Corner<LANES>],
) {
    let elements = rows.as_chunks::<CORNERS>().0;
    let done = gather_eights(elements, points, out);
    for (lane, rows) in elements.iter().enumerate().take(LANES).skip(done) {
        for (row, corner) in rows.iter().zip(out.iter_mut()) {
            let point = &points[*row as usize];
            corner[0][lane] = point[0];
            corner[1][lane] = point[1];
            corner[2][lane] = point[2];
        }
    }
}

/// Gathers eight elements at a time where the machine can; says how many are done.
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "reads eight rows at once, whose places are checked once for all")]
fn gather_eights<const CORNERS: usize, const LANES: usize>(
    elements: &[[u32; CORNERS]],
    points: &[[f64; 3]],
    out: &mut [Corner<LANES>],
) -> usize {
    use std::arch::x86_64::{
        __m512d, _mm256_maskz_loadu_pd, _mm512_castpd256_pd512, _mm512_insertf64x4, _mm512_permutex2var_pd,
        _mm512_setr_epi64, _mm512_storeu_pd, _mm512_unpackhi_pd, _mm512_unpacklo_pd,
    };

    /// Rows k and k + 4 of eight, with zeros after their three numbers.
    ///
    /// # Safety
    ///
    /// Both rows must be in `points`.
    #[target_feature(enable = "avx512f,avx512vl")]
    unsafe fn two<const CORNERS: usize>(
        points: &[[f64; 3]],
        eight: &[[u32; CORNERS]; 8],
        corner: usize,
        k: usize,
    ) -> __m512d {
        let row = |k: usize| points.as_ptr().wrapping_add(eight[k][corner] as usize).cast::<f64>();
        // SAFETY: the rows are in `points`, and the mask keeps the load from what is behind them.
        let (low, high) =
            unsafe { (_mm256_maskz_loadu_pd(0b111, row(k)), _mm256_maskz_loadu_pd(0b111, row(k + 4))) };
        _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high)
    }

    /// # Safety
    ///
    /// All rows must be in `points`.
    #[target_feature(enable = "avx512f,avx512vl")]
    unsafe fn all<const CORNERS: usize, const LANES: usize>(
        eights: &[[[u32; CORNERS]; 8]],
        points: &[[f64; 3]],
        out: &mut [Corner<LANES>],
    ) {
        let first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
        let second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
        for (eight, at) in eights.iter().zip((0..LANES).step_by(8)) {
            for (corner, out) in out.iter_mut().enumerate().take(CORNERS) {
                // SAFETY: as the caller promises.
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| unsafe { two(points, eight, corner, k) });
                // x and z of rows 0, 1, 4, 5, and of 2, 3, 6, 7; then y of the same.
                let (xz, wx) = (_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d));
                let (y, v) = (_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
                let sides = [
                    _mm512_permutex2var_pd(xz, first, wx),
                    _mm512_permutex2var_pd(y, first, v),
                    _mm512_permutex2var_pd(xz, second, wx),
                ];
                for (out, side) in out.iter_mut().zip(sides) {
                    let eight = out[at..].first_chunk_mut::<8>().expect("the lanes are a multiple of eight");
                    // SAFETY: it is room for eight numbers.
                    unsafe { _mm512_storeu_pd(eight.as_mut_ptr(), side) };
                }
            }
        }
    }

    const { assert!(LANES.is_multiple_of(8)) };
    if !(is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")) {
        return 0;
    }
    let elements = &elements[..elements.len().min(LANES)];
    let last = elements.as_flattened().iter().copied().fold(0, u32::max);
    assert!((last as usize) < points.len() || elements.is_empty(), "row {last} of {}", points.len());
    let eights = elements.as_chunks::<8>().0;
    // SAFETY: the instructions were asked for, and no row is beyond the last.
    unsafe { all(eights, points, out) };
    8 * eights.len()
}

/// There is nothing faster than one after another.
#[cfg(not(target_arch = "x86_64"))]
fn gather_eights<const CORNERS: usize, const LANES: usize>(
    _: &[[u32; CORNERS]],
    _: &[[f64; 3]],
    _: &mut [Corner<LANES>],
) -> usize {
    0
}

/// Asks the processor for points that will be read soon.
#[inline(always)]
#[cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "prefetching takes a bare address"))]
pub fn prefetch(points: &[[f64; 3]], rows: &[u32]) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let start = points.as_ptr();
        for row in rows {
            let point = start.wrapping_add(*row as usize).cast::<i8>();
            // SAFETY: a prefetch reads nothing and faults nowhere, whatever the address. A point may lie in two lines.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(point);
                _mm_prefetch::<_MM_HINT_T0>(point.wrapping_add(size_of::<[f64; 3]>() - 1));
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (points, rows);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holds<const CORNERS: usize>() {
        let points: Vec<[f64; 3]> = (0..100).map(|k| [k, k + 1000, k + 2000].map(f64::from)).collect();
        for count in [0, 1, 7, 8, 9, 63, 64] {
            // The last row of the table comes too: nothing may be read behind it.
            let rows: Vec<u32> = (0..(count * CORNERS) as u32).map(|k| 99 - (k * 37) % 100).collect();
            let mut out = [[[-1.0; 64]; 3]; 8];
            gather::<CORNERS, 64>(&rows, &points, &mut out);
            for (lane, corner, axis) in
                (0..64).flat_map(|l| (0..8).flat_map(move |c| (0..3).map(move |a| (l, c, a))))
            {
                let there = lane < count && corner < CORNERS;
                let expected =
                    if there { points[rows[lane * CORNERS + corner] as usize][axis] } else { -1.0 };
                assert_eq!(out[corner][axis][lane], expected, "{CORNERS} corners, {count} elements");
            }
        }
    }

    #[test]
    fn every_lane_has_the_corners_of_its_element() {
        holds::<3>();
        holds::<4>();
        holds::<5>();
        holds::<6>();
        holds::<8>();
    }

    #[test]
    #[should_panic(expected = "3")]
    fn a_row_beyond_the_table_is_not_read() {
        gather::<4, 64>(&[0, 1, 2, 3].repeat(8), &[[0.0; 3]; 3], &mut [[[0.0; 64]; 3]; 4]);
    }
}
