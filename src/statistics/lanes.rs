//! Values of a block combined in eight lanes: the order in which numbers are added is the same on every machine, and as
//! wide as the widest.

use std::hint::black_box;

/// Number of lanes.
pub(super) const STRIDE: usize = 8;
/// Rows of values that are combined in one go, and how many values that is.
const ROWS: usize = 8;
const STEP: usize = ROWS * STRIDE;

/// Combines each lane with the values at its places: those at 0, 8, 16 and so on go to the first lane, in this order.
///
/// All lanes are written out and stored together: eight neighbours that are stored are what the compiler makes a vector
/// from. In a loop, or kept in registers, they would stay single numbers.
#[inline(always)]
fn combine<const ROWS: usize>(
    lanes: &mut [f64; STRIDE],
    value: impl Fn(usize) -> f64,
    into: impl Fn(f64, f64) -> f64,
) {
    let before = *lanes;
    let all = |lane: usize| (0..ROWS).fold(before[lane], |all, row| into(all, value(row * STRIDE + lane)));
    *lanes = [all(0), all(1), all(2), all(3), all(4), all(5), all(6), all(7)];
    black_box(lanes);
}

/// The sum of the lanes.
#[inline(always)]
fn fold(s: [f64; STRIDE]) -> f64 {
    ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]))
}

/// A sum in a fixed order.
#[inline(always)]
pub fn sum(values: &[f64]) -> f64 {
    let (steps, rows, rest) = cut(values);
    let mut sums = [0.0; STRIDE];
    for step in steps {
        combine::<ROWS>(&mut sums, |k| step[k], |sum, value| sum + value);
    }
    for row in rows {
        combine::<1>(&mut sums, |k| row[k], |sum, value| sum + value);
    }
    fold(sums) + rest.iter().sum::<f64>()
}

/// Sum of products of deviations in a fixed order.
#[inline(always)]
pub(super) fn sum_of_products(x: &[f64], mean_x: f64, y: &[f64], mean_y: f64) -> f64 {
    let ((x_steps, x_rows, x_rest), (y_steps, y_rows, y_rest)) = (cut(x), cut(y));
    let product = |x: f64, y: f64| (x - mean_x) * (y - mean_y);
    let mut sums = [0.0; STRIDE];
    for (x, y) in x_steps.iter().zip(y_steps) {
        combine::<ROWS>(&mut sums, |k| product(x[k], y[k]), |sum, product| sum + product);
    }
    for (x, y) in x_rows.iter().zip(y_rows) {
        combine::<1>(&mut sums, |k| product(x[k], y[k]), |sum, product| sum + product);
    }
    fold(sums) + x_rest.iter().zip(y_rest).map(|(x, y)| product(*x, *y)).sum::<f64>()
}

/// The smallest and the largest value; plus and minus infinity where there is none.
#[inline(always)]
pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    let (smaller, larger) =
        (|a: f64, b: f64| if b < a { b } else { a }, |a: f64, b: f64| if b > a { b } else { a });
    let (steps, rows, rest) = cut(values);
    let (mut min, mut max) = ([f64::INFINITY; STRIDE], [f64::NEG_INFINITY; STRIDE]);
    for step in steps {
        combine::<ROWS>(&mut min, |k| step[k], smaller);
        combine::<ROWS>(&mut max, |k| step[k], larger);
    }
    for row in rows {
        combine::<1>(&mut min, |k| row[k], smaller);
        combine::<1>(&mut max, |k| row[k], larger);
    }
    let min = min.iter().chain(rest).copied().fold(f64::INFINITY, smaller);
    (min, max.iter().chain(rest).copied().fold(f64::NEG_INFINITY, larger))
}

/// Whole steps, then whole rows, then what is left.
#[inline(always)]
fn cut(values: &[f64]) -> (&[[f64; STEP]], &[[f64; STRIDE]], &[f64]) {
    let (steps, rest) = values.as_chunks();
    let (rows, rest) = rest.as_chunks();
    (steps, rows, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One after another, each in its lane.
    fn plain(values: impl Iterator<Item = f64>) -> f64 {
        let values: Vec<f64> = values.collect();
        let (rows, rest) = values.as_chunks::<STRIDE>();
        let mut sums = [0.0; STRIDE];
        for row in rows {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += value;
            }
        }
        fold(sums) + rest.iter().sum::<f64>()
    }

    #[test]
    fn blocks_of_every_length_add_in_the_same_order() {
        let x: Vec<f64> = (0..200).map(|k| (f64::from(k) * 1.3).sin() - 0.3).collect();
        let y: Vec<f64> = (0..200).map(|k| (f64::from(k) * 0.7).cos() * 1e3).collect();
        for n in 0..=200 {
            let (x, y) = (&x[..n], &y[..n]);
            assert_eq!(sum(x).to_bits(), plain(x.iter().copied()).to_bits(), "{n}");
            let products = x.iter().zip(y).map(|(x, y)| (x - 0.1) * (y - 0.2));
            assert_eq!(sum_of_products(x, 0.1, y, 0.2).to_bits(), plain(products).to_bits(), "{n}");
            let min = x.iter().copied().fold(f64::INFINITY, f64::min);
            assert_eq!(extremes(x), (min, x.iter().copied().fold(f64::NEG_INFINITY, f64::max)), "{n}");
        }
    }
}
