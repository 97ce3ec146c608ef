//! `CONFIGURATION … END_CONFIGURATION`: resources, tasks and the programs that run in them. All resources run as one controller.

use super::parser::Parser;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::events::Event;
use crate::frontend::text::token::{Keyword, Kind};
use crate::frontend::text::{GivenUp, Parse};
use crate::ladder::{ProgramInstance, Task};

impl Parser<'_> {
    /// From the word CONFIGURATION to END_CONFIGURATION.
    pub(super) fn configuration(&mut self) -> Parse<()> {
        let open = self.token.span;
        self.advance();
        self.name("the name of the configuration")?;
        self.configured = true;
        self.parts(false);
        self.end_of_block(Keyword::EndConfiguration, "END_CONFIGURATION", open)
    }

    /// What stands in a configuration or, within it, in a resource.
    fn parts(&mut self, in_resource: bool) {
        loop {
            self.start_item();
            let start = self.token.span;
            let kind = self.token.kind;
            let part = match kind {
                Kind::Keyword(Keyword::VarGlobal) => {
                    self.variable_block().map(|globals| self.program.globals.extend(globals))
                }
                Kind::Keyword(Keyword::Task) => self.task(),
                Kind::Keyword(Keyword::Program) => self.instance(),
                Kind::Keyword(Keyword::Resource) if !in_resource => self.resource(),
                Kind::Semicolon => {
                    self.advance();
                    Ok(())
                }
                kind if kind.starts_item() => return,
                _ if self.skip_unsupported() => Ok(()),
                _ => {
                    let expected =
                        if in_resource { "TASK, PROGRAM or END_RESOURCE" } else { "RESOURCE or END_CONFIGURATION" };
                    let problem = self.unexpected(expected);
                    self.give_up(problem)
                }
            };
            if part.is_err() {
                if self.token.span == start {
                    self.advance();
                }
                self.skip_declaration();
            }
        }
    }

    /// `RESOURCE name ON kind … END_RESOURCE`
    fn resource(&mut self) -> Parse<()> {
        let open = self.token.span;
        self.advance();
        self.name("the name of the resource")?;
        if self.take(Kind::Keyword(Keyword::On)) {
            self.name("the kind of the resource")?;
        }
        self.parts(true);
        self.end_of_block(Keyword::EndResource, "END_RESOURCE", open)
    }

    /// `TASK fast(INTERVAL := T#20ms, PRIORITY := 0);`
    fn task(&mut self) -> Parse<()> {
        const HINT: &str = "a task looks like this: TASK fast(INTERVAL := T#20ms, PRIORITY := 0);";
        let start = self.token.span.start;
        self.anchor(start);
        self.advance();
        let name = self.name("the name of the task")?;
        let mut task = Task { name, interval: None, priority: None, span: self.since(start) };
        let open = self.token.span;
        if self.take(Kind::LeftParenthesis) {
            while self.token.kind != Kind::RightParenthesis {
                let setting = self.name("INTERVAL, SINGLE or PRIORITY")?;
                if !self.take(Kind::Assign) {
                    let problem = self.unexpected("`:=`").hint(HINT);
                    return self.give_up(problem);
                }
                let value = self.expression()?;
                let place = match setting.key().as_str() {
                    "interval" => &mut task.interval,
                    "priority" => &mut task.priority,
                    "single" => {
                        self.events.push(Event { task: task.name.clone(), trigger: value, span: setting.span });
                        if !self.take(Kind::Comma) {
                            break;
                        }
                        continue;
                    }
                    _ => {
                        let message = format!("a task has no `{}`", setting.text);
                        let problem = Diagnostic::new(Code::UnexpectedToken, setting.span, message).hint(HINT);
                        return self.give_up(problem);
                    }
                };
                if place.replace(value).is_some() {
                    let message = format!("`{}` was given before", setting.text);
                    self.report(Diagnostic::new(Code::DuplicateClause, setting.span, message));
                }
                if !self.take(Kind::Comma) {
                    break;
                }
            }
            self.close(Kind::RightParenthesis, open, HINT)?;
        }
        task.span = self.since(start);
        self.semicolon_of_declaration()?;
        self.program.tasks.push(task);
        Ok(())
    }

    /// `PROGRAM main WITH fast : control;`
    fn instance(&mut self) -> Parse<()> {
        let start = self.token.span.start;
        self.anchor(start);
        self.advance();
        if matches!(self.token.kind, Kind::Keyword(Keyword::Retain | Keyword::NonRetain)) {
            let place = self.token.span;
            self.missing.note("RETAIN of a whole program", place);
            self.advance();
        }
        let name = self.name("the name of the instance")?;
        let task = if self.take(Kind::Keyword(Keyword::With)) { Some(self.name("the name of a task")?) } else { None };
        if !self.take(Kind::Colon) {
            let problem = self.unexpected("`:`");
            return self.give_up(problem.hint("a program runs like this: PROGRAM main WITH fast : control;"));
        }
        let program = self.name("the name of a program")?;
        let span = self.since(start);
        self.program.instances.push(ProgramInstance { name, program, task, span });
        if self.token.kind == Kind::LeftParenthesis {
            let place = self.token.span;
            self.missing.note("wiring at a program of a resource", place);
            return Err(GivenUp);
        }
        self.semicolon_of_declaration()
    }
}
