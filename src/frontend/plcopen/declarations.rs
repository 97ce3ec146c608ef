//! Declarations: data types, the interfaces of POUs, global variables.

use std::collections::HashSet;

use thin_vec::ThinVec;

use super::xml::Node;
use super::{Pou, Report};
use crate::diagnostic::Code;
use crate::elementary::Elementary;
use crate::frontend::global_lists::GlobalLists;
use crate::frontend::graph::expression::{self, Fault};
use crate::frontend::located;
use crate::ladder::{
    ArrayItem, Comment, Dimension, Expression, ExpressionKind, Field, Literal, MemberValue, Name, TypeDeclaration,
    TypeKind, TypeReference, Unit, UnitKind, Variable, VariableClass,
};
use crate::source::Span;

/// Reads declarations. Types that are written out inside of others get names of their own.
pub(super) struct Reader<'r> {
    report: &'r mut Report,
    types: Vec<TypeDeclaration>,
    comments: Vec<Comment>,
    /// The lists of global variables that have names of their own.
    pub(super) lists: GlobalLists,
}

impl<'r> Reader<'r> {
    pub(super) fn new(report: &'r mut Report) -> Self {
        Self { report, types: Vec::new(), comments: Vec::new(), lists: GlobalLists::default() }
    }

    /// The types and comments that were read.
    pub(super) fn finish(self) -> (Vec<TypeDeclaration>, Vec<Comment>) {
        (self.types, self.comments)
    }

    fn named(&mut self, node: Node<'_, '_>) -> Option<Name> {
        let name = node.attribute("name").map(|name| Name::new(name, node.span()));
        if name.is_none() {
            self.report.error(Code::BadElement, node.span(), format!("this `<{}>` has no name", node.name()));
        }
        name
    }

    /// `<dataType name="…"><baseType>…</baseType><initialValue/></dataType>`
    pub(super) fn data_type(&mut self, node: Node<'_, '_>) {
        let Some(name) = self.named(node) else { return };
        self.document(node);
        let Some(base) = node.child("baseType").and_then(|base| base.children().next()) else {
            self.report.error(Code::BadElement, node.span(), format!("the type `{}` has no base type", name.text));
            return;
        };
        let initial = node.child("initialValue");
        let kind = match base.name() {
            "struct" => TypeKind::Structure(self.fields(base)),
            "enum" => self.enumeration(base, initial),
            _ => {
                let Some(ty) = self.type_of(base) else { return };
                TypeKind::Alias { initial: initial.and_then(|value| self.initial(value, Some(&ty))), ty }
            }
        };
        self.types.push(TypeDeclaration { name, kind, span: node.span() });
    }

    fn fields(&mut self, node: Node<'_, '_>) -> Vec<Field> {
        let mut fields = Vec::new();
        for member in node.all("variable") {
            let Some(name) = self.named(member) else { continue };
            let Some(ty) = self.declared_type(member, &name) else { continue };
            let initial = member.child("initialValue").and_then(|value| self.initial(value, Some(&ty)));
            fields.push(Field { name, ty, initial });
        }
        fields
    }

    fn enumeration(&mut self, node: Node<'_, '_>, initial: Option<Node<'_, '_>>) -> TypeKind {
        let base = node.child("baseType").and_then(|base| base.children().next());
        let base = base.map(|base| Name::new(base.name(), base.span()));
        let mut values = Vec::new();
        for value in node.child("values").into_iter().flat_map(|values| values.all("value")) {
            let Some(name) = self.named(value) else { continue };
            let number = value.attribute("value").map(|number| expression::expression(number, value.span()));
            let number = number.and_then(|number| self.report.read(number, value.span()));
            values.push((name, number));
        }
        let initial = initial.and_then(|value| value.child("simpleValue"));
        let initial = initial.and_then(|value| Some(Name::new(value.attribute("value")?, value.span())));
        TypeKind::Enumeration { base, values, initial }
    }

    /// The type that a declaration has in its `<type>`.
    fn declared_type(&mut self, node: Node<'_, '_>, name: &Name) -> Option<TypeReference> {
        let Some(ty) = node.child("type").and_then(|ty| ty.children().next()) else {
            self.report.error(Code::BadElement, node.span(), format!("`{}` has no type", name.text));
            return None;
        };
        self.type_of(ty)
    }

