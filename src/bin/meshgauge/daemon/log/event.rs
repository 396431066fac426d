//! A line of the log.

use std::path::Path;
use std::time::SystemTime;

use serde_json::{Map, Value};

use crate::path_text::PathText;

/// One line of the log: `timestamp`, `level`, `event`, `mesh` where it is about one, then the rest.
pub struct Event(pub(super) Map<String, Value>);

impl Event {
    /// An event that is worth knowing.
    pub fn info(name: &str) -> Self {
        Self::new("info", name)
    }

    /// An event that somebody should look at.
    pub fn warn(name: &str) -> Self {
        Self::new("warn", name)
    }

    /// An event that went wrong.
    pub fn error(name: &str) -> Self {
        Self::new("error", name)
    }

    fn new(level: &str, name: &str) -> Self {
        let now = humantime::format_rfc3339_millis(SystemTime::now()).to_string();
        let head = [("timestamp", now.as_str()), ("level", level), ("event", name)];
        Self(head.into_iter().map(|(key, value)| (key.to_owned(), value.into())).collect())
    }

    /// About the mesh at `path` within the drop. `mesh` is for people; the bytes of a name that is not UTF-8 stand
    /// beside it.
    pub fn mesh(self, path: &Path) -> Self {
        let event = self.with("mesh", path.to_string_lossy());
        match PathText::from(path) {
            PathText::Text(_) => event,
            PathText::Bytes(bytes) => event.with("mesh_bytes", bytes),
        }
    }

    /// The event's name.
    pub fn name(&self) -> &str {
        self.0["event"].as_str().unwrap_or_default()
    }

    /// With a further field.
    pub fn with(mut self, key: impl Into<String>, value: impl Into<Value>) -> Self {
        self.0.insert(key.into(), value.into());
        self
    }
}
