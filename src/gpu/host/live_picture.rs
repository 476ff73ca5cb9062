//! Live pictures in the encoders of a host.

use std::sync::Arc;

use glam::DVec3;
use wgpu::{BindGroup, Buffer, BufferUsages, CommandEncoder, ComputePassDescriptor, Device, Queue};

use crate::camera::film::{Film, YAxis};
use crate::camera::{Camera, CameraKind, CameraVectors, View};
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::host::lit_picture::LitState;
use crate::gpu::host::lit_renderer::{LitRenderer, lit_key};
use crate::gpu::host::tickets::{AT_ONCE, Tickets};
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::lit::records::DispatchParameters;
use crate::gpu::passes::lit::{LightingBuffers, LightingData, LitScene, LiveKey, LivePasses, LiveView};
use crate::gpu::passes::targets::Targets;
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::resources::{Make, bind_group, buffer, part, whole};
use crate::gpu::scene::scene_buffers::{SceneBuffers, SceneId};
use crate::gpu::shader::records::FrameParameters;
use crate::render::{Integrator, RenderSettings};

/// Number of rays of ambient light for each pixel and frame.
const OCCLUSION_RAYS: u32 = 2;
/// Maximum number of frames over which visible shares of light are averaged.
const MOST: u32 = 64;
/// Maximum number of these frames if lamps move with the camera, because their shadows change from frame to frame.
const MOST_MOVING: u32 = 4;

/// A studio that looks finished while the camera, the light or the spheres move.
///
/// Each frame traces one ray of the camera through the centre of each pixel, one shadow ray and a few rays of ambient
/// occlusion. The hidden share of the light is averaged over earlier frames, where they show the same sphere, and over
/// neighbouring pixels, which count less as frames add up. The colours of surfaces and lamps are never mixed.
#[derive(Debug)]
pub struct LivePicture {
    passes: Arc<LivePasses>,
    key: LiveKey,
    lighting: LightingData,
    lit: LightingBuffers,
    buffers: Buffers,
    /// The frame that holds the targets.
    targets: Frame,
    frames: [FrameParameters; 2],
    scene: SceneId,
    /// The current camera. `before` has the camera and the scene of the previous frame.
    seen_from: PreviousCamera,
    film: Film,
    before: Option<(PreviousCamera, SceneId)>,
    has_moving_lamps: bool,
    /// Number of frames that were recorded.
    count: u32,
    tickets: Tickets,
}

#[derive(Debug)]
struct Buffers {
    frame: Buffer,
    dispatches: Buffer,
    views: Buffer,
    /// Distances in bytes between the records of successive recordings.
    strides: [usize; 2],
    /// The status word, and a stand-in for the lists of paths.
    status: Buffer,
    group: BindGroup,
    /// Bind groups of the passes after the first, for even and for odd frames.
    known: [BindGroup; 2],
}

/// The progress that a recording has made with a live picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LiveProgress {
    /// Number of rays that the recorded commands trace at most.
    pub rays: u64,
    /// [`LitState::Refining`], or [`LitState::Waiting`] if the device has not finished the recordings before, so that
    /// nothing was recorded.
    pub state: LitState,
    /// Whether commands of an earlier recording were not executed, or not in order, so that the averages begin again.
    pub was_lost: bool,
}

impl LivePicture {
    /// Creates the buffers of a picture in the targets. These must have the formats of the renderer's options, the size
    /// of the film, and the usage `STORAGE_BINDING`. Missing pipelines are built.
    ///
    /// # Errors
    /// [`GpuError::NotLive`] unless the settings are a studio without added light, all spheres are opaque and the scene is not
    /// divided into bricks; the errors of [`RenderSettings::check`]; [`GpuError::Target`] if a target is not as described;
    /// [`GpuError::Limit`] if the picture is too large; an error if the device has no memory left.
    pub async fn new(
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        let (scenes, lighting, key) = live_key(device, scene, view, settings)?;
        let targets = Frame::new(renderer.renderer(), device, targets).await?;
        targets.check_film(view)?;
        let passes = renderer.live_passes(device, key).await?;
        let lit = LightingBuffers::new(Make { device, queue }, &passes.lit, &lighting, None).await?;
        let buffers = Buffers::new(device, &passes, targets.size()).await?;
        let tickets = scoped(device, || Tickets::new(device)).await?;
        let frames = frames_of(device, scenes);
        buffers.write_frame(queue, &frames);
        Ok(Self {
            passes,
            key,
            lighting,
            lit,
            buffers,
            targets,
            frames,
            scene: scene.id,
            seen_from: PreviousCamera::new(view.camera),
            film: view.film,
            before: None,
            has_moving_lamps: false,
            count: 0,
            tickets,
        })
    }

