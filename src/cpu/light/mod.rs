//! The lighting of the CPU reference, in f64.
//!
//! The kernels compute the same quantities from the same random numbers, so that pictures can be compared sample by
//! sample. The reference shares only its input with the kernels.

use glam::{DVec2, DVec3};

use self::context::LightingContext;
use self::path::follow as follow_path;
use self::sample::{Address, FilmSums, PixelSums, STRIP};
use self::studio::follow as follow_in_studio;
use self::surface_ray::{Start, SurfaceRay};
use crate::camera::{View, filter, sampling};
use crate::cpu::denoise::denoise;
use crate::cpu::pace::{Pace, RenderError};
use crate::cpu::primary::{for_rows, primary_pixel};
use crate::cpu::search::Search;
use crate::geometry::math::wide;
use crate::geometry::ray::Ray;
use crate::image::{Image, LayerSet, NO_ID, Pixel, outline};
use crate::render::{
    Decision, Integrator, Picture, PrimarySettings, Progress, RenderSettings, SettingsError, Watch, batch,
};

mod bsdf;
mod context;
pub(crate) mod live;
mod maps;
mod path;
mod sample;
mod sources;
mod studio;
mod surface_ray;

pub use sample::Sample;

/// A picture that can be rendered as a whole or sample by sample.
#[derive(Debug)]
pub struct SampledPicture<'a> {
    context: LightingContext<'a>,
    view: View<'a>,
    /// See [`PixelFilter::offset_table`](crate::PixelFilter::offset_table).
    offsets: [f32; 257],
}

impl<'a> SampledPicture<'a> {
    /// The number of bytes that each pixel needs, in addition to the picture, during rendering batch by batch.
    pub const BYTES_PER_PIXEL: u64 = size_of::<PixelSums>() as u64;

    /// Checks the settings, and prepares the data that all samples share. If `search` is a reference to a scene, rays
    /// test every sphere.
    ///
    /// # Errors
    /// Returns an error if [`RenderSettings::check`] fails.
    pub fn new(
        search: impl Into<Search<'a>>,
        view: &View<'a>,
        settings: &'a RenderSettings,
    ) -> Result<Self, SettingsError> {
        let search = search.into();
        settings.check(search.scene())?;
        Ok(Self {
            context: LightingContext::new(search, view.camera, settings),
            view: *view,
            offsets: settings.sampling.filter.offset_table(),
        })
    }

    /// Computes one sample of a pixel, given as column and row. With the integrator `primary`, all samples of a pixel
    /// are the same.
    #[must_use]
    pub fn sample(&self, pixel: [u32; 2], sample: u32) -> Sample {
        let RenderSettings { integrator, sampling, is_transparent, .. } = self.context.settings;
        let address = Address::new(self.view.film.in_whole(pixel), sample, sampling.seed);
        let surface_ray = || self.surface_ray(pixel, address);
        let found = match integrator {
            Integrator::Primary(_) => Some(self.primary(pixel)),
            Integrator::Studio(studio) => {
                surface_ray().map(|surface_ray| follow_in_studio(&self.context, studio, surface_ray, address))
            }
            Integrator::Path(tracing) => {
                surface_ray().map(|surface_ray| follow_path(&self.context, tracing, surface_ray, address))
            }
        };
        let nothing = || {
            let color = if *is_transparent { DVec3::ZERO } else { self.context.background() };
            Sample { color, ..Sample::default() }
        };
        found.unwrap_or_else(nothing)
    }

    /// The ray of a sample in the scene's frame. `None` if the camera has no ray there.
    fn surface_ray(&self, pixel: [u32; 2], address: Address) -> Option<SurfaceRay> {
        let offset = address.pair(0).map(|u| filter::offset(&self.offsets, u));
        let View { camera, film } = self.view;
        // Computed in the whole film, so that parts round as the whole does.
        let place = film.in_whole(pixel);
        let [column, row] = [0, 1].map(|axis| f64::from(place[axis]) + 0.5 + offset[axis]);
        let location = film.whole().relative_location(column, row);
        if !camera.sees(location) {
            return None;
        }
        let ray = if camera.has_lens() {
            let lens = DVec2::from(address.pair(1).map(sampling::unit));
            camera.ray_through_lens(location, lens)
        } else {
            camera.ray_in_world(location)
        };
        let ray = Ray { origin: ray.origin - self.context.scene.origin(), ..ray };
        Some(SurfaceRay { ray, start: Start::Free })
    }

    fn primary(&self, pixel: [u32; 2]) -> Sample {
        let primary = self.context.settings.primary().unwrap_or_default();
        let Pixel { color, albedo, id, .. } = primary_pixel(self.context.search, &self.view, &primary, pixel);
        let alpha = if id == NO_ID { 0.0 } else { 1.0 };
        Sample { color: wide(color), alpha, albedo: wide(albedo) }
    }

