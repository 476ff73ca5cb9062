//! Collects texts that repeat often, such as the names of atoms. All readers of text share this code.

use std::collections::HashMap;

use super::dataset::{ColumnValues, Labels};

/// A map from keys to indices. A small table in front of the hash map holds the last key found in each of its slots.
#[derive(Debug)]
pub(super) struct Memo {
    recent: [Option<(u64, u32)>; Self::RECENT],
    all: HashMap<u64, u32>,
}

impl Memo {
    const RECENT: usize = 64;

    pub(super) fn get(&mut self, key: u64) -> Option<u32> {
        let recent = self.recent.get_mut(Self::slot(key));
        match recent {
            Some(Some((found, value))) if *found == key => Some(*value),
            _ => {
                let value = self.all.get(&key).copied()?;
                if let Some(recent) = recent {
                    *recent = Some((key, value));
                }
                Some(value)
            }
        }
    }

    pub(super) fn insert(&mut self, key: u64, value: u32) {
        self.all.insert(key, value);
    }

    /// Returns the slot of a key by multiplicative hashing: the upper bits of its product with 2⁶⁴ divided by the
    /// golden ratio.
    fn slot(key: u64) -> usize {
        (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 58) as usize
    }
}

impl Default for Memo {
    fn default() -> Self {
        Self { recent: [None; Self::RECENT], all: HashMap::new() }
    }
}

/// One text for each atom.
#[derive(Debug, Default)]
pub(super) struct LabelsBuilder {
    pub(super) names: Vec<String>,
    pub(super) indices: Vec<u32>,
    /// Indices of texts of few bytes, packed into a number. Most texts are short.
    short: Memo,
    long: HashMap<Box<[u8]>, u32>,
}

impl LabelsBuilder {
    /// Makes room for the texts of this number of atoms.
    pub(super) fn with_capacity(atoms: usize) -> Self {
        Self { indices: Vec::with_capacity(atoms), ..Self::default() }
    }

    /// Appends the text of an atom and returns its index in `names`.
    pub(super) fn push(&mut self, text: &[u8]) -> u32 {
        let index = self.index(text);
        self.indices.push(index);
        index
    }

    /// Returns the index of a text in `names`; a new text is added.
    pub(super) fn index(&mut self, text: &[u8]) -> u32 {
        let key = packed(text);
        let known = match key {
            Some(key) => self.short.get(key),
            None => self.long.get(text).copied(),
        };
        known.unwrap_or_else(|| {
            // There are no more names than atoms, whose number is less than 2³².
            let index = self.names.len() as u32;
            self.names.push(String::from_utf8_lossy(text).into_owned());
            match key {
                Some(key) => self.short.insert(key, index),
                None => drop(self.long.insert(text.into(), index)),
            }
            index
        })
    }

    /// Keeps some atoms and the names that they use. Returns the former index of each of these names.
    pub(super) fn retain(&mut self, keep: &[bool]) -> Vec<u32> {
        let mut labels = Labels { names: std::mem::take(&mut self.names), indices: std::mem::take(&mut self.indices) };
        let former = labels.keep(keep);
        (self.names, self.indices) = (labels.names, labels.indices);
        former
    }

    pub(super) fn into_labels(self) -> Labels {
        Labels { names: self.names, indices: self.indices }
    }

    pub(super) fn into_values(self) -> ColumnValues {
        ColumnValues::Labels(self.into_labels())
    }
}

/// Packs up to seven bytes and their number into a key. Overlapping loads take less time than a loop over the bytes.
fn packed(text: &[u8]) -> Option<u64> {
    let length = text.len();
    let bytes = match (text.first_chunk::<4>(), text.last_chunk::<4>()) {
        _ if length > 7 => return None,
        (Some(first), Some(last)) => {
            let [first, last] = [first, last].map(|four| u64::from(u32::from_le_bytes(*four)));
            first | last << (8 * (length - 4))
        }
        _ => match *text {
            [a, b, c] => u64::from_le_bytes([a, b, c, 0, 0, 0, 0, 0]),
            [a, b] => u64::from_le_bytes([a, b, 0, 0, 0, 0, 0, 0]),
            [a] => u64::from(a),
            _ => 0,
        },
    };
    Some(bytes | (length as u64) << 56)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_the_bytes_and_their_number() {
        for length in 0..=7 {
            let text = &b"abcdefg"[..length];
            let mut bytes = [0; 8];
            bytes[..length].copy_from_slice(text);
            bytes[7] = length as u8;
            assert_eq!(packed(text), Some(u64::from_le_bytes(bytes)));
        }
        assert_eq!(packed(b"abcdefgh"), None);
    }

    #[test]
    fn each_text_has_one_index() {
        let mut labels = LabelsBuilder::default();
        let texts = ["", "a", "a\0", "seven77", "eight888", "a", "eight888", "ninety-nine bottles"];
        let indices: Vec<_> = texts.iter().map(|text| labels.push(text.as_bytes())).collect();
        assert_eq!(indices, [0, 1, 2, 3, 4, 1, 4, 5]);
        let former = labels.retain(&[false, true, false, false, true, true, true, false]);
        assert_eq!(former, [1, 4]);
        assert_eq!((labels.names, labels.indices), (vec!["a".into(), "eight888".into()], vec![0, 1, 0, 1]));
    }
}
