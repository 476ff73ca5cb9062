//! Errors of the GPU renderer.

use std::time::Duration;

use crate::accel::BrickKind;
use crate::camera::CameraKind;
use crate::camera::film::{Film, FilmError};
use crate::gpu::edit::ShaderEdit;
use crate::image::denoise::MissingGuide;
use crate::image::{DoesNotFit, ImageTooLarge};
use crate::render::SettingsError;
use crate::scene::SceneError;

/// The reason why the GPU renderer failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No driver offers an adapter.
    #[cfg_attr(
        not(target_arch = "wasm32"),
        error("no Vulkan, Metal or DX12 adapter was found; install a driver (Debian: mesa-vulkan-drivers)")
    )]
    #[cfg_attr(
        target_arch = "wasm32",
        error("this browser offers no WebGPU adapter; allow WebGPU in it, or choose another browser")
    )]
    NoAdapter,
    /// The environment variable `WGPU_BACKEND` names backends that have no adapter.
    #[error("WGPU_BACKEND={value} leaves no adapter; unset it, or name vulkan, metal or dx12")]
    NoAdapterOfBackend {
        /// The value of the variable.
        value: String,
    },
    /// No adapter's name contains the requested text.
    #[error("no adapter's name contains `{wanted}`; {}", list(available))]
    UnknownAdapter {
        /// The text as given.
        wanted: String,
        /// The names of the adapters that were found.
        available: Vec<String>,
    },
    /// The adapter could not open a device with the requested limits and features.
    #[error("adapter {adapter} could not open a device: {message}")]
    NoDevice {
        /// The name of the adapter.
        adapter: String,
        /// The reason that wgpu gave.
        message: String,
    },
    /// A buffer would be larger than a limit of the device allows.
    #[error("{what} needs {needed} bytes, but {limit_name} of this device is {limit}")]
    Limit {
        /// Description of the buffer.
        what: &'static str,
        /// Size of the buffer in bytes.
        needed: u64,
        /// wgpu's name of the limit.
        limit_name: &'static str,
        /// Value of the limit in bytes.
        limit: u64,
    },
    /// The host does not have enough free memory.
    #[error("{what} needs {needed} bytes of host memory, but {available} are free; choose {instead}")]
    HostMemory {
        /// Description of the data or the step that needs the memory.
        what: &'static str,
        /// Number of bytes that are needed.
        needed: u64,
        /// Number of bytes that are free.
        available: u64,
        /// An alternative that would need less memory.
        instead: &'static str,
    },
    /// A target texture does not have the format, size or usage that the renderer needs.
    #[error("the {layer} target is {found}; it must be {expected}")]
    Target {
        /// Name of the target's layer.
        layer: &'static str,
        /// Description of the texture that was given.
        found: String,
        /// Description of the texture that is needed.
        expected: String,
    },
    /// The renderer was built without this camera or structure, or for scenes of a single brick only.
    #[error(
        "this renderer has no pipeline for the {} camera and a {} of {}s; name both in RendererOptions, and set \
         `several_bricks` if the scene consists of several bricks",
        camera.name(), kind.structure.name(), kind.primitive.name()
    )]
    NoPipeline {
        /// The kind of the camera.
        camera: CameraKind,
        /// The kind of the scene's bricks.
        kind: BrickKind,
    },
    /// The renderer was built without this structure.
    #[error(
        "this renderer was not built for a {} of {}s; name the structure and the primitive in RendererOptions",
        kind.structure.name(), kind.primitive.name()
    )]
    NoStructure {
        /// The kind of the scene's bricks.
        kind: BrickKind,
    },
    /// The device has no ray queries, was opened without them, or belongs to a host program.
    #[error(
        "this device has no ray queries, or was opened without them (`HeadlessOptions::ray_query`); choose another structure"
    )]
    NoRayQuery,
    /// Tiles were asked for, but the picture cannot have any.
    #[error(
        "tiles are lists of spheres for one picture: they need one ray for each pixel, a camera that is pinhole, \
         orthographic, thin lens or fisheye, and no other picture of the same scene; choose another structure"
    )]
    NoTiles,
    /// A ray needed more loop iterations than a kernel may execute on this device.
    #[error(
        "a ray needs more loop iterations than this device allows; choose the structure `list`, which is slow but \
         always stays within the limit"
    )]
    Steps,
    /// A part of a film is not inside of it.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The picture of a part does not fit into the whole.
    #[error(transparent)]
    DoesNotFit(#[from] DoesNotFit),
    /// The caller asked to stop the render.
    #[error("stopped before the picture was finished")]
    Stopped,
    /// A function that supports primary rays only was called with another integrator.
    #[error(
        "frames and recordings do not support the integrator `{integrator}` yet; choose `primary`, or render with \
         `Headless::render`"
    )]
    NotPrimary {
        /// The integrator that was requested.
        integrator: &'static str,
    },
    /// A lit picture, or a recording of one, was requested for the integrator `primary`, which samples no light.
    #[error("lit pictures have the integrator `studio` or `path`; pictures of `primary` are those of `Frame`")]
    NotLit,
    /// Something that shows or records a whole picture was given a part of a film.
    #[error(
        "this is a part of a film; frames, pictures of hosts and recordings have whole films, and only \
         `Headless::render` and its like render parts"
    )]
    PartOfFilm,
    /// A studio picture needs a separate structure of the spheres that cast shadows, and the
    /// scene was uploaded without it.
    #[error(
        "some spheres of this scene are not opaque, and the scene was uploaded without the structure of the spheres \
         that cast shadows in a studio; upload the structures that `RenderPlan::build` returns for a plan with these \
         settings"
    )]
    NoOccluders,
    /// A live picture was requested of a scene, or with settings, that live pictures do not support.
    #[error("a live picture needs {needs}; show a `LitPicture` instead")]
    NotLive {
        /// The missing condition.
        needs: &'static str,
    },
    /// A host allowed fewer rays than the smallest part of a lit picture needs.
    #[error("a recording may trace {given} rays, too few for any part of the picture; allow {needed} or more")]
    Budget {
        /// Number of rays of the smallest part that is next.
        needed: u64,
        /// Number of rays that were allowed.
        given: u64,
    },
    /// The renderer's pipelines are still being built: `Renderer::begin` was called, and `Renderer::build_next` has more
    /// to do.
    #[error("{remaining} pipelines of the renderer are not built yet; call Renderer::build_next until none remains")]
    NotReady {
        /// Number of pipelines that are not ready.
        remaining: usize,
    },
    /// `Renderer::record` was called before `Frame::set_view`.
    #[error("the frame has no view yet; call Frame::set_view before Renderer::record")]
    NoView,
    /// `Composite::draw` was called before `CompositePicture::set_camera`, in a pass with depth.
    #[error("the picture has no camera yet; call CompositePicture::set_camera before Composite::draw")]
    NoCamera,
    /// The frame was made for a renderer with other targets.
    #[error("the frame was made for a renderer with other targets; create a frame for this renderer")]
    OtherRenderer,
    /// The view of the frame belongs to another scene, or was set before the spheres of this scene moved.
    #[error(
        "the frame's view belongs to another scene, or was set before this scene's spheres moved; call Frame::set_view \
         with this scene"
    )]
    OtherScene,
    /// An update of a scene changes more than colours, so the existing buffers cannot be updated.
    #[error("this update cannot be made in place; build a new structure, upload it and call SceneBuffers::replace")]
    NotInPlace,
    /// The device ran out of memory.
    #[error("the device is out of memory; choose a smaller size or fewer spheres")]
    OutOfMemory,
    /// The device did not finish in time.
    #[error("the device did not finish within {} seconds", waited.as_secs())]
    Timeout {
        /// The time that the host waited.
        waited: Duration,
    },
    /// The device was lost, for example because the driver crashed.
    #[error("the device was lost: {message}")]
    DeviceLost {
        /// The reason that the driver gave.
        message: String,
    },
    /// wgpu rejected a shader or a command, which is a defect of this crate or of a driver.
    #[error("wgpu reports: {message}")]
    Device {
        /// The message of wgpu. Locations in shaders are given as file and line.
        message: String,
    },
    /// The text that a shader edit should replace does not occur in the shader.
    #[error("shaders/{} does not contain the text `{}`, which should be replaced", edit.file, edit.find)]
    NoSuchText {
        /// The edit that could not be applied.
        edit: ShaderEdit,
    },
    /// The picture does not fit into host memory.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
    /// The scene does not fit into host memory.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture lacks a layer that the denoiser needs.
    #[error(transparent)]
    Guide(#[from] MissingGuide),
    /// The settings or a material are not valid.
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

/// Returns an error if a film is a part of another.
pub(super) fn check_whole(film: &Film) -> Result<(), GpuError> {
    if film.is_whole() { Ok(()) } else { Err(GpuError::PartOfFilm) }
}

/// Returns an error if the device could not create or bind a buffer of this size.
pub(super) fn check_storage_size(device: &wgpu::Device, what: &'static str, needed: u64) -> Result<(), GpuError> {
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
