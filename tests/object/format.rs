//! What is in an object file: exactly the named symbols, nothing undefined, and the flags that linkers look at.

use object::{File, FileFlags, Object, ObjectSymbol};
use rung::engine::object as objects;
use rung::engine::target::Target;
use rung::interface::{Interface, Symbol};
use rung::logic::{Op, Program, random};

const TARGETS: [(&str, Option<&str>); 6] = [
    ("x86_64-unknown-linux-gnu", None),
    ("x86_64-apple-darwin", None),
    ("x86_64-pc-windows-msvc", None),
    ("aarch64-unknown-linux-gnu", None),
    ("aarch64-apple-darwin", None),
    ("riscv64-unknown-elf", Some("rv64gc")),
];

/// Programs of every kind, some with helpers.
fn programs() -> impl Iterator<Item = Program> {
    (0..12).map(random::program)
}

fn built(program: &Program, triple: &str, isa: Option<&str>, abi: Option<&str>, prefix: &str) -> Vec<u8> {
    let target = Target::new(triple, isa, abi).unwrap_or_else(|refused| panic!("{refused:?}"));
    let interface = Interface::new(prefix, 1_000_000).expect("an interface");
    objects::build(program, &interface, &target).unwrap_or_else(|error| panic!("{triple}: {error}"))
}

#[test]
#[cfg(feature = "all-targets")]
fn an_object_defines_the_named_symbols_and_needs_none() {
    for (triple, isa) in TARGETS {
        // Mach-O puts `_` before the names of C.
        let mark = if triple.contains("apple") { "_" } else { "" };
        let mut expected: Vec<String> =
            Symbol::ALL.iter().map(|symbol| format!("{mark}plant_{}", symbol.suffix())).collect();
        expected.sort();
        for program in programs() {
            let bytes = built(&program, triple, isa, None, "plant");
            let file = File::parse(&*bytes).expect("an object");
            let undefined: Vec<&str> =
                file.symbols().filter(|symbol| symbol.is_undefined()).filter_map(|symbol| symbol.name().ok()).collect();
            assert_eq!(undefined.iter().filter(|name| !name.is_empty()).count(), 0, "{triple}: {undefined:?}");
            let global = file.symbols().filter(|symbol| symbol.is_global());
            let mut global: Vec<&str> = global.map(|symbol| symbol.name().expect("a name")).collect();
            global.sort_unstable();
            assert_eq!(global, expected, "{triple}");
        }
    }
}

#[test]
fn the_same_program_gives_the_same_bytes() {
    let triple = Target::host_triple();
    for program in programs() {
        let [first, second] = [0, 1].map(|_| built(&program, &triple, None, None, "p"));
        assert_eq!(first, second, "{}", program.name);
    }
}

#[test]
#[cfg(feature = "all-targets")]
fn riscv_objects_are_marked_with_their_abi() {
    let plain =
        |program: &Program| !program.instructions.iter().any(|i| i.ty.is_real() || matches!(i.op, Op::Call(..)));
    let program = (0..500).map(random::program).find(plain).expect("a program without reals");
    let flags = |isa, abi| {
        let bytes = built(&program, "riscv64-unknown-elf", Some(isa), abi, "p");
        match File::parse(&*bytes).expect("an object").flags() {
            FileFlags::Elf { e_flags, .. } => e_flags,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(flags("rv64imac", None), 0x1);
    assert_eq!(flags("rv64im", None), 0x0);
    assert_eq!(flags("rv64gc", None), 0x5);
    assert_eq!(flags("rv64gc", Some("lp64")), 0x1);
    assert_eq!(flags("rv64imafc", None), 0x3);
}
