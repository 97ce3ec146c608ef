//! The retained variables of a program, as they are kept while the power is off.
//!
//! The bytes are those that a built program's `P_save` writes and `P_init` takes, in this machine's byte order; so a
//! host program and compiled firmware can hand them to each other.

use crate::elementary::Elementary;
use crate::logic::Layout;

/// What the variables with `retain` hold, and the name of the layout that says which is where.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Retained {
    /// [`Layout::hash`] of the image that the bytes are of.
    pub layout_hash: u64,
    /// The bytes of [`Layout::retained`], one run behind the other.
    pub bytes: Vec<u8>,
}

impl Retained {
    /// Gathers them from an image of that layout.
    pub(super) fn of(layout: &Layout, image: &[u8]) -> Self {
        let runs = layout.retained().iter().map(|run| &image[run.start as usize..run.end as usize]);
        Self { layout_hash: layout.hash(), bytes: runs.flatten().copied().collect() }
    }

    /// Bytes that the retained variables of a layout have.
    pub(super) fn size(layout: &Layout) -> usize {
        layout.retained().iter().map(|run| run.len()).sum()
    }

    /// Puts them into an image of that layout, of which they must be. BOOLs become 0 or 1, whatever the bytes are.
    pub(super) fn put(&self, layout: &Layout, image: &mut [u8]) {
        let mut rest = self.bytes.as_slice();
        for run in layout.retained() {
            let (bytes, behind) = rest.split_at(run.len());
            image[run.start as usize..run.end as usize].copy_from_slice(bytes);
            rest = behind;
        }
        for slot in layout.slots().iter().filter(|slot| slot.retain && slot.ty == Elementary::Bool) {
            slot.write(image, slot.read(image));
        }
    }

    /// Hash and bytes in one, for a file or a flash page: the hash in 8 bytes, least significant first, and then the
    /// bytes. Nothing in it tells that a byte was damaged; that is for the medium.
    pub fn to_bytes(&self) -> Vec<u8> {
        [self.layout_hash.to_le_bytes().as_slice(), &self.bytes].concat()
    }

    /// Reads what [`Retained::to_bytes`] wrote; `None` of fewer bytes than a hash has.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (hash, bytes) = bytes.split_first_chunk()?;
        Some(Self { layout_hash: u64::from_le_bytes(*hash), bytes: bytes.to_vec() })
    }
}
