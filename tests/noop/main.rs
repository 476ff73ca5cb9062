//! Tests of the guarantees for host programs on wgpu's `noop` device. It has WebGPU's default limits and no features,
//! checks every call as any device does, and executes nothing. No driver is needed.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod building;
#[path = "../support/host_program.rs"]
#[allow(dead_code, reason = "nothing is read back here")]
mod host_program;
mod passes;
mod steady_state;

use pinhole::accel::AccelChoice;
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::gpu::{Frame, Renderer, RendererOptions, SceneBuffers, Targets, WGPU_VERSION, Wait, wgpu};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};

use host_program::Host;

/// A host whose device has WebGPU's default limits and features.
impl Host {
    fn new() -> Self {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffers_per_shader_stage, 8);
        assert_eq!(device.features(), wgpu::DeviceDescriptor::default().required_features);
        Self { device, queue }
    }

    fn with_targets<T>(&self, options: &RendererOptions, size: [u32; 2], work: impl FnOnce(&Targets<'_>) -> T) -> T {
        self.layers(size, options.color.texture_format()).with(options.data_layers, work)
    }

    fn frame(&self, renderer: &Renderer, options: &RendererOptions, size: [u32; 2]) -> Frame {
        let frame = |targets: &Targets<'_>| Frame::new(renderer, &self.device, targets).wait().unwrap();
        self.with_targets(options, size, frame)
    }

    /// Runs `work` and returns the error of the device, if it refuses a call.
    fn refused(&self, work: impl FnOnce()) -> Option<String> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        work();
        pollster::block_on(scope.pop()).map(|error| error.to_string())
    }
}

/// Enough spheres for every structure.
fn spheres() -> Vec<[f32; 4]> {
    let spheres = (0..300_u16).map(|i| {
        let i = f32::from(i);
        [(i * 0.7).cos() * 3.0, i * 0.02 - 3.0, (i * 0.7).sin() * 3.0, 0.2]
    });
    spheres.collect()
}

fn scene() -> Scene {
    Scene::from_f32(spheres(), LinearRgb::WHITE).unwrap()
}

fn pinhole_camera() -> PinholeCamera {
    let pose = Pose::looking_at([0.0, 1.0, 12.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.7, 1.5).unwrap()
}

/// A camera of every kind.
fn cameras() -> Vec<Box<dyn Camera>> {
    let pose = Pose::looking_at([0.0, 1.0, 12.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let pinhole = pinhole_camera();
    vec![
        Box::new(pinhole),
        Box::new(OrthographicCamera::new(pose, [6.0, 4.0]).unwrap()),
        Box::new(ThinLensCamera::new(pinhole, 0.1, 12.0).unwrap()),
        Box::new(PanoramaCamera::new(pose)),
        Box::new(FisheyeCamera::new(pose, 3.0, 1.5).unwrap()),
    ]
}

const SIZE: [u32; 2] = [48, 32];

fn film() -> Film {
    Film::new(SIZE[0], SIZE[1]).unwrap()
}

/// A scene, and a frame of it whose view is set, so that it can be recorded.
fn ready(host: &Host, renderer: &Renderer, options: &RendererOptions) -> (SceneBuffers, Frame) {
    let buffers = host.scene(renderer, &scene(), AccelChoice::Auto, 1 << 27);
    let mut frame = host.frame(renderer, options, SIZE);
    let camera = pinhole_camera();
    let view = View::new(&camera, film());
    frame.set_view(&host.queue, &buffers, &view, &RenderSettings::default()).unwrap();
    (buffers, frame)
}

fn file(path: &str) -> String {
    std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Tests that every requirement of wgpu in the manifests has the version that the library and its documentation name.
#[test]
fn the_documented_version_of_wgpu_is_that_of_the_manifest() {
    let manifest = file("Cargo.toml");
    let required: Vec<&str> = manifest
        .lines()
        .filter_map(|line| line.strip_prefix("wgpu = { version = \""))
        .filter_map(|rest| rest.split('"').next())
        .collect();
    assert!(required.len() >= 2, "{required:?}");
    for version in &required {
        assert!(version.starts_with(&format!("{WGPU_VERSION}.")), "{version} is not {WGPU_VERSION}");
    }
    let release = env!("CARGO_PKG_VERSION");
    let row = format!("| {release} | {WGPU_VERSION} |");
    let page = "docs/how-to/embed.md";
    assert!(file(page).contains(&row), "{page} lacks the row `{row}`");
    let major = WGPU_VERSION.split('.').next().unwrap();
    let said = format!("wgpu {major}");
    for page in [page, "CHANGELOG.md"] {
        assert!(file(page).contains(&said), "{page} does not say `{said}`");
    }
}
