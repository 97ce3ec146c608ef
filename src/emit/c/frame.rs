//! The functions that firmware calls, around the rungs: start, save, scan, tick and cycle.

use std::fmt::Write;
use std::ops::Range;

use super::Chunk;
use super::expression::Expression;
use crate::emit::structure::{Clock, Structure};
use crate::interface::{self, ABI_VERSION, Interface, image_size};
use crate::logic::{Layout, Program, SlotId};

/// Initial values that one function sets: compilers take long over functions that are long.
const INITIALS: usize = 1000;

/// All functions and constants of the interface.
pub(super) fn frame(
    program: &Program,
    structure: &Structure<'_>,
    interface: &Interface,
    clock: &Clock,
    chunks: &[Chunk],
) -> String {
    let (layout, prefix) = (&program.layout, interface.prefix());
    let runs: Vec<(u32, u32)> = layout.retained().iter().map(|run| (run.start, run.end - run.start)).collect();
    let mut text = format!(
        "\n{prefix}_image_t {prefix}_image;\nconst uint32_t {prefix}_image_size = {}u;\nconst uint32_t \
         {prefix}_retain_offset = {}u;\nconst uint32_t {prefix}_retain_size = {}u;\nconst uint64_t \
         {prefix}_layout_hash = UINT64_C(0x{:016X});\nconst uint32_t {prefix}_abi_version = {ABI_VERSION}u;\n\n\
         /* Ticks, counted by the timer interrupt. */\nstatic volatile uint32_t {prefix}_ticks = 0u;\n",
        image_size(layout),
        interface::retain_offset(layout),
        interface::retain_size(layout),
        layout.hash(),
    );
    let starts = starts(&mut text, layout, structure, prefix);
    init(&mut text, layout, interface, clock, &runs, &starts);
    save(&mut text, prefix, &runs);
    scan(&mut text, program, structure, prefix, chunks);
    cycle(&mut text, layout, interface, clock);
    text
}

/// The functions that set initial values other than zero; gives their names.
fn starts(text: &mut String, layout: &Layout, structure: &Structure<'_>, prefix: &str) -> Vec<String> {
    let set: Vec<SlotId> = (0..)
        .zip(layout.slots())
        .filter(|(_, slot)| slot.initial.bits() != 0)
        .map(|(index, _)| SlotId(index))
        .collect();
    let mut names = Vec::new();
    for (number, slots) in set.chunks(INITIALS).enumerate() {
        let name = format!("start_{}", number + 1);
        let _ = write!(text, "\nstatic void {name}({prefix}_image_t *const image)\n{{\n");
        for slot in slots {
            let initial = layout.slot(*slot).initial;
            let constant = Expression::constant(initial.ty(), initial.bits());
            let _ = writeln!(text, "    image->{} = {};", structure.access(*slot), constant.text);
        }
        text.push_str("}\n");
        names.push(name);
    }
    names
}

fn init(
    text: &mut String,
    layout: &Layout,
    interface: &Interface,
    clock: &Clock,
    runs: &[(u32, u32)],
    starts: &[String],
) {
    let prefix = interface.prefix();
    let _ = write!(
        text,
        "\nvoid {prefix}_init(void *image, const void *retained)\n{{\n    {prefix}_image_t *const typed = \
         ({prefix}_image_t *)image;\n    uint8_t *const bytes = (uint8_t *)image;\n\n    for (uint32_t place = 0u; \
         place < {}u; place++)\n    {{\n        bytes[place] = 0u;\n    }}\n",
        image_size(layout)
    );
    for start in starts {
        let _ = writeln!(text, "    {start}(typed);");
    }
    if runs.is_empty() {
        text.push_str("    (void)retained;\n");
    } else {
        text.push_str("    if (retained != NULL)\n    {\n");
        text.push_str("        const uint8_t *const saved = (const uint8_t *)retained;\n\n");
        copies(text, "        ", runs, |at, from| format!("bytes[{at}] = saved[{from}];"));
        let normalise = normalised(&interface::retained_bools(layout));
        for line in normalise {
            let _ = writeln!(text, "        {line}");
        }
        text.push_str("    }\n");
    }
    let _ = write!(text, "    typed->{} = {prefix}_ticks;\n}}\n", clock.last_ticks);
}

/// Calls that make the BOOLs of some runs 0 or 1.
fn normalised(runs: &[Range<u32>]) -> Vec<String> {
    runs.iter().map(|run| format!("normalise(bytes, {}u, {}u);", run.start, run.end)).collect()
}

