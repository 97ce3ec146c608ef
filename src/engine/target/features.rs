//! What processors of x86-64 and AArch64 offer beyond the least, by the names that compilers give it.

use target_lexicon::Architecture;

use super::{BadTarget, shown};

/// Names with Cranelift's settings. A name brings those that every processor with it has.
const X86_64: &[(&str, &[&str])] = &[
    ("sse3", &["has_sse3"]),
    ("ssse3", &["has_sse3", "has_ssse3"]),
    ("sse4.1", &["has_sse3", "has_ssse3", "has_sse41"]),
    ("sse4.2", &["has_sse3", "has_ssse3", "has_sse41", "has_sse42"]),
    ("popcnt", &["has_popcnt"]),
    ("lzcnt", &["has_lzcnt"]),
    ("bmi1", &["has_bmi1"]),
    ("bmi2", &["has_bmi2"]),
    ("avx", &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_avx"]),
    ("avx2", &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_avx", "has_avx2"]),
    ("fma", &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_avx", "has_fma"]),
    ("x86-64-v2", &["has_sse3", "has_ssse3", "has_sse41", "has_sse42", "has_popcnt", "has_cmpxchg16b"]),
    (
        "x86-64-v3",
        &[
            "has_sse3",
            "has_ssse3",
            "has_sse41",
            "has_sse42",
            "has_popcnt",
            "has_cmpxchg16b",
            "has_avx",
            "has_avx2",
            "has_fma",
            "has_bmi1",
            "has_bmi2",
            "has_lzcnt",
        ],
    ),
];

const AARCH64: &[(&str, &[&str])] =
    &[("lse", &["has_lse"]), ("fp16", &["has_fp16"]), ("dotprod", &["has_dotprod"]), ("i8mm", &["has_i8mm"])];

/// Cranelift's settings for names that stand between commas, `+` or white space, in either case.
pub(super) fn settings(architecture: Architecture, names: &str) -> Result<Vec<&'static str>, BadTarget> {
    let table = if architecture == Architecture::X86_64 { X86_64 } else { AARCH64 };
    let mut settings = Vec::new();
    for name in names.split([',', '+', ' ']).filter(|name| !name.is_empty()) {
        let Some((_, rows)) = table.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) else {
            let known: Vec<&str> = table.iter().map(|(known, _)| *known).collect();
            return Err(BadTarget::isa(
                format!("`{}` is no feature of {architecture} that code can use", shown(name)),
                format!("`--isa` takes some of {}, with commas between", known.join(", ")),
            ));
        };
        settings.extend_from_slice(rows);
    }
    Ok(settings)
}
