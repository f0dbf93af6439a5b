//! The hash that documents tell texts and files by.

/// FNV-1a of 64 bits: against damage and mix-ups, not against forgery.
#[must_use]
pub fn hash(bytes: &[u8]) -> String {
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    format!("fnv1a:{hash:016x}")
}
