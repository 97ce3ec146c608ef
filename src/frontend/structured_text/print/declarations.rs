//! Types, variables and the configuration.

use std::collections::{HashMap, HashSet};

use super::calls::is_iec;
use super::names::Names;
use super::words::Words;
use crate::diagnostic::{Code, Diagnostic};
use crate::frontend::uses::{self, Use};
use crate::ladder::library::StandardBlock;
use crate::ladder::{Expression, Program, TypeKind, Unit, UnitKind, Variable, VariableClass, key};

/// What runs, as it is written.
pub(in crate::frontend) struct Instances {
    /// The names of program types that are not those of their units, by key.
    pub(in crate::frontend) types: HashMap<String, String>,
    /// Each instance: its name, its program's key, its task.
    pub(in crate::frontend) list: Vec<(String, String, Option<String>)>,
}

/// The instances of the programs. A program that none names has one of its own name, and its type another name then: one name stands
/// for one thing.
pub(in crate::frontend) fn instances(program: &Program, names: &mut Names) -> Instances {
    let mut types = HashMap::new();
    let mut list = Vec::new();
    let named: HashSet<String> = program.instances.iter().map(|instance| instance.program.key()).collect();
    let programs: Vec<&Unit> =
        program.units.iter().filter(|unit| matches!(unit.kind, UnitKind::Program { .. })).collect();
    let alone = programs.len() == 1 && program.instances.is_empty();
    for unit in programs.iter().filter(|unit| !named.contains(&unit.name.key())) {
        let task = match &unit.kind {
            UnitKind::Program { task } => task.as_ref().map(|task| task.text.to_string()),
            _ => None,
        };
        let instance = if alone {
            names.fresh("instance")
        } else {
            let of_type = names.fresh(&format!("{}_program", names.spell(&unit.name.text)));
            types.insert(unit.name.key(), of_type);
            names.spell(&unit.name.text).into_owned()
        };
        list.push((instance, unit.name.key(), task));
    }
    for instance in &program.instances {
        let name = names.spell(&instance.name.text).into_owned();
        list.push((name, instance.program.key(), instance.task.as_ref().map(|task| task.text.to_string())));
    }
    Instances { types, list }
}

/// `TYPE … END_TYPE`
pub(super) fn types(text: &mut String, program: &Program, words: Words<'_>) {
    if program.types.is_empty() {
        return;
    }
    text.push_str("TYPE\n");
    for ty in &program.types {
        let name = words.names.spell(&ty.name.text);
        match &ty.kind {
            TypeKind::Alias { ty, initial } => {
                text.push_str(&format!(
                    "  {name} : {}{};\n",
                    words.type_reference(ty),
                    words.initial(initial.as_ref())
                ));
            }
            TypeKind::Structure(fields) => {
                text.push_str(&format!("  {name} : STRUCT\n"));
                for field in fields {
                    text.push_str(&format!(
                        "    {} : {}{};\n",
                        words.names.spell(&field.name.text),
                        words.type_reference(&field.ty),
                        words.initial(field.initial.as_ref())
                    ));
                }
                text.push_str("  END_STRUCT;\n");
            }
            TypeKind::Enumeration { base, values, initial } => {
                let base =
                    base.as_ref().map_or(String::new(), |base| format!("{} ", words.names.spell_type(&base.text)));
                let values: Vec<String> = values
                    .iter()
                    .map(|(name, number)| {
                        format!("{}{}", words.names.spell(&name.text), words.initial(number.as_ref()))
                    })
                    .collect();
                let initial = initial.as_ref().map(|name| format!(" := {}", words.names.spell(&name.text)));
                text.push_str(&format!("  {name} : {base}({}){};\n", values.join(", "), initial.unwrap_or_default()));
            }
        }
    }
    text.push_str("END_TYPE\n\n");
}

/// What a unit uses beside what it declares.
pub(in crate::frontend) struct Used<'p> {
    /// Global variables.
    pub(in crate::frontend) globals: Vec<&'p Variable>,
    /// The instances that their calls declare: name and type, as they are written.
    pub(in crate::frontend) instances: Vec<(String, String)>,
}

/// What a unit uses beside what it declares.
pub(in crate::frontend) fn used<'p>(
    program: &'p Program,
    unit: &Unit,
    words: Words<'_>,
    problems: &mut Vec<Diagnostic>,
) -> Used<'p> {
    for variable in &unit.variables {
        let block = variable.ty.as_ref().and_then(|ty| StandardBlock::from_name(&ty.name.text));
        if block.is_some_and(|block| !is_iec(block)) {
            let message = format!("`{}` is a block of the register machine", variable.name.text);
            problems.push(Diagnostic::new(Code::CannotConvert, variable.span, message));
        }
    }
    let own: HashSet<String> = unit.variables.iter().map(|variable| variable.name.key()).collect();
    let (mut used, mut called) = (HashSet::new(), HashSet::new());
    let mut instances: Vec<(String, String)> = Vec::new();
    let registers = ["ireg", "oreg", "hreg"];
    let globals: HashMap<String, &Variable> =
        program.globals.iter().map(|variable| (variable.name.key(), variable)).collect();
    {
        let mut visit = |mentioned: Use<'_>| {
            if let Use::Block(ty, instance) = mentioned
                && let Some(name) = instance.as_name()
                && !own.contains(&name.key())
                && !globals.contains_key(&name.key())
                && called.insert(name.key())
            {
                let ty = words.names.spell_type(&ty.text).into_owned();
                instances.push((words.names.spell(&name.text).into_owned(), ty));
            }
            let Some(root) = uses::root_key(mentioned) else { return };
            if own.contains(&root) {
                return;
            }
            if let Use::Reference(reference) = mentioned
                && registers.contains(&root.as_str())
                && !globals.contains_key(&root)
                && !used.contains(&root)
            {
                let message = format!("`{root}` is an array of the register machine");
                problems.push(Diagnostic::new(Code::CannotConvert, reference.span, message));
            }
            used.insert(root);
        };
        for rung in &unit.rungs {
            uses::circuit(&rung.circuit, &mut visit);
        }
        for initial in unit.variables.iter().filter_map(|variable| variable.initial.as_ref()) {
            uses::expression(initial, &mut visit);
        }
    }
    let is_used = |global: &&Variable| used.contains(&global.name.key()) && !own.contains(&global.name.key());
    Used { globals: program.globals.iter().filter(is_used).collect(), instances }
}

