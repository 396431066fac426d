//! A mesh that ends its workers again and again is left alone.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};

use rustix::process::Signal;

use crate::daemon::{Daemon, LONGER, MESH, ONE_WORKER, Site, large_mesh, one_worker, send};

/// Whether a process has mapped a file of this name.
fn has_mapped(process: u32, mesh: &str) -> bool {
    let Ok(maps) = File::open(format!("/proc/{process}/maps")) else { return false };
    BufReader::new(maps).lines().map_while(Result::ok).any(|line| line.ends_with(mesh))
}

/// Ends the worker that has the mesh, at its so-manieth attempt: one that is killed before it took the mesh is the
/// machine's fault, not the mesh's.
fn kill_over(daemon: &Daemon<'_>, site: &Site, mesh: &str, attempt: usize) {
    daemon.wait("the claim", || site.events_of("mesh.claimed", mesh).len() == attempt);
    daemon.wait("the worker", || daemon.workers().iter().any(|worker| has_mapped(*worker, mesh)));
    daemon.workers().into_iter().for_each(|worker| send(worker, Signal::KILL));
}

#[test]
fn a_second_abnormal_end_quarantines_the_version_and_only_that() {
    let site = Site::new();
    one_worker(&site, "retry = \"200ms\"");
    let mut daemon = site.start(&ONE_WORKER);
    site.write("drop/a.msh", &large_mesh(1_000_000));
    kill_over(&daemon, &site, "a.msh", 1);
    daemon.wait_for("mesh.failed", "a.msh");
    let failed = &site.events_of("mesh.failed", "a.msh")[0];
    assert_eq!((&failed["kind"], &failed["retry_seconds"]), (&"worker_died".into(), &0.2.into()), "{failed}");
    kill_over(&daemon, &site, "a.msh", 2);
    daemon.wait_for("mesh.quarantined", "a.msh");
    assert_eq!(site.events_of("mesh.retried", "a.msh")[0]["attempt"], 2);
    assert_eq!(site.events_of("mesh.failed", "a.msh").len(), 1);
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.scored", "b.msh");
    daemon.signal(Signal::TERM);
    assert_eq!(daemon.end().code(), Some(0));
    // No later run touches it, until it changes.
    assert_eq!((site.once(&ONE_WORKER), site.once(&ONE_WORKER)), (Some(0), Some(0)));
    assert_eq!(site.events_of("mesh.claimed", "a.msh").len(), 2);
    fs::write(site.path("drop/a.msh"), LONGER).expect("written");
    assert_eq!(site.once(&ONE_WORKER), Some(0));
    assert_eq!(site.events_of("mesh.scored", "a.msh").len(), 1);
}

#[test]
fn abnormal_ends_are_counted_over_runs() {
    let site = Site::new();
    site.write("meshgauge.toml", "[worker]\ntime = \"1ms\"");
    site.write("drop/large.msh", &large_mesh(400_000));
    let statuses = [(); 3].map(|()| site.once(&ONE_WORKER));
    assert_eq!(statuses, [Some(3), Some(3), Some(0)], "tried, tried again, left alone");
    let log = site.log();
    let outcomes: Vec<_> = log.iter().filter(|line| line["kind"] == "timeout").collect();
    assert_eq!(outcomes.len(), 2);
    assert_eq!(outcomes[0]["event"], "mesh.failed");
    assert_eq!(outcomes[1]["event"], "mesh.quarantined");
}
