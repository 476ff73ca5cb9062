//! Light in scenes of which only some parts are on the device.

use std::ops::Range;

use super::loader::Loader;
use crate::accel::{AccelChoice, Structure};
use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::lit_picture::Work;
use crate::gpu::headless::progress::{
    Decision, Picture, Progress, UploadProgress, UploadStep, UploadWatch, Watch,
};
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::lit::{
    AT_ONCE, LightingData, LitFrame, LitKey, LitPasses, LitScene, LitSizes, RecordedBy, Round,
    Step, Visit, sums,
};
use crate::gpu::passes::tiles::{Tile, tiles};
use crate::gpu::passes::visible_region::VisibleRegion;
use crate::image::{Image, LayerSet, NO_ID};
use crate::render::{RenderSettings, Totals};
use crate::scene::SceneParts;

/// How a lit picture of a scene of parts is made. The picture does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartsOptions {
    /// The structure of each part.
    pub choice: AccelChoice,
    /// The bytes that paths in flight may take on the device; at least one tile is always in flight, in some 90 MB. With
    /// room for all samples of the picture at once, each part is read once for each step of a path; otherwise once more
    /// for each time that the room is filled.
    pub bytes_in_flight: u64,
    /// The bytes of parts that may stay on the device after they are used. With 0, each part is dropped before the next is
    /// read.
    pub bytes_kept: u64,
}

