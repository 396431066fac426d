//! What a daemon tells of itself, whether it runs, hangs or is dead.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};
use std::time::Duration;

use rustix::process::Signal;
use serde_json::Value;

use crate::daemon::{BAD, MESH, Site, send};

/// A configuration with one worker whose daemon tells of itself all the time.
fn telling(site: &Site, more: &str) {
    let text = format!("[worker]\ncount = 1\n[telemetry]\ninterval = \"100ms\"\nstalled = \"30s\"\n{more}");
    site.write("meshgauge.toml", &text);
}

const TELLING: [&str; 2] = ["--config", "meshgauge.toml"];

/// `meshgauge status` with options that have no blanks in them: exit status and output.
fn status(site: &Site, options: &str) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_meshgauge"))
        .arg("status")
        .args(options.split_whitespace())
        .current_dir(site.path("."))
        .env_remove("MESHGAUGE_CONFIG")
        .env_remove("STATE_DIRECTORY")
        .stderr(Stdio::inherit())
        .output()
        .expect("the program runs");
    (output.status.code(), String::from_utf8(output.stdout).expect("UTF-8"))
}

fn json(site: &Site) -> (Option<i32>, Value) {
    let (code, text) = status(site, "--json");
    (code, serde_json::from_str(&text).unwrap_or_default())
}

fn cause(site: &Site, path: &str) -> (Option<i32>, String) {
    let (code, text) = status(site, &format!("--json --explain {path}"));
    let answer: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
    (code, answer["state"].as_str().unwrap_or_default().to_owned())
}

#[test]
fn a_running_daemon_tells_what_it_is_at() {
    let site = Site::new();
    telling(&site, "");
    let daemon = site.start(&TELLING);
    let worker = daemon.worker();
    site.write("drop/bad.msh", BAD);
    daemon.wait_for("mesh.failed", "bad.msh");
    send(worker, Signal::STOP);
    site.write("drop/a.msh", MESH);
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.claimed", "a.msh");
    // The file that is looked at may be older than the claim, with `a` still in the queue.
    daemon.wait("a to run and b to be queued", || {
        let (_, told) = json(&site);
        let told = &told["status"];
        told["running"][0]["mesh"] == "a.msh" && told["queue"]["queued"] == 1
    });
    let (code, told) = json(&site);
    assert_eq!((code, &told["health"]), (Some(0), &"well".into()), "{told}");
    let told = &told["status"];
    assert_eq!(told["process"]["pid"], daemon.process());
    assert_eq!(
        (&told["running"][0]["mesh"], &told["running"][0]["phase"]),
        (&"a.msh".into(), &"opening".into())
    );
    assert_eq!(told["waiting"][0]["mesh"], "b.msh");
    assert_eq!(
        (&told["outcomes"]["scored"], &told["failures"]["malformed"]),
        (&1.into(), &1.into()),
        "{told}"
    );
    assert_eq!(told["last_errors"][0]["mesh"], "bad.msh");
    assert!(told["watches"][0]["scans"].as_u64() > Some(0), "{told}");
    assert_eq!(cause(&site, "drop/a.msh"), (Some(1), "running".into()));
    assert_eq!(cause(&site, "b.msh"), (Some(1), "queued".into()));
    assert_eq!(cause(&site, "first.msh"), (Some(0), "scored".into()));
    assert_eq!(cause(&site, "drop/bad.msh"), (Some(3), "failed".into()));
    let (_, text) = status(&site, "--explain bad.msh");
    assert!(text.contains("malformed") && text.contains("line 7"), "{text}");
    let (code, text) = status(&site, "");
    assert_eq!(code, Some(0));
    assert!(text.contains("running") && text.contains("a.msh") && text.contains("bad.msh"), "{text}");
    send(worker, Signal::CONT);
}

#[test]
fn a_daemon_that_is_stopped_by_a_signal_is_told_from_a_dead_one_and_from_one_that_ended() {
    let site = Site::new();
    telling(&site, "");
    let mut daemon = site.start(&TELLING);
    daemon.wait("a status", || json(&site).0 == Some(0));
    daemon.signal(Signal::STOP);
    daemon.wait("the stop", || json(&site).1["health"] == "stopped");
    assert_eq!(json(&site).0, Some(1));
    site.write("drop/a.msh", MESH);
    let (_, text) = status(&site, "--explain a.msh");
    assert!(text.contains("stopped by a signal"), "{text}");
    daemon.signal(Signal::CONT);
    daemon.wait_for("mesh.scored", "a.msh");
    daemon.signal(Signal::KILL);
    daemon.end();
    let (code, told) = json(&site);
    assert_eq!((code, &told["health"]), (Some(1), &"dead".into()));
    let mut daemon = site.start(&TELLING);
    daemon.wait("a status", || json(&site).0 == Some(0));
    daemon.signal(Signal::TERM);
    daemon.end();
    let (code, told) = json(&site);
    assert_eq!(
        (code, &told["health"], &told["status"]["ended"]),
        (Some(0), &"ended".into(), &"SIGTERM".into())
    );
}

