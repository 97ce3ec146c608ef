//! What a source uses and Rung has not: one diagnostic a kind, with how often and the first place. Nothing that a front end
//! leaves out may go unsaid.

use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::key;
use crate::source::Span;

/// How many kinds are told apart. Kinds can hold names of the source, so that there is no natural limit.
const MOST_KINDS: usize = 100;

/// The kinds found so far, in order of their first place.
#[derive(Default, Debug)]
pub(crate) struct Missing {
    kinds: Vec<Kind>,
    /// Uses of kinds past the limit.
    others: usize,
}

#[derive(Debug)]
struct Kind {
    what: String,
    first: Span,
    count: usize,
    hint: Option<&'static str>,
}

impl Missing {
    /// Counts a use of something, such as `the type STRING`.
    pub(crate) fn note(&mut self, what: &str, place: Span) {
        self.note_with_hint(what, place, None);
    }

    /// Counts a use of something that a hint can say more about.
    pub(crate) fn note_with_hint(&mut self, what: &str, place: Span, hint: Option<&'static str>) {
        if let Some(kind) = self.kinds.iter_mut().find(|kind| key(&kind.what) == key(what)) {
            kind.count += 1;
        } else if self.kinds.len() < MOST_KINDS {
            self.kinds.push(Kind { what: what.to_owned(), first: place, count: 1, hint });
        } else {
            self.others += 1;
        }
    }

    /// The diagnostics, one a kind.
    pub(crate) fn into_diagnostics(self) -> impl Iterator<Item = Diagnostic> {
        let last = self.kinds.last().map(|kind| kind.first).unwrap_or_default();
        let others = (self.others > 0).then(|| {
            Diagnostic::new(
                Code::NotSupported,
                last,
                format!("{} more uses of other things are not supported", self.others),
            )
        });
        let kinds = self.kinds.into_iter().map(|kind| {
            let message = match kind.count {
                1 => format!("{} is not supported", kind.what),
                count => format!("{} is not supported: {count} uses, the first here", kind.what),
            };
            let problem = Diagnostic::new(Code::NotSupported, kind.first, message);
            match kind.hint {
                Some(hint) => problem.hint(hint),
                None => problem,
            }
        });
        kinds.chain(others)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_is_one_diagnostic_with_its_count_and_first_place() {
        let mut missing = Missing::default();
        missing.note("the type STRING", Span::new(3, 9));
        missing.note("SFC", Span::new(20, 23));
        missing.note("the type string", Span::new(40, 46));
        let said: Vec<_> = missing.into_diagnostics().map(|found| (found.span.start, found.message)).collect();
        let expected = [
            (3, "the type STRING is not supported: 2 uses, the first here".to_owned()),
            (20, "SFC is not supported".to_owned()),
        ];
        assert_eq!(said, expected);
    }

    #[test]
    fn past_the_limit_kinds_are_only_counted() {
        let mut missing = Missing::default();
        for number in 0..MOST_KINDS + 5 {
            missing.note(&format!("the thing {number}"), Span::new(number, number));
        }
        let last = missing.into_diagnostics().last().map(|found| found.message);
        assert_eq!(last.as_deref(), Some("5 more uses of other things are not supported"));
    }
}
