//! The camera of a host program, given by the view and projection matrices with which the host rasterizes.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Mat4};

use super::{Camera, CameraError, CameraKind, CameraVectors, sealed};
use crate::geometry::ray::Ray;

/// The smallest volume of the box spanned by the unit vectors along right, up and forward. Below it, most digits of a
/// ray in f32 would be rounding errors.
const LEAST_VOLUME: f64 = 1.0 / 4096.0;

/// The range of the numbers for computing clip depth, within which they are normal in f32.
const DEPTH_NUMBERS: std::ops::RangeInclusive<f64> = 1e-18..=1e18;

/// A pinhole or orthographic camera, made from the matrices of a host program.
///
/// Its rays match the host's rasterizer. The ray of a pixel is the line of all points that the two matrices project to
/// the pixel's centre, and row 0 of a film with y up is the top row of the host's target. That holds for any camera
/// that two such matrices describe: shifted frusta, pixels that are not square, a view that scales, shears or mirrors,
/// left-handed and right-handed views. Distances are in units of the space that the view matrix maps from, which must
/// be that of the scene. To place a scene in the host's world, pass the product of the host's view and the scene's
/// model matrix as the view.
///
/// The ray of a perspective camera starts at the eye, and that of an orthographic camera at the near plane. Near and
/// far planes have no other effect on rays, and do not cut spheres. So a perspective near plane may be oblique.
/// oblique, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostCamera {
    kind: CameraKind,
    vectors: CameraVectors,
    /// The rows of the linear map from world space to (x, y, w) of clip space, each with its constant term.
    rows: [DVec4; 3],
    depth: ClipDepth,
    order: DepthOrder,
}

/// The relation of clip depth to a location on the film and the distance along the unit ray.
///
/// For a pinhole camera, clip depth is `film · (x, y, 1) + slope · length / distance`, where `length` is that of the
/// vector to the view plane, `x · right + y · up + forward`. For an orthographic camera it is `film · (x, y, 1) + slope
/// · distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClipDepth {
    pub(crate) film: DVec3,
    pub(crate) slope: f64,
}

