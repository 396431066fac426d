//! A daemon that is stopped or killed loses nothing and does nothing twice.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixDatagram;
use std::thread::sleep;
use std::time::Duration;

use rusqlite::Connection;
use rustix::process::Signal;

use crate::daemon::{BAD, MESH, ONE_WORKER, Site, one_worker, send};

#[test]
fn sigterm_and_sigint_stop_a_daemon_at_rest() {
    for signal in [Signal::TERM, Signal::INT] {
        let site = Site::new();
        site.write("drop/bad.msh", BAD);
        let mut daemon = site.start(&[]);
        daemon.wait_for("mesh.failed", "bad.msh");
        daemon.signal(signal);
        assert_eq!(daemon.end().code(), Some(0));
        assert_eq!(site.log().last().map(|line| line["event"].clone()), Some("daemon.stopping".into()));
    }
}

#[test]
fn sigterm_lets_a_running_mesh_finish_and_claims_no_other() {
    let site = Site::new();
    one_worker(&site, "");
    let mut daemon = site.start(&ONE_WORKER);
    let worker = daemon.worker();
    send(worker, Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.detected", "b.msh");
    daemon.signal(Signal::TERM);
    daemon.wait("the stop", || !site.events("daemon.stopping").is_empty());
    send(worker, Signal::CONT);
    assert_eq!(daemon.end().code(), Some(0));
    assert_eq!(site.events_of("mesh.scored", "a.msh").len(), 1);
    assert!(site.events_of("mesh.claimed", "b.msh").is_empty());
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.summaries(), ["a.summary.json", "b.summary.json", "first.summary.json"]);
}

#[test]
fn a_second_sigterm_stops_now_and_the_mesh_is_scored_after_the_next_start() {
    let site = Site::new();
    one_worker(&site, "");
    let mut daemon = site.start(&ONE_WORKER);
    send(daemon.worker(), Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    daemon.signal(Signal::TERM);
    daemon.wait("the stop", || !site.events("daemon.stopping").is_empty());
    daemon.signal(Signal::TERM);
    assert_eq!(daemon.end().code(), Some(0));
    assert!(site.events_of("mesh.scored", "a.msh").is_empty());
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events_of("mesh.scored", "a.msh").len(), 1);
}

#[test]
fn a_daemon_that_is_killed_takes_up_its_work_again() {
    let site = Site::new();
    one_worker(&site, "");
    let mut daemon = site.start(&ONE_WORKER);
    send(daemon.worker(), Signal::STOP);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    daemon.signal(Signal::KILL);
    daemon.end();
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events_of("mesh.scored", "a.msh").len(), 1);
    assert_eq!(site.summaries(), ["a.summary.json", "first.summary.json"]);
}

/// Puts the site into the state in which a crash after the log's line and before the summary's rename leaves it.
fn crash_before_the_summary(site: &Site) {
    let database = Connection::open(site.path("results/.meshgauge/state.db")).expect("a database");
    let log = fs::OpenOptions::new().append(true).read(true).open(site.path("results/meshgauge.jsonl"));
    let mut log = log.expect("a log");
    let mut lines = BufReader::new(&log).lines().map(|line| line.expect("UTF-8"));
    let before: usize = lines.by_ref().take_while(|l| !l.contains("mesh.scored")).map(|l| l.len() + 1).sum();
    let undo = "UPDATE version SET stage = 'claimed'; DELETE FROM score; DELETE FROM shape;";
    database.execute_batch(undo).expect("undone");
    database.execute("UPDATE log_mark SET offset = ?1", [before]).expect("set back");
    fs::remove_file(site.path("results/a.summary.json")).expect("the summary was there");
    fs::write(site.path("results/.meshgauge-x1y2.tmp"), "{").expect("an unfinished summary");
    log.write_all(b"{\"timestamp\":\"2026").expect("a torn line");
}

#[test]
fn a_crash_between_log_and_summary_is_mended_without_a_second_line() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    assert_eq!(site.once(&[]), Some(0));
    crash_before_the_summary(&site);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 1);
    assert_eq!(site.events("log.repaired").len(), 1);
    assert_eq!(site.summaries(), ["a.summary.json"]);
    assert!(!site.path("results/.meshgauge-x1y2.tmp").exists());
    assert_eq!(site.summary("a.summary.json")["elements"]["count"], 1);
    let database = Connection::open(site.path("results/.meshgauge/state.db")).expect("a database");
    let rows = database.query_row("SELECT count(*) FROM history WHERE series = 'a'", [], |row| row.get(0));
    assert_eq!(rows, Ok(4), "the four measures of tetrahedra");
}

#[test]
fn a_second_daemon_with_the_same_state_says_so() {
    let site = Site::new();
    let _daemon = site.start(&[]);
    let second = site.command(&["--once"]).output().expect("the program runs");
    assert_eq!(second.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&second.stderr).contains("another meshgauge watch"));
}

#[test]
fn a_drop_that_is_no_folder_is_wrong_usage() {
    let site = Site::new();
    fs::remove_dir(site.path("drop")).expect("removed");
    assert_eq!(site.once(&[]), Some(2));
}

#[test]
fn the_service_manager_is_told() {
    let site = Site::new();
    let socket = UnixDatagram::bind(site.path("notify")).expect("a socket");
    socket.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
    let mut command = site.command(&[]);
    let mut child = command
        .env("NOTIFY_SOCKET", site.path("notify"))
        .env("WATCHDOG_USEC", "400000")
        .spawn()
        .expect("the program runs");
    let heard = |what: &str| {
        let mut buffer = [0; 4096];
        for _ in 0..1000 {
            let length = socket.recv(&mut buffer).expect("a message");
            if String::from_utf8_lossy(&buffer[..length]).lines().any(|line| line == what) {
                return;
            }
        }
        panic!("{what} was not heard");
    };
    heard("READY=1");
    heard("WATCHDOG=1");
    sleep(Duration::from_millis(50));
    send(child.id(), Signal::TERM);
    heard("STOPPING=1");
    assert_eq!(child.wait().expect("a child").code(), Some(0));
}
