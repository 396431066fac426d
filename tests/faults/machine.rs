//! T39, T40: what the machine leaves the daemon, and what the daemon takes of it as time goes by.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::daemon::{BAD, LONGER, MESH, Site};
use crate::oracle::{Follower, all_well, bytes, memory, open_files, told};
use crate::tools::{Random, children, done, times};

/// A group of processes whose memory the kernel limits, page cache included.
struct Group {
    folder: PathBuf,
    /// Whether it is one of version 2.
    unified: bool,
}

impl Group {
    /// `None`, said aloud, where no such group can be made.
    fn new(name: &str, limit: u64) -> Option<Self> {
        let roots = [("/sys/fs/cgroup", true), ("/sys/fs/cgroup/memory", false)];
        for (root, unified) in roots {
            let root = Path::new(root);
            let (known, file) = match unified {
                true => ("cgroup.controllers", "memory.max"),
                false => ("memory.oom_control", "memory.limit_in_bytes"),
            };
            let folder = root.join(format!("meshgauge-{name}-{}", std::process::id()));
            if !root.join(known).exists() || fs::create_dir(&folder).is_err() {
                continue;
            }
            if unified {
                // It is on where anybody else uses it.
                let _ = fs::write(root.join("cgroup.subtree_control"), "+memory");
            }
            let group = Self { folder, unified };
            if fs::write(group.folder.join(file), limit.to_string()).is_ok() {
                // Where nothing can be swapped there is nothing to forbid.
                let _ = fs::write(group.folder.join("memory.swap.max"), "0");
                return Some(group);
            }
        }
        eprintln!("skipped: no memory can be limited by a control group here");
        None
    }

    /// The command, within the group.
    fn within(&self, plain: &Command) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", "echo $$ > \"$0/cgroup.procs\" && exec \"$@\""]).arg(&self.folder);
        command.arg(plain.get_program()).args(plain.get_args());
        if let Some(folder) = plain.get_current_dir() {
            command.current_dir(folder);
        }
        command.env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// How many of its processes the kernel killed for want of memory.
    fn kills(&self) -> u64 {
        let file = if self.unified { "memory.events" } else { "memory.oom_control" };
        let text = String::from_utf8_lossy(&bytes(&self.folder.join(file))).into_owned();
        let line = text.lines().find_map(|line| line.strip_prefix("oom_kill "));
        line.and_then(|count| count.trim().parse().ok()).expect("the kernel counts")
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        for _ in 0..100 {
            if fs::remove_dir(&self.folder).is_ok() {
                return;
            }
            sleep(Duration::from_millis(50));
        }
    }
}

fn generate(site: &Site, elements: &str) {
    let made = Command::new(env!("CARGO_BIN_EXE_meshgauge"))
        .args(["generate", "pit-specimen", "--elements", elements, "-o"])
        .arg(site.path("drop/large.msh"))
        .stdout(Stdio::null())
        .status();
    assert!(made.expect("the program runs").success());
}

#[test]
fn t39_meshes_that_are_larger_than_the_memory_of_the_group() {
    let Some(group) = Group::new("large", 96 << 20) else { return };
    let site = Site::new();
    // About 46 bytes an element: 0.24 GB, or 5 GB.
    generate(&site, if times(0, 1) == 0 { "5e6" } else { "1.1e8" });
    let size = fs::metadata(site.path("drop/large.msh")).expect("a mesh").len();
    assert!(size > 2 * (96 << 20), "{size} bytes would fit");
    let hole = fs::File::create(site.path("drop/hole.msh")).expect("a file");
    hole.set_len(50 << 30).expect("50 GiB of nothing");
    site.write("drop/small.msh", MESH);
    site.write(
        "meshgauge.toml",
        "[score]\nmemory = \"24MiB\"\nthreads = 2\n[worker]\ncount = 1\nmemory = \"128MiB\"\n",
    );
    let plain = site.command(&["--settle", "1s", "--config", "meshgauge.toml", "--once", "--quiet"]);
    let status = group.within(&plain).status().expect("it runs");
    assert_eq!(status.code(), Some(3), "the hole is no mesh");
    all_well(&site, ["large.msh", "small.msh"]);
    assert_eq!(site.events_of("mesh.failed", "hole.msh").len(), 1);
    assert_eq!(group.kills(), 0, "the kernel killed somebody");
    done(
        "T39",
        &format!("{:.1} GB and 50 GiB of holes in a group of 96 MiB; nobody was killed", size as f64 / 1e9),
    );
}

