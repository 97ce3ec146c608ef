//! Addresses: what storage one stands for, and which of them collide.
//!
//! An address with one number counts units of its width from the start of its area: `%QW2` is bits 32 to 47 of the
//! outputs, `%MX9` the bit 9. One of a bit with two numbers is byte and bit: `%MX1.1` is the same bit 9. So `%QX0.3`
//! lies in `%QB0`, and `%QB0` in `%QW0`. Addresses with more numbers name what only the I/O system knows; they are
//! the same if they are written the same, and overlap nothing.

use super::Checker;
use super::model::VariableId;
use crate::diagnostic::{Code, Diagnostic};
use crate::elementary::Elementary;
use crate::ladder::{Address, Area, Origin, VariableClass, Width};

/// The storage of an address: equal for two addresses exactly when they share it.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) enum Extent {
    /// From a bit of the area on, as many as the width has.
    Bits(Area, u64, Width),
    /// What only the I/O system knows.
    Listed(Area, Width, Vec<u32>),
}

impl Extent {
    /// `None` where a bit above 7 of a byte is named.
    pub(super) fn of(address: &Address) -> Option<Self> {
        let &Address { area, width, ref numbers, .. } = address;
        match (width, numbers.as_slice()) {
            (Width::Bit, [.., bit]) if numbers.len() > 1 && *bit > 7 => None,
            (Width::Bit, [byte, bit]) => Some(Self::Bits(area, u64::from(*byte) * 8 + u64::from(*bit), width)),
            (_, [unit]) => Some(Self::Bits(area, u64::from(*unit) * u64::from(width.bits()), width)),
            _ => Some(Self::Listed(area, width, numbers.clone())),
        }
    }
}

/// The type of an address that is used without a declaration.
pub(super) fn direct_type(width: Width) -> Elementary {
    match width {
        Width::Bit => Elementary::Bool,
        Width::Byte => Elementary::Byte,
        Width::Word => Elementary::Word,
        Width::Double => Elementary::Dword,
        Width::Long => Elementary::Lword,
    }
}

/// The class of what stands in an area.
pub(super) fn class_of(area: Area) -> VariableClass {
    match area {
        Area::Input => VariableClass::Input,
        Area::Output => VariableClass::Output,
        Area::Memory => VariableClass::Memory,
    }
}

impl Checker<'_> {
    /// The storage of an address, or a report that there is none such.
    pub(super) fn extent(&mut self, address: &Address) -> Option<Extent> {
        let extent = Extent::of(address);
        if extent.is_none() {
            let message = format!("`{}` names a bit that a byte has not", address);
            let problem = Diagnostic::new(Code::OutOfRange, address.span, message);
            self.report.push(problem.hint("the bits of a byte are 0 to 7"));
        }
        extent
    }

    /// Reports addresses of different widths that overlap.
    pub(super) fn check_overlaps(&mut self) {
        let mut placed: Vec<(Area, u64, u32, VariableId)> = self
            .scope
            .addresses
            .iter()
            .filter_map(|(extent, id)| match extent {
                Extent::Bits(area, start, width) => Some((*area, *start, width.bits(), *id)),
                Extent::Listed(..) => None,
            })
            .collect();
        // Widths are powers of two and starts their multiples, so that of two that overlap one holds the other: sorted
        // with the wider first, whatever the last one that is still open holds lies within it.
        placed.sort_by_key(|(area, start, bits, _)| (*area, *start, std::cmp::Reverse(*bits)));
        let mut open: Option<(Area, u64, VariableId)> = None;
        for (area, start, bits, id) in placed {
            match open {
                Some((open_area, end, outer)) if open_area == area && start < end => self.overlap(outer, id),
                _ => open = Some((area, start + u64::from(bits), id)),
            }
        }
    }

    fn overlap(&mut self, outer: VariableId, inner: VariableId) {
        let [a, b] = [outer, inner].map(|id| &self.scope.entry(id).variable);
        let (Some(a), Some(b)) = (&a.address, &b.address) else { return };
        // The later one in the source is the intruder.
        let (first, second) = if a.span <= b.span { (a, b) } else { (b, a) };
        let message = format!("`{}` overlaps `{}`", second, first);
        if self.program.origin == Origin::Imported {
            let message = format!("`{second}` and `{first}` have storage of their own");
            let problem = Diagnostic::new(Code::SeparateAddresses, second.span, message)
                .related(first.span, "the other address")
                .hint("where one should be part of the other, read its bits instead");
            return self.report.push(problem);
        }
        let problem = Diagnostic::new(Code::AddressConflict, second.span, message)
            .related(first.span, "the other address")
            .hint(format!("two addresses may share storage only when their widths are equal; `{}` holds `{}`", a, b));
        self.report.push(problem);
    }
}
