//! The history of scores.

use std::ffi::OsStr;
use std::path::Path;

use meshgauge::Summary;
use meshgauge::mesh::Shape;
use meshgauge::summary::{MeasureSummary, ShapeSummary};
use rusqlite::params;

use super::{Id, State, now};

impl State {
    /// Puts down the scores of a version, and that its summary is published under the given file name.
    pub fn score(&self, id: Id, path: &Path, summary: &Summary, published: &OsStr) -> anyhow::Result<()> {
        let version = self.version(id)?;
        let update =
            "UPDATE version SET stage = 'scored', ended = ?2, kind = NULL, reason = NULL, verdict = ?3,
                          format = ?4, xxh3 = ?5, nodes = ?6, elements = ?7, seconds = ?8
                      WHERE version = ?1";
        self.connection.prepare_cached(update)?.execute(params![
            version,
            now(),
            summary.verdict.status.name(),
            summary.mesh.format,
            summary.mesh.xxh3,
            summary.nodes.count,
            summary.elements.count,
            summary.run.as_ref().map(|run| run.seconds),
        ])?;
        for (shape, found) in &summary.shapes {
            self.insert_shape(version, *shape, found)?;
            for (code, measure) in &found.measures {
                self.insert_score(version, *shape, code, measure)?;
            }
        }
        self.set_summary(path, published)
    }

    fn insert_shape(&self, version: i64, shape: Shape, found: &ShapeSummary) -> anyhow::Result<()> {
        let insert = "INSERT OR REPLACE INTO shape VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)";
        self.connection.prepare_cached(insert)?.execute(params![
            version,
            shape.to_string(),
            found.count,
            found.inverted,
            found.degenerate,
            found.area,
            found.volume,
        ])?;
        Ok(())
    }

    fn insert_score(
        &self,
        version: i64,
        shape: Shape,
        code: &str,
        found: &MeasureSummary,
    ) -> anyhow::Result<()> {
        let insert = "INSERT OR REPLACE INTO score
                      VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15)";
        let quantile = |probability: &str| found.quantiles.get(probability);
        self.connection.prepare_cached(insert)?.execute(params![
            version,
            shape.to_string(),
            code,
            found.on,
            found.count,
            found.min,
            found.min_element.cast_signed(),
            found.max,
            found.mean,
            found.sd,
            quantile("0.001"),
            quantile("0.01"),
            quantile("0.05"),
            quantile("0.5"),
            quantile("0.95"),
        ])?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::open;
    use super::*;
    use crate::identity::Identity;

    fn summary() -> Summary {
        let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/drop/pit-specimen.inp");
        meshgauge::score(&mesh, &meshgauge::Options::default()).expect("an example")
    }

    #[test]
    fn the_history_holds_what_the_summary_holds() {
        let (state, _folder) = open();
        let (path, identity, summary) = (Path::new("sub/pit.inp"), Identity::default(), summary());
        state.name(path).expect("named");
        state.claim(path, &identity).expect("claimed");
        let id = Id::of(path, &identity);
        // A crash between two goes makes the second one; it must find the first no obstacle.
        for _ in 0..2 {
            state.score(id, path, &summary, OsStr::new("pit.summary.json")).expect("put down");
        }
        let query = "SELECT measure, min, mean, q50, min_element, elements FROM history
                     WHERE series = 'sub/pit' AND shape = 'tetrahedron' ORDER BY measure";
        let mut statement = state.connection.prepare(query).expect("a query");
        let rows = statement
            .query_map([], |row| {
                let numbers: (f64, f64, f64) = (row.get(1)?, row.get(2)?, row.get(3)?);
                Ok((row.get::<_, String>(0)?, numbers, row.get::<_, u64>(4)?, row.get::<_, u64>(5)?))
            })
            .expect("rows");
        let rows: Vec<_> = rows.map(|row| row.expect("a row")).collect();
        let expected: Vec<_> = summary.shapes[&Shape::Tetrahedron]
            .measures
            .iter()
            .map(|(code, m)| {
                let numbers = (m.min, m.mean, m.quantiles["0.5"]);
                (code.clone(), numbers, m.min_element, summary.elements.count)
            })
            .collect();
        assert_eq!(rows, expected);
        assert_eq!(rows.len(), 4);
        assert!(state.is_done(id).expect("read"));
    }
}
