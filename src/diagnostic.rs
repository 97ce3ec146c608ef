//! Diagnostics: what went wrong, where, under which code, and what to do about it.
//!
//! One type for every stage and one place that renders it. A diagnostic must never be made without a code:
//! the codes are stable, and the manual lists them from this table.

mod excerpt;

use std::fmt;
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, LabelStyle, Severity as ReportSeverity};
use codespan_reporting::term::{self, Config};

use excerpt::{CONTEXT, Excerpt, tidy};

use crate::source::{Source, Span};

/// How much a diagnostic weighs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Severity {
    /// The program runs, but probably not as was meant.
    Warning,
    /// The program does not run.
    Error,
}

macro_rules! codes {
    ($($variant:ident = $number:literal $severity:ident $title:literal,)*) => {
        /// The kind of a diagnostic. Numbers are stable: a retired one is never used again.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum Code {
            $(#[doc = $title] $variant,)*
        }

        impl Code {
            /// Every code, in the order of the numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// The number behind the letter.
            pub const fn number(self) -> u16 {
                match self { $(Self::$variant => $number,)* }
            }

            /// Whether a program with it still runs.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity,)* }
            }

            /// The kind in a few words, without the particulars.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)* }
            }
        }
    };
}

codes! {
    // Files and text.
    NotText = 101 Error "the file is not text",
    FileTooLarge = 102 Error "the file is too large",
    CannotRead = 103 Error "the file cannot be read",
    CannotWrite = 104 Error "the file cannot be written",
    UnknownFormat = 105 Error "the format of the file is not known",
    BadOptions = 106 Error "options that do not go together",
    UnknownTopic = 107 Error "the manual has no such page",
    OtherFormat = 108 Error "a file in another format than the command takes",
    // Syntax.
    UnexpectedToken = 201 Error "something else was expected here",
    UnexpectedCharacter = 202 Error "this character has no meaning here",
    Unclosed = 203 Error "something was opened and not closed",
    TooDeep = 204 Error "nested too deeply",
    BadLiteral = 205 Error "a literal that cannot be read",
    BadAddress = 206 Error "an address that cannot be read",
    DuplicateClause = 207 Error "said twice",
    UnboundedLoop = 208 Error "a loop without a constant number of times",
    NotSupported = 209 Error "something that Rung has not",
    CannotConvert = 210 Error "something that the other format has not",
    BadXml = 221 Error "XML that cannot be read",
    BadElement = 222 Error "an element that lacks what it needs",
    BadJson = 223 Error "JSON that cannot be read",
    // Names.
    UndeclaredName = 301 Error "a name that is not declared",
    DuplicateName = 302 Error "a name that is declared twice",
    UnusedName = 303 Warning "a name that nothing uses",
    UnknownType = 304 Error "a type that is not known",
    UnknownPin = 305 Error "a pin that the block has not",
    UnknownMember = 306 Error "a member that there is not",
    UnknownFunction = 307 Error "a function that is not known",
    RecursiveUnit = 308 Error "a type, block or function that holds or calls itself",
    // Types and values.
    TypeMismatch = 401 Error "a value of another type was expected",
    OutOfRange = 402 Error "a value outside the range of its type",
    NotConstant = 403 Error "a constant was expected",
    NotWritable = 404 Error "this cannot be written",
    CoilOnInput = 405 Error "a coil writes an input",
    OverwrittenInput = 406 Warning "a coil writes an input, which the next copy-in overwrites",
    DivisionByZero = 407 Warning "a division by the constant zero",
    WrongArguments = 408 Error "arguments that a function does not take",
    // Structure.
    DoubleCoil = 501 Warning "two coils write the same variable",
    NeverConducts = 502 Warning "a rung that can never conduct",
    AddressConflict = 503 Error "two addresses overlap",
    DuplicatePin = 504 Error "a pin that is wired twice",
    NodeMisuse = 505 Error "a node that is not fed before it is used",
    PowerNotTaken = 506 Error "a block that cannot take or give power",
    RepeatedBlock = 507 Warning "a block instance that is called more than once",
    EmptyRung = 508 Warning "a rung with nothing to do",
    RetainedInput = 509 Error "an input cannot be retained",
    BackwardJump = 510 Error "a jump to its own rung or an earlier one",
    MisplacedJump = 511 Error "a jump where none can stand",
    NoMemoryHere = 512 Error "something that remembers, in a function",
    BadResource = 513 Error "a task, program instance or resource that cannot be",
    MisplacedDeclaration = 514 Error "a declaration that cannot stand here",
    SeparateAddresses = 515 Warning "addresses that overlap only in number",
    LeftOut = 516 Warning "something that Rung has not is left out",
    DanglingConnection = 521 Error "a wire from an element that there is not",
    DuplicateId = 522 Error "two elements of one id",
    PowerCycle = 523 Error "power that runs in a circle",
    NotConnected = 524 Error "an element that no wire reaches",
    NeverRuns = 525 Warning "a program that no task runs",
    OpenAddress = 526 Warning "an address that the file leaves open",
    ScanCount = 527 Warning "a duration that is given as a number of scans",
    // Limits.
    TooManyDiagnostics = 601 Error "too many diagnostics",
    ImageTooLarge = 602 Error "the process image is too large",
    TooManyWarnings = 603 Warning "too many warnings",
    TooManyElements = 604 Error "arrays with too many elements",
    TooLargeInlined = 605 Error "too much is called within calls",
    // Stimuli, maps and replays.
    BadStimuli = 701 Error "stimuli that cannot be used",
    BadMap = 702 Error "a map that cannot be used",
    BadReplay = 703 Error "a replay that cannot be used",
    // Logic text.
    BadLogic = 801 Error "logic that cannot be used",
    // Engines.
    CannotCompile = 901 Error "the program cannot be compiled",
    EnginesDiffer = 902 Error "two engines compute different values",
    UnknownTarget = 903 Error "a target that is not known",
    BadIsa = 904 Error "an instruction set or ABI that cannot be",
    NeedsFpu = 905 Error "reals on a target without floating point",
    BadSymbol = 906 Error "a prefix that is no identifier of C",
    TooLargeForTarget = 907 Error "the program is too large for the target",
    NotACName = 911 Error "a name that C cannot have",
    // Lanes and assertions.
    BadAssertion = 920 Error "an assertion that cannot be used",
    AssertionFails = 921 Error "an assertion does not hold",
    CannotBatch = 922 Error "so many plants cannot be run",
    // Measuring.
    CompilerFails = 940 Error "a C compiler did not do as expected",
    // Running.
    BadTiming = 1001 Error "times that do not go together",
    CannotStart = 1002 Error "the program cannot be started",
    Stopped = 1003 Error "the program was stopped",
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "R{:04}", self.number())
    }
}

