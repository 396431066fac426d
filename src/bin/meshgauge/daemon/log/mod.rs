//! The log of results: JSON lines, each whole or absent.

mod event;
mod lines;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use anyhow::Context;
use rustix::fs::FallocateFlags;
use rustix::io::Errno;
use serde_json::Value;

use super::rotation;
use super::telemetry::Heard;
use crate::config;
use crate::publish;
use crate::state::{LogMark, Logged};

pub use event::Event;
pub use lines::CHANGES;
use lines::{read_outcomes, refuse_other_text, whole_lines};

/// The log, open to append to.
pub struct Log {
    path: PathBuf,
    file: File,
    begun: Instant,
    /// Up to here there is room on the disk.
    reserved: u64,
    heard: Option<Arc<Heard>>,
}

impl Log {
    /// Opens the log and cuts off what an earlier process did not get to finish; says how many bytes that was.
    pub fn open(path: &Path) -> io::Result<(Self, u64)> {
        let folder = folder_of(path);
        publish::make_folder(folder)?;
        let is_new = !path.exists();
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
        if is_new {
            publish::sync_folder(folder)?;
        }
        let whole = whole_lines(&mut file)?;
        let torn = file.metadata()?.len() - whole;
        if torn > 0 {
            refuse_other_text(&mut file, whole)?;
            file.set_len(whole)?;
            file.sync_all()?;
        }
        let begun = rotation::begun(&file);
        Ok((Self { path: path.to_owned(), file, begun, reserved: 0, heard: None }, torn))
    }

    /// Tells of each line that is written from now on.
    pub fn hear_with(&mut self, heard: Arc<Heard>) {
        self.heard = Some(heard);
    }

    /// Begins another file under the same name.
    fn begin_anew(&mut self) -> io::Result<()> {
        let (log, _) = Self::open(&self.path)?;
        *self = Self { heard: self.heard.take(), ..log };
        Ok(())
    }

