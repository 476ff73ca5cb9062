//! Lighting of the CPU reference, in f64.
//!
//! The kernels compute the same quantities from the same random numbers, so that pictures can be compared sample by
//! sample. Only the input is shared with them.

use glam::DVec3;

use self::context::LightingContext;
use self::film_sums::PixelSums;
use self::path::follow as follow_path;
use self::sample::{Address, Found, Lens};
use self::studio::follow as follow_in_studio;
use crate::camera::View;
use crate::cpu::denoise::denoise;
use crate::cpu::error::RenderError;
use crate::cpu::primary::{for_each_pixel, primary_pixel, render_primary};
use crate::cpu::search::Search;
use crate::geometry::math::wide;
use crate::image::outline;
use crate::image::{Averages, Image, LayerSet, NO_ID, Pixel};
use crate::render::{Integrator, PrimarySettings, RenderSettings, SettingsError};

mod bsdf;
mod color;
mod context;
mod film_sums;
mod gather;
mod lamp;
pub(super) mod live;
mod maps;
mod path;
mod sample;
mod source;
mod sources;
mod studio;
mod surface_ray;

pub use sample::Sample;

/// A picture that can be rendered as a whole or sample by sample.
#[derive(Debug)]
pub struct SampledPicture<'a> {
    context: LightingContext<'a>,
    view: View<'a>,
    lens: Lens<'a>,
}

impl<'a> SampledPicture<'a> {
    /// The bytes that each pixel needs beside the picture while it is rendered batch by batch.
    pub const BYTES_PER_PIXEL: u64 = size_of::<PixelSums>() as u64;

    /// Checks the settings, and prepares the data that all samples share. With a reference to a scene, rays test every
    /// sphere.
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
        let offsets = settings.sampling.filter.offset_table();
        Ok(Self {
            context: LightingContext::new(search, view.camera, settings),
            view: *view,
            lens: Lens::new(view, offsets, search.scene().origin()),
        })
    }

    /// One sample of a pixel, given as column and row. With the integrator `primary`, all samples of a pixel are the
    /// same.
    #[must_use]
    pub fn sample(&self, pixel: [u32; 2], sample: u32) -> Sample {
        let RenderSettings { integrator, sampling, is_transparent, .. } = self.context.settings;
        let address = Address::new(self.view.film.in_whole(pixel), sample, sampling.seed);
        let surface_ray = || self.lens.surface_ray(pixel, address);
        let found = match integrator {
            Integrator::Primary(_) => Some(self.primary(pixel)),
            Integrator::Studio(studio) => surface_ray()
                .map(|surface_ray| follow_in_studio(&self.context, studio, surface_ray, address)),
            Integrator::Path(tracing) => surface_ray()
                .map(|surface_ray| follow_path(&self.context, tracing, surface_ray, address)),
        };
        let nothing = || {
            let color = if *is_transparent { DVec3::ZERO } else { self.context.background() };
            Found { color, ..Found::default() }
        };
        found.unwrap_or_else(nothing).into()
    }

    fn primary(&self, pixel: [u32; 2]) -> Found {
        let primary = self.context.settings.primary().unwrap_or_default();
        let Pixel { color, albedo, id, .. } =
            primary_pixel(self.context.search, &self.view, &primary, pixel);
        let alpha = if id == NO_ID { 0.0 } else { 1.0 };
        Found { color: wide(color), alpha, albedo: wide(albedo) }
    }

    /// Renders all pixels; see [`super::render`].
    ///
    /// # Errors
    /// Returns an error if the image does not fit into memory.
    pub fn render(&self, layers: LayerSet) -> Result<Image, RenderError> {
        let settings = self.context.settings;
        if let Some(primary) = settings.primary() {
            return render_primary(self.context.search, &self.view, &primary, layers);
        }
        let film = self.view.film;
        let mut image = Image::new(film.width(), film.height(), settings.layers_for(layers))?;
        for_each_pixel(&mut image, |pixel, i, row| {
            if row.has_data() {
                row.set(i, &self.data(pixel));
            }
            row.set_averages(i, &self.averages(pixel));
        });
        Ok(self.finish(image, layers))
    }

    /// Completes a picture of which all means are known.
    fn finish(&self, image: Image, layers: LayerSet) -> Image {
        finish(image, self.context.settings, layers)
    }

    fn averages(&self, pixel: [u32; 2]) -> Averages {
        let count = self.context.settings.sampling.samples;
        let mut sums = PixelSums::default();
        (0..count).for_each(|sample| sums.add(&self.sample(pixel, sample)));
        sums.means(count).averages
    }

    /// The data layers of a pixel, from the ray through its centre.
    fn data(&self, pixel: [u32; 2]) -> Pixel {
        primary_pixel(self.context.search, &self.view, &PrimarySettings::default(), pixel)
    }
}

/// Completes a picture that was rendered with [`RenderSettings::unfinished`] and has the layers
/// [`RenderSettings::layers_for`]: removes noise and draws outlines, as `settings` ask for, and keeps `layers`. The result
/// is that of [`super::render`] with `settings`, to the bit. A picture that lacks layers for one of the steps is not
/// changed by it.
#[must_use]
pub fn finish(mut image: Image, settings: &RenderSettings, layers: LayerSet) -> Image {
    if settings.is_denoised {
        image = denoise(&image).unwrap_or(image);
    }
    if let Some(lines) = settings.studio_parameters().and_then(|studio| studio.outline) {
        outline::draw(&mut image, &lines);
    }
    image.keep(layers);
    image
}

/// One sample of a pixel. For many samples, create a [`SampledPicture`] once.
///
/// # Errors
/// Returns an error if [`RenderSettings::check`] fails.
pub fn radiance<'a>(
    search: impl Into<Search<'a>>,
    view: &View<'_>,
    settings: &RenderSettings,
    pixel: [u32; 2],
    sample: u32,
) -> Result<Sample, SettingsError> {
    Ok(SampledPicture::new(search.into(), view, settings)?.sample(pixel, sample))
}
