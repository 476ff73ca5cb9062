//! Caps: the directions in which a sphere is seen, with a border in which it hides a part of them.

use glam::Vec3;

/// A sphere hides the part a · d + b of a direction d, but not more than `most`.
pub(super) struct Cap {
    pub(super) a: Vec3,
    pub(super) b: f32,
    pub(super) most: f32,
}

impl Cap {
    /// Counts a cap among the hidden parts of directions, whose components lie side by side. Of caps that overlap, the one
    /// that hides most of a direction counts.
    #[inline]
    pub(super) fn hide(&self, [x, y, z]: [&[f32]; 3], hidden: &mut [f32]) {
        let Self { a, b, most } = *self;
        let count = hidden.len();
        let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
        for k in 0..count {
            let hides = a.x * x[k] + a.y * y[k] + a.z * z[k] + b;
            let hides = if hides < most { hides } else { most };
            hidden[k] = if hidden[k] > hides { hidden[k] } else { hides };
        }
    }
}
