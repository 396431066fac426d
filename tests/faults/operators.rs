//! T11, T43-T45: limits of the kernel, and what operators do to a daemon at work.

use std::collections::HashMap;
use std::fs;
use std::os::unix::net::UnixDatagram;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{scope, sleep};
use std::time::{Duration, Instant};

use rustix::process::Signal;

use crate::daemon::{LONGER, MESH, Site};
use crate::oracle::{Follower, all_well, told};
use crate::tools::{Random, done, has, times};

#[test]
fn t11_the_kernel_watches_fewer_folders_than_there_are() {
    if !has(true, &["unshare"]) {
        return;
    }
    let count = times(1, 10);
    for _ in 0..count {
        let site = Site::new();
        for folder in 0..30 {
            site.write(&format!("drop/{folder}/first.msh"), MESH);
        }
        site.write("meshgauge.toml", "[watch]\nscan = \"1s\"\n");
        let plain = site.command(&["--settle", "100ms", "--quiet", "--config", "meshgauge.toml"]);
        // A namespace of users has a limit of its own.
        let limit = "echo 10 > /proc/sys/user/max_inotify_watches && exec \"$@\"";
        let mut command = Command::new("unshare");
        command.args(["-Ur", "sh", "-c", limit, "sh"]).arg(plain.get_program()).args(plain.get_args());
        command.current_dir(site.path(".")).env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null());
        let errors = fs::File::create(site.path("errors")).expect("a file");
        let mut child = command.stderr(errors).spawn().expect("unshare runs");
        let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
        assert_eq!(log.count(600, "mesh.scored", 30).len(), 30);
        for folder in 0..30 {
            site.write(&format!("drop/{folder}/second.msh"), LONGER);
        }
        assert_eq!(log.count(600, "mesh.scored", 30).len(), 30);
        let _ = (child.kill(), child.wait());
        let errors = site.text("errors").expect("text");
        assert_eq!(errors.matches("the scan finds its meshes").count(), 1, "{errors}");
    }
    done("T11", &format!("{count} times 30 folders with 10 watches: all found by the scan, one warning"));
}

/// Meshes come one after another until `end`; their number is returned.
fn meshes_until(site: &Site, end: &AtomicBool) -> u64 {
    let mut count = 0;
    while !end.load(Ordering::Relaxed) {
        site.write(&format!("drop/{count}.msh"), if count % 2 == 0 { MESH } else { LONGER });
        count += 1;
        sleep(Duration::from_millis(10));
    }
    count
}

/// Waits until so many meshes are scored, and wants each of them once over all logs.
fn all_scored_once(site: &Site, meshes: u64) {
    let start = Instant::now();
    loop {
        let mut scored: HashMap<String, u64> = HashMap::new();
        for (mesh, count) in site.logs().iter().flat_map(|log| told(log).scored) {
            *scored.entry(mesh).or_default() += count;
        }
        if scored.len() as u64 == meshes {
            assert!(scored.values().all(|&count| count == 1), "{scored:?}");
            return;
        }
        assert!(start.elapsed().as_secs() < 1200, "{} of {meshes} are scored", scored.len());
        sleep(Duration::from_secs(2));
    }
}

#[test]
fn t43_configurations_sound_and_broken_while_meshes_flow() {
    let site = Site::new();
    site.write("meshgauge.toml", "");
    let daemon = site.start(&["--settle", "100ms", "--quiet", "--config", "meshgauge.toml"]);
    let (count, end, mut random) = (times(20, 1000), AtomicBool::new(false), Random(43));
    let meshes = scope(|threads| {
        let meshes = threads.spawn(|| meshes_until(&site, &end));
        for round in 0..count {
            // Either both settings are there or none is.
            let text = match round % 3 {
                0 => "[verdict]\nfail_under = { M31 = 0.9 }\n[worker]\ncount = 3\n",
                1 => "[verdict]\nfail_undr = 1\n",
                _ => "",
            };
            site.write("new.toml", text);
            fs::rename(site.path("new.toml"), site.path("meshgauge.toml")).expect("renamed");
            daemon.signal(Signal::HUP);
            sleep(Duration::from_millis(random.below(40)));
        }
        end.store(true, Ordering::Relaxed);
        meshes.join().expect("a thread")
    });
    all_scored_once(&site, meshes);
    let (taken, refused) = (site.events("config.reloaded").len(), site.events("config.refused").len());
    assert!(taken > 0 && refused > 0);
    for line in site.events("mesh.scored") {
        assert!(matches!(line["status"].as_str(), Some("pass" | "fail")), "{line}");
    }
    done(
        "T43",
        &format!(
            "{count} signals, {taken} taken and {refused} refused, {meshes} meshes meanwhile: each scored once"
        ),
    );
}

