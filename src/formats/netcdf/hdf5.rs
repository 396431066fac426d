//! NetCDF-4: variables as datasets of an HDF5 file's root.

use super::{MOST_LETTERS, Variable, Variables};
use crate::error::{Error, Result};
use crate::formats::array::{Stored, Unpacked};
use crate::formats::hdf5::{Dataset, Hdf5};
use crate::input::{Input, Spot};

/// An open file.
pub struct NetCdf4<'i> {
    input: &'i Input,
    file: &'i Hdf5,
    variables: Vec<Variable>,
}

impl<'i> NetCdf4<'i> {
    /// Lists the variables.
    pub fn new(input: &'i Input, file: &'i Hdf5) -> Result<Self> {
        let root = file.root()?;
        let mut variables = Vec::new();
        for name in root.names()?.1 {
            if let Some(dataset) = root.dataset(&name)? {
                variables.push(Variable { name, shape: dataset.shape().to_vec(), at: dataset.at() });
            }
        }
        Ok(Self { input, file, variables })
    }

    fn dataset(&self, variable: &Variable) -> Result<Dataset<'i>> {
        let found = self.file.root()?.dataset(&variable.name)?;
        found.ok_or_else(|| {
            let error = Error::malformed(format!("the variable {}", variable.name), "none of that name");
            self.input.source.place(error, Spot::Binary(variable.at))
        })
    }
}

impl Variables for NetCdf4<'_> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn text(&self, variable: &Variable, attribute: &str) -> Result<Option<String>> {
        Ok(self.dataset(variable)?.text(attribute))
    }

    fn letters(&self, variable: &Variable) -> Result<Option<Vec<u8>>> {
        self.dataset(variable)?.letters(MOST_LETTERS)
    }

    fn integers(&self, variable: &Variable, most: u64) -> Result<Vec<i64>> {
        let dataset = self.dataset(variable)?;
        if dataset.is_of_numbers() && dataset.len() <= most { dataset.integers(most) } else { Ok(Vec::new()) }
    }

    fn store(&self, variable: &Variable, unpacked: &mut Unpacked<'_>) -> Result<Stored> {
        self.dataset(variable)?.store(self.input, unpacked)
    }
}
