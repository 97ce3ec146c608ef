//! The names of pins, as the standard spells them: tools number the pins of a function in their own ways (CODESYS counts EN
//! as the first, others leave names out), and some pins of standard blocks have other names there.

use lean_string::LeanString;

use super::diagram::{Block, Diagram, ItemKind};
use super::types::Signatures;
use crate::ladder::functions::Function;
use crate::ladder::library::StandardBlock;

/// Gives the pins of all boxes of standard blocks and functions their names. Wires know pins by their places.
pub(super) fn name(diagram: &mut Diagram, signatures: &Signatures) {
    for item in &mut diagram.items {
        if let ItemKind::Block(block) = &mut item.kind {
            name_of(block, signatures);
        }
    }
}

fn name_of(block: &mut Block, signatures: &Signatures) {
    let standard = signatures.is_standard(&block.type_name.text);
    // Some tools name every box, though a function has no instance.
    if signatures.is_function(&block.type_name.text) && !signatures.is_known_block(&block.type_name.text) {
        block.instance = None;
    }
    match (&block.instance, Function::from_name(&block.type_name.text)) {
        (Some(_), _) => {
            let Some(known) = StandardBlock::from_name(&block.type_name.text).filter(|_| standard) else { return };
            for pin in &mut block.inputs {
                if let Some(name) = known.input_called(&pin.name.text) {
                    pin.name.text = name.into();
                }
            }
        }
        (None, Some(function)) if standard => {
            inputs(block, function);
            output(block, |_| false);
        }
        (None, _) => {
            let name = block.type_name.text.clone();
            output(block, |pin| signatures.has_output(&name, pin));
        }
    }
}

fn is_enable(name: &str) -> bool {
    name.eq_ignore_ascii_case("EN") || name.eq_ignore_ascii_case("ENO")
}

/// The operands of a function are its parameters in order, unless all have names that say another order.
fn inputs(block: &mut Block, function: Function) {
    let pins = block.inputs.iter_mut().map(|pin| &mut pin.name.text).filter(|name| !is_enable(name)).collect();
    operands(pins, function);
}

/// Gives operands the names of the parameters in their places, unless all have names that say another order.
pub(in crate::frontend) fn operands(pins: Vec<&mut LeanString>, function: Function) {
    let parameter = |place: usize| match function {
        Function::Standard(function) => function.parameter(place).map(|parameter| parameter.name),
        Function::Convert { .. } | Function::Truncate { .. } => (place == 0).then_some("IN"),
    };
    let place_of = |name: &str| match function {
        Function::Standard(function) => function.place(name),
        Function::Convert { .. } | Function::Truncate { .. } => name.eq_ignore_ascii_case("IN").then_some(0),
    };
    let count = pins.len();
    let is_place = |place: Option<usize>| place.is_some_and(|place| place < count);
    if pins.iter().all(|pin| is_place(place_of(pin))) {
        return;
    }
    let numbered = |name: &str| {
        let digits = name.trim_start_matches(|first: char| first.is_ascii_alphabetic());
        name.len() - digits.len() <= 2 && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    if !pins.iter().all(|pin| numbered(pin)) {
        return;
    }
    for (place, pin) in pins.into_iter().enumerate() {
        let Some(known) = parameter(place) else { return };
        // Behind the listed ones they count on, from the number of the last one.
        let numbers = (place.saturating_sub(1)..=place + 1).map(|number| format!("IN{number}"));
        let name = [known.to_owned()].into_iter().chain(numbers).find(|name| place_of(name) == Some(place));
        *pin = name.map_or_else(|| known.into(), LeanString::from);
    }
}

/// What a function gives is called OUT, unless its own declaration says otherwise.
fn output(block: &mut Block, is_declared: impl Fn(&str) -> bool) {
    let result = block.outputs.iter_mut().find(|pin| !is_enable(&pin.name.text));
    if let Some(pin) = result.filter(|pin| !is_declared(&pin.name.text)) {
        pin.name.text = "OUT".into();
    }
}
