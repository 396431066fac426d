//! Model problems and the writers of their meshes.
//!
//! A model is a row of [`MODELS`]: a name, what it is, its parameters. Set up with values it becomes a [`Problem`], whose
//! mesh is a [`MeshSource`]: nodes and elements are walked through in order and never held, so that a mesh of 10⁹ elements
//! takes no more memory than one of ten. A writer is a row of [`WRITERS`] and turns any problem into a file.
//!
//! ```
//! use meshgauge::generate::{self, Encoding};
//!
//! let problem = generate::model("fd-cylinder")?.problem(["rings=5", "layers=2"])?;
//! let mut file = Vec::new();
//! let counts = generate::writer_for("cylinder.vtu".as_ref())?.write(&problem, Encoding::Default, &mut file)?;
//! assert_eq!((counts.nodes, counts.elements), (543, 360));
//! # Ok::<(), meshgauge::Error>(())
//! ```

mod fd_cylinder;
mod mapped_disc;
mod parameter;
mod source;
mod writers;

use std::fmt;

use crate::error::{Error, Result};

pub use parameter::{Parameter, Range, Values};
pub use source::{Block, MeshSource, VisitElement, VisitNode};
pub use writers::{Counts, Encoding, WRITERS, Writer, write_file, writer, writer_for};

/// A model problem: a row of [`MODELS`].
#[derive(Debug)]
pub struct Model {
    /// The name that users type.
    pub name: &'static str,
    /// What the mesh is, in one line.
    pub title: &'static str,
    /// What can be set; by default the mesh is the report's.
    pub parameters: &'static [Parameter],
    /// The mesh for values that are within their ranges.
    source: fn(&Values) -> Box<dyn MeshSource>,
}

/// Every model problem.
pub static MODELS: &[Model] = &[fd_cylinder::MODEL, mapped_disc::MODEL];

/// The model named `name`.
pub fn model(name: &str) -> Result<&'static Model> {
    MODELS.iter().find(|model| model.name == name).ok_or_else(|| {
        let known: Vec<_> = MODELS.iter().map(|model| model.name).collect();
        Error::usage(format!("no model problem is named \"{name}\"; there are {}", known.join(", ")))
    })
}

impl Model {
    /// The problem with the given settings, each `name=value`; what is not set has its default.
    pub fn problem<'a>(&'static self, settings: impl IntoIterator<Item = &'a str>) -> Result<Problem> {
        let values = Values::parse(self.name, self.parameters, settings)?;
        let mesh = (self.source)(&values);
        Ok(Problem { model: self, values, mesh })
    }
}

/// A model problem with all its parameters set. It displays as the settings that would make it again.
pub struct Problem {
    model: &'static Model,
    values: Values,
    mesh: Box<dyn MeshSource>,
}

impl Problem {
    /// The model that it is a case of.
    pub fn model(&self) -> &'static Model {
        self.model
    }

    /// Its mesh, to walk through.
    pub fn mesh(&self) -> &dyn MeshSource {
        &*self.mesh
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.model.name, self.values)
    }
}

impl fmt::Debug for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Problem({self})")
    }
}
