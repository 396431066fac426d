//! T9: a mesh that is cut while it is read.

use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::daemon::{MESH, Site};
use crate::oracle::{Follower, memory};
use crate::tools::{Random, children, done, is_alive, times};

/// A mesh of a few megabytes: reading it takes a while.
fn large() -> String {
    let (nodes, elements) = (100_000, 400_000);
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n");
    for node in 1..=nodes {
        let _ = writeln!(text, "{node} {}.5 {}.25 {}.125", node % 31, node / 31 % 31, node / 961);
    }
    let _ = write!(text, "$EndNodes\n$Elements\n{elements}\n");
    for element in 1..=elements {
        let first = element % (nodes - 2000) + 1;
        let _ = writeln!(text, "{element} 4 2 1 1 {first} {} {} {}", first + 1, first + 31, first + 961);
    }
    text + "$EndElements\n"
}

#[test]
fn t09_cut_while_it_is_mapped() {
    let site = Site::new();
    let large = large();
    let whole = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(large.as_bytes()));
    site.write("meshgauge.toml", "[score]\nthreads = 1\n[worker]\ncount = 2\n");
    let daemon = site.start(&["--config", "meshgauge.toml", "--settle", "20ms"]);
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let mut random = Random(9);
    let (rounds, mut deaths, mut before) = (times(5, 500), 0, 0);
    for round in 0..rounds {
        let name = format!("{round}.msh");
        site.write(&format!("drop/{name}"), &large);
        let workers = children(daemon.process());
        let about = |event: &Value, what: &str| event["event"] == what && event["mesh"] == name.as_str();
        assert!(log.wait(60, |event| about(event, "mesh.claimed")).is_some(), "{name} was not claimed");
        sleep(Duration::from_millis(random.below(40)));
        let length = [0, large.len() as u64 / 2][(round % 2) as usize];
        let file = OpenOptions::new().write(true).open(site.path(&format!("drop/{name}"))).expect("a file");
        file.set_len(length).expect("cut");
        let ended = log.wait(60, |event| {
            assert!(
                !(about(event, "mesh.scored") && event["xxh3"] != whole.as_str()),
                "a false result: {event}"
            );
            about(event, "mesh.scored") || about(event, "mesh.failed") || about(event, "mesh.changed")
        });
        let ended = ended.unwrap_or_else(|| panic!("{name} has no outcome"));
        let alive = children(daemon.process());
        deaths += workers.iter().filter(|worker| !alive.contains(worker)).count();
        before += u64::from(ended["event"] == "mesh.scored");
        std::fs::remove_file(site.path(&format!("drop/{name}"))).expect("removed");
        assert!(is_alive(daemon.process()), "the daemon ended");
    }
    site.write("drop/last.msh", MESH);
    daemon.wait_for("mesh.scored", "last.msh");
    let (private, most) = memory(daemon.process());
    assert!(most < 64 << 10, "the daemon took {most} KiB");
    done(
        "T9",
        &format!(
            "{rounds} cuts, each with an outcome: {before} scored before the cut, {deaths} workers ended by SIGBUS; \
             false results 0; daemon {private} KiB private, {most} KiB at most"
        ),
    );
}

#[test]
fn t37_over_the_time_limit() {
    let site = Site::new();
    site.write("meshgauge.toml", "[worker]\ncount = 1\ntime = \"500ms\"\n");
    let daemon = site.start(&["--config", "meshgauge.toml", "--settle", "50ms"]);
    let rounds = times(2, 20);
    let mut slowest = Duration::ZERO;
    for round in 0..rounds {
        // Its worker is ended over the mesh, so each round has a new one.
        let worker = children(daemon.process());
        let stopped = format!("{round}.msh");
        worker.iter().for_each(|&worker| crate::daemon::send(worker, rustix::process::Signal::STOP));
        site.write(&format!("drop/{stopped}"), MESH);
        if worker.is_empty() {
            daemon.wait_for("mesh.scored", &stopped);
            continue;
        }
        daemon.wait_for("mesh.claimed", &stopped);
        let start = Instant::now();
        daemon.wait_for("mesh.failed", &stopped);
        slowest = slowest.max(start.elapsed());
        assert_eq!(site.events_of("mesh.failed", &stopped)[0]["kind"], "timeout");
        site.write(&format!("drop/next{round}.msh"), MESH);
        daemon.wait_for("mesh.scored", &format!("next{round}.msh"));
    }
    done(
        "T37",
        &format!(
            "{rounds} times; at most {:.1} s after a claim with a limit of 0.5 s",
            slowest.as_secs_f64()
        ),
    );
}