/// One finding about one source.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Its kind.
    pub code: Code,
    /// Where it is.
    pub span: Span,
    /// The particulars, one line.
    pub message: String,
    /// Other places that belong to it, each with what it has to do with it.
    pub related: Vec<(Span, String)>,
    /// What to do about it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// A finding without related places or a hint.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self { code, span, message: message.into(), related: Vec::new(), hint: None }
    }

    /// Adds another place that belongs to it.
    #[must_use]
    pub fn related(mut self, span: Span, note: impl Into<String>) -> Self {
        self.related.push((span, note.into()));
        self
    }

    /// Says what to do about it.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Whether it keeps the program from running.
    pub fn is_error(&self) -> bool {
        self.code.severity() == Severity::Error
    }
}

/// Whether any of them keeps the program from running.
pub fn any_error(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}

/// Diagnostics that one rendering prints before it only counts the rest.
const MOST_RENDERED: usize = 100;

/// Renders diagnostics about one source as text, in order of place, each with its source line, a caret and the hint.
/// After a hundred it prints how many more there are.
pub fn render(source: &Source, diagnostics: &[Diagnostic]) -> String {
    let mut ordered: Vec<&Diagnostic> = diagnostics.iter().collect();
    ordered.sort_by_key(|diagnostic| (diagnostic.span, diagnostic.code.number()));
    let config =
        Config { tab_width: 4, start_context_lines: CONTEXT.0, end_context_lines: CONTEXT.1, ..Config::default() };
    let mut text = String::new();
    for diagnostic in ordered.iter().take(MOST_RENDERED) {
        let places: Vec<Range<usize>> = std::iter::once(&diagnostic.span)
            .chain(diagnostic.related.iter().map(|(span, _)| span))
            .map(|span| within(source, *span))
            .collect();
        let excerpt = Excerpt::new(source, &places);
        let file = |place: &Range<usize>| source.file_at(Span::new(place.start, place.end).start);
        let report = report(diagnostic, places.iter().map(|place| (file(place), excerpt.place(place))));
        if term::emit_to_string(&mut text, &config, &excerpt, &report).is_err() {
            // A place outside the source: the finding still counts, so it is printed without its line.
            text.push_str(&format!("{}: {}\n", diagnostic.code, tidy(&diagnostic.message)));
        }
    }
    if ordered.len() > MOST_RENDERED {
        text.push_str(&format!("… and {} more\n", ordered.len() - MOST_RENDERED));
    }
    text
}

/// The bytes of a span. It may end up past the text when an input was cut short; rendering needs it inside.
fn within(source: &Source, span: Span) -> Range<usize> {
    let end = span.range().end.min(source.text().len());
    span.range().start.min(end)..end
}

/// The report of a diagnostic; `places`, each in a file, are those of its span and of its related spans, in that order.
fn report(diagnostic: &Diagnostic, mut places: impl Iterator<Item = (usize, Range<usize>)>) -> Report<usize> {
    let severity = match diagnostic.code.severity() {
        Severity::Warning => ReportSeverity::Warning,
        Severity::Error => ReportSeverity::Error,
    };
    let primary = places.next().map(|(file, place)| Label::new(LabelStyle::Primary, file, place));
    let related = places
        .zip(&diagnostic.related)
        .map(|((file, place), (_, note))| Label::new(LabelStyle::Secondary, file, place).with_message(tidy(note)));
    Report::new(severity)
        .with_code(diagnostic.code.to_string())
        .with_message(tidy(&diagnostic.message))
        .with_labels_iter(primary.into_iter().chain(related))
        .with_notes(diagnostic.hint.iter().map(|hint| format!("hint: {}", tidy(hint))).collect())
}

#[cfg(test)]
mod tests;
