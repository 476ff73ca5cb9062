//! What can go wrong on a device, and turning wgpu's errors into values.

use std::time::Duration;

use crate::accel::BrickKind;
use crate::camera::CameraKind;
use crate::gpu::edit::ShaderEdit;
use crate::image::ImageTooLarge;
use crate::image::denoise::MissingGuide;
use crate::render::SettingsError;
use crate::scene::SceneError;

/// Why the GPU path cannot do what it was asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No driver offers an adapter.
    #[error(
        "no Vulkan, Metal or DX12 adapter was found; install a driver (Debian: mesa-vulkan-drivers)"
    )]
    NoAdapter,
    /// `WGPU_BACKEND` names backends that have no adapter.
    #[error("WGPU_BACKEND={value} leaves no adapter; unset it, or name vulkan, metal or dx12")]
    NoAdapterOfBackend {
        /// The variable's value.
        value: String,
    },
    /// No adapter has a name that contains the wanted text.
    #[error("no adapter's name contains `{wanted}`; {}", list(available))]
    UnknownAdapter {
        /// The text as given.
        wanted: String,
        /// Names of the adapters that exist.
        available: Vec<String>,
    },
    /// The adapter gives no device with the limits that the kernels need.
    #[error("adapter {adapter} gives no device: {message}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// wgpu's reason.
        message: String,
    },
    /// A buffer would be larger than a limit of the device.
    #[error("{what} needs {needed} bytes, but {limit_name} of this device is {limit}")]
    Limit {
        /// What the buffer holds.
        what: &'static str,
        /// Bytes needed.
        needed: u64,
        /// wgpu's name of the limit.
        limit_name: &'static str,
        /// The limit's value in bytes.
        limit: u64,
    },
    /// The host's memory is too small.
    #[error(
        "{what} needs {needed} bytes of host memory, but {available} are free; choose {instead}"
    )]
    HostMemory {
        /// What takes it.
        what: &'static str,
        /// Bytes needed.
        needed: u64,
        /// Bytes that are free.
        available: u64,
        /// What would need less.
        instead: &'static str,
    },
    /// A target texture is not what the renderer was built for.
    #[error("the {layer} target is {found}; it must be {expected}")]
    Target {
        /// Which target.
        layer: &'static str,
        /// What was given.
        found: String,
        /// What is needed.
        expected: String,
    },
    /// The renderer was built without this camera or structure, or for one brick only.
    #[error(
        "this renderer has no pipeline for the {} camera and a {} of {}s, perhaps in several bricks; name them in RendererOptions",
        camera.name(), kind.structure.name(), kind.primitive.name()
    )]
    NoPipeline {
        /// The camera's kind.
        camera: CameraKind,
        /// The kind of the scene's bricks.
        kind: BrickKind,
    },
    /// The renderer was built without this structure.
    #[error(
        "this renderer was not built for a {} of {}s; name them in RendererOptions",
        kind.structure.name(), kind.primitive.name()
    )]
    NoStructure {
        /// The kind of the scene's bricks.
        kind: BrickKind,
    },
    /// A ray took more steps than a kernel may.
    #[error(
        "a ray takes more steps than this device may loop for; choose the structure `list`, which is slow \
         and always ends"
    )]
    Steps,
    /// The host asked to stop.
    #[error("stopped before the picture was finished")]
    Stopped,
    /// Only the integrator `path` has paths that can be recorded.
    #[error(
        "primary rays and studios have no paths that could be recorded; choose the integrator `path`"
    )]
    NotPaths,
    /// Only primary rays can be recorded here.
    #[error(
        "frames and recordings have primary rays only, for now, and not those of the integrator `{integrator}`; choose \
         `primary`, or render with `Headless::render`"
    )]
    NotPrimary {
        /// The integrator that was asked for.
        integrator: &'static str,
    },
    /// A studio needs a structure of its own for shadows, and the scene has none.
    #[error(
        "some spheres of this scene are not opaque, and it was uploaded without the structure of those that cast shadows \
         in a studio; upload what `RenderPlan::build` gives of a plan for these settings"
    )]
    NoOccluders,
    /// `record` was called before `Frame::set_view`.
    #[error("the frame has no view yet; call Frame::set_view before Renderer::record")]
    NoView,
    /// The frame was made for a renderer with other targets.
    #[error("the frame was made for a renderer with other targets; make it for this one")]
    OtherRenderer,
    /// The frame's view is of another scene, or of this one before its spheres moved.
    #[error(
        "the frame's view is of another scene, or of other spheres; call Frame::set_view with this one"
    )]
    OtherScene,
    /// An update of a scene changes more than colours.
    #[error(
        "this update cannot be made in place; build the structure anew, and call SceneBuffers::replace"
    )]
    NotInPlace,
    /// The device ran out of memory.
    #[error("the device is out of memory; choose a smaller size or fewer spheres")]
    OutOfMemory,
    /// The device did not finish in time.
    #[error("the device did not finish within {} seconds", waited.as_secs())]
    Timeout {
        /// How long was waited.
        waited: Duration,
    },
    /// The device is gone.
    #[error("the device was lost: {message}")]
    DeviceLost {
        /// The driver's reason.
        message: String,
    },
    /// A shader or a command was refused: a defect of this crate or of a driver.
    #[error("wgpu reports: {message}")]
    Device {
        /// wgpu's message; places in shaders are given as file and line.
        message: String,
    },
    /// A shader is to be edited where it has no such text.
    #[error("shaders/{} has no text `{}`, which is to be replaced", edit.file, edit.find)]
    NoSuchText {
        /// The edit.
        edit: ShaderEdit,
    },
    /// The picture does not fit into host memory.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
    /// The scene does not fit into host memory.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture lacks a layer by which it could be denoised.
    #[error(transparent)]
    Guide(#[from] MissingGuide),
    /// Settings, or a material, are refused.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

fn list(available: &[String]) -> String {
    if available.is_empty() {
        "there are no adapters".to_owned()
    } else {
        format!("there are: {}", available.join(", "))
    }
}

impl GpuError {
    pub(super) fn from_wgpu(error: &wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::OutOfMemory,
            other => Self::Device { message: other.to_string() },
        }
    }
}

/// Runs `create` so that errors of the device come back as values, and never reach the handler of a
/// host that lent us the device.
pub(super) fn scoped<T>(device: &wgpu::Device, create: impl FnOnce() -> T) -> Result<T, GpuError> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let created = create();
    // Scopes nest, so they are popped in reverse. What lacks memory is then invalid for all that uses
    // it, so that the last one popped, memory, comes first as a reason.
    let errors = [internal, validation, memory].map(|scope| pollster::block_on(scope.pop()));
    match errors.iter().rev().flatten().next() {
        Some(error) => Err(GpuError::from_wgpu(error)),
        None => Ok(created),
    }
}

/// Refuses a buffer that the device could not create or bind.
pub(super) fn check_storage_size(
    device: &wgpu::Device,
    what: &'static str,
    needed: u64,
) -> Result<(), GpuError> {
    let limits = device.limits();
    for (limit_name, limit) in [
        ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
        ("max_buffer_size", limits.max_buffer_size),
    ] {
        if needed > limit {
            return Err(GpuError::Limit { what, needed, limit_name, limit });
        }
    }
    Ok(())
}
