//! Rendering one picture of a scene in several bricks. Each brick is built, copied to the device, traced and dropped
//! before the next. Bricks that the picture does not show are never built.

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::View;
use crate::geometry::bounds::Bounds;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::{PictureRequest, RenderPlan};
use crate::gpu::headless::primary::begin_pass;
use crate::gpu::headless::progress::{Picture, TracedPixels, UploadProgress, UploadStep, UploadWatch, Watch};
use crate::gpu::headless::readback::{DerivedLayers, ReadBack, ReadableBuffer, TileTextures};
use crate::gpu::headless::renderers::Renderers;
use crate::gpu::headless::uploading::OptionsOf;
use crate::gpu::passes::bands::tile_size;
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::passes::tiles::{Groups, Tile, WORKGROUP_SIDE, tiles};
use crate::gpu::passes::visible_bricks::{VisibleBricks, space_of};
use crate::gpu::profile::NotedPass;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_summary::{SceneSummary, ShapeIds};
use crate::gpu::scene::scene_upload::{BrickSource, SceneUpload, UploadedBricks};
use crate::gpu::shader::records::{Hit, SceneSpace};
use crate::image::{Image, NO_ID};
use crate::parallel::map;
use crate::render::{NearestPicture, RenderSettings};
use crate::smooth::first_half;

/// Callback with the index in the picture and the hit of each pixel that was traced.
pub(crate) type KeepHit<'a> = dyn FnMut(usize, &Hit) + 'a;

impl Headless {
    /// Builds the planned structures of a scene and renders one picture, like [`Headless::upload_planned`] and
    /// [`Headless::render_uploaded`], which call the two callbacks.
    ///
    /// If a picture by primary rays is a single tile and the scene has several bricks, each brick is traced as soon as
    /// it is on the device, and dropped. Bricks that the picture does not show are not built.
    ///
    /// # Errors
    /// As for [`Headless::upload_planned`] and [`Headless::render_uploaded`].
    pub async fn render_planned(
        &self,
        request: &PictureRequest<'_>,
        plan: &RenderPlan,
        upload_watch: &mut UploadWatch<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        let PictureRequest { scene, view, settings, layers, is_shaded, .. } = *request;
        if let Some(smooth) = request.smooth() {
            settings.check(scene)?;
            let primary = RenderSettings::default();
            let of_ids = PictureRequest { settings: &primary, ..request.of_ids(&smooth) };
            let ids = Box::pin(self.render_planned(&of_ids, plan, upload_watch, &mut first_half(watch))).await?.image;
            let _phase = self.phase("light");
            return smooth.draw(ids, layers, GpuError::Stopped, watch);
        }
        if plan.by_tiles && request.suits_tiles() {
            let image = self.render_by_tiles(request, plan, upload_watch, watch).await?;
            return Ok(Picture::by_primary_rays(image));
        }
        if self.drops_bricks(plan, &view, settings) {
            let image = self.render_by_brick(request, plan, upload_watch, watch, None);
            return Ok(Picture::by_primary_rays(image.await?));
        }
        let options_of = |kinds: &[BrickKind], several_bricks: bool| {
            let options = self.options_of(kinds, several_bricks, view.camera);
            RendererOptions { data_layers: ReadBack::new(layers, is_shaded).has_data(), ..options }
        };
        let options_of: Option<&OptionsOf<'_>> =
            if settings.integrator.is_primary() { Some(&options_of) } else { None };
        let plans = plan.structures();
        let buffers = self.upload_ahead_of(scene, &plans, upload_watch, options_of).await?;
        if !is_shaded {
            let image = self.render_primary(&buffers, &view, None, layers, watch).await?;
            return Ok(Picture::by_primary_rays(image));
        }
        self.render_uploaded(&buffers, &view, settings, layers, watch).await
    }

