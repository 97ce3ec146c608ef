//! `rung run` on a terminal, here a pseudo-terminal. No figure that depends on the machine is asserted.
#![cfg(target_os = "linux")]

use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};

use rustix::fs::{Mode, OFlags};
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Termios, Winsize, tcgetattr, tcsetwinsize};

/// A running command and its terminal.
struct Session {
    child: Child,
    /// The person's side of the terminal.
    person: File,
    /// The command's side.
    terminal: OwnedFd,
    before: Termios,
    /// What has come out and was not looked at yet.
    shown: Vec<u8>,
}

impl Session {
    fn start(options: &[&str]) -> Self {
        let person = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).expect("a terminal");
        grantpt(&person).expect("granted");
        unlockpt(&person).expect("unlocked");
        let (name, flags) = (ptsname(&person, Vec::new()).expect("a name"), OFlags::RDWR | OFlags::NOCTTY);
        let terminal = rustix::fs::open(&name, flags | OFlags::CLOEXEC, Mode::empty()).expect("its other side");
        tcsetwinsize(&terminal, Winsize { ws_row: 30, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 }).expect("a size");
        let before = tcgetattr(&terminal).expect("its modes");
        let stream = || Stdio::from(terminal.try_clone().expect("a descriptor"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
        command.arg("run").arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/start_stop.rung"));
        // Whole minutes for the watchdog: whether this machine is busy is not what is tested.
        command.args(["--watchdog", "2m"]).args(options);
        let child = command.stdin(stream()).stdout(stream()).stderr(stream()).spawn().expect("the command starts");
        Self { child, person: File::from(person), terminal, before, shown: Vec::new() }
    }

    /// Reads until the command has shown something behind what was read before.
    fn until(&mut self, what: &str) {
        let mut bytes = [0; 4096];
        loop {
            if let Some(at) = self.shown.windows(what.len()).position(|window| window == what.as_bytes()) {
                self.shown.drain(..at + what.len());
                return;
            }
            let count = self.person.read(&mut bytes).expect("an open terminal");
            self.shown.extend_from_slice(&bytes[..count]);
        }
    }

    fn press(&mut self, keys: &str) {
        self.person.write_all(keys.as_bytes()).expect("an open terminal");
    }

    /// Waits for the end, which comes with a summary and leaves the terminal as it was.
    fn end(mut self) -> ExitStatus {
        self.until("ended after");
        self.until("watchdog  ");
        let status = self.child.wait().expect("a child");
        let after = tcgetattr(&self.terminal).expect("its modes");
        assert_eq!(after.local_modes, self.before.local_modes);
        assert_eq!(after.input_modes, self.before.input_modes);
        status
    }
}

/// Where a view begins, and where it gives the terminal back.
const ENTERED: &str = "\u{1b}[?1049h";
const LEFT: &str = "\u{1b}[?1049l";

#[test]
fn keys_toggle_inputs_and_end_the_run() {
    for end in ["q", "\u{3}"] {
        let mut session = Session::start(&[]);
        session.until(ENTERED);
        session.until("[1] ○ start");
        session.press("1");
        session.until("[1] ● start");
        session.press("2");
        session.until("[2] ● stop");
        session.press(end);
        session.until(LEFT);
        assert_eq!(session.end().code(), Some(0), "{end:?}");
    }
}

#[test]
fn a_signal_ends_the_run_with_a_summary_and_the_terminal_as_it_was() {
    for signal in [Signal::INT, Signal::TERM, Signal::HUP] {
        let mut session = Session::start(&[]);
        session.until("cycles");
        kill_process(Pid::from_child(&session.child), signal).expect("a running child");
        session.until(LEFT);
        assert_eq!(session.end().code(), Some(0), "{signal:?}");
    }
}

#[test]
fn a_run_whose_time_is_up_leaves_the_view() {
    let mut session = Session::start(&["--for", "300ms"]);
    session.until(LEFT);
    assert_eq!(session.end().code(), Some(0));
}

#[test]
fn a_terminal_that_goes_away_ends_the_run() {
    let mut session = Session::start(&[]);
    session.until("cycles");
    let Session { mut child, person, terminal, .. } = session;
    drop((person, terminal));
    assert_eq!(child.wait().expect("a child").code(), Some(1));
}
