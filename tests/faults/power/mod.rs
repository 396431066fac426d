//! T22: the machine loses its power.
//!
//! What the daemon asks of the file system is recorded by `strace`. Then, for one moment after another, the folder of
//! results is built as a disk might hold it that lost its power at that moment: what was not synced may be there or not
//! (`disk`), and the daemon is started on it.

mod disk;
mod trace;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use disk::{Disk, Lost};

use crate::daemon::{LONGER, MESH, Site};
use crate::oracle::{Verdict, bytes, judge};
use crate::tools::{Random, done, has, times};

const QUICK: [&str; 3] = ["--settle", "20ms", "--quiet"];

/// The same mesh with its fourth corner so low that the daemon calls it worse than its baseline.
fn sliver() -> String {
    MESH.replace("4 0 0 1\n", "4 0 0 0.01\n")
}

/// Runs `watch --once` and records what it does to the folder of results.
fn record(site: &Site) -> Vec<trace::Step> {
    let plain = site.command(&QUICK);
    let output = site.path("trace");
    let mut command = Command::new("strace");
    command.args(["-f", "-y", "-qq", "-xx", "-s", "4000000", "-o"]).arg(&output);
    command.args(["-e", &format!("trace={}", trace::CALLS.join(","))]);
    command.arg(plain.get_program()).args(plain.get_args()).arg("--once").current_dir(site.path("."));
    let status = command.env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null()).status().expect("strace runs");
    assert_eq!(status.code(), Some(0));
    let steps = trace::steps(&String::from_utf8_lossy(&bytes(&output)), &site.path("results"));
    fs::remove_file(output).expect("removed");
    steps
}

/// The files below the folder of results.
fn image(folder: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let mut found = BTreeMap::new();
    let mut pending = vec![PathBuf::new()];
    while let Some(inner) = pending.pop() {
        for entry in fs::read_dir(folder.join(&inner)).expect("a folder").flatten() {
            let path = inner.join(entry.file_name());
            if entry.path().is_dir() {
                found.insert(path.clone(), None);
                pending.push(path);
            } else {
                found.insert(path, Some(bytes(&entry.path())));
            }
        }
    }
    found
}

/// What there was, for who looks for the reason of a failure.
fn sizes(image: &BTreeMap<PathBuf, Option<Vec<u8>>>) -> BTreeMap<&Path, Option<usize>> {
    image.iter().map(|(path, content)| (path.as_path(), content.as_ref().map(Vec::len))).collect()
}

/// Makes the folder of results anew. The log keeps its inode, by which the database knows it.
fn rebuild(site: &Site, image: &BTreeMap<PathBuf, Option<Vec<u8>>>) {
    let (results, log, kept) = (site.path("results"), "meshgauge.jsonl", site.path("kept.jsonl"));
    let _ = fs::remove_dir_all(&results);
    fs::create_dir(&results).expect("a folder");
    for (path, content) in image {
        let to = results.join(path);
        let Some(content) = content else {
            fs::create_dir_all(&to).expect("a folder");
            continue;
        };
        if path == Path::new(log) {
            fs::hard_link(&kept, &to).expect("linked");
        }
        File::create(&to).and_then(|mut file| file.write_all(content)).expect("written");
    }
}

/// Starts the daemon after a loss of power at each moment of what was recorded; says how many disks that were.
fn lose_power(site: &Site, before: Disk, steps: &[trace::Step], meshes: &[&str], every: usize) -> u64 {
    let mut disk = before;
    let mut random = Random(22);
    let mut disks = 0;
    let kept = site.path("kept.jsonl");
    if !kept.exists() {
        fs::hard_link(site.path("results/meshgauge.jsonl"), &kept).expect("linked");
    }
    for (number, step) in steps.iter().enumerate() {
        disk.take(step);
        if number % every != 0 {
            continue;
        }
        let seeds = [random.below(u64::MAX), random.below(u64::MAX)].map(Lost::Random);
        for lost in [Lost::All, Lost::Nothing, Lost::Data, Lost::Names].into_iter().chain(seeds) {
            let what = format!("{lost:?} after step {number}, {step}");
            let image = disk.after(lost);
            rebuild(site, &image);
            let log = image.get(Path::new("meshgauge.jsonl")).cloned().flatten().unwrap_or_default();
            let output = site.command(&QUICK).arg("--once").output().expect("the program runs");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{what}: {said}: on {:#?}", sizes(&image));
            let verdict = judge(site, meshes.iter().copied());
            assert_eq!(verdict, Verdict::default(), "{what}: on {:#?}", sizes(&image));
            let regressed = site.events("mesh.regressed");
            let mut ids: Vec<_> = regressed.iter().map(|line| line["id"].to_string()).collect();
            ids.dedup();
            assert!(ids.len() == regressed.len(), "{what}: told twice that it is worse: {regressed:?}");
            // What was synced is still there.
            let synced = disk.synced(Path::new("meshgauge.jsonl"));
            assert!(
                bytes(&site.path("results/meshgauge.jsonl")).starts_with(&synced),
                "{what}: lines are lost"
            );
            assert!(log.len() >= synced.len(), "{what}: the disk of this test forgot what was synced");
            disks += 1;
        }
    }
    disks
}

#[test]
fn t22_power_is_lost_at_any_moment() {
    if !has(false, &["strace"]) {
        return;
    }
    let every = times(23, 1) as usize;
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    site.write("drop/sub/b.msh", LONGER);
    // From nothing, and then with a past: another mesh, and a version that is worse than its baseline.
    let first = record(&site);
    let past = image(&site.path("results"));
    let mut disks = lose_power(&site, Disk::default(), &first, &["a.msh", "sub/b.msh"], every);
    rebuild(&site, &past);
    site.write("drop/a.msh", &sliver());
    site.write("drop/c.msh", MESH);
    let second = record(&site);
    assert_eq!(site.events("mesh.regressed").len(), 1, "the second run has something to tell");
    disks += lose_power(&site, Disk::holding(past), &second, &["a.msh", "sub/b.msh", "c.msh"], every);
    done(
        "T22",
        &format!("{disks} disks after {} steps of two runs; lost 0, doubled 0", first.len() + second.len()),
    );
}
