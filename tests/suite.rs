//! `bench-generators`: whatever a generator does is a row, and what is known is not run again.

#![allow(clippy::unwrap_used)]
#![expect(clippy::disallowed_methods, reason = "the tests' own small files")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

const SUITE: &str = r#"
title = "Generators that behave, and others"
timeout = "1s"
tries = 5

[[problem]]
name = "disc"
title = "Disc"
area = 1963.4954
nodes = [200, 300]
size = 1.0
published = ["FG2", "A5"]

[[generator]]
name = "good"
title = "A generator whose size is its own"
version = ["echo", "1.0"]
output = "msh"
[generator.run]
disc = ["sh", "{suite}/good.sh", "{meshgauge}", "{size}", "{output}"]

[[generator]]
name = "graded"
title = "One most of whose nodes stay, whatever the size"
version = ["echo", "1.0"]
output = "msh"
[generator.run]
disc = ["sh", "{suite}/graded.sh", "{meshgauge}", "{size}", "{output}"]

[[generator]]
name = "stubborn"
title = "One that always makes the same"
version = ["echo", "1.0"]
output = "vtu"
run.disc = ["{meshgauge}", "generate", "mapped-disc", "divisions=4", "-q", "-o", "{output}"]

[[generator]]
name = "missing"
title = "One that is not installed"
version = ["/no/such/generator", "--version"]
output = "msh"
run.disc = ["/no/such/generator", "{output}"]

[[generator]]
name = "failing"
title = "One that gives up"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["sh", "-c", "echo cannot mesh this >&2; exit 3"]

[[generator]]
name = "silent"
title = "One that writes nothing"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["true"]

[[generator]]
name = "slow"
title = "One that never ends"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["sh", "-c", "sleep 600 & sleep 600"]

[[generator]]
name = "garbage"
title = "One that writes no mesh"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["sh", "-c", "echo no mesh > {output}"]

[[generator]]
name = "solid"
title = "One that meshes something else"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["{meshgauge}", "generate", "fd-cylinder", "rings=2", "-q", "-o", "{output}"]

[[generator]]
name = "smaller"
title = "One that meshes another disc"
version = ["echo", "1.0"]
output = "msh"
run.disc = ["{meshgauge}", "generate", "mapped-disc", "radius=20", "divisions=14", "-q", "-o", "{output}"]
"#;

/// Makes `round(15 / size) + 5` divisions and notes that it was run.
const GOOD: &str = r#"
echo run >> "$(dirname "$0")/runs"
divisions=$(awk "BEGIN { print int(15 / $2 + 5.5) }")
exec "$1" generate mapped-disc divisions=$divisions -q -o "$3"
"#;

/// Makes `round(9 + 2 / size)` divisions.
const GRADED: &str = r#"
divisions=$(awk "BEGIN { print int(9.5 + 2 / $2) }")
exec "$1" generate mapped-disc divisions=$divisions -q -o "$3"
"#;

fn bench(folder: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
    let (suite, results) = (folder.join("suite.toml"), folder.join("results"));
    command.arg("bench-generators").arg(suite).arg("--results").arg(results).args(more);
    command
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("suite.toml"), SUITE).unwrap();
    fs::write(folder.path().join("good.sh"), GOOD).unwrap();
    fs::write(folder.path().join("graded.sh"), GRADED).unwrap();
    folder
}

fn rows(folder: &Path, more: &[&str]) -> Vec<Value> {
    let run = bench(folder, more).args(["--format", "json"]).assert().success();
    serde_json::from_slice(&run.get_output().stdout).unwrap()
}