    /// `<BOOL/>`, `<derived name="…"/>`, `<array>…</array>` and so on.
    fn type_of(&mut self, node: Node<'_, '_>) -> Option<TypeReference> {
        let span = node.span();
        let base = node.child("baseType").and_then(|base| base.children().next());
        match node.name() {
            "derived" => self.named(node).map(TypeReference::of_name),
            "array" => {
                let mut dimensions = ThinVec::new();
                for dimension in node.all("dimension") {
                    let bound = |name: &str| dimension.attribute(name).unwrap_or_default();
                    let [first, last] = ["lower", "upper"].map(|name| {
                        self.report.read(expression::expression(bound(name), dimension.span()), dimension.span())
                    });
                    dimensions.push(Dimension { first: first?, last: last? });
                }
                let Some(base) = base.filter(|_| !dimensions.is_empty()) else {
                    self.report.error(Code::BadElement, span, "this array has no dimension or no base type");
                    return None;
                };
                let element = self.type_of(base)?;
                let name = if element.dimensions.is_empty() {
                    element.name
                } else {
                    self.hide(TypeKind::Alias { ty: element, initial: None }, span)
                };
                Some(TypeReference { dimensions, name, span })
            }
            // A subrange holds what its base type holds.
            "subrangeSigned" | "subrangeUnsigned" => self.type_of(base?),
            "struct" => {
                let fields = self.fields(node);
                Some(TypeReference::of_name(self.hide(TypeKind::Structure(fields), span)))
            }
            "enum" => {
                let kind = self.enumeration(node, None);
                Some(TypeReference::of_name(self.hide(kind, span)))
            }
            "pointer" => {
                self.report.not_supported("pointer type", span);
                None
            }
            name => Some(TypeReference::of_name(Name::new(name.to_uppercase(), span))),
        }
    }

    /// Declares a type that has no name.
    fn hide(&mut self, kind: TypeKind, span: Span) -> Name {
        let name = Name::new(format!("_TYPE{}", self.types.len() + 1), span);
        self.types.push(TypeDeclaration { name: name.clone(), kind, span });
        name
    }

    /// An initial value, in `<initialValue>` or one of its parts.
    fn initial(&mut self, node: Node<'_, '_>, ty: Option<&TypeReference>) -> Option<Expression> {
        let value = match node.name() {
            "simpleValue" | "arrayValue" | "structValue" => node,
            _ => node.children().next()?,
        };
        let span = value.span();
        let kind = match value.name() {
            "simpleValue" => {
                let text = value.attribute("value")?;
                let mut read = self.report.read(expression::initial_value(text, span), span)?;
                let is_bool = ty.is_some_and(|ty| ty.dimensions.is_empty() && is(&ty.name, Elementary::Bool));
                if let (true, ExpressionKind::Literal(Literal::Integer { value, ty: None, .. })) = (is_bool, &read.kind)
                    && let bit @ (0 | 1) = value.get()
                {
                    read.kind = ExpressionKind::Literal(Literal::Bool(bit == 1));
                }
                return Some(read);
            }
            "arrayValue" => {
                let mut items = Vec::new();
                for item in value.all("value") {
                    let repeat = match item.attribute("repetitionValue").filter(|count| *count != "1") {
                        Some(count) => Some(self.report.read(expression::expression(count, span), span)?),
                        None => None,
                    };
                    let inner = item.children().next();
                    items.push(ArrayItem { repeat, value: inner.and_then(|inner| self.initial(inner, None)) });
                }
                ExpressionKind::Array(items)
            }
            "structValue" => {
                let mut members = Vec::new();
                for member in value.all("value") {
                    let Some(name) = member.attribute("member") else {
                        self.report.error(Code::BadElement, member.span(), "this value names no member");
                        continue;
                    };
                    let inner = member.children().next().and_then(|inner| self.initial(inner, None));
                    members.extend(inner.map(|value| MemberValue { member: Name::new(name, member.span()), value }));
                }
                ExpressionKind::Structure(members)
            }
            _ => return None,
        };
        Some(Expression { kind, span })
    }

