//! The kernels of lit pictures. `shaders/README.md` lists them.

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::{
    BrickPass, Constant, Kernel, Part, camera_constant, camera_parts, part, structure_parts,
};

/// The properties of a lighting that determine its kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Mode {
    Studio,
    Path(Materials, Sources, SkyKind),
}

impl Mode {
    /// Whether paths sample lights.
    pub(crate) fn samples_light(self) -> bool {
        matches!(self, Self::Path(_, Sources::Any, _))
    }

    /// Whether light may be absorbed between surfaces.
    pub(crate) fn has_medium(self) -> bool {
        matches!(self, Self::Path(Materials::Any, ..))
    }

    pub(crate) fn is_studio(self) -> bool {
        self == Self::Studio
    }

    /// The constants of `path/choices.wgsl`.
    pub(super) fn constants(self) -> [Constant; 2] {
        [
            ("ANY_MATERIALS", u32::from(self.has_medium())),
            ("SAMPLES_LIGHT", u32::from(self.samples_light())),
        ]
    }
}

/// Whether all surfaces are matt or emissive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Materials {
    Matt,
    Any,
}

/// Whether there is a light source that can be sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Sources {
    None,
    Any,
}

/// Whether the sky is an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SkyKind {
    Plain,
    Image,
}

/// The paths that a dispatch processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Schedule {
    /// One path for each pixel and each sample in flight.
    Pixels,
    /// The paths of a list.
    Queue,
}

impl Schedule {
    fn constant(self) -> Constant {
        ("TAKES_LIST", u32::from(self == Self::Queue))
    }
}

/// The kernel that starts paths with camera rays.
pub(super) fn start_kernel(camera: CameraKind, mode: Mode) -> Kernel {
    let mut parts = paths();
    parts.extend([
        part!("path/address.wgsl"),
        part!("scene/lighting.wgsl"),
        part!("math/sampling.wgsl"),
        part!("camera/filter.wgsl"),
        part!("camera/film_sample.wgsl"),
        part!("path/choices.wgsl"),
        part!("path/direct_light.wgsl"),
        part!("path/medium.wgsl"),
        part!("path/start.wgsl"),
    ]);
    parts.extend(camera_parts());
    Kernel::new("start", parts)
        .with(mode.constants())
        .with([camera_constant(camera), Schedule::Pixels.constant()])
}

/// The kernel that finds the nearest sphere of every path's ray.
pub(super) fn extend_kernel(
    structure: Structure,
    exclude_by: ExcludeBy,
    brick_pass: BrickPass,
    schedule: Schedule,
) -> Kernel {
    let mut parts = paths();
    parts.extend(excluded_parts());
    parts.extend([
        part!("accel/spend.wgsl"),
        part!("accel/brick.wgsl"),
        part!("path/first_hit.wgsl"),
        part!("path/hit_before.wgsl"),
        part!("path/extend.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    let constants = [exclude_by.constant(), brick_pass.constant(), schedule.constant()];
    Kernel::new("extend", parts).with(constants)
}

/// The kernel that finds whether sampled lights are occluded.
pub(super) fn occlude_kernel(structure: Structure, exclude_by: ExcludeBy, mode: Mode) -> Kernel {
    let mut parts = paths();
    parts.extend([
        part!("path/choices.wgsl"),
        part!("accel/spend.wgsl"),
        part!("accel/brick.wgsl"),
        part!("scene/emitter.wgsl"),
    ]);
    parts.extend(excluded_with_light());
    parts.extend(structure_parts(structure));
    parts.push(part!("path/occlude.wgsl"));
    Kernel::new("occlude", parts)
        .with(mode.constants())
        .with([exclude_by.constant(), Schedule::Queue.constant()])
}

/// The kernel of studios that finds whether a light is hidden.
pub(super) fn shadow_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure);
    parts.extend([part!("scene/lamp.wgsl"), part!("studio/shadow.wgsl")]);
    Kernel::new("shadow", parts).with([exclude_by.constant(), Schedule::Queue.constant()])
}

/// The kernel of studios that finds whether directions of ambient light are occluded.
pub(super) fn ambient_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure);
    parts.push(part!("studio/ambient.wgsl"));
    Kernel::new("ambient", parts).with([exclude_by.constant(), Schedule::Queue.constant()])
}

/// The parts that exclude the shape on which a ray starts, and the emitter that it is directed to.
pub(super) fn excluded_with_light() -> [Part; 2] {
    [part!("path/departed_shape.wgsl"), part!("accel/excluded.wgsl", "departed-and-light")]
}

/// The parts that exclude the shape on which a ray starts.
pub(super) fn excluded_parts() -> [Part; 2] {
    [part!("path/departed_shape.wgsl"), part!("accel/excluded.wgsl", "departed")]
}

fn hidden_light(structure: Structure) -> Vec<Part> {
    let mut parts = paths();
    parts.push(part!("path/address.wgsl"));
    parts.extend(light_search(structure));
    parts.push(part!("studio/hide.wgsl"));
    parts
}

/// The parts that find whether a light is hidden from a surface.
pub(super) fn light_search(structure: Structure) -> Vec<Part> {
    let mut parts = sampled_search(structure, excluded_parts());
    parts.push(part!("studio/hidden_light.wgsl"));
    parts
}

