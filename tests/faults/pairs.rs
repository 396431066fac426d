//! T47, T48: two daemons with one state.

use std::fs;
use std::process::{Command, Stdio};

use rustix::process::Signal;

use crate::daemon::{MESH, Site, send};
use crate::oracle::{Follower, all_well, told};
use crate::tools::{Mounted, done, has, times};

const QUICK: [&str; 3] = ["--settle", "20ms", "--quiet"];

#[test]
fn t47_two_daemons_with_one_state() {
    let site = Site::new();
    let count = times(3, 100);
    for round in 0..count {
        site.write(&format!("drop/{round}.msh"), MESH);
        let mut pair =
            [0, 1].map(|_| site.command(&QUICK).arg("--once").stderr(Stdio::null()).spawn().expect("runs"));
        let mut codes = pair.each_mut().map(|child| child.wait().expect("a child").code());
        codes.sort_unstable();
        // The second may come when the first is done.
        assert!(matches!(codes, [Some(0), Some(0 | 4)]), "{codes:?}");
    }
    let names: Vec<_> = (0..count).map(|round| format!("{round}.msh")).collect();
    all_well(&site, names.iter().map(String::as_str));
    done("T47", &format!("{count} pairs; one of each active, doubled 0"));
}

/// Two mounts of one folder keep locks apart, as two machines do on a file system whose locks are each machine's own.
#[test]
fn t48_two_machines_with_one_state_of_which_one_stands_still() {
    if !has(true, &["bindfs", "unshare", "hostname"]) {
        return;
    }
    let count = times(1, 5);
    for _ in 0..count {
        let site = Site::new();
        fs::create_dir(site.path("shared")).expect("a folder");
        let (_a, mut bindfs_a) = Mounted::bindfs(&site.path("shared"), &site.path("a"), "attr_timeout=0");
        let (_b, mut bindfs_b) = Mounted::bindfs(&site.path("shared"), &site.path("b"), "attr_timeout=0");
        let on = |machine: &str| {
            let plain = site.command(&QUICK);
            let mut command = Command::new("unshare");
            command.args(["-u", "sh", "-c", &format!("hostname {machine} && exec \"$@\""), "sh"]);
            command.arg(plain.get_program()).args(plain.get_args()).args(["--results", machine]);
            command.current_dir(site.path(".")).env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null());
            command.stderr(fs::File::create(site.path(&format!("{machine}.errors"))).expect("a file"));
            command.spawn().expect("unshare runs")
        };
        let mut log = Follower::new(&site.path("shared/meshgauge.jsonl"));
        let mut scored = |name: &str| {
            site.write(&format!("drop/{name}"), MESH);
            log.wait(60, |line| line["event"] == "mesh.scored" && line["mesh"] == name).is_some()
        };
        let mut first = on("a");
        assert!(scored("0.msh"));
        // While the first works the second one is refused.
        assert_eq!(on("b").wait().expect("a child").code(), Some(4));
        let said = site.text("b.errors").expect("text");
        assert!(said.contains("a meshgauge watch on a works with this state folder"), "{said}");
        // While it stands still the second one takes over.
        send(first.id(), Signal::STOP);
        let mut second = on("b");
        assert!(scored("1.msh"));
        send(first.id(), Signal::CONT);
        assert_eq!(first.wait().expect("a child").code(), Some(4), "the first one goes on");
        let said = site.text("a.errors").expect("text");
        assert!(said.contains("took this state folder over"), "{said}");
        assert!(scored("2.msh"));
        send(second.id(), Signal::TERM);
        assert_eq!(second.wait().expect("a child").code(), Some(0));
        let told = told(&site.path("shared/meshgauge.jsonl"));
        assert!(told.scored.len() == 3 && told.outcomes.values().all(|&count| count == 1), "{told:?}");
        let _ = (bindfs_a.kill(), bindfs_a.wait(), bindfs_b.kill(), bindfs_b.wait());
    }
    done(
        "T48",
        &format!(
            "{count} times: the second refused, then in place of one that stood still, which ended; doubled 0"
        ),
    );
}

/// On one machine the lock of a daemon that stands still holds.
#[test]
fn t48_a_daemon_that_stands_still_keeps_its_state() {
    let site = Site::new();
    let count = times(3, 20);
    let mut daemon = site.start(&QUICK);
    for round in 0..count {
        daemon.signal(Signal::STOP);
        assert_eq!(site.once(&QUICK), Some(4));
        site.write(&format!("drop/{round}.msh"), MESH);
        daemon.signal(Signal::CONT);
        daemon.wait_for("mesh.scored", &format!("{round}.msh"));
    }
    assert!(daemon.is_alive());
    let names: Vec<_> = (0..count).map(|round| format!("{round}.msh")).collect();
    all_well(&site, names.iter().map(String::as_str));
    done("T48", &format!("{count} times on one machine: the second one refused"));
}
