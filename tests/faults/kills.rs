//! T5, T20-T25, T42: a daemon that is killed or stopped at any moment.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{scope, sleep};
use std::time::Duration;

use rustix::process::Signal;

use crate::daemon::{LONGER, MESH, ONE_WORKER, Site, one_worker, send};
use crate::oracle::{all_well, bytes, told};
use crate::tools::{Random, done, has, times};

/// Meshes that are in flow at a time.
const FLOW: usize = 200;

const QUICK: [&str; 3] = ["--settle", "20ms", "--quiet"];

fn names() -> Vec<String> {
    (0..FLOW).map(|number| format!("{number:03}.msh")).collect()
}

/// Lets meshes flow into the drop, every other one by rename, some of them twice, while `during` runs.
fn flow(site: &Site, seed: u64, during: impl FnOnce(&AtomicBool)) {
    let arrived = AtomicBool::new(false);
    scope(|threads| {
        threads.spawn(|| {
            let mut random = Random(seed);
            for (number, name) in names().iter().enumerate() {
                if number % 2 == 0 {
                    site.write(&format!("drop/{name}.part"), MESH);
                    fs::rename(site.path(&format!("drop/{name}.part")), site.path(&format!("drop/{name}")))
                        .expect("renamed");
                } else {
                    site.write(&format!("drop/{name}"), MESH);
                }
                if random.below(4) == 0 {
                    site.write(&format!("drop/{:03}.msh", random.below(number as u64 + 1)), LONGER);
                }
                sleep(Duration::from_millis(random.below(20)));
            }
            arrived.store(true, Ordering::Relaxed);
        });
        during(&arrived);
    });
}

/// Starts daemons that are ended by `signal` after random times, as long as meshes flow and `kills` says.
fn ended_at_random(seed: u64, kills: u64, signal: Signal) -> u64 {
    let site = Site::new();
    let mut random = Random(seed);
    let mut reader = Reader::follow(&site);
    flow(&site, seed ^ 1, |arrived| {
        let mut left = kills;
        while left > 0 || !arrived.load(Ordering::Relaxed) {
            let mut child = site.command(&QUICK).stderr(Stdio::null()).spawn().expect("the program runs");
            sleep(Duration::from_millis(random.below(400)));
            send(child.id(), signal);
            let status = child.wait().expect("a child");
            if signal == Signal::TERM {
                // Before its handler stands, the signal ends it as it ends any program.
                assert!(matches!(status.code(), Some(0) | None), "{status:?}");
            }
            left = left.saturating_sub(1);
        }
    });
    assert_eq!(site.once(&QUICK), Some(0), "seed {seed}");
    all_well(&site, names().iter().map(String::as_str));
    assert!(site.path("results/.meshgauge").exists());
    let unfinished = fs::read_dir(site.path("results")).expect("results");
    let unfinished =
        unfinished.filter(|e| e.as_ref().is_ok_and(|e| e.file_name().to_string_lossy().ends_with(".tmp")));
    assert_eq!(unfinished.count(), 0, "temporary files are left");
    reader.end(&site)
}

/// `tail -F` of the log into `jq`, as users have it; jq ends at the first line that is not JSON.
struct Reader(Option<(std::process::Child, std::process::Child)>);

impl Reader {
    fn follow(site: &Site) -> Self {
        if !has(false, &["tail", "jq"]) {
            return Self(None);
        }
        let mut tail = Command::new("tail")
            .args(["-n", "+1", "-F", "results/meshgauge.jsonl"])
            .current_dir(site.path("."))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("tail runs");
        let lines = tail.stdout.take().expect("its output");
        let mut jq = Command::new("jq");
        let jq = jq.args(["-c", "--unbuffered", "select(.event == \"mesh.scored\") | .id"]);
        let seen = fs::File::create(site.path("seen")).expect("a file");
        let jq = jq.stdin(lines).stdout(seen).spawn().expect("jq runs");
        Self(Some((tail, jq)))
    }

    /// Number of lines that came out, all of them different.
    fn end(&mut self, site: &Site) -> u64 {
        let Some((mut tail, mut jq)) = self.0.take() else { return 0 };
        sleep(Duration::from_millis(1500));
        assert!(jq.try_wait().expect("a child").is_none(), "jq met a line that is not JSON");
        let _ = tail.kill();
        let _ = (tail.wait(), jq.wait());
        let seen = String::from_utf8(bytes(&site.path("seen"))).expect("UTF-8");
        let mut ids: Vec<_> = seen.lines().collect();
        ids.sort_unstable();
        let all = ids.len();
        ids.dedup();
        assert_eq!(ids.len(), all, "a reader saw a result twice");
        all as u64
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        if let Some((tail, jq)) = &mut self.0 {
            let _ = (tail.kill(), jq.kill());
            let _ = (tail.wait(), jq.wait());
        }
    }
}

