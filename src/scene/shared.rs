//! The spheres of a scene, with what was computed from them and is kept while they stay.

use std::any::Any;
use std::ops::Deref;
use std::sync::{Mutex, PoisonError};

/// Spheres that a scene shares with its copy on a device, and tables of their last picture, which the next one takes.
#[derive(Debug, Default)]
pub(crate) struct SharedSpheres {
    all: Vec<[f32; 4]>,
    kept: Mutex<Option<Box<dyn Any + Send>>>,
}

impl SharedSpheres {
    pub(super) fn new(all: Vec<[f32; 4]>) -> Self {
        Self { all, kept: Mutex::new(None) }
    }

    /// The spheres, to change them. What is kept is dropped.
    pub(super) fn edit(&mut self) -> &mut [[f32; 4]] {
        *self = Self::new(std::mem::take(&mut self.all));
        &mut self.all
    }

    /// Takes what is kept, if it is of this type. Pictures that are drawn at the same time find nothing.
    pub(crate) fn take<T: Any>(&self) -> Option<T> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        kept.downcast().ok().map(|kept| *kept)
    }

    /// Keeps something that depends on the spheres alone.
    pub(crate) fn keep<T: Any + Send>(&self, kept: T) {
        *self.kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(kept));
    }
}

/// A copy keeps nothing.
impl Clone for SharedSpheres {
    fn clone(&self) -> Self {
        Self::new(self.all.clone())
    }
}

impl Deref for SharedSpheres {
    type Target = [[f32; 4]];

    fn deref(&self) -> &Self::Target {
        &self.all
    }
}
