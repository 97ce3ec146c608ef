//! Files as CODESYS and its kin export them: everything in the data of the tool, networks that stand nowhere, pins that count EN.

use crate::drawing::{locals, pou, wires};
use crate::{codes, native_text, parse, rungs};

const DATA: &str = "http://www.3s-software.com/plcopenxml";

/// What the tool keeps in `<addData>` under a name.
fn data(name: &str, inside: &str) -> String {
    format!("<addData><data name='{DATA}/{name}' handleUnknown='implementation'>{inside}</data></addData>\n")
}

/// An export whose application holds this.
fn application(inside: &str) -> String {
    format!(
        "<project xmlns='http://www.plcopen.org/xml/tc6_0200'>\
         <fileHeader companyName='' productName='CODESYS' productVersion='CODESYS V3.5'/>\
         <types><dataTypes/><pous/></types><instances><configurations/></instances>{}</project>",
        data("application", &format!("<resource name='Application'>{inside}</resource>"))
    )
}

/// An element; none has a place.
fn element(tag: &str, id: u32, attributes: &str, inside: &str) -> String {
    format!("<{tag} localId='{id}' {attributes}><position x='0' y='0'/>{inside}</{tag}>\n")
}

fn contact(id: u32, variable: &str, from: &str) -> String {
    let inside = format!("{}<connectionPointOut/><variable>{variable}</variable>", wires(from));
    element("contact", id, "negated='false' storage='none' edge='none'", &inside)
}

fn coil(id: u32, variable: &str, from: &str) -> String {
    let inside = format!("{}<connectionPointOut/><variable>{variable}</variable>", wires(from));
    element("coil", id, "negated='false' storage='none'", &inside)
}

fn value(id: u32, expression: &str) -> String {
    element("inVariable", id, "", &format!("<connectionPointOut/><expression>{expression}</expression>"))
}

/// A box: inputs are `IN=3`, outputs `Q` or `ET=variable`.
fn block(id: u32, names: &str, inputs: &str, outputs: &str) -> String {
    let mut inside = "<inputVariables>".to_owned();
    for input in inputs.split_whitespace() {
        let (pin, from) = input.split_once('=').expect("a pin has its wires");
        inside += &format!("<variable formalParameter='{pin}'>{}</variable>", wires(from));
    }
    inside += "</inputVariables><inOutVariables/><outputVariables>";
    for output in outputs.split_whitespace() {
        let (pin, target) = output.split_once('=').unwrap_or((output, ""));
        let point = format!("<connectionPointOut><expression>{target}</expression></connectionPointOut>");
        inside += &format!("<variable formalParameter='{pin}'>{point}</variable>");
    }
    inside += "</outputVariables>";
    element("block", id, names, &(inside + &data("fbdcalltype", "<CallType xmlns=''>operator</CallType>")))
}

/// The start of a network: a comment without text, then its title.
fn network(id: u32, title: &str) -> String {
    let text = |text: &str| format!("<xhtml xmlns='http://www.w3.org/1999/xhtml'>{text}</xhtml>");
    let kind = data("fbdelementtype", "<ElementType xmlns=''>networktitle</ElementType>");
    element("comment", id, "height='0' width='0'", &format!("<content>{}</content>", text("")))
        + &element("vendorElement", id + 1, "", &format!("<alternativeText>{}</alternativeText>{kind}", text(title)))
}

fn ladder(elements: &[String]) -> String {
    let left = element("leftPowerRail", 0, "", "<connectionPointOut formalParameter='none'/>");
    let right = element("rightPowerRail", 2_147_483_646, "", "<connectionPointIn/>");
    format!("<LD>{left}{}{right}</LD>", elements.concat())
}

/// A program of these variables and elements.
fn program(declarations: &str, elements: &[String]) -> String {
    application(&data("pou", &pou("program", "PLC_PRG", declarations, &ladder(elements))))
}

#[test]
fn an_application_in_the_data_of_the_tool_is_read() {
    let types = "<dataType name='mode'><baseType><enum><values><value name='off'/><value name='on'/></values></enum></baseType></dataType>";
    let task = format!(
        "<task name='MainTask' interval='PT0.02S' priority='1'><pouInstance name='PLC_PRG' typeName=''>\
         <documentation><xhtml/></documentation></pouInstance>{}</task>",
        data("tasksettings", "<TaskSettings KindOfTask='Cyclic' Interval='t#20ms'/>")
    );
    let globals = "<globalVars name='GVL'><variable name='start'><type><BOOL/></type></variable></globalVars>\
         <globalVars name='Other' constant='true'><variable name='limit'><type><INT/></type><initialValue><simpleValue value='9'/></initialValue>\
         </variable></globalVars>";
    let mixed = "<MixedAttrsVarList><globalVars name='Kept' retain='true'><variable name='total'><type><INT/></type></variable></globalVars>\
         </MixedAttrsVarList>";
    let body =
        ladder(&[contact(3, "GVL.start", "0"), contact(4, "Kept.total &gt; Other.limit", "3"), coil(5, "q", "4")]);
    let unit = pou("program", "PLC_PRG", &locals("q", "BOOL"), &body);
    let text = application(
        &(task + globals + &data("mixedattrsvarlist", mixed) + &data("datatype", types) + &data("pou", &unit)),
    );
    assert_eq!(
        native_text(&text).trim(),
        "imported\n\ntype mode : (off, on)\n\
         \n\
         global start       : BOOL\n\
         global const limit : INT := 9\n\
         global total       : INT retain\n\
         \n\
         task MainTask(interval := T#20ms, priority := 1)\n\
         \n\
         program PLC_PRG with MainTask\n\
         \n\
         var    q : BOOL\n\
         \n\
         rung\n  start {total > limit} (q)"
    );
}

