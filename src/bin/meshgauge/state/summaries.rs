//! Whole summaries of past scores, and which of them stood at a time.

use std::collections::{BTreeMap, HashSet};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use anyhow::Context;
use meshgauge::Summary;
use rusqlite::params;

use super::path_value::Out;
use super::{Id, State};
use crate::exit::Usage;

/// The version of the schema that summaries came with.
const SCHEMA: usize = 2;

/// Larger summaries are none of ours.
const LARGEST: u64 = 1 << 28;

/// Zstandard's own default: a summary takes a fifth of its text.
const LEVEL: i32 = 3;

/// What stood at a time, and what stands now, of one part. `None` where nothing had been scored, where the last mesh
/// could not be, or where its summary is not kept.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ThenAndNow {
    /// The summary of the last score before the time.
    pub then: Option<Summary>,
    /// The summary of the last score.
    pub now: Option<Summary>,
}

/// The same as numbers of versions.
#[derive(Debug, Clone, Copy, Default)]
struct Versions {
    then: Option<i64>,
    now: Option<i64>,
}

impl State {
    /// Keeps the summary of a version that was scored.
    pub fn keep_summary(&self, id: Id, summary: &Summary) -> anyhow::Result<()> {
        let packed = zstd::bulk::compress(summary.to_json().as_bytes(), LEVEL)?;
        let insert = "INSERT OR REPLACE INTO summary VALUES (?1, ?2)";
        self.connection.prepare_cached(insert)?.execute(params![self.version(id)?, packed])?;
        Ok(())
    }

    /// Removes the summaries of scores before a time (RFC 3339 in UTC), but for the last of each part: that is what
    /// stood at the time. Says how many.
    pub fn forget_summaries(&self, before: &str, part: impl Fn(&Path) -> PathBuf) -> anyhow::Result<usize> {
        let query = "SELECT version, path FROM summary JOIN version USING (version) JOIN mesh USING (mesh)
                     WHERE ended < ?1 ORDER BY ended DESC, version DESC";
        let transaction = self.begin()?;
        let mut statement = self.connection.prepare_cached(query)?;
        let mut rows = statement.query([before])?;
        let (mut seen, mut removed) = (HashSet::new(), 0);
        let mut delete = self.connection.prepare_cached("DELETE FROM summary WHERE version = ?1")?;
        let mut old = Vec::new();
        while let Some(row) = rows.next()? {
            let (version, path): (i64, Out) = (row.get(0)?, row.get(1)?);
            if !seen.insert(part(Path::new(&path.0))) {
                old.push(version);
            }
        }
        for version in old {
            removed += delete.execute([version])?;
        }
        transaction.commit()?;
        Ok(removed)
    }

    /// What stood at a time (RFC 3339 in UTC) and what stands now, of every part that was ever scored.
    pub fn then_and_now(
        &self,
        time: &str,
        part: impl Fn(&Path) -> PathBuf,
    ) -> anyhow::Result<BTreeMap<PathBuf, ThenAndNow>> {
        let made: usize = self.connection.pragma_query_value(None, "user_version", |row| row.get(0))?;
        if made < SCHEMA {
            let why = "the state is of an earlier version, which kept no summaries; `meshgauge watch` brings it up to date";
            return Err(Usage(why.into()).into());
        }
        let mut found = BTreeMap::new();
        for (part, Versions { then, now }) in self.versions_then_and_now(time, part)? {
            let then_summary = self.summary_of(then)?;
            let now_summary = if then == now { then_summary.clone() } else { self.summary_of(now)? };
            found.insert(part, ThenAndNow { then: then_summary, now: now_summary });
        }
        Ok(found)
    }

