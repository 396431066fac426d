//! T10, T30, T33, T34: many files, and files that are nothing.

use std::fs::{self, File};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rustix::process::Signal;

use crate::daemon::{MESH, Site};
use crate::oracle::{Follower, memory, open_files, told};
use crate::tools::{done, has, times};

/// The kernel keeps this many events for one who does not read them.
fn queue_of_events() -> u64 {
    let text = crate::oracle::bytes(std::path::Path::new("/proc/sys/fs/inotify/max_queued_events"));
    String::from_utf8_lossy(&text).trim().parse().unwrap_or(16_384)
}

/// The daemon is stopped while more files arrive than the kernel keeps events of.
#[test]
fn t10_events_overflow() {
    let (rounds, files) = (times(1, 5), times(6_000, 20_000));
    // Each file is made, written and closed.
    assert!(3 * files > queue_of_events(), "the queue would not overflow");
    let mut most = 0;
    for _ in 0..rounds {
        let site = Site::new();
        site.write("meshgauge.toml", "[watch]\nscan = \"1h\"\n");
        let daemon = site.start(&["--config", "meshgauge.toml", "--settle", "100ms", "--quiet"]);
        site.write("drop/first.msh", MESH);
        daemon.wait_for("mesh.scored", "first.msh");
        daemon.signal(Signal::STOP);
        for file in 0..files {
            site.write(&format!("drop/{file}.msh"), MESH);
        }
        daemon.signal(Signal::CONT);
        let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
        let scored = log.count(1200, "mesh.scored", files as usize + 1);
        assert_eq!(scored.len() as u64, files + 1);
        assert!(scored.values().all(|&count| count == 1));
        most = most.max(memory(daemon.process()).1);
    }
    assert!(most < 64 << 10, "the daemon took {most} KiB");
    done(
        "T10",
        &format!(
            "{rounds} times {files} files, with no scan but the one that the overflow asks for; lost 0, daemon at most {most} KiB"
        ),
    );
}

/// As many files as a year of a cluster brings, at once.
#[test]
fn t34_a_million_tiny_files() {
    let files = std::env::var("MESHGAUGE_FAULTS_FILES").ok().and_then(|n| n.parse().ok());
    let files: u64 = files.unwrap_or_else(|| times(2_000, 1_000_000));
    let site = Site::new();
    for file in 0..files {
        let folder = site.path(&format!("drop/{}", file / 1000));
        if file % 1000 == 0 {
            fs::create_dir(&folder).expect("a folder");
        }
        fs::write(folder.join(format!("{file}.msh")), MESH).expect("written");
    }
    let start = Instant::now();
    let daemon = site.start(&["--settle", "1s", "--quiet"]);
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let (mut scored, mut open, mut early) = (0, open_files(daemon.process()), 0);
    while scored < files {
        let event = log.wait(600, |event| event["event"] == "mesh.scored" || event["event"] == "mesh.failed");
        assert_eq!(event.expect("it goes on")["event"], "mesh.scored");
        scored += 1;
        if scored == files / 10 {
            (early, open) = (memory(daemon.process()).0, open_files(daemon.process()));
        }
    }
    let took = start.elapsed().as_secs_f64();
    let (private, most) = memory(daemon.process());
    let opened = open_files(daemon.process());
    let told = told(&site.path("results/meshgauge.jsonl"));
    assert!(told.scored.len() as u64 == files && told.outcomes.values().all(|&count| count == 1));
    println!(
        "T34: {files} files, {took:.0} s, private {early} -> {private} KiB, at most {most} KiB, {open} -> {opened} open"
    );
    assert!(opened <= open + 8, "{open} open files became {opened}");
    assert!(most < 64 << 10, "the daemon took {most} KiB for {files} files");
}

