//! Whole projects: the joined files of a folder, and the one file of early projects.

use rung::diagnostic::render;
use rung::frontend::{self, native};
use rung::source::Source;
use serde_json::{Value, json};

use crate::drawing::{coil, contact, file, left, right, rung};
use crate::{codes, rungs_of};

fn configuration() -> Value {
    json!({"resource": {
        "tasks": [{"name": "fast", "triggering": "Cyclic", "interval": "T#20ms", "priority": 1}],
        "instances": [{"name": "instance0", "task": "fast", "program": "main"}],
        "globalVariables": [{"name": "g", "type": {"definition": "base-type", "value": "bool"}, "location": "",
            "initialValue": "1", "documentation": ""}],
    }})
}

fn types() -> Value {
    json!([
        {"name": "mode", "derivation": "enumerated", "initialValue": "", "values": [{"description": "off"}]},
        {"name": "row", "derivation": "array", "baseType": {"definition": "base-type", "value": "int"},
            "dimensions": [{"dimension": "0..9"}]},
        {"name": "pair", "derivation": "structure", "variable": [
            {"name": "m", "type": {"definition": "user-data-type", "value": "mode"}},
            {"name": "x", "type": {"definition": "base-type", "value": "int"},
                "initialValue": {"simpleValue": {"value": "3"}}},
        ]},
    ])
}

fn drawn() -> Value {
    let nodes = [left(), contact("g", "default", (10, 0)), coil("b", "default", (20, 0)), right()];
    rung(&nodes, &["L g", "g b", "b R"])
}

fn folder(main: &str) -> Source {
    let project = json!({"meta": {"name": "plant", "type": "plc-project"},
        "data": {"pous": [], "dataTypes": types(), "configuration": configuration()}});
    let files = [
        ("plant/project.json", serde_json::to_string_pretty(&project).expect("it is JSON")),
        (
            "plant/pous/functions/twice.st",
            "FUNCTION twice : INT\nVAR_INPUT x : INT; END_VAR\ntwice := x * 2;\nEND_FUNCTION".to_owned(),
        ),
        ("plant/pous/programs/main.ld", main.to_owned()),
    ];
    Source::joined("plant", files.map(|(name, text)| (name.to_owned(), text)))
}

#[test]
fn the_files_of_a_folder_are_one_program() {
    let main = file("b : bool; p : pair;", &[drawn()]).replace("\nVAR\n", "\nVAR_EXTERNAL\n g : bool;\nEND_VAR\nVAR\n");
    let parsed = frontend::parse(&folder(&main));
    assert_eq!(rungs_of(&parsed), ["{twice := x * 2} program main with fast var b : bool var p : pair", "g (b)"]);
    let text = native::print(&parsed.program);
    assert!(text.contains("task fast(interval := T#20ms, priority := 1)"), "{text}");
    assert!(text.contains("type row : array [0..9] of INT"), "{text}");
    assert!(text.contains("global g : BOOL := TRUE"), "{text}");
}

#[test]
fn a_diagnostic_names_the_file_of_a_folder_and_its_line() {
    let source = folder("PROGRAM main\nVAR\n a : ;\nEND_VAR\n{\"rungs\": []}\nEND_PROGRAM");
    let parsed = frontend::parse(&source);
    let text = render(&source, &parsed.diagnostics);
    assert!(text.contains("┌─ plant/pous/programs/main.ld:3:"), "{text}");
}

#[test]
fn what_other_languages_say_is_refused_by_name() {
    let files = [
        ("project.json", "{\"meta\": {}, \"data\": {}}"),
        ("pous/function-blocks/net.py", "FUNCTION_BLOCK net\nVAR a : BOOL; END_VAR\nprint('é')\n"),
    ];
    let source = Source::joined("p", files.map(|(name, text)| (name.to_owned(), text.to_owned())));
    let parsed = frontend::parse(&source);
    assert_eq!(codes(&parsed.diagnostics)[0], "R0209", "{:?}", parsed.diagnostics);
}

#[test]
fn early_projects_hold_their_units() {
    let variable = |name: &str, class: &str| {
        json!({"name": name, "class": class, "type": {"definition": "base-type", "value": "bool"}, "location": "",
            "documentation": ""})
    };
    let project = json!({"meta": {"name": "plant", "type": "plc-project"}, "data": {
        "dataTypes": types(),
        "pous": [
            {"type": "program", "data": {"language": "ld", "name": "main",
                "variables": [variable("b", "local"), variable("g", "external")],
                "body": {"language": "ld", "value": {"name": "main", "rungs": [drawn()]}}, "documentation": ""}},
            {"type": "function", "data": {"language": "st", "name": "inverse", "returnType": "bool",
                "variables": [variable("x", "input")],
                "body": {"language": "st", "value": "(* \"not\" *)\n\tinverse := NOT x;\n"}, "documentation": ""}},
        ],
        "configuration": configuration(),
    }});
    let text = serde_json::to_string_pretty(&project).expect("it is JSON");
    let source = Source::new("project.json", text);
    let parsed = frontend::parse(&source);
    let printed = rungs_of(&parsed);
    assert!(printed[0].starts_with("g (b)"), "{printed:?}");
    assert!(printed[1].ends_with("{inverse := NOT x}"), "{printed:?}");
    let function = parsed.program.units.iter().find(|unit| unit.name.text == "inverse").expect("it is there");
    assert_eq!(source.slice(function.rungs[0].span), "inverse := NOT x");
}

#[test]
fn a_project_without_its_files_is_said_to_be_none() {
    let text = json!({"meta": {"name": "x"}, "data": {"pous": [], "configuration": configuration()}}).to_string();
    let parsed = frontend::parse(&Source::new("project.json", text));
    assert_eq!(codes(&parsed.diagnostics), ["R0222", "R0301"]);
    assert!(parsed.diagnostics[0].hint.as_ref().is_some_and(|hint| hint.contains("folder")));
}

#[test]
fn the_command_takes_a_folder_and_refuses_one_without_a_project() {
    let folder = std::env::temp_dir().join(format!("rung-openplc-{}", std::process::id()));
    let programs = folder.join("pous/programs");
    std::fs::create_dir_all(&programs).expect("a folder for the test");
    let check = || {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_rung"));
        let output = command.arg("check").arg(&folder).output().expect("the command runs");
        let text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
        (output.status.code(), text)
    };
    let (code, text) = check();
    assert!(code == Some(1) && text.contains("without a project.json"), "{text}");
    let project = json!({"meta": {"name": "plant"}, "data": {"configuration": configuration()}}).to_string();
    std::fs::write(folder.join("project.json"), project).expect("it can be written");
    std::fs::write(programs.join("main.ld"), file("b : bool;", &[drawn()])).expect("it can be written");
    let (code, text) = check();
    assert!(code == Some(0) && text.contains("1 rung, 0 errors"), "{text}");
    std::fs::write(programs.join("main.ld"), file("a : bool;", &[drawn()])).expect("it can be written");
    let (code, text) = check();
    assert!(code == Some(1) && text.contains("main.ld:"), "{text}");
    std::fs::remove_dir_all(&folder).expect("it can be removed");
}
