//! How large an object may become: calls and addresses in it hold a distance of so many bits.

use target_lexicon::{Architecture, Triple};

use crate::engine::clif::{Chunk, CompileError};

/// What the functions that are no chunks, and the firmware around them, are allowed.
const OTHERS: u64 = 1 << 20;

/// Bytes that a call reaches, and an address.
fn reach(architecture: Architecture) -> (u64, u64) {
    match architecture {
        // 26 bits of 4 bytes, and 21 bits of 4 KiB; both ways.
        Architecture::Aarch64(_) => (1 << 27, 1 << 32),
        _ => (1 << 31, 1 << 31),
    }
}

/// Whether all that an object holds is within its own reach.
///
/// # Errors
/// [`CompileError::TooLarge`] when it is not.
pub(super) fn check(triple: &Triple, chunks: &[Chunk], image: u32) -> Result<(), CompileError> {
    let code = chunks.iter().map(|chunk| chunk.code.len() as u64 + u64::from(chunk.alignment)).sum();
    fits(triple.architecture, code, u64::from(image))
}

fn fits(architecture: Architecture, code: u64, image: u64) -> Result<(), CompileError> {
    let (call, address) = reach(architecture);
    if code.saturating_add(OTHERS) > call {
        let most = (call - OTHERS) >> 20;
        return Err(CompileError::TooLarge(format!(
            "the code has {code} bytes, and a call on {architecture} reaches {most} MiB"
        )));
    }
    // Behind the code the linker may put the constants that an image starts with, and the image.
    if code.saturating_add(2 * image).saturating_add(OTHERS) > address {
        let most = (address - OTHERS) >> 20;
        return Err(CompileError::TooLarge(format!(
            "code and image have {code} and {image} bytes, and an address on {architecture} reaches {most} MiB"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    #[test]
    fn what_calls_and_addresses_reach_is_an_object_and_no_more() {
        let tried = |triple: &str, code, image| {
            let triple: Triple = triple.parse().expect("a known triple");
            fits(triple.architecture, code, image).map_err(|error| error.code())
        };
        let refused = Err(Code::TooLargeForTarget);
        assert_eq!(tried("aarch64-unknown-linux-gnu", 126 << 20, 1 << 30), Ok(()));
        assert_eq!(tried("aarch64-unknown-linux-gnu", 128 << 20, 1000), refused);
        assert_eq!(tried("x86_64-unknown-linux-gnu", 1 << 30, 1000), Ok(()));
        assert_eq!(tried("x86_64-unknown-linux-gnu", 1 << 31, 1000), refused);
        assert_eq!(tried("riscv64gc-unknown-none-elf", 1000, 1 << 30), refused);
        assert_eq!(tried("riscv64gc-unknown-none-elf", 1000, 1 << 29), Ok(()));
        assert_eq!(tried("riscv64gc-unknown-none-elf", u64::MAX, u64::MAX >> 1), refused);
    }
}
