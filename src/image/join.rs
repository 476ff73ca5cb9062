//! Joining two images side by side.

use super::{Image, ImageTooLarge};

impl Image {
    /// Joins two images of the same height, with the layers that both have.
    ///
    /// # Errors
    /// Returns an error if the memory cannot be reserved.
    pub fn side_by_side([left, right]: [&Self; 2]) -> Result<Self, ImageTooLarge> {
        let in_both = left.layers().iter().filter(|layer| right.layers().contains(*layer));
        let (width, height) = (left.width + right.width, left.height.min(right.height));
        let mut both = Self::new(width, height, in_both.collect())?;
        let sides = [left.width as usize, right.width as usize];
        joined(&mut both.color, [&left.color, &right.color], sides);
        join(&mut both.alpha, [&left.alpha, &right.alpha], sides);
        join(&mut both.depth, [&left.depth, &right.depth], sides);
        join(&mut both.normal, [&left.normal, &right.normal], sides);
        join(&mut both.position, [&left.position, &right.position], sides);
        join(&mut both.albedo, [&left.albedo, &right.albedo], sides);
        join(&mut both.id, [&left.id, &right.id], sides);
        join(&mut both.samples, [&left.samples, &right.samples], sides);
        join(&mut both.variance, [&left.variance, &right.variance], sides);
        Ok(both)
    }
}

fn join<T: Copy>(both: &mut Option<Vec<T>>, sides: [&Option<Vec<T>>; 2], widths: [usize; 2]) {
    if let (Some(both), [Some(left), Some(right)]) = (both, sides) {
        joined(both, [left, right], widths);
    }
}

/// Copies each row of the left image and of the right image into the joined row.
fn joined<T: Copy>(both: &mut [T], [left, right]: [&[T]; 2], [a, b]: [usize; 2]) {
    let rows = left.chunks(a).zip(right.chunks(b));
    for (both, (left, right)) in both.chunks_mut(a + b).zip(rows) {
        both[..a].copy_from_slice(left);
        both[a..].copy_from_slice(right);
    }
}