    /// Renders all pixels in batches of samples, and asks `watch` after parts of each batch how to continue; see
    /// [`super::render_watched`]. Each pixel adds its samples in the same order, however a render is divided.
    pub(super) fn render(&self, layers: LayerSet, watch: &mut Watch<'_>) -> Result<Picture, RenderError> {
        let (film, settings) = (self.view.film, self.context.settings);
        let mut image = Image::new(film.width(), film.height(), settings.layers_for(layers))?;
        let mut sums = FilmSums::new(film.width(), film.height())?;
        self.data_layers(&mut image, watch)?;
        self.gather(&mut sums, watch)?;
        sums.write(&mut image);
        let (samples, totals) = (sums.samples(), sums.totals());
        drop(sums);
        let image = finish(image, settings, layers);
        Ok(Picture { image, samples, noise: totals.noise(samples), hits: Some(totals.opacity), crowded: 0 })
    }

    /// Fills the layers whose data comes from the ray through the centre of each pixel.
    fn data_layers(&self, image: &mut Image, watch: &mut Watch<'_>) -> Result<(), RenderError> {
        let has_data = image.rows_mut(0..1).first().is_some_and(|row| row.has_data());
        if !has_data {
            return Ok(());
        }
        // There is no sample yet, so the render cannot finish early.
        let total = self.context.settings.sampling.samples;
        let none = Progress { samples: 0, total, part: 0.0, noise: None };
        let height = image.height() as usize;
        Pace::new().run(height.div_ceil(STRIP), |strips| {
            let rows = strips.start * STRIP..height.min(strips.end * STRIP);
            for_rows(image, rows, |pixel, i, row| {
                row.set(i, &primary_pixel(self.context.search, &self.view, &PrimarySettings::default(), pixel));
            });
            match watch(&none) {
                Decision::Stop => Err(RenderError::Stopped),
                Decision::GoOn | Decision::MeasureNoise | Decision::Finish => Ok(()),
            }
        })
    }

    /// Takes samples until all are complete or the caller finishes the render. In the latter case, some strips may have
    /// more samples than others.
    fn gather(&self, sums: &mut FilmSums, watch: &mut Watch<'_>) -> Result<(), RenderError> {
        // A pace of its own, because a sample may take many times as long as a pixel of the data layers.
        let mut pace = Pace::new();
        let total = self.context.settings.sampling.samples;
        let mut progress = Progress { samples: 0, total, part: 0.0, noise: None };
        let mut wants_noise = false;
        let count = sums.strips();
        while progress.samples < total {
            let first = progress.samples;
            let end = first + batch(first, total);
            let mut decision = Decision::GoOn;
            let done = pace.run(count, |strips| {
                let last = strips.end;
                sums.add(strips, first..end, |pixel, sample| self.sample(pixel, sample));
                if last == count {
                    return Ok(());
                }
                let in_batch = f64::from(end - first) * last as f64 / count as f64;
                progress.part = (f64::from(first) + in_batch) / f64::from(total);
                decision = watch(&progress);
                match decision {
                    Decision::GoOn | Decision::MeasureNoise => Ok(()),
                    Decision::Finish | Decision::Stop => Err(RenderError::Stopped),
                }
            });
            match done {
                Err(RenderError::Stopped) if decision == Decision::Finish && first > 0 => break,
                done => done?,
            }
            progress.samples = end;
            if wants_noise || decision == Decision::MeasureNoise {
                wants_noise = true;
                progress.noise = sums.totals().noise(end);
            }
            progress.part = f64::from(end) / f64::from(total);
            match watch(&progress) {
                Decision::GoOn => {}
                Decision::MeasureNoise => wants_noise = true,
                Decision::Finish => break,
                Decision::Stop => return Err(RenderError::Stopped),
            }
        }
        Ok(())
    }
}

/// Completes a picture that was rendered with [`RenderSettings::unfinished`] and has the layers
/// [`RenderSettings::layers_for`]. Removes noise and draws outlines, as `settings` ask, and keeps `layers`. The result
/// is that of [`super::render`] with `settings`, to the bit. Steps whose layers the picture lacks are skipped.
#[must_use]
pub fn finish(mut image: Image, settings: &RenderSettings, layers: LayerSet) -> Image {
    if settings.sampling.denoise {
        image = denoise(&image).unwrap_or(image);
    }
    if let Some(lines) = settings.studio_parameters().and_then(|studio| studio.outline) {
        outline::draw(&mut image, &lines);
    }
    image.keep(layers);
    image
}
