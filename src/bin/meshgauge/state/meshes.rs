//! Paths of the drop: which of them are meshes, and what their summaries are called.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use rusqlite::{OptionalExtension, params};

use super::State;
use super::path_value::{In, Out};
use crate::names::{Folder, stem};

impl State {
    /// The number of the path's row, which is made if it is not there.
    pub(super) fn mesh(&self, path: &Path) -> rusqlite::Result<i64> {
        let known = self.known_mesh(path)?;
        if let Some(mesh) = known {
            return Ok(mesh);
        }
        let insert = "INSERT INTO mesh (path, folder, name) VALUES (?1, ?2, ?3)";
        let (folder, name) = (folder(path), name(path));
        self.connection.prepare_cached(insert)?.insert(params![In::from(path), In::from(folder), In(name)])
    }

    pub(super) fn known_mesh(&self, path: &Path) -> rusqlite::Result<Option<i64>> {
        let query = "SELECT mesh FROM mesh WHERE path = ?1";
        self.connection.prepare_cached(query)?.query_row([In::from(path)], |row| row.get(0)).optional()
    }

    /// Whether it is put down that the path is a mesh.
    pub fn is_named(&self, path: &Path) -> anyhow::Result<bool> {
        let query = "SELECT stem IS NOT NULL FROM mesh WHERE path = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        Ok(statement.query_row([In::from(path)], |row| row.get(0)).optional()?.unwrap_or(false))
    }

    /// Puts down that the path is a mesh, so that summaries are named with regard to it.
    pub fn name(&self, path: &Path) -> anyhow::Result<()> {
        let mesh = self.mesh(path)?;
        let stem = stem(name(path));
        let series = folder(path).join(&stem);
        let update = "UPDATE mesh SET stem = ?2, series = ?3 WHERE mesh = ?1";
        self.connection.prepare_cached(update)?.execute(params![
            mesh,
            In(&stem),
            series.to_string_lossy()
        ])?;
        Ok(())
    }

    /// The file name that the summary of the mesh should have.
    pub fn summary_name(&self, path: &Path) -> anyhow::Result<OsString> {
        let stem = stem(name(path));
        let query =
            "SELECT name FROM mesh WHERE folder = ?1 AND stem IS NOT NULL AND (stem = ?2 OR name = ?2)";
        let mut statement = self.connection.prepare_cached(query)?;
        let mut folder = Folder::default();
        let names = statement
            .query_map(params![In::from(self::folder(path)), In(&stem)], |row| row.get::<_, Out>(0))?;
        for name in names {
            folder.add(&name?.0);
        }
        folder.add(name(path));
        Ok(folder.summary_name(name(path)))
    }

    /// The published summaries that may need another name because of the mesh at `path`: their meshes' paths.
    pub fn neighbours(&self, path: &Path) -> anyhow::Result<Vec<PathBuf>> {
        let (stem, name) = (stem(name(path)), name(path));
        let query = "SELECT path FROM mesh WHERE folder = ?1 AND stem IN (?2, ?3) AND summary IS NOT NULL";
        let mut statement = self.connection.prepare_cached(query)?;
        let folder = In::from(folder(path));
        let paths = statement.query_map(params![folder, In(&stem), In(name)], |row| row.get::<_, Out>(0))?;
        Ok(paths.map(|path| path.map(|path| path.0.into())).collect::<Result<_, _>>()?)
    }

    /// The file name of the mesh's published summary.
    pub fn summary(&self, path: &Path) -> anyhow::Result<Option<OsString>> {
        let query = "SELECT summary FROM mesh WHERE path = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        let summary = statement.query_row([In::from(path)], |row| row.get::<_, Option<Out>>(0)).optional()?;
        Ok(summary.flatten().map(|name| name.0))
    }

    /// Puts down the file name of the mesh's published summary.
    pub fn set_summary(&self, path: &Path, summary: &OsStr) -> anyhow::Result<()> {
        let update = "UPDATE mesh SET summary = ?2 WHERE path = ?1";
        self.connection.prepare_cached(update)?.execute(params![In::from(path), In(summary)])?;
        Ok(())
    }

    /// Whether the log tells that the path is no mesh.
    pub fn was_ignored(&self, path: &Path) -> anyhow::Result<bool> {
        let query = "SELECT ignored FROM mesh WHERE path = ?1";
        let mut statement = self.connection.prepare_cached(query)?;
        Ok(statement.query_row([In::from(path)], |row| row.get(0)).optional()?.unwrap_or(false))
    }

    /// Puts down that the log tells that the path is no mesh.
    pub fn set_ignored(&self, path: &Path) -> anyhow::Result<()> {
        let mesh = self.mesh(path)?;
        self.connection.prepare_cached("UPDATE mesh SET ignored = 1 WHERE mesh = ?1")?.execute([mesh])?;
        Ok(())
    }

    /// The sub-folders with meshes that a worker had when an earlier daemon ended.
    pub fn interrupted_folders(&self) -> anyhow::Result<Vec<PathBuf>> {
        let query = "SELECT DISTINCT folder FROM version JOIN mesh USING (mesh) WHERE stage = 'claimed'";
        let mut statement = self.connection.prepare_cached(query)?;
        let folders = statement.query_map([], |row| row.get::<_, Out>(0))?;
        Ok(folders.map(|folder| folder.map(|folder| folder.0.into())).collect::<Result<_, _>>()?)
    }
}

fn name(path: &Path) -> &OsStr {
    path.file_name().unwrap_or_default()
}

fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

#[cfg(test)]
mod tests {
    use super::super::tests::open;
    use super::*;

    #[test]
    fn summaries_are_named_as_the_names_of_the_folder_demand() {
        let (state, _folder) = open();
        let names = |paths: &[&str]| -> Vec<_> {
            let name = |path: &&str| state.summary_name(Path::new(path)).expect("a name");
            paths.iter().map(name).collect()
        };
        let (first, second, other) = ("sub/pit.inp", "sub/pit.msh", "pit.inp");
        for path in [first, other] {
            state.name(Path::new(path)).expect("named");
            state.set_summary(Path::new(path), OsStr::new("pit.summary.json")).expect("set");
        }
        assert_eq!(names(&[first, other]), ["pit.summary.json", "pit.summary.json"]);
        state.name(Path::new(second)).expect("named");
        assert_eq!(state.neighbours(Path::new(second)).expect("read"), [Path::new(first)]);
        let clashing = ["pit.inp.summary.json", "pit.msh.summary.json", "pit.summary.json"];
        assert_eq!(names(&[first, second, other]), clashing);
    }
}
