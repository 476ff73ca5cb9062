//! The blocking forms of everything that waits. Browsers cannot block, so they do not exist for `wasm32`.

#![expect(clippy::missing_errors_doc, reason = "the errors are those of the async forms")]

use wgpu::{Adapter, CommandEncoder, Device, Queue};

use crate::accel::{Accel, AccelChoice};
use crate::camera::View;
use crate::gpu::edit::{Edits, ShaderEdit};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_recording::{EachSample, LitPart};
use crate::gpu::headless::measure::TraceTime;
use crate::gpu::headless::plan::{RenderPlan, StructurePlans};
use crate::gpu::headless::progress::{Picture, UploadWatch, Watch};
use crate::gpu::headless::waiting::block_on;
use crate::gpu::host::composite::{Composite, CompositeOptions, CompositePicture};
use crate::gpu::host::depth_test::{DepthTest, HostDepth};
use crate::gpu::host::lit_picture::LitPicture;
use crate::gpu::host::lit_renderer::LitRenderer;
use crate::gpu::host::live_picture::LivePicture;
use crate::gpu::host::pick::Picker;
use crate::gpu::options::HeadlessOptions;
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::passes::targets::{TargetTextures, Targets};
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::structures::{Retry, Structures, with_retries_async};
use crate::gpu::self_test::{SelfTestExtent, SelfTestReport};
use crate::image::{Image, LayerSet};
use crate::render::{Nearest, RenderSettings};
use crate::scene::{Scene, SceneUpdate};
use crate::verify::{Certificate, Recording};

/// Blocks the thread until [`with_retries_async`] is done.
pub fn with_retries<T, E>(
    choice: AccelChoice,
    plan: impl Fn(AccelChoice) -> RenderPlan,
    retrying: impl FnMut(Retry),
    mut work: impl FnMut(&RenderPlan) -> Result<Result<T, GpuError>, E>,
) -> Result<Result<T, GpuError>, E> {
    block_on(with_retries_async(choice, plan, retrying, async |plan: &RenderPlan| work(plan)))
}

/// Builds the pipeline like [`Composite::new`], but with edited shaders.
pub fn edited_composite(
    device: &Device,
    options: &CompositeOptions,
    edits: Vec<ShaderEdit>,
) -> Result<Composite, GpuError> {
    let edits = Edits { replacements: edits, ..Edits::default() };
    block_on(Composite::edited(device, options, &edits))
}

impl Headless {
    /// Blocks the thread until [`Headless::open_async`] is done.
    pub fn open(options: &HeadlessOptions) -> Result<Self, GpuError> {
        block_on(Self::open_async(options))
    }

    /// Blocks the thread until [`Headless::self_test_async`] is done.
    pub fn self_test(&self, extent: SelfTestExtent) -> Result<SelfTestReport, GpuError> {
        block_on(self.self_test_async(extent))
    }

    /// Blocks the thread until [`Headless::upload_async`] is done.
    pub fn upload(&self, scene: &Scene, structures: &Structures) -> Result<SceneBuffers, GpuError> {
        block_on(self.upload_async(scene, structures))
    }

    /// Blocks the thread until [`Headless::upload_planned_async`] is done.
    pub fn upload_planned(
        &self,
        scene: &Scene,
        plans: &StructurePlans,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        block_on(self.upload_planned_async(scene, plans, watch))
    }

    /// Blocks the thread until [`Headless::render_async`] is done.
    pub fn render(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        block_on(self.render_async(scene, view, settings, layers))
    }

