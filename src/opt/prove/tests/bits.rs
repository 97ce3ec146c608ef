//! That operations mean bit by bit what they mean executed, and what the graph makes of them.

use super::super::graph::{Graph, Literal, Source};
use super::super::scan::{Turn, execute};
use super::super::space::Space;
use super::super::witness::Machine;
use crate::logic::{Op, SlotId, random};

#[test]
fn what_random_programs_store_is_on_samples_what_execution_stores() {
    // Of long arrays the samples are made up.
    let is_plain = |op: Op, counts: &[u32]| !matches!(op, Op::LoadIndexed(array, _) if counts[array.index()] > 64);
    for seed in 0..400 {
        let program = random::program(seed);
        let counts: Vec<u32> = program.layout.arrays().iter().map(|array| array.count).collect();
        if !program.instructions.iter().all(|instruction| is_plain(instruction.op, &counts)) {
            continue;
        }
        let machine = Machine::new(&program.layout);
        for sections in program.chunks() {
            let mut space = Space::new(&program.layout);
            let stored = execute(&mut space, &program, sections.clone(), Turn::First).expect("a small program");
            // Taken apart before samples are looked at, since every variable is part of their images.
            stored.values().for_each(|(held, _)| drop(space.bits(*held)));
            for (column, sample) in [(0, 0), (0, 63), (1, 7), (2, 30), (3, 33)] {
                let (image, now) = space.sample(column, sample);
                let left = machine.run(&program, sections.clone(), &image, now);
                for (slot, (held, _)) in &stored {
                    let bits = space.bits(*held);
                    let value = bits.iter().enumerate().fold(0, |value, (bit, literal)| {
                        value | (space.graph.sample(column, *literal) >> sample & 1) << bit
                    });
                    let slot = program.layout.slot(*slot);
                    let expected = slot.read(&left);
                    let actual = crate::elementary::Value::from_bits(slot.ty, value);
                    assert_eq!(actual, expected, "`{}` of seed {seed}", slot.name);
                }
            }
        }
    }
}

/// A graph with some variables, whose samples are all their values together.
fn variables<const COUNT: usize>() -> (Graph, [Literal; COUNT]) {
    let mut graph = Graph::new(1);
    let periods = [0xAAAA_AAAA_AAAA_AAAA, 0xCCCC_CCCC_CCCC_CCCC, 0xF0F0_F0F0_F0F0_F0F0, 0xFF00_FF00_FF00_FF00];
    let literals = std::array::from_fn(|index| graph.variable(Source::Slot(SlotId(0), 0), |_| periods[index]));
    (graph, literals)
}

#[test]
fn what_is_equal_one_level_deep_is_one_node() {
    let (mut graph, [a, b, c]) = variables();
    let both = graph.and(a, b);
    let not_both = !both;
    let without = graph.and(a, !b);
    let cases = [
        (graph.and(b, a), both),
        (graph.and(a, !a), Literal::FALSE),
        (graph.and(a, Literal::TRUE), a),
        (graph.and(a, Literal::FALSE), Literal::FALSE),
        (graph.and(both, a), both),
        (graph.and(!b, both), Literal::FALSE),
        (graph.and(not_both, !a), !a),
        (graph.and(not_both, a), without),
        (graph.or(a, both), a),
        (graph.xor(a, b), !graph.xor(!a, b)),
        (graph.select(c, a, a), a),
        (graph.select(!c, b, a), graph.select(c, a, b)),
    ];
    for (place, (actual, expected)) in cases.into_iter().enumerate() {
        assert_eq!(actual, expected, "case {place}");
    }
    let (both, or, xor) = (graph.and(a, c), graph.or(a, c), graph.xor(a, c));
    let [a, c, both, or, xor] = [a, c, both, or, xor].map(|literal| graph.sample(0, literal));
    assert_eq!((both, or, xor), (a & c, a | c, a ^ c));
}

#[test]
fn what_was_merged_stands_for_each_other_either_way_round() {
    let (mut graph, [a, b, c]) = variables();
    let with_b = graph.and(b, c);
    graph.merge(b, !a);
    assert_eq!((graph.find(b), graph.find(!b)), (!a, a));
    let with_a = graph.and(!a, c);
    assert_eq!(graph.and(b, c), with_a);
    assert_eq!(graph.again(with_a.node()), None);
    assert_eq!(graph.again(with_b.node()), None, "the other one is later");
    graph.merge(c, Literal::FALSE);
    assert_eq!(graph.again(with_b.node()), Some(Literal::FALSE));
}
