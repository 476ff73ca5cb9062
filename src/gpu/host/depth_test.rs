//! Ends primary rays at the depth of a host, so that hidden spheres are neither searched nor shaded.

use wgpu::{BindGroup, BindGroupLayout, Buffer, ComputePass, ComputePipeline, Device, Queue};

use crate::camera::{CameraKind, HostCamera};
use crate::gpu::checks::{Checks, scoped};
use crate::gpu::error::GpuError;
use crate::gpu::host::host_view::HostView;
use crate::gpu::passes::frame::{BandBrick, Frame, Slot};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::resources::numbered_group;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::layouts::{layout, uniform};
use crate::gpu::shader::{Kernel, camera_constant, pipeline};

/// The passes that end rays at the depth of a host, and remove hits behind it. One is enough for a renderer.
#[derive(Debug)]
pub struct DepthTest {
    layout: BindGroupLayout,
    /// The pipelines that end rays, for the cameras of the renderer.
    limit: Vec<(CameraKind, ComputePipeline)>,
    hide: ComputePipeline,
}

/// The kinds of camera that a host has.
pub(crate) const LIMITED: [CameraKind; 2] = [CameraKind::Pinhole, CameraKind::Orthographic];

/// A depth texture of the host, and the camera that it was rendered with.
#[derive(Debug)]
pub struct HostDepth {
    group: BindGroup,
    view: Buffer,
    texture_size: [u32; 2],
    /// The size of the pictures, once the camera is set.
    size: Option<[u32; 2]>,
}

/// The kernel that ends rays, for a kind of camera.
pub(crate) fn limit_kernel(camera: CameraKind) -> Kernel {
    Kernel::new("limit", &[]).with([camera_constant(camera)])
}

/// The kernel that removes hits.
pub(crate) fn hide_kernel() -> Kernel {
    Kernel::new("hide", &[])
}

impl DepthTest {
    /// Builds the pipelines for the frames of a renderer.
    ///
    /// # Errors
    /// If the device rejects a kernel, which is a defect of this crate or of the driver.
    pub async fn new(renderer: &Renderer, device: &Device) -> Result<Self, GpuError> {
        let depth = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let checks = Checks::default();
        let kinds = [uniform::<HostView>(), depth];
        let layout = checks.create(device, || layout(device, "pinhole host depth", &kinds));
        let groups = [&renderer.layouts.frame, &layout];
        let create = |kernel: Kernel| -> Result<ComputePipeline, GpuError> {
            Ok(pipeline(device, &kernel.edited(&renderer.edits)?, &groups, &checks))
        };
        let limit = LIMITED
            .into_iter()
            .filter(|camera| renderer.continues_hits(*camera))
            .map(|camera| Ok((camera, create(limit_kernel(camera))?)))
            .collect::<Result<_, GpuError>>()?;
        let hide = create(hide_kernel())?;
        checks.passed().await?;
        Ok(Self { layout, limit, hide })
    }

    /// The pipeline that ends the rays of a camera, if the renderer can trace shortened rays.
    fn limit(&self, renderer: &Renderer, camera: CameraKind) -> Option<&ComputePipeline> {
        let found = self.limit.iter().find(|(of, _)| *of == camera);
        found.filter(|_| renderer.continues_hits(camera)).map(|(_, pipeline)| pipeline)
    }

    /// Records a pass over the pixels of a band in which the scene may be visible.
    fn record(pipeline: &ComputePipeline, pass: &mut ComputePass<'_>, frame: &Frame, band: usize, depth: &HostDepth) {
        let slot = Slot::of_scene(band);
        let groups = frame.traced_groups(slot);
        if groups.count() == 0 {
            return;
        }
        let [width, height] = groups.size;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame.group(slot), &[]);
        pass.set_bind_group(1, &depth.group, &[]);
        pass.dispatch_workgroups(width, height, 1);
    }
}