    /// Blocks the thread until [`Headless::render_planned_async`] is done.
    pub fn render_planned(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watches: (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Picture, GpuError> {
        block_on(self.render_planned_async(scene, plan, view, settings, layers, watches))
    }

    /// Blocks the thread until [`Headless::render_nearest_async`] is done.
    pub fn render_nearest(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watches: (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Nearest, GpuError> {
        block_on(self.render_nearest_async(scene, plan, view, settings, layers, watches))
    }

    /// Blocks the thread until [`Headless::finish_async`] is done.
    pub fn finish(
        &self,
        image: Image,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        block_on(self.finish_async(image, settings, layers))
    }

    /// Blocks the thread until [`Headless::render_uploaded_async`] is done.
    pub fn render_uploaded(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        block_on(self.render_uploaded_async(scene, view, settings, layers, watch))
    }

    /// Blocks the thread until [`Headless::denoise_async`] is done.
    pub fn denoise(&self, image: &Image) -> Result<Image, GpuError> {
        block_on(self.denoise_async(image))
    }

    /// Blocks the thread until [`Headless::measure_async`] is done.
    pub fn measure(&self, scene: &SceneBuffers, view: &View<'_>) -> Result<TraceTime, GpuError> {
        block_on(self.measure_async(scene, view))
    }

    /// Blocks the thread until [`Headless::record_async`] is done.
    pub fn record(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        block_on(self.record_async(scene, view, settings, watch))
    }

    /// Blocks the thread until [`Headless::record_and_render_async`] is done.
    pub fn record_and_render(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        block_on(self.record_and_render_async(scene, view, settings, watch))
    }

    /// Blocks the thread until [`Headless::record_lit_part_async`] has recorded the middle of the film.
    pub fn record_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        samples: &[u32],
        callbacks: (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        let part = (LitPart::Middle, samples);
        block_on(self.record_lit_part_async(scene, view, settings, part, callbacks))
    }

    /// Blocks the thread until [`Headless::record_lit_part_async`] is done.
    pub fn record_lit_part(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        part_and_samples: (LitPart, &[u32]),
        callbacks: (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        block_on(self.record_lit_part_async(scene, view, settings, part_and_samples, callbacks))
    }

    /// Blocks the thread until [`Headless::verify_async`] is done.
    pub fn verify(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<Certificate, GpuError> {
        block_on(self.verify_async(scene, view, settings))
    }

    /// Blocks the thread until [`Headless::update_async`] is done.
    pub fn update(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        block_on(self.update_async(buffers, scene, update))
    }

    /// Blocks the thread until [`Headless::from_adapter_async`] is done.
    pub fn from_adapter(adapter: &Adapter, options: &HeadlessOptions) -> Result<Self, GpuError> {
        block_on(Self::from_adapter_async(adapter, options))
    }
}

impl Composite {
    /// Blocks the thread until [`Composite::new_async`] is done.
    pub fn new(device: &Device, options: &CompositeOptions) -> Result<Self, GpuError> {
        block_on(Self::new_async(device, options))
    }
}

impl CompositePicture {
    /// Blocks the thread until [`CompositePicture::new_async`] is done.
    pub fn new(
        composite: &Composite,
        device: &Device,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(composite, device, targets))
    }
}

impl DepthTest {
    /// Blocks the thread until [`DepthTest::new_async`] is done.
    pub fn new(renderer: &Renderer, device: &Device) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device))
    }
}

impl HostDepth {
    /// Blocks the thread until [`HostDepth::new_async`] is done.
    pub fn new(
        test: &DepthTest,
        device: &Device,
        texture: &wgpu::TextureView,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(test, device, texture))
    }
}

impl Picker {
    /// Blocks the thread until [`Picker::new_async`] is done.
    pub fn new(device: &Device, capacity: usize) -> Result<Self, GpuError> {
        block_on(Self::new_async(device, capacity))
    }
}

impl TargetTextures {
    /// Blocks the thread until [`TargetTextures::new_async`] is done.
    pub fn new(renderer: &Renderer, device: &Device, size: [u32; 2]) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device, size))
    }
}

impl LitPicture {
    /// Blocks the thread until [`LitPicture::new_async`] is done.
    pub fn new(
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device, queue, scene, view, settings, targets))
    }

    /// Blocks the thread until [`LitPicture::set_async`] is done.
    pub fn set(
        &mut self,
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<bool, GpuError> {
        block_on(self.set_async(renderer, device, queue, scene, view, settings))
    }
}

impl LitRenderer {
    /// Blocks the thread until [`LitRenderer::build_async`] is done.
    pub fn build(
        &self,
        device: &Device,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        block_on(self.build_async(device, scene, view, settings))
    }
}

impl LivePicture {
    /// Blocks the thread until [`LivePicture::new_async`] is done.
    pub fn new(
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device, queue, scene, view, settings, targets))
    }

    /// Blocks the thread until [`LivePicture::set_async`] is done.
    pub fn set(
        &mut self,
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        block_on(self.set_async(renderer, device, queue, scene, view, settings))
    }
}

impl Frame {
    /// Blocks the thread until [`Frame::new_async`] is done.
    pub fn new(
        renderer: &Renderer,
        device: &Device,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device, targets))
    }
}

impl Renderer {
    /// Blocks the thread until [`Renderer::new_async`] is done.
    pub fn new(device: &Device, options: &RendererOptions) -> Result<Self, GpuError> {
        block_on(Self::new_async(device, options))
    }
}

impl Recolor {
    /// Blocks the thread until [`Recolor::new_async`] is done.
    pub fn new(device: &Device) -> Result<Self, GpuError> {
        block_on(Self::new_async(device))
    }

    /// Blocks the thread until [`Recolor::record_async`] is done.
    pub fn record(
        &self,
        device: &Device,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        block_on(self.record_async(device, queue, encoder, buffers, scene, update))
    }
}

impl SceneBuffers {
    /// Blocks the thread until [`SceneBuffers::new_async`] is done.
    pub fn new(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(renderer, device, queue, scene))
    }

    /// Blocks the thread until [`SceneBuffers::with_accel_async`] is done.
    pub fn with_accel(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        accel: &Accel,
    ) -> Result<Self, GpuError> {
        block_on(Self::with_accel_async(renderer, device, queue, scene, accel))
    }

    /// Blocks the thread until [`SceneBuffers::for_studio_async`] is done.
    pub fn for_studio(
        renderer: &Renderer,
        device: &Device,
        queue: &Queue,
        scene: &Scene,
    ) -> Result<Self, GpuError> {
        block_on(Self::for_studio_async(renderer, device, queue, scene))
    }
}