impl HostCamera {
    /// Makes the camera from two matrices, both stored column by column as in WGSL and glam.
    ///
    /// `view` is an invertible affine map from world space to view space. `projection` maps view space to the clip
    /// space of WebGPU, where y is up and depth is from 0 to 1, and `order` says which end of the range is at the near
    /// plane. The far plane may be infinitely far away.
    ///
    /// # Errors
    /// Returns an error if a number is not finite, a matrix is nearly singular, the last row of the view is not (0, 0,
    /// 0, 1), that of the projection is neither (0, 0, ±1, 0), as for perspective, nor (0, 0, 0, 1), depth does not run
    /// as `order` says, or the eye or a length of the view plane is out of the range of f32 kernels.
    pub fn new(
        view: impl Into<HostMatrix>,
        projection: impl Into<HostMatrix>,
        order: DepthOrder,
    ) -> Result<Self, HostCameraError> {
        let view = view.into().finite("view")?;
        let projection = projection.into().finite("projection")?;
        let last = view.row(3);
        // An inverse that was computed in f32 may have an element that is not quite 1.
        if last.truncate() != DVec3::ZERO || (last.w - 1.0).abs() > 1e-3 {
            return Err(HostCameraError(format!(
                "the last row of the view matrix is {:?}, but it must be [0, 0, 0, 1]; matrices are given column by \
                 column",
                last.to_array()
            )));
        }
        let to_view = DMat3::from_mat4(view) * (1.0 / last.w);
        let offset = view.w_axis.truncate() / last.w;
        let singular =
            |matrix: &str| HostCameraError(format!("the {matrix} matrix has no inverse, so pixels have no rays"));
        let to_world = inverse(to_view).ok_or_else(|| singular("view"))?;
        let rows = [0, 1, 2, 3].map(|row| projection.row(row));
        let [x, y, depth, w] = rows;
        let in_view = match w.to_array() {
            [0.0, 0.0, -1.0 | 1.0, 0.0] => InView::perspective(x, y, depth, w),
            [0.0, 0.0, 0.0, 1.0] => InView::orthographic(x, y, depth, order),
            row => {
                return Err(HostCameraError(format!(
                    "the last row of the projection matrix is {row:?}, but it must be [0, 0, -1, 0] or [0, 0, 1, 0] for \
                     perspective, or [0, 0, 0, 1] for an orthographic camera; matrices are given column by column"
                )));
            }
        }
        .ok_or_else(|| singular("projection"))?;
        let InView { kind, origin, right, up, forward, film, slope } = in_view;
        let [right, up, forward] = [right, up, forward].map(|vector| to_world * vector);
        let origin = to_world * (origin - offset);
        // Orthographic cameras have unit vectors along their rays.
        let scale = if kind == CameraKind::Orthographic { forward.length() } else { 1.0 };
        let vectors = CameraVectors::checked([origin, right, up, forward / scale, DVec3::ZERO])?;
        let units = [right, up, forward].map(DVec3::normalize_or_zero);
        let volume = units[0].cross(units[1]).dot(units[2]).abs();
        // NaN is in no range.
        if !(LEAST_VOLUME..).contains(&volume) {
            return Err(HostCameraError(format!(
                "the directions right, up and forward of the camera lie nearly in one plane (their unit vectors span a \
                 volume of {volume:?}), so f32 cannot tell the rays of pixels apart"
            )));
        }
        let slope = slope / scale;
        if !DEPTH_NUMBERS.contains(&slope.abs()) || !(0.0..=1e18).contains(&film.abs().max_element()) {
            return Err(HostCameraError(format!(
                "the third row of the projection matrix is {:?}, which gives no depth that f32 can represent",
                depth.to_array()
            )));
        }
        // 1/distance falls as the distance grows.
        let rises = if kind == CameraKind::Pinhole { slope < 0.0 } else { slope > 0.0 };
        if rises != (order == DepthOrder::NearIsZero) {
            let other = match order {
                DepthOrder::NearIsZero => DepthOrder::NearIsOne,
                DepthOrder::NearIsOne => DepthOrder::NearIsZero,
            };
            return Err(HostCameraError(format!(
                "{order:?} was given, but the projection matrix maps the near plane to the other end; give {other:?}"
            )));
        }
        let in_world = |row: DVec4| {
            let turned = to_view.transpose() * row.truncate();
            turned.extend(row.truncate().dot(offset) + row.w)
        };
        let rows = [x, y, w].map(in_world);
        Ok(Self { kind, vectors, rows, depth: ClipDepth { film, slope }, order })
    }

    /// The end of the range of depths that is at the near plane.
    #[must_use]
    pub fn depth_order(&self) -> DepthOrder {
        self.order
    }

    /// The host's depth of the point at a distance along the ray of a relative location. It is not clamped, so a point
    /// in front of the near plane, or behind the far plane, has a depth below 0 or above 1.
    #[must_use]
    pub fn clip_depth(&self, location: DVec2, distance: f64) -> f64 {
        let ClipDepth { film, slope } = self.depth;
        let start = film.dot(location.extend(1.0));
        match self.kind {
            CameraKind::Pinhole => start + slope * self.toward(location).length() / distance,
            _ => start + slope * distance,
        }
    }

    /// The distance along the ray of a relative location at which the host's depth is `depth`. It is the inverse of
    /// [`HostCamera::clip_depth`], and infinite or negative if no point in front of the camera has this depth.
    #[must_use]
    pub fn distance_of(&self, location: DVec2, depth: f64) -> f64 {
        let ClipDepth { film, slope } = self.depth;
        let rest = depth - film.dot(location.extend(1.0));
        match self.kind {
            CameraKind::Pinhole => slope * self.toward(location).length() / rest,
            _ => rest / slope,
        }
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn depth(&self) -> ClipDepth {
        self.depth
    }

    /// The vector from the eye to the view plane, on which the last coordinate of clip space is 1.
    fn toward(&self, location: DVec2) -> DVec3 {
        let CameraVectors { right, up, forward, .. } = self.vectors;
        location.x * right + location.y * up + forward
    }
}

/// A camera in the host's view space. The length of `forward` of an orthographic camera changes depth by one.
struct InView {
    kind: CameraKind,
    origin: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    film: DVec3,
    slope: f64,
}

impl InView {
    /// A camera whose vectors `x · right + y · up + forward` have the clip coordinates x, y and w = 1, and whose eye
    /// has no clip coordinates. `None` if the rows do not define one.
    fn perspective(x: DVec4, y: DVec4, depth: DVec4, w: DVec4) -> Option<Self> {
        let rows = DMat3::from_cols(x.truncate(), y.truncate(), w.truncate()).transpose();
        let DMat3 { x_axis: right, y_axis: up, z_axis: forward } = inverse(rows)?;
        let origin = -(x.w * right + y.w * up + w.w * forward);
        let film = DVec3::from_array([right, up, forward].map(|v| depth.truncate().dot(v)));
        let slope = depth.truncate().dot(origin) + depth.w;
        Some(Self { kind: CameraKind::Pinhole, origin, right, up, forward, film, slope })
    }

