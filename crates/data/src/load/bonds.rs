//! Bonds that files list: atoms are found by their numbers, and pairs are put in order.

use std::collections::HashMap;

use super::error::LoadError;

/// Returns bonds as [`Dataset::bonds`](super::Dataset::bonds) has them. Pairs of a sphere with itself are left out.
pub(super) fn ordered(pairs: impl IntoIterator<Item = [u32; 2]>) -> Vec<[u32; 2]> {
    let pairs = pairs.into_iter().filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]);
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Returns the bonds between spheres that are kept, with their new indices. The order stays.
pub(super) fn kept(bonds: &[[u32; 2]], is_kept: &[bool]) -> Vec<[u32; 2]> {
    if bonds.is_empty() {
        return Vec::new();
    }
    let count = |count: &mut u32, is_kept: &bool| {
        let index = is_kept.then_some(*count);
        *count += u32::from(*is_kept);
        Some(index)
    };
    let indices: Vec<Option<u32>> = is_kept.iter().scan(0, count).collect();
    let left_out = indices.iter().filter(|index| index.is_none()).count() as u32;
    // Spheres beyond the end of `is_kept` stay.
    let new = |old: u32| indices.get(old as usize).copied().unwrap_or_else(|| old.checked_sub(left_out));
    bonds.iter().filter_map(|[a, b]| Some([new(*a)?, new(*b)?])).collect()
}

/// The rows of atoms by their numbers in the file.
pub(super) struct Numbered {
    /// `None` for a number that several atoms have.
    rows: HashMap<i64, Option<u32>>,
}

impl Numbered {
    /// Takes the numbers of all atoms, in the order of the rows; `None` for an atom without a number.
    pub(super) fn new(numbers: impl IntoIterator<Item = Option<i64>>) -> Self {
        let mut rows = HashMap::new();
        for (row, number) in (0..).zip(numbers) {
            if let Some(number) = number {
                rows.entry(number).and_modify(|row| *row = None).or_insert(Some(row));
            }
        }
        Self { rows }
    }

    /// The row of the only atom with this number.
    pub(super) fn row(&self, number: i64) -> Option<u32> {
        self.rows.get(&number).copied().flatten()
    }

    /// The rows of two bonded atoms; an error if there are no such atoms.
    pub(super) fn pair(&self, line: usize, [a, b]: [i64; 2]) -> Result<[u32; 2], LoadError> {
        let row = |number| {
            self.row(number).ok_or_else(|| {
                let how_many = if self.rows.contains_key(&number) { "several atoms have" } else { "no atom has" };
                let message = format!(
                    "this bond joins the atom {number}, but {how_many} this number; correct it, or remove the bond"
                );
                LoadError::line(line, message)
            })
        };
        if a == b {
            let message = format!("this bond joins the atom {a} with itself; correct the number, or remove the bond");
            return Err(LoadError::line(line, message));
        }
        Ok([row(a)?, row(b)?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bonds_are_in_order_and_follow_their_spheres() {
        let bonds = ordered([[3, 1], [0, 1], [2, 2], [1, 3], [4, 3]]);
        assert_eq!(bonds, [[0, 1], [1, 3], [3, 4]]);
        assert_eq!(kept(&bonds, &[true, true, false, true, true]), [[0, 1], [1, 2], [2, 3]]);
        assert_eq!(kept(&bonds, &[false, true]), [[0, 2], [2, 3]]);
        assert_eq!(kept(&bonds, &[true, true, true, false, true]), [[0, 1]]);
    }

    #[test]
    fn atoms_by_numbers() {
        let rows = Numbered::new([Some(7), None, Some(9), Some(8), Some(9)]);
        assert_eq!(rows.pair(3, [8, 7]), Ok([3, 0]));
        for (pair, said) in [
            ([7, 1], "line 3: this bond joins the atom 1, but no atom has this number; correct it, or remove the bond"),
            (
                [9, 7],
                "line 3: this bond joins the atom 9, but several atoms have this number; correct it, or remove the bond",
            ),
            ([7, 7], "line 3: this bond joins the atom 7 with itself; correct the number, or remove the bond"),
        ] {
            assert_eq!(rows.pair(3, pair).unwrap_err().to_string(), said);
        }
    }
}
