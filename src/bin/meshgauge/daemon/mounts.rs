//! File systems that are mounted below the drop, as the kernel lists them.
//!
//! A mount whose server hangs blocks whoever so much as looks at it. The kernel's list does not: it tells where the
//! mounts stand, so that each is left to a thread of its own.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};

/// A mount below the drop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mounted {
    /// Where it stands, within the drop; empty for the file system that the drop itself is on.
    pub at: PathBuf,
    /// The kernel's name of the type of file system.
    pub kind: String,
    /// The mount's number, which another mount in its place does not have.
    pub number: u64,
}

/// The list is read up to this many bytes.
const LONGEST_LIST: u64 = 16 << 20;

/// The mount that the folder `root` is on, and those below it. `root` is an absolute path without links.
pub fn below(root: &Path) -> io::Result<Vec<Mounted>> {
    parse(File::open("/proc/self/mountinfo")?.take(LONGEST_LIST), root)
}

fn parse(list: impl Read, root: &Path) -> io::Result<Vec<Mounted>> {
    let mut own: Option<(usize, Mounted)> = None;
    let mut mounts: Vec<Mounted> = Vec::new();
    for line in BufReader::new(list).split(b'\n') {
        let line = line?;
        let Some((number, place, kind)) = fields(&line) else { continue };
        if root.starts_with(&place) {
            // Of several on one place the last is on top.
            let depth = place.components().count();
            if own.as_ref().is_none_or(|(found, _)| depth >= *found) {
                own = Some((depth, Mounted { at: PathBuf::new(), kind, number }));
            }
        } else if let Ok(at) = place.strip_prefix(root) {
            mounts.retain(|mount| mount.at != at);
            mounts.push(Mounted { at: at.to_owned(), kind, number });
        }
    }
    mounts.extend(own.map(|(_, mount)| mount));
    mounts.sort_by(|a, b| a.at.cmp(&b.at));
    Ok(mounts)
}

/// Number, mount point and type of a line such as `36 35 98:0 /mnt1 /mnt2 rw,noatime master:1 - ext3 /dev/root rw`.
fn fields(line: &[u8]) -> Option<(u64, PathBuf, String)> {
    let mut words = line.split(|&b| b == b' ');
    let number = std::str::from_utf8(words.next()?).ok()?.parse().ok()?;
    let place = PathBuf::from(OsString::from_vec(unescape(words.nth(3)?)));
    let kind = words.skip_while(|word| word != b"-").nth(1)?;
    Some((number, place, String::from_utf8_lossy(kind).into_owned()))
}

/// Spaces and the like stand as three octal digits behind a backslash.
fn unescape(word: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(word.len());
    let mut rest = word;
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..3).and_then(|digits| std::str::from_utf8(digits).ok());
        match digits.and_then(|digits| u8::from_str_radix(digits, 8).ok()) {
            Some(byte) if first == b'\\' => {
                bytes.push(byte);
                rest = &behind[3..];
            }
            _ => {
                bytes.push(first);
                rest = behind;
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: &[u8] = b"\
22 1 254:0 / / rw,relatime - ext4 /dev/vda rw
30 22 0:25 / /scratch rw shared:4 master:1 - tmpfs tmpfs rw
31 30 0:26 / /scratch/drop/on\\040a\\134share rw - nfs4 server:/meshes rw
32 30 0:27 / /scratch/dropped rw - tmpfs tmpfs rw
33 30 0:28 / /scratch/drop/b rw - ext4 /dev/vdb rw
34 33 0:29 / /scratch/drop/b rw - fuse.bindfs bindfs rw
";

    #[test]
    fn mounts_are_found_with_their_type_and_number() {
        let row = |at: &str, kind: &str, number| Mounted { at: at.into(), kind: kind.into(), number };
        let below = parse(LIST, Path::new("/scratch/drop")).expect("a list");
        let expected = [row("", "tmpfs", 30), row("b", "fuse.bindfs", 34), row("on a\\share", "nfs4", 31)];
        assert_eq!(below, expected);
        assert_eq!(parse(LIST, Path::new("/home/me")).expect("a list"), [row("", "ext4", 22)]);
    }
}
