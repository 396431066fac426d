//! For how long the database keeps whole summaries.

use std::time::{Duration, Instant, SystemTime};

use crate::series::Naming;
use crate::state::State;

/// How often what is too old is removed.
const BETWEEN_LOOKS: Duration = Duration::from_secs(3600);

/// The rule by which summaries are kept.
pub struct Keeping {
    keep: Duration,
    naming: Naming,
    looked: Option<Instant>,
}

impl Keeping {
    /// Summaries are kept for so long, and the last of each part before that.
    pub fn new(keep: Duration, naming: Naming) -> Self {
        Self { keep, naming, looked: None }
    }

    /// Removes what is too old, if it is time to look.
    pub fn forget(&mut self, state: &State) -> anyhow::Result<()> {
        if self.looked.is_some_and(|looked| looked.elapsed() < BETWEEN_LOOKS) {
            return Ok(());
        }
        self.looked = Some(Instant::now());
        let Some(oldest) = SystemTime::now().checked_sub(self.keep) else { return Ok(()) };
        let before = humantime::format_rfc3339_millis(oldest).to_string();
        let removed = state.forget_summaries(&before, |path| self.naming.part(path))?;
        tracing::debug!("{removed} summaries of scores before {before} were removed");
        Ok(())
    }
}
