//! What the README's commands print, run in turn in a folder of their own.

use std::path::Path;
use std::process::Command;

use super::readme;

/// A command of the README and what it says the command prints.
struct Example {
    command: String,
    printed: String,
}

/// The commands after `$`, each with the lines below it up to the next one or the end of the block.
fn examples(readme: &str) -> Vec<Example> {
    let mut found: Vec<Example> = Vec::new();
    let mut open = false;
    for line in readme.lines() {
        let Some(line) = line.strip_prefix("    ").or_else(|| line.is_empty().then_some("")) else {
            open = false;
            continue;
        };
        if let Some(command) = line.strip_prefix("$ ") {
            found.push(Example { command: command.to_owned(), printed: String::new() });
            open = true;
        } else if let (true, Some(example)) = (open, found.last_mut()) {
            example.printed += &format!("{line}\n");
        }
    }
    found
}

/// Times, which no two runs share, as one word, and without the line that tells how fast it was.
fn without_times(text: &str) -> String {
    let time = regex::Regex::new(r"\d{4}-\d\d-\d\dT[\d:.]+Z").expect("a pattern");
    let text = time.replace_all(text, "TIME");
    let lines = text.lines().filter(|line| !line.starts_with("  run  "));
    lines.map(|line| line.trim_end().to_owned() + "\n").collect::<String>().trim_end().to_owned()
}

#[test]
fn what_the_commands_print_is_what_stands_there() {
    if Command::new("jq").arg("--version").output().is_err() {
        eprintln!("skipped: there is no jq, which the README uses");
        return;
    }
    let examples = examples(&readme());
    assert!(examples.len() >= 12, "{} commands", examples.len());
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::os::unix::fs::symlink(root.join("examples"), folder.path().join("examples")).expect("a link");
    let program = Path::new(env!("CARGO_BIN_EXE_meshgauge")).parent().expect("a folder").to_owned();
    let path = std::env::join_paths(
        [program].into_iter().chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    );
    let path = path.expect("folders without colons");
    for Example { command, printed } in examples {
        let output = Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path())
            .env("PATH", &path)
            .env_remove("MESHGAUGE_CONFIG")
            .env_remove("STATE_DIRECTORY")
            .output()
            .expect("a shell");
        let told = String::from_utf8_lossy(&output.stdout).into_owned();
        let complained = String::from_utf8_lossy(&output.stderr);
        assert_eq!(without_times(&told), without_times(&printed), "$ {command}\n{complained}");
    }
}