#[test]
fn t30_malformed_meshes_one_after_another() {
    let site = Site::new();
    let count = times(20, 300);
    let lines: Vec<_> = MESH.lines().collect();
    for number in 0..count {
        // A line is left out, doubled, or has its first digit replaced; all but the last two lines matter.
        let at = 3 + number as usize % (lines.len() - 5);
        let mut broken = lines.clone();
        let odd = format!("x{}", lines[at]);
        match number % 3 {
            0 => drop(broken.remove(at)),
            1 => broken.insert(at, &odd),
            _ => broken[at] = &odd,
        }
        site.write(&format!("drop/{number}.msh"), &broken.join("\n"));
    }
    let daemon = site.start(&["--settle", "100ms"]);
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let failed = log.count(1200, "mesh.failed", count as usize);
    let start = Instant::now();
    site.write("drop/good.msh", MESH);
    daemon.wait_for("mesh.scored", "good.msh");
    let next = start.elapsed();
    assert_eq!(
        failed.len() as u64,
        count,
        "{:?}",
        site.events("mesh.scored").iter().map(|e| &e["mesh"]).collect::<Vec<_>>()
    );
    for event in site.events("mesh.failed") {
        assert!(
            event["reason"].as_str().is_some_and(|reason| !reason.is_empty())
                && event["kind"] != "worker_died",
            "{event}"
        );
    }
    done(
        "T30",
        &format!(
            "{count} malformed meshes, each failed with a reason; the next good one scored after {:.1} s",
            next.as_secs_f64()
        ),
    );
}

#[test]
fn t33_a_line_without_an_end_nothing_at_all_and_two_bytes_a_letter() {
    let site = Site::new();
    let size = times(1 << 30, 10 << 30);
    File::create(site.path("drop/nuls.msh")).and_then(|file| file.set_len(size)).expect("a file with a hole");
    site.write("drop/empty.msh", "");
    let wide: Vec<u8> = MESH.encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(site.path("drop/wide.msh"), [b"\xff\xfe".to_vec(), wide].concat()).expect("written");
    let line = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}", "1 ".repeat(4 << 20));
    site.write("drop/line.msh", &line);
    let daemon = site.start(&["--settle", "100ms"]);
    for name in ["nuls.msh", "empty.msh", "wide.msh", "line.msh"] {
        daemon.wait_for("mesh.failed", name);
    }
    sleep(Duration::from_millis(100));
    assert!(site.events("mesh.failed").iter().all(|event| event["kind"] != "worker_died"));
    let most = memory(daemon.process()).1;
    assert!(most < 64 << 10, "the daemon took {most} KiB");
    done(
        "T33",
        &format!(
            "{} GiB of nothing, no bytes, UTF-16, a line of 8 MiB: each failed with a reason",
            size >> 30
        ),
    );
}

/// What a scan of a million files costs is what it asks the kernel about each.
#[test]
fn a_scan_asks_the_kernel_once_about_each_file() {
    if !has(false, &["strace"]) {
        return;
    }
    let site = Site::new();
    let files = 2000;
    for file in 0..files {
        site.write(&format!("drop/{}/{file}.msh", file / 100), MESH);
    }
    assert_eq!(site.once(&["--settle", "50ms", "--quiet"]), Some(0));
    let plain = site.command(&["--settle", "50ms", "--quiet", "--once"]);
    let mut command = Command::new("strace");
    command.args(["-f", "-qq", "-o"]).arg(site.path("trace")).args(["-e", "trace=%file,%desc"]);
    command.arg(plain.get_program()).args(plain.get_args()).current_dir(site.path("."));
    let status = command.env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null()).status();
    assert_eq!(status.expect("strace runs").code(), Some(0));
    let trace = String::from_utf8_lossy(&crate::oracle::bytes(&site.path("trace"))).into_owned();
    let about = trace.lines().filter(|line| line.contains(".msh\"")).count();
    assert_eq!(about, files, "calls that name a mesh");
    // What is done is looked up together.
    let all = trace.lines().count();
    assert!(all < 2 * files, "{all} calls for {files} files");
}
