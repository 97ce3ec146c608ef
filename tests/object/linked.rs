//! Objects linked by a C compiler into one program with a prefix each, and run: every image is the interpreter's.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use rung::engine::interp::Textbook;
use rung::engine::object;
use rung::engine::target::Target;
use rung::interface::{CLOCK_SIZE, Interface};
use rung::logic::{Program, random};
use rung::{check, frontend, lower, opt, source::Source};
use rung_runtime::Scan;

/// Images of each program that are scanned, twice each.
const IMAGES: u64 = 6;

/// Reads requests: which program, what, a time and an image; writes the image after it.
const MAIN: &str = r#"
int main(void) {
    static unsigned char image[1 << 20];
    struct { uint32_t program, what; int64_t now; } request;
    while (fread(&request, sizeof request, 1, stdin) == 1) {
        const struct program *p = &programs[request.program];
        uint32_t size = *p->size - 16;
        if (fread(image, 1, size, stdin) != size) return 1;
        if (request.what == 0) p->scan(image, request.now);
        if (request.what == 1) p->init(image, 0);
        if (request.what == 2) { p->init(image, 0); p->tick(); p->tick(); p->cycle(image); }
        fwrite(image, 1, size, stdout);
    }
    return 0;
}
"#;

fn examples() -> Vec<Program> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("the examples").map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "rung"));
    paths.sort();
    let program = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).expect("a program");
        let source = Source::new(path.display().to_string(), text);
        let checked = check::check(&frontend::parse(&source).program).0.expect("a program without errors");
        opt::optimise(lower::lower(&checked, &source, None).expect("a small image"))
    };
    paths.iter().map(program).collect()
}

struct Requests {
    sent: Vec<u8>,
    expected: Vec<u8>,
}

impl Requests {
    fn add(&mut self, program: usize, what: u32, now: i64, before: &[u8], after: &[u8]) {
        self.sent.extend(u32::try_from(program).expect("few programs").to_ne_bytes());
        self.sent.extend(what.to_ne_bytes());
        self.sent.extend(now.to_ne_bytes());
        self.sent.extend(before);
        self.expected.extend(after);
    }
}

fn requests(programs: &[Program], tick: i64) -> Requests {
    let mut requests = Requests { sent: Vec::new(), expected: Vec::new() };
    for (index, program) in programs.iter().enumerate() {
        let mut textbook = Textbook::new(program);
        let mut initial = program.layout.initial_image();
        let garbage = vec![0xA5; initial.len()];
        requests.add(index, 1, 0, &garbage, &initial);
        textbook.scan(&mut initial, 2 * tick);
        requests.add(index, 2, 0, &garbage, &initial);
        for round in 0..IMAGES {
            let mut image = random::image(&program.layout, round << 32 | index as u64);
            for scan in 0..2 {
                let (now, before) = (random::now(round * 1000 + scan), image.clone());
                textbook.scan(&mut image, now);
                requests.add(index, 0, now, &before, &image);
            }
        }
    }
    requests
}

/// The C program, with one line for each prefix.
fn source(count: usize) -> String {
    let mut text = String::from(
        "#include <stdint.h>\n#include <stdio.h>\nstruct program { const uint32_t *size; void (*init)(void *, const void \
         *), (*scan)(void *, int64_t), (*tick)(void), (*cycle)(void *); };\n",
    );
    for p in 0..count {
        let _ = writeln!(
            text,
            "extern const uint32_t p{p}_image_size; void p{p}_init(void *, const void *), p{p}_scan(void *, int64_t), \
             p{p}_tick(void), p{p}_cycle(void *);"
        );
    }
    text += "static const struct program programs[] = {\n";
    for p in 0..count {
        let _ = writeln!(text, "  {{ &p{p}_image_size, p{p}_init, p{p}_scan, p{p}_tick, p{p}_cycle }},");
    }
    text + "};\n" + MAIN
}

#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn linked_objects_leave_the_images_that_the_interpreter_leaves() {
    let tick = 500_000;
    let mut programs = examples();
    let examples = programs.len();
    assert!(examples >= 10, "only {examples} examples: this test looks at the wrong place");
    programs.extend((0..60).map(random::program));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = Target::new(&Target::host_triple(), None, None).expect("this machine");
    let mut files = vec![folder.path().join("main.c")];
    std::fs::write(&files[0], source(programs.len())).expect("a file");
    for (index, program) in programs.iter().enumerate() {
        let interface = Interface::new(&format!("p{index}"), tick).expect("an interface");
        let bytes =
            object::build(program, &interface, &target).unwrap_or_else(|error| panic!("{}: {error}", program.name));
        files.push(folder.path().join(format!("p{index}.o")));
        std::fs::write(&files[index + 1], bytes).expect("a file");
    }
    let binary = folder.path().join("all");
    let linked = Command::new("gcc").args(["-O1", "-Wall", "-Werror", "-o"]).arg(&binary).args(&files).output();
    let linked = linked.expect("a C compiler");
    assert!(linked.status.success(), "{}", String::from_utf8_lossy(&linked.stderr));

    let requests = requests(&programs, tick);
    let mut child =
        Command::new(binary).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("a pipe");
    let sent = requests.sent;
    let writer = std::thread::spawn(move || stdin.write_all(&sent));
    let output = child.wait_with_output().expect("the program ends");
    writer.join().expect("no panic").expect("all was read");
    assert!(output.status.success(), "{:?}", output.status);
    let images = programs.iter().map(|program| (program, program.layout.size() as usize));
    let mut at = 0;
    for (program, size) in images {
        for image in 0..2 + 2 * IMAGES {
            let (expected, actual) = (&requests.expected[at..at + size], &output.stdout[at..at + size]);
            assert_eq!(actual, expected, "{}, image {image}", program.name);
            at += size;
        }
    }
    assert_eq!(at, output.stdout.len());
    assert_eq!(CLOCK_SIZE, 16, "as the C program has it");
}
