//! The buffers of a brick on a device, and copying bricks to the device.

use std::sync::Arc;

use wgpu::{BindGroup, BindingResource, Buffer, BufferUsages, CommandEncoder, Device, Queue};

use crate::accel::{Brick, BrickBounds, BrickKind, Index};
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::scene::appearance::AppearanceWords;
use crate::gpu::scene::query_structure;
use crate::gpu::shader::records;
use crate::scene::SceneAppearance;

/// Buffers and bind groups of a brick.
#[derive(Debug)]
pub(in crate::gpu) struct BrickBuffers {
    /// Structure and primitive, which determine the kernels.
    pub(in crate::gpu) kind: BrickKind,
    /// The boxes of the shapes, by which bricks are sorted and looked for in pictures.
    pub(in crate::gpu) bounds: BrickBounds,
    /// Bind group 1 of `trace`.
    pub(in crate::gpu) trace_group: BindGroup,
    /// Bind group 1 of `shade`.
    pub(in crate::gpu) surface_group: BindGroup,
    /// Bind group 3 of kernels that search the brick and shade its shapes.
    pub(in crate::gpu) appearance_group: BindGroup,
    /// The id of every sphere, in the order of the structure, and after them words of some structures.
    pub(in crate::gpu) ids: Buffer,
    /// The appearance words of the spheres.
    pub(in crate::gpu) appearances: Buffer,
    pub(in crate::gpu) shape_count: u32,
}

/// The data of a brick that are copied to the device.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct BrickContents<'a> {
    kind: BrickKind,
    bounds: BrickBounds,
    /// The shapes in the order of the structure, in the layout that the primitive's WGSL file reads.
    shapes: &'a [u8],
    /// The id of each shape.
    ids: &'a [u32],
    index: &'a Index,
}

impl<'a> BrickContents<'a> {
    pub(in crate::gpu) fn of_spheres(brick: &'a Brick, ids: &'a [u32], kind: BrickKind) -> Self {
        let Brick { index, spheres, .. } = brick;
        let bounds = BrickBounds::of_spheres(spheres);
        Self { kind, bounds, shapes: bytemuck::cast_slice(spheres), ids, index }
    }
}

/// The whole of each buffer.
fn whole<'a>(buffers: &[&'a Buffer]) -> Vec<BindingResource<'a>> {
    buffers.iter().map(|buffer| buffer.as_entire_binding()).collect()
}

/// Upper bound of the size of a shape in bytes, for every primitive.
const LARGEST_SHAPE: usize = 64;

/// The state of copying the bricks of a scene to a device.
pub(in crate::gpu) struct Upload<'a> {
    pub(in crate::gpu) renderer: &'a Renderer,
    pub(in crate::gpu) device: &'a Device,
    pub(in crate::gpu) queue: &'a Queue,
    pub(in crate::gpu) appearance: Arc<SceneAppearance>,
    pub(in crate::gpu) first_shape: u32,
    pub(in crate::gpu) bytes: u64,
    /// Work that the device has to do before the bricks can be searched.
    pub(in crate::gpu) work: Vec<CommandEncoder>,
}

