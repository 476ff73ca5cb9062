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
        let Some((last, others)) = list.split_last() else {
            return word::EMPTY;
        };
        let start = self.references.len();
        self.references.extend_from_slice(others);
        if let Some(frame) = frame {
            let ball = |shape_index: &u32| frame.ball(spheres[*shape_index as usize]);
            self.balls.extend(others.iter().map(ball));
            let last_ball = ball(last);
            let end = start + ListLayout::Balls.elements(list.len()) - 1;
            self.references.resize(end, *last);
            self.balls.resize(end, last_ball);
            self.balls.push(last_ball | LAST);
        }
        self.references.push(last | LAST);
        word::LIST | start as u32
    }
}