/// All variables of a unit: the global ones that it uses, its own, the instances that their calls declare, and those that its
/// statements need beside them.
pub(super) fn variables(
    text: &mut String,
    program: &Program,
    unit: &Unit,
    added: &[(String, String)],
    words: Words<'_>,
    problems: &mut Vec<Diagnostic>,
) {
    let Used { globals, instances } = used(program, unit, words, problems);
    for (constant, head) in [(false, "VAR_EXTERNAL"), (true, "VAR_EXTERNAL CONSTANT")] {
        let listed = globals.iter().filter(|global| (global.class == VariableClass::Constant) == constant);
        let lines: Vec<String> = listed
            .map(|global| declaration(&Variable { initial: None, address: None, ..(*global).clone() }, words))
            .collect();
        block(text, 1, head, &lines);
    }
    blocks(text, 1, &unit.variables, words, false);
    let lines: Vec<String> = instances.iter().chain(added).map(|(name, ty)| format!("{name} : {ty};")).collect();
    block(text, 1, "VAR", &lines);
}

fn block(text: &mut String, indent: usize, head: &str, lines: &[String]) {
    if lines.is_empty() {
        return;
    }
    let pad = "  ".repeat(indent);
    text.push_str(&format!("{pad}{head}\n"));
    for line in lines {
        text.push_str(&format!("{pad}  {line}\n"));
    }
    text.push_str(&format!("{pad}END_VAR\n"));
}

/// Declarations in their order: a new block wherever the class changes.
fn blocks(text: &mut String, indent: usize, variables: &[Variable], words: Words<'_>, global: bool) {
    let mut rest = variables;
    while let Some(first) = rest.first() {
        let head = head(first, global);
        let count = rest.iter().take_while(|variable| self::head(variable, global) == head).count();
        let (now, later) = rest.split_at(count);
        let lines: Vec<String> = now.iter().map(|variable| declaration(variable, words)).collect();
        block(text, indent, &head, &lines);
        rest = later;
    }
}

fn head(variable: &Variable, global: bool) -> String {
    let word = match variable.class {
        _ if global => "VAR_GLOBAL",
        // What is located is neither input nor output of a unit: its address says what it is.
        _ if variable.address.is_some() => "VAR",
        VariableClass::Input => "VAR_INPUT",
        VariableClass::Output => "VAR_OUTPUT",
        VariableClass::InOut => "VAR_IN_OUT",
        VariableClass::Temporary => "VAR_TEMP",
        VariableClass::Memory | VariableClass::Constant => "VAR",
    };
    let constant = if variable.class == VariableClass::Constant { " CONSTANT" } else { "" };
    let retain = if variable.retain { " RETAIN" } else { "" };
    format!("{word}{constant}{retain}")
}

fn declaration(variable: &Variable, words: Words<'_>) -> String {
    let name = words.names.spell(&variable.name.text);
    let address = variable.address.as_ref().map_or(String::new(), |address| format!(" AT {address}"));
    let ty = variable.ty.as_ref().map_or("BOOL".to_owned(), |ty| words.type_reference(ty));
    let renamed = if words.names.is_renamed(&variable.name.text) {
        format!(" (* {} *)", variable.name.text.replace("*)", "* )").replace("(*", "( *").replace(['\n', '\r'], " "))
    } else {
        String::new()
    };
    format!("{name}{address} : {ty}{};{renamed}", words.initial(variable.initial.as_deref()))
}

/// `CONFIGURATION … END_CONFIGURATION`: the global variables, the tasks, and what runs in them.
pub(super) fn configuration(text: &mut String, program: &Program, instances: &Instances, words: Words<'_>) {
    if instances.list.is_empty() && program.globals.is_empty() && program.tasks.is_empty() {
        return;
    }
    text.push_str("CONFIGURATION config0\n");
    blocks(text, 1, &program.globals, words, true);
    text.push_str("  RESOURCE resource0 ON PLC\n");
    for task in &program.tasks {
        let setting = |name: &str, value: &Option<Expression>| {
            value.as_ref().map(|value| format!("{name} := {}", words.expression(value)))
        };
        let interval = setting("INTERVAL", &task.interval);
        let priority = setting("PRIORITY", &task.priority).unwrap_or_else(|| "PRIORITY := 0".to_owned());
        let settings: Vec<String> = interval.into_iter().chain([priority]).collect();
        text.push_str(&format!("    TASK {}({});\n", words.names.spell(&task.name.text), settings.join(", ")));
    }
    for (name, of_type, task) in &instances.list {
        let with = task.as_ref().map_or(String::new(), |task| format!(" WITH {}", words.names.spell(task)));
        let unit = program.units.iter().find(|unit| key(&unit.name.text) == *of_type);
        let spelled = unit.map_or(of_type.as_str(), |unit| unit.name.text.as_str());
        let of_type = instances.types.get(of_type).cloned().unwrap_or_else(|| words.names.spell(spelled).into_owned());
        text.push_str(&format!("    PROGRAM {name}{with} : {of_type};\n"));
    }
    text.push_str("  END_RESOURCE\nEND_CONFIGURATION\n");
}
