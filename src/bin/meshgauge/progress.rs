//! A bar on stderr that follows a run. It draws on a terminal only.

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
    let template = "{prefix} {wide_bar} {percent:>3}% of {total_bytes}, {bytes_per_sec}, {msg}, {eta} left";
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0).with_style(style).with_prefix(name);
    while !stop.load(Ordering::Relaxed) {
        bar.set_length(progress.bytes());
        bar.set_position(progress.bytes_done());
        bar.set_message(format!("{} elements", progress.elements()));
        std::thread::park_timeout(INTERVAL);
    }
    bar.finish_and_clear();
}
