//! The diagnostics of one run, of which only so many are kept. It must never lose the fact that there was an error.

use std::borrow::Cow;

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// Errors that one run reports before it only counts the rest; as many warnings beside them.
pub const MOST_REPORTED: usize = 1000;

/// Characters of a name that are repeated in messages.
const LONGEST_NAME: usize = 80;

/// A name for a message that does not stand at that name itself: of one that would fill the screen only the start, since
/// there may be many such messages.
pub(super) fn clipped(name: &str) -> Cow<'_, str> {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => Cow::Owned(format!("{}…", &name[..end])),
        None => Cow::Borrowed(name),
    }
}

/// The diagnostics so far.
#[derive(Default)]
pub(super) struct Report {
    kept: Vec<Diagnostic>,
    errors: Tally,
    warnings: Tally,
}

#[derive(Default)]
struct Tally {
    count: usize,
    first_dropped: Span,
}

impl Tally {
    /// Counts one more, and says whether it is to be kept.
    fn keep(&mut self, span: Span) -> bool {
        self.count += 1;
        if self.count == MOST_REPORTED + 1 {
            self.first_dropped = span;
        }
        self.count <= MOST_REPORTED
    }

    fn overflow(&self, code: Code, what: &str) -> Option<Diagnostic> {
        let dropped = self.count.checked_sub(MOST_REPORTED).filter(|dropped| *dropped > 0)?;
        let message = format!("{dropped} more {what} from here on are not listed");
        Some(Diagnostic::new(code, self.first_dropped, message))
    }
}

impl Report {
    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        let tally = if diagnostic.is_error() { &mut self.errors } else { &mut self.warnings };
        if tally.keep(diagnostic.span) {
            self.kept.push(diagnostic);
        }
    }

    /// Whether there was an error.
    pub(super) fn has_errors(&self) -> bool {
        self.errors.count > 0
    }

    /// Whether the program runs, and what there is to say, in order of place.
    pub(super) fn finish(mut self) -> (bool, Vec<Diagnostic>) {
        self.kept.extend(self.errors.overflow(Code::TooManyDiagnostics, "errors"));
        self.kept.extend(self.warnings.overflow(Code::TooManyWarnings, "warnings"));
        self.kept.sort_by_key(|diagnostic| (diagnostic.span, diagnostic.code.number()));
        (self.errors.count == 0, self.kept)
    }
}