    fn versions_then_and_now(
        &self,
        time: &str,
        part: impl Fn(&Path) -> PathBuf,
    ) -> anyhow::Result<BTreeMap<PathBuf, Versions>> {
        let query = "SELECT version, path, stage = 'scored', ended < ?1 FROM version JOIN mesh USING (mesh)
                     WHERE stage IN ('scored', 'failed', 'quarantined') ORDER BY ended, version";
        let mut statement = self.connection.prepare_cached(query)?;
        let mut rows = statement.query([time])?;
        let mut found: BTreeMap<PathBuf, Versions> = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let (version, path): (i64, Out) = (row.get(0)?, row.get(1)?);
            let (scored, before): (bool, bool) = (row.get(2)?, row.get(3)?);
            let stands = scored.then_some(version);
            let versions = found.entry(part(Path::new(&path.0))).or_default();
            versions.now = stands;
            if before {
                versions.then = stands;
            }
        }
        Ok(found)
    }

    /// The summary of a version, where it is kept.
    fn summary_of(&self, version: Option<i64>) -> anyhow::Result<Option<Summary>> {
        let mut statement = self.connection.prepare_cached("SELECT zstd FROM summary WHERE version = ?1")?;
        let mut rows = statement.query([version])?;
        let Some(row) = rows.next()? else { return Ok(None) };
        let packed: Vec<u8> = row.get(0)?;
        let of_version = || format!("the summary of version {}", version.unwrap_or_default());
        let mut json = Vec::new();
        let frame = zstd::stream::read::Decoder::new(&packed[..]).with_context(of_version)?;
        io::copy(&mut frame.take(LARGEST), &mut json).with_context(of_version)?;
        let read = Summary::read_all(&String::from_utf8_lossy(&json)).with_context(of_version)?;
        Ok(read.into_iter().next())
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::OsStr;

    use super::super::tests::open;
    use super::super::{Failed, Stage};
    use super::*;
    use crate::identity::Identity;

    fn summary() -> Summary {
        let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/drop/cylinder-hex.vtu");
        meshgauge::score(&mesh, &meshgauge::Options::default()).expect("an example")
    }

    /// The n-th version of a mesh ends at the hour.
    struct Story {
        state: State,
        _folder: tempfile::TempDir,
        summary: Summary,
    }

    impl Story {
        fn new() -> Self {
            let (state, _folder) = open();
            Self { state, _folder, summary: summary() }
        }

        fn end(&self, path: &str, hour: u64, scored: bool) {
            let (path, identity) = (Path::new(path), Identity { size: hour, ..Identity::default() });
            let id = Id::of(path, &identity);
            self.state.name(path).expect("named");
            self.state.claim(path, &identity).expect("claimed");
            if scored {
                let summary = self.summary(hour);
                self.state.score(id, path, &summary, OsStr::new("x.summary.json")).expect("scored");
                self.state.keep_summary(id, &summary).expect("kept");
            } else {
                let failed = Failed { kind: "malformed", reason: "", abnormal: false };
                self.state.end(id, Stage::Failed, Some(failed)).expect("ended");
            }
            let update = "UPDATE version SET ended = ?2 WHERE id = ?1";
            self.state.connection.execute(update, [id.to_string(), time(hour)]).expect("set");
        }

        /// A summary that is told from others by its bytes.
        fn summary(&self, hour: u64) -> Summary {
            let mut summary = self.summary.clone();
            summary.mesh.bytes = hour;
            summary
        }

        fn at(&self, hour: u64) -> Vec<(String, Option<u64>, Option<u64>)> {
            let found = self.state.then_and_now(&time(hour), part).expect("read");
            let bytes = |summary: Option<Summary>| summary.map(|summary| summary.mesh.bytes);
            let row = |(part, found): (PathBuf, ThenAndNow)| {
                (part.display().to_string(), bytes(found.then), bytes(found.now))
            };
            found.into_iter().map(row).collect()
        }
    }

    fn time(hour: u64) -> String {
        format!("2026-11-21T{hour:02}:00:00.000Z")
    }

    /// Parts by the first letter.
    fn part(path: &Path) -> PathBuf {
        path.display().to_string()[..1].into()
    }

    #[test]
    fn what_stood_at_a_time_is_found_by_part() {
        let story = Story::new();
        story.end("a1.vtu", 1, true);
        story.end("b1.vtu", 2, true);
        story.end("a2.vtu", 3, true);
        story.end("c1.vtu", 4, true);
        story.end("b2.vtu", 5, false);
        let row = |part: &str, then, now| (part.to_owned(), then, now);
        assert_eq!(
            story.at(3),
            [row("a", Some(1), Some(3)), row("b", Some(2), None), row("c", None, Some(4))]
        );
        assert_eq!(
            story.at(9),
            [row("a", Some(3), Some(3)), row("b", None, None), row("c", Some(4), Some(4))]
        );
        let whole = story.state.then_and_now(&time(3), part).expect("read");
        assert_eq!(whole[Path::new("a")].then, Some(story.summary(1)));
    }

    #[test]
    fn old_summaries_go_but_what_stood_at_the_time_stays() {
        let story = Story::new();
        for hour in 1..=4 {
            story.end("a.vtu", hour, true);
        }
        story.end("b.vtu", 1, true);
        assert_eq!(story.state.forget_summaries(&time(3), part).expect("forgotten"), 1);
        let row = |part: &str, then, now| (part.to_owned(), then, now);
        assert_eq!(story.at(3), [row("a", Some(2), Some(4)), row("b", Some(1), Some(1))]);
        assert_eq!(story.at(2)[0], row("a", None, Some(4)), "before that nothing is known");
        assert_eq!(story.state.forget_summaries(&time(3), part).expect("forgotten"), 0);
    }

    #[test]
    fn a_state_of_the_first_schema_is_brought_up_to_date_and_until_then_told() {
        let (state, folder) = open();
        state.connection.execute_batch("DROP TABLE summary; PRAGMA user_version = 1").expect("as it was");
        drop(state);
        let old = State::read(folder.path()).expect("read").expect("there");
        let error = old.then_and_now(&time(1), part).expect_err("nothing is kept there");
        assert!(error.to_string().contains("earlier version"), "{error:#}");
        drop(old);
        let state = State::open(folder.path()).expect("brought up to date");
        assert_eq!(state.then_and_now(&time(1), part).expect("read"), BTreeMap::new());
    }
}
