//! `meshgauge report RESULTS... -o report.html`

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use meshgauge::Summary;
use meshgauge::compare::{Comparison, compare};
#[cfg(feature = "png")]
use meshgauge::report::figure::Painter;
use meshgauge::report::page::{self, Content};

use super::ConfigFile;
use crate::config::Config;
use crate::exit::{Status, Usage};
use crate::nearest::nearest;
use crate::publish::publish;
use crate::summaries::{Named, Source};

/// Write one self-contained HTML page: verdicts, what changed, the report's figures and tables.
///
/// Where several results hold a mesh of the same name, as the folders of several nights do, each is compared with
/// the one before. The page opens from disk and asks for nothing.
#[derive(Debug, clap::Args)]
#[command(after_help = super::EXIT_STATUS)]
pub struct Args {
    /// Summaries, folders of results, or meshes, which are scored first; in the order of the nights.
    #[arg(required = true, value_name = "RESULTS")]
    results: Vec<PathBuf>,

    /// The page.
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    output: PathBuf,

    /// Compare with these results instead: a summary or a folder.
    #[arg(long, value_name = "BASE")]
    base: Option<PathBuf>,

    /// What stands over the page.
    #[arg(long, value_name = "TEXT", default_value = "Mesh quality")]
    title: String,

    /// Lay a mesh of the NPL report of 2007 beside, by its label there, as in A2. May be given several times.
    #[arg(long, value_name = "LABEL")]
    published: Vec<String>,

    /// Write each figure into this folder too, as SVG and as PNG.
    #[arg(long, value_name = "DIR")]
    figures: Option<PathBuf>,

    #[command(flatten)]
    config: ConfigFile,
}

impl Args {
    /// The configuration.
    pub fn config(&self) -> anyhow::Result<Config> {
        self.config.read()
    }
}

/// Writes the page.
pub fn run(args: &Args, config: &Config) -> anyhow::Result<Status> {
    known(&args.published)?;
    let source = Source { options: &config.options()?, rules: &config.watch };
    let mut meshes = Vec::new();
    for results in &args.results {
        let folder = results.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        meshes.extend(source.read(results)?.into_iter().map(|named| Mesh::new(named, &folder)));
    }
    let base = args.base.as_ref().map(|path| source.read(path)).transpose()?;
    label(&mut meshes);
    let changes = changes(&meshes, base, config);
    let meshes: Vec<Summary> = meshes.into_iter().map(|mesh| mesh.summary).collect();
    let content = Content {
        title: &args.title,
        meshes: &meshes,
        changes: changes.as_deref(),
        published: &args.published,
    };
    let mut page = Vec::new();
    page::render(&content, &mut page)?;
    write(&args.output, &page)?;
    if let Some(folder) = &args.figures {
        write_figures(&content, folder)?;
    }
    Ok(Status::Fine)
}

/// Every figure as a file of its own: SVG, and PNG where this program can draw it.
fn write_figures(content: &Content, folder: &Path) -> anyhow::Result<()> {
    #[cfg(feature = "png")]
    let painter = Painter::new();
    #[cfg(feature = "png")]
    if painter.is_none() {
        tracing::warn!(
            "figures are written as SVG alone: for PNG a font must be installed, as fonts-dejavu-core"
        );
    }
    for figure in page::figures(content) {
        let svg = figure.scene.to_file(&figure.legend);
        write(&folder.join(format!("{}.svg", figure.name)), svg.as_bytes())?;
        #[cfg(feature = "png")]
        if let Some(painter) = &painter {
            write(&folder.join(format!("{}.png", figure.name)), &painter.paint(&svg)?)?;
        }
    }
    Ok(())
}

/// A mesh, the name that it is paired by, and the results that it comes from.
struct Mesh {
    name: String,
    folder: String,
    summary: Summary,
}

impl Mesh {
    fn new(Named { name, summary }: Named, folder: &str) -> Self {
        Self { name, folder: folder.to_owned(), summary }
    }
}

/// Gives each mesh a name of its own: with the folder before it where several have one name, and a number where that
/// does not tell them apart either.
fn label(meshes: &mut [Mesh]) {
    let mut number: HashMap<String, u32> = HashMap::new();
    for mesh in meshes.iter() {
        *number.entry(mesh.name.clone()).or_default() += 1;
    }
    let mut taken: HashMap<String, u32> = HashMap::new();
    for mesh in meshes {
        let mut label = mesh.name.clone();
        if number[&mesh.name] > 1 {
            label = format!("{}/{label}", mesh.folder);
        }
        let count = taken.entry(label.clone()).or_default();
        *count += 1;
        mesh.summary.mesh.name = if *count > 1 { format!("{label} ({count})") } else { label };
    }
}

/// Each mesh beside its base: that of the same name in the results to compare with, else the last of its name before it.
/// `None` where nothing is compared.
fn changes(meshes: &[Mesh], base: Option<Vec<Named>>, config: &Config) -> Option<Vec<Comparison>> {
    let tolerances = config.compare;
    let fixed = base.is_some();
    let base: Vec<Named> = base.unwrap_or_default();
    let mut before: BTreeMap<&str, &Summary> =
        base.iter().map(|named| (named.name.as_str(), &named.summary)).collect();
    let mut changes = Vec::new();
    for mesh in meshes {
        if let Some(base) = before.get(mesh.name.as_str()) {
            changes.push(compare(&mesh.summary.mesh.name, base, &mesh.summary, &tolerances));
        }
        if !fixed {
            before.insert(&mesh.name, &mesh.summary);
        }
    }
    (fixed || !changes.is_empty()).then_some(changes)
}

fn known(labels: &[String]) -> Result<(), Usage> {
    let all = page::published_labels();
    match labels.iter().find(|label| !all.contains(&label.as_str())) {
        None => Ok(()),
        Some(unknown) => {
            let hint = nearest(unknown, all.iter().copied());
            let hint = hint.map(|near| format!("did you mean {near}? ")).unwrap_or_default();
            let all = all.join(", ");
            Err(Usage(format!("the report of 2007 has no mesh \"{unknown}\"; {hint}there are {all}")))
        }
    }
}

fn write(path: &Path, content: &[u8]) -> anyhow::Result<()> {
    publish(path, content).map_err(|e| anyhow::anyhow!("{}: {e}", path.display()))
}
