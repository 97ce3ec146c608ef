//! Types, variables, initial values and the configuration.

use super::xml::Xml;
use crate::elementary::Elementary;
use crate::frontend::structured_text::print::{Instances, Words};
use crate::ladder::{
    Expression, ExpressionKind, Program, TypeKind, TypeReference, UnitKind, Variable, VariableClass, key,
};

/// `<dataTypes>`
pub(super) fn types(xml: &mut Xml, program: &Program, words: Words<'_>) {
    if program.types.is_empty() {
        return xml.empty("dataTypes", &[]);
    }
    xml.element("dataTypes", &[], |xml| {
        for ty in &program.types {
            xml.element("dataType", &[("name", &words.names.spell(&ty.name.text))], |xml| match &ty.kind {
                TypeKind::Alias { ty, initial: value } => {
                    xml.element("baseType", &[], |xml| type_reference(xml, ty, words));
                    initial(xml, value.as_ref(), words);
                }
                TypeKind::Structure(fields) => xml.element("baseType", &[], |xml| {
                    xml.element("struct", &[], |xml| {
                        for field in fields {
                            xml.element("variable", &[("name", &words.names.spell(&field.name.text))], |xml| {
                                xml.on_one_line("type", &[], |xml| type_reference(xml, &field.ty, words));
                                initial(xml, field.initial.as_ref(), words);
                            });
                        }
                    });
                }),
                TypeKind::Enumeration { base, values, initial } => {
                    xml.element("baseType", &[], |xml| {
                        xml.element("enum", &[], |xml| {
                            xml.element("values", &[], |xml| {
                                for (name, number) in values {
                                    let name = words.names.spell(&name.text);
                                    match number {
                                        Some(number) => {
                                            let number = words.expression(number);
                                            xml.empty("value", &[("name", &name), ("value", &number)]);
                                        }
                                        None => xml.empty("value", &[("name", &name)]),
                                    }
                                }
                            });
                            if let Some(base) = base {
                                let named = TypeReference::of_name(base.clone());
                                xml.element("baseType", &[], |xml| type_reference(xml, &named, words));
                            }
                        });
                    });
                    if let Some(first) = initial {
                        let value = words.names.spell(&first.text);
                        xml.element("initialValue", &[], |xml| xml.empty("simpleValue", &[("value", &value)]));
                    }
                }
            });
        }
    });
}

/// `<BOOL/>`, `<derived name="…"/>` or `<array>…</array>`
pub(super) fn type_reference(xml: &mut Xml, ty: &TypeReference, words: Words<'_>) {
    let element = |xml: &mut Xml| match Elementary::from_name(&ty.name.text) {
        Some(elementary) => xml.empty(elementary.name(), &[]),
        None => xml.empty("derived", &[("name", &words.names.spell_type(&ty.name.text))]),
    };
    if ty.dimensions.is_empty() {
        return element(xml);
    }
    xml.element("array", &[], |xml| {
        for dimension in &ty.dimensions {
            let [lower, upper] = [&dimension.first, &dimension.last].map(|bound| words.expression(bound));
            xml.empty("dimension", &[("lower", &lower), ("upper", &upper)]);
        }
        xml.element("baseType", &[], element);
    });
}

fn initial(xml: &mut Xml, value: Option<&Expression>, words: Words<'_>) {
    if let Some(value) = value {
        xml.on_one_line("initialValue", &[], |xml| initial_value(xml, value, words));
    }
}

fn initial_value(xml: &mut Xml, value: &Expression, words: Words<'_>) {
    match &value.kind {
        ExpressionKind::Array(items) => xml.element("arrayValue", &[], |xml| {
            for item in items {
                let repeat = item.repeat.as_ref().map(|repeat| words.expression(repeat));
                let attributes = repeat.as_ref().map(|repeat| ("repetitionValue", repeat.as_str()));
                match &item.value {
                    Some(value) => {
                        xml.element("value", attributes.as_slice(), |xml| initial_value(xml, value, words));
                    }
                    None => xml.empty("value", attributes.as_slice()),
                }
            }
        }),
        ExpressionKind::Structure(members) => xml.element("structValue", &[], |xml| {
            for member in members {
                xml.element("value", &[("member", &words.names.spell(&member.member.text))], |xml| {
                    initial_value(xml, &member.value, words);
                });
            }
        }),
        _ => xml.empty("simpleValue", &[("value", &words.expression(value))]),
    }
}

/// The list that a variable of a unit stands in.
fn list(variable: &Variable) -> &'static str {
    match variable.class {
        // What is located is neither input nor output of a unit: its address says what it is.
        _ if variable.address.is_some() => "localVars",
        VariableClass::Input => "inputVars",
        VariableClass::Output => "outputVars",
        VariableClass::InOut => "inOutVars",
        VariableClass::Temporary => "tempVars",
        VariableClass::Memory | VariableClass::Constant => "localVars",
    }
}