#[test]
fn a_status_that_was_never_written_is_wrong_usage() {
    assert_eq!(status(&Site::new(), "--state nowhere").0, Some(2));
}

#[test]
fn every_reason_why_a_file_is_not_scored_has_its_word() {
    let site = Site::new();
    telling(&site, "[watch]\ndepth = 2\n");
    let daemon = site.start(&["--config", "meshgauge.toml", "--settle", "1h"]);
    site.write("outside.msh", MESH);
    site.write("drop/a.msh.part", MESH);
    site.write("drop/sub/deep/deeper.msh", MESH);
    site.write("drop/settling.msh", MESH);
    symlink("nothing", site.path("drop/link.msh")).expect("linked");
    daemon.wait_for("mesh.detected", "settling.msh");
    daemon.wait("it to be told", || json(&site).1["status"]["queue"]["settling"] == 1);
    for (path, expected) in [
        ("outside.msh", (Some(1), "outside")),
        ("drop/a.msh.part", (Some(1), "ignored_name")),
        ("sub/deep/deeper.msh", (Some(1), "too_deep")),
        ("drop/nothing.msh", (Some(3), "absent")),
        ("link.msh", (Some(1), "not_a_file")),
        ("settling.msh", (Some(1), "settling")),
    ] {
        assert_eq!(cause(&site, path), (expected.0, expected.1.to_owned()), "{path}");
    }
}

/// The answer to a request.
fn get(port: u16, path: &str) -> std::io::Result<String> {
    let mut stream = TcpStream::connect(("127.0.0.1", port))?;
    stream.set_read_timeout(Some(Duration::from_secs(30)))?;
    write!(stream, "GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")?;
    let mut answer = Vec::new();
    std::io::copy(&mut stream.take(1 << 20), &mut answer)?;
    Ok(String::from_utf8_lossy(&answer).into_owned())
}

/// A port that is free now.
fn free_port() -> u16 {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.local_addr().expect("an address").port()
}

#[test]
fn metrics_are_told_by_file_and_over_http() {
    let (site, port) = (Site::new(), free_port());
    telling(&site, &format!("metrics_file = \"metrics/meshgauge.prom\"\nlisten = \"127.0.0.1:{port}\"\n"));
    let daemon = site.start(&TELLING);
    site.write("drop/a.msh", MESH);
    site.write("drop/bad.msh", BAD);
    daemon.wait_for("mesh.scored", "a.msh");
    daemon.wait_for("mesh.failed", "bad.msh");
    let expected =
        ["meshgauge_meshes_total{outcome=\"scored\"} 1", "meshgauge_failures_total{kind=\"malformed\"} 1"];
    let whole = |text: &str| expected.iter().all(|line| text.lines().any(|l| l == *line));
    daemon.wait("the file", || site.text("metrics/meshgauge.prom").is_some_and(|text| whole(&text)));
    assert!(whole(&get(port, "/metrics").expect("an answer")));
    assert!(!get(port, "/metrics").expect("an answer").contains(".msh"), "a path in a label");
    assert!(get(port, "/healthz").expect("an answer").starts_with("HTTP/1.1 200"));
    assert!(get(port, "/readyz").expect("an answer").starts_with("HTTP/1.1 200"));
    assert!(get(port, "/").expect("an answer").contains("/healthz"));
    if let Some(promtool) = std::env::var_os("MESHGAUGE_PROMTOOL") {
        let file = std::fs::File::open(site.path("metrics/meshgauge.prom")).expect("the file");
        let said =
            Command::new(promtool).args(["check", "metrics"]).stdin(file).output().expect("promtool runs");
        assert!(said.status.success() && said.stderr.is_empty(), "{said:?}");
    } else {
        eprintln!("skipped: promtool, which MESHGAUGE_PROMTOOL names");
    }
}

#[test]
fn a_client_that_says_nothing_does_not_keep_others_from_the_metrics() {
    let (site, port) = (Site::new(), free_port());
    telling(&site, &format!("listen = \"127.0.0.1:{port}\"\n"));
    let daemon = site.start(&TELLING);
    daemon.wait("the endpoint", || get(port, "/healthz").is_ok());
    // More than are served at a time: they are cut off when they say nothing.
    let idle: Vec<_> = (0..20).map(|_| TcpStream::connect(("127.0.0.1", port)).expect("connected")).collect();
    assert!(get(port, "/healthz").expect("an answer").starts_with("HTTP/1.1 200"));
    drop(idle);
}

#[test]
fn an_address_that_others_can_reach_is_refused() {
    let site = Site::new();
    telling(&site, "listen = \"0.0.0.0:9817\"\n");
    assert_eq!(site.once(&TELLING), Some(2));
}
