//! T26: who reads a summary sees the old one or the new one.

use std::fs::File;
use std::io::BufReader;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::{scope, sleep};
use std::time::Duration;

use crate::daemon::{LONGER, MESH, Site};
use crate::oracle::Follower;
use crate::tools::{done, times};

#[test]
fn t26_a_reader_sees_whole_summaries() {
    let site = Site::new();
    site.write("drop/a.msh", MESH);
    let daemon = site.start(&["--settle", "30ms"]);
    daemon.wait_for("mesh.scored", "a.msh");
    site.summary("a.summary.json");
    let (end, reads, versions) = (AtomicBool::new(false), AtomicU64::new(0), times(10, 1000));
    scope(|threads| {
        threads.spawn(|| {
            while !end.load(Ordering::Relaxed) {
                let file = File::open(site.path("results/a.summary.json")).expect("it is always there");
                let summary: serde_json::Value =
                    serde_json::from_reader(BufReader::new(file)).expect("it is always whole");
                assert!(summary["totals"]["volume"].as_f64().is_some_and(|volume| volume > 0.1));
                reads.fetch_add(1, Ordering::Relaxed);
            }
        });
        let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
        log.wait(60, |event| event["event"] == "mesh.scored");
        for version in 0..versions {
            site.write("drop/a.msh", if version % 2 == 0 { LONGER } else { MESH });
            assert!(log.wait(60, |event| event["event"] == "mesh.scored").is_some(), "version {version}");
        }
        sleep(Duration::from_millis(50));
        end.store(true, Ordering::Relaxed);
    });
    done("T26", &format!("{versions} versions, {} reads; each whole", reads.into_inner()));
}
