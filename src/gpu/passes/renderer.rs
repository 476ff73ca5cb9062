//! The pipelines of primary rays.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use wgpu::{BindGroupLayout, ComputePipeline, Device};

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::checks::Checks;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::scene::query_structure;
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::layouts::Layouts;
use crate::gpu::shader::{self, BrickPass, Kernel, pipeline};

/// The pipelines of primary rays for a device and a kind of target. All scenes and frames can share one renderer.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) layouts: Layouts,
    pub(crate) color: ColorTarget,
    pub(crate) data_layers: bool,
    pub(crate) keeps_rays: bool,
    pub(crate) several_bricks: bool,
    pub(crate) is_indirect: bool,
    pub(crate) shape: DeviceShape,
    pub(crate) edits: Edits,
    /// Pipelines that can be recorded.
    built: Vec<(PassKey, ComputePipeline)>,
    /// Pipelines that the device has not yet accepted, with their checks. The mutex makes a
    /// renderer `Sync`, and is never locked.
    building: Mutex<VecDeque<(PassKey, ComputePipeline, Checks)>>,
    /// Pipelines that are not ready: first pipelines that are being built, then pipelines whose building has not begun.
    remaining: VecDeque<PassKey>,
    /// The checks of the layouts.
    layouts_check: Mutex<Checks>,
    /// The error that ended the building.
    failed: Option<GpuError>,
}

/// The purpose of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PassKey {
    Trace(CameraKind, BrickKind, BrickPass),
    Shade(CameraKind, Primitive),
}

impl Renderer {
    /// Builds the pipelines on a device that the caller owns. This takes from milliseconds to seconds. It can run on
    /// another thread, or in pieces with [`Renderer::begin`].
    ///
    /// # Errors
    /// If the device rejects a kernel, which is a defect of this crate or of the driver.
    pub async fn new(device: &Device, options: &RendererOptions) -> Result<Self, GpuError> {
        let needs_queries = options.structures.contains(&Structure::RayQuery);
        if needs_queries && !device.features().contains(query_structure::FEATURES) {
            return Err(GpuError::NoRayQuery);
        }
        let mut renderer = Self::begin(device, options);
        // A browser builds pipelines at the same time, so all are begun before the first is awaited.
        while renderer.begin_next(device)? {}
        std::mem::take(renderer.layouts_check.get_mut().unwrap_or_else(PoisonError::into_inner)).passed().await?;
        let building = std::mem::take(renderer.in_building());
        for (key, pipeline, checks) in building {
            checks.passed().await?;
            renderer.built.push((key, pipeline));
        }
        renderer.remaining.clear();
        Ok(renderer)
    }

    /// Begins a renderer without building any pipeline. [`Renderer::build_next`] builds them one by one.
    ///
    /// Scenes can be uploaded and frames made with it at once. Until the pipelines of a frame are built,
    /// [`Renderer::record`] records nothing and returns [`GpuError::NotReady`].
    #[must_use]
    pub fn begin(device: &Device, options: &RendererOptions) -> Self {
        let RendererOptions { color, data_layers, keeps_rays, .. } = *options;
        let device_type = options.device_type.unwrap_or(device.adapter_info().device_type);
        let checks = Checks::default();
        let layouts = checks.create(device, || Layouts::new(device, options));
        let mut remaining = VecDeque::new();
        for &camera in &options.cameras {
            // Bricks of spheres are traced before those of cones.
            let is_first = |kind: &BrickKind| options.primitives().next() == Some(kind.primitive);
            let first = options.kinds().filter(is_first).map(|of| PassKey::Trace(camera, of, BrickPass::First));
            remaining.extend(first);
            remaining.extend(options.primitives().map(|of| PassKey::Shade(camera, of)));
            let later = options.kinds().filter(|of| options.several_bricks || !is_first(of));
            remaining.extend(later.map(|of| PassKey::Trace(camera, of, BrickPass::Later)));
        }
        Self {
            layouts,
            color,
            data_layers,
            keeps_rays,
            several_bricks: options.several_bricks,
            is_indirect: options.indirect,
            shape: DeviceShape::of(device_type),
            edits: Edits { replacements: options.edits.clone(), rewrite: options.rewrite.clone() },
            built: Vec::new(),
            building: Mutex::new(VecDeque::new()),
            remaining,
            layouts_check: Mutex::new(checks),
            failed: None,
        }
    }