#[test]
fn every_generator_is_a_row_that_says_what_became_of_it() {
    let folder = folder();
    let rows = rows(folder.path(), &[]);
    let told = |name: &str| {
        let row = rows.iter().find(|row| row["generator"] == name).unwrap();
        let text = |key: &str| row[key].as_str().unwrap_or_default().to_owned();
        (text("outcome"), text("reason"))
    };
    assert_eq!(told("good"), ("fine".into(), String::new()));
    // By the square of the size alone the window would not be found in five tries.
    assert_eq!(told("graded"), ("fine".into(), String::new()));
    assert_eq!(told("stubborn"), ("outside-window".into(), "25 nodes instead of 200 to 300".into()));
    assert_eq!(told("missing").0, "missing");
    assert_eq!(told("failing"), ("failed".into(), "ended with status 3: cannot mesh this".into()));
    assert!(told("silent").1.starts_with("wrote no "), "{:?}", told("silent"));
    assert_eq!(told("slow").0, "timed-out");
    assert_eq!(told("garbage").0, "unreadable");
    assert_eq!(told("smaller"), ("wrong-domain".into(), "the mesh's area is off by -36.1 %".into()));
    assert_eq!(told("solid"), ("unreadable".into(), "the mesh has 3 dimensions".into()));

    let good = &rows[0];
    assert!((200..=300).contains(&good["nodes"].as_u64().unwrap()));
    assert!(good["tries"].as_u64().unwrap() > 1, "the first size is not the right one");
    assert!(good["peak_rss_bytes"].as_u64().unwrap() > 100_000 && good["seconds"].as_f64().unwrap() > 0.0);
    assert!((-0.02..0.0).contains(&good["relative_error"].as_f64().unwrap()));
    assert_eq!(good["summary"]["mesh"]["name"], "good");
    let disc = folder.path().join("results/disc");
    let mut names: Vec<_> =
        fs::read_dir(&disc).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| name.starts_with("good") || name.starts_with('.'));
    names.sort();
    assert_eq!(names, ["good.msh", "good.run.json", "good.summary.json"], "and nothing hidden is left");
}

#[test]
fn what_is_known_is_not_run_again_until_the_script_changes() {
    let folder = folder();
    let runs = || fs::read_to_string(folder.path().join("runs")).map_or(0, |text| text.lines().count());
    let first = rows(folder.path(), &["--only", "good"]);
    let once = runs();
    assert_eq!(rows(folder.path(), &["--only", "good,disc"]), first);
    assert_eq!(runs(), once, "kept");
    fs::write(folder.path().join("good.sh"), GOOD.replace("15 /", "16 /")).unwrap();
    rows(folder.path(), &["--only", "good"]);
    assert!(runs() > once, "the script is another one");
    let before = runs();
    rows(folder.path(), &["--only", "good", "--fresh"]);
    assert!(runs() > before, "asked for");
}

#[test]
fn tables_hold_the_runs_and_the_measures() {
    let folder = folder();
    let text = |format: &str| {
        let run = bench(folder.path(), &["--only", "good,failing", "--quiet", "--format", format])
            .assert()
            .success();
        assert!(run.get_output().stderr.is_empty());
        String::from_utf8(run.get_output().stdout.clone()).unwrap()
    };
    let table = text("table");
    for part in
        ["Disc", "Runs", "A generator whose size is its own", "cannot mesh this", "Quadrilaterals", "M22"]
    {
        assert!(table.contains(part), "{part} in {table}");
    }
    let of_2007 = table.lines().find(|line| line.contains("2007: FG2") && line.contains("M23")).unwrap();
    assert!(of_2007.contains("0.026") && of_2007.contains("1936"), "{of_2007}");
    assert!(!table.contains("2007: A5"), "of another shape");
    assert!(text("markdown").contains("| good | M23 |"));
    let csv = text("csv");
    assert_eq!(csv.lines().count(), 1 + 3 + 1, "a head, three measures of one mesh, a run without one");
}

#[test]
fn a_suite_that_makes_no_sense_is_refused_with_its_place() {
    let folder = folder();
    let cases = [
        ("run.disc = [\"true\"]", "run.disk = [\"true\"]", "runs a problem \"disk\" that is not there"),
        ("[\"true\"]", "[\"{pyhton}\"]", "nothing is known of {pyhton}"),
        ("name = \"solid\"", "name = \"good\"", "\"good\" is there twice"),
        ("name = \"solid\"", "name = \"../solid\"", "a name is made of letters"),
        ("area = 1963.4954", "area = -1.0", "expected an area or a volume over 0"),
        ("nodes = [200, 300]", "nodes = [300, 200]", "nodes must be [fewest, most]"),
        ("\"FG2\"", "\"FG9\"", "the report of 2007 has no mesh \"FG9\""),
        ("tries = 5", "trys = 5", "line 4: unknown field `trys`"),
    ];
    for (old, new, said) in cases {
        fs::write(folder.path().join("suite.toml"), SUITE.replace(old, new)).unwrap();
        let run = bench(folder.path(), &[]).assert().code(2);
        let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(told.contains(said), "{new}: {told}");
    }
    fs::write(folder.path().join("suite.toml"), SUITE).unwrap();
    let run = bench(folder.path(), &["--only", "godo"]).assert().code(2);
    assert!(String::from_utf8_lossy(&run.get_output().stderr).contains("did you mean good?"));
}
