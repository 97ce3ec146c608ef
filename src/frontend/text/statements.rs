//! Statements of structured text. An error costs its statement, and the list around it goes on.

use thin_vec::ThinVec;

use super::expressions::{Path, Tree};
use super::reader::{Parse, Reader};
use super::token::{Dialect, Keyword, Kind};
use crate::diagnostic::{Code, Diagnostic};
use crate::ladder::{
    Argument, BlockCall, CaseBranch, CaseLabel, ConditionalBranch, Expression, ExpressionKind, FunctionArgument, Name,
    Reference, Statement, StatementKind, UnaryOperator, Wire,
};
use crate::source::Span;

/// What stands between braces.
pub(crate) enum Braces {
    /// An expression by itself.
    Condition(Expression),
    /// One assignment without a semicolon.
    Assignment {
        /// What it writes.
        target: Reference,
        /// The value.
        value: Expression,
    },
    /// Statements, each with its semicolon.
    Statements(Vec<Statement>),
}

/// What can stand where a statement can.
enum Start {
    Statement(StatementKind),
    /// A condition, the first label of a branch of CASE, or a mistake: its surroundings say.
    Expression(Tree),
}

/// What a call gives its function or block.
struct Arguments {
    list: Vec<Argument>,
    height: usize,
}

impl Reader<'_> {
    /// Statements up to something that none of them ends: a closing brace, the next declaration, the end of the text.
    pub(crate) fn statements(&mut self) -> Parse<Vec<Statement>> {
        let mut statements = Vec::new();
        loop {
            self.statements_into(&mut statements);
            if !self.token.kind.ends_part() {
                return Ok(statements);
            }
            let problem = self.unexpected("a statement");
            self.report(problem.hint("nothing is open that this could close"));
            self.advance();
            self.take(Kind::Semicolon);
        }
    }

    /// What stands between braces, up to the closing one. A `;` tells statements from a condition or an assignment.
    pub(crate) fn braces(&mut self) -> Parse<Braces> {
        let start = self.token.span.start;
        if self.token.kind.starts_statement()
            || matches!(self.token.kind, Kind::Semicolon | Kind::Keyword(Keyword::Exit | Keyword::Return))
        {
            return Ok(Braces::Statements(self.statements()?));
        }
        // Only a statement has room for a comment before it, so that what it is has to be known first.
        let first = match self.simple_statement()? {
            Start::Statement(StatementKind::Assignment { target, value }) if self.token.kind != Kind::Semicolon => {
                return Ok(Braces::Assignment { target, value });
            }
            Start::Statement(kind) => Statement { kind, span: self.since(start) },
            Start::Expression(value) if self.token.kind == Kind::Semicolon => {
                return self.no_statement(value.expression.span);
            }
            Start::Expression(value) => return Ok(Braces::Condition(value.expression)),
        };
        self.anchor(start);
        self.semicolon()?;
        let mut statements = vec![first];
        statements.extend(self.statements()?);
        Ok(Braces::Statements(statements))
    }

    /// The statements of a list, as far as they can be read.
    fn list(&mut self) -> Vec<Statement> {
        let mut statements = Vec::new();
        self.statements_into(&mut statements);
        statements
    }

    fn statements_into(&mut self, statements: &mut Vec<Statement>) {
        while !self.token.kind.ends_statements() {
            if self.take(Kind::Semicolon) {
                continue;
            }
            self.attempt(|reader| {
                let start = reader.token.span;
                match reader.statement()? {
                    None => Ok(()),
                    Some(Start::Statement(kind)) => reader.finish(kind, start, statements),
                    Some(Start::Expression(value)) => reader.no_statement(value.expression.span),
                }
            });
        }
    }

    /// Reads a statement, and leaves it out if it has to be given up.
    fn attempt(&mut self, read: impl FnOnce(&mut Self) -> Parse<()>) {
        let (depth, compound) = (self.depth(), self.token.kind.starts_statement());
        if read(self).is_err() {
            self.resume_at(depth);
            self.skip_statement(compound);
        }
    }

    /// Leaves out the rest of a statement, with the statements in it; `compound` if it has an end of its own.
    fn skip_statement(&mut self, compound: bool) {
        let mut open = usize::from(compound);
        loop {
            let kind = self.token.kind;
            if kind.starts_item() || kind == Kind::RightBrace || (open == 0 && kind.ends_part()) {
                return;
            }
            self.advance();
            if kind.starts_statement() {
                open += 1;
            } else if kind.ends_statement() {
                open -= 1;
                if open == 0 {
                    self.take(Kind::Semicolon);
                    return;
                }
            } else if kind == Kind::Semicolon && open == 0 {
                return;
            }
        }
    }

    /// The end of a statement. Those that end with a word of their own need no semicolon.
    fn finish(&mut self, kind: StatementKind, start: Span, statements: &mut Vec<Statement>) -> Parse<()> {
        let closed = matches!(kind, StatementKind::If { .. } | StatementKind::Case { .. } | StatementKind::For { .. });
        statements.push(Statement { kind, span: self.since(start.start) });
        if closed {
            self.take(Kind::Semicolon);
            return Ok(());
        }
        self.semicolon()
    }

    fn semicolon(&mut self) -> Parse<()> {
        if self.take(Kind::Semicolon) {
            return Ok(());
        }
        let problem = self.unexpected("`;`");
        self.give_up(problem.hint("each statement ends with a semicolon"))
    }

    fn no_statement<T>(&mut self, span: Span) -> Parse<T> {
        let problem = Diagnostic::new(Code::UnexpectedToken, span, "a value by itself is no statement");
        self.give_up(
            problem.hint("a statement assigns (x := a;), calls (t1(IN := a);), or is IF, CASE, FOR, EXIT or RETURN"),
        )
    }

    /// A statement without its semicolon; `None` if it is too deep and was skipped.
    fn statement(&mut self) -> Parse<Option<Start>> {
        let first = self.token;
        self.anchor(first.span.start);
        let Kind::Keyword(keyword) = first.kind else { return Ok(Some(self.simple_statement()?)) };
        if !first.kind.starts_statement() {
            return Ok(Some(match keyword {
                Keyword::Exit | Keyword::Return => {
                    self.advance();
                    let leave = keyword == Keyword::Return;
                    Start::Statement(if leave { StatementKind::Return } else { StatementKind::Exit })
                }
                _ => self.simple_statement()?,
            }));
        }
        self.advance();
        if !self.enter_statement(first.span) {
            self.skip_statement(true);
            return Ok(None);
        }
        let kind = match keyword {
            Keyword::If => self.conditional()?,
            Keyword::Case => self.case()?,
            Keyword::For => self.counted_loop()?,
            _ => {
                let word = self.source.slice(first.span).to_ascii_uppercase();
                let message = format!("{word} repeats as often as its condition says, and a scan has no such loop");
                let problem = Diagnostic::new(Code::UnboundedLoop, first.span, message);
                return self.give_up(problem.hint(
                    "FOR repeats a constant number of times; what lasts longer is done a step in each scan, with an IF",
                ));
            }
        };
        self.leave();
        Ok(Some(Start::Statement(kind)))
    }

    /// An assignment, a call, or the first operand of an expression.
    fn simple_statement(&mut self) -> Parse<Start> {
        match self.token.kind {
            Kind::Name | Kind::QuotedName | Kind::Address => {
                let path = self.path("a statement")?;
                self.statement_from(path)
            }
            Kind::Keyword(Keyword::And | Keyword::Or | Keyword::Xor | Keyword::Mod) => {
                let span = self.token.span;
                let function = self.function_word();
                if self.token.kind != Kind::LeftParenthesis {
                    return self.misplaced_operator(span);
                }
                self.call_statement(Reference::of_name(function))
            }
            _ => {
                let value = self.tree()?;
                self.statement_from_value(value)
            }
        }
    }

    /// What an expression starts: an assignment, or nothing more.
    fn statement_from_value(&mut self, value: Tree) -> Parse<Start> {
        if self.token.kind != Kind::Assign {
            return Ok(Start::Expression(value));
        }
        let ExpressionKind::Read(target) = value.expression.kind else {
            let message = "only a variable can be assigned to";
            let problem = Diagnostic::new(Code::UnexpectedToken, value.expression.span, message);
            return self.give_up(problem.hint("to compare, write ="));
        };
        self.advance();
        Ok(Start::Statement(self.assignment(target)?))
    }

    /// The name of a function that is a keyword too.
    fn function_word(&mut self) -> Name {
        let span = self.token.span;
        let name = Name::new(self.source.slice(span), span);
        self.advance();
        name
    }

    fn statement_from(&mut self, path: Path) -> Parse<Start> {
        if self.token.kind == Kind::LeftParenthesis {
            return self.call_statement(path.reference);
        }
        let value = self.tree_from(path.read())?;
        self.statement_from_value(value)
    }

    /// An assignment, behind its `:=`. In structured text a call there can have EN and outputs of its own; then it is a call that
    /// gives OUT to the target, as its first argument, which stands before the call.
    fn assignment(&mut self, target: Reference) -> Parse<StatementKind> {
        use Keyword as K;
        let start = self.token.span;
        let is_function =
            matches!(self.token.kind, Kind::Name | Kind::Keyword(K::And | K::Or | K::Xor | K::Mod | K::Not));
        let behind = self.source.text()[start.range().end..].trim_start();
        let is_call = is_function && behind.starts_with('(') && !behind.starts_with("(*");
        if self.dialect == Dialect::Native || !is_call {
            return Ok(StatementKind::Assignment { target, value: self.expression()? });
        }
        let is_operator = self.token.kind == Kind::Keyword(K::Not);
        let function = self.function_word();
        let arguments = self.arguments()?;
        let is_box = |argument: &Argument| {
            matches!(argument.wire, Wire::Output(_)) || argument.pin.text.eq_ignore_ascii_case("EN")
        };
        if !arguments.list.iter().any(is_box) {
            let first = self.value_of_call(function, is_operator, arguments, start.start);
            return Ok(StatementKind::Assignment { target, value: self.tree_from(first)?.expression });
        }
        if self.token.kind != Kind::Semicolon {
            let problem = self.unexpected("`;`");
            return self.give_up(problem.hint("a call with EN or with outputs beside its result stands by itself"));
        }
        let span = target.span;
        let result = Argument { pin: Name::new("OUT", span), wire: Wire::Output(target), span };
        let arguments = std::iter::once(result).chain(arguments.list).collect();
        let instance = Reference::of_name(function);
        Ok(StatementKind::Call(BlockCall { instance, type_name: None, arguments, power_output: None }))
    }

    /// A call as an operand. NOT(a) is an operator, although it looks like a call; in back quotes it is the function.
    fn value_of_call(&mut self, function: Name, is_operator: bool, arguments: Arguments, start: u32) -> Tree {
        let mut values: ThinVec<FunctionArgument> = arguments.list.into_iter().filter_map(function_argument).collect();
        let kind = match values.pop() {
            Some(FunctionArgument { parameter: None, value }) if values.is_empty() && is_operator => {
                ExpressionKind::Unary(UnaryOperator::Not, Box::new(value))
            }
            last => {
                values.extend(last);
                ExpressionKind::Call { function, arguments: values }
            }
        };
        self.around(arguments.height, kind, start)
    }

    /// A call, from its opening parenthesis on. Where no `;` follows, it may be the first operand of an expression.
    fn call_statement(&mut self, instance: Reference) -> Parse<Start> {
        let start = instance.span.start;
        if self.token.kind != Kind::LeftParenthesis {
            let problem = self.unexpected("`(`");
            return self.give_up(problem);
        }
        let arguments = self.arguments()?;
        let values = arguments.list.iter().all(|argument| matches!(argument.wire, Wire::Value(_)));
        if self.token.kind != Kind::Semicolon
            && values
            && let Some(function) = instance.as_name().cloned()
        {
            let first = self.value_of_call(function, false, arguments, start);
            let value = self.tree_from(first)?;
            return self.statement_from_value(value);
        }
        let call = BlockCall { instance, type_name: None, arguments: arguments.list, power_output: None };
        Ok(Start::Statement(StatementKind::Call(call)))
    }

    fn arguments(&mut self) -> Parse<Arguments> {
        let open = self.token.span;
        let mut arguments = Arguments { list: Vec::new(), height: 0 };
        if !self.enter()? {
            return Ok(arguments);
        }
        let mut is_first = true;
        while is_first || self.take(Kind::Comma) {
            if is_first && self.token.kind == Kind::RightParenthesis {
                break;
            }
            is_first = false;
            let start = self.token.span.start;
            let tree = self.tree()?;
            let named = matches!(self.token.kind, Kind::Assign | Kind::Arrow);
            // CODESYS leaves the names of pins that nothing is wired to.
            if self.dialect == Dialect::StructuredText && named && tree.as_name().is_some() && self.is_left_open() {
                self.advance();
                continue;
            }
            let (pin, wire) = match tree.as_name().cloned() {
                Some(pin) if self.take(Kind::Arrow) => {
                    (pin, Wire::Output(self.reference("the variable that takes the output")?))
                }
                Some(pin) if self.take(Kind::Assign) => {
                    let value = self.tree()?;
                    arguments.height = arguments.height.max(value.height);
                    (pin, Wire::Value(value.expression))
                }
                _ if named => {
                    let message = "the name of a pin stands before `:=` and `=>`";
                    let problem = Diagnostic::new(Code::UnexpectedToken, tree.expression.span, message);
                    return self.give_up(problem);
                }
                _ => {
                    arguments.height = arguments.height.max(tree.height);
                    let place = Span { start, end: start };
                    (Name::new("", place), Wire::Value(tree.expression))
                }
            };
            arguments.list.push(Argument { pin, wire, span: self.since(start) });
        }
        self.close(Kind::RightParenthesis, open, "arguments are parted by commas")?;
        self.leave();
        Ok(arguments)
    }

    /// Whether nothing stands between the `:=` or `=>` here and the end of the argument.
    fn is_left_open(&self) -> bool {
        let behind = self.source.text()[self.token.span.range().end..].trim_start();
        behind.starts_with([',', ')'])
    }

    /// `IF a THEN … ELSIF b THEN … ELSE … END_IF`, behind the IF.
    fn conditional(&mut self) -> Parse<StatementKind> {
        let mut branches = Vec::new();
        let mut otherwise = Vec::new();
        loop {
            let condition = self.expression()?;
            self.word(Keyword::Then, "THEN")?;
            branches.push(ConditionalBranch { condition, body: self.list() });
            if self.take(Kind::Keyword(Keyword::Elsif)) {
                continue;
            }
            if self.take(Kind::Keyword(Keyword::Else)) {
                otherwise = self.list();
            }
            self.end_of(Keyword::EndIf, "END_IF")?;
            return Ok(StatementKind::If { branches, otherwise });
        }
    }

    /// `CASE x OF 1, 3..5: … ELSE … END_CASE`, behind the CASE.
    fn case(&mut self) -> Parse<StatementKind> {
        let selector = self.expression()?;
        self.word(Keyword::Of, "OF")?;
        let mut branches = Vec::new();
        self.anchor_here();
        let mut label = if self.token.kind.ends_statements() { None } else { Some(self.tree()?) };
        while let Some(first) = label {
            let labels = self.labels(first)?;
            let mut body = Vec::new();
            label = self.case_body(&mut body);
            branches.push(CaseBranch { labels, body });
        }
        let otherwise = if self.take(Kind::Keyword(Keyword::Else)) { self.list() } else { Vec::new() };
        self.end_of(Keyword::EndCase, "END_CASE")?;
        Ok(StatementKind::Case { selector, branches, otherwise })
    }

    fn labels(&mut self, first: Tree) -> Parse<Vec<CaseLabel>> {
        let mut labels = Vec::new();
        let mut first = first.expression;
        loop {
            let last = if self.take(Kind::Range) { Some(self.expression()?) } else { None };
            labels.push(CaseLabel { first, last });
            if !self.take(Kind::Comma) {
                break;
            }
            first = self.expression()?;
        }
        if !self.take(Kind::Colon) {
            let problem = self.unexpected("`:`");
            return self.give_up(problem.hint("the labels of a CASE look like this: 1, 3..5:"));
        }
        Ok(labels)
    }

    /// The statements behind a label, and the next label as far as it was read to know it for one.
    fn case_body(&mut self, body: &mut Vec<Statement>) -> Option<Tree> {
        let mut label = None;
        while label.is_none() && !self.token.kind.ends_statements() {
            if self.take(Kind::Semicolon) {
                continue;
            }
            self.attempt(|reader| {
                let start = reader.token.span;
                match reader.statement()? {
                    None => Ok(()),
                    Some(Start::Statement(kind)) => reader.finish(kind, start, body),
                    Some(Start::Expression(value)) => {
                        if !matches!(reader.token.kind, Kind::Colon | Kind::Comma | Kind::Range) {
                            return reader.no_statement(value.expression.span);
                        }
                        label = Some(value);
                        Ok(())
                    }
                }
            });
        }
        label
    }

    /// `FOR i := 0 TO 9 BY 1 DO … END_FOR`, behind the FOR.
    fn counted_loop(&mut self) -> Parse<StatementKind> {
        let variable = self.reference("the variable that counts")?;
        if !self.take(Kind::Assign) {
            let problem = self.unexpected("`:=`");
            return self.give_up(problem.hint("a loop looks like this: FOR i := 0 TO 9 DO … END_FOR;"));
        }
        let first = self.expression()?;
        self.word(Keyword::To, "TO")?;
        let last = self.expression()?;
        let step = if self.take(Kind::Keyword(Keyword::By)) { Some(self.expression()?) } else { None };
        self.word(Keyword::Do, "DO")?;
        let body = self.list();
        self.end_of(Keyword::EndFor, "END_FOR")?;
        Ok(StatementKind::For { variable, first, last, step, body })
    }

    fn word(&mut self, keyword: Keyword, spelling: &str) -> Parse<()> {
        if self.take(Kind::Keyword(keyword)) {
            return Ok(());
        }
        let problem = self.unexpected(&format!("`{spelling}`"));
        self.give_up(problem)
    }

    fn end_of(&mut self, keyword: Keyword, spelling: &str) -> Parse<()> {
        self.anchor_here();
        self.word(keyword, spelling)
    }
}

fn function_argument(argument: Argument) -> Option<FunctionArgument> {
    let Wire::Value(value) = argument.wire else { return None };
    let parameter = if argument.pin.text.is_empty() { None } else { Some(argument.pin) };
    Some(FunctionArgument { parameter, value })
}
