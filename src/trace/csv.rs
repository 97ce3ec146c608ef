//! A trace as a table: a row a scan, a column a variable.

use std::io::{self, Write};

use super::{Signal, Spelled, Trace};
use crate::simulate::decimal::Milliseconds;

/// Writes the header `time_ms,name,name,…` and then a row a scan, each as it is recorded.
#[derive(Debug)]
pub struct CsvTrace<W> {
    signals: Vec<Signal>,
    out: W,
    line: Vec<u8>,
}

impl<W: Write> CsvTrace<W> {
    /// Starts a table of these signals with its header.
    ///
    /// # Errors
    /// When `out` fails.
    pub fn new(signals: Vec<Signal>, out: W) -> io::Result<Self> {
        let mut header = csv::Writer::from_writer(out);
        header.write_record(std::iter::once("time_ms").chain(signals.iter().map(Signal::name)))?;
        let out = header.into_inner().map_err(|error| io::Error::from(error.error().kind()))?;
        Ok(Self { signals, out, line: Vec::new() })
    }
}

impl<W: Write> Trace for CsvTrace<W> {
    fn record(&mut self, now: i64, image: &[u8]) -> io::Result<()> {
        // No value holds a comma or a quote, so that none has to be quoted.
        self.line.clear();
        write!(self.line, "{}", Milliseconds(now))?;
        for signal in &self.signals {
            write!(self.line, ",{}", Spelled(signal.read(image)))?;
        }
        self.line.push(b'\n');
        self.out.write_all(&self.line)
    }

    fn finish(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
