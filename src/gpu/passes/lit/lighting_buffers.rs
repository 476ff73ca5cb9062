//! The light of a picture on the device.

use wgpu::{BindGroup, Buffer, BufferUsages, Device, TextureView};

use super::lighting::LightingData;
use super::passes::LitLayouts;
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::passes::emitter_table;
use crate::gpu::resources::{Make, bind_group, numbered_group, whole};
use crate::light::environment::Environment;

/// The record of a lighting, its tables, emitters and sky.
#[derive(Debug)]
pub(in crate::gpu) struct LightingBuffers {
    record: Buffer,
    tables: Buffer,
    emitters: TextureView,
    /// Bind group of lights and materials.
    pub(in crate::gpu) group: BindGroup,
    /// Bind group of the image of the sky.
    pub(in crate::gpu) sky: Option<BindGroup>,
}

impl LightingBuffers {
    pub(in crate::gpu) async fn new(
        make: Make<'_>,
        layouts: &LitLayouts,
        lighting: &LightingData,
    ) -> Result<Self, GpuError> {
        Self::with(make, layouts, lighting, None).await
    }

    /// Queues other light. Buffers are created only if there are tables of another size; the emitters and the image of
    /// the sky are uploaded if `is_new` says that they may be others.
    pub(in crate::gpu) async fn set(
        &mut self,
        make: Make<'_>,
        layouts: &LitLayouts,
        lighting: &LightingData,
        is_new: bool,
    ) -> Result<(), GpuError> {
        if is_new || self.tables.size() != lighting.table_bytes() {
            let kept = (!is_new).then_some(&*self);
            *self = Self::with(make, layouts, lighting, kept).await?;
        } else {
            let queue = make.queue;
            queue.write_buffer(&self.record, 0, bytemuck::bytes_of(&lighting.parameters));
            queue.write_buffer(&self.tables, 0, bytemuck::cast_slice(&lighting.tables));
        }
        Ok(())
    }

    /// Creates the buffers, with the emitters and the sky that are kept.
    async fn with(
        make: Make<'_>,
        layouts: &LitLayouts,
        lighting: &LightingData,
        kept: Option<&Self>,
    ) -> Result<Self, GpuError> {
        let Make { device, queue } = make;
        check(device, lighting)?;
        scoped(device, || {
            let record = bytemuck::bytes_of(&lighting.parameters);
            let record = make.filled("pinhole lighting", record, BufferUsages::UNIFORM);
            let tables = bytemuck::cast_slice(&lighting.tables);
            let tables = make.filled("pinhole tables", tables, BufferUsages::STORAGE);
            let (emitters, sky) = match kept {
                Some(kept) => (kept.emitters.clone(), kept.sky.clone()),
                None => (
                    emitter_table::upload(device, queue, &lighting.emitters),
                    lighting.sky.as_deref().map(|image| sky_group(make, layouts, image)),
                ),
            };
            let texture = (2, wgpu::BindingResource::TextureView(&emitters));
            let entries = [whole(0, &record), whole(1, &tables), texture];
            let group = bind_group(device, "pinhole lighting", &layouts.lighting, &entries);
            Self { record, tables, emitters, group, sky }
        })
        .await
    }
}

fn sky_group(make: Make<'_>, layouts: &LitLayouts, environment: &Environment) -> BindGroup {
    let texels: Vec<[f32; 4]> =
        environment.texels().iter().map(|[r, g, b]| [*r, *g, *b, 0.0]).collect();
    let shares: Vec<f32> =
        environment.rows().iter().chain(environment.columns()).copied().collect();
    let storage = BufferUsages::STORAGE;
    let texels = make.filled("pinhole sky", bytemuck::cast_slice(&texels), storage);
    let shares = make.filled("pinhole sky shares", bytemuck::cast_slice(&shares), storage);
    let bound = [&texels, &shares].map(Buffer::as_entire_binding);
    numbered_group(make.device, "pinhole sky", &layouts.sky, bound)
}

/// Returns an error if the device has no room for the tables of a lighting.
fn check(device: &Device, lighting: &LightingData) -> Result<(), GpuError> {
    check_storage_size(device, "the tables of lights and materials", lighting.table_bytes())?;
    let (limit_name, limit) = emitter_table::limit(&device.limits());
    let needed = emitter_table::planned(lighting.emitters.len()).map_or(0, |table| table.bytes);
    if needed > limit {
        let what = emitter_table::WHAT;
        return Err(GpuError::Limit { what, needed, limit_name, limit });
    }
    if let Some(environment) = &lighting.sky {
        let bytes = 16 * environment.texels().len() as u64;
        check_storage_size(device, "the image of the sky", bytes)?;
    }
    Ok(())
}
