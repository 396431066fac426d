//! `meshgauge score [FILE|DIR|-]...`

use std::collections::HashMap;
use std::ffi::OsStr;
use std::io::{IsTerminal, stderr, stdin};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use meshgauge::error::Kind;
use meshgauge::export::Selection;
use meshgauge::input::Scratch;
use meshgauge::mesh::{ElementWriter, System, three};
use meshgauge::summary::Expectation;
use meshgauge::{Error, Options, Progress, Summary};

use super::ConfigFile;
use super::output::Output;
use crate::config::{Checks, Config};
use crate::exit::{Status, Usage};
use crate::folder::{Found, Walk};
use crate::names::{self, Folder};
use crate::progress::Bar;
use crate::publish::publish;
use crate::quantity::Size;
use crate::selection;

/// Score meshes now.
#[derive(Debug, clap::Args)]
#[command(after_help = super::EXIT_STATUS)]
pub struct Args {
    /// Mesh files, folders, or - for standard input.
    ///
    /// A folder that is one mesh, as a case of OpenFOAM, is scored as such. Of any other every file is scored that has the extension or the content of a mesh format, sub-folders too, in the
    /// order of their names. Names that begin with a dot or end like a file that is still being written are passed
    /// over, as is what has neither a mesh extension nor known content.
    #[arg(required = true, value_name = "FILE|DIR|-")]
    inputs: Vec<PathBuf>,

    /// What is printed: table, json, jsonl, csv or markdown.
    ///
    /// json is one object for one file, and an array for a folder or several files; jsonl is one object a line.
    #[arg(long, value_name = "FORMAT", value_parser = super::output::report_names())]
    format: Option<String>,

    /// Write NAME.summary.json for each mesh into this folder.
    ///
    /// NAME is the file's name without its compression and mesh extensions; meshes that would share a NAME keep their
    /// extensions. Sub-folders of a folder that is scored are kept.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// The format of the meshes, instead of finding it out; see `meshgauge formats`.
    #[arg(long, value_name = "NAME")]
    mesh_format: Option<String>,

    /// Threads; 0 takes all processors.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,

    /// Memory for the node table and the buffers, such as 256MiB; what does not fit goes to scratch.
    #[arg(long, value_name = "SIZE")]
    memory: Option<Size>,

    /// Folder for scratch files.
    #[arg(long, value_name = "DIR")]
    scratch: Option<PathBuf>,

    /// Measures that the summary holds: npl, all, or codes as in M31,M32.
    #[arg(long, value_name = "npl|all|LIST")]
    measures: Option<String>,

    /// The coordinates that measures look at: cartesian, or cylindrical[:AXIS[@X,Y,Z]] (r, angle in radians, height).
    ///
    /// AXIS is x, y or z, and X,Y,Z a point on it. A mesh for a solver in cylindrical coordinates is judged by its
    /// elements there; volume, sizes and checks of whole elements stay those of the file's coordinates.
    #[arg(long, value_name = "SYSTEM")]
    frame: Option<System>,

    /// What each coordinate is multiplied by before shapes are measured, for an anisotropic problem.
    #[arg(long, value_name = "X,Y,Z", value_parser = stretch)]
    stretch: Option<Stretch>,

    /// Name the N worst elements a measure: number, value, centroid, nodes and region.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    worst: Option<u16>,

    /// Split the statistics by region: physical groups, parts, domains, whatever the format has.
    #[arg(long, value_name = "region", value_parser = ["region"])]
    by: Option<String>,

    /// Which checks are made; all looks for duplicate elements and coincident nodes too, which takes scratch space.
    #[arg(long, value_name = "standard|all", value_enum, hide_possible_values = true)]
    checks: Option<Checks>,

    /// The true volume of the domain; the mesh fails if its own is off by more than the tolerance.
    #[arg(long, value_name = "V", conflicts_with = "expect_area", value_parser = positive)]
    expect_volume: Option<f64>,

    /// The true area of the domain; the mesh fails if its own is off by more than the tolerance.
    #[arg(long, value_name = "A", value_parser = positive)]
    expect_area: Option<f64>,

    /// How far off the expected volume or area the mesh may be, in per cent.
    #[arg(long, value_name = "PERCENT", default_value = "1", value_parser = positive)]
    tolerance: f64,

    /// Fail where the minimum of a measure is under a value: M31=0.05. May be given several times.
    #[arg(long, value_name = "MEASURE=VALUE", value_parser = limit)]
    fail_under: Vec<(String, f64)>,

    /// What the mesh is judged by: npl, comsol, aspect or none, or several as in npl,aspect.
    ///
    /// `meshgauge measures` says what each holds. Rules of your own go into the configuration, [verdict].
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,

    /// Count elements that name missing nodes, and leave them out, instead of refusing the file.
    #[arg(long)]
    allow_missing_nodes: bool,

