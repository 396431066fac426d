//! The file that defines a suite.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use meshgauge::report::page::published_labels;
use serde::Deserialize;

use super::command::{self, Ending};
use crate::config_file;
use crate::exit::Usage;
use crate::quantity::Span;

/// A suite: problems, generators, and the command of each for each.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Suite {
    /// What stands over the tables.
    pub title: String,
    /// Longest time that one run of a generator may take, of the processor; ten times as long by the clock.
    pub timeout: Span,
    /// Most runs of a generator on a problem until the number of nodes is in the window.
    #[serde(default = "tries")]
    pub tries: u32,
    /// Words that commands use: `{python}`. The command line may set others; `{meshgauge}` is this program.
    #[serde(default)]
    pub variables: BTreeMap<String, String>,
    /// Model problems.
    #[serde(rename = "problem")]
    pub problems: Vec<Problem>,
    /// Mesh generators.
    #[serde(rename = "generator")]
    pub generators: Vec<Generator>,
}

fn tries() -> u32 {
    6
}

/// A model problem.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// Its name, which is a folder of the results.
    pub name: String,
    /// What it is.
    pub title: String,
    /// True area of the domain.
    pub area: Option<f64>,
    /// True volume of the domain.
    pub volume: Option<f64>,
    /// Fewest and most nodes that a mesh of it may have.
    pub nodes: Option<[u64; 2]>,
    /// The first element size to try.
    pub size: f64,
    /// Labels of meshes of the report of 2007 whose rows stand under those of today.
    #[serde(default)]
    pub published: Vec<String>,
}

/// A mesh generator.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Generator {
    /// Its name, by which its meshes are called.
    pub name: String,
    /// What it is, and which of its algorithms.
    pub title: String,
    /// The command that prints its version; one that fails says that the generator is missing.
    pub version: Vec<String>,
    /// Extension of the meshes that it writes.
    pub output: String,
    /// Factor on the problem's first element size.
    #[serde(default = "one")]
    pub size_factor: f64,
    /// The command for each problem.
    pub run: BTreeMap<String, Vec<String>>,
}

fn one() -> f64 {
    1.0
}

impl Suite {
    /// Reads the suite at `path`; `{suite}` is its folder, and `variables` go before its own.
    pub fn read(path: &Path, variables: &[(String, String)]) -> anyhow::Result<Self> {
        let at = |problem: String| Usage(format!("{}: {problem}", path.display()));
        let text = config_file::read(path).map_err(|e| at(e.to_string()))?;
        let mut suite: Suite = toml::from_str(&text).map_err(|error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
            at(format!("line {line}: {}", error.message()))
        })?;
        let folder = path.canonicalize()?.parent().map(Path::to_owned).unwrap_or_else(|| PathBuf::from("."));
        suite.variables.extend(variables.iter().cloned());
        for value in suite.variables.values_mut() {
            // Commands run in folders of their own.
            if value.contains('/') && Path::new(value).exists() {
                *value = std::path::absolute(&*value)?.to_string_lossy().into_owned();
            }
        }
        let own = std::env::current_exe()?.to_string_lossy().into_owned();
        suite.variables.entry("meshgauge".into()).or_insert(own);
        suite.variables.insert("suite".into(), folder.to_string_lossy().into_owned());
        suite.check().map_err(at)?;
        Ok(suite)
    }

    /// Says what makes no sense.
    fn check(&self) -> Result<(), String> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        let names: Vec<_> = self.problems.iter().map(|p| &p.name).collect();
        for name in names.iter().copied().chain(self.generators.iter().map(|g| &g.name)) {
            if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
                return Err(format!("a name is made of letters, digits, - and _, found \"{name}\""));
            }
        }
        let twice = |names: &[&String]| {
            (1..names.len()).find(|&i| names[..i].contains(&names[i])).map(|i| names[i].clone())
        };
        let generators: Vec<_> = self.generators.iter().map(|g| &g.name).collect();
        if let Some(name) = twice(&names).or(twice(&generators)) {
            return Err(format!("\"{name}\" is there twice"));
        }
        for problem in &self.problems {
            let measures = [problem.area, problem.volume];
            if measures.iter().flatten().any(|m| !(m.is_finite() && *m > 0.0))
                || measures.iter().flatten().count() != 1
            {
                return Err(format!("problem {}: expected an area or a volume over 0", problem.name));
            }
            if !(problem.size.is_finite() && problem.size > 0.0) {
                return Err(format!("problem {}: size must be over 0", problem.name));
            }
            let known = published_labels();
            if let Some(label) = problem.published.iter().find(|label| !known.contains(&label.as_str())) {
                let (name, known) = (&problem.name, known.join(", "));
                return Err(format!(
                    "problem {name}: the report of 2007 has no mesh \"{label}\", only {known}"
                ));
            }
            if problem.nodes.is_some_and(|[least, most]| least > most || most == 0) {
                return Err(format!("problem {}: nodes must be [fewest, most]", problem.name));
            }
        }
        for generator in &self.generators {
            let commands = generator.run.values().chain([&generator.version]);
            for command in commands {
                command::check(command, &self.variables)
                    .map_err(|e| format!("generator {}: {e}", generator.name))?;
            }
            if let Some(name) = generator.run.keys().find(|name| !names.contains(name)) {
                return Err(format!(
                    "generator {} runs a problem \"{name}\" that is not there",
                    generator.name
                ));
            }
        }
        Ok(())
    }

    /// Number of dimensions of a problem.
    pub fn dimension(problem: &Problem) -> u32 {
        if problem.volume.is_some() { 3 } else { 2 }
    }
}

/// Versions, each asked for once.
#[derive(Debug, Default)]
pub struct Versions(HashMap<Vec<String>, Result<String, String>>);

impl Versions {
    /// What the generator's version command prints, or why it is missing.
    pub fn of(&mut self, command: &[String], suite: &Suite) -> Result<String, String> {
        let words = command::fill(command, &suite.variables, &[]);
        let found = self.0.entry(words.clone()).or_insert_with(|| {
            let limit = suite.timeout.0;
            match command::run(&words, Path::new("."), limit, &Default::default()) {
                Ok(ran) if ran.ending == Ending::Fine && !ran.printed.trim().is_empty() => {
                    Ok(ran.printed.trim().lines().next_back().unwrap_or_default().trim().to_owned())
                }
                Ok(ran) => Err(ran.told()),
                Err(error) => Err(format!("{}: {error}", words[0])),
            }
        });
        found.clone()
    }
}