#[test]
fn t39_the_kernel_kills_a_worker_and_not_the_daemon() {
    let Some(group) = Group::new("small", 28 << 20) else { return };
    let site = Site::new();
    generate(&site, "6e6");
    // The worker is allowed more than there is.
    let config = "[score]\nmemory = \"1GiB\"\n[worker]\ncount = 1\nmemory = \"4GiB\"\nretry = \"1s\"\n";
    site.write("meshgauge.toml", config);
    let plain = site.command(&["--settle", "300ms", "--config", "meshgauge.toml", "--quiet"]);
    let mut child = group.within(&plain).spawn().expect("it runs");
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let quarantined = log.wait(300, |line| line["event"] == "mesh.quarantined");
    let quarantined = quarantined.expect("its second worker was killed too");
    assert_eq!(quarantined["mesh"], "large.msh");
    site.write("drop/small.msh", MESH);
    assert!(log.wait(60, |line| line["event"] == "mesh.scored").is_some(), "the daemon does not go on");
    assert!(child.try_wait().expect("a child").is_none() && group.kills() >= 2);
    let _ = (child.kill(), child.wait());
    done(
        "T39",
        &format!("{} workers killed by the kernel: quarantined, the next mesh scored", group.kills()),
    );
}

/// Meshes come, change, go and are broken for as long as it takes to see what grows.
#[test]
fn t40_a_long_run_takes_no_more_memory_and_files_than_a_short_one() {
    let seconds = std::env::var("MESHGAUGE_FAULTS_SECONDS").ok().and_then(|n| n.parse().ok());
    let seconds: u64 = seconds.unwrap_or_else(|| times(15, 3600));
    let site = Site::new();
    site.write("meshgauge.toml", "[worker]\nretry = \"1h\"\n[log]\nrotate_bytes = \"4MiB\"\n");
    let daemon = site.start(&["--settle", "100ms", "--quiet", "--config", "meshgauge.toml"]);
    let (start, mut random) = (Instant::now(), Random(40));
    let (mut samples, mut versions) = (Vec::new(), 0_u64);
    while start.elapsed() < Duration::from_secs(seconds) {
        // No more than it can keep up with.
        if waiting(&site).is_some_and(|files| files > 500) {
            sleep(Duration::from_millis(300));
            continue;
        }
        for _ in 0..20 {
            let name = format!("drop/{}/{}.msh", random.below(20), random.below(100));
            match random.below(10) {
                0 => drop(fs::remove_file(site.path(&name))),
                1 => site.write(&name, BAD),
                content => site.write(&name, if content % 2 == 0 { MESH } else { LONGER }),
            }
            versions += 1;
        }
        sleep(Duration::from_millis(300));
        let (private, _) = memory(daemon.process());
        samples.push((private, open_files(daemon.process()), children(daemon.process()).len()));
    }
    let end = Instant::now();
    while waiting(&site) != Some(0) {
        assert!(end.elapsed() < Duration::from_secs(600), "files are left");
        sleep(Duration::from_millis(300));
    }
    // The first tenth warms up.
    let tenth = samples.len() / 10 + 1;
    let most = |samples: &[(u64, usize, usize)]| {
        samples.iter().fold((0, 0, 0), |a, b| (a.0.max(b.0), a.1.max(b.1), a.2.max(b.2)))
    };
    let (early, late) = (most(&samples[tenth..2 * tenth]), most(&samples[samples.len() - tenth..]));
    let mut outcomes = std::collections::HashMap::new();
    for (id, count) in site.logs().iter().flat_map(|log| told(log).outcomes) {
        *outcomes.entry(id).or_insert(0) += count;
    }
    assert!(outcomes.values().all(|&count| count == 1), "a version has two outcomes");
    // The pages that SQLite keeps in memory come to 2 MiB, and are not all there from the start.
    assert!(late.0 <= early.0 + 4096, "{} KiB of private memory became {}", early.0, late.0);
    assert!(late.1 <= early.1 + 4 && late.2 <= early.2, "files and workers: {early:?} became {late:?}");
    done(
        "T40",
        &format!(
            "{seconds} s, {versions} files written, changed and removed, {} outcomes in {} logs: private {} -> {} KiB, {} -> {} open files",
            outcomes.len(),
            site.logs().len(),
            early.0,
            late.0,
            early.1,
            late.1
        ),
    );
}

/// How many files are not done with, as the daemon's status says.
fn waiting(site: &Site) -> Option<u64> {
    let status: serde_json::Value =
        serde_json::from_slice(&bytes(&site.path("results/.meshgauge/status.json"))).ok()?;
    status["queue"].as_object()?.values().filter_map(serde_json::Value::as_u64).sum::<u64>().into()
}
