//! Where located variables stand, in the formats of other tools: addresses that a file leaves open (`%I*`), and variables that are
//! declared as one thing and stand where another does.

use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::frontend::missing::Missing;
use crate::ladder::{Address, Area, Unit, UnitKind, Variable, VariableClass, Width};
use crate::source::Span;

/// The first number of addresses that are given to global variables: beyond those of any input or output of a real plant.
const FIRST_GIVEN: u32 = 10_000;

/// An address that a file leaves open, until [`settle`] has filled it in: it has no number.
pub(super) fn open(text: &str, span: Span) -> Option<Address> {
    let mut letters = text.strip_prefix('%')?.strip_suffix('*')?.chars().map(|letter| letter.to_ascii_uppercase());
    let area = match letters.next()? {
        'I' => Area::Input,
        'Q' => Area::Output,
        'M' => Area::Memory,
        _ => return None,
    };
    let width = match letters.next() {
        None | Some('X') => Width::Bit,
        Some('B') => Width::Byte,
        Some('W') => Width::Word,
        Some('D') => Width::Double,
        Some('L') => Width::Long,
        Some(_) => return None,
    };
    letters.next().is_none().then(|| Address { area, width, numbers: Vec::new(), span })
}

/// Fills in what is left open, and lets the address of a program's variable say what it is: what is declared among the inputs and
/// stands at `%M` is memory.
pub(super) fn settle(globals: &mut [Variable], units: &mut [&mut Unit]) -> Vec<Diagnostic> {
    let mut left_open: Vec<Span> = Vec::new();
    let mut missing = Missing::default();
    for unit in units {
        let is_program = matches!(unit.kind, UnitKind::Program { .. });
        for variable in &mut unit.variables {
            let Some(address) = variable.address.as_ref() else { continue };
            let class = match address.area {
                Area::Input => VariableClass::Input,
                Area::Output => VariableClass::Output,
                Area::Memory => VariableClass::Memory,
            };
            let is_open = address.numbers.is_empty();
            if is_open && !is_program {
                missing.note("an address that each instance of a block has of its own", variable.span);
                variable.address = None;
            } else if is_open {
                left_open.push(variable.span);
                variable.address = None;
                variable.class = class;
            } else if is_program
                && matches!(variable.class, VariableClass::Input | VariableClass::Output)
                && variable.class != class
            {
                variable.class = VariableClass::Memory;
            }
        }
    }
    let mut number = FIRST_GIVEN;
    for variable in globals {
        let is_bool = variable.ty.as_ref().is_none_or(|ty| ty.name.text.eq_ignore_ascii_case("BOOL"));
        let width = variable.ty.as_ref().and_then(|ty| Elementary::from_name(&ty.name.text)).map(width_of);
        let Some(address) = variable.address.as_mut().filter(|address| address.numbers.is_empty()) else { continue };
        left_open.push(variable.span);
        address.width = width.unwrap_or(address.width);
        address.numbers.push(number);
        if is_bool {
            address.numbers.push(0);
        }
        number += 1;
    }
    let count = left_open.len();
    let said = left_open.first().map(|first| {
        let message = match count {
            1 => "the address of this variable is left open".to_owned(),
            count => format!("the addresses of {count} variables are left open, the first here"),
        };
        let problem = Diagnostic::new(Code::OpenAddress, *first, message);
        problem.hint("it is an input or output all the same: `%I*` an input, `%Q*` an output")
    });
    missing.into_diagnostics().chain(said).collect()
}

fn width_of(ty: Elementary) -> Width {
    match ty {
        Elementary::Bool => Width::Bit,
        Elementary::Sint | Elementary::Usint | Elementary::Byte => Width::Byte,
        Elementary::Int | Elementary::Uint | Elementary::Word => Width::Word,
        Elementary::Dint | Elementary::Udint | Elementary::Dword | Elementary::Real => Width::Double,
        Elementary::Lint | Elementary::Ulint | Elementary::Lword | Elementary::Lreal | Elementary::Time => Width::Long,
    }
}
