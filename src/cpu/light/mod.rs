//! Lit pictures: as the reference, in f64, with every sphere tried for every ray.
//!
//! What is computed is what kernels compute, from the same random numbers, so that pictures may be compared sample
//! by sample; nothing but the numbers that both are given is shared with them.

use glam::DVec3;

use self::path::follow as follow_path;
use self::sample::{Address, Found, Lens};
use self::stage::{Stage, luminance};
use self::studio::follow as follow_in_studio;
use super::{ROWS_AT_ONCE, for_each_row, shade, trace};
use crate::camera::Camera;
use crate::film::Film;
use crate::image::{Averages, Image, ImageTooLarge, LayerSet, Pixel};
use crate::lighting::{Integrator, Lighting, LightingError};
use crate::outline;
use crate::scene::Scene;
use crate::settings::Settings;

mod bsdf;
mod flight;
mod lamp;
mod maps;
mod path;
mod sample;
mod source;
mod stage;
mod studio;

pub use sample::Sample;

/// Why there is no lit picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LitError {
    /// The lighting is refused.
    #[error(transparent)]
    Lighting(#[from] LightingError),
    /// The image does not fit into memory.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
}

/// A lit picture that is ready to be rendered, as a whole or sample by sample.
#[derive(Debug)]
pub struct LitPicture<'a> {
    stage: Stage<'a>,
    camera: &'a dyn Camera,
    film: &'a Film,
    lens: Lens<'a>,
}

impl<'a> LitPicture<'a> {
    /// Checks the lighting, and makes ready what all samples need.
    ///
    /// # Errors
    /// What [`Lighting::check`] refuses.
    pub fn new(
        scene: &'a Scene,
        camera: &'a dyn Camera,
        film: &'a Film,
        lighting: &'a Lighting,
    ) -> Result<Self, LightingError> {
        lighting.check(scene)?;
        let offsets = lighting.sampling.filter.offset_table();
        Ok(Self {
            stage: Stage::new(scene, camera, lighting),
            camera,
            film,
            lens: Lens::new(camera, film, offsets, scene.origin()),
        })
    }

    /// One sample of a pixel, which is column and row.
    #[must_use]
    pub fn sample(&self, pixel: [u32; 2], sample: u32) -> Sample {
        let Lighting { integrator, sampling, is_transparent, .. } = self.stage.lighting;
        let address = Address::new(pixel, sample, sampling.seed);
        let found = match (self.lens.flight(pixel, address), integrator) {
            (None, _) if *is_transparent => Found::default(),
            (None, _) => Found { color: self.stage.background(), ..Found::default() },
            (Some(flight), Integrator::Studio(studio)) => {
                follow_in_studio(&self.stage, studio, flight, address)
            }
            (Some(flight), Integrator::Path(tracing)) => {
                follow_path(&self.stage, tracing, flight, address)
            }
        };
        found.into()
    }

    /// Renders all pixels.
    ///
    /// Colour, alpha and albedo are means of samples. Depth, normal, position and id are those of the ray through the
    /// pixel's centre, as [`super::render`] gives them: of spheres alone, whatever they are made of. The variance is
    /// that of the mean of luminances. Rows run in parallel with the feature `parallel`; the picture does not depend
    /// on it.
    ///
    /// # Errors
    /// If the image does not fit into memory.
    pub fn render(&self, layers: LayerSet) -> Result<Image, ImageTooLarge> {
        let lines = self.stage.lighting.studio().and_then(|studio| studio.outline);
        let by = lines.map_or(LayerSet::COLOR, |_| outline::LAYERS);
        let wanted = layers.iter().fold(by, LayerSet::with);
        let mut image = Image::new(self.film.width(), self.film.height(), wanted)?;
        let height = self.film.height() as usize;
        for start in (0..height).step_by(ROWS_AT_ONCE) {
            let rows = image.rows_mut(start..(start + ROWS_AT_ONCE).min(height));
            for_each_row(rows, |j, row| {
                for i in 0..self.film.width() {
                    let pixel = [i, (start + j) as u32];
                    let averages = self.averages(pixel);
                    row.set(i as usize, &self.data(pixel));
                    row.set_averages(i as usize, &averages);
                }
            });
        }
        if let Some(lines) = &lines {
            outline::draw(&mut image, lines);
            image.keep(layers);
        }
        Ok(image)
    }

    fn averages(&self, pixel: [u32; 2]) -> Averages {
        let count = self.stage.lighting.sampling.samples;
        let (mut color, mut albedo) = (DVec3::ZERO, DVec3::ZERO);
        let (mut alpha, mut light, mut square) = (0.0, 0.0, 0.0);
        for sample in 0..count {
            let found = self.sample(pixel, sample);
            let luminance = luminance(found.color.into());
            color += DVec3::from(found.color);
            albedo += DVec3::from(found.albedo);
            alpha += found.alpha;
            light += luminance;
            square += luminance * luminance;
        }
        let n = f64::from(count);
        let spread = (square / n - (light / n).powi(2)).max(0.0);
        Averages {
            color: (color / n).as_vec3().to_array(),
            alpha: (alpha / n) as f32,
            albedo: (albedo / n).as_vec3().to_array(),
            samples: count,
            variance: if count > 1 { spread / (n - 1.0) } else { 0.0 } as f32,
        }
    }

    /// What the ray through the pixel's centre says, without light.
    fn data(&self, [i, j]: [u32; 2]) -> Pixel {
        let location = self.film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let ray = self.camera.ray_in_world(location);
        let hit = self.camera.sees(location).then(|| trace(self.stage.scene, &ray)).flatten();
        shade(self.stage.scene, &Settings::default(), &ray, hit.as_ref())
    }
}

/// Renders a lit picture; see [`LitPicture::render`].
///
/// # Errors
/// What [`Lighting::check`] refuses; if the image does not fit into memory.
pub fn render_lit(
    scene: &Scene,
    camera: &dyn Camera,
    film: &Film,
    lighting: &Lighting,
    layers: LayerSet,
) -> Result<Image, LitError> {
    Ok(LitPicture::new(scene, camera, film, lighting)?.render(layers)?)
}

/// One sample of a lit picture's pixel. Who wants many makes a [`LitPicture`] once.
///
/// # Errors
/// What [`Lighting::check`] refuses.
pub fn radiance(
    scene: &Scene,
    camera: &dyn Camera,
    film: &Film,
    lighting: &Lighting,
    pixel: [u32; 2],
    sample: u32,
) -> Result<Sample, LightingError> {
    Ok(LitPicture::new(scene, camera, film, lighting)?.sample(pixel, sample))
}
