//! The live view of a running program on a terminal.
//!
//! The terminal must be as it was before, however the view is left, and one that goes away must end the run. What is
//! drawn is in [`frame`], and pure.

mod frame;

use std::io::{self, Write};
use std::panic;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crossterm::{cursor, execute, queue, style, terminal};
use rung_runtime::Scan;

use super::Failure;
use super::machine::{self, Machine, Shared};
use super::points::{Point, Points};
use crate::diagnostic::Code;
use crate::elementary::{Elementary, Value};

/// From one drawing to the next.
const REFRESH: Duration = Duration::from_millis(100);

/// What stands above all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Title<'a> {
    pub program: &'a str,
    pub engine: &'a str,
    /// Nanoseconds.
    pub cycle: i64,
}

/// Shows a running program until it is over or a key ends it.
pub(super) fn watch<E: Scan + Send + 'static>(
    machine: &Machine<E>,
    points: &Points,
    title: &Title<'_>,
) -> Result<(), Failure> {
    let failed = |error: io::Error| Failure::new(Code::CannotWrite, format!("the terminal cannot be used: {error}"));
    let _screen = Screen::enter().map_err(failed)?;
    let keys = keys().map_err(failed)?;
    let mut view = View { points, selected: None, image: Vec::new() };
    while !machine.is_over() {
        view.draw(&machine.shared, title).map_err(failed)?;
        match keys.recv_timeout(REFRESH) {
            Ok(Press::Key(key)) if view.key(key, &machine.shared) => break,
            Ok(Press::Key(_) | Press::Other) | Err(RecvTimeoutError::Timeout) => {}
            Ok(Press::Failed(error)) => return Err(failed(error)),
            Err(RecvTimeoutError::Disconnected) => return Err(failed(io::ErrorKind::UnexpectedEof.into())),
        }
    }
    Ok(())
}

/// Whether another program has the terminal, as behind `rung run … &`: the system stops whoever changes it then.
pub(super) fn in_background() -> bool {
    // Where it cannot be told, the terminal is taken to be ours.
    std::fs::read_to_string("/proc/self/stat").is_ok_and(|stat| stands_behind(&stat))
}

/// Whether a line of `/proc/PID/stat` is that of a process whose group is not the terminal's.
fn stands_behind(stat: &str) -> bool {
    // Behind the command's name, which may hold anything: state, parent, group, session, terminal, its group.
    let fields = stat.rsplit_once(')').map_or("", |(_, fields)| fields);
    let number = |place: usize| fields.split_whitespace().nth(place).and_then(|field| field.parse::<i32>().ok());
    match (number(2), number(5)) {
        (Some(group), Some(of_terminal)) => of_terminal > 0 && of_terminal != group,
        _ => false,
    }
}

/// What the terminal sent.
#[derive(Debug)]
enum Press {
    Key(KeyEvent),
    /// Something that only wants a new drawing, such as another size.
    Other,
    Failed(io::Error),
}

/// What the terminal sends, read by a thread of its own: reading from a terminal that has gone may never return,
/// and drawing on it then still tells.
fn keys() -> io::Result<Receiver<Press>> {
    let (sender, keys) = mpsc::sync_channel(64);
    thread::Builder::new().name("rung-keys".to_owned()).spawn(move || {
        loop {
            let press = match event::read() {
                Ok(Event::Key(key)) if key.kind != KeyEventKind::Release => Press::Key(key),
                Ok(_) => Press::Other,
                Err(error) => Press::Failed(error),
            };
            let failed = matches!(press, Press::Failed(_));
            if sender.send(press).is_err() || failed {
                return;
            }
        }
    })?;
    Ok(keys)
}

/// The terminal in the view's hands; dropping it, and any panic, gives it back.
#[derive(Debug)]
struct Screen;

impl Screen {
    fn enter() -> io::Result<Self> {
        // A panic of any thread would be printed into the view and be gone with it.
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            leave();
            before(panic);
        }));
        terminal::enable_raw_mode()?;
        let screen = Self;
        execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)?;
        Ok(screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        leave();
    }
}

fn leave() {
    // There is nothing left to try when this fails.
    let _ = execute!(io::stdout(), cursor::Show, terminal::LeaveAlternateScreen);
    let _ = terminal::disable_raw_mode();
}

