//! The example of a host program, run as it stands.

#[path = "../../examples/embed.rs"]
#[expect(dead_code, reason = "its `main` is for the command line")]
mod example;

/// What the manual prints of it.
fn shown() -> &'static str {
    let page = include_str!("../../docs/embedding.md");
    page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the manual shows a run")
}

#[test]
fn the_host_program_does_what_the_manual_shows() {
    let mut out = Vec::new();
    example::run(&mut out).expect("it runs");
    assert_eq!(String::from_utf8_lossy(&out), shown());
}
