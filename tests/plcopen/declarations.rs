//! Declarations: types, interfaces, initial values, tasks and instances.

use crate::drawing::{coil, contact, locals, pou, project, rail};
use crate::{codes, native_text, parse};

fn body(read: &str, written: &str) -> String {
    format!("<LD>{}{}{}</LD>", rail(), contact(2, read, "1"), coil(3, written, "2"))
}

#[test]
fn types_and_initial_values_are_read() {
    let types = "<dataTypes>\
        <dataType name='colour'><baseType><enum><values><value name='red'/><value name='green' value='4'/></values></enum></baseType></dataType>\
        <dataType name='point'><baseType><struct><variable name='x'><type><REAL/></type><initialValue><simpleValue value='1.5'/></initialValue></variable>\
        <variable name='n'><type><INT/></type></variable></struct></baseType></dataType>\
        <dataType name='level'><baseType><subrangeSigned><range lower='0' upper='9'/><baseType><INT/></baseType></subrangeSigned></baseType></dataType>\
        <dataType name='row'><baseType><array><dimension lower='0' upper='9'/><baseType><INT/></baseType></array></baseType>\
        <initialValue><arrayValue><value repetitionValue='10'><simpleValue value='7'/></value></arrayValue></initialValue></dataType></dataTypes>";
    let interface = "<localVars retain='true'><variable name='kept'><type><DINT/></type><initialValue><simpleValue value='-5'/></initialValue></variable></localVars>\
        <localVars constant='true'><variable name='limit'><type><TIME/></type><initialValue><simpleValue value='t#2000ms'/></initialValue></variable></localVars>\
        <localVars><variable name='lamp' address='%QX0.1'><type><BOOL/></type><initialValue><simpleValue value='1'/></initialValue></variable>\
        <variable name='p'><type><derived name='point'/></type><initialValue><structValue><value member='n'><simpleValue value='3'/></value></structValue></initialValue></variable>\
        <variable name='m'><type><array><dimension lower='1' upper='2'/><dimension lower='0' upper='1'/><baseType><BOOL/></baseType></array></type>\
        <initialValue><simpleValue value='[TRUE, 3(FALSE)]'/></initialValue></variable></localVars>\
        <tempVars><variable name='t'><type><WORD/></type></variable></tempVars>";
    let text = project(&pou("program", "p", interface, &body("m[1,0]", "lamp")), "").replace("<dataTypes/>", types);
    assert_eq!(
        native_text(&text).split("\nrung").next().map(str::trim_end),
        Some(
            "imported\n\ntype colour : (red, green := 4)\n\
             \n\
             type point : struct\n  x : REAL := 1.5\n  n : INT\nend_struct\n\
             \n\
             type level : INT\n\
             type row : array [0..9] of INT := [10(7)]\n\
             \n\
             program p\n\
             \n\
             var    kept  : DINT := -5 retain\n\
             const  limit : TIME := T#2s\n\
             var    lamp  : BOOL at %QX0.1 := TRUE\n\
             var    p     : point := (n := 3)\n\
             var    m     : array [1..2, 0..1] of BOOL := [TRUE, 3(FALSE)]\n\
             temp   t     : WORD"
        )
    );
}

#[test]
fn units_tasks_and_globals_are_read() {
    let block = pou(
        "functionBlock",
        "latch",
        "<inputVars><variable name='s'><type><BOOL/></type></variable></inputVars>\
         <outputVars><variable name='q'><type><BOOL/></type></variable></outputVars>\
         <inOutVars><variable name='n'><type><INT/></type></variable></inOutVars>",
        &body("s", "q"),
    );
    let function = pou(
        "function",
        "same",
        "<returnType><BOOL/></returnType><inputVars><variable name='a'><type><BOOL/></type></variable></inputVars>",
        &body("a", "same"),
    );
    let main = pou(
        "program",
        "main",
        "<externalVars><variable name='total'><type><BOOL/></type></variable></externalVars>",
        &body("total", "total"),
    );
    let configuration = "<configuration name='c'><resource name='r'><task name='fast' priority='1' interval='T#20ms'>\
        <pouInstance name='one' typeName='main'/></task></resource>\
        <globalVars><variable name='total'><type><BOOL/></type></variable></globalVars></configuration>";
    assert_eq!(
        native_text(&project(&(block + &function + &main), configuration)),
        "imported\n\nglobal total : BOOL\n\
         \n\
         task fast(interval := T#20ms, priority := 1)\n\
         \n\
         function_block latch\n\
         \n\
         input  s : BOOL\noutput q : BOOL\ninout  n : INT\n\
         \n\
         rung\n  s (q)\n\
         \n\
         function same : BOOL\n\
         \n\
         input  a : BOOL\n\
         \n\
         rung\n  a (same)\n\
         \n\
         program main with fast\n\
         \n\
         rung\n  total (total)\n"
    );
}

