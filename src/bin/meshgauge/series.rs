//! Which meshes are one part, night after night: their names without dates and job numbers.

use std::path::{Path, PathBuf};

use regex::Regex;

use crate::names;

/// How the name of a mesh gives the name of its part.
#[derive(Debug, Clone)]
pub struct Naming {
    pattern: Option<Regex>,
}

impl Naming {
    /// The naming by a pattern, whose captures are the part's name; by the whole name for "".
    pub fn new(pattern: &str) -> Result<Self, String> {
        if pattern.is_empty() {
            return Ok(Self { pattern: None });
        }
        let pattern = Regex::new(pattern).map_err(|error| error.to_string())?;
        if pattern.captures_len() < 2 {
            return Err("expected a capture, as in ^(.+)_job\\d+$".into());
        }
        Ok(Self { pattern: Some(pattern) })
    }

    /// The part that the mesh at `path` within the drop is of: its folder, and what the pattern captures of its name
    /// without extensions. A name that the pattern does not fit is a part of its own.
    pub fn part(&self, path: &Path) -> PathBuf {
        let stem = names::stem(path.file_name().unwrap_or_default());
        let captured = self.pattern.as_ref().and_then(|pattern| {
            let captures = pattern.captures(stem.to_str()?)?;
            let parts: Vec<_> = captures.iter().skip(1).flatten().map(|part| part.as_str()).collect();
            // A part must stay a file name in its folder.
            let name = parts.join("-");
            (!name.is_empty() && name != "." && name != ".." && !name.contains('/')).then_some(name)
        });
        match captured {
            Some(name) => path.with_file_name(name),
            None => path.with_file_name(stem),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_job_numbers_are_stripped() {
        let rows = [
            ("", "sub/pit-2026-11-21.inp.gz", "sub/pit-2026-11-21"),
            (r"^(.+)-\d{4}-\d\d-\d\d$", "sub/pit-2026-11-21.inp.gz", "sub/pit"),
            (r"^(.+)-\d{4}-\d\d-\d\d$", "pit.inp", "pit"),
            (r"^(\w+)_job\d+_(fine|coarse)$", "pit_job0815_fine.msh", "pit-fine"),
            (r"^job\d+(.*)$", "job7.msh", "job7"),
            (r"^(\.\.)x$", "a/..x.msh", "a/..x"),
        ];
        for (pattern, path, part) in rows {
            let naming = Naming::new(pattern).expect(pattern);
            assert_eq!(naming.part(Path::new(path)), Path::new(part), "{pattern} {path}");
        }
    }

    #[test]
    fn a_pattern_without_a_capture_is_refused() {
        assert!(Naming::new(r"job\d+").is_err_and(|error| error.contains("expected a capture")));
        assert!(Naming::new("(").is_err());
    }
}
