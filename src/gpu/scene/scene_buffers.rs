//! A scene on a device.

use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use wgpu::{Buffer, Device, Queue};

use crate::accel::{Accel, AccelChoice, AccelPlan, BrickKind, LIST_LEN, Structure};
use crate::gpu::error::{GpuError, check_storage_size, scoped};
use crate::gpu::headless::submission_size::SubmissionSize;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::scene::appearance;
use crate::gpu::scene::brick_buffers::{BrickBuffers, BrickContents, Upload};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::shape_ids::{ExcludeBy, ShapeIds};
use crate::gpu::shader::records::SceneSpace;
use crate::render::{PrimarySettings, RenderSettings};
use crate::scene::{Scene, SceneAppearance};

/// Tells scenes on devices apart, and where the spheres of each are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gpu) struct SceneId {
    scene: u64,
    /// How often its spheres have moved.
    shape: u64,
}

impl SceneId {
    fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self { scene: NEXT.fetch_add(1, Ordering::Relaxed), shape: 0 }
    }
}

/// A scene in buffers of a device. Per scene: made once, used by any number of frames.
#[derive(Debug)]
pub struct SceneBuffers {
    id: SceneId,
    space: SceneSpace,
    /// What of the host's scene pictures need.
    summary: SceneSummary,
    structure: Structure,
    /// How lit pictures keep rays from the spheres that they start on.
    exclude_by: ExcludeBy,
    bricks: Vec<BrickBuffers>,
    bytes: u64,
    /// How many spheres a ray tries in one dispatch, if it is many.
    tests_per_ray: usize,
    /// What the last picture of the scene taught of the device.
    submission_size: Mutex<SubmissionSize>,
    /// Of the spheres that cast shadows in a studio, where some do not and a studio was planned for.
    occluders: Option<Box<Self>>,
}

impl SceneBuffers {
    /// Copies the scene to the device, with a structure that suits it.
    ///
    /// The copy is queued; it is done before anything that is submitted later.
    ///
    /// # Errors
    /// As [`SceneBuffers::with_accel`].
    pub fn new(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        let plan =
            AccelPlan::new(scene.spheres(), AccelChoice::Auto, binding_limit(&device.limits()));
        Self::with_accel(renderer, device, queue, scene, &plan.build(scene.spheres()))
    }

    /// Copies the scene to the device, with a structure that was built for it.
    ///
    /// The copy is queued; it is done before anything that is submitted later.
    ///
    /// # Errors
    /// If the renderer was not built for this structure, if a brick does not fit into the bindings of the
    /// device, or the whole into its memory.
    pub fn with_accel(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        accel: &Accel,
    ) -> Result<Self, GpuError> {
        let ids = ShapeIds::of_all(scene, accel);
        Self::upload(renderer, device, queue, SceneSummary::of(scene), accel, &ids, || Ok(()))
    }

    /// As [`SceneBuffers::with_accel`]; calls `flush` after every brick, so that the host may submit what is
    /// queued and its copy is freed.
    pub(in crate::gpu) fn upload(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        summary: SceneSummary,
        accel: &Accel,
        ids: &ShapeIds,
        mut flush: impl FnMut() -> Result<(), GpuError>,
    ) -> Result<Self, GpuError> {
        let appearance = &summary.appearance;
        let mut upload = Upload { renderer, device, queue, appearance, first_shape: 0, bytes: 0 };
        let palette = appearance::palette(appearance);
        check_storage_size(device, "the palette", size_of_val(&palette[..]) as u64)?;
        let palette = scoped(device, || upload.storage("pinhole palette", &palette))?;
        let mut bricks = Vec::new();
        for brick in accel.bricks() {
            let ids = ids.of(&brick.ids);
            let contents = BrickContents::of_spheres(brick, &ids, accel.kind());
            bricks.push(upload.brick(&contents, &palette)?);
            flush()?;
        }
        let bytes = upload.bytes;
        let (min, max) = accel.bounds();
        Ok(Self {
            id: SceneId::new(),
            space: SceneSpace { origin: summary.origin, min, max },
            summary,
            structure: accel.structure(),
            exclude_by: ids.exclude_by,
            bricks,
            bytes,
            occluders: None,
            tests_per_ray: tests_per_ray(accel),
            submission_size: Mutex::new(SubmissionSize::new(tests_per_ray(accel))),
        })
    }

    /// The same scene with what casts shadows in a studio, unless that is all.
    pub(in crate::gpu) fn with_occluders(self, occluders: Option<Self>) -> Self {
        Self { occluders: occluders.map(Box::new), ..self }
    }

    /// Takes note of other colours, which the buffers have been given.
    pub(in crate::gpu) fn set_summary(&mut self, summary: SceneSummary) {
        self.summary = summary;
    }

