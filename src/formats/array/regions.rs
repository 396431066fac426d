//! Which regions the elements of an array are in.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::Array;
use crate::error::Result;
use crate::formats::ElementSink;

/// The regions of elements that stand one after another.
#[derive(Debug, Clone, Default)]
pub enum InRegions {
    /// The file does not say.
    #[default]
    Unknown,
    /// All are in the one of this name.
    All(Arc<str>),
    /// Each has a key in an array.
    Keyed(Keys),
}

/// The keys of regions, one an element, and what the keys mean.
#[derive(Debug, Clone)]
pub struct Keys {
    /// The keys.
    pub keys: Array,
    /// Names by key; a key without one is its own name, and an empty name is no region.
    pub names: Arc<HashMap<u64, String>>,
}

impl InRegions {
    /// The region of that name; of none where it is empty.
    pub fn named(name: impl Into<Arc<str>>) -> Self {
        let name = name.into();
        if name.is_empty() { Self::Unknown } else { Self::All(name) }
    }

    /// Those of the elements of `span` alone, counted from its start.
    pub fn part(&self, span: Range<u64>) -> Self {
        match self {
            Self::Keyed(Keys { keys, names }) => {
                Self::Keyed(Keys { keys: keys.part(span), names: Arc::clone(names) })
            }
            other => other.clone(),
        }
    }

    /// Prepares for the elements of `span`, as far as anybody wants to know: the keys to call [`Self::enter`] with.
    pub fn begin(&self, span: Range<u64>, out: &mut ElementSink<'_>) -> Result<Vec<u64>> {
        let mut keys = Vec::new();
        match self {
            Self::All(name) => out.region(0, || name.to_string())?,
            Self::Keyed(regions) if out.wants_regions() => regions.keys.integers(span, &mut keys),
            _ => {}
        }
        Ok(keys)
    }

    /// The elements that follow are in the region of this key.
    #[inline]
    pub fn enter(&self, key: u64, out: &mut ElementSink<'_>) -> Result<()> {
        let Self::Keyed(Keys { names, .. }) = self else { return Ok(()) };
        out.region(key, || names.get(&key).cloned().unwrap_or_else(|| key.cast_signed().to_string()))
    }
}