/// A loop for each run of retained bytes; `step` copies one, given its place in the image and among the retained.
fn copies(text: &mut String, indent: &str, runs: &[(u32, u32)], step: impl Fn(&str, &str) -> String) {
    let mut before = 0;
    for (start, size) in runs {
        let place = |offset: u32| if offset == 0 { "place".to_owned() } else { format!("{offset}u + place") };
        let _ = write!(
            text,
            "{indent}for (uint32_t place = 0u; place < {size}u; place++)\n{indent}{{\n{indent}    {}\n{indent}}}\n",
            step(&place(*start), &place(before))
        );
        before += size;
    }
}

fn save(text: &mut String, prefix: &str, runs: &[(u32, u32)]) {
    let _ = write!(text, "\nvoid {prefix}_save(const void *image, void *retained)\n{{\n");
    if runs.is_empty() {
        text.push_str("    (void)image;\n    (void)retained;\n}\n");
        return;
    }
    text.push_str("    const uint8_t *const bytes = (const uint8_t *)image;\n");
    text.push_str("    uint8_t *const saved = (uint8_t *)retained;\n\n");
    copies(text, "    ", runs, |at, to| format!("saved[{to}] = bytes[{at}];"));
    text.push_str("}\n");
}

fn scan(text: &mut String, program: &Program, structure: &Structure<'_>, prefix: &str, chunks: &[Chunk]) {
    let mut body = String::new();
    let (mut uses_now, mut uses_image) = (false, false);
    for (index, task) in program.tasks.iter().enumerate() {
        let sections = program.task_range(index);
        let mut calls = String::new();
        let indent = if task.interval.is_some() { "        " } else { "    " };
        for chunk in chunks.iter().filter(|chunk| sections.contains(&chunk.start)) {
            let now = if chunk.uses_now { ", now" } else { "" };
            let _ = writeln!(calls, "{indent}{}(typed{now});", chunk.name);
            uses_now |= chunk.uses_now;
            uses_image = true;
        }
        if !task.name.is_empty() {
            let _ = writeln!(body, "    /* The task {} */", crate::emit::notes::comment(&task.name));
        }
        match task.interval.zip(task.due) {
            None => body.push_str(&calls),
            Some((interval, due)) => {
                let due = structure.access(due);
                let _ = write!(
                    body,
                    "    if (now >= typed->{due})\n    {{\n        typed->{due} = turn(INT64_C({interval}), \
                     now);\n{calls}    }}\n"
                );
                (uses_now, uses_image) = (true, true);
            }
        }
    }
    let _ = write!(text, "\nvoid {prefix}_scan(void *image, int64_t now)\n{{\n");
    if uses_image {
        let _ = write!(text, "    {prefix}_image_t *const typed = ({prefix}_image_t *)image;\n\n");
    } else {
        text.push_str("    (void)image;\n");
    }
    if !uses_now {
        text.push_str("    (void)now;\n");
    }
    let _ = writeln!(text, "{body}}}");
}

fn cycle(text: &mut String, layout: &Layout, interface: &Interface, clock: &Clock) {
    let (prefix, tick) = (interface.prefix(), interface.tick());
    let _ = write!(
        text,
        "\nvoid {prefix}_tick(void)\n{{\n    {prefix}_ticks = {prefix}_ticks + 1u;\n}}\n\nvoid {prefix}_cycle(void \
         *image)\n{{\n    {prefix}_image_t *const typed = ({prefix}_image_t *)image;\n"
    );
    let normalise = normalised(&interface::input_bools(layout));
    if !normalise.is_empty() {
        text.push_str("    uint8_t *const bytes = (uint8_t *)image;\n");
    }
    let (last, total) = (&clock.last_ticks, &clock.total_ticks);
    let _ = write!(
        text,
        "    const uint32_t ticks = {prefix}_ticks;\n    const uint64_t total = typed->{total} + \
         (uint64_t)(uint32_t)(ticks - typed->{last});\n    const uint64_t held = (total > UINT64_C({most})) ? \
         UINT64_C({most}) : total;\n\n    typed->{last} = ticks;\n    typed->{total} = total;\n",
        most = i64::MAX / tick
    );
    for line in normalise {
        let _ = writeln!(text, "    {line}");
    }
    // What lies beyond the last whole tick before the end of time is that end.
    let _ = write!(
        text,
        "    {prefix}_scan(image, (held < total) ? INT64_MAX : (int64_t)(held * UINT64_C({tick})));\n}}\n"
    );
}