    /// Opens the log again if another file or none stands under its name, as after rotation by somebody else; says
    /// whether that was so.
    pub fn reopen_if_moved(&mut self) -> io::Result<bool> {
        let here = self.file.metadata()?;
        let moved = match fs::metadata(&self.path) {
            Ok(there) => (there.dev(), there.ino()) != (here.dev(), here.ino()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => true,
            Err(error) => return Err(error),
        };
        if moved {
            self.begin_anew()?;
        }
        Ok(moved)
    }

    /// Puts the log away and begins another, if it is time; returns where the old one is.
    pub fn rotate_if_due(&mut self, rules: &config::Log) -> io::Result<Option<PathBuf>> {
        if !rotation::is_due(rules, self.file.metadata()?.len(), self.begun) {
            return Ok(None);
        }
        let away = rotation::put_away(&self.path)?;
        self.begin_anew()?;
        rotation::thin_out(&self.path, rules.keep)?;
        Ok(Some(away))
    }

    /// The folder of the log.
    pub fn folder(&self) -> &Path {
        folder_of(&self.path)
    }

    /// The end of the log.
    pub fn mark(&self) -> io::Result<LogMark> {
        let data = self.file.metadata()?;
        Ok(LogMark { inode: data.ino(), offset: data.len() })
    }

    /// Appends one line by one write.
    pub fn append(&mut self, event: Event) -> anyhow::Result<()> {
        self.write(event).with_context(|| self.path.display().to_string())
    }

    /// Appends one line by one write, and has the log on disk when it returns.
    pub fn append_durably(&mut self, event: Event) -> anyhow::Result<()> {
        let written = self.write(event).and_then(|()| self.file.sync_data());
        written.with_context(|| self.path.display().to_string())
    }

    fn write(&mut self, event: Event) -> io::Result<()> {
        let event = Value::Object(event.0);
        let mut line = event.to_string();
        line.push('\n');
        let length = self.file.metadata()?.len();
        self.reserve(length, line.len() as u64)?;
        let written = self.file.write(line.as_bytes())?;
        if written < line.len() {
            self.file.set_len(length)?;
            return Err(io::Error::new(io::ErrorKind::StorageFull, "no room for a whole line"));
        }
        if let (Some(heard), Some(event)) = (&self.heard, event.as_object()) {
            heard.hear(event);
        }
        Ok(())
    }

    /// Makes sure that there is room for a line before it is written, so that nobody who follows the log ever sees half
    /// of one.
    fn reserve(&mut self, length: u64, line: u64) -> io::Result<()> {
        if length < self.reserved && length + line <= self.reserved {
            return Ok(());
        }
        let bytes = if line <= RESERVE { RESERVE } else { line };
        for bytes in [bytes, line] {
            match rustix::fs::fallocate(&self.file, FallocateFlags::KEEP_SIZE, length, bytes) {
                Ok(()) => {
                    self.reserved = length + bytes;
                    return Ok(());
                }
                Err(Errno::NOSPC | Errno::DQUOT) if bytes > line => {}
                // What the file system cannot reserve is found out by writing.
                Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => return Ok(()),
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    /// The outcomes that the log tells behind the mark, which may be in a log that was put away since.
    pub fn outcomes_since(&self, mark: LogMark) -> io::Result<Vec<Logged>> {
        let mut outcomes = Vec::new();
        let here = File::open(&self.path)?;
        if here.metadata()?.ino() == mark.inode {
            read_outcomes(here, mark.offset, &mut outcomes)?;
            return Ok(outcomes);
        }
        for path in rotation::put_away_before(&self.path)? {
            let away = File::open(path)?;
            if away.metadata()?.ino() == mark.inode {
                read_outcomes(away, mark.offset, &mut outcomes)?;
            }
        }
        read_outcomes(here, 0, &mut outcomes)?;
        Ok(outcomes)
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Room is reserved for so many bytes at a time.
const RESERVE: u64 = 64 << 10;

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;
    use crate::quantity::Size;

    fn text(path: &Path) -> String {
        let mut bytes = Vec::new();
        File::open(path).and_then(|file| io::copy(&mut file.take(1 << 20), &mut bytes)).expect("readable");
        String::from_utf8(bytes).expect("UTF-8")
    }

    #[test]
    fn a_torn_line_is_cut_off_wherever_it_was_torn() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.jsonl");
        let (mut log, _) = Log::open(&path).expect("opened");
        log.append(Event::info("daemon.started")).expect("written");
        let first = text(&path);
        log.append(Event::info("mesh.failed").with("reason", "x".repeat(9000))).expect("written");
        let whole = text(&path);
        for cut in [first.len() + 1, first.len() + 5000, whole.len() - 1] {
            fs::write(&path, &whole[..cut]).expect("cut");
            let (mut log, torn) = Log::open(&path).expect("opened");
            assert_eq!((torn as usize, text(&path)), (cut - first.len(), first.clone()));
            log.append(Event::info("daemon.started")).expect("written");
            assert!(text(&path).lines().all(|line| serde_json::from_str::<Value>(line).is_ok()));
        }
        let (_, torn) = Log::open(&path).expect("opened");
        assert_eq!(torn, 0);
    }

    #[test]
    fn a_file_that_is_no_log_is_not_cut() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("pit.inp");
        fs::write(&path, "*NODE\n1, 0., 0., 0.").expect("written");
        assert!(Log::open(&path).is_err());
        assert_eq!(text(&path), "*NODE\n1, 0., 0., 0.");
    }

    #[test]
    fn outcomes_behind_the_mark_are_found() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut log, _) = Log::open(&folder.path().join("log.jsonl")).expect("opened");
        let found = |log: &Log, mark| -> Vec<_> {
            log.outcomes_since(mark).expect("read").into_iter().map(|o| (o.id, o.event)).collect()
        };
        let start = log.mark().expect("a mark");
        log.append(Event::info("mesh.claimed").with("id", "7")).expect("written");
        assert_eq!(found(&log, start), []);
        log.append_durably(Event::info("mesh.scored").with("id", "7")).expect("written");
        let scored = vec![("7".to_owned(), "mesh.scored".to_owned())];
        assert_eq!(found(&log, start), scored);
        assert_eq!(found(&log, LogMark { inode: 0, ..log.mark().expect("a mark") }), scored, "another file");
        assert_eq!(found(&log, log.mark().expect("a mark")), []);
    }

    #[test]
    fn outcomes_are_found_in_a_log_that_was_put_away() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut log, _) = Log::open(&folder.path().join("log.jsonl")).expect("opened");
        log.append(Event::info("mesh.scored").with("id", "1")).expect("written");
        let mark = log.mark().expect("a mark");
        log.append(Event::info("mesh.scored").with("id", "2")).expect("written");
        let rules = config::Log { rotate_bytes: Size(1), ..config::Log::default() };
        assert!(log.rotate_if_due(&rules).expect("rotated").is_some());
        assert!(log.rotate_if_due(&rules).expect("nothing to do").is_none(), "an empty log stays");
        log.append(Event::info("mesh.scored").with("id", "3")).expect("written");
        let found: Vec<_> =
            log.outcomes_since(mark).expect("read").into_iter().map(|outcome| outcome.id).collect();
        assert_eq!(found, ["2", "3"]);
    }

    #[test]
    fn a_log_that_was_moved_away_is_begun_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.jsonl");
        let (mut log, _) = Log::open(&path).expect("opened");
        log.append(Event::info("daemon.started")).expect("written");
        assert!(!log.reopen_if_moved().expect("looked"));
        fs::rename(&path, folder.path().join("log.jsonl.1")).expect("moved");
        assert!(log.reopen_if_moved().expect("looked"));
        log.append(Event::info("daemon.stopping")).expect("written");
        assert!(text(&path).contains("daemon.stopping") && !text(&path).contains("daemon.started"));
    }
}
