//! A scene on a device.

use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use wgpu::{BindGroup, Buffer, BufferUsages, Device, Queue};

use super::appearance::{self, Looks};
use super::error::{GpuError, check_storage_size, scoped};
use super::order::CenterBox;
use super::pace::Pace;
use super::records::{self, SceneSpace};
use super::renderer::Renderer;
use super::scene_summary::SceneSummary;
use super::tiles::Groups;
use crate::accel::{Accel, AccelChoice, AccelPlan, Brick, BrickKind, Index, LIST_LEN, Structure};
use crate::render::{PrimaryLook, RenderSettings};
use crate::scene::{Scene, SceneAppearance};

/// Tells scenes on devices apart, and where the spheres of each are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SceneId {
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
    bricks: Vec<BrickBuffers>,
    bytes: u64,
    /// How many spheres a ray tries in one dispatch, if it is many.
    tests_per_ray: usize,
    /// What the last picture of the scene taught of the device.
    pace: Mutex<Pace>,
    /// Of the spheres that cast shadows in a studio, where some do not and a studio was planned for.
    occluders: Option<Box<Self>>,
}

/// A brick, bound for the kernels.
#[derive(Debug)]
pub(super) struct BrickBuffers {
    /// What searches and shades it.
    pub(super) kind: BrickKind,
    /// Where it is, to tell which is nearer.
    pub(super) center_box: CenterBox,
    /// Group 1 of `trace` and `occluded`.
    pub(super) trace_group: BindGroup,
    /// Group 1 of `shade`.
    pub(super) surface_group: BindGroup,
    /// Of every sphere, in the order of the structure.
    pub(super) ids: Buffer,
    /// What every sphere looks like.
    pub(super) looks: Buffer,
    pub(super) place_count: u32,
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
        Self::upload(renderer, device, queue, SceneSummary::of(scene), accel, || Ok(()))
    }

    /// As [`SceneBuffers::with_accel`]; calls `flush` after every brick, so that the host may submit what is
    /// queued and its copy is freed.
    pub(super) fn upload(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        summary: SceneSummary,
        accel: &Accel,
        mut flush: impl FnMut() -> Result<(), GpuError>,
    ) -> Result<Self, GpuError> {
        let appearance = &summary.appearance;
        let mut upload = Upload { renderer, device, queue, appearance, first_place: 0, bytes: 0 };
        let palette = appearance::palette(appearance);
        check_storage_size(device, "the palette", size_of_val(&palette[..]) as u64)?;
        let palette = scoped(device, || upload.storage("pinhole palette", &palette))?;
        let mut bricks = Vec::new();
        for brick in accel.bricks() {
            bricks.push(upload.brick(&BrickContents::of_spheres(brick, accel.kind()), &palette)?);
            flush()?;
        }
        let bytes = upload.bytes;
        let (min, max) = accel.bounds();
        Ok(Self {
            id: SceneId::new(),
            space: SceneSpace { origin: summary.origin, min, max },
            summary,
            structure: accel.structure(),
            bricks,
            bytes,
            occluders: None,
            tests_per_ray: tests_per_ray(accel),
            pace: Mutex::new(Pace::new(tests_per_ray(accel))),
        })
    }

    /// The same scene with what casts shadows in a studio, unless that is all.
    pub(super) fn with_occluders(self, occluders: Option<Self>) -> Self {
        Self { occluders: occluders.map(Box::new), ..self }
    }

    /// Takes note of other colours, which the buffers have been given.
    pub(super) fn set_summary(&mut self, summary: SceneSummary) {
        self.summary = summary;
    }

    /// Becomes a copy of the same scene with its spheres elsewhere: what [`SceneBuffers::new`] or
    /// [`SceneBuffers::with_accel`] made of it after [`Scene::apply`]. Frames that show the scene then need
    /// [`Frame::set_view`](super::Frame::set_view).
    pub fn replace(&mut self, copy: Self) {
        let SceneId { scene, shape } = self.id;
        let is_like = copy.structure == self.structure;
        // What pictures have taught of the device holds on.
        let pace = if is_like { self.pace() } else { copy.pace() };
        let id = SceneId { scene, shape: shape + 1 };
        *self = Self { id, pace: Mutex::new(pace), ..copy };
    }

    /// Whether there is a structure of what casts shadows in a studio.
    pub(super) fn has_occluders(&self) -> bool {
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
    pub(super) fn occluders(&self, settings: &RenderSettings) -> Result<&Self, GpuError> {
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
    pub(super) fn primary_look(&self, settings: &RenderSettings) -> Result<PrimaryLook, GpuError> {
        let integrator = settings.integrator.name();
        let look = settings.primary().ok_or(GpuError::NotPrimary { integrator })?;
        settings.check_with(&self.summary.appearance)?;
        Ok(look)
    }

    pub(super) fn summary(&self) -> &SceneSummary {
        &self.summary
    }

    pub(super) fn id(&self) -> SceneId {
        self.id
    }

    /// How many rays, at most so many, one invocation may search one after the other: where each tries all spheres, no
    /// more than one dispatch may loop for.
    pub(super) fn rays_at_once(&self, most: u32) -> u32 {
        let fits = LIST_LEN / self.tests_per_ray.max(1);
        u32::try_from(fits).unwrap_or(u32::MAX).clamp(1, most)
    }

    /// How much of a picture to submit at once.
    pub(super) fn pace(&self) -> Pace {
        *self.pace.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes note of what a submission took. The next picture starts as this one ends, because most pictures
    /// of a scene cost about the same.
    pub(super) fn took(&self, groups: Groups, elapsed: Duration) {
        self.pace.lock().unwrap_or_else(PoisonError::into_inner).took(groups.count(), elapsed);
    }

    pub(super) fn appearance(&self) -> &SceneAppearance {
        &self.summary.appearance
    }

    pub(super) fn space(&self) -> &SceneSpace {
        &self.space
    }

    pub(super) fn structure(&self) -> Structure {
        self.structure
    }

    /// The kinds of the bricks, each once.
    pub(super) fn kinds(&self) -> Vec<BrickKind> {
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
    pub(super) fn bricks(&self) -> &[BrickBuffers] {
        &self.bricks
    }
}

/// What of a brick is copied.
#[derive(Clone, Copy, Debug)]
struct BrickContents<'a> {
    kind: BrickKind,
    center_box: CenterBox,
    /// As the primitive's WGSL part reads them, in the order of the structure.
    shapes: &'a [u8],
    /// Of each.
    ids: &'a [u32],
    index: &'a Index,
}

impl<'a> BrickContents<'a> {
    fn of_spheres(brick: &'a Brick, kind: BrickKind) -> Self {
        let Brick { index, spheres, ids } = brick;
        let shapes = bytemuck::cast_slice(spheres);
        Self { kind, center_box: CenterBox::of(brick), shapes, ids, index }
    }
}

/// No primitive's shape has more bytes.
const LARGEST_SHAPE: usize = 64;

/// A copy in progress.
struct Upload<'a> {
    renderer: &'a Renderer,
    device: &'a Device,
    queue: &'a Queue,
    appearance: &'a SceneAppearance,
    first_place: u32,
    bytes: u64,
}

impl Upload<'_> {
    fn brick(
        &mut self,
        brick: &BrickContents<'_>,
        palette: &Buffer,
    ) -> Result<BrickBuffers, GpuError> {
        let BrickContents { kind, center_box, shapes, ids, index } = *brick;
        let layouts = &self.renderer.layouts;
        let trace_layout = layouts
            .brick
            .iter()
            .find(|(of, _)| *of == kind)
            .map(|(_, layout)| layout)
            .ok_or(GpuError::NoStructure { kind })?;
        let looks = Looks::of(self.appearance, ids);
        let mut record = records::Brick {
            place_count: ids.len() as u32,
            first_place: self.first_place,
            is_first: u32::from(self.first_place == 0),
            last_look: looks.words.len() as u32 - 1,
            color_shift: looks.color_shift,
            color_mask: looks.color_mask,
            material_first: looks.material_first,
            material_mask: looks.material_mask,
            ..bytemuck::Zeroable::zeroed()
        };
        // A binding must not be empty.
        let (no_shape, no_word) = ([0; LARGEST_SHAPE], [0]);
        let shapes = if shapes.is_empty() { &no_shape[..] } else { shapes };
        let ids = if ids.is_empty() { &no_word[..] } else { ids };
        let mut words: Vec<&[u32]> = Vec::new();
        match index {
            Index::List => {}
            Index::Grid(grid) => {
                record.min = grid.min.to_array();
                record.cell_size = grid.cell_size;
                record.cell_counts = grid.cell_counts;
                words.push(&grid.cells);
                words.extend(grid.references.as_deref());
            }
            Index::WideTree(tree) => words.push(bytemuck::cast_slice(tree.nodes())),
            Index::BinaryTree(tree) => words.push(bytemuck::cast_slice(tree.nodes())),
        }
        self.first_place += record.place_count;
        for (what, bytes) in [
            ("the buffer of spheres", shapes.len()),
            ("the buffer of colors", size_of_val(&looks.words[..])),
        ]
        .into_iter()
        .chain(words.iter().map(|words| ("the buffer of the structure", size_of_val(*words))))
        {
            check_storage_size(self.device, what, bytes as u64)?;
        }
        scoped(self.device, || {
            let place_count = record.place_count;
            let record = self.buffer("pinhole brick", BufferUsages::UNIFORM, &[record]);
            let shapes = self.storage("pinhole shapes", shapes);
            let ids = self.storage("pinhole ids", ids);
            let looks = self.storage("pinhole looks", &looks.words);
            let words: Vec<Buffer> =
                words.iter().map(|words| self.storage("pinhole structure", words)).collect();
            let group = |label, layout, buffers: &[&Buffer]| {
                let entries: Vec<_> = (0..)
                    .zip(buffers)
                    .map(|(binding, buffer)| wgpu::BindGroupEntry {
                        binding,
                        resource: buffer.as_entire_binding(),
                    })
                    .collect();
                let descriptor =
                    wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries };
                self.device.create_bind_group(&descriptor)
            };
            let mut traced = vec![&record, &shapes, &ids];
            traced.extend(&words);
            BrickBuffers {
                kind,
                center_box,
                trace_group: group("pinhole brick", trace_layout, &traced),
                surface_group: group(
                    "pinhole surface",
                    layouts.surface_of(kind.primitive),
                    &[&record, &shapes, &looks, palette],
                ),
                ids,
                looks,
                place_count,
            }
        })
    }

    fn storage<T: bytemuck::Pod>(&mut self, label: &'static str, contents: &[T]) -> Buffer {
        self.buffer(label, BufferUsages::STORAGE, contents)
    }

    fn buffer<T: bytemuck::Pod>(
        &mut self,
        label: &'static str,
        usage: BufferUsages,
        contents: &[T],
    ) -> Buffer {
        let contents: &[u8] = bytemuck::cast_slice(contents);
        let size = contents.len() as u64;
        let descriptor = |usage, mapped_at_creation| wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation,
        };
        // Where the device's memory is the host's, contents are written where they stay.
        let is_shared = self.device.features().contains(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS);
        if is_shared {
            let buffer =
                self.device.create_buffer(&descriptor(usage | BufferUsages::MAP_WRITE, true));
            if let Ok(mut target) = buffer.get_mapped_range_mut(..) {
                target.copy_from_slice(contents);
                drop(target);
                buffer.unmap();
                self.bytes += size;
                return buffer;
            }
            // It could not be created, which the error scope around us has noted.
            return buffer;
        }
        let buffer = self.device.create_buffer(&descriptor(usage | BufferUsages::COPY_DST, false));
        self.queue.write_buffer(&buffer, 0, contents);
        self.bytes += contents.len() as u64;
        buffer
    }
}

/// What one storage binding can hold on a device with such limits.
pub(super) fn binding_limit(limits: &wgpu::Limits) -> u64 {
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
pub(super) fn part(buffer: &Buffer, offset: usize, size: usize) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: offset as u64,
        size: NonZeroU64::new(size as u64),
    })
}
