//! Summaries that the command line names: files of them, folders of results, or meshes that are scored on the spot.

use std::fs::{self, File};
use std::io::{self, Read, stdin};
use std::path::{Path, PathBuf};

use meshgauge::error::Kind;
use meshgauge::{Error, Options, Result, Summary};

use crate::config::Watch;
use crate::folder::{Found, Walk};
use crate::names;

/// Larger files hold no summaries.
const LARGEST: u64 = 1 << 30;

/// A summary, and the name that it is paired by: its mesh's name, or the path within a folder of results.
pub struct Named {
    /// The name.
    pub name: String,
    /// The summary.
    pub summary: Summary,
}

/// Where summaries come from.
pub struct Source<'a> {
    /// How meshes are scored.
    pub options: &'a Options,
    /// How folders are read through.
    pub rules: &'a Watch,
}

impl Source<'_> {
    /// The summaries at `path`: those of a JSON file (or of standard input, for `-`), those of a folder, or that of a
    /// mesh. A folder without summaries is taken for one of meshes.
    pub fn read(&self, path: &Path) -> Result<Vec<Named>> {
        if path.as_os_str() == "-" {
            return named(
                text(stdin().lock()).and_then(|text| Summary::read_all(&text)).map_err(|e| e.in_file(path)),
            );
        }
        let data = fs::metadata(path).map_err(|e| Error::unreadable(path, e))?;
        if data.is_dir() { self.folder(path) } else { named(self.file(path)) }
    }

    fn file(&self, path: &Path) -> Result<Vec<Summary>> {
        if looks_like_json(path).map_err(|e| Error::unreadable(path, e))? {
            let file = File::open(path).map_err(|e| Error::unreadable(path, e))?;
            text(file).and_then(|text| Summary::read_all(&text)).map_err(|e| e.in_file(path))
        } else {
            Ok(vec![meshgauge::score(path, self.options)?])
        }
    }

    fn folder(&self, folder: &Path) -> Result<Vec<Named>> {
        let scan = Walk::new(folder, self.rules).scan();
        if let Some((problem, cause)) = scan.problems.into_iter().next() {
            return Err(Error::unreadable(&folder.join(problem), cause));
        }
        let files: Vec<PathBuf> = scan
            .files
            .into_iter()
            .filter(|(_, found)| matches!(found, Found::File(_)))
            .map(|(file, _)| file)
            .collect();
        let is_summary = |file: &&PathBuf| file.to_string_lossy().ends_with(names::SUFFIX);
        let summaries: Vec<_> = files.iter().filter(is_summary).collect();
        let chosen = if summaries.is_empty() { files.iter().collect() } else { summaries };
        let mut found = Vec::new();
        for within in chosen {
            match self.file(&folder.join(within)) {
                Ok(read) => {
                    let name = within.to_string_lossy();
                    let name = name.strip_suffix(names::SUFFIX).map(str::to_owned).unwrap_or_else(|| {
                        within
                            .with_file_name(names::stem(within.file_name().unwrap_or_default()))
                            .display()
                            .to_string()
                    });
                    found.extend(read.into_iter().map(|summary| Named { name: name.clone(), summary }));
                }
                Err(error) if is_no_mesh(&error, within) => tracing::info!("passed over: {error}"),
                Err(error) => return Err(error),
            }
        }
        if found.is_empty() {
            let nothing = Kind::Unsupported("expected summaries or meshes in the folder, found none".into());
            return Err(Error::new(nothing).in_file(folder));
        }
        Ok(found)
    }
}

/// Whether an error means that a file of a folder is no mesh at all.
fn is_no_mesh(error: &Error, within: &Path) -> bool {
    matches!(error.kind(), Kind::UnknownFormat(_) | Kind::Empty)
        && !names::has_mesh_extension(within.file_name().unwrap_or_default())
}

fn named(summaries: Result<Vec<Summary>>) -> Result<Vec<Named>> {
    let name = |summary: Summary| Named { name: summary.mesh.name.clone(), summary };
    Ok(summaries?.into_iter().map(name).collect())
}

/// No mesh format begins with a brace or a bracket.
fn looks_like_json(path: &Path) -> io::Result<bool> {
    if !fs::metadata(path)?.is_file() {
        return Ok(false);
    }
    let mut start = [0; 64];
    let read = File::open(path)?.read(&mut start)?;
    let first = start[..read].iter().find(|byte| !byte.is_ascii_whitespace());
    Ok(matches!(first, Some(b'{' | b'[')))
}

/// The text of what holds summaries.
fn text(from: impl Read) -> Result<String> {
    let mut bytes = Vec::new();
    let read =
        io::copy(&mut from.take(LARGEST + 1), &mut bytes).map_err(|e| Error::new(Kind::Unreadable(e)))?;
    if read > LARGEST {
        return Err(Error::limit("the file of summaries", "1 GiB"));
    }
    String::from_utf8(bytes).map_err(|_| Error::malformed("a summary as UTF-8 text", "other bytes"))
}