impl Headless {
    /// Renders a lit picture of parts like [`Headless::light_parts`], without blocking the thread while the device works.
    ///
    /// # Errors
    /// The same as for [`Headless::light_parts`].
    #[expect(clippy::too_many_arguments, reason = "they are those of one picture")]
    pub async fn light_parts_async(
        &self,
        parts: &mut dyn SceneParts,
        view: &View<'_>,
        settings: &RenderSettings,
        mut image: Image,
        layers: LayerSet,
        options: PartsOptions,
        (upload_watch, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Picture, GpuError> {
        if settings.integrator.is_primary() {
            return Err(GpuError::NotLit);
        }
        let wanted = settings.layers_for(layers);
        let size = [image.width(), image.height()];
        if size != [view.film.width(), view.film.height()] || image.layers() != wanted {
            return Err(GpuError::PartLayers);
        }
        let automatic = options.choice == AccelChoice::Auto;
        let mut choice = options.choice;
        let (samples, totals) = loop {
            let mut loader = Loader::open(self, parts, choice, options.bytes_kept).await?;
            let structure = loader.structure();
            let options = PartsOptions { choice, ..options };
            let picture = (view, settings, &mut image);
            match self.gather_parts(&mut loader, picture, options, (upload_watch, watch)).await {
                // Trees take fewer steps than grids.
                Err(GpuError::Steps) if automatic && structure != Structure::WideTree => {
                    choice = AccelChoice::Tree;
                }
                done => break done?,
            }
        };
        let image = self.finish_async(image, settings, layers).await?;
        let noise = totals.noise(samples);
        Ok(Picture { image, samples, noise, hits: Some(totals.opacity) })
    }

    /// Takes all samples, and writes their means to the image.
    async fn gather_parts(
        &self,
        loader: &mut Loader<'_>,
        (view, settings, image): (&View<'_>, &RenderSettings, &mut Image),
        options: PartsOptions,
        (upload_watch, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<(u32, Totals), GpuError> {
        let nothing = loader.nothing().await?;
        settings.check_with(nothing.appearance())?;
        let lighting = &LightingData::new(settings, nothing.summary(), view.camera);
        let scenes = LitScene { all: &nothing, occluders: &nothing };
        let key = scenes.key(view, lighting, &self.device().limits());
        let key = LitKey { several_bricks: true, one_pass: None, ..key };
        self.with_lit_passes(key, async |passes: &LitPasses| {
            // One ray at a time tests as many spheres of a list as a loop may.
            let at_once = if loader.structure() == Structure::List { 1 } else { AT_ONCE };
            let work = Work { headless: self, passes, scenes, view, settings, lighting, at_once };
            match work.gather_parts(loader, image, options, (upload_watch, watch)).await {
                // Several directions of ambient light in one invocation need more steps than one direction.
                Err(GpuError::Steps)
                    if at_once > 1 && lighting.parameters.occlusion_samples > 1 =>
                {
                    let work = Work { at_once: 1, ..work };
                    work.gather_parts(loader, image, options, (upload_watch, watch)).await
                }
                done => done,
            }
        })
        .await
    }
}

/// The tiles whose paths are in flight.
struct InFlight<'a> {
    frame: &'a LitFrame,
    flow: Flow<'a>,
    /// Reads the hits of the paths of a tile.
    hits: ReadableBuffer,
}

/// What is told while a picture is made.
struct Telling<'a, 'b> {
    upload: &'a mut UploadWatch<'b>,
    watch: &'a mut Watch<'b>,
    progress: Progress,
}

impl Telling<'_, '_> {
    /// Tells how much is done, and returns an error if the caller stops. All samples are taken together, so that the
    /// picture cannot be finished early.
    fn part(&mut self, part: f64) -> Result<(), GpuError> {
        self.progress.part = part;
        match (self.watch)(&self.progress) {
            Decision::Stop => Err(GpuError::Stopped),
            Decision::GoOn | Decision::MeasureNoise | Decision::Finish => Ok(()),
        }
    }
}

impl Work<'_> {
    /// Takes all samples, and writes their means to the image. The scene of `self` has no spheres, and the space of all.
    async fn gather_parts(
        &self,
        loader: &mut Loader<'_>,
        image: &mut Image,
        options: PartsOptions,
        (upload, watch): (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<(u32, Totals), GpuError> {
        let Self { headless, passes, scenes, view, settings, lighting, .. } = *self;
        let device = headless.device();
        let devices = (device, headless.queue());
        let total = settings.sampling.samples;
        let (limits, shape) = (device.limits(), headless.shape());
        let sizes = LitSizes::of_parts(&limits, shape, &view.film, lighting.mode, total);
        let (region, limit) = (scenes.visible_region(view, settings), iteration_limit(device));
        let all: Vec<Tile> = tiles(&view.film, sizes.tile).collect();
        let at_once = (options.bytes_in_flight / sizes.tile_bytes()).max(1);
        let at_once = usize::try_from(at_once).unwrap_or(usize::MAX).min(all.len());
        let rounds = all.len().div_ceil(at_once) * total.div_ceil(sizes.in_flight) as usize;
        let progress = Progress { samples: 0, total, part: 0.0, noise: None };
        let mut telling = Telling { upload, watch, progress };
        let (mut totals, mut round) = (Totals::default(), 0);
        for tiles in all.chunks(at_once) {
            let records =
                tiles.iter().map(|tile| (*tile, scenes.frames(view, region, *tile, limit)));
            let by = RecordedBy::Parts;
            let frame = &LitFrame::new(devices, passes, sizes, lighting, by, records).await?;
            let hits = ReadableBuffer::new(device, "pinhole hits read-back", sizes.hits()[1]);
            let flow = Flow::new(headless, frame, passes, scenes.all);
            let mut in_flight = InFlight { frame, flow, hits };
            let mut start = 0;
            while start < total {
                let end = total.min(start.saturating_add(sizes.in_flight));
                let part = [round, round + 1].map(|round| round as f64 / rounds as f64);
                self.round(&mut in_flight, loader, start..end, part, &mut telling).await?;
                (start, round) = (end, round + 1);
            }
            let flow = &mut in_flight.flow;
            for (number, tile) in tiles.iter().enumerate() {
                frame.record_copy_film(flow.encoder(), number);
                frame.record_copy_spent(flow.encoder(), number);
                flow.finish(&[frame.film_back.buffer(), frame.spent_back.buffer()]).await?;
                frame.read_spent()?;
                let _phase = headless.phase("read back");
                frame.film_back.read(|found| {
                    totals.add(&sums::write(image, *tile, found, total));
                })?;
            }
        }
        telling.progress.samples = total;
        telling.part(1.0)?;
        Ok((total, totals))
    }

    /// Takes some samples of every pixel of the tiles in flight.
    async fn round(
        &self,
        in_flight: &mut InFlight<'_>,
        loader: &mut Loader<'_>,
        samples: Range<u32>,
        [from, to]: [f64; 2],
        telling: &mut Telling<'_, '_>,
    ) -> Result<(), GpuError> {
        let Self { passes, scenes: LitScene { all, occluders }, lighting, at_once, .. } = *self;
        let room = in_flight.frame.sizes.room();
        let round = Round { passes, lighting, scene: all, occluders, room, at_once };
        let steps = round.steps(samples)?;
        let tiles = 0..in_flight.frame.tiles.len();
        tiles.clone().for_each(|tile| in_flight.flow.begin(tile));
        let mut done = 0;
        for steps_of_kind in steps.chunk_by(|a, b| a.visit == b.visit) {
            let place = |done: usize| from + (to - from) * done as f64 / steps.len() as f64;
            let part = [place(done), place(done + steps_of_kind.len())];
            done += steps_of_kind.len();
            let visit = steps_of_kind.first().and_then(|step| step.visit);
            // What no brick is needed for, and the hits of no sphere.
            if matches!(visit, None | Some(Visit::Shade)) {
                for tile in tiles.clone() {
                    in_flight.flow.go_to(tile);
                    for step in steps_of_kind {
                        in_flight.flow.step(step, &mut || telling.part(part[0])).await?;
                    }
                }
            }
            if let Some(visit) = visit {
                self.visit(visit, steps_of_kind, in_flight, loader, part, telling).await?;
            }
        }
        Ok(())
    }

    /// Brings parts to the device one after the other, and does the same in each.
    async fn visit(
        &self,
        visit: Visit,
        steps: &[Step<'_>],
        in_flight: &mut InFlight<'_>,
        loader: &mut Loader<'_>,
        [from, to]: [f64; 2],
        telling: &mut Telling<'_, '_>,
    ) -> Result<(), GpuError> {
        let headless = self.headless;
        let tiles = in_flight.frame.tiles.len();
        let mut wanted = match visit {
            Visit::Shade => in_flight.parts_hit(headless, loader).await?,
            Visit::Extend | Visit::Occlude => (0..loader.len()).collect(),
        };
        // What is there comes first, before others take its place.
        wanted.sort_by_key(|part| !loader.has(*part));
        let is_from_camera = visit == Visit::Extend && steps.iter().all(Step::is_from_camera);
        let count = wanted.len();
        let mut is_first = true;
        for (number, part) in wanted.into_iter().enumerate() {
            let region = is_from_camera.then(|| self.region_of(loader, part)).flatten();
            let sees = |tile: usize| {
                let tile = in_flight.frame.tiles[tile].tile;
                region.is_none_or(|region| region.groups_of(tile).count() > 0)
            };
            // The first part that is searched also begins the hits.
            let seen: Vec<usize> = (0..tiles).filter(|tile| is_first || sees(*tile)).collect();
            if seen.is_empty() {
                continue;
            }
            let step = UploadStep::Building;
            UploadProgress { step, brick: part, bricks: loader.len() }.tell(telling.upload)?;
            let done = from + (to - from) * number as f64 / count as f64;
            telling.part(done)?;
            for brick in loader.load(part).await? {
                for &tile in &seen {
                    in_flight.flow.go_to(tile);
                    for step in steps {
                        let step = step.in_brick(brick, self.passes, is_first);
                        let step = step.ok_or(GpuError::OtherRenderer)?;
                        in_flight.flow.step(&step, &mut || telling.part(done)).await?;
                    }
                }
                is_first = false;
            }
            // The part may be dropped next.
            in_flight.flow.finish(&[]).await?;
        }
        Ok(())
    }

    /// The part of the film in which the camera may see a part of the scene; `None` for the whole film.
    fn region_of(&self, loader: &Loader<'_>, part: usize) -> Option<VisibleRegion> {
        let space = loader.space_of(self.scenes.all.space(), part)?;
        let around = self.settings.sampling.filter.radius();
        Some(VisibleRegion::of(self.view, &space).widened(around))
    }
}

impl InFlight<'_> {
    /// The parts that some ray hits.
    async fn parts_hit(
        &mut self,
        headless: &Headless,
        loader: &Loader<'_>,
    ) -> Result<Vec<usize>, GpuError> {
        let [first, _] = self.frame.sizes.hits();
        let mut is_hit = vec![false; loader.len()];
        for tile in &self.frame.tiles {
            let paths = &tile.in_flight.paths;
            self.hits.record_copy_from(self.flow.encoder(), paths, first);
            self.flow.finish(&[self.hits.buffer()]).await?;
            let _phase = headless.phase("read back");
            self.hits.read(|hits: &[[u32; 4]]| {
                for [_, id, shape, _] in hits {
                    if *id != NO_ID
                        && let Some(part) = loader.part_of(*shape)
                    {
                        is_hit[part] = true;
                    }
                }
            })?;
        }
        Ok((0..loader.len()).filter(|part| is_hit[*part]).collect())
    }
}
