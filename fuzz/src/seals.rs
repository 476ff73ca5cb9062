//! Makes digests and checksums fit damaged bytes, so that readers look beyond them.

use data_encoding::HEXLOWER;
use flate2::Crc;
use serde_json::Value;
use sha2::{Digest, Sha256};

/// The length of a digest in digits.
pub(crate) const DIGITS: usize = 64;

pub(crate) fn hex(bytes: &[u8]) -> String {
    HEXLOWER.encode(&Sha256::digest(bytes))
}

/// Puts `digest` after the first `key`, over what is there.
pub(crate) fn put(bytes: &mut [u8], key: &str, digest: &str) {
    let place = bytes.windows(key.len()).position(|found| found == key.as_bytes());
    if let Some(digits) = place.and_then(|place| bytes.get_mut(place + key.len()..place + key.len() + DIGITS)) {
        digits.copy_from_slice(digest.as_bytes());
    }
}

/// A run file, whose digest is computed with zeros in its place.
pub(crate) fn run(mut bytes: Vec<u8>) -> Vec<u8> {
    put(&mut bytes, "\"sha256\":\"", &"0".repeat(DIGITS));
    let digest = hex(&bytes);
    put(&mut bytes, "\"sha256\":\"", &digest);
    bytes
}

/// A PNG, with the checksum of every chunk.
pub(crate) fn png(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut place = 8;
    while let Some(length) = bytes.get(place..).and_then(<[u8]>::first_chunk).map(|length| u32::from_be_bytes(*length))
    {
        let end = place + 8 + length as usize;
        let (Some(chunk), true) = (bytes.get(place + 4..end), end + 4 <= bytes.len()) else { break };
        let mut sum = Crc::new();
        sum.update(chunk);
        bytes[end..end + 4].copy_from_slice(&sum.sum().to_be_bytes());
        place = end + 4;
    }
    bytes
}

/// A file of bricks: the digests of its sections and of its header.
pub(crate) fn bricks(bytes: &[u8]) -> Vec<u8> {
    let number = |at: usize| Some(u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    let start = number(24).filter(|start| *start >= 40).unwrap_or(usize::MAX);
    let end = number(32).and_then(|length| start.checked_add(length));
    let Some(text) = end.and_then(|end| bytes.get(start..end)) else { return bytes.to_vec() };
    let text = with_sections(bytes, start, text).unwrap_or_else(|| text.to_vec());
    let mut sealed = bytes[..start].to_vec();
    sealed[32..40].copy_from_slice(&(text.len() as u64).to_le_bytes());
    let digest = Sha256::new_with_prefix(&sealed[..40]).chain_update(&text).finalize();
    [&sealed[..], &text, &digest].concat()
}

/// The header of a file of bricks, which has the digest of each section: of the digests of its spheres, ids and colours.
/// Each section ends where the next one starts.
fn with_sections(bytes: &[u8], mut end: usize, header: &[u8]) -> Option<Vec<u8>> {
    let mut header: Value = serde_json::from_slice(header).ok()?;
    let mut seal = |section: &mut Value| {
        let number = |key| Some(section.get(key)?.as_u64()? as usize);
        let (count, offset) = (number("count").filter(|count| *count > 0)?, number("offset")?);
        let (spheres, rest) = bytes.get(offset..end)?.split_at_checked(count.checked_mul(16)?)?;
        let mut digest = Sha256::new_with_prefix(Sha256::digest(spheres));
        rest.chunks(4 * count).for_each(|words| digest.update(Sha256::digest(words)));
        *section.get_mut("sha256")? = HEXLOWER.encode(&digest.finalize()).into();
        end = offset;
        Some(())
    };
    seal(header.get_mut("outer")?)?;
    header.get_mut("bricks")?.as_array_mut()?.iter_mut().rev().try_for_each(|brick| seal(brick.get_mut("section")?))?;
    serde_json::to_vec(&header).ok()
}
