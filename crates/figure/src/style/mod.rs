//! Styles: named sets of a scene file's tables about light, with values that are chosen from the data.
//!
//! Each style is one commented file `src/style/NAME.toml`, which [`SceneFile`](crate::scene_file::SceneFile) reads where
//! a scene names it with `style = "NAME"`. What such a file cannot say, because it depends on the spheres and the
//! camera, is chosen in one place: `fit`.

use glam::DVec3;

use pinhole::camera::{Camera, View};
use pinhole::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use pinhole::geometry::subject::Subject;
use pinhole::light::Ground;
use pinhole::render::{Integrator, Outline, RenderSettings, Studio};
use pinhole::scene::Scene;

/// A named look of a picture: everything about light, lines and the background.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Style {
    /// Soft light without cast shadows, ambient occlusion and thin lines: the style of data files.
    #[default]
    Default,
    /// One ray for each pixel, lit from the eye.
    Fast,
    /// Colours without light, with lines.
    Flat,
    /// Soft shadows and smooth ambient occlusion.
    Studio,
    /// Bright colours and strong lines, as a textbook draws.
    Illustration,
    /// Path tracing under a soft sky and a sun, over a ground.
    Path,
    /// Light that adds up, as that of stars, on black.
    Stars,
}

impl Style {
    /// All styles.
    pub const ALL: &'static [Self] =
        &[Self::Default, Self::Fast, Self::Flat, Self::Studio, Self::Illustration, Self::Path, Self::Stars];

    /// The name in scene files and flags.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Fast => "fast",
            Self::Flat => "flat",
            Self::Studio => "studio",
            Self::Illustration => "illustration",
            Self::Path => "path",
            Self::Stars => "stars",
        }
    }

    /// The style of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|style| style.name() == name)
    }

    /// The tables of the style, as the text of a scene file.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Default => include_str!("default.toml"),
            Self::Fast => include_str!("fast.toml"),
            Self::Flat => include_str!("flat.toml"),
            Self::Studio => include_str!("studio.toml"),
            Self::Illustration => include_str!("illustration.toml"),
            Self::Path => include_str!("path.toml"),
            Self::Stars => include_str!("stars.toml"),
        }
    }
}

/// Which values a scene file gives itself. The style does not choose these.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OwnValues {
    pub(crate) occlusion_radius: bool,
    pub(crate) occlusion_samples: bool,
    pub(crate) smooth: bool,
    pub(crate) dense: bool,
    pub(crate) denoise: bool,
    pub(crate) outline: bool,
    /// Whether a flag gives an outline, and the file does not.
    pub(crate) outline_by_flag: bool,
    pub(crate) outline_depth: bool,
    pub(crate) ground: bool,
    /// Whether the file names lights, a sun or a sky.
    pub(crate) light: bool,
}

/// The mean radius of spheres, in pixels, below which lines would hide what they are drawn around.
const LEAST_RADIUS_IN_PIXELS: f64 = 3.0;

/// The mean radius of spheres, in pixels, from which on pixels and their neighbours show most spheres that they touch.
const LEAST_RADIUS_OF_EDGES: f64 = 2.0;

/// The radius of the thinnest cylinder or cone, in pixels, below which rays in the middles of pixels may miss it.
const LEAST_RADIUS_OF_CONES: f64 = 0.5;

/// Chooses the values of a style for a scene and a view of it, except those that the scene file gives.
pub(crate) fn fit(settings: &mut RenderSettings, style: Style, given: OwnValues, scene: &Scene, view: &View<'_>) {
    let subject = scene.subject();
    let is_smooth = |settings: &RenderSettings| settings.is_smooth(scene, view.camera);
    let widths = scene.cones().iter().map(|cone| cone.first_radius.abs().max(cone.second_radius.abs()));
    let thinnest = widths
        .reduce(f32::min)
        .and_then(|radius| radius_in_pixels(view, scene.bounds_to_frame().center(), radius.into()));
    let are_thin = thinnest.is_some_and(|radius| radius < LEAST_RADIUS_OF_CONES);
    let Some(radius) = subject.mean_radius() else { return fit_smooth(settings, given, are_thin, is_smooth) };
    if let Integrator::Studio(studio) = &mut settings.integrator {
        fit_occlusion(studio, given, &subject, radius);
        fit_outline(studio, style, given, &subject, radius, view);
    }
    if let (Some(ground), false) = (&mut settings.ground, given.ground) {
        settings.ground = fit_ground(ground, &subject, view.camera);
    }
    let pixels = radius_in_pixels(view, subject.bounds().center(), radius);
    let is_small = are_thin || pixels.is_some_and(|radius| radius < LEAST_RADIUS_OF_EDGES);
    fit_smooth(settings, given, is_small, is_smooth);
}

/// Nothing is random, and no noise is removed, if the picture allows it, unless a number of random rays is asked for. All
/// pixels have several rays if spheres are small, or cylinders thin.
fn fit_smooth(
    settings: &mut RenderSettings,
    given: OwnValues,
    is_small: bool,
    is_smooth: impl Fn(&RenderSettings) -> bool,
) {
    if !settings.studio_parameters().is_some_and(|studio| studio.is_smooth) {
        return;
    }
    let is_refused = !given.smooth && given.occlusion_samples;
    let denoise = settings.sampling.denoise;
    settings.sampling.denoise &= given.denoise;
    let is_smooth = !is_refused && is_smooth(settings);
    let Integrator::Studio(studio) = &mut settings.integrator else { return };
    if is_smooth {
        studio.is_dense = if given.dense { studio.is_dense } else { is_small };
    } else {
        settings.sampling.denoise = denoise;
        // What the file asks for stays, so that a note can say why it is not so.
        studio.is_smooth = given.smooth;
    }
}

/// Occlusion reaches as far as pockets are deep: a part of the extent of the data, and at least some radii, so that
/// neighbours darken each other.
fn fit_occlusion(studio: &mut Studio, given: OwnValues, subject: &Subject<'_>, radius: f64) {
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
    given: OwnValues,
    subject: &Subject<'_>,
    radius: f64,
    view: &View<'_>,
) {
    let Some(outline) = &mut studio.outline else { return };
    let middle = subject.bounds().center();
    let is_tiny = radius_in_pixels(view, middle, radius).is_some_and(|pixels| pixels < LEAST_RADIUS_IN_PIXELS);
    if is_tiny && !given.outline {
        let wide = Outline { width: outline.width, ..Outline::thin() };
        studio.outline = given.outline_by_flag.then_some(wide);
        return;
    }
    if !given.outline_depth {
        let jump = if matches!(style, Style::Flat | Style::Illustration) { 0.35 } else { 0.7 } * radius;
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
