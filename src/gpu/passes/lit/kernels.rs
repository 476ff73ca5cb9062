//! The kernels of lit pictures. `shaders/README.md` lists them.

use super::one_pass::OnePass;
use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::scene::shape_ids::ExcludeBy;
use crate::gpu::shader::{BrickPass, Kernel, Part, camera_parts, part, structure_parts};

/// The properties of a lighting that determine its kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Mode {
    Studio,
    Path(Materials, Sources, SkyKind),
}

impl Mode {
    /// Whether paths sample lights.
    pub(in crate::gpu) fn samples_light(self) -> bool {
        matches!(self, Self::Path(_, Sources::Any, _))
    }

    /// Whether light may be absorbed between surfaces.
    pub(in crate::gpu) fn has_medium(self) -> bool {
        matches!(self, Self::Path(Materials::Any, ..))
    }

    pub(in crate::gpu) fn is_studio(self) -> bool {
        self == Self::Studio
    }

    fn direct_light(self) -> Part {
        if self.samples_light() {
            part!("path/direct_light.wgsl", "any")
        } else {
            part!("path/direct_light.wgsl", "none")
        }
    }

    fn medium(self) -> Part {
        if self.has_medium() {
            part!("path/medium.wgsl", "glass")
        } else {
            part!("path/medium.wgsl", "none")
        }
    }
}

/// Whether all surfaces are matt or emissive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Materials {
    Matt,
    Any,
}

/// Whether there is a light source that can be sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Sources {
    None,
    Any,
}

/// Whether the sky is an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum SkyKind {
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
    fn part(self) -> Part {
        match self {
            Self::Pixels => part!("path/schedule.wgsl", "pixels"),
            Self::Queue => part!("path/schedule.wgsl", "queue"),
        }
    }
}

/// The kernel that starts paths with camera rays.
pub(super) fn start_kernel(camera: CameraKind, mode: Mode) -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.extend([
        part!("path/address.wgsl"),
        part!("scene/lighting.wgsl"),
        part!("math/sampling.wgsl"),
        part!("camera/filter.wgsl"),
        part!("camera/film_sample.wgsl"),
    ]);
    parts.extend(camera_parts(camera));
    parts.extend([mode.direct_light(), mode.medium(), part!("path/start.wgsl")]);
    Kernel { entry_point: "start", parts }
}

/// The kernel that finds the nearest sphere of every path's ray.
pub(super) fn extend_kernel(
    structure: Structure,
    exclude_by: ExcludeBy,
    brick_pass: BrickPass,
    schedule: Schedule,
) -> Kernel {
    let mut parts = base(schedule);
    parts.extend(excluded_parts(exclude_by));
    parts.extend([part!("accel/spend.wgsl"), part!("accel/brick.wgsl")]);
    parts.extend(structure_parts(structure));
    parts.push(match brick_pass {
        BrickPass::First => part!("path/hit_before.wgsl", "first-brick"),
        BrickPass::Later => part!("path/hit_before.wgsl", "later-brick"),
    });
    parts.push(part!("path/extend.wgsl"));
    Kernel { entry_point: "extend", parts }
}

/// The kernel that finds whether sampled lights are occluded.
pub(super) fn occlude_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = base(Schedule::Queue);
    parts.extend([
        part!("accel/spend.wgsl"),
        part!("accel/brick.wgsl"),
        part!("scene/emitter.wgsl"),
    ]);
    parts.extend(excluded_with_light(exclude_by));
    parts.extend(structure_parts(structure));
    parts.push(part!("path/occlude.wgsl"));
    Kernel { entry_point: "occlude", parts }
}

/// The kernel of studios that finds whether a light is hidden.
pub(super) fn shadow_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure, exclude_by);
    parts.extend([part!("scene/lamp.wgsl"), part!("studio/shadow.wgsl")]);
    Kernel { entry_point: "shadow", parts }
}

/// The kernel of studios that finds whether directions of ambient light are occluded.
pub(super) fn ambient_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure, exclude_by);
    parts.push(part!("studio/ambient.wgsl"));
    Kernel { entry_point: "ambient", parts }
}

/// The parts that exclude the shape on which a ray starts, and the emitter that it is directed to.
pub(super) fn excluded_with_light(exclude_by: ExcludeBy) -> Vec<Part> {
    match exclude_by {
        ExcludeBy::Index => vec![
            part!("path/departed_shape.wgsl"),
            part!("accel/excluded.wgsl", "by-index-and-light"),
        ],
        ExcludeBy::Id => vec![part!("accel/excluded.wgsl", "by-id-and-light")],
    }
}

/// The parts that exclude the shape on which a ray starts.
pub(super) fn excluded_parts(exclude_by: ExcludeBy) -> Vec<Part> {
    match exclude_by {
        ExcludeBy::Index => {
            vec![part!("path/departed_shape.wgsl"), part!("accel/excluded.wgsl", "by-index")]
        }
        ExcludeBy::Id => vec![part!("accel/excluded.wgsl", "by-id")],
    }
}

fn hidden_light(structure: Structure, exclude_by: ExcludeBy) -> Vec<Part> {
    let mut parts = base(Schedule::Queue);
    parts.push(part!("path/address.wgsl"));
    parts.extend(light_search(structure, exclude_by));
    parts.push(part!("studio/hide.wgsl"));
    parts
}

/// The parts that find whether a light is hidden from a surface.
pub(super) fn light_search(structure: Structure, exclude_by: ExcludeBy) -> Vec<Part> {
    let mut parts = sampled_search(structure, excluded_parts(exclude_by));
    parts.push(part!("studio/hidden_light.wgsl"));
    parts
}

