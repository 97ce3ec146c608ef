//! Files that strangers wrote, where they are there: in the folder that `RUNG_CORPUS` names.

use std::path::PathBuf;

use crate::{codes, parse};
use rung::check::check;
use rung::frontend::native;
use rung::source::Source;

/// The files, with the codes that reading them gives.
const FILES: [(&str, usize, &[&str]); 14] = [
    ("OpenPLC_Tutorials__01_Coil_and_Contact__plc.xml", 1, &[]),
    ("OpenPLC_Tutorials__02_NO_and_NC__plc.xml", 2, &[]),
    ("OpenPLC_Tutorials__03_NOT_OR_and_NOT_Gates__plc.xml", 3, &[]),
    ("OpenPLC_Tutorials__04_AND_and_NAND_Gate__plc.xml", 2, &[]),
    ("OpenPLC_Tutorials__05_XOR_and_XNOR_Gate__plc.xml", 2, &[]),
    ("Roaster_s7-200__I2C_test__plc.xml", 4, &[]),
    ("Roaster_s7-200__openplc__plc.xml", 15, &[]),
    ("esbmc__conveyor_sequencing__conveyor.ld", 5, &[]),
    ("esbmc__emergency_shutdown__esd.ld", 7, &[]),
    ("esbmc__motor_interlock__motor_interlock.ld", 2, &[]),
    ("esbmc__stairs_light__stairs_light.ld", 2, &[]),
    ("esbmc__water_control__water_control.ld", 2, &[]),
    ("parking-automation__openplc__plc.xml", 8, &[]),
    ("sphere-usecases__test_project__plc_minimal.xml", 11, &["R0209", "R0209", "R0209", "R0209"]),
];

#[test]
fn files_of_the_corpus_are_read_and_come_back_from_native_text() {
    let Some(folder) = std::env::var_os("RUNG_CORPUS").map(|folder| PathBuf::from(folder).join("plcopen-ld")) else {
        say("RUNG_CORPUS is not set: the files of the corpus are not tested");
        return;
    };
    for (file, rungs, expected) in FILES {
        let text = std::fs::read_to_string(folder.join(file)).expect("the file is there and UTF-8");
        let parsed = parse(&text);
        assert_eq!(codes(&parsed.diagnostics), expected, "{file}: {:#?}", parsed.diagnostics);
        assert_eq!(parsed.program.rungs().count(), rungs, "{file}");
        let printed = native::print(&parsed.program);
        let again = rung::frontend::parse(&Source::new(file, printed.clone()));
        assert_eq!(codes(&again.diagnostics), Vec::<String>::new(), "{file}: {printed}");
        say(&format!("{file}: {rungs} rungs; checking finds {:?}", codes(&check(&parsed.program).1)));
    }
}

/// A line for who runs the tests with `--nocapture`.
#[expect(clippy::print_stdout, reason = "it says what is not tested, and what checking finds in files of others")]
fn say(line: &str) {
    println!("{line}");
}
