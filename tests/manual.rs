//! The manual cannot drift: its drawings, pin tables, examples and timing diagrams are made here and compared with the
//! stored ones; `BLESS=1 cargo test --test manual` writes these anew. And `rung help` shows its pages.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use rung::check;
use rung::diagnostic;
use rung::draw::{self, TextOptions};
use rung::elementary::Elementary;
use rung::frontend;
use rung::ladder::functions::{Function, ParameterType, StandardFunction};
use rung::ladder::library::StandardBlock;
use rung::source::Source;

/// The columns that a page may take in the terminal.
const COLUMNS: usize = 100;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The pages about elements: stem of the file's name, and text.
fn pages() -> BTreeMap<String, String> {
    let entries = fs::read_dir(docs().join("elements")).expect("the folder of the pages");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let markdown = paths.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let stem = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
    markdown.map(|path| (stem(&path), read(&path))).collect()
}

/// Compares with a stored file, or stores it.
fn assert_stored(path: &Path, text: &str) {
    if std::env::var_os("BLESS").is_some() {
        fs::write(path, text).expect("a writable file");
    }
    let stored = fs::read_to_string(path).unwrap_or_default();
    assert!(stored == text, "{} is not up to date: look, then BLESS=1 cargo test --test manual", path.display());
}

/// A page with all that is made by the program made anew. What stands between `<!-- KIND … -->` and `<!-- end -->` is
/// made; of a table of pins, all but the last column, which says what a pin is for.
fn made_anew(stem: &str, page: &str) -> String {
    let example = read(&docs().join("elements/src").join(format!("{stem}.rung")));
    let mut text = String::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        text.push_str(line);
        text.push('\n');
        let Some(mark) = line.strip_prefix("<!-- ").and_then(|line| line.strip_suffix(" -->")) else { continue };
        let old: Vec<&str> = lines.by_ref().take_while(|line| *line != "<!-- end -->").collect();
        match mark.split_once(' ').unwrap_or((mark, "")) {
            ("drawing", "") => text.push_str(&fenced(&drawing(stem, &example))),
            ("example", "") => text.push_str(&fenced(&example)),
            ("pins", block) => text.push_str(&pins(block, &old)),
            ("variants", block) => text.push_str(&variants(block)),
            ("functions", names) => text.push_str(&functions(names, &old)),
            _ => panic!("{stem}.md has a mark of no known kind: {line}"),
        }
        text.push_str("<!-- end -->\n");
    }
    text
}

fn fenced(text: &str) -> String {
    format!("```text\n{}\n```\n", text.trim_end())
}

/// The rungs as `rung show` draws them, without the program's name and declarations.
fn drawing(stem: &str, example: &str) -> String {
    let (source, undecoded) = match Source::decode(stem, example.as_bytes()) {
        Ok(source) => (source, None),
        Err(undecoded) => (undecoded.0, Some(undecoded.1)),
    };
    let mut parsed = frontend::parse(&source);
    assert!(undecoded.is_none() && parsed.diagnostics.is_empty(), "{stem}.rung has errors");
    parsed.program.units.iter_mut().for_each(|unit| unit.variables.clear());
    let text = draw::text(&parsed.program, &TextOptions { width: 72 });
    text.split_once("\n\n").expect("a drawing").1.to_owned()
}

/// The table of a block's pins, from the library.
fn pins(block: &str, old: &[&str]) -> String {
    let block = StandardBlock::from_name(block).unwrap_or_else(|| panic!("there is no block {block}"));
    let mut table = String::from("| pin | | type | |\n|---|---|---|---|\n");
    let inputs = block.inputs().iter().map(|pin| (pin, "input"));
    for (pin, side) in inputs.chain(block.outputs().iter().map(|pin| (pin, "output"))) {
        let row = format!("| {} | {side} | {} |", pin.name, pin.ty.name());
        let meaning = old.iter().find_map(|line| line.strip_prefix(&format!("| {} |", pin.name)));
        let meaning = meaning.and_then(|rest| rest.trim_end_matches('|').rsplit('|').next()).unwrap_or("").trim();
        assert!(!meaning.is_empty(), "what is {} of {} for?", pin.name, block.name());
        table.push_str(&format!("{row} {meaning} |\n"));
    }
    table
}

/// The table of some functions with their parameters, from the library.
fn functions(names: &str, old: &[&str]) -> String {
    let mut table = String::from("| function | of | |\n|---|---|---|\n");
    for name in names.split(' ') {
        let Some(Function::Standard(function)) = Function::from_name(name) else {
            panic!("there is no function {name}")
        };
        let mut parameters: Vec<&str> = function.parameters().iter().map(|parameter| parameter.name).collect();
        parameters.extend(function.is_extensible().then_some("…"));
        let generic = function.parameters().iter().any(|parameter| parameter.ty == ParameterType::Generic);
        let class = if generic { function.class().describe() } else { "TIME" };
        let start = format!("| `{name}(");
        let meaning = old.iter().find(|line| line.starts_with(&start));
        let meaning = meaning.and_then(|row| row.trim_end_matches('|').rsplit('|').next()).unwrap_or("").trim();
        assert!(!meaning.is_empty(), "what does {name} compute?");
        table.push_str(&format!("{start}{})` | {class} | {meaning} |\n", parameters.join(", ")));
    }
    table
}