    /// Whether bricks may be dropped after they are traced: one buffer holds the hits of the whole picture, so that no
    /// brick is needed twice, and there are bricks to choose from.
    fn drops_bricks(&self, plan: &RenderPlan, view: &View<'_>, settings: &RenderSettings) -> bool {
        let size = [view.film.width(), view.film.height()];
        settings.integrator.is_primary()
            && plan.accel.brick_count > 1
            && plan.accel.cones.is_none()
            && plan.accel.structure != Structure::List
            && plan.tile_size == size
    }

    /// Renders a picture whose hits are in one buffer. Copies the hits of the pixels that were traced to `traced`, by
    /// their indices in the picture.
    pub(crate) async fn render_by_brick(
        &self,
        request: &PictureRequest<'_>,
        plan: &RenderPlan,
        upload_watch: &mut UploadWatch<'_>,
        watch: &mut Watch<'_>,
        mut traced: Option<&mut KeepHit<'_>>,
    ) -> Result<Image, GpuError> {
        let PictureRequest { scene, view, settings, layers, is_shaded, .. } = request;
        let (layers, what) = (*layers, ReadBack::new(*layers, *is_shaded));
        let (device, queue, film) = (self.device(), self.queue(), &view.film);
        let size = [film.width(), film.height()];
        let tile = Tile { origin: [0, 0], size, in_target: [0, 0] };
        let phase = self.phase("divide");
        let BrickSource { space: brick_space, mut bricks, .. } = BrickSource::from(plan.accel.bricks(scene.spheres()));
        let boxes = bricks.boxes();
        drop(phase);
        // In every brick, the nearest of equal spheres has the smallest id, so the ids of the input suffice.
        let ids = ShapeIds::of_all(scene, false);
        let summary = SceneSummary::of(scene);
        let no_bricks = UploadedBricks { space: brick_space, bricks: Vec::new(), bytes: 0 };
        let kinds = [false, true].map(|nested| brick_space.structure.with_nested(nested));
        self.alone(async |renderers: &mut Renderers| {
            let layouts = self.layouts_of(kinds.to_vec(), Vec::new()).await?;
            let mut upload = SceneUpload::new(&layouts, device, queue, &summary, brick_space, &ids).await?;
            let mut scene = SceneBuffers::new_of(no_bricks, summary, ids.exclude_by, self.shape());
            let primary = scene.primary_settings(settings)?;
            let visible = VisibleBricks::of(view, &scene.space, &boxes);
            let textures = scoped(device, || TileTextures::new(device, size, what)).await?;
            let options = kinds.map(|structure| {
                let kind = BrickKind { structure, primitive: Primitive::Sphere };
                let options = self.options_of(&[kind], true, view.camera);
                RendererOptions { data_layers: what.has_data(), ..options }
            });
            let first = renderers.of(device, options[0].clone()).await?;
            let mut frame = Frame::new(first, device, &textures.targets()).await?;
            let seen_buffer =
                scoped(device, || ReadableBuffer::new(device, "pinhole hits read-back", frame.traced().0.size()))
                    .await?;
            frame.set_bricks(queue, &scene, &visible, view, tile, &primary);
            let parts: Vec<BandBrick> = frame.parts().collect();
            bricks.keep(&parts.iter().map(|part| part.brick).collect::<Vec<_>>());
            let mut done = TracedPixels::of(parts.iter().map(|part| part.groups.pixels()).sum());
            let mut seen: Option<NearestDistances> = None;
            for (number, part) in parts.iter().enumerate() {
                let region = frame.traced_groups(part.slot);
                let own = space_of(&scene.space, &boxes[part.brick]);
                if let (Some(seen), Some(own)) = (&seen, &own)
                    && seen.hide(view, own, region)
                {
                    bricks.leave_out();
                    done.add(part.groups, watch)?;
                    continue;
                }
                let mut tell = |step| UploadProgress { step, brick: number, bricks: parts.len() }.tell(upload_watch);
                tell(UploadStep::Building)?;
                let phase = self.phase("build");
                let Some(brick) = bricks.next() else { break };
                drop(phase);
                tell(UploadStep::Copying)?;
                let phase = self.phase("upload");
                upload.brick(&brick).await?;
                for work in upload.take_work() {
                    self.start(work);
                }
                self.flush().await?;
                drop(phase);
                let options = options[usize::from(brick.is_nested())].clone();
                drop(brick);
                scene.bricks = upload.take_bricks();
                let renderer = renderers.of(device, options).await?;
                let mut left = vec![part.groups];
                while let Some(groups) = Groups::take(&mut left, scene.submission_size().groups()) {
                    frame.set_first_group(queue, part.slot, groups.first);
                    let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
                    let mut pass = begin_pass(&mut encoder, &mut noted, "trace");
                    let slice = BandBrick { groups, brick: 0, ..*part };
                    renderer.record_trace(&mut pass, &scene, &frame, slice)?;
                    drop(pass);
                    self.submit_slice(encoder, noted, groups, &scene, &[]).await?;
                    done.add(groups, watch)?;
                }
                // Pixels whose sphere a later brick hides will be shaded again.
                let (mut encoder, noted) = self.shading(renderer, &scene, &frame, part.band, &textures)?;
                if number + 1 == parts.len() {
                    self.run_timed(encoder, noted, &[]).await?;
                    break;
                }
                seen_buffer.record_copy(&mut encoder, frame.traced().0);
                self.run_timed(encoder, noted, &[&seen_buffer.buffer]).await?;
                seen = Some(seen_buffer.read(|hits| NearestDistances::new(size, hits))?);
            }
            if let (Some(traced), Some(first)) = (&mut traced, parts.first()) {
                let mut encoder = self.encoder();
                seen_buffer.record_copy(&mut encoder, frame.traced().0);
                self.run(encoder, &[&seen_buffer.buffer]).await?;
                seen_buffer.read(|hits: &[Hit]| {
                    let groups = frame.traced_groups(first.slot);
                    groups.indices(size).for_each(|at| traced(at, &hits[at]));
                })?;
            }
            let mut encoder = self.encoder();
            let mapped = textures.record_read_back(&mut encoder, &frame, size);
            self.run(encoder, &mapped).await?;
            let mut image = Image::new(film.width(), film.height(), layers)?;
            let derived = DerivedLayers { view: *view, appearance: scene.appearance() };
            let traced = parts.first().map_or(Groups::NONE, |first| frame.traced_groups(first.slot));
            textures.read_into(&mut image, tile, traced, &derived)?;
            // If nothing was traced, the picture is complete only now.
            done.add(Groups::NONE, watch)?;
            Ok(image)
        })
        .await
    }
}

