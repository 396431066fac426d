//! The log of results: JSON lines, each whole or absent.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::{Map, Value};

use crate::path_text::PathText;

/// The log, open to append to.
pub struct Log {
    path: PathBuf,
    file: File,
    length: u64,
}

/// One line of the log: `timestamp`, `level`, `event`, `mesh` where it is about one, then the rest.
pub struct Event(Map<String, Value>);

impl Event {
    /// An event that is worth knowing.
    pub fn info(name: &str) -> Self {
        Self::new("info", name)
    }

    /// An event that somebody should look at.
    pub fn warn(name: &str) -> Self {
        Self::new("warn", name)
    }

    /// An event that went wrong.
    pub fn error(name: &str) -> Self {
        Self::new("error", name)
    }

    fn new(level: &str, name: &str) -> Self {
        let now = humantime::format_rfc3339_millis(SystemTime::now()).to_string();
        let head = [("timestamp", now.as_str()), ("level", level), ("event", name)];
        Self(head.into_iter().map(|(key, value)| (key.to_owned(), value.into())).collect())
    }

    /// About the mesh at `path` within the drop. `mesh` is for people; the bytes of a name that is not UTF-8 stand
    /// beside it.
    pub fn mesh(self, path: &Path) -> Self {
        let event = self.with("mesh", path.to_string_lossy());
        match PathText::from(path) {
            PathText::Text(_) => event,
            PathText::Bytes(bytes) => event.with("mesh_bytes", bytes),
        }
    }

    /// With a further field.
    pub fn with(mut self, key: impl Into<String>, value: impl Into<Value>) -> Self {
        self.0.insert(key.into(), value.into());
        self
    }
}

impl Log {
    /// Opens the log and cuts off what an earlier process did not get to finish; says how many bytes that was.
    pub fn open(path: &Path) -> io::Result<(Self, u64)> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
        let whole = whole_lines(&mut file)?;
        let torn = file.metadata()?.len() - whole;
        if torn > 0 {
            refuse_other_text(&mut file, whole)?;
            file.set_len(whole)?;
            file.sync_all()?;
        }
        Ok((Self { path: path.to_owned(), file, length: whole }, torn))
    }

    /// Number of bytes of the log.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Appends one line by one write, and has it on disk when it returns.
    pub fn append(&mut self, event: Event) -> anyhow::Result<()> {
        let mut line = Value::Object(event.0).to_string();
        line.push('\n');
        self.write(line.as_bytes()).map_err(|e| anyhow::anyhow!("{}: {e}", self.path.display()))
    }

    fn write(&mut self, line: &[u8]) -> io::Result<()> {
        // Somebody else may have cut the file, as log rotation by copying does.
        self.length = self.file.metadata()?.len();
        let written = self.file.write(line)?;
        if written < line.len() {
            self.file.set_len(self.length)?;
            return Err(io::Error::new(io::ErrorKind::StorageFull, "no room for a whole line"));
        }
        self.file.sync_data()?;
        self.length += line.len() as u64;
        Ok(())
    }

    /// The event's name in the last line from byte `from` on whose `id` is the given one.
    pub fn outcome(&self, id: &str, from: u64) -> io::Result<Option<String>> {
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(from))?;
        let mut lines = BufReader::new(file);
        let (mut line, mut outcome) = (Vec::new(), None);
        while lines.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)? > 0 {
            let event: Option<Value> = serde_json::from_slice(&line).ok();
            if let Some(event) = event.filter(|e| e["id"] == id)
                && let Some("mesh.scored" | "mesh.failed" | "mesh.ignored") = event["event"].as_str()
            {
                outcome = event["event"].as_str().map(String::from);
            }
            line.clear();
        }
        Ok(outcome)
    }
}

/// Lines of ours are shorter by far.
const LONGEST_LINE: u64 = 1 << 20;

/// What we tore begins like a line of ours, or is a hole; anything else is not ours to cut.
fn refuse_other_text(file: &mut File, torn: u64) -> io::Result<()> {
    let mut first = [0];
    file.seek(SeekFrom::Start(torn))?;
    file.read_exact(&mut first)?;
    match first[0] {
        b'{' | 0 => Ok(()),
        _ => {
            Err(io::Error::new(io::ErrorKind::InvalidData, "expected a log of JSON lines, found other text"))
        }
    }
}

/// Number of bytes up to the end of the last whole line.
fn whole_lines(file: &mut File) -> io::Result<u64> {
    let mut end = file.metadata()?.len();
    let mut block = [0; 4096];
    while end > 0 {
        let start = end.saturating_sub(block.len() as u64);
        let block = &mut block[..(end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(block)?;
        if let Some(newline) = block.iter().rposition(|&b| b == b'\n') {
            return Ok(start + newline as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn an_outcome_is_found_by_its_id_behind_the_given_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut log, _) = Log::open(&folder.path().join("log.jsonl")).expect("opened");
        log.append(Event::info("mesh.claimed").with("id", "7")).expect("written");
        let claimed = log.length();
        assert_eq!(log.outcome("7", 0).expect("read"), None);
        log.append(Event::info("mesh.scored").with("id", "7")).expect("written");
        assert_eq!(log.outcome("7", claimed).expect("read").as_deref(), Some("mesh.scored"));
        assert_eq!(log.outcome("8", 0).expect("read"), None);
        assert_eq!(log.outcome("7", log.length()).expect("read"), None);
    }
}