    /// Sets the scene, the view and the light of the next frame.
    ///
    /// The new values are queued on `queue` and take effect with its next submission. Buffers are created only for
    /// another number of lights or materials.
    ///
    /// # Errors
    /// The errors of [`LivePicture::new`]; the picture stays as it was.
    pub async fn set(
        &mut self,
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        self.targets.check_renderer(renderer.renderer())?;
        self.targets.check_film(view)?;
        let (scenes, lighting, key) = live_key(device, scene, view, settings)?;
        let make = Make { device, queue };
        if key != self.key {
            let passes = renderer.live_passes(device, key).await?;
            self.lit = LightingBuffers::new(make, &passes.lit, &lighting, None).await?;
            self.buffers = Buffers::new(device, &passes, self.targets.size()).await?;
            (self.passes, self.key, self.before) = (passes, key, None);
        } else if !lighting.is_same(&self.lighting) {
            self.lit.set(make, &self.passes.lit, &lighting, false).await?;
        }
        // Lamps move with the camera, or because the host moves them. Any other change changes which light is hidden.
        let has_other_rays = lighting.rays_differ(&self.lighting);
        self.has_moving_lamps |= lighting.tables != self.lighting.tables;
        if has_other_rays {
            self.before = None;
        }
        self.frames = frames_of(device, scenes);
        self.buffers.write_frame(queue, &self.frames);
        (self.lighting, self.scene) = (lighting, scene.id);
        (self.seen_from, self.film) = (PreviousCamera::new(view.camera), view.film);
        Ok(())
    }

    /// Records a frame into the host's encoder: colours, and depth, normals and ids if the renderer has data layers.
    /// Where the ground is seen, the depth is that of the ground. Nothing is submitted, awaited or created.
    ///
    /// The encoder must be submitted to `queue` before the next frame is set.
    ///
    /// # Errors
    /// [`GpuError::OtherScene`] if the scene is not the one that was set, or its spheres have moved since;
    /// [`GpuError::OtherRenderer`]. Nothing is recorded then. [`GpuError::Steps`] if searches of an earlier frame were
    /// abandoned.
    pub fn record(
        &mut self,
        renderer: &LitRenderer,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        scene: &SceneBuffers,
    ) -> Result<LiveProgress, GpuError> {
        self.targets.check_renderer(renderer.renderer())?;
        if scene.id != self.scene {
            return Err(GpuError::OtherScene);
        }
        let news = self.tickets.news();
        if news.is_lost {
            self.tickets.begin_again();
            self.before = None;
        }
        let [_, visible] = &self.frames;
        // Each pixel has rays to its surface, to a lamp and for ambient light.
        let rays = Groups { first: [0, 0], size: visible.traced_size }.pixels()
            * u64::from(2 + self.lighting.parameters.occlusion_samples);
        let Some(place) = self.tickets.free() else {
            let state = LitState::Waiting;
            return Ok(LiveProgress { rays: 0, state, was_lost: news.is_lost });
        };
        if self.count == 0 || news.is_spent {
            encoder.clear_buffer(&self.buffers.status, 0, Some(4));
        }
        if news.is_spent {
            return Err(GpuError::Steps);
        }
        self.record_passes(queue, encoder, scene, place);
        self.before = Some((self.seen_from, self.scene));
        self.has_moving_lamps = false;
        self.count = self.count.wrapping_add(1);
        self.tickets.record(encoder, place, [&self.buffers.status; 2]);
        Ok(LiveProgress { rays, state: LitState::Refining, was_lost: news.is_lost })
    }

