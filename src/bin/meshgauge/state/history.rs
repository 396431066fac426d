//! The history of scores, read while a daemon may be writing it.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::State;
use super::path_value::Out;

/// One measure of one scored version.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// When it was scored, RFC 3339 in UTC.
    pub scored: String,
    /// Where the mesh stood in the drop.
    pub mesh: PathBuf,
    /// The verdict's status.
    pub verdict: Option<String>,
    /// Number of elements.
    pub elements: Option<u64>,
    /// The shape.
    pub shape: String,
    /// The measure's code.
    pub measure: String,
    /// The smallest value.
    pub min: Option<f64>,
    /// The element that has it.
    pub min_element: i64,
    /// The mean.
    pub mean: Option<f64>,
}

impl State {
    /// Every scored measure, the oldest first, of meshes that are asked for, since a time (RFC 3339 in UTC).
    pub fn history(&self, wanted: impl Fn(&Path) -> bool, since: &str) -> anyhow::Result<Vec<Entry>> {
        let query =
            "SELECT ended, path, verdict, elements, shape, measure, min, min_element, mean FROM history
                     WHERE ended >= ?1 ORDER BY ended, version, shape, measure";
        let mut statement = self.connection.prepare(query)?;
        let rows = statement.query_map([since], |row| {
            Ok(Entry {
                scored: row.get(0)?,
                mesh: row.get::<_, Out>(1)?.0.into(),
                verdict: row.get(2)?,
                elements: row.get(3)?,
                shape: row.get(4)?,
                measure: row.get(5)?,
                min: row.get(6)?,
                min_element: row.get(7)?,
                mean: row.get(8)?,
            })
        })?;
        let mut entries = Vec::new();
        for entry in rows {
            let entry = entry?;
            if wanted(&entry.mesh) {
                entries.push(entry);
            }
        }
        Ok(entries)
    }

    /// The file of the last published summary of the meshes that are asked for, within the results.
    pub fn last_summary(&self, wanted: impl Fn(&Path) -> bool) -> anyhow::Result<Option<PathBuf>> {
        let query = "SELECT path, summary FROM version JOIN mesh USING (mesh)
                     WHERE stage = 'scored' AND summary IS NOT NULL ORDER BY ended DESC, version DESC";
        let mut statement = self.connection.prepare(query)?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let (mesh, summary) = (PathBuf::from(row.get::<_, Out>(0)?.0), row.get::<_, Out>(1)?.0);
            if wanted(&mesh) {
                return Ok(Some(mesh.with_file_name(summary)));
            }
        }
        Ok(None)
    }
}
