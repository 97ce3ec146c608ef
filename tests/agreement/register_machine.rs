//! The register machine where a step table would be too long, on every engine: the ends of the ranges, every unit that a
//! timer counts, the longest chains, and registers chosen while the program runs.

use rung::check::Checked;
use rung::elementary::{Elementary, Value};
use rung::frontend;
use rung::source::Source;

use crate::support::rig::{Rig, checked};

fn program(text: &str) -> Checked {
    let parsed = frontend::parse(&Source::new("registers", text));
    assert_eq!(parsed.diagnostics, []);
    checked(&parsed.program).unwrap_or_else(|problems| panic!("{problems}"))
}

fn scan(rig: &mut Rig, now: i64) {
    rig.scan(now).unwrap_or_else(|difference| panic!("at {now} ns: {difference:?}"));
}

fn on(rig: &Rig, name: &str) -> bool {
    rig.oracle.get(name).is_true()
}

fn word(rig: &Rig, name: &str) -> u64 {
    let value = rig.oracle.get(name);
    assert_eq!(value.ty(), Elementary::Word, "{name}");
    value.bits()
}

/// Two scans, in the first of which `pulse` is on.
fn pulse(rig: &mut Rig) {
    for on in [true, false] {
        rig.set("pulse", Value::bool(on));
        scan(rig, 0);
    }
}

#[test]
fn counters_and_drums_stop_at_the_ends_of_their_ranges() {
    let checked = program(
        "program ends
        input pulse
        input far : WORD := 65535
        rung
          pulse up:UC(PRESET := far)
        rung
          pulse down:DC(PRESET := far)
        rung
          pulse drum:DR(PRESET := far, TAP1 := 2047, TAP2 := 2048)",
    );
    let mut rig = Rig::new(&checked).expect("it runs");
    for pulses in 1..=10_001 {
        pulse(&mut rig);
        let (counted, stepped) = (pulses.min(9999), pulses.min(2047));
        assert_eq!((word(&rig, "up.VALUE"), on(&rig, "up.Q")), (counted, pulses >= 9999));
        assert_eq!((word(&rig, "down.VALUE"), on(&rig, "down.Q")), (9999 - counted, pulses >= 9999));
        let drum = ["drum.Q", "drum.Q1", "drum.Q2"].map(|coil| on(&rig, coil));
        assert_eq!((word(&rig, "drum.VALUE"), drum), (stepped, [pulses >= 2047, pulses >= 2047, false]));
    }
}

#[test]
fn timers_show_each_unit_from_the_nanosecond_that_completes_it() {
    let checked = program(
        "program units
        rung
          TRUE tenths:TT(KIND := 1, PRESET := 9999)
        rung
          TRUE seconds:TS(KIND := 1, PRESET := 9999)",
    );
    let mut rig = Rig::new(&checked).expect("it runs");
    scan(&mut rig, 0);
    for (timer, unit, first) in [("tenths.VALUE", 100_000_000, 1), ("seconds.VALUE", 1_000_000_000, 1000)] {
        for units in first..=9999_u32 {
            let complete = i64::from(units) * unit;
            scan(&mut rig, complete - 1);
            assert_eq!(word(&rig, timer), u64::from(units - 1));
            scan(&mut rig, complete);
            assert_eq!(word(&rig, timer), u64::from(units));
        }
    }
}

#[test]
fn a_bit_goes_all_the_way_through_the_longest_chains() {
    let checked = program(
        "program chains
        input pulse, data
        output oreg : array [0..31] of WORD
        var hreg : array [0..31] of WORD
        rung
          pulse up:SHIFTL(DATA := data, REGISTER := oreg[0], LENGTH := 32)
        rung
          pulse down:SHIFTR(DATA := data, REGISTER := hreg[0], LENGTH := 32)",
    );
    let mut rig = Rig::new(&checked).expect("it runs");
    rig.set("data", Value::bool(true));
    for place in 0..512 {
        pulse(&mut rig);
        rig.set("data", Value::bool(false));
        for register in 0..32 {
            let bit = if register == place / 16 { 1 << (place % 16) } else { 0 };
            assert_eq!(word(&rig, &format!("oreg[{register}]")), bit, "after {place} places");
            let mirrored = if 31 - register == place / 16 { 0x8000 >> (place % 16) } else { 0 };
            assert_eq!(word(&rig, &format!("hreg[{register}]")), mirrored, "after {place} places");
        }
        assert_eq!([on(&rig, "up.Q"), on(&rig, "down.Q")], [false, false]);
    }
    pulse(&mut rig);
    assert_eq!([on(&rig, "up.Q"), on(&rig, "down.Q")], [true, true]);
    pulse(&mut rig);
    assert_eq!([on(&rig, "up.Q"), on(&rig, "down.Q")], [false, false]);
}

#[test]
fn registers_beyond_the_array_read_0_and_are_not_written() {
    let checked = program(
        "program beyond
        input pulse, data
        input at : INT
        input bit : USINT
        var hreg : array [0..3] of WORD := [16#1234, 16#8001, 16#FFFF, 16#C003]
        rung
          pulse up:SHIFTL(DATA := data, COUNT := bit, REGISTER := hreg[at], LENGTH := 3)
        rung
          pulse down:SHIFTR(DATA := data, COUNT := bit, REGISTER := hreg[at], LENGTH := 2)
        rung
          pulse setting:BS(REGISTER := hreg[at], BIT := bit)
        rung
          /pulse clearing:BC(REGISTER := hreg[at], BIT := bit)",
    );
    let mut rig = Rig::new(&checked).expect("it runs");
    for (at, bit) in (-5_i64..=9).flat_map(|at| (0_u64..=20).map(move |bit| (at, bit))) {
        rig.set("at", Value::from_bits(Elementary::Int, at.cast_unsigned()));
        rig.set("bit", Value::from_bits(Elementary::Usint, bit));
        rig.set("data", Value::bool((bit + at.unsigned_abs()) % 3 == 0));
        let before: Vec<u64> = (0..4).map(|register| word(&rig, &format!("hreg[{register}]"))).collect();
        pulse(&mut rig);
        let after: Vec<u64> = (0..4).map(|register| word(&rig, &format!("hreg[{register}]"))).collect();
        let first = usize::try_from(at.clamp(0, 4)).expect("from 0 to 4");
        assert_eq!(before[..first], after[..first], "what stands before hreg[{at}] is not written");
        if at > 3 {
            assert_eq!([on(&rig, "up.Q"), on(&rig, "setting.Q")], [false, false]);
        }
    }
}