    fn record_passes(&self, queue: &Queue, encoder: &mut CommandEncoder, scene: &SceneBuffers, place: usize) {
        let Self { passes, buffers, .. } = self;
        let [all, visible] = &self.frames;
        let dispatch = DispatchParameters {
            sample: self.count,
            count: 1,
            visible_first: visible.traced_first,
            visible_size: visible.traced_size,
            ..bytemuck::Zeroable::zeroed()
        };
        let offsets = buffers.strides.map(|stride| (place * stride) as u32);
        let bytes = bytemuck::bytes_of(&dispatch);
        queue.write_buffer(&buffers.dispatches, offsets[0].into(), bytes);
        let before = self.before.filter(|(_, shown)| *shown == self.scene).map(|(seen, _)| seen);
        let most_lamps = if self.has_moving_lamps { MOST_MOVING } else { MOST };
        let view = record(self.seen_from, &self.film, before, [most_lamps, MOST]);
        queue.write_buffer(&buffers.views, offsets[1].into(), bytemuck::bytes_of(&view));
        let descriptor = ComputePassDescriptor { label: Some("pinhole live"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        let brick = &scene.bricks[0];
        pass.set_pipeline(&passes.live);
        pass.set_bind_group(0, &buffers.group, &[offsets[0]]);
        pass.set_bind_group(1, &brick.trace_group, &[]);
        pass.set_bind_group(2, &self.lit.group, &[]);
        pass.set_bind_group(3, &brick.appearance_group, &[]);
        pass.dispatch_workgroups(all.traced_size[0], all.traced_size[1], 1);
        let [width, height] = Groups::of_size(self.targets.size()).size;
        let number = (self.count % 2) as usize;
        pass.set_pipeline(&passes.reproject);
        pass.set_bind_group(0, &buffers.known[number], &[offsets[1]]);
        pass.dispatch_workgroups(width, height, 1);
        pass.set_pipeline(&passes.show);
        // This frame writes the history that the next one reads.
        pass.set_bind_group(0, &buffers.known[1 - number], &[offsets[1]]);
        pass.set_bind_group(2, self.targets.target_group(), &[]);
        pass.dispatch_workgroups(width, height, 1);
    }
}

impl Buffers {
    async fn new(device: &Device, passes: &LivePasses, [width, height]: [u32; 2]) -> Result<Self, GpuError> {
        let alignment = device.limits().min_uniform_buffer_offset_alignment as usize;
        let strides =
            [size_of::<DispatchParameters>(), size_of::<LiveView>()].map(|bytes| bytes.next_multiple_of(alignment));
        let pixels = u64::from(width) * u64::from(height);
        check_storage_size(device, "the surfaces of a live picture", 64 * pixels)?;
        scoped(device, || {
            let uniform = |label, bytes: usize| buffer(device, label, bytes as u64, BufferUsages::UNIFORM);
            let both = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let storage = |label, bytes| buffer(device, label, bytes, both);
            let frame = uniform("pinhole live frame", size_of::<FrameParameters>());
            let dispatches = uniform("pinhole live dispatches", AT_ONCE * strides[0]);
            let views = uniform("pinhole live views", AT_ONCE * strides[1]);
            let status = storage("pinhole live status", 64);
            let surfaces = storage("pinhole live surfaces", 64 * pixels);
            let known = [(); 2].map(|()| storage("pinhole live visibility", 16 * pixels));
            let samples = [
                whole(0, &frame),
                whole(2, &status),
                (4, part(&dispatches, 0, size_of::<DispatchParameters>())),
                whole(5, &surfaces),
            ];
            let group = bind_group(device, "pinhole live", &passes.lit.samples, &samples);
            let of_frame = |before: usize| {
                let entries = [
                    (0, part(&views, 0, size_of::<LiveView>())),
                    whole(1, &surfaces),
                    whole(2, &known[before]),
                    whole(3, &known[1 - before]),
                ];
                bind_group(device, "pinhole live visibility", &passes.known, &entries)
            };
            let known = [of_frame(0), of_frame(1)];
            Self { frame, dispatches, views, strides, status, group, known }
        })
        .await
    }

    fn write_frame(&self, queue: &Queue, [all, _]: &[FrameParameters; 2]) {
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(all));
    }
}

/// A scene with a view for a live picture, its light, and the key of its passes.
fn live_key<'a>(
    device: &Device,
    scene: &'a SceneBuffers,
    view: &'a View<'a>,
    settings: &'a RenderSettings,
) -> Result<(LitScene<'a>, LightingData, LiveKey), GpuError> {
    let mut few = settings.clone();
    let Integrator::Studio(studio) = &mut few.integrator else {
        return Err(GpuError::NotLive { needs: "the integrator `studio`" });
    };
    if studio.added_light {
        return Err(GpuError::NotLive { needs: "spheres that are lit, and no added light" });
    }
    studio.occlusion.iter_mut().for_each(|occlusion| occlusion.samples = OCCLUSION_RAYS);
    if !scene.appearance().is_opaque() {
        return Err(GpuError::NotLive { needs: "opaque spheres" });
    }
    if scene.has_cones() {
        return Err(GpuError::NotLive { needs: "spheres alone" });
    }
    let (_, lighting, key) = lit_key(device, scene, view, &few)?;
    let scenes = LitScene { all: scene, occluders: scene, view, settings };
    let needs = "a scene in one brick, a structure that fits into one pass, and at most 32 lights";
    let key = LiveKey::new(&key).ok_or(GpuError::NotLive { needs })?;
    Ok((scenes, lighting, key))
}