impl Upload<'_> {
    pub(in crate::gpu) async fn brick(
        &mut self,
        brick: &BrickContents<'_>,
        palette: &Buffer,
    ) -> Result<BrickBuffers, GpuError> {
        let BrickContents { kind, bounds, shapes, ids, index } = *brick;
        let layouts = &self.renderer.layouts;
        let trace_layout = layouts.brick_like(kind)?;
        let appearances = AppearanceWords::of(&self.appearance, ids);
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
        let shapes = if shapes.is_empty() { &no_shape[..] } else { shapes };
        let ids = if ids.is_empty() { &no_word[..] } else { ids };
        // What shares a buffer with the ids, so that a kernel has enough bindings.
        let mut with_ids: Vec<&[u32]> = vec![ids];
        let mut words: Option<&[u32]> = None;
        let mut boxes = None;
        match index {
            Index::List => {}
            Index::Grid(grid) => {
                record.min = grid.min.to_array();
                record.cell_size = grid.cell_size;
                record.cell_counts = grid.cell_counts;
                record.first_reference = record.shape_count + grid.cells.len() as u32;
                with_ids.extend([&grid.cells[..], &grid.references]);
                words = Some(&grid.balls);
            }
            Index::WideTree(tree) => {
                let near = tree.near_rays();
                record.crowd_min = near.min.to_array();
                record.crowd_margin = near.margin;
                record.crowd_max = near.max.to_array();
                words = Some(bytemuck::cast_slice(tree.nodes()));
            }
            Index::RayQuery(own) => boxes = Some(&own[..]),
        }
        self.first_shape += record.shape_count;
        for (what, bytes) in [
            ("the buffer of spheres", shapes.len()),
            ("the buffer of ids", with_ids.iter().map(|words| size_of_val(*words)).sum()),
            ("the buffer of colors", size_of_val(&appearances.words[..])),
        ]
        .into_iter()
        .chain(words.map(|words| ("the buffer of the structure", size_of_val(words))))
        {
            check_storage_size(self.device, what, bytes as u64)?;
        }
        scoped(self.device, || {
            let shape_count = record.shape_count;
            let record = self.buffer("pinhole brick", BufferUsages::UNIFORM, &[record]);
            let shapes = self.storage("pinhole shapes", shapes);
            let ids = self.joined("pinhole ids", BufferUsages::STORAGE, &with_ids);
            let appearances = self.storage("pinhole appearances", &appearances.words);
            let words = words.map(|words| self.storage("pinhole structure", words));
            let query = boxes.map(|boxes| {
                let (query, work) = query_structure::begin(self.device, boxes);
                self.bytes += size_of_val(boxes) as u64;
                self.work.push(work);
                query
            });
            let group = |label, layout, resources: Vec<BindingResource<'_>>| {
                let entries: Vec<_> = (0..)
                    .zip(resources)
                    .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
                    .collect();
                let descriptor =
                    wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries };
                self.device.create_bind_group(&descriptor)
            };
            let mut traced = whole(&[&record, &shapes, &ids]);
            traced.extend(words.iter().map(Buffer::as_entire_binding));
            traced.extend(query.iter().map(wgpu::Tlas::as_binding));
            BrickBuffers {
                kind,
                bounds,
                trace_group: group("pinhole brick", trace_layout, traced),
                surface_group: group(
                    "pinhole surface",
                    layouts.surface_of(kind.primitive),
                    whole(&[&record, &shapes, &appearances, palette]),
                ),
                appearance_group: group(
                    "pinhole appearance",
                    &layouts.appearance,
                    whole(&[&appearances, palette]),
                ),
                ids,
                appearances,
                shape_count,
            }
        })
        .await
    }

    pub(in crate::gpu) fn storage<T: bytemuck::Pod>(
        &mut self,
        label: &'static str,
        contents: &[T],
    ) -> Buffer {
        self.buffer(label, BufferUsages::STORAGE, contents)
    }

    fn buffer<T: bytemuck::Pod>(
        &mut self,
        label: &'static str,
        usage: BufferUsages,
        contents: &[T],
    ) -> Buffer {
        self.joined(label, usage, &[contents])
    }

    /// A buffer of slices, one after another.
    fn joined<T: bytemuck::Pod>(
        &mut self,
        label: &'static str,
        usage: BufferUsages,
        slices: &[&[T]],
    ) -> Buffer {
        let slices: Vec<&[u8]> = slices.iter().map(|slice| bytemuck::cast_slice(slice)).collect();
        let size = slices.iter().map(|slice| slice.len() as u64).sum();
        let mut at = 0;
        let descriptor = |usage, mapped_at_creation| wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation,
        };
        // If device and host share their memory, the contents are written directly to the buffer.
        let is_shared = self.device.features().contains(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS);
        if is_shared {
            let buffer =
                self.device.create_buffer(&descriptor(usage | BufferUsages::MAP_WRITE, true));
            if let Ok(mut target) = buffer.get_mapped_range_mut(..) {
                for slice in slices {
                    target.slice(at..at + slice.len()).copy_from_slice(slice);
                    at += slice.len();
                }
                drop(target);
                buffer.unmap();
                self.bytes += size;
                return buffer;
            }
            // The buffer could not be created, which the enclosing error scope has recorded.
            return buffer;
        }
        let buffer = self.device.create_buffer(&descriptor(usage | BufferUsages::COPY_DST, false));
        for slice in slices {
            self.queue.write_buffer(&buffer, at as u64, slice);
            at += slice.len();
        }
        self.bytes += size;
        buffer
    }
}