    /// Becomes a copy of the same scene with its spheres elsewhere: what [`SceneBuffers::new`] or
    /// [`SceneBuffers::with_accel`] made of it after [`Scene::apply`]. Frames that show the scene then need
    /// [`Frame::set_view`](crate::gpu::Frame::set_view).
    pub fn replace(&mut self, copy: Self) {
        let SceneId { scene, shape } = self.id;
        let is_like = copy.structure == self.structure;
        // What pictures have taught of the device holds on.
        let submission_size = if is_like { self.submission_size() } else { copy.submission_size() };
        let id = SceneId { scene, shape: shape + 1 };
        *self = Self { id, submission_size: Mutex::new(submission_size), ..copy };
    }

    /// Whether there is a structure of what casts shadows in a studio.
    pub(in crate::gpu) fn has_occluders(&self) -> bool {
        self.occluders.is_some()
    }

    /// Bytes of all its buffers on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes + self.occluders.as_ref().map_or(0, |occluders| occluders.bytes())
    }

    /// What is between surfaces and lights: in a studio, the opaque spheres alone.
    ///
    /// # Errors
    /// [`GpuError::NoOccluders`] if the scene was uploaded without what a studio needs.
    pub(in crate::gpu) fn occluders(&self, settings: &RenderSettings) -> Result<&Self, GpuError> {
        match &self.occluders {
            _ if settings.studio_parameters().is_none() || self.summary.is_opaque() => Ok(self),
            Some(occluders) => Ok(occluders),
            None => Err(GpuError::NoOccluders),
        }
    }

    /// How primary rays become colours.
    ///
    /// # Errors
    /// [`GpuError::NotPrimary`] if the picture is to be lit; what [`RenderSettings::check`] refuses.
    pub(in crate::gpu) fn primary_settings(
        &self,
        settings: &RenderSettings,
    ) -> Result<PrimarySettings, GpuError> {
        let integrator = settings.integrator.name();
        let primary = settings.primary().ok_or(GpuError::NotPrimary { integrator })?;
        settings.check_with(&self.summary.appearance)?;
        Ok(primary)
    }

    pub(in crate::gpu) fn summary(&self) -> &SceneSummary {
        &self.summary
    }

    pub(in crate::gpu) fn id(&self) -> SceneId {
        self.id
    }

    /// How many rays, at most so many, one invocation may search one after the other: where each tries all spheres, no
    /// more than one dispatch may loop for.
    pub(in crate::gpu) fn rays_at_once(&self, most: u32) -> u32 {
        let fits = LIST_LEN / self.tests_per_ray.max(1);
        u32::try_from(fits).unwrap_or(u32::MAX).clamp(1, most)
    }

    /// How much of a picture to submit at once.
    pub(in crate::gpu) fn submission_size(&self) -> SubmissionSize {
        *self.submission_size.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes note of what a submission took. The next picture starts as this one ends, because most pictures
    /// of a scene cost about the same.
    pub(in crate::gpu) fn took(&self, groups: Groups, elapsed: Duration) {
        self.submission_size
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .took(groups.count(), elapsed);
    }

    pub(in crate::gpu) fn appearance(&self) -> &SceneAppearance {
        &self.summary.appearance
    }

    pub(in crate::gpu) fn space(&self) -> &SceneSpace {
        &self.space
    }

    pub(in crate::gpu) fn structure(&self) -> Structure {
        self.structure
    }

    pub(in crate::gpu) fn exclude_by(&self) -> ExcludeBy {
        self.exclude_by
    }

    /// The kinds of the bricks, each once.
    pub(in crate::gpu) fn kinds(&self) -> Vec<BrickKind> {
        let mut kinds = Vec::new();
        for brick in &self.bricks {
            if !kinds.contains(&brick.kind) {
                kinds.push(brick.kind);
            }
        }
        kinds
    }

    /// In the order in which they were copied. At least one, so that an empty scene's rays are marked as
    /// misses.
    pub(in crate::gpu) fn bricks(&self) -> &[BrickBuffers] {
        &self.bricks
    }
}

/// What one storage binding can hold on a device with such limits.
pub(in crate::gpu) fn binding_limit(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// How many spheres a ray tries in one dispatch, if it is many.
fn tests_per_ray(accel: &Accel) -> usize {
    match accel.structure() {
        Structure::List => accel.bricks().iter().map(|b| b.spheres.len()).max().unwrap_or(0),
        _ => 0,
    }
}

/// Binds a part of a buffer, in bytes.
pub(in crate::gpu) fn part(
    buffer: &Buffer,
    offset: usize,
    size: usize,
) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: offset as u64,
        size: NonZeroU64::new(size as u64),
    })
}
