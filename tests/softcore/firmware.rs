//! Firmware of many programs: the tables that `check.c` runs them by, and what is built of all.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use tempfile::TempDir;

use crate::suite::{Case, SUITE, places};
use crate::target::{Target, output, root, rung};

/// Every program as text, and as C with its header, for all targets.
struct Prepared {
    /// Keeps the files until the last test has run.
    _folder: TempDir,
    /// By case: the path without its extension, which is the prefix of its names, too.
    stems: Vec<PathBuf>,
}

static PREPARED: LazyLock<Prepared> = LazyLock::new(|| {
    let folder = TempDir::new().expect("a temporary folder");
    let stems: Vec<PathBuf> = (0..SUITE.cases.len()).map(|index| folder.path().join(format!("p{index}"))).collect();
    for (stem, case) in stems.iter().zip(&SUITE.cases) {
        fs::write(stem.with_extension("rung"), &case.text).expect("a writable folder");
    }
    in_parallel(&stems, |stem| {
        let header = stem.with_extension("h");
        build(stem, &stem.with_extension("c"), &["--emit", "c", "--header", header.to_str().expect("UTF-8")]);
    });
    Prepared { _folder: folder, stems }
});

/// Has `rung` build a prepared program.
fn build(stem: &Path, to: &Path, arguments: &[&str]) {
    let prefix = stem.file_name().expect("a name");
    let mut command = rung();
    command.arg("build").arg(stem.with_extension("rung")).arg("--prefix").arg(prefix).args(arguments);
    output(command.arg("-o").arg(to));
}

/// Does the same with each, on as many threads as there are processors.
fn in_parallel(stems: &[PathBuf], work: impl Fn(&Path) + Sync) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let work = &work;
    std::thread::scope(|scope| {
        for thread in 0..threads {
            scope.spawn(move || stems.iter().skip(thread).step_by(threads).for_each(|stem| work(stem)));
        }
    });
}

/// Builds firmware of those cases that are wanted, runs it, and gives what it printed.
pub(crate) fn run(target: Target, wanted: impl Fn(&Case) -> bool) -> Vec<(&'static Case, String)> {
    let folder = TempDir::new().expect("a temporary folder");
    let cases = SUITE.cases.iter().zip(&PREPARED.stems).filter(|(case, _)| wanted(case));
    let (cases, stems): (Vec<&Case>, Vec<PathBuf>) = cases.map(|(case, stem)| (case, stem.clone())).unzip();
    let copy = |from: &Path| {
        fs::copy(from, folder.path().join(from.file_name().expect("a name"))).expect("a writable folder");
    };
    ["check.c", "programs.h"].iter().for_each(|name| copy(&root().join("tests/softcore").join(name)));
    for stem in &stems {
        copy(&stem.with_extension("h"));
        if target.object.is_empty() {
            copy(&stem.with_extension("c"));
        }
    }
    if !target.object.is_empty() {
        in_parallel(&stems, |stem| {
            let object = folder.path().join(stem.file_name().expect("a name")).with_extension("o");
            build(stem, &object, target.object);
        });
    }
    let names: Vec<String> =
        stems.iter().map(|stem| stem.file_name().expect("a name").to_string_lossy().into_owned()).collect();
    fs::write(folder.path().join("sizes.h"), sizes(&cases)).expect("a writable folder");
    fs::write(folder.path().join("programs.c"), tables(&cases, &names)).expect("a writable folder");
    let parts = ["programs"].into_iter().chain(names.iter().map(String::as_str));
    let parts: Vec<String> = parts.map(|name| folder.path().join(name).display().to_string() + ".o").collect();
    let parts = format!("PARTS={}", parts.join(" "));
    // Random programs compare what is always true, and compilers say so: no fault of theirs, and none of the C.
    let printed = target.make(folder.path(), ["OPT=-O1", "WARNINGS=-Wall", &parts, "run-check"]);
    // Two firmware builds of a hundred programs each take room.
    drop(folder);
    let mut runs = printed.split('=').skip(1).map(|run| run.split_once('\n').unwrap_or_default().1.to_owned());
    cases.into_iter().map(|case| (case, runs.next().unwrap_or_default())).collect()
}

fn sizes(cases: &[&Case]) -> String {
    let largest = cases.iter().map(|case| case.layout.size()).max().unwrap_or_default();
    format!("#define LARGEST_IMAGE {largest}\n")
}

/// The tables of `programs.h`.
fn tables(cases: &[&Case], names: &[String]) -> String {
    let mut c = String::from("#include \"programs.h\"\n");
    for name in names {
        let _ = writeln!(c, "#include \"{name}.h\"");
    }
    for (case, name) in cases.iter().zip(names) {
        let _ = writeln!(c, "static const place_t {name}_places[] = {{");
        for place in places(&case.layout) {
            let _ = writeln!(c, "{{{}u, {}u}},", place.offset, place.size);
        }
        let _ = writeln!(c, "}};\nstatic const change_t {name}_changes[] = {{");
        for change in case.moments.iter().flat_map(|moment| &moment.changes) {
            let _ = writeln!(c, "{{{}u, {}u, {}ull}},", change.offset, change.size, change.bits);
        }
        // C has no arrays without elements.
        let _ = writeln!(c, "{{0u, 1u, 0ull}}}};\nstatic const moment_t {name}_moments[] = {{");
        for moment in &case.moments {
            let _ = writeln!(c, "{{{}ll, {}u}},", moment.now, moment.changes.len());
        }
        c.push_str("};\n");
    }
    c.push_str("const program_t programs[] = {\n");
    for (case, name) in cases.iter().zip(names) {
        let (places, scans) = (places(&case.layout).len(), case.moments.len());
        let _ = writeln!(
            c,
            "{{{name}_init, {name}_scan, &{name}_image, {places}u, {name}_places, {name}_changes, {scans}u, {name}_moments}},"
        );
    }
    let _ = writeln!(c, "}};\nconst uint32_t program_count = {}u;", cases.len());
    c
}
