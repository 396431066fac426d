//! Statistics: numbers in, moments and bins out. They know no mesh and no measure.
//!
//! Two kinds of sums are kept apart. Counts are whole numbers: they may be added in any order, so each thread keeps
//! its own. Means, deviations and co-moments are doubles, whose last bits depend on the order: they are merged in the
//! order of the file, along a tree that does not depend on threads.

mod distance;
mod distribution;
mod lanes;
mod moments;
mod spread;
mod tally;
mod tree;

pub use distance::{Shift, shift};
pub use distribution::{BINS, Distribution};
pub use lanes::sum;
pub use moments::{Extremes, MOST, Moments};
pub use spread::{QUANTILES, Spread};
pub use tree::Tree;
