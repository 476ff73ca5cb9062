//! Values for one picture, or for the two pictures of a stereo camera.

use super::input::Input;
use crate::memory;
use pinhole::camera::View;
use pinhole::camera::film::Film;
use pinhole::image::LayerSet;

/// A value for one picture, or two values for the left and the right eye.
pub(super) enum Views<T> {
    One(T),
    Two([T; 2]),
}

impl<T> Views<T> {
    pub(super) fn as_slice(&self) -> &[T] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Two(two) => two,
        }
    }

    pub(super) fn as_mut_slice(&mut self) -> &mut [T] {
        match self {
            Self::One(one) => std::slice::from_mut(one),
            Self::Two(two) => two,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.as_slice().len()
    }

    /// Applies `f` to each value.
    pub(super) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Views<U> {
        match self {
            Self::One(one) => Views::One(f(one)),
            Self::Two(two) => Views::Two(two.map(f)),
        }
    }

    /// Applies `f` to each value, and returns the first error if there is one.
    pub(super) fn try_each<U, E>(
        &self,
        mut f: impl FnMut(&T) -> Result<U, E>,
    ) -> Result<Views<U>, E> {
        Ok(match self {
            Self::One(one) => Views::One(f(one)?),
            Self::Two([left, right]) => Views::Two([f(left)?, f(right)?]),
        })
    }
}

impl<'a> Views<View<'a>> {
    pub(super) fn of(input: &'a Input) -> Self {
        Self::on_film(input, input.film)
    }

    /// The same on another film, such as a part of it.
    pub(super) fn on_film(input: &'a Input, film: Film) -> Self {
        match &input.eyes {
            None => Self::One(View::new(input.camera.as_ref(), film)),
            Some(eyes) => {
                let [left, right] = eyes.each_ref();
                Self::Two([left, right].map(|eye| View::new(eye.as_ref(), film)))
            }
        }
    }

    /// The film, which is the same for both eyes.
    pub(super) fn film(&self) -> Film {
        match self {
            Self::One(view) | Self::Two([view, _]) => view.film,
        }
    }

    /// Returns the bytes per pixel that are needed in addition to the layers of one picture.
    pub(super) fn extra_bytes_per_pixel(&self, layers: LayerSet) -> u64 {
        let encoding = memory::ENCODING_BYTES_PER_PIXEL;
        match self {
            Self::One(_) => encoding,
            // The other picture, and a picture of twice the width that joins both.
            Self::Two(_) => 3 * layers.bytes_per_pixel() + 2 * encoding,
        }
    }
}
