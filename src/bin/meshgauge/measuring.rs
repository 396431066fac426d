//! Meshes of the drop that are measured in coordinates of their own: the rows of `watch.rules`.

use std::path::Path;
use std::sync::Arc;

use meshgauge::mesh::System;
use serde::{Deserialize, Serialize};

use crate::config::{Config, Score};
use crate::folder;

/// How the meshes that fit a pattern are measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// What their path in the drop is like; `*` stands for anything, slashes too.
    pub mesh: String,
    /// The coordinates, where they are others than those of `score.frame`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<System>,
    /// The factors, where they are others than those of `score.stretch`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretch: Option<[f64; 3]>,
}

/// How the mesh at `path` in the drop is scored: as all are, but for the first row that it fits.
pub fn config_for(all: &Arc<Config>, path: &Path) -> Arc<Config> {
    match all.watch.rules.iter().find(|row| folder::fits(&row.mesh, path.as_os_str())) {
        None => Arc::clone(all),
        Some(row) => {
            let frame = row.frame.unwrap_or(all.score.frame);
            let stretch = row.stretch.unwrap_or(all.score.stretch);
            let score = Score { frame, stretch, ..all.score.clone() };
            Arc::new(Config { score, ..Config::clone(all) })
        }
    }
}

/// What makes no sense in the rows.
pub fn check(rows: &[Row]) -> Result<(), String> {
    for (number, row) in (1..).zip(rows) {
        if row.mesh.is_empty() {
            return Err(format!(
                "watch.rules, row {number}: mesh must be a path in the drop, as in \"polar/*\""
            ));
        }
        if !row.stretch.is_none_or(|stretch| is_stretch(&stretch)) {
            return Err(format!("watch.rules, row {number}: stretch must be three numbers over 0"));
        }
    }
    Ok(())
}

/// Whether axes can be stretched by these factors.
pub fn is_stretch(factors: &[f64; 3]) -> bool {
    factors.iter().all(|factor| factor.is_finite() && *factor > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_row_that_a_path_fits_holds_and_what_it_does_not_say_is_as_everywhere() {
        let mut all = Config::default();
        all.score.stretch = [1.0, 2.0, 3.0];
        let polar: System = "cylindrical:x".parse().expect("a system");
        let row = |mesh: &str, frame, stretch| Row { mesh: mesh.into(), frame, stretch };
        all.watch.rules = vec![row("polar/*", Some(polar), None), row("*.inp", None, Some([5.0; 3]))];
        let all = Arc::new(all);
        let found = |path: &str| {
            let config = config_for(&all, Path::new(path));
            (config.score.frame, config.score.stretch)
        };
        assert_eq!(found("polar/sub/a.inp"), (polar, all.score.stretch));
        assert_eq!(found("sub/a.inp"), (all.score.frame, [5.0; 3]));
        assert!(Arc::ptr_eq(&config_for(&all, Path::new("a.msh")), &all));
    }
}
