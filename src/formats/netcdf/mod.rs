//! NetCDF files: variables by name, in the classic container ([`classic`]: CDF-1, CDF-2, CDF-5) or in HDF5 (NetCDF-4).

pub mod classic;
#[cfg(feature = "hdf5")]
pub mod hdf5;

use crate::error::Result;
#[cfg(feature = "hdf5")]
use crate::formats::HEAD_BYTES;
use crate::formats::array::{Stored, Unpacked};
use crate::input::Input;

/// Whether a file starts as one does that may be NetCDF.
pub fn detect(head: &[u8]) -> bool {
    classic::detect(head) || is_hdf5(head)
}

/// Opens a file and shows its variables.
pub fn open<T>(input: &Input, see: impl FnOnce(&dyn Variables) -> Result<T>) -> Result<T> {
    #[cfg(feature = "hdf5")]
    if is_hdf5(input.source.peek(0..HEAD_BYTES as u64)) {
        let file = crate::formats::hdf5::Hdf5::open(input)?;
        return see(&hdf5::NetCdf4::new(input, &file)?);
    }
    see(&classic::Classic::open(&input.source)?)
}

#[cfg(feature = "hdf5")]
use crate::formats::hdf5::detect as is_hdf5;
#[cfg(not(feature = "hdf5"))]
fn is_hdf5(_: &[u8]) -> bool {
    false
}

/// A variable.
#[derive(Debug, Clone)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Number of entries along each dimension, the slowest first.
    pub shape: Vec<u64>,
    /// Where it is described: a byte of the file.
    pub at: u64,
}

impl Variable {
    /// Number of entries; as good as endless where it is more than a number can say.
    pub fn len(&self) -> u64 {
        self.shape.iter().copied().fold(1, u64::saturating_mul)
    }
}

/// Most letters of a variable of names.
const MOST_LETTERS: usize = 4 << 20;

/// A container of variables.
pub trait Variables {
    /// The variables, in the file's order.
    fn variables(&self) -> &[Variable];
    /// The text of an attribute of a variable, without blanks and zeros round it.
    fn text(&self, variable: &Variable, attribute: &str) -> Result<Option<String>>;
    /// The letters of a variable of text, all entries one after another; nothing where they are more than a few names.
    fn letters(&self, variable: &Variable) -> Result<Option<Vec<u8>>>;
    /// Finds the numbers of a variable, or unpacks them.
    fn store(&self, variable: &Variable, unpacked: &mut Unpacked<'_>) -> Result<Stored>;

    /// The whole numbers of a variable; none where they are more than `most`, or no numbers.
    fn integers(&self, variable: &Variable, most: u64) -> Result<Vec<i64>>;

    /// The variable called `name`.
    fn find(&self, name: &str) -> Option<&Variable> {
        self.variables().iter().find(|variable| variable.name == name)
    }
}
