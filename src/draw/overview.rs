//! What stands outside the rungs in words: units, types, registers, tasks and instances of programs, each on a line that is
//! cut where it is far too long.

use super::label;
use crate::ladder::{Expression, Name, Program, Setting, TypeDeclaration, TypeKind, Unit, UnitKind};

/// The most columns of one value or type.
const WIDEST: usize = 48;
/// How many members or values of one type are shown.
const MOST: usize = 64;

/// What a unit is, with its name.
pub(super) fn unit(unit: &Unit) -> String {
    let name = &unit.name.text;
    match &unit.kind {
        UnitKind::Program { task } => format!("program {name}{}", with_task(task.as_ref())),
        UnitKind::FunctionBlock => format!("function_block {name}"),
        UnitKind::Function { result: None } => format!("function {name}"),
        UnitKind::Function { result: Some(ty) } => format!("function {name} : {}", label::type_reference(ty, WIDEST)),
    }
}

/// What is declared outside the units but for the global variables.
pub(super) fn lines(program: &Program) -> Vec<String> {
    let types = program.types.iter().map(type_line);
    let registers = program.registers.iter().map(|registers| format!("registers({})", settings(&registers.settings)));
    let tasks = program.tasks.iter().map(|task| {
        let settings = [("interval", &task.interval), ("priority", &task.priority)];
        let settings =
            settings.map(|(name, value)| value.as_ref().map(|value| format!("{name}{}", initial(Some(value)))));
        let settings: Vec<String> = settings.into_iter().flatten().collect();
        let name = &task.name.text;
        if settings.is_empty() { format!("task {name}") } else { format!("task {name}({})", settings.join(", ")) }
    });
    let instances = program.instances.iter().map(|instance| {
        format!("program {} : {}{}", instance.name.text, instance.program.text, with_task(instance.task.as_ref()))
    });
    types.chain(registers).chain(tasks).chain(instances).collect()
}

fn type_line(declaration: &TypeDeclaration) -> String {
    let kind = match &declaration.kind {
        TypeKind::Alias { ty, initial: value } => {
            format!("{}{}", label::type_reference(ty, WIDEST), initial(value.as_ref()))
        }
        TypeKind::Structure(fields) => {
            let field = fields.iter().map(|field| {
                let ty = label::type_reference(&field.ty, WIDEST);
                format!("{} : {ty}{}", field.name.text, initial(field.initial.as_ref()))
            });
            format!("struct {} end_struct", first_of(field, "  "))
        }
        TypeKind::Enumeration { base, values, initial: value } => {
            let values = values.iter().map(|(name, number)| format!("{}{}", name.text, initial(number.as_ref())));
            let base = base.as_ref().map_or(String::new(), |base| format!("{} ", base.text));
            let value = value.as_ref().map_or(String::new(), |value| format!(" := {}", value.text));
            format!("{base}({}){value}", first_of(values, ", "))
        }
    };
    format!("type {} : {kind}", declaration.name.text)
}

/// The first of many, with a sign where there are more.
fn first_of(items: impl ExactSizeIterator<Item = String>, separator: &str) -> String {
    let more = items.len() > MOST;
    let mut shown: Vec<String> = items.take(MOST).collect();
    shown.extend(more.then(|| "…".to_owned()));
    shown.join(separator)
}

fn initial(value: Option<&Expression>) -> String {
    value.map_or(String::new(), |value| format!(" := {}", label::expression(value, WIDEST)))
}

fn settings(settings: &[Setting]) -> String {
    first_of(settings.iter().map(|setting| format!("{}{}", setting.name.text, initial(Some(&setting.value)))), ", ")
}

fn with_task(task: Option<&Name>) -> String {
    task.map_or(String::new(), |task| format!(" with {}", task.text))
}
