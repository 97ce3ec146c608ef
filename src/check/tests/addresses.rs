//! Addresses: what they declare, what shares storage, what overlaps.

use super::build::*;
use super::*;
use crate::check::{Type, VariableId};
use crate::elementary::Elementary;
use crate::ladder::{BinaryOperator, Variable, VariableClass};

/// A program that reads all of its variables.
fn using(variables: Vec<Variable>) -> Program {
    let conditions = variables.iter().map(|variable| {
        let name = &variable.name.text;
        when(binary(read(name), BinaryOperator::Equal, read(name)))
    });
    let elements = conditions.chain([coil("_used")]).collect();
    program([vec![memory("_used", "BOOL")], variables].concat(), vec![rung(elements)])
}

#[test]
fn faults_of_addresses_point_at_the_address() {
    let two = |a: Variable, b: Variable| using(vec![a, b]);
    table(vec![
        (using(vec![input("a").at("%QX0.0")]), Code::AddressConflict, "%QX0.0"),
        (using(vec![output("a").at("%MX0.0")]), Code::AddressConflict, "%MX0.0"),
        (using(vec![constant("a", "BOOL", truth(true)).at("%MX0.0")]), Code::AddressConflict, "%MX0.0"),
        (using(vec![input("a").at("%IX0.8")]), Code::OutOfRange, "%IX0.8"),
        (using(vec![input("a").at("%IW0")]), Code::TypeMismatch, "%IW0"),
        (using(vec![output("a").typed("INT").at("%QX0.0")]), Code::TypeMismatch, "%QX0.0"),
        (two(memory("a", "BOOL").at("%QX0.3"), memory("b", "BYTE").at("%QB0")), Code::AddressConflict, "%QB0"),
        (two(memory("a", "BYTE").at("%MB5"), memory("b", "WORD").at("%MW2")), Code::AddressConflict, "%MW2"),
        (two(memory("a", "INT").at("%MW2"), memory("b", "WORD").at("%MW2")), Code::AddressConflict, "%MW2"),
        (two(memory("a", "INT").at("%MW2"), memory("b", "INT").at("%MW2").retained()), Code::AddressConflict, "%MW2"),
        (
            two(memory("a", "INT").at("%MW2").starting(int(1)), memory("b", "INT").at("%MW2").starting(int(2))),
            Code::AddressConflict,
            "b",
        ),
        (program(vec![output("q")], vec![rung(vec![open("%IX0.8"), coil("q")])]), Code::OutOfRange, "%IX0.8"),
        (
            program(vec![output("a").at("%QB0").typed("BYTE")], vec![rung(vec![coil("%QX0.1"), assign("a", int(1))])]),
            Code::AddressConflict,
            "%QX0.1",
        ),
        (using(vec![input("a").retained()]), Code::RetainedInput, "a"),
        (using(vec![memory("a", "BOOL").at("%IX0.0").retained()]), Code::RetainedInput, "a"),
    ]);
}

#[test]
fn every_address_within_a_wider_one_overlaps_it() {
    let outer = memory("a", "LWORD").at("%ML0");
    let inner = ["%MX0.0", "%MB3", "%MW3", "%MD1", "%MX7.7"];
    let types = ["BOOL", "BYTE", "WORD", "DWORD", "BOOL"];
    let variables =
        inner.iter().zip(types).enumerate().map(|(at, (address, ty))| memory(&format!("b{at}"), ty).at(address));
    let found = findings(&using([vec![outer], variables.collect()].concat()));
    assert_eq!(found, inner.map(|address| (Code::AddressConflict, address.to_owned())));
}

#[test]
fn neighbours_and_other_areas_do_not_overlap() {
    let bytes = ["%MB0", "%MB3", "%QB0", "%IB1"].map(|address| memory(&address[1..], "BYTE").at(address));
    let words = ["%MW2", "%QW1", "%IW2.1.0"].map(|address| memory(&address[1..].replace('.', "_"), "WORD").at(address));
    clean(&using([bytes.to_vec(), words.to_vec()].concat()));
}

#[test]
fn a_variable_at_an_address_has_the_class_of_its_area() {
    let checked = clean(&using(vec![
        memory("a", "INT").at("%IW0"),
        memory("b", "INT").at("%QW0"),
        memory("c", "INT").at("%MW0"),
    ]));
    let classes: Vec<_> = checked.variables()[1..].iter().map(|variable| variable.class).collect();
    assert_eq!(classes, [VariableClass::Input, VariableClass::Output, VariableClass::Memory]);
}

#[test]
fn variables_at_one_address_share_storage_and_the_initial_value() {
    let checked = clean(&using(vec![
        memory("a", "INT").at("%MW2"),
        memory("b", "INT").at("%MW2").starting(int(7)),
        memory("c", "INT").at("%MW2"),
    ]));
    let found: Vec<_> = checked.variables()[1..]
        .iter()
        .map(|variable| (variable.shares, variable.initial.value(Elementary::Int).as_integer()))
        .collect();
    assert_eq!(found, [(None, Some(7)), (Some(VariableId(1)), Some(7)), (Some(VariableId(1)), Some(7))]);
}

#[test]
fn a_bit_counted_from_the_start_is_that_bit_of_its_byte() {
    let checked = clean(&using(vec![memory("a", "BOOL").at("%MX1.1"), memory("b", "BOOL").at("%MX9")]));
    assert_eq!(checked.variables()[2].shares, Some(VariableId(1)));
}

#[test]
fn an_address_in_a_rung_is_the_variable_declared_there() {
    let checked =
        clean(&program(vec![output("n").typed("INT").at("%QW1")], vec![rung(vec![assign("%QW1", negate(int(1)))])]));
    assert_eq!(checked.variables().len(), 1);
}

#[test]
fn an_address_that_nothing_declares_is_a_variable_of_its_area_and_width() {
    let rungs = vec![
        rung(vec![open("%IX0.3"), coil("%QX1.0"), assign("%MW4", int(1))]),
        rung(vec![open("%IX0.3"), assign("%ML9", int(1))]),
    ];
    let checked = clean(&program(vec![], rungs));
    let found: Vec<_> =
        checked.variables().iter().map(|variable| (variable.name.as_str(), variable.class, variable.ty)).collect();
    let expected = [
        ("%IX0.3", VariableClass::Input, Type::Elementary(Elementary::Bool)),
        ("%QX1.0", VariableClass::Output, Type::Elementary(Elementary::Bool)),
        ("%MW4", VariableClass::Memory, Type::Elementary(Elementary::Word)),
        ("%ML9", VariableClass::Memory, Type::Elementary(Elementary::Lword)),
    ];
    assert_eq!(found, expected);
}
