//! NetCDF files: variables by name, in the classic container ([`classic`]: CDF-1, CDF-2, CDF-5).

pub mod classic;

use crate::error::Result;
use crate::formats::array::{Stored, Unpacked};

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

/// A container of variables.
pub trait Variables {
    /// The variables, in the file's order.
    fn variables(&self) -> &[Variable];
    /// The text of an attribute of a variable, without blanks and zeros round it.
    fn text(&self, variable: &Variable, attribute: &str) -> Result<Option<String>>;
    /// Finds the numbers of a variable, or unpacks them.
    fn store(&self, variable: &Variable, unpacked: &mut Unpacked<'_>) -> Result<Stored>;

    /// The variable called `name`.
    fn find(&self, name: &str) -> Option<&Variable> {
        self.variables().iter().find(|variable| variable.name == name)
    }
}
