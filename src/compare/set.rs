//! Two sets of meshes, as two result folders hold them: paired by name.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Comparison, Outcome, SCHEMA, Tolerances, compare};
use crate::summary::Summary;

/// Two sets of meshes beside each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparisons {
    /// [`SCHEMA`].
    pub schema: Cow<'static, str>,
    /// The worst of all.
    pub outcome: Outcome,
    /// The meshes that both sets have, the worst first, then by name.
    pub meshes: Vec<Comparison>,
    /// Names of meshes that only the base has. That is for the worse: a mesh that is not made can have no faults.
    pub gone: Vec<String>,
    /// Names of meshes that only the new set has.
    pub added: Vec<String>,
}

impl Comparisons {
    /// Comparisons of meshes, put in order.
    pub fn new(mut meshes: Vec<Comparison>, gone: Vec<String>, added: Vec<String>) -> Self {
        meshes.sort_by(|a, b| b.outcome.cmp(&a.outcome).then_with(|| a.name.cmp(&b.name)));
        let mut outcome = meshes.first().map_or(Outcome::Same, |worst| worst.outcome);
        if !added.is_empty() {
            outcome = outcome.max(Outcome::Changed);
        }
        if !gone.is_empty() {
            outcome = Outcome::Worse;
        }
        Self { schema: Cow::Borrowed(SCHEMA), outcome, meshes, gone, added }
    }

    /// The number of meshes of one outcome.
    pub fn count(&self, outcome: Outcome) -> usize {
        self.meshes.iter().filter(|mesh| mesh.outcome == outcome).count()
    }
}

/// Compares two sets of meshes by name.
pub fn compare_sets(
    base: &BTreeMap<String, Summary>,
    new: &BTreeMap<String, Summary>,
    tolerances: &Tolerances,
) -> Comparisons {
    let only = |these: &BTreeMap<String, Summary>, those: &BTreeMap<String, Summary>| {
        these.keys().filter(|name| !those.contains_key(*name)).cloned().collect()
    };
    let pairs = new.iter().filter_map(|(name, new)| Some((name, base.get(name)?, new)));
    let meshes = pairs.map(|(name, base, new)| compare(name, base, new, tolerances)).collect();
    Comparisons::new(meshes, only(base, new), only(new, base))
}
