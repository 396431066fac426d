//! How often, and with what.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use rustix::process::geteuid;

use crate::oracle::bytes;

/// How often a fault is done: `few` times, or `full` times with `MESHGAUGE_FAULTS=full`.
pub fn times(few: u64, full: u64) -> u64 {
    if std::env::var("MESHGAUGE_FAULTS").is_ok_and(|often| often == "full") { full } else { few }
}

/// Says in the test's output what was done, for the table.
pub fn done(row: &str, what: &str) {
    println!("{row}: {what}");
}

/// Whether the test may mount and has the programs; says aloud if not.
pub fn has(root: bool, programs: &[&str]) -> bool {
    if root && !geteuid().is_root() {
        eprintln!("skipped: it needs root");
        return false;
    }
    let missing = programs.iter().find(|program| {
        let paths = std::env::var_os("PATH").unwrap_or_default();
        !std::env::split_paths(&paths).any(|folder| folder.join(program).is_file())
    });
    if let Some(missing) = missing {
        eprintln!("skipped: {missing} is not installed");
    }
    missing.is_none()
}

/// Numbers that look random and are the same on every run of a seed (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// Less than `limit`.
    pub fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % limit
    }
}

/// Runs a program that must succeed.
pub fn run<I: IntoIterator<Item = S>, S: AsRef<OsStr>>(program: &str, arguments: I) {
    let output = Command::new(program).args(arguments).output().expect("the program runs");
    assert!(output.status.success(), "{program}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A file system that goes with it.
pub struct Mounted(PathBuf);

impl Mounted {
    /// Memory with these options at a folder, which is made.
    pub fn tmpfs(at: &Path, options: &str) -> Self {
        std::fs::create_dir_all(at).expect("a folder");
        let at_text = at.to_str().expect("UTF-8");
        run("mount", ["-t", "tmpfs", "-o", options, "tmpfs", at_text]);
        Self(at.to_owned())
    }

    /// Another folder, read-only.
    pub fn read_only(of: &Path, at: &Path) -> Self {
        std::fs::create_dir_all(at).expect("a folder");
        run("mount", [OsStr::new("--bind"), of.as_os_str(), at.as_os_str()]);
        run("mount", [OsStr::new("-o"), OsStr::new("remount,bind,ro"), at.as_os_str()]);
        Self(at.to_owned())
    }

    /// Another folder by way of FUSE, with these options. The process that serves it is returned.
    pub fn bindfs(of: &Path, at: &Path, options: &str) -> (Self, std::process::Child) {
        std::fs::create_dir_all(at).expect("a folder");
        let mut command = Command::new("bindfs");
        command.arg("-f").args(["-o", options]).arg(of).arg(at).stdout(Stdio::null());
        let child = command.spawn().expect("bindfs runs");
        let here = |path: &Path| rustix::fs::stat(path).map(|stat| stat.st_dev);
        let outside = here(at.parent().expect("a folder"));
        for _ in 0..1000 {
            if here(at) != outside {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        (Self(at.to_owned()), child)
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        // Lazily: something may still be open there.
        let _ = Command::new("umount").arg("-l").arg(&self.0).stderr(Stdio::null()).status();
    }
}

/// Whether a child of ours runs; one that ended and was not waited for does not.
pub fn is_alive(process: u32) -> bool {
    let stat = bytes(Path::new(&format!("/proc/{process}/stat")));
    let stat = String::from_utf8_lossy(&stat).into_owned();
    stat.rsplit_once(')').is_some_and(|(_, rest)| !rest.trim_start().starts_with(['Z', 'X']))
}

/// The children of a process.
pub fn children(process: u32) -> Vec<u32> {
    let mut children = Vec::new();
    for thread in std::fs::read_dir(format!("/proc/{process}/task")).expect("its threads").flatten() {
        let line = bytes(&thread.path().join("children"));
        children.extend(
            String::from_utf8_lossy(&line).split_whitespace().filter_map(|pid| pid.parse::<u32>().ok()),
        );
    }
    children
}
