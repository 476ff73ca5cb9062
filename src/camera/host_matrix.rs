//! The matrices of a host program, the direction of its depth, and why they do not make a camera.

use glam::{DMat4, DVec4, Mat4};

use super::CameraError;

/// A matrix of a host program, stored column by column, in f32 or f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostMatrix(DMat4);

/// Which end of the range of depths, from 0 to 1, is at the near plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// Depth is 0 at the near plane and grows with the distance.
    NearIsZero,
    /// Depth is 1 at the near plane and falls with the distance, which is called reversed depth.
    NearIsOne,
}

/// Why matrices of a host program do not make a camera.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HostCameraError {
    /// A number is NaN or infinite.
    #[error("the {matrix} matrix contains a number that is not finite")]
    NotFinite {
        /// The matrix.
        matrix: &'static str,
    },
    /// The view matrix is not affine.
    #[error(
        "the last row of the view matrix is {:?}, but it must be [0, 0, 0, 1]; matrices are given column by column",
        row.to_array()
    )]
    ViewRow {
        /// The last row.
        row: DVec4,
    },
    /// The projection is neither perspective nor orthographic.
    #[error(
        "the last row of the projection matrix is {:?}, but it must be [0, 0, -1, 0] or [0, 0, 1, 0] for perspective, \
         or [0, 0, 0, 1] for an orthographic camera; matrices are given column by column",
        row.to_array()
    )]
    ProjectionRow {
        /// The last row.
        row: DVec4,
    },
    /// A matrix has no inverse.
    #[error("the {matrix} matrix has no inverse, so pixels have no rays")]
    Singular {
        /// The matrix.
        matrix: &'static str,
    },
    /// The vectors of the camera lie nearly in a plane.
    #[error(
        "the directions right, up and forward of the camera lie nearly in one plane (their unit vectors span a volume \
         of {volume:?}), so f32 cannot tell the rays of pixels apart"
    )]
    Flat {
        /// The volume of the box that the three unit vectors span.
        volume: f64,
    },
    /// Depth does not depend on the distance, or its numbers are out of range.
    #[error(
        "the third row of the projection matrix is {:?}, which gives no depth that f32 can represent", row.to_array()
    )]
    NoDepth {
        /// The third row.
        row: DVec4,
    },
    /// Depth runs in the other direction.
    #[error(
        "{given:?} was given, but the projection matrix maps the near plane to the other end; give {:?}", given.other()
    )]
    Order {
        /// The direction that was given.
        given: DepthOrder,
    },
    /// The eye or the view plane is out of range.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

impl DepthOrder {
    pub(super) const fn other(self) -> Self {
        match self {
            Self::NearIsZero => Self::NearIsOne,
            Self::NearIsOne => Self::NearIsZero,
        }
    }
}

impl HostMatrix {
    pub(super) fn finite(self, matrix: &'static str) -> Result<DMat4, HostCameraError> {
        if self.0.is_finite() { Ok(self.0) } else { Err(HostCameraError::NotFinite { matrix }) }
    }
}

impl From<DMat4> for HostMatrix {
    fn from(matrix: DMat4) -> Self {
        Self(matrix)
    }
}

impl From<Mat4> for HostMatrix {
    fn from(matrix: Mat4) -> Self {
        Self(matrix.as_dmat4())
    }
}

impl From<[[f64; 4]; 4]> for HostMatrix {
    fn from(columns: [[f64; 4]; 4]) -> Self {
        Self(DMat4::from_cols_array_2d(&columns))
    }
}

impl From<[[f32; 4]; 4]> for HostMatrix {
    fn from(columns: [[f32; 4]; 4]) -> Self {
        Self(Mat4::from_cols_array_2d(&columns).as_dmat4())
    }
}

impl From<[f64; 16]> for HostMatrix {
    fn from(numbers: [f64; 16]) -> Self {
        Self(DMat4::from_cols_array(&numbers))
    }
}

impl From<[f32; 16]> for HostMatrix {
    fn from(numbers: [f32; 16]) -> Self {
        Self(Mat4::from_cols_array(&numbers).as_dmat4())
    }
}
