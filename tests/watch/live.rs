//! `status --watch` on a terminal of its own, which `script` makes.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use rustix::process::Signal;

use crate::daemon::{MESH, Site};

const ENTER: &str = "\x1b[?1049h";
const LEAVE: &str = "\x1b[?1049l";
const SHOW_CURSOR: &str = "\x1b[?25h";

/// What a shell line prints on a terminal where, once it drew, these keys are pressed.
fn on_a_terminal(site: &Site, line: &str, keys: &[u8]) -> String {
    let line = line.replace(
        "WATCH",
        &format!("'{}' status --watch --config meshgauge.toml", env!("CARGO_BIN_EXE_meshgauge")),
    );
    let mut child = Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .current_dir(site.path("."))
        .env("TERM", "xterm")
        .env("SHELL", "/bin/sh")
        .env_remove("NO_COLOR")
        .env_remove("MESHGAUGE_CONFIG")
        .env_remove("STATE_DIRECTORY")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("script is part of every Linux");
    let mut stdin = child.stdin.take().expect("a pipe");
    // Long enough for several drawings; what is tested does not depend on how many.
    sleep(Duration::from_secs(3));
    stdin.write_all(keys).expect("pressed");
    let output = child.wait_with_output().expect("it ends");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn scored(site: &Site) {
    site.write("meshgauge.toml", "[telemetry]\ninterval = \"100ms\"\n");
    site.write("drop/a.msh", MESH);
}

#[test]
fn the_screen_is_drawn_until_q_and_the_terminal_given_back() {
    let site = Site::new();
    scored(&site);
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    daemon.wait_for("mesh.scored", "a.msh");
    let line =
        "before=$(stty -g); WATCH; echo \"status $?\"; test \"$before\" = \"$(stty -g)\" && echo restored";
    let seen = on_a_terminal(&site, line, b"q");
    let (start, end) = (seen.find(ENTER).expect("its own screen"), seen.rfind(LEAVE).expect("given back"));
    assert!(start < end && seen.contains(SHOW_CURSOR), "{seen:?}");
    let drawn = &seen[start..end];
    assert!(drawn.matches("running").count() > 1, "it is drawn again and again: {drawn:?}");
    assert!(drawn.contains("1 scored") && drawn.contains("q ends this"), "{drawn:?}");
    assert!(seen[end..].contains("status 0") && seen[end..].contains("restored"), "{seen:?}");
}

#[test]
fn it_fits_the_terminal_however_that_is_resized_and_ends_by_control_c() {
    let site = Site::new();
    scored(&site);
    let output = site.command(&["--once", "--config", "meshgauge.toml"]).status().expect("it runs");
    assert!(output.success());
    let resized =
        "stty rows 4 cols 30; t=$(tty); (sleep 1; stty -F $t rows 6 cols 40) & WATCH; echo \"status $?\"";
    let seen = on_a_terminal(&site, resized, b"\x03");
    // The hint stands in the last line: the fourth, then the sixth.
    for last in ["\x1b[4;1H", "\x1b[6;1H"] {
        assert!(seen.contains(last), "{last:?} in {seen:?}");
    }
    assert!(!seen.contains("\x1b[24;1H"), "{seen:?}");
    assert!(seen.contains("ended") && seen.contains("status 0"), "{seen:?}");
}

#[test]
fn a_daemon_that_dies_while_it_is_watched_is_told_and_sets_the_status() {
    let site = Site::new();
    scored(&site);
    let daemon = site.start(&["--config", "meshgauge.toml"]);
    daemon.wait_for("mesh.scored", "a.msh");
    daemon.signal(Signal::KILL);
    daemon.wait("its end", || !Path::new(&format!("/proc/{}/exe", daemon.process())).exists());
    let seen = on_a_terminal(&site, "WATCH; echo \"status $?\"", b"q");
    assert!(seen.contains("dead") && seen.contains("status 1"), "{seen:?}");
}

#[test]
fn it_ends_when_its_terminal_goes_without_a_signal() {
    let site = Site::new();
    scored(&site);
    let output = site.command(&["--once", "--config", "meshgauge.toml"]).status().expect("it runs");
    assert!(output.success());
    // In a session of its own, whose terminal this is not: nobody sends it a signal when the terminal goes.
    let program = env!("CARGO_BIN_EXE_meshgauge");
    let watch = format!("echo $$ > watcher; exec {program} status --watch --config meshgauge.toml");
    let line = format!("setsid --wait sh -c '{watch}'");
    let mut script = Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .current_dir(site.path("."))
        .env("SHELL", "/bin/sh")
        .env_remove("MESHGAUGE_CONFIG")
        .env_remove("STATE_DIRECTORY")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .expect("script is part of every Linux");
    sleep(Duration::from_secs(3));
    let mut number = [0; 20];
    let length = std::fs::File::open(site.path("watcher")).and_then(|mut file| file.read(&mut number));
    let number = String::from_utf8_lossy(&number[..length.expect("it was started")]).trim().to_owned();
    let watcher = Path::new("/proc").join(number);
    assert!(watcher.exists(), "it runs");
    script.kill().expect("killed");
    script.wait().expect("it ends");
    for _ in 0..200 {
        if !watcher.exists() {
            return;
        }
        sleep(Duration::from_millis(100));
    }
    panic!("{} still runs without a terminal", watcher.display());
}

#[test]
fn without_a_terminal_there_is_no_screen() {
    let site = Site::new();
    scored(&site);
    let output = site.command(&["--once", "--config", "meshgauge.toml"]).status().expect("it runs");
    assert!(output.success());
    let output = Command::new(env!("CARGO_BIN_EXE_meshgauge"))
        .args(["status", "--watch", "--config", "meshgauge.toml"])
        .current_dir(site.path("."))
        .env_remove("STATE_DIRECTORY")
        .stdin(Stdio::null())
        .output()
        .expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--watch draws on a terminal"));
}
