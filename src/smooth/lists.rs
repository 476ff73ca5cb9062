//! Lists for the cubes in which there are visible points.

use std::sync::atomic::{AtomicBool, Ordering};

use super::levels::Places;
use super::spots::Row;
use crate::parallel;

/// The number of what no visible point needs.
pub(super) const NONE: u32 = 0;

/// Places that visible points need, such as cubes.
#[derive(Debug)]
pub(super) struct Needed(Vec<AtomicBool>);

impl Needed {
    pub(super) fn none(count: usize) -> Self {
        Self((0..count).map(|_| AtomicBool::new(false)).collect())
    }

    /// The cubes of some spots.
    pub(super) fn cubes(places: &Places<'_>, rows: &[Row]) -> Self {
        let cubes = Self::none(places.cells.cube_counts().into_iter().product());
        parallel::for_each(rows.iter().collect(), |row: &Row| {
            row.all.iter().for_each(|spot| cubes.mark(places.cells.cube_of(spot.position)));
        });
        cubes
    }

    pub(super) fn mark(&self, place: u32) {
        self.0[place as usize].store(true, Ordering::Relaxed);
    }

    /// Numbers the needed places that have no number, from `first` on, in order. Returns them.
    pub(super) fn number(&self, numbers: &mut [u32], first: usize) -> Vec<u32> {
        let mut new = Vec::new();
        for (place, (number, needed)) in numbers.iter_mut().zip(&self.0).enumerate() {
            if *number == NONE && needed.load(Ordering::Relaxed) {
                *number = (first + new.len()) as u32;
                new.push(place as u32);
            }
        }
        new
    }
}

/// A list for each needed cube of 2×2×2 cells.
#[derive(Debug)]
pub(super) struct CubeLists<T> {
    /// The number of each cube's list. List 0 is that of cubes without visible points, and empty.
    numbers: Vec<u32>,
    /// The end of each list in `all`.
    ends: Vec<u32>,
    all: Vec<T>,
}

impl<T: Copy + Send> CubeLists<T> {
    pub(super) fn new(places: &Places<'_>) -> Self {
        let cubes = places.cells.cube_counts().into_iter().product();
        Self { numbers: vec![NONE; cubes], ends: vec![0], all: Vec::new() }
    }

    /// Makes the lists that are needed and missing.
    pub(super) fn complete(&mut self, needed: &Needed, list: impl Fn(u32) -> Vec<T> + Sync) {
        let new = needed.number(&mut self.numbers, self.ends.len());
        for list in parallel::map(new.len(), |k| list(new[k])) {
            self.all.extend(list);
            self.ends.push(self.all.len() as u32);
        }
    }

    pub(super) fn of(&self, cube: u32) -> &[T] {
        let list = self.numbers[cube as usize] as usize;
        let start = list.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.all[start..self.ends[list] as usize]
    }
}
