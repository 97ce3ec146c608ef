//! The header, what it says and who can read it, and the names that C cannot have.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::rig::{STRICT, run};

/// Something of every kind: sections, arrays, a structure, a block, addresses, comments, names that must be changed.
const PROGRAM: &str = "program pump_station

input  start at %IX0.3            -- the panel
input  stop
input  level : INT
output pump
var    runs : INT := 5 retain
var    class : UDINT
var    `a b` : LREAL := 0.1
var    a_b : REAL
var    speeds : array [1..3] of INT := [1, 2, 3]

rung r10 \"seal-in: stop wins */ really\"
  [ start | pump ] /stop (pump)

rung r20
  pump delay:TON(PT := T#5s) {runs := runs + 1} {speeds[runs] := level} {a_b := a_b * 2.0 + LREAL_TO_REAL(`a b`)}

rung r30
  {class := class + 1}
";

fn rung(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rung")).current_dir(folder).args(arguments).output().expect("the command starts")
}

fn built(folder: &Path, program: &str, arguments: &[&str]) -> String {
    fs::write(folder.join("pump.rung"), program).expect("a writable folder");
    let output = rung(folder, &[&["build", "pump.rung"], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn the_header_has_a_member_for_each_variable_with_what_the_source_says_of_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    built(folder.path(), PROGRAM, &["--header", "pump.h"]);
    let header = fs::read_to_string(folder.path().join("pump.h")).expect("the header");
    for expected in [
        " * Written by rung 0.1.0 from pump.rung; do not edit.",
        "    /* Inputs: set them before a scan */",
        "    uint8_t start; /* start: BOOL, at %IX0.3, line 3. the panel */",
        "    uint8_t stop; /* stop: BOOL, line 4 */",
        "    /* Retained memory */",
        "    int16_t runs; /* runs: INT, starts as 5, line 7 */",
        "    int16_t speeds[3]; /* speeds[1] to speeds[3]: INT, starts as 1 ..., line 11 */",
        "    uint32_t class_; /* class: UDINT, line 8 */",
        "    double a_b_2; /* a b: LREAL, starts as 0.1, line 9 */",
        "    float a_b; /* a_b: REAL, line 10 */",
        "    uint8_t delay_Q; /* delay.Q: BOOL, line 17 */",
        "    int64_t delay_start; /* delay#start: TIME, hidden, line 17 */",
        "offsetof(ladder_image_t, level) == 2u) ? 1 : -1];",
        "extern ladder_image_t ladder_image;",
        "/* To be called by the timer interrupt, every 1 ms. */\nvoid ladder_tick(void);",
    ] {
        assert!(header.contains(expected), "{header}\nlacks {expected}");
    }
}

#[test]
fn the_code_is_written_to_be_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let code = built(folder.path(), PROGRAM, &["--emit", "c"]);
    for expected in [
        "    /* r10: seal-in: stop wins * / really (line 13) */\n    image->pump = (image->start | image->pump) & \
         (image->stop ^ 1u);\n",
        "    /* r30 (line 19) */\n    image->class_ = image->class_ + 1u;\n",
    ] {
        assert!(code.contains(expected), "{code}\nlacks {expected}");
    }
    // The same in the header and in the code, so that neither can drift.
    let header = built(folder.path(), PROGRAM, &["--header", "-"]);
    let structure = |text: &str| {
        let start = text.find("typedef struct").expect("a structure");
        let end = text.find("void ladder_cycle(void *image);").expect("the last function");
        text[start..end].to_owned()
    };
    assert_eq!(structure(&code), structure(&header));
}

#[test]
fn two_headers_can_be_read_together_by_c_and_by_cpp() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (prefix, header) in [("first", "first.h"), ("second", "second.h")] {
        built(folder.path(), PROGRAM, &["--header", header, "--prefix", prefix]);
    }
    let unit = "#include \"first.h\"\n#include \"second.h\"\n#include \"first.h\"\nint main(void) { \
                first_init(&first_image, NULL); second_cycle(&second_image); return first_image.pump; }\n";
    fs::write(folder.path().join("unit.c"), unit).expect("a writable folder");
    let strict = &STRICT[1..];
    for (compiler, language) in [
        ("gcc", ["-x", "c", "-std=c99"]),
        ("clang", ["-x", "c", "-std=c11"]),
        ("clang", ["-x", "c++", "-std=c++98"]),
        ("clang", ["-x", "c++", "-std=c++17"]),
    ] {
        // A `long long` is no part of C++98, as strict as that is.
        let pedantic: &[&str] = if language[2] == "-std=c++98" { &["-Wno-long-long"] } else { &[] };
        let mut command = Command::new(compiler);
        command.current_dir(folder.path()).args(language).args(strict).args(pedantic).args(["-fsyntax-only", "unit.c"]);
        run(&mut command);
    }
}

#[test]
fn names_that_c_cannot_have_are_all_said_at_once_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let program = "program p\n\ninput switch, `größe`, fine\nvar `auto` : TON\noutput lamp\n\nrung r1\n  switch \
                   `größe` fine `auto`(PT := T#1s) (lamp)\n";
    fs::write(folder.path().join("p.rung"), program).expect("a writable folder");
    for arguments in [&["--emit", "c", "-o", "p.c"][..], &["--header", "p.h"], &["--header", "p.h", "--map", "p.json"]]
    {
        let output = rung(folder.path(), &[&["build", "p.rung"], arguments].concat());
        assert_eq!(output.status.code(), Some(1));
        let said = String::from_utf8_lossy(&output.stderr);
        for expected in [
            "error[R0911]: `switch` is a keyword of C\n  ┌─ p.rung:3:7",
            "error[R0911]: `größe` is not ASCII, as names of C are\n  ┌─ p.rung:3:16",
            "hint: rename it",
        ] {
            assert!(said.contains(expected), "{said}\nlacks {expected}");
        }
        assert_eq!(said.matches("error[").count(), 2, "{said}");
        let files = fs::read_dir(folder.path()).expect("the folder").count();
        assert_eq!(files, 1, "nothing may be written");
    }
    let output = rung(folder.path(), &["build", "p.rung", "--emit", "c", "--prefix", "int"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("the prefix `int` is a word of C"));
}
