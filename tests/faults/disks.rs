//! T27: a disk that fails.

use std::process::{Command, Stdio};

use crate::daemon::{MESH, Site};
use crate::oracle::all_well;
use crate::tools::{done, has, times};

/// Whatever call fails, the next start makes it good.
#[test]
fn t27_the_disk_fails_once() {
    if !has(false, &["strace"]) {
        return;
    }
    let calls = ["fsync", "fdatasync", "rename", "pwrite64", "ftruncate"];
    let most = times(2, 10);
    let mut failed = 0;
    for call in calls {
        for when in 1..=most {
            let site = Site::new();
            site.write("drop/a.msh", MESH);
            site.write("drop/b.msh", MESH);
            let plain = site.command(&["--settle", "50ms", "--once"]);
            let mut command = Command::new("strace");
            command.args(["-f", "-qq", "-o", "/dev/null", "-e", &format!("trace={call}")]);
            command.args(["-e", &format!("inject={call}:error=EIO:when={when}")]);
            command.arg(plain.get_program()).args(plain.get_args()).current_dir(site.path("."));
            let status =
                command.env_remove("MESHGAUGE_CONFIG").stdout(Stdio::null()).stderr(Stdio::null()).status();
            let code = status.expect("strace runs").code();
            assert!(matches!(code, Some(0 | 3 | 4)), "{call} {when}: {code:?}");
            failed += u64::from(code != Some(0));
            assert_eq!(site.once(&["--settle", "50ms"]), Some(0), "{call} {when}");
            all_well(&site, ["a.msh", "b.msh"]);
        }
    }
    let whole = most * calls.len() as u64;
    done(
        "T27",
        &format!(
            "{whole} errors, {failed} of which ended the run with an error; the next start made all good"
        ),
    );
}
