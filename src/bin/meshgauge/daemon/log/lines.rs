//! The lines of a log that is there: where the last whole one ends, and what was told once of a version.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

use serde_json::Value;

use crate::state::Logged;

/// Reads the outcomes of a log from byte `from` on.
pub fn read_outcomes(mut log: File, from: u64, outcomes: &mut Vec<Logged>) -> io::Result<()> {
    log.seek(SeekFrom::Start(from))?;
    let (mut lines, mut line) = (BufReader::new(log), Vec::new());
    while lines.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)? > 0 {
        outcomes.extend(outcome(&line));
        line.clear();
    }
    Ok(())
}

/// What a line tells that is told once, if it is such a line.
fn outcome(line: &[u8]) -> Option<Logged> {
    let line: Value = serde_json::from_slice(line).ok()?;
    let (id, event) = (line["id"].as_str()?, line["event"].as_str()?);
    (OUTCOMES.contains(&event) || CHANGES.contains(&event))
        .then(|| Logged { id: id.into(), event: event.into() })
}

/// The events that end a version of a mesh, or one try at it.
const OUTCOMES: [&str; 4] = ["mesh.scored", "mesh.failed", "mesh.quarantined", "mesh.ignored"];

/// The events that tell that a version is worse or better than its baseline.
pub const CHANGES: [&str; 2] = ["mesh.regressed", "mesh.improved"];

/// Lines of ours are shorter by far.
const LONGEST_LINE: u64 = 1 << 20;

/// What we tore begins like a line of ours, or is a hole; anything else is not ours to cut.
pub fn refuse_other_text(file: &mut File, torn: u64) -> io::Result<()> {
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
pub fn whole_lines(file: &mut File) -> io::Result<u64> {
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
