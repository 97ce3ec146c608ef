//! The walk over a chunk's instructions: which Cranelift value holds which value of logic, and when loads are made.
//!
//! A load is made where its value is used, so that it becomes part of the instruction that uses it, and at the
//! latest before its slot is stored. All else is made in order.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Function, InstBuilder, InstructionData, MemFlagsData, Opcode, SigRef, Type, Value, types};
use cranelift_codegen::isa::TargetIsa;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use super::place::{self, Stored};
use super::{BASES, Target, location_of};
use crate::elementary::Elementary;
use crate::logic::{Array, Binary, Compare, Instruction, Op, Program, SlotId, Unary, ValueId};

/// What was learnt of a chunk on the way.
pub(super) struct Built {
    /// The offsets of the pointers that it takes.
    pub(super) bases: [u32; BASES],
    /// How many of them are used.
    pub(super) used_bases: usize,
    /// The most values that wait for a use at one time.
    pub(super) alive: usize,
}

/// Fills an empty function with a chunk.
pub(super) fn chunk(
    program: &Program,
    sections: Range<usize>,
    isa: &dyn TargetIsa,
    target: Target,
    function: &mut Function,
    context: &mut FunctionBuilderContext,
) -> Built {
    let (bases, used_bases) = place::bases(program, sections.clone(), target);
    let mut builder = FunctionBuilder::new(function, context);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    builder.seal_block(block);
    let first = if sections.is_empty() { 0 } else { program.section_range(sections.start).start };
    let end = if sections.is_empty() { 0 } else { program.section_range(sections.end - 1).end };
    let (mut uses, mut only_chooses) = (vec![0; end - first], vec![true; end - first]);
    for instruction in &program.instructions[first..end] {
        for (place, operand) in instruction.op.operands().enumerate() {
            uses[operand.index() - first] += 1;
            only_chooses[operand.index() - first] &= place == 0 && matches!(instruction.op, Op::Select(..));
        }
    }
    let params = builder.block_params(block).to_vec();
    let now = params[1];
    let mut pointers = [(0, params[0]); BASES];
    for (index, pointer) in pointers.iter_mut().enumerate() {
        // What is not used stays away, so that nothing is reached from it.
        let index = if index < used_bases { index } else { 0 };
        *pointer = (bases[index], params[if index == 0 { 0 } else { index + 1 }]);
    }
    let mut lowering = Lowering {
        program,
        first,
        target,
        builder,
        now,
        pointers,
        helpers: params.get(BASES + 1).copied(),
        helper_signature: None,
        copy_signature: None,
        held: vec![None; end - first],
        uses,
        only_chooses,
        constants: HashMap::new(),
        alive: 0,
        most_alive: 0,
        pending: BTreeMap::new(),
        stored: Stored::before(program, sections.start),
        section: sections.start,
    };
    for section in sections {
        lowering.section = section;
        lowering.constants.clear();
        lowering.builder.set_srcloc(location_of(section));
        for index in program.section_range(section) {
            lowering.instruction(index, program.instructions[index]);
        }
    }
    lowering.builder.ins().return_(&[]);
    lowering.builder.finalize(isa.frontend_config());
    Built { bases, used_bases, alive: lowering.most_alive }
}

pub(super) struct Lowering<'a, 'f> {
    pub(super) program: &'a Program,
    /// The chunk's first instruction.
    first: usize,
    pub(super) target: Target,
    pub(super) builder: FunctionBuilder<'f>,
    now: Value,
    /// Offsets and values of the pointers.
    pointers: [(u32, Value); BASES],
    /// The table of helpers, where the chunk calls any.
    pub(super) helpers: Option<Value>,
    /// What helpers take and give, once one is called.
    pub(super) helper_signature: Option<SigRef>,
    /// The same of the one that copies.
    pub(super) copy_signature: Option<SigRef>,
    /// By instruction of the chunk: what holds its value, once made.
    held: Vec<Option<Value>>,
    /// By instruction of the chunk: uses that are still to come.
    uses: Vec<u32>,
    /// By instruction of the chunk: whether it is used for nothing but as the condition of selects.
    only_chooses: Vec<bool>,
    /// Constants that the section has made and may use again.
    constants: HashMap<(Type, u64), Value>,
    /// How many values are held that have a use to come, now and at most.
    alive: usize,
    most_alive: usize,
    /// Loads of a slot since it was last stored.
    pending: BTreeMap<SlotId, Vec<ValueId>>,
    stored: Stored,
    section: usize,
}

