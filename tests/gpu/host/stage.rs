//! A host program with a camera, attachments and spheres, and the picture that it must show, in f64.

use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use pinhole::camera::film::Film;
use pinhole::camera::{Camera, HostCamera, Pose};
use pinhole::glam::{DMat4, DVec2, DVec3};
use pinhole::gpu::{
    Composite, CompositeDepth, CompositeOptions, CompositePicture, DepthTest, Frame, HostDepth, Renderer,
    RendererOptions, SceneBuffers, Targets, Wait, wgpu,
};
use pinhole::{LinearRgb, RenderSettings, Scene, Shading, Sphere};
use wgpu::TextureFormat;

use crate::host_program::{Host, Layers, view_of};
use crate::support::hosts::{Convention, view};
use crate::support::shaded;

pub(super) const SIZE: [u32; 2] = [101, 67];
/// The picture is a part of the host's attachments.
pub(super) const FIRST: [u32; 2] = [7, 5];
pub(super) const TARGET: [u32; 2] = [120, 80];
pub(super) const RANGE: [f64; 2] = [0.5, 20.0];

pub(super) struct Stage {
    pub(super) host: Host,
    pub(super) convention: Convention,
    pub(super) camera: HostCamera,
    /// Transform from world space to clip space.
    pub(super) to_clip: DMat4,
    pub(super) spheres: Vec<Sphere>,
    shared: Arc<Pipelines>,
    scene: SceneBuffers,
    pub(super) frame: Frame,
    pub(super) layers: Layers,
}

/// The host of all stages.
static HOST: LazyLock<Host> = LazyLock::new(Host::new);

/// A renderer and its test of the host's depth, which stages with the same options share.
pub(super) struct Pipelines {
    pub(super) renderer: Renderer,
    pub(super) test: DepthTest,
}

impl Pipelines {
    pub(super) fn new(options: &RendererOptions) -> Self {
        let renderer = Renderer::new(&HOST.device, options).wait().unwrap();
        let test = DepthTest::new(&renderer, &HOST.device).wait().unwrap();
        Self { renderer, test }
    }

    /// Pipelines with these options. Stages with equal options share them.
    pub(super) fn with(options: &RendererOptions) -> Arc<Self> {
        static ALL: Mutex<Vec<(RendererOptions, Arc<Pipelines>)>> = Mutex::new(Vec::new());
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = all.iter().find(|(of, _)| of == options) {
            return Arc::clone(known);
        }
        let new = Arc::new(Self::new(options));
        all.push((options.clone(), Arc::clone(&new)));
        new
    }
}

/// The point of a sphere at a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Truth {
    pub(super) id: usize,
    pub(super) distance: f64,
    /// Cosine of the angle between the ray and the normal; small at silhouettes.
    pub(super) cosine: f64,
    /// The host's depth, by its matrices.
    pub(super) depth: f64,
    pub(super) point: DVec3,
}

pub(super) fn pose() -> Pose {
    Pose::looking_at([2.0, 3.0, 7.0], [0.0, 0.25, 0.0], [0.1, 1.0, 0.0]).unwrap()
}

/// A shifted view, which is the same for all conventions.
pub(super) fn projection(convention: Convention, range: [f64; 2]) -> DMat4 {
    let scale = if convention.is_orthographic() { 7.0 } else { 1.0 };
    convention.projection([-0.5, 0.6, -0.35, 0.4].map(|edge| scale * edge), range, -1.0)
}

/// Random spheres whose centres and radii are exact in f32.
fn random_spheres() -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(12);
    let mut number = |range: std::ops::Range<i32>| f64::from(random.i32(range)) / 64.0;
    (0..40)
        .map(|i| {
            let center = [number(-128..128), number(-128..128), number(-128..128)];
            let color = LinearRgb::from_srgb8([6 * i, 255 - 6 * i, 90 + 2 * i]);
            Sphere::new(center, number(12..45), color)
        })
        .collect()
}

impl Stage {
    pub(super) fn new(convention: Convention) -> Self {
        Self::with(convention, projection(convention, RANGE), view(&pose(), -1.0))
    }

