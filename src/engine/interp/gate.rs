//! Gates: boolean functions of a few BOOL cells, given by their truth tables.
//!
//! As on an FPGA, any expression over up to [`INPUTS`] cells is one look-up, whatever its operations: contacts in series
//! and in parallel, negations, exclusive or, a choice. A gate must execute without a branch.

use crate::logic::Compare;

/// Cells that a gate reads at most.
pub(super) const INPUTS: usize = 4;

/// A function's results: bit i is the one for the inputs that, the first lowest, are the bits of i.
pub(super) type Table = u16;

/// Where each input is 1.
const COLUMNS: [Table; INPUTS] = [0xAAAA, 0xCCCC, 0xF0F0, 0xFF00];

/// Sets a BOOL cell to a function of others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    inputs: [u32; INPUTS],
    target: u32,
    table: Table,
}

impl Gate {
    /// A gate that sets `target`; `any` is some cell that always holds a BOOL, which that of the target need not before.
    pub(super) fn new(function: &Function, target: u32, any: u32) -> Self {
        // An input that does not count must be a BOOL all the same; best one that is at hand.
        let mut inputs = [function.inputs().first().copied().unwrap_or(any); INPUTS];
        inputs[..function.count].copy_from_slice(function.inputs());
        Self { inputs, target, table: function.table }
    }

    /// The table, the inputs, the target.
    pub(super) fn parts(&self) -> (Table, [u32; INPUTS], u32) {
        (self.table, self.inputs, self.target)
    }

    #[inline(always)]
    pub(super) fn execute(&self, cells: &mut [u8]) {
        let input = |place: usize| u32::from(cells[self.inputs[place] as usize]) << place;
        let index = input(0) + input(1) + input(2) + input(3);
        cells[self.target as usize] = u8::from(u32::from(self.table).wrapping_shr(index) & 1 != 0);
    }
}

/// A boolean function of cells: what a value is before, and unless, it gets a cell of its own.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Function {
    inputs: [u32; INPUTS],
    count: usize,
    table: Table,
}

impl Function {
    pub(super) fn constant(value: bool) -> Self {
        Self { inputs: [0; INPUTS], count: 0, table: if value { Table::MAX } else { 0 } }
    }

    /// What one cell holds.
    pub(super) fn cell(cell: u32) -> Self {
        Self { inputs: [cell; INPUTS], count: 1, table: COLUMNS[0] }
    }

    /// The cell, if it is no more than that.
    pub(super) fn as_cell(&self) -> Option<u32> {
        (self.count == 1 && self.table == COLUMNS[0]).then_some(self.inputs[0])
    }

    /// The cells that it reads, each once.
    pub(super) fn inputs(&self) -> &[u32] {
        &self.inputs[..self.count]
    }

    /// A function of functions, if together they read few enough cells. `of` maps the tables bit by bit.
    pub(super) fn combine<const N: usize>(operands: [&Self; N], of: impl Fn([Table; N]) -> Table) -> Option<Self> {
        let mut all = Self::constant(false);
        for cell in operands.iter().flat_map(|operand| operand.inputs()) {
            if !all.inputs().contains(cell) {
                *all.inputs.get_mut(all.count)? = *cell;
                all.count += 1;
            }
        }
        let table = of(operands.map(|operand| operand.table_over(&all)));
        Some(Self { table, ..all })
    }

    /// Its table with the inputs of another function, which reads all cells that it does.
    fn table_over(&self, other: &Self) -> Table {
        let mut columns = [0; INPUTS];
        for (column, cell) in columns.iter_mut().zip(self.inputs()) {
            let place = other.inputs().iter().position(|input| input == cell);
            *column = place.map_or(0, |place| COLUMNS[place]);
        }
        (0..1 << self.count).filter(|row| self.table >> row & 1 != 0).fold(0, |table, row| {
            let choose = |(place, column): (usize, &Table)| if row >> place & 1 != 0 { *column } else { !*column };
            table | columns[..self.count].iter().enumerate().map(choose).fold(Table::MAX, |a, b| a & b)
        })
    }
}

/// A comparison of two BOOLs as a function of their tables.
pub(super) fn compare(op: Compare, a: Table, b: Table) -> Table {
    match op {
        Compare::Equal => !(a ^ b),
        Compare::NotEqual => a ^ b,
        Compare::Less => !a & b,
        Compare::LessOrEqual => !a | b,
        Compare::Greater => a & !b,
        Compare::GreaterOrEqual => a | !b,
    }
}
