//! T1, T2, T4, T6-T8, T16: meshes arrive in every way that people have.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File, FileTimes, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::process::Command;
use std::sync::Mutex;
use std::thread::{scope, sleep};
use std::time::{Duration, Instant, SystemTime};

use crate::daemon::{LONGER, MESH, Site};
use crate::oracle::{Follower, all_well, told};
use crate::tools::{Random, done, has, times};

/// Ways to bring a file from `$1` to `$2`; `tar` and the pauses need the shell.
const PRODUCERS: [(&str, &str, &str); 12] = [
    ("cp", "cp", "cp $1 $2"),
    ("cp -p", "cp", "cp -p $1 $2"),
    ("mv", "mv", "cp $1 $1.x; mv $1.x $2"),
    ("mv across file systems", "mv", "cp $1 /dev/shm/$$.x; mv /dev/shm/$$.x $2"),
    ("ln", "ln", "ln $1 $2"),
    ("rsync", "rsync", "rsync -t $1 $2"),
    ("rsync --inplace -t", "rsync", "rsync --inplace -t $1 $2"),
    (
        "tar",
        "tar",
        "mkdir $1.d; cp -p $1 $1.d/$(basename $2); tar -C $1.d -cf - . | tar -C $(dirname $2) -xf -",
    ),
    ("dd in blocks", "dd", "dd if=$1 of=$2 bs=50 status=none"),
    (
        "appended five times",
        "dd",
        "for i in 0 1 2 3 4; do dd if=$1 bs=50 skip=$i count=1 status=none >> $2; sleep 0.05; done",
    ),
    (
        "preallocated",
        "fallocate",
        "fallocate -l $(stat -c %s $1) $2; sleep 0.1; dd if=$1 of=$2 conv=notrunc status=none",
    ),
    (
        "written by mmap",
        "python3",
        "python3 -c \"
import mmap,sys,time
d=open('$1','rb').read(); f=open('$2','w+b'); f.truncate(len(d)); m=mmap.mmap(f.fileno(),0)
m[:len(d)//2]=d[:len(d)//2]; m.flush(); time.sleep(0.1); m[len(d)//2:]=d[len(d)//2:]; m.flush()\"",
    ),
];

#[test]
fn t01_every_producer() {
    let site = Site::new();
    let each = times(2, 50);
    let settle = Duration::from_secs(3);
    let _daemon = site.start(&["--settle", "3s"]);
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    let producers: Vec<_> =
        PRODUCERS.iter().enumerate().filter(|(_, (_, program, _))| has(false, &[program])).collect();
    let (mut names, mut late) = (Vec::new(), HashSet::new());
    for round in 0..each {
        for (number, (_, _, script)) in &producers {
            let name = format!("{number}-{round}.msh");
            let start = Instant::now();
            site.write(&format!("from/{name}"), MESH);
            let status = Command::new("sh")
                .args(["-ec", script, "sh"])
                .arg(site.path(&format!("from/{name}")))
                .arg(site.path(&format!("drop/{name}")))
                .status()
                .expect("sh runs");
            assert!(status.success(), "{script}");
            if start.elapsed() >= settle {
                late.insert(name.clone());
            }
            names.push(name);
        }
    }
    log.count(1200, "mesh.scored", names.len());
    let mut told = told(&site.path("results/meshgauge.jsonl"));
    // Who was held up for longer than a file must stand still breaks what is asked of writers.
    told.failed.retain(|name, _| !late.contains(name));
    told.scored.retain(|name, _| !late.contains(name));
    assert!(told.failed.is_empty(), "{:?}", told.failed);
    assert!(told.scored.values().all(|&count| count == 1), "{:?}", told.scored);
    all_well(&site, names.iter().map(String::as_str));
    let (producers, late) = (producers.len(), late.len());
    done(
        "T1",
        &format!(
            "{producers} producers, {each} files each; each scored once, as it came; {late} held up too long"
        ),
    );
}

#[test]
fn t02_slow_writers_that_pause_for_less_than_the_settle_time() {
    let site = Site::new();
    let count = times(10, 200);
    let settle = Duration::from_secs(4);
    let _daemon = site.start(&["--settle", "4s"]);
    let late = Mutex::new(HashSet::new());
    scope(|threads| {
        for writer in 0..count {
            let (site, late) = (&site, &late);
            threads.spawn(move || {
                let (mut random, mut last) = (Random(writer), Instant::now());
                let mut file = File::create(site.path(&format!("drop/{writer}.msh"))).expect("a file");
                for piece in MESH.as_bytes().chunks(MESH.len() / 5) {
                    file.write_all(piece).expect("written");
                    if last.elapsed() >= settle {
                        late.lock().expect("sound").insert(format!("{writer}.msh"));
                    }
                    last = Instant::now();
                    // From 0.1 to 0.7 of the settle time: the rest is for a busy machine.
                    sleep(Duration::from_millis(400 + random.below(2400)));
                }
            });
        }
    });
    let scored =
        Follower::new(&site.path("results/meshgauge.jsonl")).count(1200, "mesh.scored", count as usize);
    let late = late.into_inner().expect("sound");
    let mut told = told(&site.path("results/meshgauge.jsonl"));
    // Who was held up for longer than a file must stand still breaks what is asked of writers.
    told.failed.retain(|name, _| !late.contains(name));
    assert!(told.failed.is_empty(), "half a mesh was read: {:?}", told.failed);
    assert!(scored.len() == count as usize && told.scored.values().all(|&count| count == 1));
    done("T2", &format!("{count} slow writers, {} held up too long; half a mesh was never read", late.len()));
}

#[test]
fn t04_names_of_files_in_flight() {
    let site = Site::new();
    let patterns = ["tmp", "part", "partial", "filepart", "inprogress", "crdownload", "PROCESSING"];
    let mut names: Vec<_> = patterns.iter().map(|ending| format!("a.msh.{ending}")).collect();
    names.extend(
        [
            "a.msh~",
            ".a.msh",
            ".a.msh.Xy12Qz",
            ".~tmp~/a.msh",
            ".syncthing.a.msh",
            ".nfs0001",
            ".fuse_hidden01",
        ]
        .map(String::from),
    );
    for name in &names {
        site.write(&format!("drop/{name}"), MESH);
    }
    assert_eq!(site.once(&["--settle", "50ms"]), Some(0));
    assert!(site.events("mesh.detected").is_empty() && site.events("mesh.ignored").is_empty());
    done("T4", &format!("{} names; none read", names.len()));
}

/// Drops many meshes, changes each once it is scored, and wants each to be scored once more.
fn changed_after(row: &str, count: u64, change: impl Fn(&Site, &str)) {
    let site = Site::new();
    let names: Vec<_> = (0..count).map(|number| format!("{number}.msh")).collect();
    names.iter().for_each(|name| site.write(&format!("drop/{name}"), MESH));
    let _daemon = site.start(&["--settle", "100ms"]);
    let mut log = Follower::new(&site.path("results/meshgauge.jsonl"));
    log.count(1200, "mesh.scored", names.len());
    names.iter().for_each(|name| change(&site, name));
    let again = log.count(1200, "mesh.scored", names.len());
    let expected: HashMap<_, _> = names.iter().map(|name| (name.clone(), 1)).collect();
    assert_eq!(again, expected);
    all_well(&site, names.iter().map(String::as_str));
    done(row, &format!("{count} files; each new version scored, once"));
}

fn modified(site: &Site, name: &str) -> SystemTime {
    fs::metadata(site.path(&format!("drop/{name}"))).and_then(|data| data.modified()).expect("a time")
}

fn set_modified(site: &Site, path: &str, time: SystemTime) {
    let file = OpenOptions::new().write(true).open(site.path(path)).expect("a file");
    file.set_times(FileTimes::new().set_modified(time)).expect("a time set");
}

#[test]
fn t06_replaced_by_rename_with_an_older_time() {
    changed_after("T6", times(20, 200), |site, name| {
        site.write(&format!("new/{name}"), LONGER);
        set_modified(site, &format!("new/{name}"), modified(site, name) - Duration::from_secs(86400));
        fs::rename(site.path(&format!("new/{name}")), site.path(&format!("drop/{name}"))).expect("renamed");
    });
}

#[test]
fn t07_written_over_in_place_with_the_time_restored() {
    changed_after("T7", times(20, 200), |site, name| {
        let time = modified(site, name);
        let mut file =
            OpenOptions::new().write(true).open(site.path(&format!("drop/{name}"))).expect("a file");
        file.write_all(LONGER.as_bytes()).expect("written");
        set_modified(site, &format!("drop/{name}"), time);
    });
}

#[test]
fn t16_removed_and_made_anew_with_its_inode() {
    changed_after("T16", times(20, 500), |site, name| {
        let time = modified(site, name);
        fs::remove_file(site.path(&format!("drop/{name}"))).expect("removed");
        site.write(&format!("drop/{name}"), LONGER);
        set_modified(site, &format!("drop/{name}"), time);
    });
}

#[test]
fn t08_preallocated_and_filled_slowly() {
    let site = Site::new();
    let count = times(5, 50);
    let _daemon = site.start(&["--settle", "4s"]);
    scope(|threads| {
        for writer in 0..count {
            let site = &site;
            threads.spawn(move || {
                let mut file = File::create(site.path(&format!("drop/{writer}.msh"))).expect("a file");
                file.set_len(MESH.len() as u64).expect("allocated");
                // From the end to the start, as parallel writers do.
                for start in (0..MESH.len()).step_by(40).rev() {
                    file.seek(SeekFrom::Start(start as u64)).expect("a place");
                    file.write_all(&MESH.as_bytes()[start..MESH.len().min(start + 40)]).expect("written");
                    sleep(Duration::from_millis(400));
                }
            });
        }
    });
    Follower::new(&site.path("results/meshgauge.jsonl")).count(1200, "mesh.scored", count as usize);
    assert!(told(&site.path("results/meshgauge.jsonl")).failed.is_empty());
    let names: Vec<_> = (0..count).map(|number| format!("{number}.msh")).collect();
    all_well(&site, names.iter().map(String::as_str));
    done("T8", &format!("{count} files; half a mesh was never read"));
}
