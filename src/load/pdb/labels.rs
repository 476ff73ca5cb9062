//! Stores short texts of which few different ones occur.

use std::collections::HashMap;

use crate::load::ColumnValues;

/// A map from keys to indices. A small table in front of the hash map holds the last key found in each of its slots.
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

/// One text for each atom, without the blanks around it.
#[derive(Default)]
pub(super) struct Labels {
    pub(super) names: Vec<String>,
    pub(super) indices: Vec<u32>,
    known: Memo,
}

impl Labels {
    /// Appends the text of an atom and returns its index in `names`.
    pub(super) fn push(&mut self, field: [u8; 4]) -> u32 {
        let index = self.index(field);
        self.indices.push(index);
        index
    }

    /// Returns the index of a text in `names`; a new text is added.
    pub(super) fn index(&mut self, field: [u8; 4]) -> u32 {
        let key = u64::from(u32::from_le_bytes(field));
        if let Some(index) = self.known.get(key) {
            return index;
        }
        // The same text may have another position in its field.
        let text = field.trim_ascii();
        let mut left = [b' '; 4];
        left.iter_mut().zip(text).for_each(|(to, from)| *to = *from);
        let left = u64::from(u32::from_le_bytes(left));
        let index = self.known.get(left).unwrap_or_else(|| {
            self.names.push(String::from_utf8_lossy(text).into_owned());
            // There are no more names than atoms, which are fewer than 2³².
            self.names.len() as u32 - 1
        });
        self.known.insert(left, index);
        self.known.insert(key, index);
        index
    }

    /// Keeps some atoms and the names that they use. Returns the former index of each of these names.
    pub(super) fn retain(&mut self, keep: &[bool]) -> Vec<u32> {
        retain(&mut self.indices, keep);
        let mut names = Vec::new();
        let mut former = Vec::new();
        let mut renumbered = vec![None; self.names.len()];
        for index in &mut self.indices {
            let old = *index as usize;
            let (Some(new), Some(name)) = (renumbered.get_mut(old), self.names.get_mut(old)) else {
                continue;
            };
            let next = names.len() as u32;
            if new.is_none() {
                names.push(std::mem::take(name));
                former.push(*index);
            }
            *index = *new.get_or_insert(next);
        }
        self.names = names;
        former
    }

    pub(super) fn into_values(self) -> ColumnValues {
        ColumnValues::Labels(crate::load::Labels { names: self.names, indices: self.indices })
    }
}

/// Keeps the values for which `keep` is true.
pub(super) fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| keep.next().copied().unwrap_or(true));
}
