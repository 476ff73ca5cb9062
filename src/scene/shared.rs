//! The shapes of a scene, with what was computed from them and is kept while they stay.

use std::any::Any;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use crate::geometry::cone::ConeInFrame;

/// Shapes that a scene shares with its copy on a device, and tables of their last picture, which the next one takes.
#[derive(Debug, Default)]
pub(crate) struct SharedShapes {
    /// Centres in the frame of the scene, and radii.
    pub(crate) spheres: Vec<[f32; 4]>,
    /// Their ids come after those of the spheres.
    pub(crate) cones: Vec<ConeInFrame>,
    kept: Mutex<Option<Box<dyn Any + Send>>>,
}

/// A shape of a scene, in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Sphere([f32; 4]),
    Cone(ConeInFrame),
}

impl Shape {
    /// The corners of its bounding box.
    pub(crate) fn corners(self) -> [DVec3; 2] {
        match self {
            Self::Sphere(sphere) => {
                let [x, y, z, radius] = sphere.map(f64::from);
                let center = DVec3::new(x, y, z);
                [center - radius.abs(), center + radius.abs()]
            }
            Self::Cone(cone) => cone.corners(),
        }
    }
}

impl SharedShapes {
    pub(super) fn new(spheres: Vec<[f32; 4]>, cones: Vec<ConeInFrame>) -> Self {
        Self { spheres, cones, kept: Mutex::new(None) }
    }

    /// The spheres, to change them. What is kept is dropped.
    pub(super) fn edit(&mut self) -> &mut [[f32; 4]] {
        *self = Self::new(std::mem::take(&mut self.spheres), std::mem::take(&mut self.cones));
        &mut self.spheres
    }

    /// The number of shapes.
    pub(crate) fn len(&self) -> usize {
        self.spheres.len() + self.cones.len()
    }

    /// The shape with an id, which must be valid.
    #[inline]
    pub(crate) fn shape(&self, id: u32) -> Shape {
        match self.spheres.get(id as usize) {
            Some(sphere) => Shape::Sphere(*sphere),
            None => Shape::Cone(self.cones[id as usize - self.spheres.len()]),
        }
    }

    /// Takes what is kept, if it is of this type. Pictures that are drawn at the same time find nothing.
    pub(crate) fn take<T: Any>(&self) -> Option<T> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        kept.downcast().ok().map(|kept| *kept)
    }

    /// Keeps something that depends on the shapes alone.
    pub(crate) fn keep<T: Any + Send>(&self, kept: T) {
        *self.kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(kept));
    }
}

/// A copy keeps nothing.
impl Clone for SharedShapes {
    fn clone(&self) -> Self {
        Self::new(self.spheres.clone(), self.cones.clone())
    }
}
