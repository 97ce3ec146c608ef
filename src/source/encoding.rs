//! Encodings other than UTF-8 that program files come in.

/// How far into a file its XML header is looked for, in bytes.
const HEADER: usize = 256;

/// The text of UTF-16 with a byte order mark or of XML that declares Latin-1 (which tools on Windows write), and whether
/// that is all of it; `None` for what has to be UTF-8.
pub(super) fn other(bytes: &[u8]) -> Option<(String, bool)> {
    match bytes {
        [0xFF, 0xFE, rest @ ..] => Some(utf16(rest, u16::from_le_bytes)),
        [0xFE, 0xFF, rest @ ..] => Some(utf16(rest, u16::from_be_bytes)),
        _ if declares_latin1(bytes) => Some((bytes.iter().map(|byte| latin1(*byte)).collect(), true)),
        _ => None,
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> (String, bool) {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut text = String::with_capacity(bytes.len());
    for character in char::decode_utf16(pairs.iter().map(|pair| unit(*pair))) {
        match character {
            Ok(character) => text.push(character),
            Err(_) => return (text, false),
        }
    }
    (text, rest.is_empty())
}

fn declares_latin1(bytes: &[u8]) -> bool {
    let header = &bytes[..bytes.len().min(HEADER)];
    if !header.starts_with(b"<?xml") {
        return false;
    }
    let header = String::from_utf8_lossy(header).to_ascii_lowercase();
    let header = header.split("?>").next().unwrap_or("");
    let declared = header.split_once("encoding").map_or("", |(_, value)| value);
    let declared = declared.trim_start_matches(|c: char| c == '=' || c == '"' || c == '\'' || c.is_whitespace());
    ["iso-8859-1", "iso8859-1", "latin1", "latin-1", "windows-1252", "cp1252"]
        .iter()
        .any(|name| declared.strip_prefix(name).is_some_and(|rest| rest.starts_with(['"', '\''])))
}

/// Windows' code page 1252, which differs from Latin-1 only where that has control characters.
fn latin1(byte: u8) -> char {
    const WINDOWS: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8D}', 'Ž', '\u{8F}', '\u{90}', '‘',
        '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9D}', 'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9F => WINDOWS[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf16_is_read_in_both_orders_up_to_its_first_fault() {
        assert_eq!(other(b"\xFF\xFEa\0\xE9\0"), Some(("aé".to_owned(), true)));
        assert_eq!(other(b"\xFE\xFF\0a\0\xE9"), Some(("aé".to_owned(), true)));
        assert_eq!(other(b"\xFF\xFEa\0b"), Some(("a".to_owned(), false)));
        assert_eq!(other(b"\xFF\xFEa\0\0\xD8b\0"), Some(("a".to_owned(), false)));
    }

    #[test]
    fn latin1_is_read_where_the_header_declares_it() {
        let text = b"<?xml version='1.0' encoding='windows-1252'?><a>\xE9\x80</a>";
        let read = other(text).expect("it is declared");
        assert!(read.1);
        assert!(read.0.ends_with("<a>é€</a>"), "{}", read.0);
        assert_eq!(other(b"<?xml version=\"1.0\" encoding=\"utf-8\"?><a encoding='latin1'/>"), None);
        assert_eq!(other(b"program p encoding=\"latin1\""), None);
    }
}
