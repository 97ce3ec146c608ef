//! Which targets there are, and why others are none.

use super::riscv::{FloatAbi, Processor};
use super::*;

fn code(triple: &str, isa: Option<&str>, abi: Option<&str>) -> Code {
    let refused = Target::new(triple, isa, abi).expect_err(triple);
    assert!(!refused.message.contains(['\n', '\0']) && !refused.hint.is_empty(), "{refused:?}");
    refused.code
}

#[test]
fn isa_strings_are_read_in_either_case_and_in_any_order() {
    let settings = |text: &str| {
        let mut settings: Vec<&str> = Processor::parse(text).expect(text).settings().collect();
        settings.sort_unstable();
        settings
    };
    assert_eq!(settings("rv64imac"), ["has_zca"]);
    assert_eq!(settings("rv64im"), [""; 0]);
    assert_eq!(settings("rv64gc"), ["has_zca", "has_zcd"]);
    let all = ["has_zba", "has_zbb", "has_zbs", "has_zca", "has_zicond"];
    assert_eq!(settings("RV64IMAC_Zba_Zbb_Zbs_Zicond"), all);
    assert_eq!(settings("rv64imac_zicond_zbs_zba_zbb"), all);
    assert_eq!(settings("rv64imacb_zicond"), all);
    assert_eq!(settings("rv64icam_zba"), ["has_zba", "has_zca"]);
    assert_eq!(settings("rv64imaczba_xthead_sstc"), ["has_zba", "has_zca"]);
}

#[test]
fn what_is_no_isa_string_is_refused() {
    for text in [
        "",
        "rv64",
        "rv32imac",
        "rv64e",
        "rv64imac_",
        "rv64imacc",
        "rv64imac_zbx",
        "rv64imw",
        "rv64i2p1m2p0",
        "rv64iac",
        "imac",
        "rv64gc_ä",
        "rv64im\0",
        "rv128i",
        "rv64cmi",
    ] {
        let refused = Processor::parse(text).expect_err(text);
        assert_eq!(refused.code, Code::BadIsa, "{text}");
        assert!(!refused.message.contains('\0') && !refused.hint.is_empty());
    }
}

#[test]
fn the_abi_is_what_the_registers_allow_and_marks_the_object() {
    let flags = |isa: &str, abi: Option<&str>| {
        let processor = Processor::parse(isa).expect(isa);
        processor.abi(abi).map(|abi| processor.elf_flags(abi)).map_err(|refused| refused.code)
    };
    assert_eq!(flags("rv64imac", None), Ok(1));
    assert_eq!(flags("rv64im", Some("lp64")), Ok(0));
    assert_eq!(flags("rv64gc", None), Ok(5));
    assert_eq!(flags("rv64gc", Some("LP64")), Ok(1));
    assert_eq!(flags("rv64imafc", None), Ok(3));
    for (isa, abi) in
        [("rv64imac", "lp64d"), ("rv64imafc", "lp64d"), ("rv64imac", "lp64f"), ("rv64gc", "ilp32"), ("rv64gc", "")]
    {
        assert_eq!(flags(isa, Some(abi)), Err(Code::BadIsa), "{isa} {abi}");
    }
    assert_eq!(FloatAbi::Double.to_string(), "lp64d");
}

#[test]
fn what_is_no_triple_of_a_64_bit_target_is_refused() {
    for triple in
        ["", "z80", "riscv32imac-unknown-none-elf", "thumbv7m-none-eabi", "x86_64-apple-\0", "aarch64_be-none-elf"]
    {
        assert_eq!(code(triple, None, None), Code::UnknownTarget, "{triple}");
    }
    let refused = Target::new("thumbv7m-none-eabi", None, None).expect_err("a 32-bit target");
    assert!(refused.hint.contains("--emit c"), "{refused:?}");
    assert_eq!(code("wasm32-unknown-unknown", None, None), Code::UnknownTarget);
    assert_eq!(code("s390x-unknown-linux-gnu", None, None), Code::UnknownTarget);
}

#[test]
#[cfg(feature = "all-targets")]
fn targets_offer_what_was_asked_for_and_nothing_else() {
    let enabled = |triple: &str, isa: Option<&str>| {
        let target = Target::new(triple, isa, None).unwrap_or_else(|refused| panic!("{refused:?}"));
        let flags = target.isa().isa_flags();
        let is_on = |flag: &cranelift_codegen::settings::Value| flag.as_bool() == Some(true);
        let mut on: Vec<&str> = flags.iter().filter(|flag| is_on(flag)).map(|flag| flag.name).collect();
        // What Cranelift insists on.
        on.retain(|name| !["has_m", "has_a", "has_f", "has_d", "has_zicsr", "has_zifencei"].contains(name));
        on
    };
    assert_eq!(enabled("x86_64-unknown-linux-gnu", None), [""; 0]);
    assert_eq!(enabled("x86_64-unknown-linux-gnu", Some("bmi1,BMI2")), ["has_bmi1", "has_bmi2"]);
    assert_eq!(enabled("aarch64-apple-darwin", None), [""; 0]);
    assert_eq!(enabled("aarch64-unknown-none", Some("lse")), ["has_lse"]);
    assert_eq!(enabled("riscv64imac-unknown-none-elf", None), ["has_zca"]);
    assert_eq!(enabled("riscv64-unknown-elf", None), ["has_zca", "has_zcd"]);
    assert_eq!(enabled("riscv64", Some("rv64im")), [""; 0]);
    assert_eq!(enabled("x86_64-pc-windows-msvc", None), [""; 0]);
}

#[test]
#[cfg(feature = "all-targets")]
fn features_and_abis_that_a_target_has_not_are_refused() {
    assert_eq!(code("x86_64-unknown-linux-gnu", Some("rv64gc"), None), Code::BadIsa);
    assert_eq!(code("x86_64-unknown-linux-gnu", None, Some("lp64d")), Code::BadIsa);
    assert_eq!(code("aarch64-unknown-linux-gnu", Some("avx2"), None), Code::BadIsa);
    assert_eq!(code("riscv64-unknown-elf", Some("zba"), None), Code::BadIsa);
    assert_eq!(code("riscv64-unknown-elf", Some("rv64imac"), Some("lp64d")), Code::BadIsa);
    assert_eq!(code("riscv64-apple-darwin", None, None), Code::UnknownTarget);
}

#[test]
#[cfg(not(feature = "all-targets"))]
fn without_the_feature_other_machines_are_refused_and_the_feature_named() {
    let other = if cfg!(target_arch = "x86_64") { "aarch64-unknown-linux-gnu" } else { "x86_64-unknown-linux-gnu" };
    let refused = Target::new(other, None, None).expect_err("no back end");
    assert_eq!(refused.code, Code::UnknownTarget);
    assert!(refused.hint.contains("all-targets"), "{refused:?}");
}
