//! Pictures of parts of a scene, with the distances by which the nearest of all parts is found.

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::RenderPlan;
use crate::gpu::headless::progress::{UploadWatch, Watch};
use crate::gpu::passes::bands::{rows_per_band, tile_size};
use crate::gpu::passes::tiles::tiles;
use crate::gpu::shader::records::Hit;
use crate::image::{LayerSet, NO_ID};
use crate::render::{Nearest, RenderSettings};
use crate::scene::Scene;

impl Headless {
    /// Renders a picture by primary rays of a part of a scene ([`Scene::part`]), with what is needed to put it together
    /// with those of the other parts. Each planned brick is built, traced and dropped before the next. A large picture is
    /// rendered in tiles, for each of which the bricks are built again.
    ///
    /// # Errors
    /// The same as for [`Headless::render_planned`]; [`GpuError::NotPrimary`] for settings with light.
    pub async fn render_nearest_async(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        (upload_watch, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Nearest, GpuError> {
        let film = &view.film;
        let mut whole = Nearest::misses([film.width(), film.height()], layers)?;
        let limits = self.device().limits();
        // The hits of a tile are in one buffer.
        let [width, height] = tile_size(&limits, self.shape(), film, false);
        let rows = rows_per_band(&limits, [width, height], false);
        for tile in tiles(film, [width, rows]) {
            let part = film.part(tile.origin, tile.size)?;
            let pixels = part.pixel_count() as usize;
            let mut t = vec![f64::INFINITY; pixels];
            let (mut ids, mut distances) = (vec![NO_ID; pixels], vec![f32::INFINITY; pixels]);
            let mut keep = |at: usize, [along, id, _, before]: &Hit| {
                if *id != NO_ID {
                    let (along, before) = (f32::from_bits(*along), f32::from_bits(*before));
                    (t[at], ids[at], distances[at]) = (along.into(), *id, along + before);
                }
            };
            let (view, traced) = (View::new(view.camera, part), Some(&mut keep as _));
            let watches: (&mut UploadWatch<'_>, &mut Watch<'_>) = (upload_watch, watch);
            let image = self.render_by_brick(scene, plan, &view, settings, layers, watches, traced);
            let image = image.await?;
            let integrator = settings.integrator.name();
            let part = Nearest::new(image, t, ids, distances);
            whole.put(&part.ok_or(GpuError::NotPrimary { integrator })?, tile.origin)?;
        }
        Ok(whole)
    }
}
