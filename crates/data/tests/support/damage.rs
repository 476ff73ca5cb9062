//! Reads files that were damaged at random. Reading any file must end soon, with spheres or with an error of one line.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use fastrand::Rng;
use pinhole_data::load::{self, ColumnValues, Dataset, Format, LoadError, Options, Trajectory};

/// The longest time that reading a small file may take.
pub(crate) const SLOW: Duration = Duration::from_secs(2);

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
pub(crate) fn damaged(good: &[u8], other: &[u8], random: &mut Rng) -> Vec<u8> {
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

/// Reads a file in every way that a program can, and returns the longest time.
///
/// # Errors
/// Describes the fault in the result, or in the message of an error.
pub(crate) fn read_all(
    format: &'static Format,
    bytes: &[u8],
    options: &Options,
    file: &Path,
    random: &mut Rng,
) -> Result<Duration, String> {
    let mut longest = read_bytes(format, bytes, options, random)?;
    let named = options.clone().with_format(format);
    if format.has_frames() {
        fs::write(file, bytes).map_err(|error| error.to_string())?;
        longest = longest.max(timed(|| match Trajectory::open(file, &named) {
            Err(error) => check(Err(error)),
            Ok(mut trajectory) => {
                if trajectory.is_empty() {
                    return Err("a trajectory has no frames".to_owned());
                }
                check_message(trajectory.problem().map(LoadError::to_string))?;
                let last = trajectory.len() - 1;
                for index in [0, last, random.usize(0..=last), last + 1] {
                    check(trajectory.frame(index))?;
                }
                Ok(())
            }
        })?);
        let frame = named.clone().with_frame(random.usize(0..3));
        longest = longest.max(timed(|| check(load::open(file, &frame)))?);
    }
    Ok(longest)
}

/// Reads bytes as [`read_all`] does, but without a file, which takes much longer.
///
/// # Errors
/// Returns an error as [`read_all`] does.
pub(crate) fn read_bytes(
    format: &'static Format,
    bytes: &[u8],
    options: &Options,
    random: &mut Rng,
) -> Result<Duration, String> {
    let named = options.clone().with_format(format);
    let longest = timed(|| check(load::from_bytes(bytes, "", &named)))?;
    // The content may now look like another format, which would get options that do not apply to it.
    if random.u8(0..8) > 0 {
        return Ok(longest);
    }
    Ok(longest.max(timed(|| check(load::from_bytes(bytes, "", options)))?))
}

/// Returns the time that reading took.
fn timed(read: impl FnOnce() -> Result<(), String>) -> Result<Duration, String> {
    let start = Instant::now();
    read()?;
    Ok(start.elapsed())
}

/// Checks that the data are consistent, or that the error is one line.
fn check(read: Result<Dataset, LoadError>) -> Result<(), String> {
    let loaded = match read {
        Ok(loaded) => loaded,
        Err(error) => return check_message([error.to_string()]),
    };
    let count = loaded.spheres.len();
    let is = |what: &str, found: usize| match found == count {
        true => Ok(()),
        false => Err(format!("{count} spheres have {found} {what}")),
    };
    is("colors", loaded.colors.as_ref().map_or(count, Vec::len))?;
    is("opacities", loaded.opacities.as_ref().map_or(count, Vec::len))?;
    for column in &loaded.columns {
        match &column.values {
            ColumnValues::Numbers(numbers) => is("numbers", numbers.len())?,
            ColumnValues::Labels(labels) => {
                is("labels", labels.indices.len())?;
                if labels.indices.iter().any(|index| *index as usize >= labels.names.len()) {
                    return Err(format!("a label of {} has no name", column.name));
                }
            }
        }
    }
    check_message(loaded.notes)
}

/// Checks that each message is one line that a terminal can show unchanged.
fn check_message(messages: impl IntoIterator<Item = String>) -> Result<(), String> {
    for message in messages {
        if message.is_empty() || message.chars().any(char::is_control) {
            return Err(format!("a message is empty or has control characters: {message:?}"));
        }
        if message.len() > 2000 {
            return Err(format!("a message has {} bytes: {:.200}", message.len(), message));
        }
    }
    Ok(())
}
