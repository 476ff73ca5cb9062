//! The studio as a file gives it. Missing values of the depth cue follow from the scene.

use serde::Deserialize;

use crate::scene_file::span::{SceneFileError, WithSpan};
use crate::settings::layers::Joined;
use pinhole::camera::Camera;
use pinhole::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use pinhole::image::color::LinearRgb;
use pinhole::range::RangeError;
use pinhole::render::{DepthCue, Occlusion, Outline, Studio};
use pinhole::scene::Scene;

#[derive(Debug)]
pub(crate) struct StudioPlan {
    studio: Studio,
    depth_cue: Option<WithSpan<DepthCuePlan>>,
}

/// The table `[studio.depth_cue]`.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct DepthCuePlan {
    /// Distance from the camera at which fading begins; by default that of the nearest sphere.
    near: Option<f64>,
    /// Distance from the camera at which only `color` is left; by default that of the farthest sphere.
    far: Option<f64>,
    /// The colour to which others fade; by default the background.
    color: Option<LinearRgb>,
    /// The part of `color` in what is at `far`, more than 0 and at most 1; by default 1.
    strength: Option<f64>,
}

impl DepthCuePlan {
    fn check(&self) -> Result<(), RangeError> {
        let within = RangeError::unless_within;
        let strength = self.strength.unwrap_or(1.0);
        within("strength", strength, [0.01, 1.0], "from 0.01 to 1")?;
        let near = self.near.unwrap_or(0.0);
        within("near", near, [0.0, MAX_LENGTH], "0 or more, and at most 2^56")?;
        let Some(far) = self.far else { return Ok(()) };
        let range = "more than `near`, and from 2^-56 to 2^56";
        within("far", far, [MIN_LENGTH, MAX_LENGTH], range)?;
        let wrong = RangeError { parameter: "far", value: far, range: "more than `near`" };
        if far > near { Ok(()) } else { Err(wrong) }
    }
}

impl StudioPlan {
    pub(super) fn new(
        mut studio: Studio,
        depth_cue: Option<DepthCuePlan>,
        layers: &Joined<'_>,
    ) -> Result<Self, SceneFileError> {
        // A width of 0 takes away the lines of a style.
        studio.outline =
            studio.outline.filter(|outline| outline.width.is_nan() || outline.width.abs() >= f32::MIN_POSITIVE);
        let bare = Studio { occlusion: None, outline: None, ..studio.clone() };
        for (table, checked) in [
            ("studio", bare.check()),
            ("studio.occlusion", studio.occlusion.iter().try_for_each(Occlusion::check)),
            ("studio.outline", studio.outline.iter().try_for_each(Outline::check)),
            ("studio.depth_cue", depth_cue.iter().try_for_each(DepthCuePlan::check)),
        ] {
            checked.map_err(|error| layers.places.refused(table, error))?;
        }
        let span = layers.places.span("studio.depth_cue");
        Ok(Self { studio, depth_cue: depth_cue.map(|value| WithSpan { value, span }) })
    }

    pub(crate) fn outline(&self) -> Option<Outline> {
        self.studio.outline
    }

    pub(crate) fn studio(
        &self,
        scene: &Scene,
        camera: &dyn Camera,
        background: LinearRgb,
    ) -> Result<Studio, SceneFileError> {
        let mut studio = self.studio.clone();
        if let Some(WithSpan { value: plan, span }) = &self.depth_cue {
            let [near, far] = reach(scene, camera);
            let near = plan.near.unwrap_or(plan.far.map_or(near, |far| near.min(far / 2.0)));
            let far = plan.far.unwrap_or(if far > near { far } else { near + 1.0 });
            let far = (near + (far - near) / plan.strength.unwrap_or(1.0)).min(MAX_LENGTH);
            let color = plan.color.unwrap_or(background);
            studio.depth_cue = Some(DepthCue { near, far, color });
            studio.check().map_err(|error| span.error(error))?;
        }
        Ok(studio)
    }
}

/// Returns bounds of the distances from the camera at which there are spheres.
fn reach(scene: &Scene, camera: &dyn Camera) -> [f64; 2] {
    let bounds = scene.bounds_to_frame();
    let distance = (bounds.center() - camera.vectors().origin).length();
    let radius = bounds.size().length() / 2.0;
    [(distance - radius).max(0.0), distance + radius].map(|length| length.min(MAX_LENGTH))
}
