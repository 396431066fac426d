//! Disks that are full, and what becomes of meshes meanwhile.

use std::fs;
use std::io::Write;
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{MESH, Mounted, Site};

/// Fills a file system up to the last byte; removing the file makes room again.
fn fill(folder: &std::path::Path) -> std::path::PathBuf {
    let path = folder.join("filler");
    let mut file = fs::File::create(&path).expect("a file");
    let mut block = vec![b'x'; 1 << 16];
    while !block.is_empty() {
        if file.write_all(&block).is_err() {
            block.truncate(block.len() / 2);
        }
    }
    path
}

/// More than the log has room reserved for.
const MESHES: usize = 100;

/// Where the log, the state and the results are, each on a file system of its own.
const FOLDERS: [&str; 3] = ["log", "state", "results"];

const OPTIONS: [&str; 6] = ["--log", "log/meshgauge.jsonl", "--state", "state", "--results", "results"];

#[test]
fn a_daemon_waits_for_room_and_loses_nothing() {
    for full in FOLDERS {
        let site = Site::with_log("log/meshgauge.jsonl");
        let mounts = FOLDERS.map(|folder| Mounted::memory(site.path(folder), "size=16m"));
        if mounts.iter().any(Option::is_none) {
            return;
        }
        let mut daemon = site.start(&OPTIONS);
        site.write("drop/before.msh", MESH);
        daemon.wait_for("mesh.scored", "before.msh");
        let filler = fill(&site.path(full));
        for i in 0..MESHES {
            site.write(&format!("drop/{i}.msh"), MESH);
        }
        if full == "state" {
            // The status stands there too and cannot be written.
            sleep(Duration::from_secs(5));
        } else {
            let degraded =
                || site.text("state/status.json").is_some_and(|text| text.contains("nothing is claimed"));
            daemon.wait("the status to say so", degraded);
        }
        assert!(daemon.is_alive(), "{full}");
        assert!(site.summaries().len() < 1 + MESHES, "{full}: it is full");
        fs::remove_file(filler).expect("there is room again");
        daemon.wait("the rest", || site.summaries().len() == 1 + MESHES);
        assert_eq!(site.events("mesh.scored").len(), 1 + MESHES, "{full}: one line each");
        let resumed = site.events("daemon.resumed");
        assert!(!resumed.is_empty() && resumed[0]["reason"].is_string(), "{full}");
        daemon.signal(rustix::process::Signal::TERM);
        assert_eq!(daemon.end().code(), Some(0), "{full}");
    }
}

#[test]
fn a_run_that_is_to_end_ends_with_the_status_of_a_full_disk() {
    let site = Site::new();
    let Some(_mount) = Mounted::memory(site.path("results"), "size=2m") else { return };
    site.write("drop/a.msh", MESH);
    assert_eq!(site.once(&["--state", "state", "--log", "log.jsonl"]), Some(0));
    let filler = fill(&site.path("results"));
    site.write("drop/b.msh", MESH);
    assert_eq!(site.once(&["--state", "state", "--log", "log.jsonl"]), Some(4));
    fs::remove_file(filler).expect("there is room again");
    assert_eq!(site.once(&["--state", "state", "--log", "log.jsonl"]), Some(0));
    assert_eq!(site.summaries(), ["a.summary.json", "b.summary.json"]);
}

#[test]
fn a_daemon_that_finds_a_full_disk_starts_when_there_is_room() {
    let site = Site::new();
    let Some(_mount) = Mounted::memory(site.path("results"), "size=4m") else { return };
    let filler = fill(&site.path("results"));
    site.write("drop/a.msh", MESH);
    let room = std::thread::spawn(move || {
        sleep(Duration::from_secs(2));
        fs::remove_file(filler).expect("there is room again");
    });
    let mut daemon = site.start(&[]);
    daemon.wait_for("mesh.scored", "a.msh");
    room.join().expect("it made room");
    daemon.signal(rustix::process::Signal::TERM);
    assert_eq!(daemon.end().code(), Some(0));
}
