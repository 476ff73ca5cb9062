//! The structure that a driver builds from boxes for ray queries.

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BufferUsages, CommandEncoder, Device, Features, Tlas};

/// The features that kernels with ray queries need.
pub(crate) const FEATURES: Features = Features::EXPERIMENTAL_RAY_QUERY;

/// The permission that wgpu requires for ray queries.
#[expect(unsafe_code, reason = "whoever opens a device for ray queries is told that they are an experiment")]
pub(crate) fn experiment() -> wgpu::ExperimentalFeatures {
    // SAFETY: `HeadlessOptions::ray_query`, which is off by default, says that a mistake in wgpu or in the driver may do
    // anything. Our kernels use no other experimental feature.
    unsafe { wgpu::ExperimentalFeatures::enabled() }
}

/// The transform that leaves boxes in place: no rotation, and a scale of one.
const IN_PLACE: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// Begins a structure of boxes, each given by its least and its greatest coordinates. The encoder's work completes it.
pub(crate) fn begin(device: &Device, boxes: &[[f32; 6]]) -> (Tlas, CommandEncoder) {
    let buffer = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("pinhole boxes"),
        contents: bytemuck::cast_slice(boxes),
        usage: BufferUsages::BLAS_INPUT,
    });
    let flags = wgpu::AccelerationStructureFlags::PREFER_FAST_TRACE;
    let update_mode = wgpu::AccelerationStructureUpdateMode::Build;
    let size = wgpu::BlasAABBGeometrySizeDescriptor {
        // A brick has fewer than 2²⁸ spheres, which any device allows.
        primitive_count: boxes.len() as u32,
        // One candidate for each box, because each candidate costs the test of a sphere.
        flags: wgpu::AccelerationStructureGeometryFlags::NO_DUPLICATE_ANY_HIT_INVOCATION,
    };
    let label = Some("pinhole ray query");
    let blas = device.create_blas(
        &wgpu::CreateBlasDescriptor { label, flags, update_mode },
        wgpu::BlasGeometrySizeDescriptors::AABBs { descriptors: vec![size.clone()] },
    );
    let mut tlas = device.create_tlas(&wgpu::CreateTlasDescriptor { label, max_instances: 1, flags, update_mode });
    tlas[0] = Some(wgpu::TlasInstance::new(&blas, IN_PLACE, 0, 0xff));
    let geometry = wgpu::BlasAabbGeometry {
        size: &size,
        stride: size_of::<[f32; 6]>() as u64,
        aabb_buffer: &buffer,
        primitive_offset: 0,
    };
    let entry = wgpu::BlasBuildEntry { blas: &blas, geometry: wgpu::BlasGeometries::AabbGeometries(vec![geometry]) };
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    encoder.build_acceleration_structures([&entry], [&tlas]);
    (tlas, encoder)
}