    /// Draw the histograms, in the width of the terminal.
    #[arg(long)]
    plot: bool,

    /// Write every element with its scores to a file: .csv, .parquet or .vtu, as its extension says.
    #[arg(long, value_name = "FILE")]
    per_element: Option<PathBuf>,

    /// Into that file, write only elements that have a score under V.
    #[arg(long, value_name = "V", visible_alias = "only-below", requires = "per_element", value_parser = positive)]
    below: Option<f64>,

    /// Print errors only, unless --format asks for a report.
    #[arg(short, long)]
    quiet: bool,

    /// Draw no progress bar.
    #[arg(long)]
    no_progress: bool,

    /// Leave `run` out of the summary, so that the same mesh gives the same bytes.
    #[arg(long)]
    no_run_info: bool,

    #[command(flatten)]
    config: ConfigFile,
}

/// A number that is finite and over 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "expected a number over 0".into())
}

/// Factors of the coordinates.
#[derive(Debug, Clone, Copy)]
struct Stretch([f64; 3]);

fn stretch(text: &str) -> Result<Stretch, String> {
    let factors = three(text).filter(|factors| factors.iter().all(|factor| *factor > 0.0));
    factors.map(Stretch).ok_or_else(|| "expected three numbers over 0, as in 1,1,4".into())
}

/// `MEASURE=VALUE`.
fn limit(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected MEASURE=VALUE, as in M31=0.05")?;
    let code = selection::known(name.trim()).map_err(|e| e.0)?;
    let value = value.trim().parse().ok().filter(|v| (0.0..=1.0).contains(v));
    Ok((code.to_owned(), value.ok_or("expected a VALUE from 0 to 1, as in M31=0.05")?))
}

impl Args {
    /// The configuration, with what the command line says put over it.
    pub fn config(&self) -> anyhow::Result<Config> {
        let mut config = self.config.read()?;
        let score = &mut config.score;
        score.threads = self.threads.unwrap_or(score.threads);
        score.memory = self.memory.unwrap_or(score.memory);
        score.scratch = self.scratch.clone().unwrap_or_else(|| score.scratch.clone());
        score.measures = self.measures.clone().unwrap_or_else(|| score.measures.clone());
        score.frame = self.frame.unwrap_or(score.frame);
        score.stretch = self.stretch.map_or(score.stretch, |stretch| stretch.0);
        score.worst = self.worst.map_or(score.worst, usize::from);
        score.by_region |= self.by.is_some();
        score.checks = self.checks.unwrap_or(score.checks);
        score.allow_missing_nodes |= self.allow_missing_nodes;
        score.run_info &= !self.no_run_info;
        config.verdict.fail_under.extend(self.fail_under.iter().cloned());
        config.verdict.preset = self.preset.clone().unwrap_or_else(|| config.verdict.preset.clone());
        Ok(config)
    }

    fn options(&self, config: &Config) -> Result<Options, Usage> {
        let mut options = config.options()?;
        options.format = self.mesh_format.clone();
        let expected = self.expect_volume.map(|v| (true, v)).or(self.expect_area.map(|a| (false, a)));
        options.judgement.expectation =
            expected.map(|(volume, value)| Expectation { volume, value, tolerance_percent: self.tolerance });
        Ok(options)
    }
}

/// Scores what the command line names.
pub fn run(args: &Args, config: &Config) -> anyhow::Result<Status> {
    let options = args.options(config)?;
    if let Some(name) = &args.mesh_format
        && meshgauge::formats::find(name).is_none()
    {
        let known: Vec<_> = meshgauge::formats::FORMATS.iter().map(|f| f.name()).collect();
        let hint = crate::nearest::nearest(name, known.iter().copied());
        let hint = hint.map(|near| format!("did you mean {near}? ")).unwrap_or_default();
        return Err(
            Usage(format!("no format is named \"{name}\"; {hint}there are {}", known.join(", "))).into()
        );
    }
    let mut status = Status::Fine;
    let meshes = meshes(&args.inputs, config, &mut status);
    let places = args.out.as_deref().map(|out| places(&meshes, out)).transpose()?;
    let many = args.inputs.len() > 1 || meshes.first().is_none_or(|mesh| mesh.within.is_some());
    if let Some(file) = args.per_element.as_ref().filter(|_| many) {
        let file = file.display();
        return Err(Usage(format!("{file} takes the elements of one mesh, not of several")).into());
    }
    let print = !args.quiet || args.format.is_some();
    let mut output = print.then(|| Output::new(args.format.as_deref(), many, args.plot));
    for (i, mesh) in meshes.iter().enumerate() {
        match score(mesh, args, &options) {
            Ok(summary) => {
                status = status.max(Status::of_verdict(&summary.verdict));
                if let Some(places) = &places {
                    let place = places[i].clone().unwrap_or_else(|| {
                        let name = format!("{}{}", summary.mesh.name, names::SUFFIX);
                        args.out.clone().unwrap_or_default().join(name)
                    });
                    publish(&place, summary.to_json())
                        .map_err(|e| anyhow::anyhow!("{}: {e}", place.display()))?;
                }
                if let Some(output) = &mut output {
                    output.add(summary)?;
                }
            }
            Err(error) if mesh.is_passed_over(&error) => tracing::info!("passed over: {error}"),
            Err(error) => {
                eprintln!("meshgauge: {error}");
                status = status.max(Status::of(&error));
            }
        }
    }
    if let Some(output) = output {
        output.finish()?;
    }
    Ok(status)
}