impl Lowering<'_, '_> {
    fn instruction(&mut self, index: usize, Instruction { ty, op }: Instruction) {
        let id = ValueId(u32::try_from(index).unwrap_or(u32::MAX));
        if self.uses[index - self.first] == 0 && op.has_value() {
            return;
        }
        let value = match op {
            // Made where they are used.
            Op::Constant(_) => return,
            Op::Load(slot) => {
                self.pending.entry(slot).or_default().push(id);
                return;
            }
            Op::Unary(Unary::Not, a) if ty == Elementary::Bool && self.is_late_not(id, a) => return,
            Op::Now => self.now,
            Op::Store(slot, a) => return self.store(slot, a),
            Op::Unary(op, a) if ty.is_real() => self.real_unary(op, ty, a),
            Op::Unary(op, a) => self.integer_unary(op, ty, a),
            Op::Binary(Binary::And, a, b) if self.is_test(index - self.first, a, b) => self.byte_test(a, b),
            Op::Binary(op, a, b) if ty == Elementary::Bool => self.bool_binary(op, a, b),
            Op::Binary(op, a, b) if ty.is_real() => self.real_binary(op, ty, a, b),
            Op::Binary(op, a, b) => self.integer_binary(op, ty, a, b),
            Op::Compare(op, a, b) => self.compare(op, a, b),
            Op::Select(condition, a, b) => {
                // By an inverse it is the other one.
                let (condition, a, b) = self.late_not(condition).map_or((condition, a, b), |inner| (inner, b, a));
                let condition = self.flag(condition);
                let (a, b) = self.alike(a, b);
                self.choose(condition, a, b)
            }
            Op::Convert(a) => self.convert(a, ty),
            Op::Reinterpret(a) => self.reinterpret(a, ty),
            Op::Call(helper, a, b) => self.call(helper, ty, a, b),
            Op::LoadIndexed(array, index) => self.load_indexed(array, index),
            Op::StoreIndexed(array, index, a) => return self.store_indexed(array, index, a),
            Op::CopyArray(to, from, condition) => return self.copy_array(to, from, condition),
        };
        // What becomes part of the instruction that tests it must not be put into a register.
        let place = index - self.first;
        let joins =
            matches!(op, Op::Binary(..) | Op::Select(..)) && !(ty == Elementary::Bool && self.only_chooses[place]);
        let value = if joins && self.uses[place] > 1 { self.settled(value) } else { value };
        self.hold(place, value);
    }

    /// Whether an AND is nothing but the condition of selects, and a single instruction sets the flags by it.
    fn is_test(&self, place: usize, a: ValueId, b: ValueId) -> bool {
        let inverts = self.late_not(a).is_some() || self.late_not(b).is_some();
        self.target.wide_loads && self.only_chooses[place] && self.type_of(a) == Elementary::Bool && !inverts
    }

    /// The AND of two BOOLs in 8 bits, all of which count.
    fn byte_test(&mut self, a: ValueId, b: ValueId) -> Value {
        let (a, b) = (self.exact_value(a), self.exact_value(b));
        let (a, b) = (self.byte_of(a), self.byte_of(b));
        self.builder.ins().band(a, b)
    }

    fn hold(&mut self, place: usize, value: Value) {
        self.held[place] = Some(value);
        self.alive += usize::from(self.uses[place] > 0);
        self.most_alive = self.most_alive.max(self.alive);
    }

    /// The same value, but such that loads below it can still become part of the instructions that use them, though it
    /// is used more than once: Cranelift gives up on all that such a value is made of, up to the parameters of a block.
    /// The jump to the block that follows makes no code.
    fn settled(&mut self, value: Value) -> Value {
        let block = self.builder.create_block();
        let ty = self.builder.func.dfg.value_type(value);
        let settled = self.builder.append_block_param(block, ty);
        self.builder.ins().jump(block, &[value.into()]);
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
        settled
    }

    pub(super) fn type_of(&self, id: ValueId) -> Elementary {
        self.program.instructions[id.index()].ty
    }

    /// The constant that a value is.
    pub(super) fn constant(&self, id: ValueId) -> Option<u64> {
        match self.program.instructions[id.index()].op {
            Op::Constant(bits) => Some(bits),
            Op::Now
            | Op::Load(_)
            | Op::Store(..)
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => None,
        }
    }

