//! T46: the clock is set, by years.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::daemon::{MESH, Site};
use crate::oracle::{Follower, all_well};
use crate::tools::{done, times};

#[test]
fn t46_the_clock_jumps_by_ten_years() {
    let library = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";
    let library = std::env::var("MESHGAUGE_FAKETIME").unwrap_or_else(|_| library.into());
    if !fs::exists(&library).unwrap_or(false) {
        eprintln!("skipped: libfaketime is not at {library}, nor where MESHGAUGE_FAKETIME says");
        return;
    }
    let site = Site::new();
    site.write("clock", "+0");
    let plain = site.command(&["--settle", "200ms"]);
    let mut command = Command::new(plain.get_program());
    command.args(plain.get_args()).current_dir(site.path(".")).env_remove("MESHGAUGE_CONFIG");
    command.env("LD_PRELOAD", library).env("FAKETIME_TIMESTAMP_FILE", site.path("clock"));
    // The machine's clock is set, not its heart stopped: monotonic time goes on, files have true times.
    command.env("FAKETIME_DONT_FAKE_MONOTONIC", "1").env("DONT_FAKE_MONOTONIC", "1").env("NO_FAKE_STAT", "1");
    command.env("FAKETIME_NO_CACHE", "1").stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("the program runs");
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let (count, mut names, mut years) = (times(3, 20), Vec::new(), std::collections::BTreeSet::new());
    for round in 0..count {
        for (jump, text) in ["+3650d", "-3650d", "+0"].into_iter().enumerate() {
            let name = format!("{round}-{jump}.msh");
            site.write(&format!("drop/{name}"), MESH);
            // In the midst of its settling.
            sleep(Duration::from_millis(80));
            site.write("clock.new", text);
            fs::rename(site.path("clock.new"), site.path("clock")).expect("renamed");
            let scored =
                log.wait(60, |event| event["event"] == "mesh.scored" && event["mesh"] == name.as_str());
            let scored = scored.unwrap_or_else(|| panic!("{name} was not scored after {text}"));
            years.insert(scored["timestamp"].as_str().unwrap_or_default()[..4].to_owned());
            names.push(name);
        }
    }
    let _ = (child.kill(), child.wait());
    assert!(years.len() >= 3, "the clock did not jump: {years:?}");
    assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
    all_well(&site, names.iter().map(String::as_str));
    done("T46", &format!("{} jumps of 10 years; each mesh scored, once", names.len()));
}
