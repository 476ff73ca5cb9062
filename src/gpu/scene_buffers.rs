//! A scene on a device.

use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use wgpu::{BindGroup, Buffer, Device, Queue};

use super::error::{GpuError, check_storage_size, scoped};
use super::records;
use super::renderer::Renderer;
use crate::scene::Scene;

/// How many spheres one dispatch tries.
///
/// Mesa 22.3's lavapipe leaves all loops of an invocation, silently, after 65,535 iterations. A
/// multiple of 2¹⁴, so that a slice starts at a multiple of any offset alignment.
const SLICE_LEN: usize = 3 << 14;

/// Tells scenes on devices apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SceneId(u64);

impl SceneId {
    fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// A scene in buffers of a device. Per scene: made once, used by any number of frames.
#[derive(Debug)]
pub struct SceneBuffers {
    id: SceneId,
    origin: DVec3,
    sphere_count: u32,
    group: BindGroup,
    slices: Vec<BindGroup>,
}

impl SceneBuffers {
    /// Copies the scene to the device.
    ///
    /// The copy is queued; it is done before anything that is submitted later.
    ///
    /// # Errors
    /// If the spheres do not fit into one binding of the device, or into its memory.
    pub fn new(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        // A binding must not be empty.
        let count = scene.len().max(1);
        check_storage_size(
            device,
            "the buffer of spheres",
            (count * size_of::<records::Sphere>()) as u64,
        )?;
        let mut spheres = scene.spheres();
        let mut colors: Vec<records::Color> =
            (0..scene.len()).map(|id| pad(scene.color(id as u32).to_array())).collect();
        if scene.is_empty() {
            spheres = &[[0.0; 4]];
            colors.push([0.0; 4]);
        }
        let (group, slices) = scoped(device, || {
            let storage = wgpu::BufferUsages::STORAGE;
            let spheres = buffer(device, queue, "pinhole spheres", storage, spheres);
            let colors = buffer(device, queue, "pinhole colors", storage, &colors);
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("pinhole scene"),
                layout: &renderer.layouts.scene,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: spheres.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: colors.as_entire_binding() },
                ],
            });
            (group, slice_groups(renderer, device, queue, &spheres, scene.len()))
        })?;
        Ok(Self {
            id: SceneId::new(),
            origin: scene.origin(),
            sphere_count: scene.len() as u32,
            group,
            slices,
        })
    }

    pub(super) fn id(&self) -> SceneId {
        self.id
    }

    pub(super) fn origin(&self) -> DVec3 {
        self.origin
    }

    pub(super) fn sphere_count(&self) -> u32 {
        self.sphere_count
    }

    /// Group 1 of `shade`.
    pub(super) fn group(&self) -> &BindGroup {
        &self.group
    }

    /// Group 1 of `trace`, one per dispatch, in the order of ids. At least one, so that an empty
    /// scene's rays are marked as misses.
    pub(super) fn slices(&self) -> &[BindGroup] {
        &self.slices
    }
}

fn slice_groups(
    renderer: &Renderer,
    device: &Device,
    queue: &Queue,
    spheres: &Buffer,
    sphere_count: usize,
) -> Vec<BindGroup> {
    let slices: Vec<records::Slice> = (0..sphere_count.max(1))
        .step_by(SLICE_LEN)
        .map(|first| records::Slice {
            first: first as u32,
            count: (sphere_count - first).min(SLICE_LEN) as u32,
        })
        .collect();
    let stride = device.limits().min_uniform_buffer_offset_alignment as usize;
    let mut bytes = vec![0_u8; slices.len() * stride];
    for (target, slice) in bytes.chunks_mut(stride).zip(&slices) {
        target[..size_of::<records::Slice>()].copy_from_slice(bytemuck::bytes_of(slice));
    }
    let uniforms = buffer(device, queue, "pinhole slices", wgpu::BufferUsages::UNIFORM, &bytes);
    let sphere_size = size_of::<records::Sphere>();
    slices
        .iter()
        .enumerate()
        .map(|(index, slice)| {
            let first = slice.first as usize * sphere_size;
            let bytes = slice.count.max(1) as usize * sphere_size;
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("pinhole slice"),
                layout: &renderer.layouts.slice,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: part(&uniforms, index * stride, size_of::<records::Slice>()),
                    },
                    wgpu::BindGroupEntry { binding: 1, resource: part(spheres, first, bytes) },
                ],
            })
        })
        .collect()
}

fn pad([r, g, b]: [f32; 3]) -> records::Color {
    [r, g, b, 0.0]
}

/// Binds a part of a buffer, in bytes.
pub(super) fn part(buffer: &Buffer, offset: usize, size: usize) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: offset as u64,
        size: NonZeroU64::new(size as u64),
    })
}

fn buffer<T: bytemuck::Pod>(
    device: &Device,
    queue: &Queue,
    label: &'static str,
    usage: wgpu::BufferUsages,
    contents: &[T],
) -> Buffer {
    let contents: &[u8] = bytemuck::cast_slice(contents);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: contents.len() as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, contents);
    buffer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::RendererOptions;
    use crate::{LinearRgb, Sphere};

    /// On a device whose bindings hold 1024 bytes: 64 spheres.
    #[test]
    fn too_many_spheres_for_a_binding_are_an_error_before_any_allocation() {
        let required_limits =
            wgpu::Limits { max_storage_buffer_binding_size: 1024, ..wgpu::Limits::default() };
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) = Device::noop(&descriptor);
        let renderer = Renderer::new(&device, &RendererOptions::default()).unwrap();
        let upload = |count| {
            let sphere = Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE);
            let scene = Scene::new(&vec![sphere; count]).unwrap();
            SceneBuffers::new(&renderer, &device, &queue, &scene)
        };
        assert!(upload(64).is_ok());
        assert_eq!(
            upload(65).unwrap_err(),
            GpuError::Limit {
                what: "the buffer of spheres",
                needed: 65 * 16,
                limit_name: "max_storage_buffer_binding_size",
                limit: 1024,
            }
        );
    }
}
