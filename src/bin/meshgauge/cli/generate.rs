//! `meshgauge generate MODEL -o FILE [NAME=VALUE]...`

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::ValueEnum;
use meshgauge::generate::{Encoding, MODELS, Target, WRITERS, model, write_file};

use crate::exit::Status;

/// Write the mesh of a model problem.
///
/// The format follows from the file's extension; a further .gz or .zst packs the file.
#[derive(Debug, clap::Args)]
#[command(after_long_help = catalogue(), after_help = "The models and their parameters: meshgauge generate --help")]
pub struct Args {
    /// The model problem.
    #[arg(value_name = "MODEL")]
    model: String,

    /// The file to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Choose the divisions so that there are about N elements (1e6 is a number too).
    #[arg(long, value_name = "N", value_parser = count, conflicts_with = "nodes")]
    elements: Option<u64>,

    /// Choose the divisions so that there are about N nodes.
    #[arg(long, value_name = "N", value_parser = count)]
    nodes: Option<u64>,

    /// How the numbers stand in the file; by default as is usual in the format.
    #[arg(long, value_enum)]
    encoding: Option<Numbers>,

    /// Print nothing.
    #[arg(short, long)]
    quiet: bool,

    /// Parameters of the model; what is not set has its default.
    #[arg(value_name = "NAME=VALUE")]
    settings: Vec<String>,
}

/// How the numbers stand in a file.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Numbers {
    /// Text that reads back to the same doubles.
    Text,
    /// 64-bit little-endian.
    Binary,
    /// Binary in compressed blocks.
    Compressed,
}

pub fn run(args: &Args) -> anyhow::Result<Status> {
    let (model, settings) = (model(&args.model)?, args.settings.iter().map(String::as_str));
    let target = args.nodes.map(Target::Nodes).or(args.elements.map(Target::Elements));
    let problem = match target {
        Some(target) => model.problem_near(target, settings)?,
        None => model.problem(settings)?,
    };
    let encoding = match args.encoding {
        None => Encoding::Default,
        Some(Numbers::Text) => Encoding::Text,
        Some(Numbers::Binary) => Encoding::Binary,
        Some(Numbers::Compressed) => Encoding::Compressed,
    };
    let counts = write_file(&problem, encoding, &args.output)?;
    if !args.quiet {
        let file = args.output.display();
        let (nodes, elements, exact) = (counts.nodes, counts.elements, problem.exact());
        let measure = if problem.mesh().dimension() == 2 { "area" } else { "volume" };
        eprintln!("{file}: {problem}; {nodes} nodes, {elements} elements; true {measure} {exact}");
    }
    Ok(Status::Fine)
}

/// A number of nodes or elements: `25000`, `1e9`.
fn count(text: &str) -> Result<u64, String> {
    let number: Option<f64> = text.parse().ok();
    match number.filter(|n| n.fract() == 0.0 && (1.0..=1e15).contains(n)) {
        Some(number) => Ok(number as u64),
        None => Err("expected a whole number from 1 to 1e15".into()),
    }
}

/// The models with their parameters, and the formats.
fn catalogue() -> String {
    let mut text = String::from("Models:\n");
    // Writing to a string cannot fail.
    for model in MODELS {
        let _ = writeln!(text, "  {}: {}", model.name, model.title);
        for p in model.parameters {
            let _ = writeln!(text, "    {}={}  {}, {}", p.name, p.default_text(), p.meaning, p.range);
        }
    }
    text.push_str("Formats:\n");
    for writer in WRITERS {
        let extensions: Vec<_> = writer.extensions.iter().map(|e| format!(".{e}")).collect();
        let _ = writeln!(text, "  {} ({}): {}", writer.name, extensions.join(" "), writer.title);
    }
    text
}
