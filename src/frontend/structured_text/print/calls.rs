//! Boxes of blocks and functions.

use super::power::{Change, Power};
use super::rungs::{Rungs, conducts};
use super::words::pin;
use crate::elementary::Elementary;
use crate::frontend::uses;
use crate::ladder::functions::{Function, StandardFunction};
use crate::ladder::library::StandardBlock;
use crate::ladder::{
    Argument, BlockCall, Circuit, Expression, ExpressionKind, Reference, Root, Step, UnitKind, VariableClass, Wire, key,
};
use crate::source::Span;

/// The blocks of the register machine, which no other compiler has.
const REGISTER_MACHINE: [&str; 9] = ["TT", "TS", "UC", "DC", "DR", "BS", "BC", "SHIFTL", "SHIFTR"];

/// Why a box whose ENO depends on an index cannot be written.
pub(super) const ENO_OF_INDEX: &str = "ENO of this box depends on whether an index is out of range";

/// Whether what is wired to a pin has an index that is computed.
pub(super) fn is_computed(argument: &Argument) -> bool {
    let mut found = false;
    let mut visit = |mentioned: uses::Use<'_>| found |= uses::has_computed_index(mentioned);
    match &argument.wire {
        Wire::Value(value) => uses::expression(value, &mut visit),
        Wire::Circuit(circuit) => uses::circuit(circuit, &mut visit),
        Wire::Output(target) => uses::reference(target, &mut visit),
    }
    found
}

fn is_computed_power(power: &Power) -> bool {
    let mut found = false;
    if let Power::While(expression) = power {
        uses::expression(expression, &mut |mentioned| found |= uses::has_computed_index(mentioned));
    }
    found
}

/// Whether other compilers have a block.
pub(in crate::frontend) fn is_iec(block: StandardBlock) -> bool {
    !REGISTER_MACHINE.contains(&block.name())
}

/// The BOOL pins of a block through which power flows.
struct PowerPins {
    input: Option<String>,
    output: Option<String>,
    has_enable: bool,
}