/// A mesh that is to be scored.
struct Mesh {
    /// The file; - for standard input.
    path: PathBuf,
    /// The path within the folder that was named on the command line, where one was.
    within: Option<PathBuf>,
}

impl Mesh {
    fn is_stdin(&self) -> bool {
        self.path.as_os_str() == "-"
    }

    /// Whether an error means that a file of a folder is no mesh at all.
    fn is_passed_over(&self, error: &Error) -> bool {
        self.within.is_some()
            && matches!(error.kind(), Kind::UnknownFormat(_) | Kind::Empty)
            && !names::has_mesh_extension(self.path.file_name().unwrap_or_default())
    }
}

/// The meshes that the command line names, folders read through.
fn meshes(inputs: &[PathBuf], config: &Config, status: &mut Status) -> Vec<Mesh> {
    let mut meshes = Vec::new();
    for path in inputs {
        let is_file = path.as_os_str() == "-" || !path.is_dir();
        if is_file || meshgauge::formats::files(path).is_some() {
            meshes.push(Mesh { path: path.clone(), within: None });
            continue;
        }
        let before = meshes.len();
        let scan = Walk::new(path, &config.watch).scan();
        for (problem, cause) in scan.problems {
            eprintln!("meshgauge: {}: {cause}", path.join(problem).display());
            *status = (*status).max(Status::Unreadable);
        }
        for (within, found) in scan.files {
            match found {
                Found::File(_) => meshes.push(Mesh { path: path.join(&within), within: Some(within) }),
                Found::Other(what) => tracing::info!("passed over: {}: {what}", path.join(within).display()),
            }
        }
        if meshes.len() == before {
            eprintln!("meshgauge: {}: expected meshes in the folder, found none", path.display());
            *status = (*status).max(Status::Unreadable);
        }
    }
    meshes
}

/// Where each mesh's summary goes; standard input's is named by its summary.
fn places(meshes: &[Mesh], out: &Path) -> Result<Vec<Option<PathBuf>>, Usage> {
    let mut folders: HashMap<&Path, Folder> = HashMap::new();
    for mesh in meshes.iter().filter(|mesh| !mesh.is_stdin()) {
        let (folder, name) = split(mesh);
        let folder = folders.entry(folder).or_default();
        if folder.contains(name) {
            return Err(Usage(format!("two meshes named {} would share one summary", name.display())));
        }
        folder.add(name);
    }
    let place = |mesh: &Mesh| {
        let (folder, name) = split(mesh);
        let named = folders.get(folder)?.summary_name(name);
        (!mesh.is_stdin()).then(|| out.join(folder).join(named))
    };
    Ok(meshes.iter().map(place).collect())
}

/// The sub-folder that the summary goes to, and the mesh's file name.
fn split(mesh: &Mesh) -> (&Path, &OsStr) {
    let folder = mesh.within.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    (folder, mesh.path.file_name().unwrap_or_default())
}

fn score(mesh: &Mesh, args: &Args, options: &Options) -> meshgauge::Result<Summary> {
    let mut options = options.clone();
    let _bar = (!args.quiet && !args.no_progress && stderr().is_terminal()).then(|| {
        let progress = Arc::new(Progress::default());
        options.progress = Some(Arc::clone(&progress));
        Bar::start(mesh.path.display().to_string(), progress)
    });
    let mut writer = args.per_element.as_deref().map(|file| export(file, args, &options)).transpose()?;
    let writer: Option<&mut dyn ElementWriter> = match &mut writer {
        Some(writer) => Some(writer.as_mut()),
        None => None,
    };
    if mesh.is_stdin() {
        meshgauge::score_reader_each("stdin", stdin().lock(), &options, writer)
    } else {
        meshgauge::score_each(&mesh.path, &options, writer)
    }
}

/// Begins the file of single elements.
fn export(file: &Path, args: &Args, options: &Options) -> meshgauge::Result<Box<dyn ElementWriter>> {
    let selection = Selection { measures: options.measures.clone(), below: args.below };
    let scratch = Scratch::new(&options.scratch, options.scratch_bytes);
    meshgauge::export::create(file, &selection, &scratch)
}
