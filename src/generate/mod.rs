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

mod bricks;
mod disc;
mod fd_cylinder;
mod mapped_disc;
mod parameter;
mod pit_specimen;
mod source;
mod swept_cylinder;
mod target;
mod writers;

use std::fmt;

use crate::error::{Error, Result};

pub use parameter::{Parameter, Range, Values};
pub use source::{Block, MeshSource, VisitElement, VisitNode};
pub use target::Target;
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
    /// The whole numbers that grow together when a mesh of a wanted size is asked for.
    grows: &'static [&'static str],
    /// The mesh for values that are within their ranges; an error where they do not fit together.
    source: fn(&Values) -> Result<Box<dyn MeshSource>>,
    /// Area or volume of what is meshed, by its formula and not by the mesh.
    exact: fn(&Values) -> f64,
}

/// Every model problem.
pub static MODELS: &[Model] =
    &[fd_cylinder::MODEL, mapped_disc::MODEL, swept_cylinder::MODEL, pit_specimen::MODEL];

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
        self.set_up(Values::parse(self.name, self.parameters, settings)?)
    }

    /// The problem whose mesh comes nearest to `target`: the numbers of divisions that are not among the settings grow or
    /// shrink together.
    pub fn problem_near<'a>(
        &'static self,
        target: Target,
        settings: impl IntoIterator<Item = &'a str>,
    ) -> Result<Problem> {
        target::nearest(self, Values::parse(self.name, self.parameters, settings)?, target)
    }

    fn set_up(&'static self, values: Values) -> Result<Problem> {
        let mesh = (self.source)(&values)?;
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

    /// Area or volume of the body itself, which its mesh approaches.
    pub fn exact(&self) -> f64 {
        (self.model.exact)(&self.values)
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
