//! What an operator asks of a running daemon.

use std::fs;
use std::os::unix::net::UnixDatagram;
use std::time::Duration;

use rustix::process::Signal;

use crate::daemon::{MESH, ONE_WORKER, Site};

#[test]
fn sighup_takes_a_sound_configuration_and_refuses_another() {
    let site = Site::new();
    site.write("meshgauge.toml", "");
    let daemon = site.start(&ONE_WORKER);
    site.write("drop/a.msh", MESH);
    daemon.wait_for("mesh.scored", "a.msh");
    site.write("meshgauge.toml", "[verdict]\nfail_undr = { M31 = 0.9 }");
    daemon.signal(Signal::HUP);
    daemon.wait("the refusal", || !site.events("config.refused").is_empty());
    let reason = site.events("config.refused")[0]["reason"].to_string();
    assert!(reason.contains("line 2") && reason.contains("fail_under"), "{reason}");
    site.write("drop/b.msh", MESH);
    daemon.wait_for("mesh.scored", "b.msh");
    site.write("meshgauge.toml", "[verdict]\nfail_under = { M31 = 0.9 }");
    daemon.signal(Signal::HUP);
    daemon.wait("the new configuration", || !site.events("config.reloaded").is_empty());
    site.write("drop/c.msh", MESH);
    daemon.wait_for("mesh.scored", "c.msh");
    let status = |mesh| site.events_of("mesh.scored", mesh)[0]["status"].clone();
    assert_eq!([status("a.msh"), status("b.msh"), status("c.msh")], ["pass", "pass", "fail"]);
    assert!(site.events("config.reloaded")[0].get("needs_restart").is_none());
    site.write("meshgauge.toml", "[watch]\nlog = \"elsewhere.jsonl\"");
    daemon.signal(Signal::HUP);
    daemon.wait("another configuration", || site.events("config.reloaded").len() == 2);
    assert_eq!(site.events("config.reloaded")[1]["needs_restart"], "watch.log");
}

#[test]
fn sighup_takes_other_tolerances_of_baselines_and_asks_for_events_or_not() {
    let site = Site::new();
    site.write("meshgauge.toml", "");
    let daemon = site.start(&ONE_WORKER);
    let lower = |height: &str| MESH.replace("4 0 0 1\n", &format!("4 0 0 {height}\n"));
    let mut reloads = 0;
    let mut reload = |text: &str| {
        site.write("meshgauge.toml", text);
        daemon.signal(Signal::HUP);
        reloads += 1;
        daemon.wait("the new configuration", || site.events("config.reloaded").len() == reloads);
        assert!(site.events("config.reloaded")[reloads - 1].get("needs_restart").is_none());
    };
    // The versions of one mesh, each with what it is called beside the first.
    let mut scored = 0;
    let mut land = |height: &str, regressed: usize| {
        site.write("drop/a.msh", &lower(height));
        scored += 1;
        daemon.wait("its score", || site.events_of("mesh.scored", "a.msh").len() == scored);
        daemon.wait("its end", || {
            site.summary("a.summary.json")["mesh"]["xxh3"] == site.events("mesh.scored")[scored - 1]["xxh3"]
        });
        assert_eq!(site.events("mesh.regressed").len(), regressed, "{height}");
    };
    land("1", 0);
    land("0.1", 1);
    reload(
        "[compare]\nminimum = { absolute = 1.0 }\nmean = { absolute = 1.0 }\nquantile = { absolute = 1.0 }\ndistance = 1.0\n\
            under = 1e9\nchecks = 1e9\nvolume = 1.0\nsize = 1e9\n[watch]\nevents = false\nscan = \"500ms\"\n",
    );
    land("0.11", 1);
    reload("[baseline]\ncompare = false\n[watch]\nscan = \"500ms\"\n");
    land("0.01", 1);
    reload("");
    land("0.02", 2);
}

#[test]
fn the_service_manager_is_told_of_a_reload() {
    let site = Site::new();
    let socket = UnixDatagram::bind(site.path("notify")).expect("a socket");
    socket.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
    let mut child = site.command(&[]).env("NOTIFY_SOCKET", site.path("notify")).spawn().expect("it runs");
    let heard = |what: &str| -> String {
        let mut buffer = [0; 4096];
        loop {
            let length = socket.recv(&mut buffer).expect("a message");
            let message = String::from_utf8_lossy(&buffer[..length]).into_owned();
            if message.lines().any(|line| line == what) {
                return message;
            }
        }
    };
    heard("READY=1");
    crate::daemon::send(child.id(), Signal::HUP);
    assert!(heard("RELOADING=1").contains("MONOTONIC_USEC="));
    heard("READY=1");
    crate::daemon::send(child.id(), Signal::TERM);
    heard("STOPPING=1");
    assert_eq!(child.wait().expect("a child").code(), Some(0));
}

#[test]
fn a_full_log_is_put_away_and_no_line_is_lost() {
    let site = Site::new();
    site.write("meshgauge.toml", "[log]\nrotate_bytes = \"1KiB\"\n");
    let daemon = site.start(&ONE_WORKER);
    for i in 0..6 {
        site.write(&format!("drop/{i}.msh"), MESH);
        daemon.wait("its score", || site.all_logs().iter().any(|l| is_score(l, &format!("{i}.msh"))));
        std::thread::sleep(Duration::from_millis(400));
    }
    let logs = site.logs();
    assert!(logs.len() > 1, "{logs:?}");
    let lines = site.all_logs();
    for i in 0..6 {
        assert_eq!(lines.iter().filter(|line| is_score(line, &format!("{i}.msh"))).count(), 1);
    }
    assert!(lines.iter().any(|line| line["event"] == "log.rotated"));
}

fn is_score(line: &serde_json::Value, mesh: &str) -> bool {
    line["event"] == "mesh.scored" && line["mesh"] == mesh
}

#[test]
fn a_log_that_was_moved_away_is_begun_again_with_and_without_a_signal() {
    let site = Site::new();
    let daemon = site.start(&[]);
    let log = site.path("results/meshgauge.jsonl");
    for (mesh, signal) in [("a.msh", true), ("b.msh", false)] {
        fs::rename(&log, site.path(&format!("results/meshgauge.jsonl.{mesh}"))).expect("moved");
        if signal {
            daemon.signal(Signal::USR1);
        }
        daemon.wait("a new log", || log.exists());
        site.write(&format!("drop/{mesh}"), MESH);
        daemon.wait_for("mesh.scored", mesh);
    }
    let scored = site.all_logs().iter().filter(|line| line["event"] == "mesh.scored").count();
    assert_eq!((scored, site.logs().len()), (2, 3));
    drop(daemon);
    assert_eq!(site.once(&[]), Some(0));
    assert_eq!(site.events("mesh.scored").len(), 1, "nothing is logged again");
}