/// The records of the whole picture: for all workgroups, and for the workgroups in which the scene may be visible.
fn frames_of(device: &Device, scenes: LitScene<'_>) -> [FrameParameters; 2] {
    let film = &scenes.view.film;
    let tile = Tile { origin: [0, 0], size: [film.width(), film.height()], in_target: [0, 0] };
    let (_, [all, visible, _]) = scenes.records(device)(tile);
    [all, visible]
}

/// Values of `has_before` for a previous frame with another view, and with the same view.
const OTHER_VIEW: u32 = 1;
const SAME_VIEW: u32 = 2;

/// A camera that a frame was seen from. The points of the next frame are found in its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PreviousCamera {
    kind: CameraKind,
    vectors: CameraVectors,
}

impl PreviousCamera {
    pub(super) fn new(camera: &dyn Camera) -> Self {
        Self { kind: camera.kind(), vectors: camera.vectors() }
    }

    /// Whether a projection maps points to the film: a linear map, divided by another.
    fn is_linear(self) -> bool {
        matches!(self.kind, CameraKind::Pinhole | CameraKind::ThinLens | CameraKind::Orthographic)
    }
}

/// The record of a frame seen by the camera `now`. `before` is the camera of an earlier frame that shows the same
/// surfaces. `most` are the maximum numbers of frames over which the shares of lamps and of ambient light are averaged.
pub(super) fn record(now: PreviousCamera, film: &Film, before: Option<PreviousCamera>, most: [u32; 2]) -> LiveView {
    let CameraVectors { origin, right, up, forward, .. } = now.vectors;
    let narrow = |v: DVec3| v.as_vec3().to_array();
    let is_parallel = now.kind == CameraKind::Orthographic;
    let height = f64::from(film.height());
    let at_one = if is_parallel { 1.0 } else { forward.length() };
    let mut record = LiveView {
        right: narrow(right),
        is_parallel: is_parallel.into(),
        up: narrow(up),
        footprint: (2.0 * up.length() / (height * at_one)) as f32,
        forward: narrow(forward),
        y_sign: match film.y_axis() {
            YAxis::Up => 1.0,
            YAxis::Down => -1.0,
        },
        most_lamps: most[0],
        most_open: most[1],
        size: [film.width(), film.height()],
        ..bytemuck::Zeroable::zeroed()
    };
    if let Some(before) = before {
        if before == now {
            record.has_before = SAME_VIEW;
        } else if before.kind == now.kind && now.is_linear() {
            let CameraVectors { origin: old, right, up, forward, .. } = before.vectors;
            let dual = |a: DVec3, b: DVec3, of: DVec3| narrow(a.cross(b) / of.dot(a.cross(b)));
            record.has_before = OTHER_VIEW;
            record.shift = narrow(origin - old);
            record.across = dual(up, forward, right);
            record.down = dual(forward, right, up);
            record.along = dual(right, up, forward);
        }
    }
    record
}
