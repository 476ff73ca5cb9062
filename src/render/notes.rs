//! Notes about settings that are valid but may not give the intended picture.

use std::f64::consts::PI;

use super::{Integrator, RenderSettings, Studio};
use crate::image::color::LinearRgb;
use crate::light::SkyLight;
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::{Scene, SceneAppearance};

impl RenderSettings {
    /// Notes for the user about possibly unintended results of rendering a scene with these settings, and what to do.
    #[must_use]
    pub fn notes(&self, scene: &Scene) -> Vec<String> {
        let any = |is_special: fn(&SurfaceProperties) -> bool| scene.appearance().surfaces().iter().any(is_special);
        let is_translucent = || !scene.checked_appearance().is_opaque();
        let needs_paths =
            || any(|surface| matches!(surface.material, Material::Conductor { .. } | Material::Dielectric { .. }));
        let has_chance = |studio: &Studio| studio.is_smooth && self.has_chance(scene.checked_appearance());
        let notes = [
            (
                self.studio_parameters().is_some_and(has_chance),
                "the studio is not smooth but sampled at random, because a ground, lights with a place or wider than 15 \
                 degrees, denoising, gloss or opacity are asked for; leave these out, or `smooth` in `[studio]`",
            ),
            (
                self.is_dark(scene),
                "no light: nothing shines on this scene, and its spheres will be black; add [[lights]], or give a light, \
                 the sky or a sphere a color and a strength above zero",
            ),
            (
                self.studio_parameters().is_some() && needs_paths(),
                "metal and glass are matt in a studio; choose the integrator `path` to render them as they are",
            ),
            (
                self.integrator.is_primary() && is_translucent(),
                "primary rays ignore opacity, and all spheres are drawn as if they were opaque; choose the integrator \
                 `studio` or `path` to see through them",
            ),
        ];
        let most = self.studio_parameters().map(|studio| studio.max_surfaces);
        let most = most.filter(|most| is_translucent() && may_exceed(scene, *most));
        let deep = most.map(|most| {
            format!(
                "so many clear spheres seem to lie behind each other that some are not seen: of each ray, the {most} \
                 nearest surfaces are drawn, two for each sphere; set `max_surfaces` in `[studio]`, up to 64, or higher \
                 opacities"
            )
        });
        let notes = notes.into_iter().filter(|(holds, _)| *holds).map(|(_, note)| note.to_owned());
        notes.chain(deep).collect()
    }

    /// True if something other than the camera's lens prevents that a studio is smooth.
    pub(crate) fn has_chance(&self, appearance: &SceneAppearance) -> bool {
        let is_glossy =
            |material: &Material| matches!(material, Material::Lambert { specular, .. } if *specular != 0.0);
        self.sampling.denoise
            || self.ground.is_some()
            || self.lights.iter().any(|light| !light.kind.is_narrow())
            || !appearance.is_opaque()
            || appearance.surfaces().iter().any(|surface| is_glossy(&surface.material))
    }

    /// Whether the picture has lighting but no light source.
    fn is_dark(&self, scene: &Scene) -> bool {
        let is_black = |color: &LinearRgb| *color == LinearRgb::BLACK;
        let is_lit = self.lights.iter().any(|light| !is_black(&light.kind.color()));
        let has_ambient = match (&self.integrator, &self.sky.light) {
            // The headlight at the eye always shines.
            (Integrator::Primary(_), _) => true,
            (Integrator::Studio(studio), _) => !is_black(&studio.ambient),
            (Integrator::Path(_), SkyLight::Constant(color)) => !is_black(color),
            (Integrator::Path(_), SkyLight::Gradient { zenith, horizon, nadir }) => {
                [zenith, horizon, nadir].into_iter().any(|color| !is_black(color))
            }
            (Integrator::Path(_), SkyLight::Image { environment, strength, .. }) => {
                environment.has_light() && *strength > 0.0
            }
        };
        let shines = |surface: &SurfaceProperties| match surface.material {
            Material::Emissive { strength } => strength > 0.0,
            _ => false,
        };
        let is_emitter = |id: u32| shines(&scene.surface(id)) && !is_black(&scene.color(id));
        let has_emitter =
            || scene.appearance().surfaces().iter().any(shines) && (0..scene.len() as u32).any(is_emitter);
        !is_lit && !has_ambient && !has_emitter()
    }
}

/// Whether a ray probably meets more than `most` translucent surfaces, and surfaces behind them could be seen. This is
/// an estimate from the sizes of the spheres and of the whole scene. Only tracing the picture would give the answer.
fn may_exceed(scene: &Scene, most: u32) -> bool {
    let bounds = scene.bounds_to_frame();
    let [x, y, z] = (bounds.max() - bounds.min()).to_array();
    // The mean area of a box's shadow over all directions, times the share of an ellipsoid in the box.
    let shadow = 0.5 * (x * y + y * z + z * x) * PI / 6.0;
    let (mut area, mut clearness) = (0.0, 0.0);
    for (id, [.., radius]) in (0_u32..).zip(scene.spheres()) {
        let opacity = f64::from(scene.surface(id).opacity);
        if opacity < 1.0 {
            let own = PI * f64::from(*radius).powi(2);
            area += own;
            clearness += own * (1.0 - opacity).ln();
        }
    }
    // A ray enters and leaves each sphere. In the middle of a round scene it meets 1.5 times as many as on average.
    let met = 1.5 * 2.0 * area / shadow;
    let left = (clearness / area * f64::from(most)).exp();
    met > f64::from(most) && left > 1.0 / 256.0
}