#[test]
fn t44_the_log_is_moved_away_while_meshes_flow() {
    let site = Site::new();
    site.write("meshgauge.toml", "[log]\nrotate_bytes = \"64KiB\"\n");
    let daemon = site.start(&["--settle", "100ms", "--quiet", "--config", "meshgauge.toml"]);
    let (count, end) = (times(10, 100), AtomicBool::new(false));
    let log = site.path("results/meshgauge.jsonl");
    let meshes = scope(|threads| {
        let meshes = threads.spawn(|| meshes_until(&site, &end));
        for round in 0..count {
            sleep(Duration::from_millis(300));
            // As `create` of logrotate, with the signal and, every third time, without.
            if fs::rename(&log, site.path(&format!("results/meshgauge.jsonl.moved{round}"))).is_ok()
                && round % 3 != 0
            {
                daemon.signal(Signal::USR1);
            }
        }
        end.store(true, Ordering::Relaxed);
        meshes.join().expect("a thread")
    });
    all_scored_once(&site, meshes);
    done(
        "T44",
        &format!(
            "{count} times, {} logs, {meshes} meshes meanwhile: no line lost or doubled",
            site.logs().len()
        ),
    );
}

/// The loop stands still in a call that does not return; everything else in the process runs.
#[test]
fn t45_a_loop_that_stands_still_feeds_no_watchdog() {
    if !has(true, &["strace"]) {
        return;
    }
    let count = times(1, 10);
    for _ in 0..count {
        let site = Site::new();
        let socket = UnixDatagram::bind(site.path("notify")).expect("a socket");
        socket.set_read_timeout(Some(Duration::from_millis(100))).expect("a timeout");
        let mut daemon = site.command(&["--settle", "50ms", "--quiet"]);
        daemon.env("NOTIFY_SOCKET", site.path("notify")).env("WATCHDOG_USEC", "2000000");
        let mut child = daemon.stderr(Stdio::null()).spawn().expect("it runs");
        let fed = |seconds: u64| {
            let (start, mut buffer, mut fed) = (Instant::now(), [0; 4096], 0);
            while start.elapsed() < Duration::from_secs(seconds) {
                if let Ok(length) = socket.recv(&mut buffer) {
                    fed += u64::from(String::from_utf8_lossy(&buffer[..length]).contains("WATCHDOG=1"));
                }
            }
            fed
        };
        assert!(fed(4) >= 2, "a loop that turns feeds it");
        let mut strace = Command::new("strace");
        strace.args(["-f", "-qq", "-o", "/dev/null", "-e", "trace=fdatasync", "-p", &child.id().to_string()]);
        strace.args(["-e", "inject=fdatasync:delay_enter=8000000:when=1"]);
        let mut strace = strace.stderr(Stdio::null()).spawn().expect("strace runs");
        sleep(Duration::from_millis(500));
        site.write("drop/a.msh", MESH);
        let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
        assert!(log.wait(300, |line| line["event"] == "mesh.scored").is_some());
        // The line is written, and the call that has it on disk stands still.
        while socket.recv(&mut [0; 4096]).is_ok() {}
        assert_eq!(fed(4), 0, "a loop that stands still feeds it");
        assert!(fed(10) >= 2, "a loop that turns again feeds it");
        all_well(&site, ["a.msh"]);
        let _ = (child.kill(), child.wait(), strace.kill(), strace.wait());
    }
    done(
        "T45",
        &format!("{count} times the loop stood still for 8 s: not fed, and fed again when it turned"),
    );
}