#[test]
fn t20_t24_t25_killed_at_random_times_with_200_meshes_in_flow() {
    let (kills, each) = (times(20, 1000), 20);
    let mut results = 0;
    for seed in 0..kills.div_ceil(each) {
        results += ended_at_random(seed, each, Signal::KILL);
        println!("T20: {} kills", (seed + 1) * each);
    }
    done(
        "T20, T24, T25",
        &format!("{kills} kills; {results} results seen by tail -F | jq; lost 0, doubled 0"),
    );
}

#[test]
fn t42_ended_at_random_times_with_200_meshes_in_flow() {
    let (ends, each) = (times(10, 500), 20);
    for seed in 0..ends.div_ceil(each) {
        ended_at_random(1000 + seed, each.min(ends), Signal::TERM);
        println!("T42: {} ends", (seed + 1) * each.min(ends));
    }
    done("T42", &format!("{ends} ends; lost 0, doubled 0"));
}

/// The system calls of the daemon that change something on disk: it is killed at each of the first `when` of each.
#[test]
fn t21_killed_at_each_system_call_that_changes_something() {
    if !has(false, &["strace"]) {
        return;
    }
    let calls =
        ["write", "pwrite64", "fdatasync", "fsync", "rename", "openat", "ftruncate", "unlink", "mkdir"];
    let most = times(3, 40);
    let mut kills = 0;
    for call in calls {
        for when in 1..=most {
            // The first calls of most kinds are those of the start; a random start is as good as any.
            let when = if call == "openat" || call == "write" { when * 7 } else { when };
            let site = Site::new();
            site.write("drop/a.msh", MESH);
            site.write("drop/b.msh", LONGER);
            let plain = site.command(&QUICK);
            let mut command = Command::new("strace");
            command.args(["-f", "-qq", "-o", "/dev/null", "-e", &format!("trace={call}")]);
            command.args(["-e", &format!("inject={call}:signal=SIGKILL:when={when}")]);
            command.arg(plain.get_program()).args(plain.get_args()).arg("--once");
            command.current_dir(site.path(".")).env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null());
            let status = command.stderr(Stdio::null()).status().expect("strace runs");
            kills += u64::from(status.code() != Some(0));
            let status = site.once(&QUICK);
            assert_eq!(status, Some(0), "{call} {when}");
            all_well(&site, ["a.msh", "b.msh"]);
        }
    }
    done("T21", &format!("{kills} kills at {} system calls; lost 0, doubled 0", calls.len()));
}

#[test]
fn t23_the_log_torn_at_every_byte_of_its_last_lines() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    site.write("drop/b.msh", MESH);
    assert_eq!(site.once(&QUICK), Some(0));
    let whole = bytes(&site.path("results/meshgauge.jsonl"));
    let ends: Vec<_> = whole.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(i, _)| i).collect();
    let from = ends[ends.len() - 3] + 1;
    let step = times(97, 1) as usize;
    let mut cuts = 0;
    for cut in (from..whole.len()).step_by(step) {
        let torn = Site::new();
        fs::create_dir_all(torn.path("results")).expect("a folder");
        fs::write(torn.path("results/meshgauge.jsonl"), &whole[..cut]).expect("written");
        assert_eq!(torn.once(&QUICK), Some(0), "cut at {cut}");
        // Every line is whole, and those before the torn one are as they were.
        told(&torn.path("results/meshgauge.jsonl"));
        let after = bytes(&torn.path("results/meshgauge.jsonl"));
        let kept = whole[..cut].iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
        assert_eq!(after[..kept], whole[..kept], "cut at {cut}");
        cuts += 1;
    }
    done("T23", &format!("{cuts} cuts; longest prefix of whole lines kept"));
}

#[test]
fn t05_changed_while_it_is_scored() {
    let site = Site::new();
    one_worker(&site, "");
    let daemon = site.start(&[ONE_WORKER[0], ONE_WORKER[1], "--settle", "50ms"]);
    let worker = daemon.worker();
    let count = times(3, 200);
    for round in 0..count {
        let name = format!("{round}.msh");
        send(worker, Signal::STOP);
        site.write(&format!("drop/{name}"), MESH);
        daemon.wait_for("mesh.claimed", &name);
        sleep(Duration::from_millis(30));
        let mut file =
            OpenOptions::new().append(true).open(site.path(&format!("drop/{name}"))).expect("a file");
        file.write_all(b"\n").expect("appended");
        drop(file);
        send(worker, Signal::CONT);
        daemon.wait_for("mesh.scored", &name);
        assert_eq!(site.events_of("mesh.changed", &name).len(), 1, "{name}");
    }
    let names: Vec<_> = (0..count).map(|round| format!("{round}.msh")).collect();
    all_well(&site, names.iter().map(String::as_str));
    done("T5", &format!("{count} times; each result thrown away, the final version scored once"));
}