    /// Whether a NOT is left to its only use. Not so that of a NOT, or a long chain of them would nest as deep.
    fn is_late_not(&self, id: ValueId, operand: ValueId) -> bool {
        let inner = self.program.instructions[operand.index()].op;
        self.uses[id.index() - self.first] == 1 && !matches!(inner, Op::Unary(Unary::Not, _))
    }

    /// Uses a value: a BOOL in either of its forms.
    pub(super) fn value(&mut self, id: ValueId) -> Value {
        self.value_by(id, Self::load)
    }

    /// The same, but a load that is made for it reads its own byte only, into a register.
    pub(super) fn exact_value(&mut self, id: ValueId) -> Value {
        self.value_by(id, Self::exact_load)
    }

    fn value_by(&mut self, id: ValueId, load: impl FnOnce(&mut Self, SlotId) -> (Value, bool)) -> Value {
        let place = id.index() - self.first;
        self.uses[place] = self.uses[place].saturating_sub(1);
        if let Some(value) = self.held[place] {
            self.alive -= usize::from(self.uses[place] == 0);
            return value;
        }
        let Instruction { ty, op } = self.program.instructions[id.index()];
        match op {
            Op::Constant(bits) => self.shared_constant(self.holder(ty), bits),
            Op::Load(slot) => {
                let (value, wide) = load(self, slot);
                // A wide load costs nothing where it is used, and a register where it is kept.
                if self.uses[place] > 0 && !wide {
                    self.hold(place, value);
                }
                value
            }
            Op::Unary(Unary::Not, a) => self.integer_unary(Unary::Not, ty, a),
            Op::Now
            | Op::Store(..)
            | Op::Unary(..)
            | Op::Binary(..)
            | Op::Compare(..)
            | Op::Select(..)
            | Op::Convert(_)
            | Op::Reinterpret(_)
            | Op::Call(..)
            | Op::LoadIndexed(..)
            | Op::StoreIndexed(..)
            | Op::CopyArray(..) => unreachable!("operands come before, are no stores, and only the above are late"),
        }
    }

    /// What holds a value of a type that was read or is constant.
    pub(super) fn holder(&self, ty: Elementary) -> Type {
        if ty == Elementary::Bool && self.target.whole_bools { types::I64 } else { holder(ty) }
    }

    /// The same as [`Lowering::integer_constant`], but made once a section where it takes several instructions.
    fn shared_constant(&mut self, ty: Type, bits: u64) -> Value {
        if !self.target.is_long(bits) {
            return self.integer_constant(ty, bits);
        }
        if let Some(value) = self.constants.get(&(ty, bits)) {
            return *value;
        }
        let value = self.integer_constant(ty, bits);
        self.constants.insert((ty, bits), value);
        value
    }

    /// Bits of a type as a constant.
    pub(super) fn integer_constant(&mut self, ty: Type, bits: u64) -> Value {
        // Cranelift wants a narrow constant zero-extended.
        let mask = if ty.bits() < 64 { (1 << ty.bits()) - 1 } else { u64::MAX };
        self.builder.ins().iconst(ty, (bits & mask).cast_signed())
    }

    /// The pointer nearest below or around an offset, and the way from there.
    pub(super) fn address(&self, offset: u32) -> (Value, i32) {
        let mut best = (self.pointers[0].1, i64::MAX);
        for (base, pointer) in self.pointers {
            let way = i64::from(offset) - i64::from(base);
            let short = (-i64::from(self.target.below)..=i64::from(self.target.above)).contains(&way);
            if short {
                return (pointer, i32::try_from(way).unwrap_or_default());
            }
            if way.abs() < best.1.abs() {
                best = (pointer, way);
            }
        }
        // An image has at most 2^30 bytes.
        (best.0, i32::try_from(best.1).unwrap_or_default())
    }

    /// Reads a slot; also whether it was done by a wide load.
    fn load(&mut self, id: SlotId) -> (Value, bool) {
        let slot = self.program.layout.slot(id);
        let wide =
            slot.ty == Elementary::Bool && self.target.wide_loads && !self.stored.lately(slot.offset, self.section);
        if !wide {
            return self.exact_load(id);
        }
        let (pointer, way) = self.address(slot.offset);
        (self.builder.ins().load(types::I32, MemFlagsData::new().with_notrap(), pointer, way), true)
    }

    /// Reads a slot, and no more than that.
    fn exact_load(&mut self, id: SlotId) -> (Value, bool) {
        let slot = self.program.layout.slot(id);
        let (pointer, way) = self.address(slot.offset);
        (self.read(slot.ty, pointer, way), false)
    }

