//! The command line: what is printed, what goes wrong how, and the exit status.
#![cfg(feature = "program")]

use std::fs::{self, File};
use std::io::{BufReader, pipe};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// One tetrahedron at the corner of a cube: volume 1/6, M31 = 12 sqrt(3) / 27 = 0.77.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\
    $EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

/// The same, and a tetrahedron one of whose nodes does not exist.
const MISSING: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\
    $EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 9\n$EndElements\n";

const BAD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 x 0 0\n$EndNodes\n$Elements\n0\n\
    $EndElements\n";

struct Folder(TempDir);

impl Folder {
    fn with(files: &[(&str, &str)]) -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        for (name, text) in files {
            let path = folder.path(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, text).expect("written");
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshgauge"));
        command.args(arguments.split_whitespace()).current_dir(self.0.path()).env_remove("MESHGAUGE_CONFIG");
        command
    }

    /// Runs the program with arguments that have no blanks in them.
    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("the program runs")
    }

    fn json(&self, arguments: &str) -> Value {
        let output = self.run(arguments);
        serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}: {output:?}"))
    }
}

fn status(output: &Output) -> Option<i32> {
    output.status.code()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

#[test]
fn exit_status_and_message_of_each_outcome() {
    let folder = Folder::with(&[
        ("good.msh", MESH),
        ("bad.msh", BAD),
        ("missing.msh", MISSING),
        ("notes.txt", "remember the milk"),
        ("empty.msh", ""),
        ("wrong.toml", "[score]\nthreads = 1\nmesures = \"all\"\n"),
    ]);
    let rows = [
        ("score good.msh", 0, ""),
        ("score good.msh --fail-under M31=0.5", 0, ""),
        ("score good.msh --fail-under M31=0.9", 1, ""),
        ("score good.msh --expect-volume 0.1666", 0, ""),
        ("score good.msh --expect-volume 0.17", 1, ""),
        ("score good.msh --expect-volume 0.17 --tolerance 5", 0, ""),
        ("score", 2, "FILE|DIR|-"),
        ("score good.msh --fail-under M3=0.5", 2, "did you mean M31?"),
        ("score good.msh --fail-under M31", 2, "MEASURE=VALUE"),
        ("score good.msh --fail-under M31=2", 2, "from 0 to 1"),
        ("score good.msh --measures verdict", 2, "the sets npl, all"),
        ("score good.msh --mesh-format gmesh", 2, "did you mean gmsh?"),
        ("score good.msh --worst 3", 0, ""),
        ("score good.msh --worst 0", 2, "--worst"),
        ("score good.msh --by part", 2, "region"),
        ("score good.msh --by region", 0, ""),
        ("score good.msh --memory lots", 2, "expected a size such as 256MiB, found \"lots\""),
        (
            "score good.msh --config wrong.toml",
            2,
            "wrong.toml: line 3: unknown setting `mesures`; did you mean `measures`?",
        ),
        ("score good.msh --config absent.toml", 2, "absent.toml: "),
        ("score absent.msh", 3, "meshgauge: absent.msh: "),
        ("score empty.msh", 3, "meshgauge: empty.msh: expected a mesh, found an empty file"),
        ("score notes.txt", 3, "looked for"),
        ("score bad.msh", 3, "meshgauge: bad.msh: gmsh: line 7: expected "),
        ("score missing.msh", 3, "element 2 names node 9"),
        ("score missing.msh --allow-missing-nodes", 0, ""),
        ("score good.msh bad.msh --fail-under M31=0.9", 3, "bad.msh"),
        ("score good.msh --out good.msh/below", 4, "good.msh/below"),
        ("frobnicate", 2, "frobnicate"),
        ("generate cylinder -o a.msh", 2, "no model problem is named \"cylinder\""),
        ("man frobnicate", 2, "no command is named"),
    ];
    for (arguments, expected, message) in rows {
        let output = folder.run(arguments);
        assert_eq!(status(&output), Some(expected), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{arguments}: {}", stderr(&output));
        assert!(message.is_empty() == output.stderr.is_empty(), "{arguments}: {}", stderr(&output));
    }
}

#[test]
fn an_error_is_one_line() {
    let folder = Folder::with(&[("bad.msh", BAD)]);
    let output = folder.run("score bad.msh");
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
    assert!(output.stdout.is_empty());
}

#[test]
fn json_is_an_object_for_one_file_and_an_array_for_several() {
    let folder = Folder::with(&[("a.msh", MESH), ("bad.msh", BAD), ("dir/b.msh", MESH)]);
    assert_eq!(folder.json("score a.msh --format json")["mesh"]["name"], "a");
    assert_eq!(folder.json("score a.msh bad.msh --format json").as_array().map(Vec::len), Some(1));
    assert_eq!(folder.json("score bad.msh dir/absent --format json"), serde_json::json!([]));
    assert_eq!(folder.json("score dir --format json")[0]["mesh"]["path"], "dir/b.msh");
    let lines = stdout(&folder.run("score a.msh dir --format jsonl"));
    let names: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((&names[0]["mesh"]["name"], &names[1]["mesh"]["name"]), (&"a".into(), &"b".into()));
    let csv = stdout(&folder.run("score a.msh dir --format csv"));
    assert_eq!(csv.lines().filter(|line| line.contains("M31")).count(), 2, "{csv}");
    assert_eq!(csv.lines().filter(|line| line.starts_with("mesh")).count(), 1, "{csv}");
}

#[test]
fn a_folder_is_read_in_order_and_what_is_no_mesh_is_passed_over() {
    let folder = Folder::with(&[
        ("drop/b.msh", MESH),
        ("drop/a/z.msh", MESH),
        ("drop/unnamed", MESH),
        ("drop/notes.txt", "no mesh"),
        ("drop/.hidden.msh", MESH),
        ("drop/c.msh.part", MESH),
    ]);
    let found = folder.json("score drop --format json");
    let paths: Vec<_> =
        found.as_array().expect("an array").iter().map(|s| s["mesh"]["path"].clone()).collect();
    assert_eq!(paths, ["drop/a/z.msh", "drop/b.msh", "drop/unnamed"]);
    fs::create_dir(folder.path("empty")).expect("a folder");
    assert_eq!(status(&folder.run("score empty")), Some(3));
}

#[test]
fn summaries_go_to_the_folder_under_names_that_do_not_clash() {
    let folder = Folder::with(&[("in/pit.msh", MESH), ("in/pit.inp", MESH), ("in/sub/pit.msh", MESH)]);
    assert_eq!(status(&folder.run("score in --out out --quiet")), Some(0));
    for name in ["pit.msh.summary.json", "pit.inp.summary.json", "sub/pit.summary.json"] {
        let file = File::open(folder.path("out").join(name)).expect(name);
        let summary: Value = serde_json::from_reader(BufReader::new(file)).expect("JSON");
        assert_eq!(summary["schema"], "meshgauge.summary/1");
    }
    let output = folder.run("score in/pit.msh in/sub/pit.msh --out out");
    assert_eq!(status(&output), Some(2), "{}", stderr(&output));
}

#[test]
fn standard_input_is_scored() {
    let folder = Folder::with(&[("a.msh", MESH)]);
    let mut command = folder.command("score - --format json --out out");
    let output = command.stdin(File::open(folder.path("a.msh")).expect("a file")).output().expect("it runs");
    assert_eq!(status(&output), Some(0), "{}", stderr(&output));
    let summary: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(summary["elements"]["count"], 1);
    assert!(folder.path("out/stdin.summary.json").exists());
}

#[test]
fn without_run_info_the_same_mesh_gives_the_same_bytes() {
    let folder = Folder::with(&[("a.msh", MESH)]);
    let once = folder.run("score a.msh --format json --no-run-info --threads 1");
    let again = folder.run("score a.msh --format json --no-run-info --threads 3 --memory 1MiB");
    assert_eq!(once.stdout, again.stdout);
    assert!(!stdout(&once).contains("\"run\""));
    assert!(stdout(&folder.run("score a.msh --format json")).contains("\"run\""));
}

#[test]
fn measures_can_be_chosen() {
    let folder = Folder::with(&[("a.msh", MESH)]);
    let summary = folder.json("score a.msh --format json --measures m31,M33");
    let measures = summary["shapes"]["tetrahedron"]["measures"].as_object().expect("measures");
    assert_eq!(measures.keys().collect::<Vec<_>>(), ["M31", "M33"]);
}

#[test]
fn quiet_prints_nothing_unless_a_format_is_asked_for() {
    let folder = Folder::with(&[("a.msh", MESH)]);
    assert!(folder.run("score a.msh --quiet").stdout.is_empty());
    assert!(stdout(&folder.run("score a.msh --quiet --format json")).starts_with('{'));
    assert!(stdout(&folder.run("score a.msh")).contains("M31"));
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = Folder::with(&[("a.msh", MESH)]);
    for arguments in ["score a.msh", "score a.msh --format json", "measures", "config", "man"] {
        let (reader, writer) = pipe().expect("a pipe");
        drop(reader);
        let mut command = folder.command(arguments);
        let output = command.stdout(writer).stderr(Stdio::piped()).output().expect("it runs");
        assert_eq!((status(&output), stderr(&output).as_str()), (Some(0), ""), "{arguments}");
    }
}

#[test]
fn the_documented_configuration_is_sound() {
    let folder = Folder::with(&[]);
    fs::write(folder.path("meshgauge.toml"), folder.run("config").stdout).expect("written");
    let output = folder.run("config --check meshgauge.toml");
    assert_eq!((status(&output), stderr(&output).as_str()), (Some(0), ""));
    fs::write(folder.path("meshgauge.toml"), "[wach]\n").expect("written");
    let output = folder.run("config --check meshgauge.toml");
    assert_eq!(status(&output), Some(2));
    assert!(stderr(&output).contains("did you mean `watch`?"), "{}", stderr(&output));
}

#[test]
fn a_model_problem_is_generated_and_scored() {
    let folder = Folder::with(&[]);
    let output = folder.run("generate fd-cylinder -o cylinder.msh rings=5 layers=2");
    assert_eq!(status(&output), Some(0), "{}", stderr(&output));
    let summary = folder.json("score cylinder.msh --format json");
    assert_eq!((&summary["nodes"]["count"], &summary["elements"]["count"]), (&543.into(), &360.into()));
}

#[test]
fn lists_help_completions_and_manual() {
    let folder = Folder::with(&[]);
    let rows = [
        ("formats", "gmsh"),
        ("measures", "M34"),
        ("--help", "Exit status:"),
        ("--version", env!("CARGO_PKG_VERSION")),
        ("score --help", "--fail-under <MEASURE=VALUE>"),
        ("watch --help", "--settle <DURATION>"),
        ("generate --help", "fd-cylinder"),
        ("completions bash", "_meshgauge"),
        ("completions fish", "meshgauge"),
        ("man", ".TH meshgauge"),
        ("man score", "meshgauge\\-score"),
    ];
    for (arguments, expected) in rows {
        let output = folder.run(arguments);
        assert_eq!(status(&output), Some(0), "{arguments}: {}", stderr(&output));
        assert!(stdout(&output).contains(expected), "{arguments}: {}", stdout(&output));
    }
    assert!(!stdout(&folder.run("--help")).contains("worker"), "the worker is not for people");
}
