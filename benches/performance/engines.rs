//! Every engine and compiler on programs of several sizes: what `rung bench` prints.

use std::path::Path;

use crate::{Plan, generated, rung};

/// The table of `rung bench`, and what it says as JSON.
pub(crate) struct Engines {
    pub(crate) table: String,
    pub(crate) json: serde_json::Value,
}

pub(crate) fn measure(plan: &Plan, folder: &Path, chart: &Path) -> Engines {
    let files: Vec<_> = plan.sizes.iter().map(|(rungs, timers)| generated(folder, *rungs, *timers)).collect();
    let json = folder.join("bench.json");
    let mut command = rung();
    command.arg("bench").args(&files).args(["--patience", plan.patience, "--json"]).arg(&json).arg("--svg").arg(chart);
    if let Some(scans) = plan.scans {
        command.args(["--scans", scans]);
    }
    let output = command.output().expect("the command runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json = serde_json::from_slice(&std::fs::read(json).expect("written")).expect("JSON");
    Engines { table: String::from_utf8(output.stdout).expect("UTF-8"), json }
}

impl Engines {
    /// What is known of an engine on the program of a size.
    pub(crate) fn value(&self, rungs: u32, engine: &str, what: &str) -> Option<f64> {
        let programs = self.json.as_array()?;
        let program = programs.iter().find(|program| program["rungs"] == rungs)?;
        program["rows"].as_array()?.iter().find(|row| row["engine"] == engine)?[what].as_f64()
    }
}