    /// Builds one more pipeline, and returns the number of pipelines that are still not ready. The
    /// renderer is complete when this number is 0.
    ///
    /// It never waits. On a native device the call takes as long as the driver needs for one pipeline. A browser builds
    /// in the background, so there the number may stay the same for some calls.
    ///
    /// # Errors
    /// If the device rejects a kernel, which is a defect of this crate or of the driver. All later calls return the
    /// same error.
    pub fn build_next(&mut self, device: &Device) -> Result<usize, GpuError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let progress = self.begin_next(device).and_then(|_| self.take_built());
        progress.map(|()| self.remaining.len()).inspect_err(|error| {
            self.failed = Some(error.clone());
        })
    }

    /// Begins to build the next pipeline. Returns whether there was one.
    fn begin_next(&mut self, device: &Device) -> Result<bool, GpuError> {
        let begun = self.in_building().len();
        let Some(key) = self.remaining.get(begun).copied() else {
            return Ok(false);
        };
        let kernel = self.kernel(key).edited(&self.edits)?;
        let checks = Checks::default();
        let pipeline = pipeline(device, &kernel, &self.groups(key)?, &checks);
        self.in_building().push_back((key, pipeline, checks));
        Ok(true)
    }

    /// Moves the pipelines that the device has accepted to the pipelines that can be recorded.
    fn take_built(&mut self) -> Result<(), GpuError> {
        let layouts = self.layouts_check.get_mut().unwrap_or_else(PoisonError::into_inner);
        if !layouts.are_known()? {
            return Ok(());
        }
        while let Some((_, _, checks)) = self.in_building().front_mut() {
            if !checks.are_known()? {
                break;
            }
            if let Some((key, pipeline, _)) = self.in_building().pop_front() {
                self.built.push((key, pipeline));
                self.remaining.pop_front();
            }
        }
        Ok(())
    }

    fn in_building(&mut self) -> &mut VecDeque<(PassKey, ComputePipeline, Checks)> {
        self.building.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether some pipelines of a camera continue tracing from hits that another pass has written.
    pub(crate) fn continues_hits(&self, camera: CameraKind) -> bool {
        let built = self.built.iter().map(|(key, _)| key);
        let mut keys = built.chain(&self.remaining);
        // Rays are kept only by the pass of the first brick.
        !self.keeps_rays && keys.any(|key| matches!(key, PassKey::Trace(of, _, BrickPass::Later) if *of == camera))
    }

    /// Moves some pipelines to the front of the remaining ones, and returns how many of them are not ready.
    pub(crate) fn put_first(&mut self, needed: &[PassKey]) -> usize {
        // Pipelines that are being built keep their places.
        let begun = self.in_building().len();
        let (first, others): (Vec<_>, Vec<_>) = self.remaining.drain(begun..).partition(|key| needed.contains(key));
        self.remaining.extend(first.into_iter().chain(others));
        self.remaining.iter().filter(|key| needed.contains(key)).count()
    }

    fn kernel(&self, key: PassKey) -> Kernel {
        match key {
            PassKey::Shade(camera, primitive) => {
                shader::shade_kernel(camera, primitive, self.color, self.data_layers, self.keeps_rays)
            }
            PassKey::Trace(camera, kind, brick_pass) => shader::trace_kernel(camera, kind, brick_pass, self.keeps_rays),
        }
    }

    /// The layouts of the bind groups of a pipeline.
    fn groups(&self, key: PassKey) -> Result<Vec<&BindGroupLayout>, GpuError> {
        let Layouts { frame, targets, .. } = &self.layouts;
        Ok(match key {
            PassKey::Shade(_, primitive) => {
                vec![frame, self.layouts.surface_of(primitive), targets]
            }
            PassKey::Trace(_, kind, _) => vec![frame, self.layouts.brick_of(kind)?],
        })
    }

    /// The pipeline for a purpose, and for a brick of a kind.
    pub(crate) fn pipeline(&self, key: PassKey, kind: BrickKind) -> Result<&ComputePipeline, GpuError> {
        let (PassKey::Trace(camera, ..) | PassKey::Shade(camera, _)) = key;
        match self.built.iter().find(|(of, _)| *of == key) {
            Some((_, pipeline)) => Ok(pipeline),
            None if self.remaining.contains(&key) => Err(GpuError::NotReady { remaining: self.remaining.len() }),
            None => Err(GpuError::NoPipeline { camera, kind }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::headless::waiting::Wait;

    /// wgpu checks shaders, layouts, access modes and record sizes without any driver.
    #[test]
    fn every_pipeline_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffer_binding_size, 128 << 20);
        for &color in ColorTarget::ALL {
            for (data_layers, keeps_rays) in [(false, false), (true, true), (true, false)] {
                let options = RendererOptions {
                    color,
                    data_layers,
                    structures: Structure::ALL.to_vec(),
                    cone_structures: Structure::ALL.to_vec(),
                    keeps_rays,
                    ..RendererOptions::default()
                };
                let renderer = Renderer::new(&device, &options).wait().unwrap();
                let of_shading = |(key, _): &&_| matches!(key, PassKey::Shade(..));
                let shading = renderer.built.iter().filter(of_shading).count();
                assert_eq!(shading, CameraKind::ALL.len() * Primitive::ALL.len());
            }
        }
    }

    /// Errors in a shader name file and line, whether the parser or the validation finds them.
    #[test]
    fn a_refused_kernel_is_an_error_that_names_the_part() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let structures = vec![Structure::List];
        let layouts = Layouts::new(&device, &RendererOptions { structures, ..RendererOptions::default() });
        for broken in ["fn broken() -> f32 {\n    let x = 1.0;\n}\n", "\nfn broken() -> none {}\n"] {
            let kernel = shader::trace_kernel(CameraKind::Pinhole, layouts.brick[0].0, BrickPass::First, false)
                .with_part("broken.wgsl", broken);
            let checks = Checks::default();
            pipeline(&device, &kernel, &[&layouts.frame, &layouts.brick[0].1], &checks);
            match checks.passed().wait() {
                Err(GpuError::Device { message }) => {
                    assert!(message.contains("broken.wgsl:"), "{message}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
}