#[test]
fn a_program_with_two_instances_has_them_by_name() {
    let main = pou("program", "main", &locals("a", "BOOL"), &body("a", "a"));
    let configuration = "<configuration name='c'><resource name='r'><task name='slow' interval='PT1.5S'/>\
        <pouInstance name='one' typeName='main'/><pouInstance name='two' typeName='MAIN'/></resource></configuration>";
    let text = native_text(&project(&main, configuration));
    assert!(text.contains("task slow(interval := T#1s500ms)"), "{text}");
    assert!(text.ends_with("program one : main\nprogram two : MAIN\n"), "{text}");
}

#[test]
fn a_program_that_no_task_runs_is_off() {
    let pous = pou("program", "main", &locals("a", "BOOL"), &body("a", "a"))
        + &pou("program", "idle", &locals("b", "BOOL"), &body("b", "b"));
    let configuration = "<configuration name='c'><resource name='r'><pouInstance name='one' typeName='main'/></resource></configuration>";
    let parsed = parse(&project(&pous, configuration));
    assert_eq!(codes(&parsed.diagnostics), ["R0525"]);
    assert_eq!(parsed.program.rungs().map(|rung| rung.enabled).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn any_namespace_or_prefix_is_read() {
    let plain = project(&pou("program", "p", &locals("a", "BOOL"), &body("a", "a")), "");
    let expected = native_text(&plain);
    let older = plain.replace("tc6_0201", "tc6_0200");
    let without = plain.replace(" xmlns='http://www.plcopen.org/xml/tc6_0201'", "");
    let prefixed = plain
        .replace("xmlns=", "xmlns:ppx=")
        .replace("</", "\u{1}")
        .replace('<', "<ppx:")
        .replace('\u{1}', "</ppx:")
        .replace("<ppx:?xml", "<?xml");
    for text in [older, without, prefixed] {
        assert_eq!(native_text(&text), expected, "{text}");
    }
}

#[test]
fn an_address_of_a_program_says_what_its_variable_is() {
    let interface = "<inputVars><variable name='m' address='%MX0.2'><type><BOOL/></type></variable>\
        <variable name='i' address='%IX0.0'><type><BOOL/></type></variable></inputVars>\
        <localVars><variable name='a' address='%I*'><type><BOOL/></type></variable>\
        <variable name='b' address='%Q*'><type><BOOL/></type></variable></localVars>";
    let globals = "<configuration name='c'><globalVars><variable name='g' address='%Q*'><type><INT/></type></variable>\
        <variable name='h' address='%QX*'><type><BOOL/></type></variable></globalVars></configuration>";
    let parsed = parse(&project(&pou("program", "p", interface, &body("a", "b")), globals));
    assert_eq!(codes(&parsed.diagnostics), ["R0526"]);
    let printed = rung::frontend::native::print(&parsed.program);
    let declared: Vec<&str> = printed.lines().filter(|line| line.contains(" : ")).collect();
    assert_eq!(
        declared,
        [
            "global g : INT at %QW10000",
            "global h : BOOL at %QX10001.0",
            "var    m : BOOL at %MX0.2",
            "input  i : BOOL at %IX0.0",
            "input  a : BOOL",
            "output b : BOOL"
        ]
    );
    let block = pou(
        "functionBlock",
        "f",
        "<localVars><variable name='x' address='%I*'><type><BOOL/></type></variable></localVars>",
        "<LD/>",
    );
    assert_eq!(codes(&parse(&project(&block, "")).diagnostics), ["R0209"]);
}

#[test]
fn a_program_that_an_event_starts_leaves_unless_it_comes() {
    let configuration = "<configuration name='c'><resource name='r'><task name='t' priority='1' single='g'>\
        <pouInstance name='one' typeName='p'/></task><globalVars><variable name='g'><type><BOOL/></type></variable>\
        </globalVars></resource></configuration>";
    let text = project(&pou("program", "p", &locals("a b", "BOOL"), &body("a", "b")), configuration);
    assert_eq!(crate::rungs(&text), ["\"runs at an event\" NOT(IN := [ ^g ]).OUT >> return", "a (b)"]);
    let hidden = project(&pou("program", "p", &locals("g b", "BOOL"), &body("g", "b")), configuration);
    assert_eq!(codes(&parse(&hidden).diagnostics), ["R0209"]);
    let both = text.replace("single=", "interval='T#1s' single=");
    assert_eq!(codes(&parse(&both).diagnostics), ["R0209"]);
}
