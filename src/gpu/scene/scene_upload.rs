//! Copying the bricks of a scene to a device, one after the other, and their buffers.

use std::sync::Arc;

use glam::Vec3;
use wgpu::{
    BindGroup, BindingResource, Buffer, BufferUsages, CommandEncoder, Device, Queue, TextureFormat, TextureUsages,
    TextureView,
};

use crate::accel::{Accel, AccelPlan, Brick, BrickBounds, BrickKind, Bricks, Index, Primitive, Structure};
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::resources::{Make, extent, numbered_group, texture};
use crate::gpu::scene::appearance::{self, AppearanceWords};
use crate::gpu::scene::query_structure;
use crate::gpu::scene::scene_summary::{SceneSummary, ShapeIds};
use crate::gpu::shader::records;
use crate::gpu::shader::textures::{Searched, TEXELS_PER_ROW, reads_textures};
use crate::scene::{Scene, SceneAppearance};

/// Buffers and bind groups of a brick.
#[derive(Debug)]
pub(crate) struct BrickBuffers {
    /// Structure and primitive, which determine the kernels.
    pub(crate) kind: BrickKind,
    /// The bounds of the shapes, by which bricks are sorted and found in pictures.
    pub(crate) bounds: BrickBounds,
    /// Bind group 1 of `trace`.
    pub(crate) trace_group: BindGroup,
    /// Bind group 1 of `shade`.
    pub(crate) surface_group: BindGroup,
    /// Bind group 3 of kernels that search the brick and shade its shapes.
    pub(crate) appearance_group: BindGroup,
    /// The id of every sphere, in the order of the structure. Some structures append words.
    pub(crate) ids: SearchedData,
    /// The appearance words of the spheres.
    pub(crate) appearances: Buffer,
    pub(crate) shape_count: u32,
    /// The distance of the farthest hit of each tile, if the brick has lists for tiles.
    pub(crate) farthest: Option<Buffer>,
}

/// Data of a brick that kernels search.
#[derive(Debug)]
pub(crate) enum SearchedData {
    Buffer(Buffer),
    Texture(TextureView),
}

impl SearchedData {
    pub(crate) fn binding(&self) -> BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::Texture(view) => BindingResource::TextureView(view),
        }
    }
}

/// The properties that all bricks of a scene have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BrickSpace {
    /// The planned structure. However, grids of some bricks may be nested.
    pub(crate) structure: Structure,
    /// The inflated box of the scene.
    pub(crate) bounds: (Vec3, Vec3),
}

/// The bricks of a scene that are to be copied. Each may be built only when the iterator returns it.
pub(crate) struct BrickSource<I> {
    pub(crate) space: BrickSpace,
    pub(crate) may_split_duplicates: bool,
    pub(crate) bricks: I,
}

impl<'a> From<&'a Accel> for BrickSource<std::slice::Iter<'a, Brick>> {
    fn from(accel: &'a Accel) -> Self {
        let space = BrickSpace { structure: accel.structure(), bounds: accel.bounds() };
        let may_split_duplicates = accel.may_split_duplicates();
        Self { space, may_split_duplicates, bricks: accel.bricks().iter() }
    }
}

impl<'a> From<Bricks<'a>> for BrickSource<Bricks<'a>> {
    fn from(bricks: Bricks<'a>) -> Self {
        let space = BrickSpace { structure: bricks.structure(), bounds: bricks.bounds() };
        Self { space, may_split_duplicates: bricks.may_split_duplicates(), bricks }
    }
}

/// The planned bricks of a scene's shapes.
pub(crate) fn bricks_of<'a>(plan: &'a AccelPlan, scene: &'a Scene) -> Bricks<'a> {
    plan.bricks(scene.spheres()).with_cones(scene.cones())
}

/// The bricks of a scene on a device.
#[derive(Debug)]
pub(crate) struct UploadedBricks {
    /// The structure is that of the bricks.
    pub(crate) space: BrickSpace,
    pub(crate) bricks: Vec<BrickBuffers>,
    pub(crate) bytes: u64,
}

