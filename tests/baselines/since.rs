//! `compare --since`: the scores of now beside those of then, out of the daemon's history.

use std::path::Path;
use std::time::SystemTime;

use serde_json::Value;

use super::{mesh, night, run, text};

/// The present time as the command line takes it, once a moment has passed on either side.
fn now() -> String {
    let moment = std::time::Duration::from_millis(20);
    std::thread::sleep(moment);
    let now = humantime::format_rfc3339_millis(SystemTime::now()).to_string();
    std::thread::sleep(moment);
    now
}

fn part<'v>(comparison: &'v Value, name: &str) -> Option<&'v Value> {
    comparison["meshes"].as_array()?.iter().find(|mesh| mesh["name"] == name)
}

/// Two parts are scored, then one gets a sliver, one is broken, one is new.
fn story(here: &Path, config: &str) -> [String; 2] {
    std::fs::write(here.join("c.toml"), format!("[baseline]\npattern = '^([a-z]+)\\d+$'\n{config}"))
        .expect("written");
    let before = now();
    for name in ["pit1.msh", "plate1.msh", "rod1.msh"] {
        night(here, name, &mesh(0.7));
    }
    let then = now();
    night(here, "pit2.msh", &mesh(0.01));
    night(here, "rod2.msh", "$MeshFormat\n2.2 0 8\n");
    night(here, "new1.msh", &mesh(0.7));
    [before, then]
}

#[test]
fn the_scores_of_now_are_compared_with_those_of_then() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let [before, then] = story(here, "");
    let output = run(here, &format!("compare --since {then} --format json --config c.toml"));
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let outcome =
        |name| part(&found, name).map(|mesh| mesh["outcome"].as_str().unwrap_or_default().to_owned());
    assert_eq!((outcome("pit").as_deref(), outcome("plate").as_deref()), (Some("worse"), Some("same")));
    assert_eq!((&found["gone"][0], &found["added"][0]), (&"rod".into(), &"new".into()));
    let pit = part(&found, "pit").expect("compared");
    let statistics: Vec<_> =
        pit["findings"].as_array().expect("findings").iter().map(|f| &f["statistic"]).collect();
    for statistic in ["wasserstein-1", "share under 0.1", "volume", "elements"] {
        assert!(statistics.iter().any(|found| **found == statistic), "{statistic}: {statistics:?}");
    }
    let table = text(&run(here, "compare --since 1h --config c.toml").stderr);
    assert!(table.contains("no mesh has a score of now and one of 20"), "{table}");
    let table = text(&run(here, &format!("compare --since {then} --config c.toml")).stdout);
    assert!(table.contains("pit  worse") && table.contains("M33"), "{table}");
    let markdown =
        text(&run(here, &format!("compare --since {then} --format markdown --config c.toml")).stdout);
    assert!(markdown.contains("| worse |"), "{markdown}");
    let early = run(here, &format!("compare --since {before} --config c.toml"));
    assert_eq!(early.status.code(), Some(2), "{}", text(&early.stderr));
}

#[test]
fn what_is_no_longer_kept_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let [_, then] = story(here, "[history]\nkeep = \"0s\"\n");
    let rows = [
        (format!("compare --since {then} --config c.toml"), "history.keep"),
        ("compare --since 1y".to_owned(), "summaries are kept for"),
        (format!("compare --since {then} --state elsewhere"), "expected the state of a daemon, found none"),
        ("compare --since soon".to_owned(), "such as 7d"),
        ("compare --since 7d a b".to_owned(), "cannot be used with"),
        ("compare a".to_owned(), "NEW"),
    ];
    for (arguments, message) in rows {
        let output = run(here, &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(message), "{arguments}: {}", text(&output.stderr));
    }
}

#[test]
fn parts_are_those_of_the_present_configuration() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let [_, then] = story(here, "");
    std::fs::write(here.join("c.toml"), "").expect("written");
    let output = run(here, &format!("compare --since {then} --format json --config c.toml"));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(part(&found, "pit1").map(|mesh| &mesh["outcome"]), Some(&"same".into()), "{found}");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}