/// The blocks that share the page of a block, for other types.
fn variants(block: &str) -> String {
    let sharing = StandardBlock::ALL.iter().filter(|variant| base(**variant) == block && variant.name() != block);
    let names: Vec<String> = sharing.map(|variant| format!("`{}`", variant.name())).collect();
    format!("The same for counts of another type:\n{}.\n", names.join(", "))
}

fn rung<'a>(folder: &Path, arguments: impl IntoIterator<Item = &'a str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rung"));
    command.current_dir(folder).args(arguments).output().expect("the command starts")
}

#[test]
fn drawings_examples_and_pin_tables_are_up_to_date() {
    for (stem, page) in pages() {
        assert_stored(&docs().join("elements").join(format!("{stem}.md")), &made_anew(&stem, &page));
    }
}

/// Each page says the command that makes its diagram; that very command is run, on both engines.
#[test]
fn timing_diagrams_are_what_their_command_makes() {
    let folder = docs().join("elements/src");
    let made = tempfile::tempdir().expect("a temporary folder");
    for (stem, page) in pages() {
        let joined = page.replace("\\\n", " ");
        let commands: Vec<&str> = joined.lines().filter(|line| line.starts_with("rung sim ")).collect();
        assert!(!commands.is_empty(), "{stem}.md has no diagram");
        for command in commands {
            let mut words: Vec<&str> = command.split_whitespace().skip(1).collect();
            let name = words.pop().expect("the name of a picture");
            assert!(page.contains(&format!("](src/{name})")), "{stem}.md does not show {name}");
            let path = made.path().join(name);
            let run = rung(&folder, words.into_iter().chain([path.to_str().expect("a path"), "--engine", "both"]));
            assert!(run.status.success(), "{command}: {}", String::from_utf8_lossy(&run.stderr));
            assert_eq!(String::from_utf8_lossy(&run.stderr), "", "{command}");
            assert_stored(&folder.join(name), &read(&path));
        }
    }
}

#[test]
fn examples_are_in_canonical_form() {
    for stem in pages().keys() {
        let file = format!("{stem}.rung");
        let run = rung(&docs().join("elements/src"), ["fmt", "--check", &file]);
        assert!(run.status.success(), "{file}: {}", String::from_utf8_lossy(&run.stdout));
    }
}

/// The block whose page a block shares: itself, or, for `CTU_DINT` and its like, the one without the type.
fn base(block: StandardBlock) -> &'static str {
    match block.name().rsplit_once('_') {
        Some((base, ty)) if Elementary::from_name(ty).is_some() => base,
        _ => block.name(),
    }
}

#[test]
fn every_standard_block_has_a_page_with_its_pins() {
    let pages = pages();
    let missing: Vec<_> = StandardBlock::ALL
        .iter()
        .map(|block| base(*block))
        .filter(|base| {
            let page = pages.get(&base.to_lowercase());
            page.is_none_or(|page| !page.contains(&format!("\n<!-- pins {base} -->\n")))
        })
        .collect();
    assert_eq!(missing, Vec::<&str>::new());
}

/// The pages beside those about elements.
fn chapters() -> Vec<PathBuf> {
    let paths = fs::read_dir(docs()).expect("the manual").map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect()
}

/// The programs of a page: its blocks of text that begin as a file does.
fn programs(page: &str) -> Vec<&str> {
    let blocks = page.split("```text\n").skip(1).filter_map(|rest| rest.split("```").next());
    let begins = |block: &&str| {
        let word = block.split([' ', '\n']).next().unwrap_or_default();
        ["program", "function", "function_block", "global", "type", "task"].contains(&word)
    };
    blocks.filter(begins).collect()
}

#[test]
fn every_standard_function_has_a_row_on_a_page_that_help_finds() {
    let pages = pages();
    for function in StandardFunction::ALL {
        let row = format!("\n| `{}(", function.name());
        let page = pages.iter().find(|(_, page)| page.contains(&row)).map(|(stem, _)| stem);
        let stem = page.unwrap_or_else(|| panic!("no page has {}", function.name()));
        // The words of the text that are functions too lead there as well.
        assert_eq!(help(function.name()), help(stem), "{}", function.name());
    }
}