impl Rungs<'_> {
    /// A box; gives the power on its right.
    pub(super) fn block(&mut self, call: &BlockCall, left: Power, needed: bool, span: Span) -> Power {
        if self.writes_beside_eno(call) {
            self.problem(call.instance.span, "ENO and another output of this box go to one variable");
        }
        if self.is_function(call) {
            return self.function_box(call, left, needed);
        }
        let Some(pins) = self.power_pins(call) else {
            let message = "this block has no counterpart in structured text";
            let ty = call.type_name.as_ref().map_or(call.instance.span, |name| name.span);
            self.problem(if ty == Span::default() { span } else { ty }, message);
            return left;
        };
        let is_wired = |name: &str| pin(call, name).is_some();
        let feeds = pins.input.filter(|input| !is_wired(input));
        let output = match &call.power_output {
            Some(output) if !output.text.eq_ignore_ascii_case("ENO") => Some(output.text.to_string()),
            Some(_) => None,
            None => pins.output,
        };
        let eno = pin(call, "ENO").filter(|_| !pins.has_enable);
        // An index that is out of range takes ENO away, which only the call itself can say.
        let can_fail = (eno.is_some() || needed && output.is_none()) && call.arguments.iter().any(is_computed);
        let mut arguments = Vec::new();
        let (left, enable) = self.arguments(call, left, feeds.as_deref(), pins.has_enable, &mut arguments);
        let mut enabled = if feeds.is_some() { enable } else { self.and(left, enable) };
        if needed && output.is_none() && !can_fail {
            enabled = self.held(enabled, &Change::All);
        }
        self.spill(&Change::All);
        let is_conditional = !matches!(enabled, Power::Always);
        let enabled_by_pin =
            is_conditional && !pins.has_enable && (can_fail || self.keeps_inputs(call, feeds.as_deref()));
        if enabled_by_pin {
            arguments.insert(0, format!("EN := {}", self.words().expression(&enabled.expression())));
        }
        let mut right = enabled.clone();
        if can_fail && needed && output.is_none() {
            if eno.is_some() {
                self.problem(span, "ENO of this box is wired and gives the power behind it, too");
            }
            let fresh = self.temporary();
            arguments.push(format!("ENO => {fresh}"));
            right = Power::of_variable(&fresh);
        } else if let Some(eno) = eno.filter(|_| can_fail || enabled_by_pin) {
            arguments.extend(self.words().argument(eno));
        }
        let instance = self.words().reference(&call.instance);
        let mut statement = format!("{instance}({});", arguments.join(", "));
        if enabled_by_pin || can_fail {
            self.line(&statement);
        } else {
            if let Some(Wire::Output(target)) = eno.map(|eno| &eno.wire) {
                statement.push_str(&format!(" {} := TRUE;", self.words().reference(target)));
            }
            let otherwise = self.words().not_enabled(call).filter(|_| eno.is_some());
            self.line_either(&enabled, &statement, otherwise.as_deref());
        }
        match output {
            None => right,
            Some(output) => {
                let mut reference: Reference = call.instance.clone();
                reference.steps.push(Step::Member(crate::ladder::Name::new(output, Span::default())));
                Power::While(Expression { kind: ExpressionKind::Read(reference), span: Span::default() })
            }
        }
    }

    /// Whether ENO goes where another output goes, too: which of the two is written last cannot be said.
    pub(super) fn writes_beside_eno(&self, call: &BlockCall) -> bool {
        let target = |argument: &Argument| match &argument.wire {
            Wire::Output(target) => Some(key(&self.words().reference(target))),
            _ => None,
        };
        let Some(eno) = pin(call, "ENO").and_then(target) else { return false };
        call.arguments.iter().filter(|argument| target(argument).as_ref() == Some(&eno)).count() > 1
    }

    /// Whether it can be seen that the inputs of a call are set although it is not enabled: something reads one, or another call
    /// leaves it as it is. Where nobody can see it, an IF around the call says the same to more compilers.
    fn keeps_inputs(&self, call: &BlockCall, fed: Option<&str>) -> bool {
        let Root::Name(instance) = &call.instance.root else { return true };
        let Some(mentions) = self.mentions.get(&instance.key()) else { return false };
        let mut pins = call.arguments.iter().map(|argument| argument.pin.key()).chain(fed.map(key));
        mentions.count > 1 || pins.any(|pin| mentions.members.contains(&pin))
    }

    /// The arguments of a block in words, in their order, with the power on the left and on EN when all are computed.
    fn arguments(
        &mut self,
        call: &BlockCall,
        left: Power,
        feeds: Option<&str>,
        has_enable: bool,
        arguments: &mut Vec<String>,
    ) -> (Power, Power) {
        let mut enable = Power::Always;
        let mut values = Vec::new();
        let (left, circuits) = self.keeping(left, |rungs| {
            let mut circuits = 0;
            for argument in &call.arguments {
                if let Wire::Circuit(circuit) = &argument.wire {
                    let is_first = feeds.is_none() && circuits == 0;
                    let is_late = !values.is_empty() || !is_first && rungs.reaches(circuit, &call.instance);
                    if !conducts(circuit) && is_late {
                        rungs.problem(
                            argument.span,
                            "what this circuit does would come before the pins that stand before it",
                        );
                    }
                    let power = rungs.circuit(circuit, Power::Always, true);
                    let power = rungs.settled(power);
                    rungs.live_push(power);
                    circuits += 1;
                } else {
                    values.push(argument);
                }
            }
            rungs.live_take(circuits)
        });
        let mut circuits = circuits.into_iter();
        if let Some(input) = feeds {
            arguments.push(format!("{input} := {}", self.words().expression(&left.expression())));
        }
        for argument in &call.arguments {
            let is_enable = !has_enable && argument.pin.text.eq_ignore_ascii_case("EN");
            let power = match &argument.wire {
                Wire::Circuit(_) => circuits.next(),
                Wire::Value(value) if is_enable => Some(Power::of(value.clone())),
                _ => None,
            };
            match power {
                Some(power) if is_enable => enable = power,
                Some(power) => {
                    let pin = self.names.spell(&argument.pin.text).into_owned();
                    arguments.push(format!("{pin} := {}", self.words().expression(&power.expression())));
                }
                None if !has_enable && argument.pin.text.eq_ignore_ascii_case("ENO") => {}
                None => arguments.extend(self.words().argument(argument)),
            }
        }
        (left, enable)
    }

    /// The power of a circuit at a pin, in a variable if it depends on a computed index: an index in a circuit is not one at the pin,
    /// which ENO would tell of.
    fn settled(&mut self, power: Power) -> Power {
        if !is_computed_power(&power) {
            return power;
        }
        let variable = self.temporary();
        let value = self.words().expression(&power.expression());
        self.line(&format!("{variable} := {value};"));
        Power::of_variable(&variable)
    }

    /// Whether a circuit may write the inputs of an instance.
    fn reaches(&self, circuit: &Circuit, instance: &Reference) -> bool {
        let Root::Name(name) = &instance.root else { return true };
        let key = name.key();
        let is_shared = self.program.globals.iter().any(|global| global.name.key() == key)
            || self.unit.variables.iter().any(|one| one.name.key() == key && one.class == VariableClass::InOut);
        let mut found = is_shared;
        uses::circuit(circuit, &mut |mentioned| found |= uses::root_key(mentioned).is_some_and(|root| root == key));
        found
    }

    /// A box of a function, which is enabled by the power on its left.
    fn function_box(&mut self, call: &BlockCall, left: Power, needed: bool) -> Power {
        let mut call = call.clone();
        let mut enable = Power::Always;
        let mut rest = Vec::new();
        let mut left = left;
        for mut argument in std::mem::take(&mut call.arguments) {
            if let Wire::Circuit(circuit) = &argument.wire {
                if !conducts(circuit) && !rest.is_empty() {
                    self.problem(
                        argument.span,
                        "what this circuit does would come before the pins that stand before it",
                    );
                }
                let (kept, power) = self.keeping(left, |rungs| {
                    let power = rungs.circuit(circuit, Power::Always, true);
                    rungs.settled(power)
                });
                left = kept;
                argument.wire = Wire::Value(power.expression());
            }
            match &argument.wire {
                Wire::Value(value) if argument.pin.text.eq_ignore_ascii_case("EN") => enable = Power::of(value.clone()),
                _ => rest.push(argument),
            }
        }
        let enable_fails = is_computed_power(&enable);
        call.arguments = rest;
        let enabled = self.and(left, enable);
        let name = call.instance.as_name().cloned();
        let unit = name.as_ref().and_then(|name| self.function(name));
        let result_of =
            |pin: &str| pin.eq_ignore_ascii_case("OUT") || name.as_ref().is_some_and(|name| name.key() == key(pin));
        let chosen = call.power_output.clone().filter(|output| !output.text.eq_ignore_ascii_case("ENO"));
        let has_result =
            call.arguments.iter().any(|one| matches!(one.wire, Wire::Output(_)) && result_of(&one.pin.text));
        if let Some(eno) = pin(&call, "ENO")
            && (enable_fails || is_computed(eno) && !matches!(enabled, Power::Always))
        {
            self.problem(eno.span, ENO_OF_INDEX);
        }
        if let Some(output) = chosen.filter(|_| needed) {
            return self.chosen_output(call, &output, result_of(&output.text), enabled);
        }
        if let Some(unit) = unit
            && let UnitKind::Function { result: Some(ty) } = &unit.kind
            && !has_result
        {
            // A result has to go somewhere.
            let ty = self.words().type_reference(ty);
            let unused = self.fresh("unused", &ty);
            call.arguments.push(wired("OUT", &unused));
        }
        let mut can_fail = is_division(&call);
        uses::call(&call, &mut |mentioned| can_fail |= uses::has_computed_index(mentioned));
        if needed && enable_fails {
            self.problem(call.instance.span, ENO_OF_INDEX);
        }
        if unit.is_none() && !has_result {
            return self.without_result(&call, enabled, needed, can_fail);
        }
        let is_move = name.as_ref().is_some_and(|name| name.key() == "move");
        if let (true, Some(Wire::Value(value)), Some(Wire::Output(target))) =
            (is_move && can_fail, pin(&call, "IN").map(|one| &one.wire), pin(&call, "OUT").map(|one| &one.wire))
            && (needed || pin(&call, "ENO").is_some())
            && !self.moves_one_value(target, value)
        {
            self.problem(call.instance.span, ENO_OF_INDEX);
        }
        let mut right = enabled.clone();
        if needed && can_fail && pin(&call, "ENO").is_none() {
            self.spill(&Change::All);
            let eno = self.temporary();
            self.line(&format!("{eno} := FALSE;"));
            call.arguments.push(wired("ENO", &eno));
            right = Power::of_variable(&eno);
        } else if needed {
            right = self.held(right, &Change::All);
            if can_fail && pin(&call, "ENO").is_some() {
                let span = call.instance.span;
                self.problem(span, "ENO of this box is wired and gives the power behind it, too");
            }
        }
        let enabled = if needed && !can_fail { right.clone() } else { enabled };
        self.spill(&Change::All);
        let statement = format!("{};", self.words().function_box(&call));
        let otherwise = self.words().not_enabled(&call);
        self.line_either(&enabled, &statement, otherwise.as_deref());
        right
    }

    /// A box of a standard function whose result goes nowhere: of what it does, ENO is left.
    fn without_result(&mut self, call: &BlockCall, enabled: Power, needed: bool, can_fail: bool) -> Power {
        let eno = pin(call, "ENO");
        let mut acts = can_fail && (needed || eno.is_some());
        uses::call(call, &mut |mentioned| {
            acts |= uses::has_computed_index(mentioned)
                || matches!(mentioned, uses::Use::Function(name) if Function::from_name(&name.text).is_none());
        });
        if acts {
            self.problem(call.instance.span, "the result of this box goes nowhere, though computing it does something");
        }
        let right = if needed { self.held(enabled, &Change::All) } else { enabled };
        self.spill(&Change::All);
        if let Some(Wire::Output(target)) = eno.map(|eno| &eno.wire) {
            let value = self.words().expression(&right.expression());
            let statement = format!("{} := {value};", self.words().reference(target));
            self.line(&statement);
        }
        right
    }

    /// A box of a function of which an output gives the power on the right: FALSE while it is not enabled.
    fn chosen_output(
        &mut self,
        mut call: BlockCall,
        output: &crate::ladder::Name,
        is_result: bool,
        enabled: Power,
    ) -> Power {
        self.spill(&Change::All);
        let enabled = self.held(enabled, &Change::All);
        let right = self.temporary();
        self.line(&format!("{right} := FALSE;"));
        let wired_before = call.arguments.iter().position(|one| {
            matches!(one.wire, Wire::Output(_))
                && (one.pin.key() == output.key() || is_result && one.pin.text.eq_ignore_ascii_case("OUT"))
        });
        let taken = wired_before.map(|index| call.arguments.remove(index));
        call.arguments.push(wired(if is_result { "OUT" } else { &output.text }, &right));
        let mut statements = vec![format!("{};", self.words().function_box(&call))];
        if let Some(argument) = taken
            && let Wire::Output(target) = &argument.wire
        {
            if is_computed(&argument)
                && let Some(eno) = pin(&call, "ENO")
            {
                self.problem(eno.span, ENO_OF_INDEX);
            }
            statements.push(format!("{} := {right};", self.words().reference(target)));
        }
        let otherwise = self.words().not_enabled(&call);
        self.line_either(&enabled, &statements.join(" "), otherwise.as_deref());
        Power::of_variable(&right)
    }

    /// The pins of a block through which power flows; `None` for a block that structured text has not.
    fn power_pins(&self, call: &BlockCall) -> Option<PowerPins> {
        let name = self.block_type(call)?;
        if let Some(unit) = self.program.units.iter().find(|unit| unit.name.key() == key(&name)) {
            let is_bool = |ty: &Option<crate::ladder::TypeReference>| {
                ty.as_ref().is_none_or(|ty| {
                    ty.dimensions.is_empty() && Elementary::from_name(&ty.name.text) == Some(Elementary::Bool)
                })
            };
            let first = |class: VariableClass| {
                let pin = unit.variables.iter().find(|one| one.class == class && is_bool(&one.ty));
                pin.map(|pin| pin.name.text.to_string())
            };
            let has_enable = unit.variables.iter().any(|one| one.name.key() == "en");
            return Some(PowerPins {
                input: first(VariableClass::Input),
                output: first(VariableClass::Output),
                has_enable,
            });
        }
        let block = StandardBlock::from_name(&name).filter(|block| is_iec(*block))?;
        let first = |pins: &[crate::ladder::library::Pin]| {
            pins.iter().find(|pin| pin.ty == Elementary::Bool).map(|pin| pin.name.to_owned())
        };
        Some(PowerPins { input: first(block.inputs()), output: first(block.outputs()), has_enable: false })
    }
}

/// Whether a box fails where an operand is zero.
fn is_division(call: &BlockCall) -> bool {
    let function = call.instance.as_name().and_then(|name| Function::from_name(&name.text));
    matches!(function, Some(Function::Standard(StandardFunction::Divide | StandardFunction::Modulo)))
}

fn wired(pin: &str, variable: &str) -> Argument {
    let name = |text: &str| crate::ladder::Name::new(text, Span::default());
    Argument { pin: name(pin), wire: Wire::Output(Reference::of_name(name(variable))), span: Span::default() }
}
