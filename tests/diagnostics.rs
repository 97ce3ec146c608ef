//! `docs/diagnostics.md` says of every code what the table in `src/diagnostic.rs` says of it, and what to do.

use rung::diagnostic::{Code, Severity};

#[test]
fn the_manual_has_one_row_for_each_code_with_its_severity_and_title() {
    let manual = include_str!("../docs/diagnostics.md");
    let rows: Vec<Vec<&str>> = manual
        .lines()
        .filter(|line| line.starts_with("| R"))
        .map(|line| line.trim_matches('|').splitn(4, '|').map(str::trim).collect())
        .collect();
    let expected: Vec<[String; 3]> = Code::ALL
        .iter()
        .map(|code| {
            let severity = match code.severity() {
                Severity::Warning => "warning",
                Severity::Error => "error",
            };
            [code.to_string(), severity.to_owned(), code.title().to_owned()]
        })
        .collect();
    assert_eq!(rows.iter().map(|row| row[..3].to_vec()).collect::<Vec<_>>(), expected);
    for row in rows {
        assert!(row[3].len() > 20 && row[3].ends_with('.'), "{row:?} says nothing of what to do");
    }
}