/// The variables of a unit, a new list wherever the class changes.
pub(super) fn variables(xml: &mut Xml, variables: &[Variable], words: Words<'_>) {
    lists(xml, variables, words, list);
}

/// The globals that a unit uses.
pub(super) fn externals(xml: &mut Xml, globals: &[&Variable], words: Words<'_>) {
    let bare: Vec<Variable> = globals
        .iter()
        .map(|global| Variable { initial: None, address: None, retain: false, ..(*global).clone() })
        .collect();
    lists(xml, &bare, words, |_| "externalVars");
}

fn lists(xml: &mut Xml, variables: &[Variable], words: Words<'_>, list: impl Fn(&Variable) -> &'static str) {
    let kind = |variable: &Variable| (list(variable), variable.class == VariableClass::Constant, variable.retain);
    let mut rest = variables;
    while let Some(first) = rest.first() {
        let count = rest.iter().take_while(|variable| kind(variable) == kind(first)).count();
        let (now, later) = rest.split_at(count);
        rest = later;
        let (list, constant, retain) = kind(first);
        let mut attributes = Vec::new();
        attributes.extend(constant.then_some(("constant", "true")));
        attributes.extend(retain.then_some(("retain", "true")));
        xml.element(list, &attributes, |xml| now.iter().for_each(|one| variable(xml, one, words)));
    }
}

fn variable(xml: &mut Xml, variable: &Variable, words: Words<'_>) {
    let name = words.names.spell(&variable.name.text);
    let address = variable.address.as_ref().map(ToString::to_string);
    let mut attributes = vec![("name", &*name)];
    attributes.extend(address.as_ref().map(|address| ("address", address.as_str())));
    xml.element("variable", &attributes, |xml| {
        xml.on_one_line("type", &[], |xml| match &variable.ty {
            Some(ty) => type_reference(xml, ty, words),
            None => xml.empty("BOOL", &[]),
        });
        initial(xml, variable.initial.as_deref(), words);
        if words.names.is_renamed(&variable.name.text) {
            xml.formatted("documentation", &variable.name.text);
        }
    });
}

/// `<instances>`: the global variables, the tasks and what runs in them.
pub(super) fn configuration(xml: &mut Xml, program: &Program, instances: &Instances, words: Words<'_>) {
    let instance = |xml: &mut Xml, name: &str, of: &str| {
        let unit = program.units.iter().find(|unit| key(&unit.name.text) == of && is_program(&unit.kind));
        let spelled = unit.map(|unit| words.names.spell(&unit.name.text));
        let ty = instances.types.get(of).map(String::as_str).or(spelled.as_deref()).unwrap_or(of);
        xml.empty("pouInstance", &[("name", name), ("typeName", ty)]);
    };
    let of_task = |task: Option<&str>| {
        let wanted = task.map(key);
        instances.list.iter().filter(move |(_, _, task)| task.as_deref().map(key) == wanted)
    };
    let resource = |xml: &mut Xml| {
        for task in &program.tasks {
            let name = words.names.spell(&task.name.text);
            let priority = task.priority.as_ref().map_or("0".to_owned(), |priority| words.expression(priority));
            let interval = task.interval.as_ref().map(|interval| words.expression(interval));
            let mut attributes = vec![("name", &*name), ("priority", &*priority)];
            attributes.extend(interval.as_ref().map(|interval| ("interval", interval.as_str())));
            if of_task(Some(&task.name.text)).next().is_none() {
                xml.empty("task", &attributes);
                continue;
            }
            xml.element("task", &attributes, |xml| {
                of_task(Some(&task.name.text)).for_each(|(name, of, _)| instance(xml, name, of));
            });
        }
        lists(xml, &program.globals, words, |_| "globalVars");
        of_task(None).for_each(|(name, of, _)| instance(xml, name, of));
    };
    xml.element("instances", &[], |xml| {
        xml.element("configurations", &[], |xml| {
            xml.element("configuration", &[("name", "config0")], |xml| {
                xml.element("resource", &[("name", "resource0")], resource);
            });
        });
    });
}

fn is_program(kind: &UnitKind) -> bool {
    matches!(kind, UnitKind::Program { .. })
}

/// Variables of a name and a type that are written already.
pub(super) fn added<'a>(xml: &mut Xml, variables: impl Iterator<Item = &'a (String, String)>) {
    let mut variables = variables.peekable();
    if variables.peek().is_none() {
        return;
    }
    xml.element("localVars", &[], |xml| {
        for (name, ty) in variables {
            xml.element("variable", &[("name", name)], |xml| {
                xml.element("type", &[], |xml| match Elementary::from_name(ty) {
                    Some(elementary) => xml.empty(elementary.name(), &[]),
                    None => xml.empty("derived", &[("name", ty)]),
                });
            });
        }
    });
}