#[test]
fn programs_in_the_chapters_are_sound() {
    let chapters = chapters();
    for name in ["units", "tasks", "arrays", "boxes", "statements", "native-text"] {
        let path = chapters.iter().find(|path| path.file_stem().is_some_and(|stem| stem == name)).expect("a chapter");
        let page = read(path);
        let programs = programs(&page);
        assert!(!programs.is_empty(), "{name} shows no program");
        for program in programs {
            let source = Source::new(name, program);
            let parsed = frontend::parse(&source);
            let (checked, mut problems) = check::check(&parsed.program);
            problems.extend(parsed.diagnostics);
            assert!(checked.is_some(), "{name}: {}", diagnostic::render(&source, &problems));
        }
    }
}

#[test]
fn every_link_of_the_manual_leads_somewhere() {
    let mut files: Vec<PathBuf> = pages().keys().map(|stem| docs().join(format!("elements/{stem}.md"))).collect();
    files.extend(chapters());
    for file in files {
        // What stands in back quotes is no link.
        let page: String = read(&file).split('`').step_by(2).collect();
        for target in page.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = file.parent().expect("a folder").join(target);
            assert!(path.exists(), "{} links to {target}", file.display());
        }
    }
}

#[test]
fn the_contents_list_every_page() {
    let contents = read(&docs().join("README.md"));
    for stem in pages().keys() {
        assert!(contents.contains(&format!("(elements/{stem}.md)")), "docs/README.md does not list {stem}.md");
    }
}

/// What `rung help` prints for a topic.
fn help(topic: &str) -> String {
    let run = rung(&docs(), ["help", topic]);
    assert!(run.status.success(), "{topic}: {}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8(run.stdout).expect("UTF-8")
}

#[test]
fn help_shows_every_page_within_the_terminal() {
    for (stem, page) in pages() {
        let shown = help(&stem);
        let heading = page.lines().next().expect("a heading").trim_start_matches("# ");
        assert!(shown.starts_with(&format!("{heading}\n═")), "{stem}: {shown}");
        let drawing = drawing(&stem, &read(&docs().join(format!("elements/src/{stem}.rung"))));
        for line in drawing.lines().filter(|line| !line.is_empty()) {
            assert!(shown.contains(&format!("  {line}\n")), "{stem} lacks the drawing's line {line}");
        }
        assert!(shown.contains(&format!("docs/elements/src/{stem}.svg]")), "{stem} does not name its diagram");
        for sign in ["```", "<!--", "](", "|---", "\\|"] {
            assert!(!shown.contains(sign), "{stem} shows {sign}");
        }
        let widest = shown.lines().max_by_key(|line| line.chars().count()).expect("a line");
        assert!(widest.chars().count() <= COLUMNS, "{stem}: {widest}");
    }
}

#[test]
fn help_knows_every_block_in_any_case() {
    for block in StandardBlock::ALL {
        let page = help(block.name());
        assert_eq!(page, help(&base(*block).to_lowercase()));
        assert!(page.contains(block.name()), "the page of {} does not name it", block.name());
    }
}

#[test]
fn help_knows_elements_by_what_is_drawn_and_written() {
    for (topics, page) in [
        (&["contact", "NO", "--| |--", "--|/|--", "-|P|-", "^"][..], "contacts"),
        (&["coil", "(S)", "( )", "--(/)--", "(n)", "OTE"], "coils"),
        (&["parallel", ">x>", "[ ]", "Node"], "branches"),
        (&["condition", "assignment", ":="], "expressions"),
        (&["instance", "block"], "blocks"),
        (&["EN", "function box"], "box"),
        (&["IF", "for", "While"], "statements"),
        (&["function_block", "inout"], "units"),
        (&["index", "#fault", "struct"], "arrays"),
        (&["priority"], "tasks"),
        (&["overflow"], "bad input"),
    ] {
        for topic in topics {
            assert_eq!(help(topic), help(page), "{topic}");
        }
    }
}

#[test]
fn help_without_a_topic_lists_subcommands_and_elements() {
    let shown = String::from_utf8(rung(&docs(), ["help"]).stdout).expect("UTF-8");
    for line in ["  sim ", "  help ", "  ton         TON: ", "  coil        "] {
        assert!(shown.lines().any(|shown| shown.starts_with(line)), "{line} is not in\n{shown}");
    }
}

#[test]
fn help_of_a_subcommand_is_its_own_long_help() {
    for subcommand in ["check", "sim", "help"] {
        let long = rung(&docs(), [subcommand, "--help"]);
        assert_eq!(help(subcommand), String::from_utf8_lossy(&long.stdout), "{subcommand}");
    }
}

#[test]
fn an_unknown_topic_is_a_coded_error_with_a_suggestion() {
    for (topic, hint) in [
        ("TOM", "did you mean `ton`?"),
        ("chekc", "did you mean `check`?"),
        ("CTU_X", "`rung help` lists all that there is"),
        ("é", "`rung help` lists all that there is"),
    ] {
        let run = rung(&docs(), ["help", topic]);
        assert_eq!(run.status.code(), Some(1));
        let said = String::from_utf8_lossy(&run.stderr);
        assert_eq!(said, format!("error[R0107]: the manual has nothing on `{topic}`; {hint}\n"));
    }
}