/// The state of copying the bricks of a scene to a device.
pub(crate) struct SceneUpload<'a> {
    renderer: &'a Renderer,
    device: &'a Device,
    queue: &'a Queue,
    appearance: Arc<SceneAppearance>,
    ids: &'a ShapeIds,
    palette: Buffer,
    first_shape: u32,
    uploaded: UploadedBricks,
    /// Work that the device has to do before the bricks can be searched.
    work: Vec<CommandEncoder>,
}

/// Size in bytes that no shape of any primitive exceeds.
const LARGEST_SHAPE: usize = 64;

impl<'a> SceneUpload<'a> {
    pub(crate) async fn new(
        renderer: &'a Renderer,
        device: &'a Device,
        queue: &'a Queue,
        summary: &SceneSummary,
        space: BrickSpace,
        ids: &'a ShapeIds,
    ) -> Result<Self, GpuError> {
        let palette = appearance::palette(&summary.appearance);
        let palette = [bytemuck::cast_slice(&palette)];
        check_storage_size(device, "the palette", palette[0].len() as u64)?;
        let mut bytes = 0;
        let palette = scoped(device, || {
            let usage = BufferUsages::STORAGE;
            joined((device, queue), &mut bytes, "pinhole palette", usage, &palette)
        });
        Ok(Self {
            renderer,
            device,
            queue,
            appearance: Arc::clone(&summary.appearance),
            ids,
            palette: palette.await?,
            first_shape: 0,
            uploaded: UploadedBricks { space, bricks: Vec::new(), bytes },
            work: Vec::new(),
        })
    }

    /// The state in which the shapes of earlier bricks have been counted.
    pub(crate) fn after(self, shapes: u32) -> Self {
        Self { first_shape: shapes, ..self }
    }

