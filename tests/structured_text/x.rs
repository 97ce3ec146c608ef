use rung::frontend;
use rung::source::Source;
#[test]
fn dump() {
    let file = std::env::var("ST").unwrap();
    let text = std::fs::read_to_string(&file).unwrap();
    let source = Source::new(file, text);
    let parsed = frontend::parse(&source);
    println!("{}", rung::diagnostic::render(&source, &parsed.diagnostics));
    println!("{}", frontend::native::print(&parsed.program));
}
