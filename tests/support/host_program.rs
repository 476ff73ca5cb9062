//! A program with a device of its own that draws with this library.

use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::gpu::{DataTargets, Frame, Renderer, RendererOptions, SceneBuffers, Targets, Wait, wgpu};
use pinhole::{RenderSettings, Scene, View};
use wgpu::TextureFormat::{R32Float, R32Uint, Rgba32Float};

#[derive(Clone)]
pub(crate) struct Host {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

pub(crate) fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

impl Host {
    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    pub(crate) fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
    }

    pub(crate) fn wait(&self) {
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    }

    /// A texture that passes draw to, and that copies read or write.
    pub(crate) fn texture(&self, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        let usage = match format.is_depth_stencil_format() {
            true => wgpu::TextureUsages::RENDER_ATTACHMENT,
            false => wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::STORAGE_BINDING,
        };
        let copies = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
        self.texture_for(size, format, 1, usage | copies | wgpu::TextureUsages::TEXTURE_BINDING)
    }

    pub(crate) fn texture_for(
        &self,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        sample_count: u32,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("host"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Writes all texels of a texture.
    pub(crate) fn write<T: bytemuck::NoUninit>(&self, texture: &wgpu::Texture, texels: &[T]) {
        let bytes = bytemuck::cast_slice(texels);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / texture.height()),
            rows_per_image: None,
        };
        self.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// Runs the encoder and returns the words of a texture.
    pub(crate) fn submit_and_read<T: bytemuck::Pod>(
        &self,
        mut encoder: wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> Vec<T> {
        let used = texture.width() * texture.format().block_copy_size(None).unwrap();
        let row = used.next_multiple_of(256);
        let buffer = self.read_buffer(u64::from(row * texture.height()));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, texture.size());
        let bytes = self.submit_and_map(encoder, &buffer);
        let rows = bytes.chunks(row as usize).flat_map(|row| &row[..used as usize]);
        bytemuck::pod_collect_to_vec(&rows.copied().collect::<Vec<u8>>())
    }

    pub(crate) fn read<T: bytemuck::Pod>(&self, texture: &wgpu::Texture) -> Vec<T> {
        self.submit_and_read(self.encoder(), texture)
    }

    /// Runs the encoder and returns the word in a buffer.
    pub(crate) fn submit_and_read_word(&self, mut encoder: wgpu::CommandEncoder, word: &wgpu::Buffer) -> u32 {
        let buffer = self.read_buffer(4);
        encoder.copy_buffer_to_buffer(word, 0, &buffer, 0, 4);
        u32::from_ne_bytes(self.submit_and_map(encoder, &buffer).try_into().unwrap())
    }

    fn read_buffer(&self, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    fn submit_and_map(&self, encoder: wgpu::CommandEncoder, buffer: &wgpu::Buffer) -> Vec<u8> {
        self.submit(encoder);
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        self.wait();
        buffer.get_mapped_range(..).unwrap().to_vec()
    }

    pub(crate) fn layers(&self, size: [u32; 2], color: wgpu::TextureFormat) -> Layers {
        let [color, depth, normal, id] =
            [color, R32Float, Rgba32Float, R32Uint].map(|format| self.texture(size, format));
        Layers { color, depth, normal, id }
    }

    /// A scene in a structure, divided into bricks of at most `binding` bytes.
    pub(crate) fn scene(&self, renderer: &Renderer, scene: &Scene, choice: AccelChoice, binding: u64) -> SceneBuffers {
        let accel = AccelPlan::new(scene.spheres(), choice, binding).build(scene.spheres());
        SceneBuffers::with_accel(renderer, &self.device, &self.queue, scene, &accel).wait().unwrap()
    }
}

/// The textures of a picture.
pub(crate) struct Layers {
    pub(crate) color: wgpu::Texture,
    pub(crate) depth: wgpu::Texture,
    pub(crate) normal: wgpu::Texture,
    pub(crate) id: wgpu::Texture,
}

impl Layers {
    pub(crate) fn all(&self) -> [&wgpu::Texture; 4] {
        [&self.color, &self.depth, &self.normal, &self.id]
    }

    /// Calls `then` with all layers, or with colour only.
    pub(crate) fn with<T>(&self, has_data: bool, then: impl FnOnce(&Targets<'_>) -> T) -> T {
        let [color, depth, normal, id] = self.all().map(view_of);
        let data = DataTargets { depth: &depth, normal: &normal, id: &id };
        then(&Targets { color: &color, data: has_data.then_some(data) })
    }

    /// A frame in these textures.
    pub(crate) fn frame(&self, renderer: &Renderer, device: &wgpu::Device, has_data: bool) -> Frame {
        self.with(has_data, |targets| Frame::new(renderer, device, targets).wait().unwrap())
    }
}

/// A renderer of a program, and a frame in its textures.
pub(crate) struct Drawing {
    pub(crate) renderer: Renderer,
    pub(crate) layers: Layers,
    pub(crate) frame: Frame,
}

impl Drawing {
    pub(crate) fn new(host: &Host, options: &RendererOptions, size: [u32; 2]) -> Self {
        Self::of(host, Renderer::new(&host.device, options).wait().unwrap(), options, size)
    }

    pub(crate) fn of(host: &Host, renderer: Renderer, options: &RendererOptions, size: [u32; 2]) -> Self {
        let layers = host.layers(size, options.color.texture_format());
        let frame = layers.frame(&renderer, &host.device, options.data_layers);
        Self { renderer, layers, frame }
    }

    pub(crate) fn scene(&self, host: &Host, scene: &Scene) -> SceneBuffers {
        SceneBuffers::new(&self.renderer, &host.device, &host.queue, scene).wait().unwrap()
    }

    /// Records a view of a scene into an encoder.
    pub(crate) fn record(
        &mut self,
        host: &Host,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> wgpu::CommandEncoder {
        self.frame.set_view(&host.queue, scene, view, settings).unwrap();
        let mut encoder = host.encoder();
        self.renderer.record(&mut encoder, scene, &self.frame).unwrap();
        encoder
    }
}