    /// Queues the copy of a brick. The brick can be dropped afterwards.
    pub(crate) async fn brick(&mut self, brick: &Brick) -> Result<(), GpuError> {
        let (renderer, device, queue) = (self.renderer, self.device, self.queue);
        let Self { palette, uploaded, .. } = self;
        let ids = self.ids.of(&brick.ids);
        let kind = brick.kind();
        let layouts = &renderer.layouts;
        let trace_layout = layouts.brick_like(kind)?;
        let appearances = AppearanceWords::of(&self.appearance, &ids);
        let mut record = records::Brick {
            shape_count: ids.len() as u32,
            first_shape: self.first_shape,
            is_first: u32::from(self.first_shape == 0),
            last_appearance: appearances.words.len() as u32 - 1,
            color_shift: appearances.color_shift,
            color_mask: appearances.color_mask,
            material_first: appearances.material_first,
            material_mask: appearances.material_mask,
            ..bytemuck::Zeroable::zeroed()
        };
        // A buffer binding must not be empty.
        let (no_shape, no_word) = ([0; LARGEST_SHAPE], [0]);
        let shapes = match brick.primitive {
            Primitive::Sphere => bytemuck::cast_slice(&brick.spheres),
            Primitive::Cone => bytemuck::cast_slice(&brick.cones),
        };
        let shapes = if shapes.is_empty() { &no_shape[..] } else { shapes };
        let ids = if ids.is_empty() { &no_word[..] } else { &ids };
        // Data that share a buffer with the ids, so that a kernel has enough bindings.
        let mut with_ids: Vec<&[u8]> = vec![bytemuck::cast_slice(ids)];
        let mut words: Option<&[u8]> = None;
        let (mut boxes, mut tiles) = (None, None);
        match &brick.index {
            Index::List => {}
            Index::Tiles(lists) => {
                record.first_reference = record.shape_count;
                let first_place = record.shape_count + lists.starts.len() as u32;
                record.cell_counts = [lists.columns, first_place, first_place + lists.places.len() as u32];
                with_ids.extend([&lists.starts, &lists.places].map(|of| bytemuck::cast_slice(of)));
                with_ids.push(bytemuck::cast_slice(&lists.nears));
                tiles = Some(lists);
            }
            Index::Grid(grid) => {
                record.min = grid.min.to_array();
                record.cell_size = grid.cell_size;
                record.cell_counts = grid.cell_counts;
                record.first_reference = record.shape_count + grid.cells.len() as u32;
                with_ids.extend([&grid.cells, &grid.references].map(|of| bytemuck::cast_slice(of)));
                words = Some(bytemuck::cast_slice(&grid.balls));
            }
            Index::WideTree(tree) => {
                // Without a crowd (a box around most spheres), no margin is too small for any ray.
                record.crowd_margin = 1e30;
                if let Some(crowd) = &tree.margins.crowd {
                    record.crowd_min = crowd.min.to_array();
                    record.crowd_margin = crowd.margin();
                    record.crowd_max = crowd.max.to_array();
                }
                words = Some(bytemuck::cast_slice(&tree.nodes));
            }
            Index::RayQuery(own) => boxes = Some(&own[..]),
        }
        let appearances = bytemuck::cast_slice(&appearances.words);
        let all_ids = with_ids.iter().map(|of| of.len()).sum();
        self.first_shape += record.shape_count;
        for (what, bytes) in [
            ("the buffer of shapes", shapes.len()),
            ("the buffer of ids", all_ids),
            ("the buffer of colors", appearances.len()),
        ]
        .into_iter()
        .chain(words.map(|words| ("the buffer of the structure", words.len())))
        {
            check_storage_size(device, what, bytes as u64)?;
        }
        let surface_layout = layouts.surface_of(kind.primitive);
        let buffers = scoped(device, || {
            let mut filled =
                |label, usage, slices: &[&[u8]]| joined((device, queue), &mut uploaded.bytes, label, usage, slices);
            let storage = BufferUsages::STORAGE;
            let uniform = BufferUsages::UNIFORM;
            let shape_count = record.shape_count;
            let record = filled("pinhole brick", uniform, &[bytemuck::bytes_of(&record)]);
            let appearances = filled("pinhole appearances", storage, &[appearances]);
            let shapes = filled("pinhole shapes", storage, &[shapes]);
            let mut searched = |label, searched: Searched, slices: &[&[u8]]| match reads_textures(device) {
                true => {
                    uploaded.bytes += slices.iter().map(|slice| slice.len() as u64).sum::<u64>();
                    SearchedData::Texture(list_texture(Make { device, queue }, label, searched.format(), slices))
                }
                false => SearchedData::Buffer(joined((device, queue), &mut uploaded.bytes, label, storage, slices)),
            };
            let ids = searched("pinhole ids", Searched::Ids, &with_ids);
            let words = words.map(|words| searched("pinhole structure", Searched::Words, &[words]));
            let query = boxes.map(|boxes| {
                let (query, work) = query_structure::begin(device, boxes);
                uploaded.bytes += size_of_val(boxes) as u64;
                self.work.push(work);
                query
            });
            let farthest = tiles.map(|lists| {
                let tiles = lists.starts.len().max(2) as u64 - 1;
                Make { device, queue }.buffer("pinhole tiles", 4 * tiles, storage | BufferUsages::COPY_SRC)
            });
            let of_structure = words.as_ref().map(SearchedData::binding);
            let of_structure = of_structure.or(query.as_ref().map(wgpu::Tlas::as_binding));
            let of_structure = of_structure.or(farthest.as_ref().map(Buffer::as_entire_binding));
            let traced = [record.as_entire_binding(), shapes.as_entire_binding(), ids.binding()];
            let traced = traced.into_iter().chain(of_structure);
            let group = |label, layout, buffers: &[&Buffer]| {
                numbered_group(device, label, layout, buffers.iter().map(|buffer| buffer.as_entire_binding()))
            };
            let shaded = [&record, &shapes, &appearances, palette];

            let seen = [&appearances, palette];
            BrickBuffers {
                kind,
                bounds: match tiles {
                    // All spheres of a picture are seen in it.
                    Some(_) => BrickBounds::of_box(uploaded.space.bounds),
                    None => BrickBounds::of_brick(brick),
                },
                trace_group: numbered_group(device, "pinhole brick", trace_layout, traced),
                surface_group: group("pinhole surface", surface_layout, &shaded),
                appearance_group: group("pinhole appearance", &layouts.appearance, &seen),
                ids,
                appearances,
                shape_count,
                farthest,
            }
        });
        let buffers = buffers.await?;
        self.uploaded.bricks.push(buffers);
        Ok(())
    }

