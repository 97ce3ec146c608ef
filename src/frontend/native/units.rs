//! Headers of units, and what stands before the units: types, registers, globals, tasks.

use super::parser::{Parser, Place};
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::text::token::{Keyword, Kind};
use crate::frontend::text::{Parse, literals};
use crate::ladder::{
    Expression, ExpressionKind, Literal, Name, Origin, ProgramInstance, Registers, Setting, Task, Unit, UnitKind,
    VariableClass,
};
use crate::source::Span;

impl Parser<'_> {
    /// `type colour : (red, green)`
    pub(super) fn type_item(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.come_to(Place::Types, start);
        self.advance();
        let declaration = self.type_declaration()?;
        self.item_end("another declaration or a rung")?;
        self.program.types.push(declaration);
        Ok(())
    }

    /// `imported`: what follows came from another tool, and what that accepts is at most a warning.
    pub(super) fn imported(&mut self) -> Parse<()> {
        let start = self.token.span;
        if self.program.origin == Origin::Imported {
            return self.give_up(Diagnostic::new(Code::DuplicateClause, start, "this was said before"));
        }
        self.come_to(Place::Origin, start);
        self.anchor(start.start);
        self.advance();
        self.item_end("a declaration or a rung")?;
        self.program.origin = Origin::Imported;
        Ok(())
    }

    /// `registers(hreg := 64)`
    pub(super) fn registers(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.come_to(Place::Registers, start);
        self.anchor(start.start);
        self.advance();
        let settings = self.settings("a size, such as hreg := 64")?;
        self.item_end("another declaration or a rung")?;
        if let Some(first) = &self.program.registers {
            let problem = Diagnostic::new(Code::DuplicateClause, start, "the sizes of registers were given before");
            let problem = problem.related(first.span, "here");
            return self.give_up(problem);
        }
        self.program.registers = Some(Registers { settings, span: self.since(start.start) });
        Ok(())
    }

    /// `global total : DINT`, `global const limit : INT := 90`
    pub(super) fn global(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.come_to(Place::Globals, start);
        self.advance();
        let constant = self.take(Kind::Keyword(Keyword::Const));
        let class = if constant { VariableClass::Constant } else { VariableClass::Memory };
        let variables = self.variables(class, start)?;
        self.program.globals.extend(variables);
        Ok(())
    }

    /// `task fast(interval := 10ms, priority := 1)`
    pub(super) fn task(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.come_to(Place::Tasks, start);
        self.advance();
        self.anchor_here();
        let name = self.name("the name of a task")?;
        let mut task = Task { name, interval: None, priority: None, span: start };
        if self.token.kind == Kind::LeftParenthesis {
            for Setting { name, value } in self.settings("`interval := 10ms` or `priority := 1`")? {
                let place = match name.key().as_str() {
                    "interval" => &mut task.interval,
                    "priority" => &mut task.priority,
                    _ => {
                        let message = format!("a task has no `{}`", name.text);
                        let problem = Diagnostic::new(Code::UnexpectedToken, name.span, message);
                        self.report(problem.hint("a task has an interval and a priority"));
                        continue;
                    }
                };
                if place.replace(value).is_some() {
                    let message = format!("`{}` was given before", name.text);
                    self.report(Diagnostic::new(Code::DuplicateClause, name.span, message));
                }
            }
        }
        self.item_end("another declaration or a rung")?;
        task.span = self.since(start.start);
        self.program.tasks.push(task);
        Ok(())
    }

    /// `(name := value, …)`
    fn settings(&mut self, expected: &str) -> Parse<Vec<Setting>> {
        let open = self.token.span;
        if self.token.kind != Kind::LeftParenthesis {
            let problem = self.unexpected("`(`");
            return self.give_up(problem);
        }
        self.advance();
        let mut settings = Vec::new();
        while settings.is_empty() || self.take(Kind::Comma) {
            if settings.is_empty() && self.token.kind == Kind::RightParenthesis {
                break;
            }
            let name = self.name(expected)?;
            if !self.take(Kind::Assign) {
                let problem = self.unexpected("`:=`");
                return self.give_up(problem);
            }
            let value = self.setting()?;
            settings.push(Setting { name, value });
        }
        self.close(Kind::RightParenthesis, open, "settings are parted by commas")?;
        Ok(settings)
    }

    /// A value; a duration needs no `T#` here.
    fn setting(&mut self) -> Parse<Expression> {
        let span = self.token.span;
        match literals::duration(self.source.slice(span)) {
            Ok(time) if self.token.kind == Kind::Literal => {
                self.advance();
                Ok(Expression { kind: ExpressionKind::Literal(Literal::Time(time)), span })
            }
            _ => self.expression(),
        }
    }

    /// `program control with fast`, `program pump1 : pump with fast`
    pub(super) fn program_line(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.advance();
        let at = self.token.span.start;
        let name = self.name("the program's name")?;
        self.anchor(at);
        let program = if self.take(Kind::Colon) { Some(self.name("the name of a program")?) } else { None };
        let task = if self.at_word("with") {
            self.advance();
            Some(self.name("the name of a task")?)
        } else {
            None
        };
        let Some(program) = program else {
            return self.start_unit(UnitKind::Program { task }, name, start);
        };
        self.come_to(Place::Instances, start);
        let expected = "`with` and a task, another instance, or the end: an instance has the declarations and rungs of its program";
        self.item_end(expected)?;
        let span = self.since(start.start);
        self.program.instances.push(ProgramInstance { name, program, task, span });
        Ok(())
    }

    /// `function_block latch`
    pub(super) fn function_block_line(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.advance();
        let at = self.token.span.start;
        let name = self.name("the function block's name")?;
        self.anchor(at);
        self.start_unit(UnitKind::FunctionBlock, name, start)
    }

    /// `function scale : REAL`
    pub(super) fn function_line(&mut self) -> Parse<()> {
        let start = self.token.span;
        self.advance();
        let at = self.token.span.start;
        let name = self.name("the function's name")?;
        self.anchor(at);
        let result = if self.take(Kind::Colon) { Some(self.type_reference()?) } else { None };
        self.start_unit(UnitKind::Function { result }, name, start)
    }

    fn start_unit(&mut self, kind: UnitKind, name: Name, start: Span) -> Parse<()> {
        if let [first] = self.program.units.as_slice()
            && first.name.span == Span::default()
        {
            let message = "what stands before this belongs to a program without a name";
            let problem = Diagnostic::new(Code::UnexpectedToken, start, message);
            self.report(problem.hint("where there are several units, each starts with its name: program main"));
        }
        self.come_to(Place::Units, start);
        let span = self.since(start.start);
        self.program.units.push(Unit { kind, name, variables: Vec::new(), rungs: Vec::new(), span });
        self.item_end("a declaration or a rung")
    }
}
