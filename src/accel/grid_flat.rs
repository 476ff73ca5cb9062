//! The words and lists of a grid in which no cell has a grid of its own: lists become those of the grid where they are, or
//! are copied once, straight to their places.

use std::ops::Range;

use super::ball::BallFrame;
use super::cells::Cells;
use super::grid::{LAST, ListLayout, word};
use super::grid_dense::corner;
use super::grid_lists::write_list;
use super::grid_slabs::Lists;
use super::grid_sort::CHUNK;
use crate::parallel::{for_each, map_parts, ranges, split_mut};

/// Words, references and balls.
pub(super) struct Flat {
    pub(super) words: Vec<u32>,
    pub(super) references: Vec<u32>,
    pub(super) balls: Option<Vec<u32>>,
}

impl Flat {
    /// Makes references of lists.
    pub(super) fn referenced(cells: &Cells, lists: Lists) -> Self {
        let Lists { shape_indices: mut references, starts } = lists;
        let mut words = empty_words(cells);
        let chunks = ranges(cells.len(), CHUNK);
        let ends = chunks.iter().map(|cells| starts[cells.end] as usize);
        let tasks = split_mut(&mut references, ends).into_iter().zip(words.chunks_mut(CHUNK));
        let tasks = chunks.into_iter().zip(tasks).collect();
        for_each(
            tasks,
            |(cells, (references, words)): (Range<usize>, (&mut [u32], &mut [u32]))| {
                let first = starts[cells.start];
                for (word, list) in words.iter_mut().zip(starts[cells.start..=cells.end].windows(2))
                {
                    if list[0] < list[1] {
                        *word = word::LIST | list[0];
                        references[(list[1] - first) as usize - 1] |= LAST;
                    }
                }
            },
        );
        Self { words, references, balls: None }
    }

    /// Makes references and balls of lists.
    pub(super) fn with_balls(
        cells: &Cells,
        lists: &Lists,
        spheres: &[[f32; 4]],
        margin: f32,
    ) -> Self {
        let Lists { shape_indices, starts } = lists;
        let elements =
            |cell: usize| ListLayout::Balls.elements((starts[cell + 1] - starts[cell]) as usize);
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
                write_list(list, spheres, Some(frame), &mut references[place], balls);
            }
        });
        Self { words, references, balls: Some(balls) }
    }
}

/// The words of the first level, rounded up to whole units, if all cells are empty.
fn empty_words(cells: &Cells) -> Vec<u32> {
    vec![word::EMPTY; word::in_whole_units(cells.len())]
}
