//! Files of single elements: every element, or the bad ones, with all that was measured of it.
//!
//! Elements are written as they come, in the order of the file and in bounded memory. The file gets its name when it is
//! whole; a run that fails leaves none behind.

mod csv;
#[cfg(feature = "parquet")]
mod parquet;
mod vtu;
mod vtu_array;

use std::fs::Permissions;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Kind, Result};
use crate::input::Scratch;
use crate::measures::measures;
use crate::mesh::{ElementWriter, Nodes, ScoredElement};

/// What is written of the elements.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// Codes of the measures that get a column; empty for all.
    pub measures: Vec<String>,
    /// Only elements that have a score under this value, if there is one.
    pub below: Option<f64>,
}

/// The extensions of the files that can be written, which say what is written.
pub const EXTENSIONS: &[&str] =
    if cfg!(feature = "parquet") { &["csv", "parquet", "vtu"] } else { &["csv", "vtu"] };

/// The columns of measures: the codes, and the place of each among all measures.
#[derive(Debug)]
struct Columns(Vec<(&'static str, usize)>);

impl Columns {
    fn of(selection: &Selection) -> Self {
        let wanted =
            |code: &str| selection.measures.is_empty() || selection.measures.iter().any(|m| m == code);
        let all = measures().enumerate().map(|(place, measure)| (measure.code, place));
        Self(all.filter(|(code, _)| wanted(code)).collect())
    }

    fn codes(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|(code, _)| *code)
    }

    /// The scores of an element, column by column; NaN where its shape has no such measure.
    fn scores<'a>(&'a self, element: &'a ScoredElement<'_>) -> impl Iterator<Item = f64> + 'a {
        self.0.iter().map(|(_, place)| element.scores[*place])
    }
}

/// Begins the file at `path`; its extension says what is written.
pub fn create(path: &Path, selection: &Selection, scratch: &Scratch) -> Result<Box<dyn ElementWriter>> {
    let target = Target { path: path.to_owned() };
    let columns = Columns::of(selection);
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let writer: Box<dyn ElementWriter> = match extension.as_str() {
        "csv" => Box::new(csv::Csv::create(target, columns)?),
        #[cfg(feature = "parquet")]
        "parquet" => Box::new(parquet::Parquet::create(target, columns)?),
        "vtu" => Box::new(vtu::Vtu::create(target, columns, scratch)?),
        _ => {
            let known = EXTENSIONS.join(", .");
            let found = path.display();
            return Err(Error::usage(format!(
                "expected a file of single elements (.{known}), found {found}"
            )));
        }
    };
    Ok(match selection.below {
        Some(limit) => Box::new(Below { limit, columns: Columns::of(selection), writer }),
        None => writer,
    })
}

/// Where the file goes.
#[derive(Debug)]
struct Target {
    path: PathBuf,
}

impl Target {
    /// A file beside the target that has no name yet which anybody looks for.
    fn begin(&self) -> Result<NamedTempFile> {
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty());
        tempfile::Builder::new()
            .prefix(".meshgauge-")
            .suffix(".tmp")
            .permissions(Permissions::from_mode(0o666))
            .tempfile_in(folder.unwrap_or(Path::new(".")))
            .map_err(|e| self.error(e))
    }

    /// Gives the whole file its name.
    fn end(&self, file: NamedTempFile) -> Result<()> {
        file.as_file().sync_all().map_err(|e| self.error(e))?;
        file.persist(&self.path).map(drop).map_err(|e| self.error(e.error))
    }

    fn error(&self, cause: io::Error) -> Error {
        Error::new(Kind::Unwritable(cause)).in_file(&self.path)
    }
}

/// Passes on the elements that have a score under a limit.
struct Below {
    limit: f64,
    columns: Columns,
    writer: Box<dyn ElementWriter>,
}

impl ElementWriter for Below {
    fn write(&mut self, element: &ScoredElement<'_>) -> Result<()> {
        // NaN is under nothing.
        if self.columns.scores(element).any(|score| score < self.limit) {
            self.writer.write(element)?;
        }
        Ok(())
    }

    fn finish(&mut self, nodes: &Nodes) -> Result<()> {
        self.writer.finish(nodes)
    }
}

/// Area of a surface or volume of a solid, in a column of its own each.
fn extents(element: &ScoredElement<'_>) -> (Option<f64>, Option<f64>) {
    let solid = element.shape.dimension() == 3;
    ((!solid).then_some(element.extent), solid.then_some(element.extent))
}