impl HostDepth {
    /// A depth texture with one sample for each pixel, of any depth format, and the usage `TEXTURE_BINDING`. The view
    /// must show the depth aspect alone.
    ///
    /// # Errors
    /// If the texture does not meet these conditions.
    pub async fn new(test: &DepthTest, device: &Device, texture: &wgpu::TextureView) -> Result<Self, GpuError> {
        let (view, group) = scoped(device, || {
            let view = HostView::buffer(device, &HostView::without_camera([0, 0], [0, 0]));
            let bound = [view.as_entire_binding(), wgpu::BindingResource::TextureView(texture)];
            let group = numbered_group(device, "pinhole host depth", &test.layout, bound);
            (view, group)
        })
        .await?;
        let texture = texture.texture();
        let texture_size = [texture.width(), texture.height()];
        Ok(Self { group, view, texture_size, size: None })
    }

    /// Sets the camera that the depth was rendered with, and that the frame has, on a film with y up, and the pixel of
    /// the depth texture at the top left pixel of the frame.
    ///
    /// The values are queued on `queue` and take effect with its next submission.
    ///
    /// # Errors
    /// If the frame does not lie within the depth texture.
    pub fn set_camera(
        &mut self,
        queue: &Queue,
        camera: &HostCamera,
        frame: &Frame,
        first_pixel: [u32; 2],
    ) -> Result<(), GpuError> {
        let size = frame.size();
        if (0..2).any(|axis| u64::from(first_pixel[axis]) + u64::from(size[axis]) > self.texture_size[axis].into()) {
            let [width, height] = self.texture_size;
            return Err(GpuError::Target {
                layer: "host's depth",
                found: format!("{width}x{height}"),
                expected: format!("large enough for {}x{} pixels from pixel {first_pixel:?} on", size[0], size[1]),
            });
        }
        let view = HostView::new(camera, size, first_pixel);
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        self.size = Some(size);
        Ok(())
    }
}

/// The part, traced with the kernel that continues from existing hits.
fn continued(part: BandBrick) -> BandBrick {
    BandBrick { is_first_of_band: false, ..part }
}

impl Renderer {
    /// Records the frame's view of the scene like [`Renderer::record`], except that hits behind the host's depth become
    /// misses before they are shaded: they have the background's colour, and neither depth nor id. A hit at the very
    /// depth of the host stays.
    ///
    /// Rays end a little behind the host's depth, so hidden spheres take little time. This needs the pipelines of
    /// `several_bricks`. Without them, or with `keeps_rays`, rays are traced to their ends with the same picture.
    ///
    /// The comparison is a depth test between depths that are computed in f32. It may be wrong only where the two
    /// differ by less than rounding, a few units of 2⁻²⁴ of the numbers that are subtracted.
    ///
    /// # Errors
    /// The errors of [`Renderer::record`]; [`GpuError::NoView`] if the depth has no camera yet, or that of a frame of
    /// another size.
    pub fn record_with_depth(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneBuffers,
        frame: &Frame,
        test: &DepthTest,
        depth: &HostDepth,
    ) -> Result<(), GpuError> {
        if depth.size != Some(frame.size()) {
            return Err(GpuError::NoView);
        }
        let limit = test.limit(self, frame.view(self, scene)?.camera);
        let traced = |part| if limit.is_some() { continued(part) } else { part };
        self.check_pipelines(scene, frame, traced)?;
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("pinhole"), timestamp_writes: None });
        for part in frame.parts() {
            if let Some(limit) = limit.filter(|_| part.is_first_of_band) {
                DepthTest::record(limit, &mut pass, frame, part.band, depth);
            }
            self.record_trace(&mut pass, scene, frame, traced(part))?;
            if part.is_last_of_band {
                DepthTest::record(&test.hide, &mut pass, frame, part.band, depth);
                self.record_shade(&mut pass, scene, frame, part.band)?;
            }
        }
        Ok(())
    }
}
