//! The buffers of a scene on a device.

use std::borrow::Borrow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use wgpu::{Device, Queue};

use crate::accel::{Accel, AccelChoice, AccelPlan, Brick, BrickBounds, BrickKind, LIST_LEN, Structure};
use crate::camera::View;
use crate::gpu::device_shape::{DeviceShape, SubmissionSize};
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::scene::scene_summary::{ExcludeBy, SceneSummary, ShapeIds};
use crate::gpu::scene::scene_upload::{BrickBuffers, BrickSource, BrickSpace, SceneUpload, UploadedBricks, bricks_of};
use crate::gpu::shader::records::SceneSpace;
use crate::gpu::shader::textures::{TEXELS_PER_ROW, reads_textures};
use crate::render::{PrimarySettings, RenderSettings};
use crate::scene::{Scene, SceneAppearance};
use crate::smooth::SmoothPicture;

/// Identifies a scene on a device, and the version of its shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SceneId {
    scene: u64,
    /// Number of times that the scene's spheres have moved.
    shape: u64,
}

/// Identifies the look of a scene on a device: its shapes and its colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SceneLook {
    id: SceneId,
    /// Number of times that the colours have changed since the scene was copied to the device.
    colors: u64,
}

impl SceneId {
    fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self { scene: NEXT.fetch_add(1, Ordering::Relaxed), shape: 0 }
    }
}

/// The buffers of a scene on a device. Any number of frames can use them.
#[derive(Debug)]
pub struct SceneBuffers {
    pub(crate) id: SceneId,
    colors: u64,
    pub(crate) space: SceneSpace,
    /// The data of the host's scene that pictures need.
    pub(crate) summary: SceneSummary,
    structure: Structure,
    /// How lit pictures exclude a sphere from the search of a ray that starts on it.
    pub(crate) exclude_by: ExcludeBy,
    /// Bricks in the order in which they were copied. There is at least one, so that the rays of an
    /// empty scene are marked as misses.
    pub(crate) bricks: Vec<BrickBuffers>,
    bytes: u64,
    /// Number of spheres that a ray tests in one dispatch if the structure is a list; 0 otherwise.
    tests_per_ray: usize,
    /// The order and the amounts of work that suit the device.
    pub(crate) shape: DeviceShape,
    /// The submission size at the end of the last picture of the scene.
    submission_size: Mutex<SubmissionSize>,
    /// The spheres that cast shadows in a studio, if some do not and a studio was planned for.
    pub(crate) occluders: Option<Box<Self>>,
}

