//! A status as a live screen: drawn anew every second from the daemon's file, until a key ends it.

use std::io::{self, IsTerminal, Write, stdin, stdout};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyModifiers};
use crossterm::style::{Attribute, Color, Print, ResetColor, SetAttribute, SetForegroundColor};
use crossterm::terminal::{
    self, Clear, ClearType, DisableLineWrap, EnableLineWrap, EnterAlternateScreen, LeaveAlternateScreen,
};
use crossterm::{execute, queue};
use signal_hook::consts::{SIGHUP, SIGTERM};

use super::{Health, Status, health, text};
use crate::exit::Usage;

/// How often it is drawn.
const BETWEEN_DRAWINGS: Duration = Duration::from_secs(1);

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

/// Waits until it is time to draw again, or the terminal has another size. Whether a key ends it.
fn wait_for_end() -> io::Result<bool> {
    if !event::poll(BETWEEN_DRAWINGS)? {
        return Ok(false);
    }
    Ok(match event::read()? {
        Event::Key(KeyEvent { code: KeyCode::Char('q' | 'Q') | KeyCode::Esc, .. }) => true,
        Event::Key(KeyEvent { code: KeyCode::Char('c'), modifiers, .. }) => {
            modifiers.contains(KeyModifiers::CONTROL)
        }
        _ => false,
    })
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
