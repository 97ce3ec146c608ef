//! Rungs: words one behind the other while a line has room, and what has none spread over lines of its own, its
//! branches one below the other as they are drawn.

use unicode_width::UnicodeWidthStr;

use super::{LINE_WIDTH, Page, statements, words};
use crate::ladder::{BlockCall, Branch, Circuit, Element, ElementKind, Rung, Statement, Wire};

/// Where bodies stand; the bars of a rung's own branches stand to the left of it.
const BODY: usize = 2;

/// The deepest indentation, so that deep circuits still have room on their lines.
const DEEPEST: usize = 60;

pub(super) const fn deeper(indent: usize) -> usize {
    if indent + 2 > DEEPEST { DEEPEST } else { indent + 2 }
}

/// Prints a rung and the comments before and in it.
pub(super) fn print(page: &mut Page<'_>, rung: &Rung) {
    page.flush(rung.span.start, 0);
    page.line(0);
    page.push("rung");
    if !rung.enabled {
        page.push(" off");
    }
    if let Some(name) = &rung.name {
        page.push(" ");
        // Bare, this name would switch the rung off.
        let off = name.text.eq_ignore_ascii_case("off");
        page.push(&if off { format!("`{}`", name.text).into() } else { words::name(&name.text) });
    }
    if let Some(title) = &rung.title {
        page.push(" ");
        page.push(&words::title(title));
    }
    // The body starts on a new line, if there is one.
    page.ended = true;
    for (index, branch) in rung.circuit.branches.iter().enumerate() {
        if index > 0 {
            print_bar(page, branch, 0);
        }
        print_branch(page, branch, BODY);
    }
}

/// Starts the next branch of a circuit that takes several lines. Comments stand before its bar.
fn print_bar(page: &mut Page<'_>, branch: &Branch, indent: usize) {
    let first_element = branch.elements.first().map(|element| element.span);
    let first = branch.from.as_ref().map(|name| name.span).or(first_element).or(branch.to.as_ref().map(|to| to.span));
    page.flush(first.map_or(0, |span| span.start), deeper(indent));
    page.line(indent);
    page.gutter("|");
}

fn print_branch(page: &mut Page<'_>, branch: &Branch, indent: usize) {
    if let Some(from) = &branch.from {
        page.flush(from.span.start, indent);
        page.word(&words::node(&from.text), indent);
    }
    for element in &branch.elements {
        page.flush(element.span.start, indent);
        print_element(page, element, indent);
    }
    if let Some(to) = &branch.to {
        page.flush(to.span.start, indent);
        if words::is_bare_feed(branch) {
            page.word("-", indent);
        }
        page.word(&words::node(&to.text), indent);
    }
}

fn print_element(page: &mut Page<'_>, element: &Element, indent: usize) {
    // A comment within has to end a line within, if there is more than one line at all.
    let whole = !page.has_comment_before(element.span.end);
    let statements = matches!(element.kind, ElementKind::Statements(_));
    if (whole || !statements)
        && let Some(word) = words::simple_element(element)
    {
        page.word(&word, indent);
        return;
    }
    if whole
        && let Some(word) = words::short_element(element)
        && indent + word.width() <= LINE_WIDTH
    {
        page.word(&word, indent);
        return;
    }
    page.start(indent);
    match &element.kind {
        ElementKind::Block(call) => print_block(page, call, element.span.end, indent),
        ElementKind::Parallel(circuit) => print_brackets(page, circuit, indent),
        ElementKind::Statements(list) => print_statements(page, list, element.span.end, indent),
        _ => {}
    }
}

/// ```text
/// [ start
/// | pump
/// ]
/// ```
fn print_brackets(page: &mut Page<'_>, circuit: &Circuit, indent: usize) {
    page.gutter("[");
    for (index, branch) in circuit.branches.iter().enumerate() {
        if index > 0 {
            print_bar(page, branch, indent);
        }
        print_branch(page, branch, deeper(indent));
    }
    page.flush(circuit.span.end.saturating_sub(1), deeper(indent));
    page.line(indent);
    page.push("]");
}

/// ```text
/// { IF a THEN
///     b := 1;
///   END_IF;
/// }
/// ```
fn print_statements(page: &mut Page<'_>, list: &[Statement], end: u32, indent: usize) {
    let closing = end.saturating_sub(1);
    page.gutter("{");
    statements::print(page, list, closing, deeper(indent));
    page.flush(closing, deeper(indent));
    page.line(indent);
    page.push("}");
}

/// ```text
/// starts:CTU(
///   PV := 100,
///   R :=
///     [ stop
///     | fault
///     ]
/// )
/// ```
fn print_block(page: &mut Page<'_>, call: &BlockCall, end: u32, indent: usize) {
    page.push(&words::block_head(call));
    let indent_arguments = deeper(indent);
    for (index, argument) in call.arguments.iter().enumerate() {
        page.flush(argument.span.start, indent_arguments);
        page.line(indent_arguments);
        match &argument.wire {
            Wire::Circuit(circuit) => print_circuit_argument(page, &argument.pin.text, circuit, indent_arguments),
            _ => page.push(&words::simple_argument(argument).unwrap_or_default()),
        }
        if index + 1 < call.arguments.len() {
            page.push(",");
        }
    }
    page.flush(end.saturating_sub(1), indent_arguments);
    page.line(indent);
    page.push(&words::block_tail(call));
}

fn print_circuit_argument(page: &mut Page<'_>, pin: &str, circuit: &Circuit, indent: usize) {
    let pin = format!("{} :=", words::name(pin));
    page.push(&pin);
    if !page.has_comment_before(circuit.span.end)
        && let Some(word) = words::short_circuit(circuit)
        && indent + pin.width() + 1 + word.width() < LINE_WIDTH
    {
        page.push(" ");
        page.push(&word);
    } else {
        page.line(deeper(indent));
        print_brackets(page, circuit, deeper(indent));
    }
}