    fn orthographic(x: DVec4, y: DVec4, depth: DVec4, order: DepthOrder) -> Option<Self> {
        let rows = DMat3::from_cols(x.truncate(), y.truncate(), depth.truncate()).transpose();
        let to_view = inverse(rows)?;
        let (near, toward_far) = match order {
            DepthOrder::NearIsZero => (0.0, 1.0),
            DepthOrder::NearIsOne => (1.0, -1.0),
        };
        Some(Self {
            kind: CameraKind::Orthographic,
            origin: to_view * (DVec3::new(-x.w, -y.w, near - depth.w)),
            right: to_view.x_axis,
            up: to_view.y_axis,
            forward: toward_far * to_view.z_axis,
            film: DVec3::new(0.0, 0.0, near),
            slope: toward_far,
        })
    }
}

/// The inverse of a matrix. `None` if it has numbers that are not finite.
fn inverse(matrix: DMat3) -> Option<DMat3> {
    // Rows of very different lengths are common, so they are first scaled to one length.
    let lengths = DVec3::from_array([0, 1, 2].map(|row| matrix.row(row).length()));
    if lengths.min_element() == 0.0 {
        return None;
    }
    let scale = DMat3::from_diagonal(1.0 / lengths);
    let scaled = scale * matrix;
    (scaled.determinant().abs() > 1e-12).then(|| scaled.inverse() * scale)
}

impl sealed::Sealed for HostCamera {}

impl Camera for HostCamera {
    fn kind(&self) -> CameraKind {
        self.kind
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        let CameraVectors { origin, right, up, forward, .. } = self.vectors;
        match self.kind {
            CameraKind::Pinhole => {
                // Never zero, because the three vectors do not lie in one plane.
                let toward = self.toward(location);
                Ray { origin, direction: toward / toward.length() }
            }
            _ => Ray { origin: origin + location.x * right + location.y * up, direction: forward },
        }
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let [x, y, w] = self.rows.map(|row| row.dot(point_in_world.extend(1.0)));
        let location = DVec2::new(x, y) / w;
        (w > 0.0 && location.is_finite()).then_some(location)
    }

    fn vectors(&self) -> CameraVectors {
        self.vectors
    }
}

/// A matrix of a host program, stored column by column, in f32 or f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HostMatrix(DMat4);

/// The end of the range of depths, from 0 to 1, that is at the near plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// Depth is 0 at the near plane and grows with the distance.
    NearIsZero,
    /// Depth is 1 at the near plane and falls with the distance. This is called reversed depth.
    NearIsOne,
}

/// The reason why matrices of a host program do not make a camera, and what would be right.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct HostCameraError(String);

impl From<CameraError> for HostCameraError {
    fn from(error: CameraError) -> Self {
        Self(error.to_string())
    }
}

impl HostMatrix {
    fn finite(self, matrix: &str) -> Result<DMat4, HostCameraError> {
        let error = || format!("the {matrix} matrix contains a number that is not finite");
        if self.0.is_finite() { Ok(self.0) } else { Err(HostCameraError(error())) }
    }
}

macro_rules! from_matrices {
    ($($matrix:ty: $convert:expr;)+) => {$(
        impl From<$matrix> for HostMatrix {
            fn from(matrix: $matrix) -> Self {
                Self($convert(&matrix))
            }
        }
    )+};
}
from_matrices! {
    DMat4: DMat4::clone;
    Mat4: Mat4::as_dmat4;
    [[f64; 4]; 4]: DMat4::from_cols_array_2d;
    [[f32; 4]; 4]: |columns| Mat4::from_cols_array_2d(columns).as_dmat4();
    [f64; 16]: DMat4::from_cols_array;
    [f32; 16]: |numbers| Mat4::from_cols_array(numbers).as_dmat4();
}
