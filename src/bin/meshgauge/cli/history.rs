//! `meshgauge history NAME`

use std::collections::BTreeMap;
use std::io::{self, Write, stdout};
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::ConfigFile;
use crate::daemon::Places;
use crate::daemon::fields::printable;
use crate::exit::{Status, Usage};
use crate::quantity::Since;
use crate::selection;
use crate::series::Naming;
use crate::state::{Entry, State};

/// Tell how the scores of a part went, from the daemon's history.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The part: the mesh's path in the drop without extensions, or what baseline.pattern makes of it.
    #[arg(value_name = "NAME")]
    name: PathBuf,

    /// This measure only.
    #[arg(long, value_name = "MEASURE", value_parser = measure)]
    measure: Option<String>,

    /// Only what was scored since: 7d, 2026-11-15 or 2026-11-15T06:00:00Z (UTC).
    #[arg(long, value_name = "WHEN")]
    since: Option<Since>,

    /// What is printed.
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,

    /// The state folder of the daemon [default: that of the configuration, else results/.meshgauge].
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,

    #[command(flatten)]
    config: ConfigFile,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    /// A line a shape and measure, with a sparkline of its minimum.
    Table,
    /// A row a scored mesh, shape and measure.
    Csv,
    /// The same as an array.
    Json,
}

fn measure(text: &str) -> Result<String, String> {
    selection::known(text.trim()).map(str::to_owned).map_err(|error| error.0)
}

/// Prints it.
pub fn run(args: &Args) -> anyhow::Result<Status> {
    let config = args.config.read()?;
    let mut watch = config.watch.clone();
    if let Some(state) = &args.state {
        watch.state.clone_from(state);
    }
    let naming = config.baseline.naming()?;
    let state = open(&Places::of(&watch).state)?;
    let since = args.since.map(|since| since.to_string()).unwrap_or_default();
    let mut entries = state.history(|mesh| naming.part(mesh) == args.name, &since)?;
    entries.retain(|entry| args.measure.as_ref().is_none_or(|code| *code == entry.measure));
    if entries.is_empty() {
        return Err(Usage(unknown(&state, &naming, &args.name)?).into());
    }
    let mut out = stdout().lock();
    match args.format {
        Format::Table => table(&entries, &mut out)?,
        Format::Csv => csv(&entries, &mut out)?,
        Format::Json => {
            serde_json::to_writer_pretty(&mut out, &entries)?;
            writeln!(out)?;
        }
    }
    Ok(Status::Fine)
}

/// The database of a state folder, or what is missing.
pub fn open(folder: &Path) -> anyhow::Result<State> {
    let missing = || Usage(format!("{}: expected the state of a daemon, found none", folder.display()));
    Ok(State::read(folder)?.ok_or_else(missing)?)
}

/// Why there is nothing, with the nearest name that is known.
fn unknown(state: &State, naming: &Naming, name: &Path) -> anyhow::Result<String> {
    let all = state.history(|_| true, "")?;
    let parts: Vec<String> = all.iter().map(|entry| naming.part(&entry.mesh).display().to_string()).collect();
    let name = name.display().to_string();
    let hint = match crate::nearest::nearest(&name, parts.iter().map(String::as_str)) {
        Some(near) if near != name => format!("; did you mean {near}?"),
        _ => String::new(),
    };
    Ok(format!("nothing that was asked for of a part named {name} was scored{hint}"))
}

/// A line a shape and measure: first, lowest and last minimum, last mean, a sparkline, and since when it is at its lowest.
fn table(entries: &[Entry], out: &mut dyn Write) -> io::Result<()> {
    let mut lines: BTreeMap<(&str, &str), Vec<&Entry>> = BTreeMap::new();
    for entry in entries {
        lines.entry((&entry.shape, &entry.measure)).or_default().push(entry);
    }
    let (first, last) = (&entries[0].scored, &entries[entries.len() - 1].scored);
    let most = lines.values().map(Vec::len).max().unwrap_or(0);
    writeln!(out, "{most} scored from {first} to {last}")?;
    writeln!(
        out,
        "{:<14} {:<8} {:>7} {:>7} {:>7} {:>7}  {:<20}  minimum, 0 to 1",
        "shape", "measure", "first", "lowest", "last", "mean", "lowest since"
    )?;
    for ((shape, measure), line) in lines {
        let minima: Vec<f64> = line.iter().filter_map(|entry| entry.min).collect();
        let (Some(first), Some(last)) = (minima.first(), minima.last()) else { continue };
        let lowest = minima.iter().copied().fold(f64::INFINITY, f64::min);
        let since =
            line.iter().find(|entry| entry.min == Some(lowest)).map(|entry| to_the_second(&entry.scored));
        let since = since.unwrap_or_default();
        let mean = line.last().and_then(|entry| entry.mean).unwrap_or_default();
        let (shape, measure) = (printable(shape), printable(measure));
        let bars = sparkline(&minima);
        writeln!(
            out,
            "{shape:<14} {measure:<8} {first:>7.3} {lowest:>7.3} {last:>7.3} {mean:>7.3}  {since:<20}  {bars}"
        )?;
    }
    Ok(())
}

/// A time of RFC 3339 without its fraction of a second.
fn to_the_second(time: &str) -> String {
    let seconds = time.split('.').next().unwrap_or(time);
    if seconds.len() < time.len() { printable(&format!("{seconds}Z")) } else { printable(time) }
}

/// One bar a value of \[0, 1\], for at most the last 60.
fn sparkline(values: &[f64]) -> String {
    const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let last = &values[values.len().saturating_sub(60)..];
    last.iter().map(|value| BARS[((value * 8.0) as usize).min(7)]).collect()
}

fn csv(entries: &[Entry], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "scored,mesh,verdict,elements,shape,measure,min,min_element,mean")?;
    let number = |value: Option<f64>| value.map(|value| format!("{value:?}")).unwrap_or_default();
    for entry in entries {
        let mesh = printable(&entry.mesh.to_string_lossy()).replace('"', "\"\"");
        let verdict = entry.verdict.as_deref().unwrap_or_default();
        let elements = entry.elements.map(|elements| elements.to_string()).unwrap_or_default();
        let (shape, measure) = (printable(&entry.shape), printable(&entry.measure));
        let (min, mean) = (number(entry.min), number(entry.mean));
        writeln!(
            out,
            "{},\"{mesh}\",{verdict},{elements},{shape},{measure},{min},{},{mean}",
            entry.scored, entry.min_element
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_a_value() {
        assert_eq!(sparkline(&[0.0, 0.5, 1.0, 0.124, 0.126]), "▁▅█▁▂");
        assert_eq!(sparkline(&[0.3; 100]).chars().count(), 60);
    }

    #[test]
    fn times_are_told_to_the_second() {
        assert_eq!(to_the_second("2026-11-19T22:04:09.277Z"), "2026-11-19T22:04:09Z");
        assert_eq!(to_the_second("2026-11-19T22:04:09Z"), "2026-11-19T22:04:09Z");
    }
}