    /// A host whose near plane is oblique, so that depth depends on the position on the film, and
    /// whose view stretches and mirrors.
    pub(super) fn oblique(convention: Convention) -> Self {
        let mut projection = projection(convention, RANGE);
        projection.x_axis.z += 0.02;
        projection.y_axis.z -= 0.03;
        let change = DMat4::from_scale(DVec3::new(1.1, -0.9, 1.0));
        Self::with(convention, projection, view(&pose(), -1.0) * change)
    }

    fn with(convention: Convention, projection: DMat4, to_view: DMat4) -> Self {
        let host = HOST.clone();
        let camera = HostCamera::new(to_view, projection, convention.order()).unwrap();
        let spheres = random_spheres();
        let options = RendererOptions { data_layers: true, ..RendererOptions::default() };
        let shared = Pipelines::with(&options);
        let (renderer, Host { device, queue }) = (&shared.renderer, &host);
        let of_spheres = Scene::new(&spheres).unwrap();
        let scene = SceneBuffers::new(renderer, device, queue, &of_spheres).wait().unwrap();
        let layers = host.layers(SIZE, options.color.texture_format());
        let frame = layers.frame(renderer, device, true);
        let mut stage =
            Self { host, convention, camera, to_clip: projection * to_view, spheres, shared, scene, frame, layers };
        let film = Film::new(SIZE[0], SIZE[1]).unwrap();
        let seen = pinhole::View::new(&stage.camera, film);
        stage.frame.set_view(&stage.host.queue, &stage.scene, &seen, &settings()).unwrap();
        stage
    }

    pub(super) fn view(&self) -> pinhole::View<'_> {
        pinhole::View::new(&self.camera, Film::new(SIZE[0], SIZE[1]).unwrap())
    }

    /// An attachment of the host.
    pub(super) fn attachment(&self, format: TextureFormat, sample_count: u32) -> wgpu::Texture {
        let once = if sample_count == 1 {
            wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING
        } else {
            wgpu::TextureUsages::empty()
        };
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | once;
        self.host.texture_for(TARGET, format, sample_count, usage)
    }

    pub(super) fn composite(&self, format: TextureFormat, depth: TextureFormat, samples: u32) -> Composite {
        let mut options = CompositeOptions::new(format, self.composite_depth(depth));
        options.sample_count = samples;
        Composite::new(&self.host.device, &options).wait().unwrap()
    }

    pub(super) fn composite_depth(&self, format: TextureFormat) -> CompositeDepth {
        CompositeDepth::new(format, self.convention.order())
    }

    pub(super) fn picture(&self, composite: &Composite) -> CompositePicture {
        let device = &self.host.device;
        let picture = |targets: &Targets<'_>| CompositePicture::new(composite, device, targets).wait();
        self.layers.with(true, picture).unwrap()
    }

    /// Attachments with one sample, into which the spheres are drawn as a camera sees them.
    pub(super) fn composited(
        &self,
        [color, depth]: [TextureFormat; 2],
        camera: &HostCamera,
        first_pixel: [u32; 2],
        cleared: f32,
    ) -> [wgpu::Texture; 2] {
        let composite = self.composite(color, depth, 1);
        let mut picture = self.picture(&composite);
        picture.set_camera(&self.host.queue, camera, first_pixel);
        let textures = [color, depth].map(|format| self.attachment(format, 1));
        let mut encoder = self.host.encoder();
        self.trace(&mut encoder);
        {
            let [color, depth] = textures.each_ref().map(view_of);
            let mut pass = begin(&mut encoder, &color, None, &depth, Some(cleared));
            composite.draw(&mut pass, &picture).unwrap();
        }
        self.host.submit(encoder);
        textures
    }

    /// Records tracing the spheres.
    pub(super) fn trace(&self, encoder: &mut wgpu::CommandEncoder) {
        self.shared.renderer.record(encoder, &self.scene, &self.frame).unwrap();
    }

    /// Records tracing the spheres that the depth texture does not hide.
    pub(super) fn trace_with_depth(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        first_pixel: [u32; 2],
    ) {
        let Host { device, queue } = &self.host;
        let Pipelines { renderer, test } = &*self.shared;
        let mut depth = HostDepth::new(test, device, depth).wait().unwrap();
        let missing = renderer.record_with_depth(encoder, &self.scene, &self.frame, test, &depth);
        assert_eq!(missing, Err(pinhole::gpu::GpuError::NoView));
        depth.set_camera(queue, &self.camera, &self.frame, first_pixel).unwrap();
        assert!(depth.set_camera(queue, &self.camera, &self.frame, [20, 0]).is_err());
        renderer.record_with_depth(encoder, &self.scene, &self.frame, test, &depth).unwrap();
    }

    /// The depth to which the host clears.
    pub(super) fn far(&self) -> f32 {
        match self.convention.order() {
            pinhole::camera::DepthOrder::NearIsZero => 1.0,
            _ => 0.0,
        }
    }

    pub(super) fn location(pixel: [u32; 2]) -> DVec2 {
        let [x, y] = [0, 1].map(|axis| (f64::from(pixel[axis]) + 0.5) / f64::from(SIZE[axis]) * 2.0 - 1.0);
        DVec2::new(x, -y)
    }

    pub(super) fn depth_of(&self, point: DVec3) -> f64 {
        let clip = self.to_clip * point.extend(1.0);
        clip.z / clip.w
    }

    /// The nearest sphere at the centre of a pixel, by the textbook formula in f64.
    pub(super) fn truth(&self, pixel: [u32; 2]) -> Option<Truth> {
        let ray = self.camera.ray_in_world(Self::location(pixel));
        let hits = self.spheres.iter().enumerate().filter_map(|(id, sphere)| {
            let to_center = DVec3::from(sphere.center) - ray.origin;
            let along = to_center.dot(ray.direction);
            let aside = (to_center - along * ray.direction).length_squared();
            let half = (sphere.radius * sphere.radius - aside).sqrt();
            // NaN, for a miss, is not in front.
            [along - half, along + half].into_iter().find(|t| *t > 0.0).map(|distance| {
                let point = ray.at(distance);
                let cosine = half / sphere.radius;
                Truth { id, distance, cosine, depth: self.depth_of(point), point }
            })
        });
        hits.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// The pixels that are not near a silhouette, where rounding decides whether a sphere is hit.
    pub(super) fn clear_pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        pixels().filter(|pixel| !self.is_near_a_silhouette(*pixel))
    }

    /// Whether the ray passes the silhouette of a sphere at less than a thousandth of the sphere's radius.
    pub(super) fn is_near_a_silhouette(&self, pixel: [u32; 2]) -> bool {
        let ray = self.camera.ray_in_world(Self::location(pixel));
        self.spheres.iter().any(|sphere| {
            let to_center = DVec3::from(sphere.center) - ray.origin;
            let along = to_center.dot(ray.direction);
            let aside = (to_center - along * ray.direction).length();
            (aside / sphere.radius - 1.0).abs() < 2e-3
        })
    }
}

