//! Meshes that are come upon, and handed to workers.

use std::io;
use std::path::Path;

use anyhow::Context;

use super::{Record, file_name};
use crate::daemon::log::Event;
use crate::identity::Identity;
use crate::publish;
use crate::state::{Id, Tries};

impl Record {
    /// There are files with names of meshes.
    pub fn detected<'f>(
        &mut self,
        files: impl Iterator<Item = (&'f Path, &'f Identity)> + Clone,
    ) -> anyhow::Result<()> {
        for (path, identity) in files.clone() {
            self.log.append(Event::info("mesh.detected").mesh(path).with("bytes", identity.size))?;
        }
        let transaction = self.state.begin()?;
        for (path, _) in files {
            self.name(path)?;
        }
        Ok(transaction.commit()?)
    }

    /// A mesh is there that the summaries of its folder may have to be renamed for. The database is told after the
    /// files have their names: a crash in between is mended by doing it again.
    fn name(&self, path: &Path) -> anyhow::Result<()> {
        if self.state.is_named(path)? {
            return Ok(());
        }
        self.state.name(path)?;
        self.state.neighbours(path)?.iter().try_for_each(|mesh| self.rename(mesh))
    }

    /// Gives the summary of a mesh the name that it should have.
    fn rename(&self, mesh: &Path) -> anyhow::Result<()> {
        let Some(name) = self.state.summary(mesh)? else { return Ok(()) };
        let to = self.summary_path(mesh)?;
        let from = to.with_file_name(name);
        if from == to {
            return Ok(());
        }
        match publish::rename(&from, &to) {
            // An earlier process got this far, or somebody took the summary away.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            result => result.with_context(|| from.display().to_string())?,
        }
        self.state.set_summary(mesh, file_name(&to))
    }

    /// A worker is about to get it.
    pub fn claimed(&mut self, path: &Path, identity: &Identity, announced: bool) -> anyhow::Result<()> {
        let transaction = self.state.begin()?;
        let claim = self.state.claim(path, identity)?;
        transaction.commit()?;
        if claim.again {
            let event = Event::info("mesh.retried").mesh(path).with("id", Id::of(path, identity).to_string());
            self.log.append(event.with("attempt", claim.attempt))?;
        }
        if announced { self.log_claim(path, identity) } else { Ok(()) }
    }

    /// How often the version was tried.
    pub fn tries(&self, path: &Path, identity: &Identity) -> anyhow::Result<Tries> {
        self.state.tries(Id::of(path, identity))
    }

    fn log_claim(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        let id = Id::of(path, identity).to_string();
        self.log.append(Event::info("mesh.claimed").mesh(path).with("id", id))
    }

    /// What was not announced turned out to be a mesh.
    pub fn announced(&mut self, path: &Path, identity: &Identity) -> anyhow::Result<()> {
        self.detected(std::iter::once((path, identity)))?;
        self.log_claim(path, identity)
    }
}
