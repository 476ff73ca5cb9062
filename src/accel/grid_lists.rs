//! The words and lists of cells. In a grid in which no cell has a grid of its own, lists are copied once, straight to their
//! places.

use super::ball::BallFrame;
use super::cells::Cells;
use super::grid::{LAST, elements, word};
use super::grid_dense::corner;
use super::grid_slabs::Lists;
use super::grid_sort::CHUNK;
use crate::parallel::{for_each, map_parts, ranges, split_mut};

/// References, list after list, and a ball beside each.
#[derive(Default)]
pub(super) struct BuiltLists {
    pub(super) references: Vec<u32>,
    pub(super) balls: Vec<u32>,
}

impl BuiltLists {
    pub(super) fn with_capacity(listed: usize) -> Self {
        Self { references: Vec::with_capacity(listed), balls: Vec::with_capacity(listed) }
    }

    /// Appends the list of a cell with this frame, and returns the word of the cell.
    pub(super) fn append(&mut self, list: &[u32], spheres: &[[f32; 4]], frame: BallFrame) -> u32 {
        if list.is_empty() {
            return word::EMPTY;
        }
        let start = self.references.len();
        self.references.resize(start + elements(list.len()), 0);
        self.balls.resize(self.references.len(), 0);
        let (references, balls) = (&mut self.references[start..], &mut self.balls[start..]);
        write_list(list, spheres, frame, references, balls);
        word::LIST | start as u32
    }
}

/// Writes a list that is not empty, with its balls, and fills it up with its last element.
fn write_list(
    list: &[u32],
    spheres: &[[f32; 4]],
    frame: BallFrame,
    references: &mut [u32],
    balls: &mut [u32],
) {
    references[..list.len()].copy_from_slice(list);
    for (ball, shape_index) in balls.iter_mut().zip(list) {
        *ball = frame.ball(spheres[*shape_index as usize]);
    }
    for elements in [references, balls] {
        let last = elements[list.len() - 1];
        elements[list.len()..].fill(last);
        if let Some(end) = elements.last_mut() {
            *end |= LAST;
        }
    }
}

/// Words, references and balls of a grid with one level.
pub(super) struct Flat {
    pub(super) words: Vec<u32>,
    pub(super) references: Vec<u32>,
    pub(super) balls: Vec<u32>,
}

impl Flat {
    /// Makes references and balls of lists.
    pub(super) fn of(cells: &Cells, lists: &Lists, spheres: &[[f32; 4]], margin: f32) -> Self {
        let Lists { shape_indices, starts } = lists;
        let elements = |cell: usize| elements((starts[cell + 1] - starts[cell]) as usize);
        let chunks = ranges(cells.len(), CHUNK);
        let counts = map_parts(chunks.clone(), |cells| cells.map(elements).sum::<usize>());
        let mut end = 0;
        let ends: Vec<usize> = counts
            .into_iter()
            .map(|count| {
                end += count;
                end
            })
            .collect();
        let (mut references, mut balls) = (vec![0; end], vec![0; end]);
        let mut words = empty_words(cells);
        let mut tasks = Vec::with_capacity(chunks.len());
        let targets = split_mut(&mut references, ends.iter().copied());
        let targets = targets.into_iter().zip(split_mut(&mut balls, ends.iter().copied()));
        let mut start = 0;
        for ((chunk, target), words) in chunks.into_iter().zip(targets).zip(words.chunks_mut(CHUNK))
        {
            tasks.push((chunk, start, target, words));
            start += tasks.last().map_or(0, |task| task.2.0.len());
        }
        for_each(tasks, |(chunk, start, (references, balls), words)| {
            let mut at = 0;
            for (cell, word) in chunk.zip(words) {
                let list = &shape_indices[starts[cell] as usize..starts[cell + 1] as usize];
                if list.is_empty() {
                    continue;
                }
                *word = word::LIST | (start + at) as u32;
                let place = at..at + elements(cell);
                at = place.end;
                let frame = BallFrame::new(corner(cells, cell), cells.size, margin);
                let balls = &mut balls[place.clone()];
                write_list(list, spheres, frame, &mut references[place], balls);
            }
        });
        Self { words, references, balls }
    }
}

/// The words of the first level, rounded up to whole units, if all cells are empty.
fn empty_words(cells: &Cells) -> Vec<u32> {
    vec![word::EMPTY; word::in_whole_units(cells.len())]
}