/// Index of a pixel in a picture.
pub(super) fn at([column, row]: [u32; 2]) -> usize {
    (row * SIZE[0] + column) as usize
}

/// Index of a pixel of the picture in an attachment.
pub(super) fn at_target([column, row]: [u32; 2]) -> usize {
    ((row + FIRST[1]) * TARGET[0] + column + FIRST[0]) as usize
}

pub(super) fn settings() -> RenderSettings {
    shaded(Shading::Flat, LinearRgb::from_srgb8([90, 90, 90]))
}

pub(super) fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| [column, row]))
}

/// A render pass over the viewport of the picture. Targets are cleared to black.
pub(super) fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    color: &wgpu::TextureView,
    resolved: Option<&wgpu::TextureView>,
    depth: &wgpu::TextureView,
    cleared: Option<f32>,
) -> wgpu::RenderPass<'a> {
    begin_over(encoder, [color, depth], resolved, cleared, wgpu::Color::BLACK)
}

/// A render pass over the viewport of the picture, with a colour and a depth to which the targets are cleared.
pub(super) fn begin_over<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    [color, depth]: [&wgpu::TextureView; 2],
    resolved: Option<&wgpu::TextureView>,
    cleared: Option<f32>,
    background: wgpu::Color,
) -> wgpu::RenderPass<'a> {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: resolved,
            ops: wgpu::Operations {
                load: match cleared {
                    Some(_) => wgpu::LoadOp::Clear(background),
                    None => wgpu::LoadOp::Load,
                },
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: cleared.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    let [x, y, width, height] = [FIRST[0], FIRST[1], SIZE[0], SIZE[1]].map(|n| n as f32);
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
    pass
}
