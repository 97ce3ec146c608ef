//! The registers that blocks of the register machine work on: elements of an array of WORD. A block that works on several
//! must never leave the array, so that which ones they are is known here.

use super::Checker;
use super::model::{ArrayType, Index, Input, Place, Step, Type, Wire};
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::library::{StandardBlock, Takes};
use crate::ladder::{BlockCall, VariableClass};
use crate::source::Span;

impl Checker<'_> {
    /// Whether the registers of a call can be what they are; else that is reported.
    pub(super) fn check_registers_of(
        &mut self,
        block: StandardBlock,
        call: &BlockCall,
        inputs: &[Input],
        references: &[(usize, Place)],
    ) -> bool {
        // A block that says how many registers it works on works on all from there.
        let length = block.inputs().iter().position(|pin| pin.takes == Takes::Constant && pin.name == "LENGTH");
        let length = length.map(|pin| inputs.iter().find(|input| input.pin == pin).and_then(constant_of).unwrap_or(1));
        references.iter().all(|(pin, place)| {
            let name = block.inputs()[*pin].name;
            let argument = call.arguments.iter().find(|argument| argument.pin.text.eq_ignore_ascii_case(name));
            let span = argument.map_or(call.instance.span, |argument| argument.span);
            self.check_register(name, place, length, span)
        })
    }

    fn check_register(&mut self, pin: &str, place: &Place, length: Option<i128>, span: Span) -> bool {
        let array = match place.path.as_slice() {
            [before @ .., Step::Element(indices)] => self.array_at(place, before.len()).map(|array| (array, indices)),
            _ => None,
        };
        let array = array.filter(|(array, _)| array.element == Type::Elementary(Elementary::Word));
        let (code, message) = match (array, length) {
            (None, _) => (Code::TypeMismatch, format!("`{pin}` takes an element of an array of WORD")),
            (Some(_), None) => return true,
            (Some((array, indices)), Some(length)) => {
                let class = self.scope.entry(place.variable).variable.class;
                if matches!(class, VariableClass::Input | VariableClass::InOut) {
                    let message = format!("`{pin}` takes registers of the unit's own, which are no inputs");
                    (Code::NotWritable, message)
                } else if let Some(offset) = offset(array, indices).filter(|_| is_constant(place)) {
                    if i128::from(offset) + length <= i128::from(array.count()) {
                        return true;
                    }
                    let message =
                        format!("{length} registers from here on are more than the {} of the array", array.count());
                    (Code::OutOfRange, message)
                } else {
                    (Code::NotConstant, format!("`{pin}` takes an element with a constant index"))
                }
            }
        };
        self.report.push(Diagnostic::new(code, span, message).hint(format!("write it as `{pin} := hreg[0]`")));
        false
    }

    /// The array at the end of so many steps of a place.
    fn array_at(&self, place: &Place, steps: usize) -> Option<&ArrayType> {
        let mut ty = self.scope.entry(place.variable).variable.ty;
        for step in &place.path[..steps] {
            ty = match (step, ty) {
                (Step::Field(field), Type::Structure(structure)) => {
                    self.types.structures[structure.index()].fields[*field].ty
                }
                (Step::Variable(variable), _) => self.scope.entry(*variable).variable.ty,
                (Step::Element(_), Type::Array(array)) => self.types.arrays[array.index()].element,
                _ => return None,
            };
        }
        match ty {
            Type::Array(array) => Some(&self.types.arrays[array.index()]),
            _ => None,
        }
    }
}

fn constant_of(input: &Input) -> Option<i128> {
    match &input.wire {
        Wire::Value(value) => value.constant()?.as_integer(),
        Wire::Circuit(_) => None,
    }
}

/// Whether a place has no computed index.
pub(super) fn is_constant(place: &Place) -> bool {
    let computed = |step: &Step| match step {
        Step::Element(indices) => indices.iter().any(|index| matches!(index, Index::Computed(_))),
        _ => false,
    };
    !place.path.iter().any(computed)
}

/// The place of an element among all of its array; none where an index is computed.
fn offset(array: &ArrayType, indices: &[Index]) -> Option<u64> {
    let mut offset = 0;
    for (index, dimension) in indices.iter().zip(&array.dimensions) {
        let Index::Constant(index) = index else { return None };
        offset = offset * u64::from(dimension.count) + u64::from(*index);
    }
    Some(offset)
}