impl Headless {
    /// Renders a picture by primary rays of a part of a scene ([`Scene::part`](crate::Scene::part)), with the data that
    /// merging it with the other parts needs. Each planned brick is built, traced and dropped before the next. A large
    /// picture is rendered in tiles, for each of which the bricks are built again.
    ///
    /// # Errors
    /// As for [`Headless::render_planned`]; [`GpuError::NotPrimary`] for settings with light.
    pub async fn render_nearest(
        &self,
        request: &PictureRequest<'_>,
        plan: &RenderPlan,
        upload_watch: &mut UploadWatch<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<NearestPicture, GpuError> {
        let PictureRequest { view, settings, layers, .. } = *request;
        let film = &view.film;
        let mut whole = NearestPicture::misses([film.width(), film.height()], layers)?;
        let limits = self.device().limits();
        // The hits of a tile are in one buffer.
        for tile in tiles(film, tile_size(&limits, self.shape(), film, false)) {
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
            let tile_request = PictureRequest { view, ..*request };
            let image = self.render_by_brick(&tile_request, plan, upload_watch, watch, traced);
            let image = image.await?;
            let integrator = settings.integrator.name();
            let part = NearestPicture::new(image, t, ids, distances);
            whole.put(&part.ok_or(GpuError::NotPrimary { integrator })?, tile.origin)?;
        }
        Ok(whole)
    }
}

/// The distance of the nearest hit so far in each pixel of a film.
#[derive(Debug)]
pub(crate) struct NearestDistances {
    size: [u32; 2],
    /// Distance from the camera for each pixel, row by row; infinite for a miss.
    distances: Vec<f32>,
}

/// Relative distance by which a box must be farther than a hit. It is more than the rounding of distances in f32.
const FARTHER: f64 = 1.0 / (1 << 18) as f64;

impl NearestDistances {
    /// The distances of hits that a kernel has written.
    pub(crate) fn new(size: [u32; 2], hits: &[Hit]) -> Self {
        let distance = |[t, id, _, distance]: &Hit| match *id {
            NO_ID => f32::INFINITY,
            _ => f32::from_bits(*t) + f32::from_bits(*distance),
        };
        Self { size, distances: hits.iter().map(distance).collect() }
    }

