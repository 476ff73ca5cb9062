//! Damages files at random.

use fastrand::Rng;

/// Numbers that are likely to break readers.
const NUMBERS: [u64; 14] = [
    0,
    1,
    2,
    7,
    0x7f,
    0xff,
    0xffff,
    0x00ff_ffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x0000_0100_0000_0000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];

/// Numbers of this kind as text, other forms of numbers, and an empty text, with blanks between them.
const WORDS: &str = "0 -1 1e308 -1e-320 nan inf 1e999 16777216 4294967296 999999999999 18446744073709551615 \
                     99999999999999999999999  \u{e9}";

/// Bytes with a meaning in texts.
const TELLING: &[u8] = b"\n\t \"';#,._\xff\0";

/// A damaged copy of a file. Pieces of `other`, another good file, may be copied into it.
pub fn damaged(good: &[u8], other: &[u8], random: &mut Rng) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..1 << random.usize(0..4) {
        damage(&mut bytes, other, random);
    }
    // A file that grows with each damage would only be slow.
    bytes.truncate(2 * good.len() + 4096);
    bytes
}

fn range(length: usize, longest: usize, random: &mut Rng) -> std::ops::Range<usize> {
    let start = random.usize(0..=length);
    start..(start + random.usize(0..=longest)).min(length)
}

fn damage(bytes: &mut Vec<u8>, other: &[u8], random: &mut Rng) {
    if bytes.is_empty() {
        bytes.extend(other);
        return;
    }
    let at = random.usize(0..bytes.len());
    match random.u8(0..11) {
        0 => bytes[at] ^= 1 << random.u8(0..8),
        1 => bytes[at] = random.u8(..),
        2 => drop(bytes.drain(range(bytes.len(), 16, random))),
        3 => bytes.truncate(at),
        4 => {
            let more: Vec<u8> = (0..random.usize(1..9)).map(|_| random.u8(..)).collect();
            bytes.splice(at..at, more);
        }
        5 => {
            let piece = bytes[range(bytes.len(), 64, random)].to_vec();
            bytes.splice(at..at, piece);
        }
        6 => {
            let piece = other[range(other.len(), 64, random)].to_vec();
            let replaced = range(bytes.len(), 64, random);
            bytes.splice(replaced, piece);
        }
        7 => {
            let number = NUMBERS[random.usize(0..NUMBERS.len())].wrapping_add(random.u64(0..3));
            let width = 1 << random.usize(0..4);
            // Most numbers of binary files are at multiples of their width.
            let at = if random.bool() { at / width * width } else { at };
            let mut number = number.to_le_bytes()[..width].to_vec();
            if random.bool() {
                number.reverse();
            }
            let end = (at + width).min(bytes.len());
            bytes.splice(at..end, number);
        }
        8 => {
            bytes.splice(at..at + random.usize(0..2), random.choice(TELLING.iter().copied()));
        }
        _ => replace_number(bytes, at, random),
    }
}

/// Replaces the first number in the text at this place or after it.
fn replace_number(bytes: &mut Vec<u8>, at: usize, random: &mut Rng) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.".contains(byte);
    let Some(start) = bytes[at..].iter().position(is_part).map(|offset| at + offset) else {
        return;
    };
    let end = bytes[start..].iter().position(|byte| !is_part(byte));
    let end = end.map_or(bytes.len(), |length| start + length);
    let words: Vec<&str> = WORDS.split(' ').collect();
    bytes.splice(start..end, random.choice(words).unwrap().bytes());
}
