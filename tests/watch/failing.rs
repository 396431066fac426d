//! What is bad fails alone, with a reason.

use std::os::unix::fs::symlink;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use rustix::process::Signal;

use crate::daemon::{BAD, LONGER, MESH, ONE_WORKER, Site, one_worker, send};

#[test]
fn a_bad_mesh_fails_with_its_place_and_the_next_one_is_scored() {
    let site = Site::new();
    let daemon = site.start(&[]);
    site.write("drop/bad.msh", BAD);
    daemon.wait_for("mesh.failed", "bad.msh");
    let failed = &site.events_of("mesh.failed", "bad.msh")[0];
    assert_eq!((&failed["kind"], &failed["line"]), (&"malformed".into(), &7.into()), "{failed}");
    assert!(failed["reason"].as_str().is_some_and(|r| r.contains("expected") && r.contains("found")));
    site.write("drop/good.msh", MESH);
    daemon.wait_for("mesh.scored", "good.msh");
    // It is tried again when it changes, and not before.
    assert_eq!(site.events("mesh.failed").len(), 1);
    site.write("drop/bad.msh", MESH);
    daemon.wait_for("mesh.scored", "bad.msh");
}

#[test]
fn once_returns_the_highest_status() {
    let site = Site::new();
    site.write("drop/good.msh", MESH);
    site.write("meshgauge.toml", "[verdict]\nfail_under = { M31 = 0.9 }");
    assert_eq!(site.once(&["--config", "meshgauge.toml"]), Some(1));
    site.write("drop/bad.msh", BAD);
    site.write("drop/another.msh", LONGER);
    assert_eq!(site.once(&["--config", "meshgauge.toml"]), Some(3));
    assert_eq!(site.events("mesh.scored").len(), 2);
}

#[test]
fn what_is_no_mesh_is_ignored_once() {
    let site = Site::new();
    site.write("outside.msh", MESH);
    site.write("drop/notes.txt", "remember the milk");
    let fifo = Command::new("mkfifo").arg(site.path("drop/pipe.msh")).status().expect("mkfifo");
    assert!(fifo.success());
    symlink(site.path("outside.msh"), site.path("drop/out.msh")).expect("linked");
    symlink("loop.msh", site.path("drop/loop.msh")).expect("linked");
    symlink(".", site.path("drop/folder")).expect("linked");
    site.write("drop/mesh-without-extension", MESH);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.once(&[]), Some(0));
    let mut ignored: Vec<_> = site.events("mesh.ignored").iter().map(|e| e["mesh"].clone()).collect();
    ignored.sort_by_key(|mesh| mesh.to_string());
    assert_eq!(ignored, ["folder", "loop.msh", "notes.txt", "out.msh", "pipe.msh"]);
    assert_eq!(site.summaries(), ["mesh-without-extension.summary.json"]);
}

#[test]
fn a_worker_that_is_killed_over_a_mesh_fails_that_mesh_alone() {
    let site = Site::new();
    one_worker(&site, "");
    let daemon = site.start(&ONE_WORKER);
    let worker = daemon.worker();
    send(worker, Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    sleep(Duration::from_millis(200));
    send(worker, Signal::KILL);
    daemon.wait_for("mesh.failed", "a.msh");
    let failed = &site.events("mesh.failed")[0];
    assert_eq!(failed["kind"], "worker_died");
    assert!(failed["reason"].as_str().is_some_and(|reason| reason.contains("SIGKILL")), "{failed}");
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.scored", "b.msh");
}

#[test]
fn a_worker_that_dies_idle_fails_no_mesh() {
    let site = Site::new();
    one_worker(&site, "");
    let daemon = site.start(&ONE_WORKER);
    send(daemon.worker(), Signal::KILL);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.scored", "a.msh");
    assert!(site.events("mesh.failed").is_empty());
}

#[test]
fn a_mesh_that_takes_too_long_fails_and_the_next_one_is_scored() {
    let site = Site::new();
    one_worker(&site, "time = \"3s\"");
    let daemon = site.start(&ONE_WORKER);
    send(daemon.worker(), Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.failed", "a.msh");
    assert_eq!(site.events("mesh.failed")[0]["kind"], "timeout");
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.scored", "b.msh");
}

#[test]
fn what_changes_while_it_is_read_is_not_published_and_is_scored_when_it_stands_still() {
    let site = Site::new();
    one_worker(&site, "");
    let daemon = site.start(&ONE_WORKER);
    let worker = daemon.worker();
    send(worker, Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    sleep(Duration::from_millis(200));
    site.write("drop/a.msh", LONGER);
    send(worker, Signal::CONT);
    daemon.wait_for("mesh.changed", "a.msh");
    daemon.wait_for("mesh.scored", "a.msh");
    assert_eq!(site.events_of("mesh.scored", "a.msh").len(), 1);
    assert!(site.summary("a.summary.json")["totals"]["volume"].as_f64().is_some_and(|v| v > 0.3));
}

#[test]
fn a_worker_may_not_take_more_memory_than_it_is_given() {
    let site = Site::new();
    // Threads alone take more than this.
    site.write(
        "meshgauge.toml",
        "[score]\nmemory = \"1MiB\"\nthreads = 64\n[worker]\ncount = 1\nmemory = \"8MiB\"",
    );
    site.write("drop/a.msh", MESH);
    let status = site.once(&ONE_WORKER);
    assert!(matches!(status, Some(3 | 4)), "{status:?}");
    let failed = &site.events("mesh.failed")[0];
    assert!(matches!(failed["kind"].as_str(), Some("worker_died" | "resource")), "{failed}");
}
