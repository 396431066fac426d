//! What each part is compared with: the first mesh of its name, until somebody accepts a later one.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use meshgauge::Summary;

use crate::publish::publish;

/// Not the suffix of results: who collects those must not find a mesh twice.
const SUFFIX: &str = ".baseline.json";

/// Larger files are no summary of ours.
const LARGEST: u64 = 1 << 28;

/// The folder of baselines, below the state folder.
pub struct Baselines {
    folder: PathBuf,
}

impl Baselines {
    /// The baselines that stand with this state.
    pub fn of(state: &Path) -> Self {
        Self { folder: state.join("baselines") }
    }

    /// The baseline of a part; `None` where it has none yet.
    pub fn read(&self, part: &Path) -> anyhow::Result<Option<Summary>> {
        let path = self.path(part);
        match File::open(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(meshgauge::Error::unreadable(&path, error).into()),
            Ok(file) => Ok(Some(read_summary(file, &path)?)),
        }
    }

    /// Makes a summary the baseline of a part.
    pub fn accept(&self, part: &Path, summary: &Summary) -> anyhow::Result<()> {
        let path = self.path(part);
        publish(&path, summary.to_json()).map_err(|error| anyhow::anyhow!("{}: {error}", path.display()))
    }

    fn path(&self, part: &Path) -> PathBuf {
        let mut name = part.file_name().unwrap_or_default().to_owned();
        name.push(SUFFIX);
        self.folder.join(part.with_file_name(name))
    }
}

/// The one summary in the file at `path`.
pub fn summary_at(path: &Path) -> anyhow::Result<Summary> {
    let file = fs::File::open(path).map_err(|error| meshgauge::Error::unreadable(path, error))?;
    read_summary(file, path)
}

fn read_summary(file: File, path: &Path) -> anyhow::Result<Summary> {
    let mut bytes = Vec::new();
    io::copy(&mut file.take(LARGEST), &mut bytes)
        .map_err(|error| meshgauge::Error::unreadable(path, error))?;
    let read = Summary::read_all(&String::from_utf8_lossy(&bytes)).map_err(|error| error.in_file(path))?;
    read.into_iter()
        .next()
        .ok_or_else(|| anyhow::anyhow!("{}: expected a summary, found none", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_baseline_is_there_once_it_is_accepted() {
        let folder = tempfile::tempdir().expect("a folder");
        let baselines = Baselines::of(folder.path());
        let part = Path::new("sub/pit.v2");
        assert!(baselines.read(part).expect("nothing is no error").is_none());
        let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/drop/cylinder-hex.vtu");
        let summary = meshgauge::score(&mesh, &meshgauge::Options::default()).expect("an example");
        baselines.accept(part, &summary).expect("written");
        assert_eq!(baselines.read(part).expect("read"), Some(summary));
        assert!(baselines.read(Path::new("sub/pit")).expect("another part").is_none());
    }
}