#[test]
fn networks_without_places_run_in_order_of_the_file_each_with_its_title() {
    let text = program(
        &locals("a b q r", "BOOL"),
        &[
            network(1, "first &amp; last"),
            contact(3, "a", "0"),
            contact(4, "q", "0"),
            contact(5, "b", "3 4"),
            coil(6, "q", "5"),
            network(7, "the other"),
            contact(9, "q", "0"),
            coil(10, "r", "9"),
        ],
    );
    assert_eq!(rungs(&text), ["\"first & last\" [ a | q ] b (q)", "\"the other\" q (r)"]);
}

#[test]
fn labels_without_places_name_the_network_behind_them() {
    let text = program(
        &locals("a q r", "BOOL"),
        &[
            contact(1, "a", "0"),
            element("jump", 2, "label='far'", &wires("1")),
            coil(3, "q", "0"),
            element("label", 4, "label='far'", ""),
            coil(5, "r", "0"),
        ],
    );
    assert_eq!(rungs(&text), ["a >> far", "(q)", "far (r)"]);
}

#[test]
fn what_takes_an_output_may_stand_at_the_pin() {
    let text = program(
        &(locals("a q", "BOOL") + &locals("t", "TON") + &locals("e", "TIME")),
        &[
            contact(1, "a", "0"),
            value(3, "T#5s"),
            block(2, "typeName='TON' instanceName='t'", "IN=1 PT=3", "Q ET=e"),
            coil(4, "q", "2.Q"),
        ],
    );
    assert_eq!(rungs(&text), ["a t:TON(PT := T#5s, ET => e) (q)"]);
}

#[test]
fn pins_of_functions_may_count_en_or_have_no_names() {
    let text = program(
        &(locals("a q", "BOOL") + &locals("n m", "INT")),
        &[
            contact(1, "a", "0"),
            value(3, "n"),
            value(4, "m + 1"),
            block(2, "typeName='GT'", "EN=1 In2=3 In3=4", "Out1"),
            coil(5, "q", "2.Out1"),
            value(7, "42"),
            block(6, "typeName='MOVE'", "EN=2.Out1 In2=7", "ENO Out2=n"),
            block(8, "typeName='ADD'", "=3 =4 =7", "=m"),
        ],
    );
    assert_eq!(
        rungs(&text),
        ["a GT(IN1 := n, IN2 := m + 1).OUT [ (q) | MOVE(IN := 42, OUT => n) ]", "{m := ADD(n, m + 1, 42)}"]
    );
}

#[test]
fn pins_of_standard_blocks_have_the_names_of_the_tool_too() {
    let declarations = locals("a b q", "BOOL") + &locals("c", "CTUD") + &locals("s", "SR") + &locals("r", "RS");
    let text = program(
        &declarations,
        &[
            contact(1, "a", "0"),
            value(2, "b"),
            value(3, "5"),
            block(4, "typeName='CTUD' instanceName='c'", "CU=1 RESET=2 LOAD=2 PV=3", "QU"),
            coil(5, "q", "4.QU"),
            contact(6, "a", "0"),
            block(7, "typeName='SR' instanceName='s'", "SET1=6 RESET=2", "Q1"),
            coil(8, "q", "7.Q1"),
            contact(9, "a", "0"),
            block(10, "typeName='RS' instanceName='r'", "SET=9 RESET1=2", "Q1"),
            coil(11, "q", "10.Q1"),
        ],
    );
    assert_eq!(rungs(&text), ["a c:CTUD(R := b, LD := b, PV := 5) (q)", "a s:SR(R := b) (q)", "a r:RS(R1 := b) (q)"]);
}

#[test]
fn methods_and_actions_are_counted_and_libraries_are_not_read() {
    let method = "<Method name='M' ObjectId='1'><interface/><body><ST><xhtml>x := 1;</xhtml></ST></body></Method>";
    let unit = format!(
        "<pou name='f' pouType='functionBlock'><interface/><actions><action name='A'><body><ST/></body></action></actions>\
         <body><ST><xhtml/></ST></body>{}{}{}</pou>",
        data("method", method),
        data("method", method),
        data("objectid", "<ObjectId>1</ObjectId>")
    );
    let libraries = data("libraries", "<Libraries><pou name='hidden' pouType='program'/></Libraries>");
    let parsed = parse(&application(&(data("pou", &unit) + &libraries)));
    let messages: Vec<&str> = parsed.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(
        messages,
        ["Rung has no actions of `f`: used once here", "Rung has no methods of `f`: used 2 times, first here"]
    );
    assert_eq!(parsed.program.units.len(), 1);
}

#[test]
fn a_box_with_structured_text_is_refused_by_name() {
    let code = data("stcode", "<STCode>q := a;</STCode>");
    let execute = block(2, "typeName='EXECUTE'", "EN=1", "ENO").replace("</block>", &format!("{code}</block>"));
    let text = program(&locals("a q", "BOOL"), &[contact(1, "a", "0"), execute]);
    assert_eq!(codes(&parse(&text).diagnostics), ["R0209"]);
}