/// The parts that take directions by chance, and find what is along them. `excluded` are those that exclude shapes.
pub(super) fn sampled_search(structure: Structure, excluded: Vec<Part>) -> Vec<Part> {
    let mut parts = excluded;
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
    let mut parts = shading(schedule);
    parts.extend([
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/appearance.wgsl"),
        part!("path/vertex.wgsl"),
        part!("scene/material.wgsl"),
        part!("studio/faded.wgsl"),
        part!("studio/surface.wgsl"),
    ]);
    Kernel { entry_point: "surface", parts }
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
    Kernel { entry_point: "illuminate", parts }
}

/// The kernel of studios that adds ambient light from some directions.
pub(super) fn gather_kernel() -> Kernel {
    let mut parts = studio_light();
    parts.push(part!("studio/gather.wgsl"));
    Kernel { entry_point: "gather", parts }
}

/// The kernel that shades hits and scatters paths.
pub(super) fn scatter_kernel(
    schedule: Schedule,
    materials: Materials,
    sources: Sources,
    sky: SkyKind,
) -> Kernel {
    let mut parts = shading(schedule);
    parts.extend([
        part!("math/sampling.wgsl"),
        part!("math/disk.wgsl"),
        part!("math/warp.wgsl"),
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/emitter.wgsl"),
        part!("path/scatter.wgsl"),
    ]);
    parts.extend(scattering(materials, sources, sky));
    Kernel { entry_point: "scatter", parts }
}

/// The parts that say what becomes of a path at a surface.
pub(super) fn scattering(materials: Materials, sources: Sources, sky: SkyKind) -> Vec<Part> {
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
    ];
    let mode = Mode::Path(materials, sources, sky);
    parts.extend([mode.direct_light(), mode.medium()]);
    match materials {
        Materials::Matt => parts.push(part!("path/scatter_light.wgsl", "matt")),
        Materials::Any => parts.extend([
            part!("path/microfacet.wgsl"),
            part!("path/bsdf.wgsl"),
            part!("path/dielectric.wgsl"),
            part!("path/scatter_light.wgsl", "any"),
        ]),
    }
    parts.push(match sources {
        Sources::None => part!("path/direct.wgsl", "none"),
        Sources::Any => part!("path/direct.wgsl", "any"),
    });
    match sky {
        SkyKind::Plain => parts.push(part!("scene/sky.wgsl", "plain")),
        SkyKind::Image => parts.extend(sky_image()),
    }
    parts
}

/// The kernel that accumulates samples.
pub(super) fn accumulate_kernel(mode: Mode) -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.extend([
        mode.direct_light(),
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("path/accumulate.wgsl"),
    ]);
    Kernel { entry_point: "accumulate", parts }
}

/// The kernel that computes the numbers of workgroups of the next indirect dispatches.
pub(super) fn advance_kernel() -> Kernel {
    let mut parts = base(Schedule::Queue);
    parts.extend([part!("path/advance.wgsl")]);
    Kernel { entry_point: "advance", parts }
}

/// The kernel that sums variances and luminances of pixels.
pub(super) fn noise_kernel() -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.extend([
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("path/noise.wgsl"),
    ]);
    Kernel { entry_point: "noise", parts }
}

fn sky_image() -> Vec<Part> {
    vec![
        part!("math/turns.wgsl"),
        part!("math/trigonometry_inverse.wgsl"),
        part!("scene/environment.wgsl"),
        part!("scene/sky.wgsl", "image"),
    ]
}

pub(super) fn base(schedule: Schedule) -> Vec<Part> {
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
        schedule.part(),
    ]
}

fn shading(schedule: Schedule) -> Vec<Part> {
    let mut parts = base(schedule);
    parts.extend([
        part!("path/address.wgsl"),
        part!("math/trigonometry.wgsl"),
        part!("scene/lighting.wgsl"),
    ]);
    parts
}

fn studio_light() -> Vec<Part> {
    let mut parts = shading(Schedule::Queue);
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

/// All kernels of lit pictures that can be composed.
pub(in crate::gpu) fn all_kernels() -> Vec<Kernel> {
    const SCHEDULES: [Schedule; 2] = [Schedule::Pixels, Schedule::Queue];
    let mut modes = vec![Mode::Studio];
    for materials in [Materials::Matt, Materials::Any] {
        for sources in [Sources::None, Sources::Any] {
            for sky in [SkyKind::Plain, SkyKind::Image] {
                modes.push(Mode::Path(materials, sources, sky));
            }
        }
    }
    let mut kernels = vec![advance_kernel(), noise_kernel(), illuminate_kernel(), gather_kernel()];
    for &mode in &modes {
        kernels.push(accumulate_kernel(mode));
        if let Mode::Path(materials, sources, sky) = mode {
            kernels.extend(SCHEDULES.map(|by| scatter_kernel(by, materials, sources, sky)));
        }
        let cameras = CameraKind::ALL.iter();
        kernels.extend(cameras.map(|camera| start_kernel(*camera, mode)));
    }
    for (&structure, exclude_by) in Structure::WITH_KERNELS
        .iter()
        .flat_map(|of| ExcludeBy::ALL.map(|exclude_by| (of, exclude_by)))
    {
        for brick_pass in [BrickPass::First, BrickPass::Later] {
            kernels
                .extend(SCHEDULES.map(|by| extend_kernel(structure, exclude_by, brick_pass, by)));
        }
        let cameras = CameraKind::ALL.iter();
        kernels.extend(cameras.flat_map(|camera| {
            OnePass::ALL.map(|pass| pass.kernel(*camera, structure, exclude_by))
        }));
        let searches = [occlude_kernel, shadow_kernel, ambient_kernel];
        kernels.extend(searches.map(|of| of(structure, exclude_by)));
    }
    kernels.extend(super::live::live_kernels());
    kernels.extend(SCHEDULES.map(surface_kernel));
    kernels
}
