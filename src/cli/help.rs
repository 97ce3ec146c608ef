//! `rung help`: the command's help, a subcommand's, or an element's page of the manual.
//!
//! The pages are those of the manual, `docs/elements/` and some chapters, embedded; what the terminal shows must never
//! be said anywhere but there.

mod markdown;

use clap::{CommandFactory, Parser};

use super::{Failure, print};
use crate::check::spelling::{Budget, nearest};
use crate::diagnostic::Code;
use crate::elementary::Elementary;
use crate::ladder::functions::Function;

/// Prints this, the help of a subcommand, or what the manual says of an element
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A subcommand, or an element: `TON`, `contact`, `'(S)'`
    #[arg(value_name = "TOPIC", allow_hyphen_values = true)]
    topic: Vec<String>,
}

/// One page about elements.
struct Page {
    /// What it is asked for by, in lower case, the one that is listed first.
    names: &'static [&'static str],
    /// Its Markdown.
    text: &'static str,
}

macro_rules! pages {
    ($($file:literal: $($name:literal)+;)*) => {
        &[$(Page {
            names: &[$($name),+],
            text: include_str!(concat!("../../docs/elements/", $file, ".md")),
        }),*]
    };
}

/// Every page, in the order in which they are listed.
const PAGES: &[Page] = pages! {
    "contacts": "contact" "contacts" "no" "nc" "normally open" "normally closed" "rising contact" "falling contact"
        "xic" "xio" "| |" "||" "|/|" "|p|" "|n|" "^" "/";
    "coils": "coil" "coils" "negated coil" "set coil" "reset coil" "latch" "unlatch" "ote" "otl" "otu"
        "( )" "()" "(/)" "(s)" "(r)" "(p)" "(n)";
    "branches": "branch" "branches" "parallel" "series" "node" "nodes" "bridge" "[ ]" "[]" "[|]" ">x>";
    "jumps": "jump" "jumps" "return" ">>";
    "expressions": "expression" "expressions" "condition" "assignment" "compare" "{ }" "{}" ":=";
    "../statements": "statement" "statements" "if" "case" "for" "while" "exit" "structured text";
    "../boxes": "box" "boxes" "function box" "en" "eno";
    "../functions": "function" "functions";
    "arithmetic": "arithmetic" "add" "sub" "mul" "div" "mod" "abs" "move" "add_time" "sub_time" "mul_time" "div_time"
        "multime" "divtime";
    "mathematics": "mathematics" "sqrt" "ln" "log" "exp" "sin" "cos" "tan" "asin" "acos" "atan" "expt";
    "bits": "bits" "bit string" "shl" "shr" "rol" "ror" "and" "or" "xor" "not";
    "selection": "selection" "sel" "mux" "min" "max" "limit";
    "comparison": "comparison" "gt" "ge" "eq" "le" "lt" "ne";
    "conversion": "conversion" "convert" "trunc";
    "blocks": "block" "blocks" "function block" "pin" "instance";
    "user_blocks": "user_blocks" "user block" "user function";
    "ton": "ton" "on-delay";
    "tof": "tof" "off-delay";
    "tp": "tp" "pulse timer";
    "tonr": "tonr" "retentive timer";
    "ctu": "ctu" "up counter";
    "ctd": "ctd" "down counter";
    "ctud": "ctud" "up-down counter";
    "r_trig": "r_trig" "rising edge" "edge";
    "f_trig": "f_trig" "falling edge";
    "sr": "sr" "bistable" "flip-flop";
    "rs": "rs";
    "sema": "sema" "semaphore";
    "integral": "integral";
    "derivative": "derivative";
    "pid": "pid" "controller";
    "ramp": "ramp";
    "hysteresis": "hysteresis" "two-point switch";
    "../units": "unit" "units" "function_block" "program" "inout" "in-out" "temp" "global" "inlining";
    "../tasks": "task" "tasks" "interval" "priority" "round";
    "../arrays": "array" "arrays" "struct" "structure" "enumeration" "index" "#fault" "fault";
    "../bad-input": "bad input" "overflow" "division by zero" "nan";
    "../register-machine": "registers" "register machine" "ireg" "oreg" "hreg";
    "tt": "tt";
    "ts": "ts";
    "uc": "uc";
    "dc": "dc";
    "dr": "dr" "drum";
    "shiftl": "shiftl" "shift left" "shift register";
    "shiftr": "shiftr" "shift right";
    "bs": "bs" "bit set";
    "bc": "bc" "bit clear";
};

impl Page {
    /// The page that a topic names, in any case; a block that is there for several types is named with or
    /// without one, and a conversion by its name.
    fn of(topic: &str) -> Option<&'static Self> {
        let named = |name: &str| PAGES.iter().find(|page| page.names.contains(&name));
        let topic = topic.to_lowercase();
        let function = || Function::from_name(&topic).and_then(|_| named("conversion"));
        named(&topic).or_else(function).or_else(|| {
            let (block, ty) = topic.rsplit_once('_')?;
            Elementary::from_name(ty).and_then(|_| named(block))
        })
    }

    /// Its heading.
    fn title(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches("# ")
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let topic = arguments.topic.join(" ");
    if topic.is_empty() {
        return print(&format!("{}\n{}", help_of(&[]), elements()));
    }
    let command = super::Arguments::command();
    if command.find_subcommand(&topic).is_some() {
        return print(&help_of(&[&topic]));
    }
    // A contact or a coil may be drawn with its wire.
    match Page::of(topic.trim_matches(['-', '─', ' '])) {
        Some(page) => print(&markdown::render(page.text)),
        None => Err(unknown(&topic, &command)),
    }
}

/// What the command prints for `--help` behind these words, with colours where they can be seen.
fn help_of(words: &[&str]) -> String {
    let words = [&["rung"], words, &["--help"]].concat();
    let help = match super::Arguments::try_parse_from(words) {
        Err(help) => help.render(),
        Ok(_) => return String::new(),
    };
    if std::io::IsTerminal::is_terminal(&std::io::stdout()) { help.ansi().to_string() } else { help.to_string() }
}

/// The list of the elements that have a page.
fn elements() -> String {
    let rows = PAGES.iter().map(|page| format!("  {:<12}{}\n", page.names[0], page.title()));
    format!("Elements (`rung help ELEMENT`):\n{}", rows.collect::<String>())
}

fn unknown(topic: &str, command: &clap::Command) -> Failure {
    let subcommands = command.get_subcommands().map(clap::Command::get_name);
    let names = PAGES.iter().flat_map(|page| page.names).copied().chain(subcommands);
    let hint = match nearest(topic, names, &mut Budget::default()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => "`rung help` lists all that there is".to_owned(),
    };
    Failure::new(Code::UnknownTopic, format!("the manual has nothing on `{topic}`; {hint}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_to_one_page() {
        let mut names: Vec<&str> = PAGES.iter().flat_map(|page| page.names).copied().collect();
        let all = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all);
        assert!(names.iter().all(|name| *name == name.to_lowercase()), "names are stored in lower case");
    }

    #[test]
    fn a_page_starts_with_its_heading() {
        for page in PAGES {
            assert!(page.text.starts_with("# "), "{}", page.names[0]);
        }
    }

    #[test]
    fn typed_variants_share_the_page_of_their_block() {
        let title = |topic| Page::of(topic).map(Page::title);
        assert_eq!(title("CTU_DINT"), title("ctu"));
        assert_eq!(title("ctud_ulint"), title("CTUD"));
        assert_eq!(title("CTU_X"), None);
        assert_eq!(title("INT"), None);
    }
}
