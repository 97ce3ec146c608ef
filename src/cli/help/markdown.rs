//! Markdown for the terminal: headings underlined, tables in columns, code as it stands, pictures named.
//!
//! It knows the little Markdown that the manual is written in, and must never refuse any.

use unicode_width::UnicodeWidthStr;

/// Renders a page.
pub(super) fn render(page: &str) -> String {
    let mut text = String::new();
    let mut lines = page.lines().peekable();
    let mut is_code = false;
    while let Some(line) = lines.next() {
        if line.starts_with("```") {
            is_code = !is_code;
        } else if is_code {
            push(&mut text, &format!("  {line}"));
        } else if line.starts_with("<!--") {
            // A mark for whatever keeps the page up to date.
        } else if line.starts_with('|') {
            let mut rows = vec![cells(line)];
            while let Some(row) = lines.next_if(|line| line.starts_with('|')) {
                rows.push(cells(row));
            }
            table(&mut text, &rows);
        } else if let Some(heading) = line.strip_prefix("# ") {
            underlined(&mut text, heading, "═");
        } else if let Some(heading) = line.strip_prefix("## ") {
            underlined(&mut text, heading, "─");
        } else {
            push(&mut text, &inline(line));
        }
    }
    text
}

/// Adds a line without blanks at its end; of empty lines in a row only the first.
fn push(text: &mut String, line: &str) {
    let line = line.trim_end();
    if !(line.is_empty() && (text.is_empty() || text.ends_with("\n\n"))) {
        text.push_str(line);
        text.push('\n');
    }
}

fn underlined(text: &mut String, heading: &str, stroke: &str) {
    let heading = inline(heading);
    push(text, &heading);
    push(text, &stroke.repeat(heading.width()));
}

/// The cells of a table's row; `\|` is a stroke inside one.
fn cells(row: &str) -> Vec<String> {
    let row = row.trim().trim_start_matches('|').replace("\\|", "\0");
    let row = row.strip_suffix('|').unwrap_or(&row);
    row.split('|').map(|cell| inline(&cell.replace('\0', "|")).trim().to_owned()).collect()
}

fn table(text: &mut String, rows: &[Vec<String>]) {
    let is_rule = |row: &[String]| row.iter().all(|cell| cell.starts_with('-') && cell.trim_matches('-').is_empty());
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widest = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.width()).max();
    let widths: Vec<usize> = (0..columns).map(|column| widest(column).unwrap_or(0)).collect();
    for row in rows.iter().filter(|row| row.iter().any(|cell| !cell.is_empty())) {
        let mut line = String::from(" ");
        for (cell, &width) in row.iter().zip(&widths) {
            let shown = if is_rule(row) { "─".repeat(width) } else { cell.clone() };
            let padding = width.saturating_sub(shown.width());
            line.push_str(&format!(" {shown}{} ", " ".repeat(padding)));
        }
        push(text, &line);
    }
}

/// A line of prose: links as their text, pictures as a note of where they are, and no signs of emphasis.
fn inline(line: &str) -> String {
    let mut shown = String::new();
    let mut rest = line;
    while let Some((before, label, target, after)) = next_link(rest) {
        match before.strip_suffix('!') {
            Some(before) => shown.push_str(&format!("{before}[{label}: the picture docs/elements/{target}]")),
            None => shown.push_str(&format!("{before}{label}")),
        }
        rest = after;
    }
    shown.push_str(rest);
    shown.replace("**", "")
}

/// The first `[label](target)` of a line, with what stands before and after.
fn next_link(line: &str) -> Option<(&str, &str, &str, &str)> {
    let middle = line.find("](")?;
    let (before, label) = line[..middle].rsplit_once('[')?;
    let (target, after) = line[middle + 2..].split_once(')')?;
    Some((before, label, target, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_becomes_plain_text() {
        let page = "# Title\n\nSee [the **other**](x.md) page, `a` and [b | c].\n\n<!-- mark -->\n```text\n# as it | stands\n```\n\
                    <!-- end -->\n\n## Part\n\n| pin | |\n|---|---|\n| IN | `[ a \\| b ]` |\n\n![Diagram](src/x.svg)\n";
        let text = "Title\n═════\n\nSee the other page, `a` and [b | c].\n\n  # as it | stands\n\n\
                    Part\n────\n\n  pin\n  ───  ───────────\n  IN   `[ a | b ]`\n\n\
                    [Diagram: the picture docs/elements/src/x.svg]\n";
        assert_eq!(render(page), text);
    }

    #[test]
    fn broken_markdown_is_shown_as_it_stands() {
        for page in ["](", "[a](", "| a", "|", "```", "![]()", "]( [x](y", "# ", "|\\"] {
            let _ = render(page);
        }
        assert_eq!(render("a](b"), "a](b\n");
        assert_eq!(render("| a"), "  a\n");
    }
}