    /// Reads a value of a type from memory, and no more than that.
    pub(super) fn read(&mut self, ty: Elementary, pointer: Value, way: i32) -> Value {
        let (flags, signed) = (MemFlagsData::trusted(), ty.is_signed());
        let ins = self.builder.ins();
        match ty.size() {
            1 if ty == Elementary::Bool && self.target.whole_bools => ins.uload8(types::I64, flags, pointer, way),
            1 if signed => ins.sload8(types::I32, flags, pointer, way),
            1 => ins.uload8(types::I32, flags, pointer, way),
            2 if signed => ins.sload16(types::I32, flags, pointer, way),
            2 => ins.uload16(types::I32, flags, pointer, way),
            4 => ins.load(types::I32, flags, pointer, way),
            _ => ins.load(types::I64, flags, pointer, way),
        }
    }

    fn store(&mut self, id: SlotId, value: ValueId) {
        let slot = self.program.layout.slot(id);
        let value = match self.constant(value) {
            // A constant of the slot's width becomes part of the store.
            Some(bits) => self.integer_constant(memory(slot.ty), bits),
            None => self.value(value),
        };
        self.make_pending(id);
        let (pointer, way) = self.address(slot.offset);
        self.write(slot.ty, value, pointer, way);
        self.stored.store(slot.offset, slot.ty.size(), self.section);
    }

    /// Makes the loads of a slot that is about to be stored.
    fn make_pending(&mut self, id: SlotId) {
        for load in self.pending.remove(&id).unwrap_or_default() {
            let place = load.index() - self.first;
            if self.uses[place] > 0 && self.held[place].is_none() {
                let value = self.load(id).0;
                self.hold(place, value);
            }
        }
    }

    /// The same for all elements of an array.
    pub(super) fn make_all_pending(&mut self, array: Array) {
        let slots: Vec<SlotId> = self.pending.range(array.slots()).map(|(slot, _)| *slot).collect();
        for slot in slots {
            self.make_pending(slot);
        }
    }

    /// Writes a value of a type to memory.
    pub(super) fn write(&mut self, ty: Elementary, value: Value, pointer: Value, way: i32) {
        let flags = MemFlagsData::trusted();
        let width = self.builder.func.dfg.value_type(value).bytes();
        let ins = self.builder.ins();
        match ty.size() {
            size if size == width => ins.store(flags, value, pointer, way),
            1 => ins.istore8(flags, value, pointer, way),
            _ => ins.istore16(flags, value, pointer, way),
        };
    }

    /// Two values of one type, held alike: of two BOOLs, both in 32 bits if they are, else both in 8.
    pub(super) fn alike(&mut self, a: ValueId, b: ValueId) -> (Value, Value) {
        let (a, b) = (self.value(a), self.value(b));
        self.narrowed(a, b)
    }

    pub(super) fn narrowed(&mut self, a: Value, b: Value) -> (Value, Value) {
        if self.builder.func.dfg.value_type(a) == self.builder.func.dfg.value_type(b) {
            (a, b)
        } else {
            (self.byte_of(a), self.byte_of(b))
        }
    }

    /// The low 8 bits; of a BOOL, all that it has.
    fn byte_of(&mut self, value: Value) -> Value {
        if self.builder.func.dfg.value_type(value) == types::I8 {
            value
        } else {
            self.builder.ins().ireduce(types::I8, value)
        }
    }

    /// A BOOL of which all bits count: 8, or 64 where all have as many.
    pub(super) fn flag(&mut self, id: ValueId) -> Value {
        let value = self.value(id);
        if self.target.whole_bools { value } else { self.byte_of(value) }
    }

    fn bool_binary(&mut self, op: Binary, a: ValueId, b: ValueId) -> Value {
        match op {
            Binary::And => {
                // x AND NOT y: one instruction where the target has it. Of y's inverted bits only the lowest is
                // right, and x has no other.
                let (kept, inverted) = match (self.late_not(a), self.late_not(b)) {
                    (_, Some(inner)) => (a, Some(inner)),
                    (Some(inner), None) => (b, Some(inner)),
                    (None, None) => (a, None),
                };
                if let Some(inner) = inverted
                    && self.target.whole_bools
                {
                    // Of 0 and 1 the same as `inner < kept`, which is one instruction without Zbb, too.
                    let (inner, kept) = self.alike(inner, kept);
                    let less = self.builder.ins().icmp(IntCC::UnsignedLessThan, inner, kept);
                    self.truth(less)
                } else if let Some(inner) = inverted {
                    let (inner, kept) = self.alike(inner, kept);
                    let inner = self.builder.ins().bnot(inner);
                    self.builder.ins().band(kept, inner)
                } else {
                    let (a, b) = self.alike(a, b);
                    self.builder.ins().band(a, b)
                }
            }
            Binary::Or => {
                let (a, b) = self.alike(a, b);
                self.builder.ins().bor(a, b)
            }
            Binary::Xor => {
                let (a, b) = self.alike(a, b);
                self.builder.ins().bxor(a, b)
            }
            Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Divide
            | Binary::Remainder
            | Binary::Minimum
            | Binary::Maximum
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::RotateLeft
            | Binary::RotateRight => unreachable!("not an operation on BOOLs in a verified program"),
        }
    }