/// The parts that take directions by chance, and find what is along them. `excluded` are those that exclude shapes.
pub(super) fn sampled_search(structure: Structure, excluded: [Part; 2]) -> Vec<Part> {
    let mut parts = Vec::from(excluded);
    parts.extend([
        part!("accel/spend.wgsl"),
        part!("accel/brick.wgsl"),
        part!("math/trigonometry.wgsl"),
        part!("scene/lighting.wgsl"),
        part!("math/sampling.wgsl"),
        part!("math/disk.wgsl"),
        part!("math/warp.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    parts
}

/// The kernel of studios that computes surfaces from hits.
pub(super) fn surface_kernel(schedule: Schedule) -> Kernel {
    let mut parts = shading();
    parts.extend([
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/appearance.wgsl"),
        part!("path/vertex.wgsl"),
        part!("scene/material.wgsl"),
        part!("studio/faded.wgsl"),
        part!("studio/surface.wgsl"),
    ]);
    Kernel::new("surface", parts).with([schedule.constant()])
}

/// The kernel of studios that adds the contributions of some lights.
pub(super) fn illuminate_kernel() -> Kernel {
    let mut parts = studio_light();
    parts.extend([
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/appearance.wgsl"),
        part!("path/vertex.wgsl"),
        part!("scene/material.wgsl"),
        part!("path/microfacet.wgsl"),
        part!("studio/reflected.wgsl"),
        part!("studio/illuminate.wgsl"),
    ]);
    Kernel::new("illuminate", parts).with([Schedule::Queue.constant()])
}

/// The kernel of studios that adds ambient light from some directions.
pub(super) fn gather_kernel() -> Kernel {
    let mut parts = studio_light();
    parts.push(part!("studio/gather.wgsl"));
    Kernel::new("gather", parts).with([Schedule::Queue.constant()])
}

/// The kernel that shades hits and scatters paths.
pub(super) fn scatter_kernel(
    schedule: Schedule,
    materials: Materials,
    sources: Sources,
    sky: SkyKind,
) -> Kernel {
    let mut parts = shading();
    parts.extend([
        part!("math/sampling.wgsl"),
        part!("math/disk.wgsl"),
        part!("math/warp.wgsl"),
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/emitter.wgsl"),
        part!("path/scatter.wgsl"),
    ]);
    parts.extend(scattering(sky));
    let mode = Mode::Path(materials, sources, sky);
    Kernel::new("scatter", parts).with(mode.constants()).with([schedule.constant()])
}

/// The parts that say what becomes of a path at a surface.
pub(super) fn scattering(sky: SkyKind) -> Vec<Part> {
    let mut parts = vec![
        part!("scene/appearance.wgsl"),
        part!("path/vertex.wgsl"),
        part!("scene/material.wgsl"),
        part!("path/surface_point.wgsl"),
        part!("scene/emitters.wgsl"),
        part!("scene/lamp.wgsl"),
        part!("path/by_chance.wgsl"),
        part!("path/bounce.wgsl"),
        part!("path/leave.wgsl"),
        part!("path/choices.wgsl"),
        part!("path/direct_light.wgsl"),
        part!("path/medium.wgsl"),
        part!("path/microfacet.wgsl"),
        part!("path/bsdf.wgsl"),
        part!("path/dielectric.wgsl"),
        part!("path/scatter_light.wgsl"),
        part!("path/direct.wgsl"),
    ];
    match sky {
        SkyKind::Plain => parts.push(part!("scene/sky.wgsl", "plain")),
        SkyKind::Image => parts.extend(sky_image()),
    }
    parts
}

/// The kernel that accumulates samples.
pub(super) fn accumulate_kernel(mode: Mode) -> Kernel {
    let mut parts = paths();
    parts.extend([
        part!("path/choices.wgsl"),
        part!("path/direct_light.wgsl"),
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("path/accumulate.wgsl"),
    ]);
    Kernel::new("accumulate", parts).with(mode.constants()).with([Schedule::Pixels.constant()])
}

/// The kernel that computes the numbers of workgroups of the next indirect dispatches.
pub(super) fn advance_kernel() -> Kernel {
    let mut parts = base();
    parts.push(part!("path/advance.wgsl"));
    Kernel::new("advance", parts)
}

/// The kernel that sums variances and luminances of pixels.
pub(super) fn noise_kernel() -> Kernel {
    let mut parts = base();
    parts.extend([
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("path/noise.wgsl"),
    ]);
    Kernel::new("noise", parts)
}

fn sky_image() -> Vec<Part> {
    vec![
        part!("math/turns.wgsl"),
        part!("math/trigonometry_inverse.wgsl"),
        part!("scene/environment.wgsl"),
        part!("scene/sky.wgsl", "image"),
    ]
}

/// What kernels have in which every invocation processes a path.
fn paths() -> Vec<Part> {
    let mut parts = base();
    parts.push(part!("path/schedule.wgsl"));
    parts
}

/// What all kernels of lit pictures have.
pub(super) fn base() -> Vec<Part> {
    vec![
        part!("scene/records.wgsl"),
        part!("scene/lighting_records.wgsl"),
        part!("scene/frame.wgsl"),
        part!("math/fence.wgsl"),
        part!("camera/ray.wgsl"),
        part!("scene/enter.wgsl"),
        part!("scene/sphere.wgsl"),
        part!("path/state.wgsl"),
        part!("path/departure.wgsl"),
        part!("path/queue.wgsl"),
        part!("primary/schedule.wgsl"),
    ]
}

fn shading() -> Vec<Part> {
    let mut parts = paths();
    parts.extend([
        part!("path/address.wgsl"),
        part!("math/trigonometry.wgsl"),
        part!("scene/lighting.wgsl"),
    ]);
    parts
}

fn studio_light() -> Vec<Part> {
    let mut parts = shading();
    parts.extend([
        part!("math/sampling.wgsl"),
        part!("math/disk.wgsl"),
        part!("math/warp.wgsl"),
        part!("math/luminance.wgsl"),
        part!("scene/lamp.wgsl"),
        part!("studio/catcher.wgsl"),
    ]);
    parts
}
