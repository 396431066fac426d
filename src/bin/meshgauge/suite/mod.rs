//! A suite of mesh generators: each is run on model problems, and what it makes is scored, as the report did.
//!
//! A generator that is missing, fails, takes too long or writes garbage is a row that says so. Every row is written as
//! soon as it is known, so a suite that was interrupted goes on where it stopped; a row is kept for as long as the
//! command, the version and the driver scripts of its generator are what they were.

mod command;
mod definition;
mod group;
mod row;
mod tables;
mod trial;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use meshgauge::{Options, Summary};

pub use definition::Suite;
pub use row::Row;
pub use tables::write;

/// What of a suite is run, and where to.
pub struct Run {
    /// The suite.
    pub suite: Suite,
    /// Folder of the meshes, their summaries and the rows.
    pub results: PathBuf,
    /// Names of problems and of generators; where none of either is named, all of them.
    pub only: Vec<String>,
    /// Run again what is known already.
    pub fresh: bool,
    /// How meshes are scored.
    pub options: Options,
    /// Set where somebody wants the run to end.
    pub stop: Arc<AtomicBool>,
}

/// A row and, where there is a mesh, its summary.
pub type Scored = (Row, Option<Summary>);

impl Run {
    /// Runs every generator on every problem that it has a command for; `done` hears of each row.
    pub fn all(&self, mut done: impl FnMut(&Row)) -> anyhow::Result<Vec<Scored>> {
        let mut scored = Vec::new();
        let (problems, generators) = (&self.suite.problems, &self.suite.generators);
        let names_problem = self.only.iter().any(|name| problems.iter().any(|p| p.name == *name));
        let names_generator = self.only.iter().any(|name| generators.iter().any(|g| g.name == *name));
        let wanted = |some_named: bool, name: &String| !some_named || self.only.contains(name);
        let mut versions = definition::Versions::default();
        for problem in problems.iter().filter(|p| wanted(names_problem, &p.name)) {
            for generator in generators.iter().filter(|g| wanted(names_generator, &g.name)) {
                let Some(template) = generator.run.get(&problem.name) else { continue };
                if self.stop.load(Ordering::Relaxed) {
                    anyhow::bail!("interrupted; the same command goes on from here");
                }
                let trial = trial::Trial { run: self, problem, generator, template };
                let row = trial.carry_out(&mut versions)?;
                done(&row.0);
                scored.push(row);
            }
        }
        Ok(scored)
    }
}