    /// What a NOT that was left to its use inverts.
    fn late_not(&self, id: ValueId) -> Option<ValueId> {
        match self.program.instructions[id.index()].op {
            Op::Unary(Unary::Not, inner)
                if self.held[id.index() - self.first].is_none() && self.is_late_not(id, inner) =>
            {
                Some(inner)
            }
            _ => None,
        }
    }

    fn compare(&mut self, op: Compare, a: ValueId, b: ValueId) -> Value {
        let ty = self.type_of(a);
        if ty.is_real() {
            return self.real_compare(op, ty, a, b);
        }
        let signed = ty.is_signed();
        let condition = match op {
            Compare::Equal => IntCC::Equal,
            Compare::NotEqual => IntCC::NotEqual,
            Compare::Less if signed => IntCC::SignedLessThan,
            Compare::Less => IntCC::UnsignedLessThan,
            Compare::LessOrEqual if signed => IntCC::SignedLessThanOrEqual,
            Compare::LessOrEqual => IntCC::UnsignedLessThanOrEqual,
            Compare::Greater if signed => IntCC::SignedGreaterThan,
            Compare::Greater => IntCC::UnsignedGreaterThan,
            Compare::GreaterOrEqual if signed => IntCC::SignedGreaterThanOrEqual,
            Compare::GreaterOrEqual => IntCC::UnsignedGreaterThanOrEqual,
        };
        let (a, b) = if ty == Elementary::Bool { (self.flag(a), self.flag(b)) } else { (self.value(a), self.value(b)) };
        let holds = self.builder.ins().icmp(condition, a, b);
        self.truth(holds)
    }

    /// What a comparison says, as a BOOL.
    pub(super) fn truth(&mut self, holds: Value) -> Value {
        if self.target.whole_bools { self.builder.ins().uextend(types::I64, holds) } else { holds }
    }

    /// `a` where the bits of `condition`, a comparison or a [`Lowering::flag`], are not zero, else `b`; never a branch.
    pub(super) fn choose(&mut self, condition: Value, a: Value, b: Value) -> Value {
        if !self.target.select_branches {
            return self.builder.ins().select(condition, a, b);
        }
        let ty = self.builder.func.dfg.value_type(a);
        let one = match self.builder.func.dfg.value_type(condition) {
            same if same == ty => condition,
            wide if wide.bits() > ty.bits() => self.builder.ins().ireduce(ty, condition),
            _ => self.builder.ins().uextend(ty, condition),
        };
        if self.is_zero(a) {
            let mask = self.builder.ins().iadd_imm_s(one, -1);
            return self.builder.ins().band(b, mask);
        }
        let mask = self.builder.ins().ineg(one);
        if self.is_zero(b) {
            return self.builder.ins().band(a, mask);
        }
        let differ = self.builder.ins().bxor(a, b);
        let chosen = self.builder.ins().band(differ, mask);
        self.builder.ins().bxor(b, chosen)
    }

    /// Whether a value is seen to be 0.
    fn is_zero(&self, value: Value) -> bool {
        let dfg = &self.builder.func.dfg;
        let made = dfg.value_def(value).inst().map(|inst| dfg.insts[inst]);
        matches!(made, Some(InstructionData::UnaryImm { opcode: Opcode::Iconst, imm }) if imm.bits() == 0)
    }
}

/// What holds a value of a type other than BOOL: 32 or 64 bits, with the sign or zeros above.
pub(super) fn holder(ty: Elementary) -> Type {
    if ty.size() == 8 { types::I64 } else { types::I32 }
}

fn memory(ty: Elementary) -> Type {
    match ty.size() {
        1 => types::I8,
        2 => types::I16,
        4 => types::I32,
        _ => types::I64,
    }
}
