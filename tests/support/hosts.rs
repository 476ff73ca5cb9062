//! Matrices of host programs, written down from their definitions.

use pinhole::camera::{DepthOrder, Pose};
use pinhole::glam::{DMat4, DQuat, DVec3, DVec4};

/// The way in which a host program computes depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Convention {
    Perspective,
    Reversed,
    Infinite,
    InfiniteReversed,
    Orthographic,
    OrthographicReversed,
}

impl Convention {
    pub(crate) const ALL: [Self; 6] = [
        Self::Perspective,
        Self::Reversed,
        Self::Infinite,
        Self::InfiniteReversed,
        Self::Orthographic,
        Self::OrthographicReversed,
    ];

    pub(crate) fn order(self) -> DepthOrder {
        match self {
            Self::Perspective | Self::Infinite | Self::Orthographic => DepthOrder::NearIsZero,
            _ => DepthOrder::NearIsOne,
        }
    }

    pub(crate) fn is_orthographic(self) -> bool {
        matches!(self, Self::Orthographic | Self::OrthographicReversed)
    }

    /// The projection whose view plane has these edges: left, right, bottom and top, at the distance 1 for perspective.
    /// `into` is 1 if z grows into the picture, and −1 if it grows towards the viewer.
    pub(crate) fn projection(self, edges: [f64; 4], [near, far]: [f64; 2], into: f64) -> DMat4 {
        let [left, right, bottom, top] = edges;
        let scale = [2.0 / (right - left), 2.0 / (top - bottom)];
        let middle = [(right + left) / 2.0, (top + bottom) / 2.0];
        // Depth is `a · z + b`, divided by z for perspective, where z is the distance into the picture.
        let (a, b) = match self {
            Self::Perspective => (far / (far - near), -near * far / (far - near)),
            Self::Reversed => (-near / (far - near), near * far / (far - near)),
            Self::Infinite => (1.0, -near),
            Self::InfiniteReversed => (0.0, near),
            Self::Orthographic => (1.0 / (far - near), -near / (far - near)),
            Self::OrthographicReversed => (-1.0 / (far - near), far / (far - near)),
        };
        let shift = [0, 1].map(|axis| -middle[axis] * scale[axis]);
        let rows = if self.is_orthographic() {
            [
                DVec4::new(scale[0], 0.0, 0.0, shift[0]),
                DVec4::new(0.0, scale[1], 0.0, shift[1]),
                DVec4::new(0.0, 0.0, a * into, b),
                DVec4::W,
            ]
        } else {
            [
                DVec4::new(scale[0], 0.0, shift[0] * into, 0.0),
                DVec4::new(0.0, scale[1], shift[1] * into, 0.0),
                DVec4::new(0.0, 0.0, a * into, b),
                DVec4::new(0.0, 0.0, into, 0.0),
            ]
        };
        from_rows(rows)
    }
}

pub(crate) fn from_rows([x, y, z, w]: [DVec4; 4]) -> DMat4 {
    DMat4::from_cols(x, y, z, w).transpose()
}

/// The view of a camera at a pose: x right and y up. `into` as in [`Convention::projection`].
pub(crate) fn view(pose: &Pose, into: f64) -> DMat4 {
    let basis = pose.basis();
    let row = |axis: DVec3| axis.extend(-axis.dot(pose.origin()));
    from_rows([row(basis.u()), row(basis.v()), row(-into * basis.w()), DVec4::W])
}

/// Changes that hosts make to a scene: none, a mirror image for a reflecting plane, stretching and shearing, or a place
/// in their world, smaller and turned.
pub(crate) fn changes() -> [DMat4; 4] {
    let mirror = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let stretch = DMat4::from_cols(
        DVec4::new(1.5, 0.2, 0.0, 0.0),
        DVec4::new(0.0, 1.0, -0.3, 0.0),
        DVec4::new(0.1, 0.0, 0.8, 0.0),
        DVec4::W,
    );
    let turn = DQuat::from_rotation_y(0.3);
    let model = DMat4::from_scale_rotation_translation(DVec3::splat(0.1), turn, DVec3::splat(0.4));
    [DMat4::IDENTITY, mirror, stretch, model]
}