    /// Whether the ray of every pixel of some workgroups misses a box or hits something before it. Always false for
    /// cameras whose rays start far from the scene, because kernels round them by more than the margin of boxes.
    pub(crate) fn hide(&self, view: &View<'_>, space: &SceneSpace, groups: Groups) -> bool {
        if !view.camera.kind().is_linear() {
            return false;
        }
        let [columns, rows] = [0, 1].map(|axis| {
            let (first, count) = (groups.first[axis], groups.size[axis]);
            let side = WORKGROUP_SIDE;
            first * side..((first + count) * side).min(self.size[axis])
        });
        let [min, max] = [space.min, space.max].map(|corner| space.origin + corner.as_dvec3());
        let bounds = Bounds::between(min, max);
        let is_hidden = |column: u32, row: u32| {
            let place = row as usize * self.size[0] as usize + column as usize;
            let ray = view.ray_through_center([column, row]);
            let entry = ray.and_then(|ray| bounds.entry(&ray));
            entry.is_none_or(|entry| f64::from(self.distances[place]) < entry * (1.0 - FARTHER))
        };
        let is_row_hidden = |at: usize| columns.clone().all(|column| is_hidden(column, rows.start + at as u32));
        map(rows.len(), is_row_hidden).into_iter().all(|is_hidden| is_hidden)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::camera::film::Film;
    use crate::camera::{FisheyeCamera, OrthographicCamera, Pose};

    /// Pixels of one unit, seen from z = 10, and a box from z = 2 to 3 behind the pixels from 4 to 6 in each direction.
    #[test]
    fn a_box_is_hidden_by_nearer_hits_on_all_of_its_pixels() {
        let film = Film::new(16, 16).unwrap();
        let pose = Pose::looking_along([8.0, 8.0, 10.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [8.0, 8.0]).unwrap();
        let view = View::new(&camera, film);
        let space = SceneSpace {
            origin: DVec3::new(4.0, 4.0, 0.0),
            min: Vec3::new(0.0, 0.0, 2.0),
            max: Vec3::new(2.0, 2.0, 3.0),
        };
        let (all, right) = (Groups::of_size([16, 16]), Groups { first: [1, 0], size: [1, 2] });
        let hit = |t: f32| [t.to_bits(), 0, 0, 0.5_f32.to_bits()];
        let mut hits = vec![[0, NO_ID, 0, 0]; 256];
        let hides = |hits: &[Hit], groups| NearestDistances::new([16, 16], hits).hide(&view, &space, groups);
        assert!(!hides(&hits, all) && hides(&hits, right));
        for row in 10..12 {
            for column in 4..6 {
                assert!(!hides(&hits, all));
                hits[16 * row + column] = hit(6.4);
            }
        }
        assert!(hides(&hits, all));
        // Hits at the distance of the box, and behind it.
        for t in [6.5, 7.0] {
            hits[16 * 10 + 4] = hit(t);
            assert!(!hides(&hits, all), "{t}");
        }
        hits[16 * 10 + 4] = hit(6.4);
        let round = FisheyeCamera::new(pose, 3.0, 1.0).unwrap();
        assert!(!NearestDistances::new([16, 16], &hits).hide(&View::new(&round, film), &space, all));
    }
}
