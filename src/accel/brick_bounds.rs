//! The boxes of bricks.

use glam::Vec3;

use crate::parallel::map_chunks;

/// The bounding boxes of the spheres of a brick and of their centres, in the scene's frame. Both are empty if there are
/// no spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BrickBounds {
    pub(crate) center_min: Vec3,
    pub(crate) center_max: Vec3,
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl BrickBounds {
    pub(crate) const EMPTY: Self =
        Self { center_min: Vec3::MAX, center_max: Vec3::MIN, min: Vec3::MAX, max: Vec3::MIN };

    /// The boxes of the spheres of a brick.
    pub(crate) fn of_spheres(spheres: &[[f32; 4]]) -> Self {
        Self::joined(map_chunks(spheres, |_, spheres| spheres.iter().fold(Self::EMPTY, Self::with)))
    }

    /// The boxes of the spheres with the given indices.
    pub(crate) fn of_ids(spheres: &[[f32; 4]], ids: &[u32]) -> Self {
        let with = |all: Self, id: &u32| all.with(&spheres[*id as usize]);
        Self::joined(map_chunks(ids, |_, ids| ids.iter().fold(Self::EMPTY, with)))
    }

    /// Whether there are no spheres.
    pub(crate) fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    fn with(self, &[x, y, z, radius]: &[f32; 4]) -> Self {
        let center = Vec3::new(x, y, z);
        Self {
            center_min: self.center_min.min(center),
            center_max: self.center_max.max(center),
            min: self.min.min(center - radius),
            max: self.max.max(center + radius),
        }
    }

    fn joined(parts: Vec<Self>) -> Self {
        parts.into_iter().fold(Self::EMPTY, |all, part| Self {
            center_min: all.center_min.min(part.center_min),
            center_max: all.center_max.max(part.center_max),
            min: all.min.min(part.min),
            max: all.max.max(part.max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_those_of_spheres_and_of_ids() {
        let spheres = [[1.0, 2.0, 3.0, 0.5], [-1.0, 2.0, 3.0, 0.25], [9.0, 9.0, 9.0, 1.0]];
        let bounds = BrickBounds::of_spheres(&spheres[..2]);
        assert_eq!(bounds, BrickBounds::of_ids(&spheres, &[1, 0]));
        assert_eq!(bounds.min, Vec3::new(-1.25, 1.5, 2.5));
        assert_eq!(bounds.max, Vec3::new(1.5, 2.5, 3.5));
        assert_eq!(bounds.center_min, Vec3::new(-1.0, 2.0, 3.0));
        assert!(!bounds.is_empty() && BrickBounds::of_spheres(&[]).is_empty());
    }
}
