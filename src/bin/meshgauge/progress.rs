//! A bar on stderr that follows a run. It draws on a terminal only.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use meshgauge::Progress;

/// How often the bar is drawn.
const INTERVAL: Duration = Duration::from_millis(100);

/// A bar that is drawn until it is dropped.
pub struct Bar {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Bar {
    /// Starts to draw `progress` under the name of the mesh.
    pub fn start(name: String, progress: Arc<Progress>) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || draw(name, &progress, &stopped));
        Self { stop, thread: Some(thread) }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // A bar that could not be drawn is no reason to lose a score.
            let _ = thread.join();
        }
    }
}

fn draw(name: String, progress: &Progress, stop: &AtomicBool) {
    // The bar has what the rest leaves: some of a terminal of 80 columns too.
    let template = "{prefix:20!} {wide_bar} {percent:>3}% {bytes_per_sec}, {msg}, {eta} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style).with_prefix(file_name(&name));
    while !stop.load(Ordering::Relaxed) {
        bar.set_length(progress.bytes());
        bar.set_position(progress.bytes_done());
        bar.set_message(format!("{} elements", short(progress.elements())));
        std::thread::park_timeout(INTERVAL);
    }
    bar.finish_and_clear();
}

/// The last part of a path; the whole where it has none, as standard input.
fn file_name(path: &str) -> String {
    Path::new(path).file_name().map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// A number in a few columns.
fn short(number: u64) -> String {
    match number {
        0..100_000 => number.to_string(),
        100_000..1_000_000_000 => format!("{:.1}M", number as f64 / 1e6),
        _ => format!("{:.2}G", number as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_take_few_columns() {
        let rows = [
            (0, "0"),
            (99_999, "99999"),
            (2_437_902, "2.4M"),
            (999_999_999, "1000.0M"),
            (1_500_000_000, "1.50G"),
        ];
        for (number, text) in rows {
            assert_eq!(short(number), text);
        }
        assert_eq!(file_name("/scratch/meshes/pit.inp"), "pit.inp");
        assert_eq!(file_name("-"), "-");
    }
}
