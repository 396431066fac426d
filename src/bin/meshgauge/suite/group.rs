//! The processor time of a command with all the processes that it started, as the kernel tells it.

use std::fs;
use std::path::Path;
use std::time::Duration;

use rustix::process::Pid;

use crate::config_file;

/// Processor time of the processes of a group, and of those children of theirs that have ended.
pub fn processor_time(group: Pid) -> Duration {
    let Ok(processes) = fs::read_dir("/proc") else { return Duration::ZERO };
    let ticks: u64 = processes.flatten().filter_map(|process| ticks(&process.path(), group)).sum();
    Duration::from_secs_f64(ticks as f64 / rustix::param::clock_ticks_per_second() as f64)
}

/// Clock ticks of a process, if it is one of the group.
fn ticks(process: &Path, group: Pid) -> Option<u64> {
    let numbered = process.file_name()?.as_encoded_bytes().iter().all(u8::is_ascii_digit);
    let stat = if numbered { config_file::read(&process.join("stat")).ok()? } else { return None };
    ticks_in(&stat, group.as_raw_nonzero().get())
}

/// The line of proc_pid_stat(5): after the name in brackets come the state, the parent and the group, and nine fields later
/// the times of the process and of its children, as user and as system.
fn ticks_in(stat: &str, group: i32) -> Option<u64> {
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_ascii_whitespace().skip(2);
    let of_group = fields.next()?.parse::<i32>().ok()? == group;
    let times: Vec<u64> = fields.skip(8).take(4).map_while(|field| field.parse().ok()).collect();
    (of_group && times.len() == 4).then(|| times.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_times_stand_behind_a_name_that_may_hold_anything() {
        let stat = "7 (a) R 9 (b) S 1 42 42 0 -1 4194304 10 20 0 0 100 20 3 4000 20 0 1 0 99 0 0";
        assert_eq!(ticks_in(stat, 42), Some(4123));
        assert_eq!(ticks_in(stat, 7), None, "another group");
        assert_eq!(ticks_in("7 (a) S 1 42 42 0 -1", 42), None, "a line that ends too soon");
    }

    #[test]
    fn our_own_group_has_used_some() {
        let group = rustix::process::getpgrp();
        // Ticks are coarse.
        let started = std::time::Instant::now();
        while started.elapsed() < Duration::from_millis(50) {
            std::hint::black_box(processor_time(group));
        }
        assert!(processor_time(group) > Duration::ZERO);
    }
}