    /// Returns the work since the last call that has to be submitted before the bricks are searched.
    pub(crate) fn take_work(&mut self) -> Vec<CommandEncoder> {
        std::mem::take(&mut self.work)
    }

    /// Returns the bricks since the last call. Each keeps its own structure.
    pub(crate) fn take_bricks(&mut self) -> Vec<BrickBuffers> {
        std::mem::take(&mut self.uploaded.bricks)
    }

    /// Returns the bricks. If any of them is a nested grid, all grids of these shapes are searched as nested grids.
    pub(crate) fn finish(self) -> Result<UploadedBricks, GpuError> {
        let UploadedBricks { mut space, mut bricks, bytes } = self.uploaded;
        let kinds: Vec<BrickKind> = bricks.iter().map(|brick| brick.kind).collect();
        let of_spheres = BrickKind { structure: space.structure, primitive: Primitive::Sphere };
        space.structure = of_spheres.among(&kinds).structure;
        for brick in &mut bricks {
            brick.kind = brick.kind.among(&kinds);
            self.renderer.layouts.brick_of(brick.kind)?;
        }
        Ok(UploadedBricks { space, bricks, bytes })
    }
}

/// Creates a buffer that contains slices one after another, and adds its size to `bytes`.
fn joined(
    (device, queue): (&Device, &Queue),
    bytes: &mut u64,
    label: &'static str,
    usage: BufferUsages,
    slices: &[&[u8]],
) -> Buffer {
    let size = slices.iter().map(|slice| slice.len() as u64).sum();
    *bytes += size;
    // If device and host share their memory, the contents are written directly to the buffer.
    let is_shared = device.features().contains(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS);
    let written = if is_shared { BufferUsages::MAP_WRITE } else { BufferUsages::COPY_DST };
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | written,
        mapped_at_creation: is_shared,
    });
    let starts = slices.iter().scan(0, |end, slice| {
        *end += slice.len();
        Some(*end - slice.len())
    });
    if !is_shared {
        for (start, slice) in starts.zip(slices) {
            queue.write_buffer(&buffer, start as u64, slice);
        }
    } else if let Ok(mut target) = buffer.get_mapped_range_mut(..) {
        // If the buffer could not be created, the enclosing error scope has recorded it.
        for (start, slice) in starts.zip(slices) {
            target.slice(start..start + slice.len()).copy_from_slice(slice);
        }
        drop(target);
        buffer.unmap();
    }
    buffer
}

/// Creates a texture whose texels are the elements of slices one after another, row by row.
fn list_texture(make: Make<'_>, label: &'static str, format: TextureFormat, slices: &[&[u8]]) -> TextureView {
    let bytes_per_texel = format.block_copy_size(None).unwrap_or(1) as usize;
    let count: usize = slices.iter().map(|slice| slice.len() / bytes_per_texel).sum();
    let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST;
    let size = [count.min(TEXELS_PER_ROW), count.div_ceil(TEXELS_PER_ROW)].map(|side| side as u32);
    let texture = texture(make.device, label, format, size, usage);
    let mut at = 0;
    for slice in slices {
        let mut rest = *slice;
        while !rest.is_empty() {
            // The rest of a row, or all whole rows.
            let (x, left) = (at % TEXELS_PER_ROW, rest.len() / bytes_per_texel);
            let rows = if x == 0 { (left / TEXELS_PER_ROW).max(1) } else { 1 };
            let width = left.min(TEXELS_PER_ROW - x);
            let (piece, after) = rest.split_at(rows * width * bytes_per_texel);
            let mut target = texture.as_image_copy();
            (target.origin.x, target.origin.y) = (x as u32, (at / TEXELS_PER_ROW) as u32);
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((width * bytes_per_texel) as u32),
                rows_per_image: None,
            };
            make.queue.write_texture(target, piece, layout, extent([width as u32, rows as u32]));
            (at, rest) = (at + rows * width, after);
        }
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
