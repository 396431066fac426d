//! A status as a live screen: drawn anew every second from the daemon's file, until a key ends it.

use std::io::{self, IsTerminal, Write, stdin, stdout};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::style::{Attribute, Color, Print, ResetColor, SetAttribute, SetForegroundColor};
use crossterm::terminal::{
    self, Clear, ClearType, DisableLineWrap, EnableLineWrap, EnterAlternateScreen, LeaveAlternateScreen,
};
use crossterm::{execute, queue};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use signal_hook::consts::{SIGHUP, SIGTERM};

use super::{Health, Status, health, text};
use crate::exit::Usage;

/// How often it is drawn.
const BETWEEN_DRAWINGS: Timespec = Timespec { tv_sec: 1, tv_nsec: 0 };

/// Columns and rows of a terminal that does not say.
const USUAL: (u16, u16) = (80, 24);

/// The last line.
const HINT: &str = "q ends this; the daemon goes on";

/// The terminal while the screen is ours; it is given back as it was, whatever happens.
struct Screen {
    color: bool,
}

/// Draws the status of the daemon with this state folder until somebody has seen enough; says how it was in the end.
pub fn live(state: &Path) -> anyhow::Result<Health> {
    if !stdin().is_terminal() || !stdout().is_terminal() {
        return Err(Usage("--watch draws on a terminal; for programs there is --json".into()).into());
    }
    let mut last = look(state)?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGTERM, SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&stop))?;
    }
    let screen = Screen::take()?;
    loop {
        screen.draw(&last)?;
        if wait_for_end()? || stop.load(Ordering::Relaxed) {
            return Ok(last.health);
        }
        // A file that is gone or torn for a moment is no reason to end.
        match look(state) {
            Ok(next) => last = next,
            Err(error) => last.trouble = Some(format!("{error:#}")),
        }
    }
}

/// What there is to draw.
struct Look {
    status: Status,
    health: Health,
    age: Option<f64>,
    trouble: Option<String>,
}

fn look(state: &Path) -> anyhow::Result<Look> {
    let status = Status::read(state).map_err(|error| Usage(format!("{error:#}")))?;
    let (health, age) = health(&status);
    Ok(Look { status, health, age, trouble: None })
}

/// Waits until it is time to draw again, or a signal came. Whether a key ends it, or the terminal is gone.
fn wait_for_end() -> io::Result<bool> {
    let terminal = stdin();
    let mut keys = [PollFd::new(&terminal, PollFlags::IN)];
    match poll(&mut keys, Some(&BETWEEN_DRAWINGS)) {
        Ok(0) | Err(Errno::INTR) => return Ok(false),
        Ok(_) if keys[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL) => {
            return Ok(true);
        }
        Ok(_) => {}
        Err(error) => return Err(error.into()),
    }
    let mut pressed = [0; 64];
    match rustix::io::read(&terminal, &mut pressed) {
        Ok(count) => Ok(ends(&pressed[..count])),
        Err(Errno::INTR) => Ok(false),
        Err(_) => Ok(true),
    }
}

/// Whether these bytes of a raw terminal say so: `q`, Control-C, Escape alone; none at all is a terminal that is gone.
fn ends(pressed: &[u8]) -> bool {
    const CONTROL_C: u8 = 3;
    const ESCAPE: u8 = 27;
    matches!(pressed, [] | [ESCAPE]) || pressed.iter().any(|key| matches!(*key, b'q' | b'Q' | CONTROL_C))
}

impl Screen {
    fn take() -> io::Result<Self> {
        let color = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        terminal::enable_raw_mode()?;
        let screen = Self { color };
        execute!(stdout(), EnterAlternateScreen, Hide, DisableLineWrap)?;
        Ok(screen)
    }

    fn draw(&self, look: &Look) -> io::Result<()> {
        let (columns, rows) = match terminal::size()? {
            // A terminal that does not know its size.
            (0, _) | (_, 0) => USUAL,
            size => size,
        };
        let words = text(&look.status, look.health, look.age, Some(columns));
        let room = usize::from(rows.saturating_sub(1));
        let mut out = stdout().lock();
        queue!(out, MoveTo(0, 0))?;
        let trouble = look.trouble.as_deref().map(|why| format!("trouble  {why}"));
        for (row, line) in trouble.as_deref().into_iter().chain(words.lines()).take(room).enumerate() {
            if row == 0 && self.color {
                queue!(out, SetForegroundColor(color(look)), SetAttribute(Attribute::Bold))?;
            }
            queue!(
                out,
                Print(line),
                SetAttribute(Attribute::Reset),
                ResetColor,
                Clear(ClearType::UntilNewLine),
                Print("\r\n")
            )?;
        }
        queue!(out, Clear(ClearType::FromCursorDown), MoveTo(0, rows.saturating_sub(1)))?;
        queue!(out, SetAttribute(Attribute::Dim), Print(HINT), SetAttribute(Attribute::Reset))?;
        out.flush()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // Nobody is left to tell where the terminal is gone.
        let _ = execute!(stdout(), EnableLineWrap, Show, LeaveAlternateScreen);
        let _ = terminal::disable_raw_mode();
    }
}

fn color(look: &Look) -> Color {
    match look.health {
        _ if look.trouble.is_some() => Color::Red,
        Health::Well => Color::Green,
        Health::Ended | Health::Elsewhere => Color::Blue,
        Health::Degraded | Health::Stopped => Color::Yellow,
        Health::Hung | Health::Dead => Color::Red,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_end_it_and_keys_that_do_not() {
        for pressed in [&b"q"[..], b"Q", b"\x03", b"\x1b", b"xxq", b""] {
            assert!(ends(pressed), "{pressed:?}");
        }
        // An arrow is an escape with more behind it.
        for pressed in [&b"\x1b[A"[..], b"x", b"\r"] {
            assert!(!ends(pressed), "{pressed:?}");
        }
    }
}
