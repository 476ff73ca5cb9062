//! The cameras of a live picture, now and in the frame before.

use glam::DVec3;

use crate::camera::film::{Film, YAxis};
use crate::camera::{Camera, CameraKind, CameraVectors};
use crate::gpu::passes::lit::LiveView;

/// The value of `has_before` for a frame before with another view, and with the same view.
const OTHER_VIEW: u32 = 1;
const SAME_VIEW: u32 = 2;

/// A camera whose points can be found in pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SeenFrom {
    kind: CameraKind,
    vectors: CameraVectors,
}

impl SeenFrom {
    pub(super) fn new(camera: &dyn Camera) -> Self {
        Self { kind: camera.kind(), vectors: camera.vectors() }
    }

    /// Whether the place of a point on the film is a linear map, divided by one.
    fn is_linear(self) -> bool {
        matches!(self.kind, CameraKind::Pinhole | CameraKind::ThinLens | CameraKind::Orthographic)
    }
}

/// The record of a frame seen by the camera `now`. `before` is the camera of a frame before that shows the same surfaces; `most` are the maximum
/// numbers of frames over which the shares of lamps and of ambient light are averaged.
pub(super) fn record(
    now: SeenFrom,
    film: &Film,
    before: Option<SeenFrom>,
    most: [u32; 2],
) -> LiveView {
    let CameraVectors { origin, right, up, forward, .. } = now.vectors;
    let narrow = |v: DVec3| v.as_vec3().to_array();
    let is_parallel = now.kind == CameraKind::Orthographic;
    let height = f64::from(film.height());
    let at_one = if is_parallel { 1.0 } else { forward.length() };
    let mut record = LiveView {
        right: narrow(right),
        is_parallel: is_parallel.into(),
        up: narrow(up),
        footprint: (2.0 * up.length() / (height * at_one)) as f32,
        forward: narrow(forward),
        y_sign: match film.y_axis() {
            YAxis::Up => 1.0,
            YAxis::Down => -1.0,
        },
        most_lamps: most[0],
        most_open: most[1],
        size: [film.width(), film.height()],
        ..bytemuck::Zeroable::zeroed()
    };
    if let Some(before) = before {
        if before == now {
            record.has_before = SAME_VIEW;
        } else if before.kind == now.kind && now.is_linear() {
            let CameraVectors { origin: old, right, up, forward, .. } = before.vectors;
            let dual = |a: DVec3, b: DVec3, of: DVec3| narrow(a.cross(b) / of.dot(a.cross(b)));
            record.has_before = OTHER_VIEW;
            record.shift = narrow(origin - old);
            record.across = dual(up, forward, right);
            record.down = dual(forward, right, up);
            record.along = dual(right, up, forward);
        }
    }
    record
}