impl SceneBuffers {
    /// The picture of these spheres, if it is smooth.
    pub(crate) fn smooth<'a>(&'a self, view: &View<'a>, settings: &'a RenderSettings) -> Option<SmoothPicture<'a>> {
        let SceneSummary { shapes, origin, appearance, .. } = &self.summary;
        SmoothPicture::new((shapes, *origin), appearance, view, settings)
    }

    /// Copies a scene to a device, with a structure that suits it.
    ///
    /// The copy is queued and precedes everything that is submitted later.
    ///
    /// # Errors
    /// As for [`SceneBuffers::with_accel`].
    pub async fn new(renderer: &Renderer, device: &Device, queue: &Queue, scene: &Scene) -> Result<Self, GpuError> {
        let plan = plan_of(device, scene);
        let bricks = BrickSource::from(bricks_of(&plan, scene));
        let ids = ShapeIds::of_all(scene, bricks.may_split_duplicates);
        Self::upload(renderer, device, queue, SceneSummary::of(scene), bricks, &ids).await
    }

    /// Copies a scene to a device, with a structure that was built for it.
    ///
    /// The copy is queued and precedes everything that is submitted later.
    ///
    /// # Errors
    /// If the renderer was not built for this structure, if a brick does not fit into a binding of the device, or if
    /// the scene does not fit into its memory.
    pub async fn with_accel(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        accel: &Accel,
    ) -> Result<Self, GpuError> {
        let ids = ShapeIds::of_all(scene, accel.may_split_duplicates());
        Self::upload(renderer, device, queue, SceneSummary::of(scene), accel.into(), &ids).await
    }

    /// Copies a scene like [`SceneBuffers::new`]. If some spheres cast no shadows, because they are not opaque, also
    /// copies a second structure, of the spheres that do. Studios of such scenes need it.
    ///
    /// # Errors
    /// As for [`SceneBuffers::with_accel`].
    pub async fn for_studio(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        let all = Self::new(renderer, device, queue, scene).await?;
        let Some(opaque) = scene.opaque() else { return Ok(all) };
        let plan = plan_of(device, &opaque);
        let (summary, ids) = (SceneSummary::of_occluders(scene), ShapeIds::of_opaque(scene));
        let bricks = BrickSource::from(bricks_of(&plan, &opaque));
        let some = Self::upload(renderer, device, queue, summary, bricks, &ids).await?;
        Ok(all.with_occluders(some))
    }

    /// Copies a scene like [`SceneBuffers::with_accel`]. All copies are queued.
    async fn upload<B: Borrow<Brick>>(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        summary: SceneSummary,
        bricks: BrickSource<impl Iterator<Item = B>>,
        ids: &ShapeIds,
    ) -> Result<Self, GpuError> {
        let BrickSource { space, bricks, .. } = bricks;
        let mut upload = SceneUpload::new(renderer, device, queue, &summary, space, ids).await?;
        for brick in bricks {
            upload.brick(brick.borrow()).await?;
        }
        if !upload.take_work().is_empty() {
            // Nothing is submitted to the device of a host.
            return Err(GpuError::NoRayQuery);
        }
        Ok(Self::new_of(upload.finish()?, summary, ids.exclude_by, renderer.shape))
    }

    /// Creates a scene from bricks that were copied.
    pub(crate) fn new_of(
        uploaded: UploadedBricks,
        summary: SceneSummary,
        exclude_by: ExcludeBy,
        shape: DeviceShape,
    ) -> Self {
        let UploadedBricks { space: BrickSpace { structure, bounds: (min, max) }, bricks, bytes } = uploaded;
        // Without spheres, the structure of the cones.
        let structure = bricks.first().map_or(structure, |brick| brick.kind.structure);
        let lists = bricks.iter().filter(|brick| brick.kind.structure == Structure::List);
        let tests_per_ray = lists.map(|brick| brick.shape_count as usize).max().unwrap_or(0);
        Self {
            id: SceneId::new(),
            colors: 0,
            space: SceneSpace { origin: summary.origin, min, max },
            summary,
            structure,
            exclude_by,
            bricks,
            bytes,
            occluders: None,
            tests_per_ray,
            shape,
            submission_size: Mutex::new(SubmissionSize::new(tests_per_ray, shape)),
        }
    }

    /// Returns the same scene together with its spheres that cast shadows in a studio.
    pub(crate) fn with_occluders(self, occluders: Self) -> Self {
        Self { occluders: Some(Box::new(occluders)), ..self }
    }

    /// Replaces the summary after the colours in the buffers were changed.
    pub(crate) fn set_summary(&mut self, summary: SceneSummary) {
        self.summary = summary;
        self.colors += 1;
    }

    /// Replaces the buffers by a copy of the same scene with moved spheres, which [`SceneBuffers::new`] or
    /// [`SceneBuffers::with_accel`] created after [`Scene::apply`]. The views of frames that show the scene must be set
    /// again with [`Frame::set_view`](crate::gpu::Frame::set_view).
    pub fn replace(&mut self, copy: Self) {
        let SceneId { scene, shape } = self.id;
        let is_same_structure = copy.structure == self.structure;
        // The adapted submission size stays valid for the same kind of structure.
        let submission_size = if is_same_structure { self.submission_size() } else { copy.submission_size() };
        let id = SceneId { scene, shape: shape + 1 };
        *self = Self { id, submission_size: Mutex::new(submission_size), ..copy };
    }

    /// Returns the number of bytes of all buffers on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes + self.occluders.as_ref().map_or(0, |occluders| occluders.bytes())
    }

    /// The buffers of the spheres that can hide lights from surfaces. In a studio these are only the opaque spheres.
    pub(crate) fn occluders(&self, settings: &RenderSettings) -> Result<&Self, GpuError> {
        match settings.studio_parameters() {
            Some(_) => self.studio_occluders(),
            None => Ok(self),
        }
    }

    /// The buffers of the spheres that can hide lights from surfaces in a studio.
    pub(crate) fn studio_occluders(&self) -> Result<&Self, GpuError> {
        match &self.occluders {
            _ if self.summary.is_opaque() => Ok(self),
            Some(occluders) => Ok(occluders),
            None => Err(GpuError::NoOccluders),
        }
    }

    /// True if there are cones or cylinders.
    pub(crate) fn has_cones(&self) -> bool {
        !self.summary.shapes.cones.is_empty()
    }

    /// The settings for shading primary rays.
    pub(crate) fn primary_settings(&self, settings: &RenderSettings) -> Result<PrimarySettings, GpuError> {
        let integrator = settings.integrator.name();
        let primary = settings.primary().ok_or(GpuError::NotPrimary { integrator })?;
        settings.check_with(&self.summary.appearance)?;
        Ok(primary)
    }

    pub(crate) fn look(&self) -> SceneLook {
        SceneLook { id: self.id, colors: self.colors }
    }

    /// Number of rays, at most `max`, that an invocation may search one after another. If each ray tests all spheres,
    /// the iteration limit bounds the number.
    pub(crate) fn rays_at_once(&self, max: u32) -> u32 {
        let fits = LIST_LEN / self.tests_per_ray.max(1);
        u32::try_from(fits).unwrap_or(u32::MAX).clamp(1, max)
    }

    /// The size of the next submission.
    pub(crate) fn submission_size(&self) -> SubmissionSize {
        *self.submission_size.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adapts the submission size to the time that a submission took. The next picture starts with the last size of
    /// this picture, because most pictures of a scene take about the same time.
    pub(crate) fn adapt_submission_size(&self, groups: Groups, elapsed: Duration) {
        self.submission_size.lock().unwrap_or_else(PoisonError::into_inner).adapt(groups.count(), elapsed);
    }

    pub(crate) fn appearance(&self) -> &SceneAppearance {
        &self.summary.appearance
    }

    /// Returns the structure of the bricks.
    #[must_use]
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// The kinds of the bricks, without repetition.
    pub(crate) fn kinds(&self) -> Vec<BrickKind> {
        let mut kinds = Vec::new();
        for brick in &self.bricks {
            if !kinds.contains(&brick.kind) {
                kinds.push(brick.kind);
            }
        }
        kinds
    }

    /// True if pipelines are needed that continue from the hits of other bricks of the same kind.
    pub(crate) fn has_several_bricks(&self) -> bool {
        has_several(&self.bricks.iter().map(|brick| brick.kind).collect::<Vec<_>>())
    }

    /// The boxes of the bricks, in the same order.
    pub(crate) fn brick_bounds(&self) -> Vec<BrickBounds> {
        self.bricks.iter().map(|brick| brick.bounds).collect()
    }
}

/// True if there are several bricks of the kind of shapes that is traced first, which is that of the first brick.
pub(crate) fn has_several(kinds: &[BrickKind]) -> bool {
    kinds.iter().filter(|of| Some(of.primitive) == kinds.first().map(|first| first.primitive)).count() > 1
}

/// Maximum size of a storage binding in bytes on a device with these limits.
pub(crate) fn binding_limit(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// Maximum size in bytes of the data of a brick that kernels search on a device: of a binding, or of a texture of numbers.
pub(crate) fn search_limit(device: &Device) -> u64 {
    let limits = device.limits();
    let binding = binding_limit(&limits);
    let texture = 4 * TEXELS_PER_ROW as u64 * u64::from(limits.max_texture_dimension_2d);
    if reads_textures(device) { binding.min(texture) } else { binding }
}

/// Plans the structure of a scene for a device.
fn plan_of(device: &Device, scene: &Scene) -> AccelPlan {
    let binding = search_limit(device);
    AccelPlan::new(scene.spheres(), AccelChoice::Auto, binding).with_cones(scene.cones(), binding)
}