#[derive(Debug)]
struct View<'a> {
    points: &'a Points,
    /// The input that + and - change, by its place.
    selected: Option<usize>,
    image: Vec<u8>,
}

impl View<'_> {
    fn draw(&mut self, shared: &Shared, title: &Title<'_>) -> io::Result<()> {
        let (width, height) = terminal::size()?;
        shared.image(&mut self.image);
        let lines = frame::lines(
            &frame::State {
                title: title.program,
                engine: title.engine,
                cycle: title.cycle,
                now: shared.now(),
                statistics: &shared.statistics,
                points: self.points,
                image: &self.image,
                inputs: &|point| machine::input(&shared.panel, &point.slot),
                selected: self.selected,
            },
            usize::from(width),
            usize::from(height),
        );
        let mut out = io::stdout().lock();
        for (row, line) in (0..height).zip(lines.iter().map(String::as_str).chain(std::iter::repeat(""))) {
            queue!(
                out,
                cursor::MoveTo(0, row),
                style::Print(line),
                terminal::Clear(terminal::ClearType::UntilNewLine)
            )?;
        }
        out.flush()
    }

    /// Does what a key is for; TRUE for those that end the run.
    fn key(&mut self, key: KeyEvent, shared: &Shared) -> bool {
        match key.code {
            KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return true,
            KeyCode::Char('q') | KeyCode::Esc => return true,
            KeyCode::Char('+' | '=') | KeyCode::Up => self.step(1, shared),
            KeyCode::Char('-') | KeyCode::Down => self.step(-1, shared),
            KeyCode::Char(pressed) => {
                let Some(index) = self.points.inputs.iter().position(|input| input.key == Some(pressed)) else {
                    return false;
                };
                let slot = &self.points.inputs[index].slot;
                if slot.ty == Elementary::Bool {
                    let value = machine::input(&shared.panel, slot);
                    machine::set(&shared.panel, slot, Value::bool(!value.is_true()));
                } else {
                    self.selected = Some(index);
                }
            }
            _ => {}
        }
        shared.stop.load(Ordering::Relaxed)
    }

    /// Moves the selected input by one step.
    fn step(&self, direction: i8, shared: &Shared) {
        if let Some(Point { slot, .. }) = self.selected.and_then(|index| self.points.inputs.get(index)) {
            let value = stepped(machine::input(&shared.panel, slot), direction);
            machine::set(&shared.panel, slot, value);
        }
    }
}

/// A value moved by 1, of a TIME by 100 ms, held at the ends of its range.
fn stepped(value: Value, direction: i8) -> Value {
    let ty = value.ty();
    let moved = match (value.as_real(), value.as_integer()) {
        (Some(real), _) => Value::real(ty, real + f64::from(direction)),
        (None, Some(number)) => {
            let step = if ty == Elementary::Time { 100_000_000 } else { 1 };
            Value::integer(ty, number + i128::from(direction) * step)
        }
        (None, None) => None,
    };
    moved.unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_stays_within_the_type() {
        let integer = |ty, number| Value::integer(ty, number).expect("in range");
        assert_eq!(stepped(integer(Elementary::Int, 5), -1), integer(Elementary::Int, 4));
        assert_eq!(stepped(integer(Elementary::Int, 32_767), 1), integer(Elementary::Int, 32_767));
        assert_eq!(stepped(integer(Elementary::Byte, 0), -1), integer(Elementary::Byte, 0));
        assert_eq!(stepped(Value::time(0), 1), Value::time(100_000_000));
        assert_eq!(
            Value::real(Elementary::Real, 1.5).map(|value| stepped(value, 1)),
            Value::real(Elementary::Real, 2.5)
        );
    }

    #[test]
    fn a_job_in_the_background_is_told_by_the_group_that_has_the_terminal() {
        assert!(stands_behind("4242 (a) 1 (b) S 1 4242 4000 34816 4100 4194304"));
        assert!(!stands_behind("4242 (rung) S 1 4242 4000 34816 4242 4194304"));
        assert!(!stands_behind("4242 (rung) S 1 4242 4000 0 -1 4194304"));
        assert!(!stands_behind(""));
    }
}
