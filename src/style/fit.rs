//! Chooses the values of a style that depend on the spheres and the camera.

use glam::DVec3;

use super::Style;
use crate::camera::{Camera, View};
use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use crate::geometry::subject::Subject;
use crate::light::Ground;
use crate::render::{Integrator, RenderSettings, Studio};
use crate::scene::Scene;

/// Which values a scene file gives itself. The style does not choose these.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Given {
    pub(crate) occlusion_radius: bool,
    pub(crate) outline: bool,
    pub(crate) outline_depth: bool,
    pub(crate) ground: bool,
    /// Whether the file names lights, a sun or a sky.
    pub(crate) light: bool,
}

/// The mean radius of spheres, in pixels, below which lines would hide what they are drawn around.
const LEAST_RADIUS_IN_PIXELS: f64 = 3.0;

/// Chooses the values of a style for a scene and a view of it, except those that the scene file gives.
pub(crate) fn fit(
    settings: &mut RenderSettings,
    style: Style,
    given: Given,
    scene: &Scene,
    view: &View<'_>,
) {
    let subject = scene.subject();
    let Some(radius) = subject.mean_radius() else { return };
    if let Integrator::Studio(studio) = &mut settings.integrator {
        fit_occlusion(studio, given, &subject, radius);
        fit_outline(studio, style, given, &subject, radius, view);
    }
    if let (Some(ground), false) = (&mut settings.ground, given.ground) {
        settings.ground = fit_ground(ground, &subject, view.camera);
    }
}

/// Occlusion reaches as far as pockets are deep: a part of the extent of the data, and at least some radii, so that
/// neighbours darken each other.
fn fit_occlusion(studio: &mut Studio, given: Given, subject: &Subject<'_>, radius: f64) {
    if let (Some(occlusion), false) = (&mut studio.occlusion, given.occlusion_radius) {
        let extent = subject.bounds().size().length();
        let reach = (0.2 * extent).max(6.0 * radius);
        occlusion.radius = Some(reach.clamp(MIN_LENGTH, MAX_LENGTH));
    }
}

/// Lines are drawn where one sphere stands clearly in front of another, by a part of a radius, and nowhere if spheres
/// are only a few pixels wide.
fn fit_outline(
    studio: &mut Studio,
    style: Style,
    given: Given,
    subject: &Subject<'_>,
    radius: f64,
    view: &View<'_>,
) {
    let Some(outline) = &mut studio.outline else { return };
    let middle = subject.bounds().center();
    let is_tiny = radius_in_pixels(view, middle, radius)
        .is_some_and(|pixels| pixels < LEAST_RADIUS_IN_PIXELS);
    if is_tiny && !given.outline {
        studio.outline = None;
        return;
    }
    if !given.outline_depth {
        let jump = if style == Style::Illustration { 0.35 } else { 0.7 } * radius;
        let distance = (middle - view.camera.vectors().origin).length();
        // Outlines compare a jump with the distance to the camera.
        outline.depth = (jump / distance.max(jump)).clamp(0.0, 1.0) as f32;
    }
}

/// The radius of a sphere at a point on the picture, in pixels; `None` if the camera cannot tell.
fn radius_in_pixels(view: &View<'_>, point: DVec3, radius: f64) -> Option<f64> {
    let upward = view.camera.vectors().up.normalize_or_zero();
    let at = |point: DVec3| view.camera.location_of(point);
    let half = at(point + radius * upward)? - at(point)?;
    Some(half.length() * 0.5 * f64::from(view.film.height()))
}

/// A ground that touches the spheres on the side that is down in the picture, along an axis of the world; `None` where
/// the camera looks along it or from below.
fn fit_ground(ground: &Ground, subject: &Subject<'_>, camera: &dyn Camera) -> Option<Ground> {
    let vectors = camera.vectors();
    let [up, forward] = [vectors.up, vectors.forward].map(DVec3::normalize_or_zero);
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let normal = axes.max_by(|a, b| a.dot(up).total_cmp(&b.dot(up)))?;
    let [down] = subject.supports([-normal]);
    let point = subject.bounds().center() - down * normal;
    (forward.dot(normal) < -0.1).then_some(Ground { point, normal, ..*ground })
}