    /// The variables of `<localVars>` and the like.
    fn variables(&mut self, list: Node<'_, '_>, class: VariableClass, found: &mut Vec<Variable>) {
        let class = if list.flag("constant") { VariableClass::Constant } else { class };
        let retain = list.flag("retain") || list.flag("persistent");
        for node in list.all("variable") {
            let Some(name) = self.named(node) else { continue };
            let ty = self.declared_type(node, &name);
            let address = node.attribute("address").and_then(|text| match expression::address(text, node.span()) {
                Ok(address) => Some(address),
                Err(_) if text.ends_with('*') => located::open(text, node.span()),
                Err(Fault::Bad(message)) => {
                    self.report.error(Code::BadAddress, node.span(), message);
                    None
                }
                Err(fault) => {
                    self.report.fault(fault, node.span());
                    None
                }
            });
            let initial = node.child("initialValue").and_then(|value| self.initial(value, ty.as_ref()));
            self.document(node);
            found.push(Variable {
                class,
                name,
                ty,
                address: address.map(Box::new),
                initial: initial.map(Box::new),
                retain,
                span: node.span(),
            });
        }
    }

    /// Keeps the documentation of an element as a comment beside it.
    fn document(&mut self, node: Node<'_, '_>) {
        for documentation in node.all("documentation") {
            let text = documentation.whole_text();
            if !text.is_empty() {
                self.comments.push(Comment { text, span: documentation.span(), own_line: false });
            }
        }
    }

    /// The global variables of all lists, each once.
    pub(super) fn globals<'d, 'a: 'd>(&mut self, lists: impl Iterator<Item = Node<'d, 'a>>) -> Vec<Variable> {
        let mut globals = Vec::new();
        for list in lists {
            let first = globals.len();
            self.variables(list, VariableClass::Memory, &mut globals);
            if let Some(name) = list.attribute("name") {
                self.lists.add(name, &globals[first..]);
            }
        }
        globals
    }

    /// A POU without its body.
    pub(super) fn pou<'d, 'a>(&mut self, node: Node<'d, 'a>) -> Option<Pou<'d, 'a>> {
        let name = self.named(node)?;
        let interface = node.child("interface");
        let kind = node.attribute("pouType").unwrap_or_default();
        let kind = match kind.to_ascii_lowercase().as_str() {
            "program" => UnitKind::Program { task: None },
            "functionblock" => UnitKind::FunctionBlock,
            "function" => {
                let result = interface.and_then(|interface| interface.child("returnType"));
                let result = result.and_then(|result| result.children().next());
                UnitKind::Function { result: result.and_then(|result| self.type_of(result)) }
            }
            _ => {
                let message = format!("`{}` is no program, functionBlock or function", name.text);
                self.report.error(Code::BadElement, node.span(), message);
                return None;
            }
        };
        let (mut variables, mut externals) = (Vec::new(), Vec::new());
        for list in interface.into_iter().flat_map(Node::children) {
            let class = match list.name() {
                "inputVars" => VariableClass::Input,
                "outputVars" => VariableClass::Output,
                "inOutVars" => VariableClass::InOut,
                "localVars" => VariableClass::Memory,
                "tempVars" => VariableClass::Temporary,
                "externalVars" => {
                    self.variables(list, VariableClass::Memory, &mut externals);
                    continue;
                }
                "accessVars" => {
                    self.report.not_supported("access variables", list.span());
                    continue;
                }
                // A program's own globals are locals that others may see.
                "globalVars" => VariableClass::Memory,
                _ => continue,
            };
            self.variables(list, class, &mut variables);
        }
        self.document(node);
        let mut names = HashSet::new();
        for variable in &variables {
            if !names.insert(variable.name.key()) {
                let message = format!("`{}` is declared twice in `{}`", variable.name.text, name.text);
                self.report.error(Code::DuplicateName, variable.name.span, message);
            }
        }
        let unit = Unit { kind, name, variables, rungs: Vec::new(), span: node.span() };
        Some(Pou { node, unit, externals })
    }
}

/// Whether a type's name is that of an elementary type.
pub(super) fn is(name: &Name, ty: Elementary) -> bool {
    name.text.eq_ignore_ascii_case(ty.name())
}
