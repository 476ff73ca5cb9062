//! The lists of cells under construction.

use super::ball::BallFrame;
use super::grid::{LAST, ListLayout, word};

/// References, list after list, and a ball beside each if the layout has balls.
#[derive(Default)]
pub(super) struct BuiltLists {
    pub(super) references: Vec<u32>,
    pub(super) balls: Vec<u32>,
}

impl BuiltLists {
    pub(super) fn with_capacity(listed: usize, layout: ListLayout) -> Self {
        let balls = if layout == ListLayout::Balls { listed } else { 0 };
        Self { references: Vec::with_capacity(listed), balls: Vec::with_capacity(balls) }
    }

    /// Appends the list of a cell, and returns the word of the cell. `frame` is that of its balls, if it has balls.
    pub(super) fn append(
        &mut self,
        list: &[u32],
        spheres: &[[f32; 4]],
        frame: Option<BallFrame>,
    ) -> u32 {
        if list.is_empty() {
            return word::EMPTY;
        }
        let (start, balls_start) = (self.references.len(), self.balls.len());
        let layout = if frame.is_some() { ListLayout::Balls } else { ListLayout::Referenced };
        self.references.resize(start + layout.elements(list.len()), 0);
        if frame.is_some() {
            self.balls.resize(self.references.len(), 0);
        }
        let (references, balls) = (&mut self.references[start..], &mut self.balls[balls_start..]);
        write_list(list, spheres, frame, references, balls);
        word::LIST | start as u32
    }
}

/// Writes a list that is not empty, with its balls if there is a frame, and fills it up with its last element.
pub(super) fn write_list(
    list: &[u32],
    spheres: &[[f32; 4]],
    frame: Option<BallFrame>,
    references: &mut [u32],
    balls: &mut [u32],
) {
    fn fill_up(elements: &mut [u32], len: usize) {
        let last = elements[len - 1];
        elements[len..].fill(last);
        if let Some(end) = elements.last_mut() {
            *end |= LAST;
        }
    }
    references[..list.len()].copy_from_slice(list);
    fill_up(references, list.len());
    if let Some(frame) = frame {
        for (ball, shape_index) in balls.iter_mut().zip(list) {
            *ball = frame.ball(spheres[*shape_index as usize]);
        }
        fill_up(balls, list.len());
    }
}
