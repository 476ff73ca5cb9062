//! The kernels of lit pictures. `shaders/README.md` lists them.

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::shaders::{BrickPass, Kernel, Part, camera_parts, part, structure_parts};
use crate::gpu::shape_ids::ExcludeBy;

/// What of a lighting decides which kernels it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Mode {
    Studio,
    Path(Materials, Sources, SkyKind),
}

impl Mode {
    /// Whether paths look for light.
    pub(in crate::gpu) fn looks_for_light(self) -> bool {
        matches!(self, Self::Path(_, Sources::Any, _))
    }

    /// Whether something may absorb light on the way.
    pub(in crate::gpu) fn has_medium(self) -> bool {
        matches!(self, Self::Path(Materials::Any, ..))
    }
}

/// Whether all surfaces are matt or emissive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Materials {
    Matt,
    Any,
}

/// Whether there is a light that can be looked for.
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

/// Which paths a dispatch works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Schedule {
    /// One for each pixel and each sample in flight.
    Pixels,
    /// Those of a list.
    Queue,
}

impl Schedule {
    fn part(self) -> Part {
        match self {
            Self::Pixels => part!("schedule_pixels.wgsl"),
            Self::Queue => part!("schedule_queue.wgsl"),
        }
    }
}

/// Makes the rays of samples.
pub(super) fn start_kernel(camera: CameraKind, mode: Mode) -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.extend([
        part!("path_address.wgsl"),
        part!("lighting.wgsl"),
        part!("sampling.wgsl"),
        part!("filter.wgsl"),
        part!("film_sample.wgsl"),
    ]);
    parts.extend(camera_parts(camera));
    parts.extend(match mode {
        Mode::Path(materials, sources, _) => [
            match sources {
                Sources::None => part!("start_no_light.wgsl"),
                Sources::Any => part!("start_light.wgsl"),
            },
            match materials {
                Materials::Matt => part!("start_no_medium.wgsl"),
                Materials::Any => part!("start_medium.wgsl"),
            },
        ],
        Mode::Studio => [part!("start_no_light.wgsl"), part!("start_no_medium.wgsl")],
    });
    parts.push(part!("start.wgsl"));
    Kernel { entry_point: "start", parts }
}

/// Finds the nearest sphere of every path's ray.
pub(super) fn extend_kernel(
    structure: Structure,
    exclude_by: ExcludeBy,
    brick_pass: BrickPass,
    schedule: Schedule,
) -> Kernel {
    let mut parts = base(schedule);
    parts.extend(origin_parts(exclude_by));
    parts.extend([part!("spend.wgsl"), part!("brick.wgsl")]);
    parts.push(match brick_pass {
        BrickPass::First => part!("first_segment.wgsl"),
        BrickPass::Later => part!("later_brick.wgsl"),
    });
    parts.extend(structure_parts(structure));
    parts.extend([part!("entry_path.wgsl"), part!("extend.wgsl")]);
    Kernel { entry_point: "extend", parts }
}

/// Finds whether anything is between paths' surfaces and lights.
pub(super) fn occlude_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = base(Schedule::Queue);
    parts.extend([
        part!("spend.wgsl"),
        part!("brick.wgsl"),
        part!("lighting.wgsl"),
        part!("emitter.wgsl"),
    ]);
    parts.extend(match exclude_by {
        ExcludeBy::Index => {
            vec![part!("own_shape.wgsl"), part!("origin_place_and_light.wgsl")]
        }
        ExcludeBy::Id => vec![part!("origin_id_and_light.wgsl")],
    });
    parts.extend(structure_parts(structure));
    parts.push(part!("occlude.wgsl"));
    Kernel { entry_point: "occlude", parts }
}

/// In a studio, finds whether a light is hidden.
pub(super) fn shadow_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure, exclude_by);
    parts.extend([part!("lamp.wgsl"), part!("shadow.wgsl")]);
    Kernel { entry_point: "shadow", parts }
}

/// In a studio, finds whether something is near in a direction of ambient light.
pub(super) fn ambient_kernel(structure: Structure, exclude_by: ExcludeBy) -> Kernel {
    let mut parts = hidden_light(structure, exclude_by);
    parts.push(part!("ambient.wgsl"));
    Kernel { entry_point: "ambient", parts }
}

/// How rays that start on a shape are told apart from it.
fn origin_parts(exclude_by: ExcludeBy) -> Vec<Part> {
    match exclude_by {
        ExcludeBy::Index => vec![part!("own_shape.wgsl"), part!("origin_place.wgsl")],
        ExcludeBy::Id => vec![part!("origin_id.wgsl")],
    }
}

fn hidden_light(structure: Structure, exclude_by: ExcludeBy) -> Vec<Part> {
    let mut parts = base(Schedule::Queue);
    parts.extend(origin_parts(exclude_by));
    parts.extend([
        part!("path_address.wgsl"),
        part!("spend.wgsl"),
        part!("brick.wgsl"),
        part!("trigonometry.wgsl"),
        part!("lighting.wgsl"),
        part!("sampling.wgsl"),
        part!("disk.wgsl"),
        part!("warp.wgsl"),
        part!("hidden_light.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    parts
}

/// In a studio, turns hits into surfaces.
pub(super) fn surface_kernel(schedule: Schedule) -> Kernel {
    let mut parts = shading(schedule);
    parts.extend([
        part!("appearance.wgsl"),
        part!("vertex.wgsl"),
        part!("material.wgsl"),
        part!("surface.wgsl"),
    ]);
    Kernel { entry_point: "surface", parts }
}

/// In a studio, adds some lights.
pub(super) fn illuminate_kernel() -> Kernel {
    let mut parts = studio_light();
    parts.extend([
        part!("appearance.wgsl"),
        part!("vertex.wgsl"),
        part!("material.wgsl"),
        part!("microfacet.wgsl"),
        part!("illuminate.wgsl"),
    ]);
    Kernel { entry_point: "illuminate", parts }
}

/// In a studio, adds ambient light from some directions.
pub(super) fn gather_kernel() -> Kernel {
    let mut parts = studio_light();
    parts.push(part!("gather.wgsl"));
    Kernel { entry_point: "gather", parts }
}

/// Scatters paths.
pub(super) fn scatter_kernel(
    schedule: Schedule,
    materials: Materials,
    sources: Sources,
    sky: SkyKind,
) -> Kernel {
    let mut parts = shading(schedule);
    parts.extend([
        part!("sampling.wgsl"),
        part!("disk.wgsl"),
        part!("warp.wgsl"),
        part!("appearance.wgsl"),
        part!("vertex.wgsl"),
        part!("material.wgsl"),
        part!("surface_point.wgsl"),
        part!("emitter.wgsl"),
        part!("emitters.wgsl"),
        part!("lamp.wgsl"),
        part!("by_chance.wgsl"),
        part!("bounce.wgsl"),
        part!("scatter.wgsl"),
    ]);
    match materials {
        Materials::Matt => {
            parts.extend([part!("medium_none.wgsl"), part!("scatter_matt.wgsl")]);
        }
        Materials::Any => parts.extend([
            part!("microfacet.wgsl"),
            part!("bsdf.wgsl"),
            part!("dielectric.wgsl"),
            part!("medium_glass.wgsl"),
            part!("scatter_any.wgsl"),
        ]),
    }
    match sources {
        Sources::None => {
            parts.extend([part!("settle_plain.wgsl"), part!("direct_none.wgsl")]);
        }
        Sources::Any => parts.extend([
            part!("settle_light.wgsl"),
            part!("direct_light.wgsl"),
            part!("direct.wgsl"),
        ]),
    }
    match sky {
        SkyKind::Plain => parts.push(part!("sky_plain.wgsl")),
        SkyKind::Image => parts.extend(sky_image()),
    }
    Kernel { entry_point: "scatter", parts }
}

/// Adds samples to pixels.
pub(super) fn accumulate_kernel(mode: Mode) -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.push(match mode {
        Mode::Path(_, Sources::Any, _) => part!("settle_light.wgsl"),
        Mode::Path(..) | Mode::Studio => part!("settle_plain.wgsl"),
    });
    parts.extend([part!("film_sums.wgsl"), part!("accumulate.wgsl")]);
    Kernel { entry_point: "accumulate", parts }
}

/// Says how many workgroups the next dispatches need.
pub(super) fn advance_kernel() -> Kernel {
    let mut parts = base(Schedule::Queue);
    parts.extend([part!("advance.wgsl")]);
    Kernel { entry_point: "advance", parts }
}

/// Sums up how much samples vary.
pub(super) fn noise_kernel() -> Kernel {
    let mut parts = base(Schedule::Pixels);
    parts.extend([part!("film_sums.wgsl"), part!("noise.wgsl")]);
    Kernel { entry_point: "noise", parts }
}

fn sky_image() -> Vec<Part> {
    vec![
        part!("turns.wgsl"),
        part!("trigonometry_inverse.wgsl"),
        part!("environment.wgsl"),
        part!("sky_image.wgsl"),
    ]
}

fn base(schedule: Schedule) -> Vec<Part> {
    vec![
        part!("records.wgsl"),
        part!("light_records.wgsl"),
        part!("frame.wgsl"),
        part!("fence.wgsl"),
        part!("ray.wgsl"),
        part!("enter.wgsl"),
        part!("sphere.wgsl"),
        part!("path_state.wgsl"),
        part!("departure.wgsl"),
        part!("queue.wgsl"),
        part!("schedule.wgsl"),
        schedule.part(),
    ]
}

fn shading(schedule: Schedule) -> Vec<Part> {
    let mut parts = base(schedule);
    parts.extend([part!("path_address.wgsl"), part!("trigonometry.wgsl"), part!("lighting.wgsl")]);
    parts
}

fn studio_light() -> Vec<Part> {
    let mut parts = shading(Schedule::Queue);
    parts.extend([
        part!("sampling.wgsl"),
        part!("disk.wgsl"),
        part!("warp.wgsl"),
        part!("lamp.wgsl"),
        part!("catcher.wgsl"),
    ]);
    parts
}

/// Every kernel of lit pictures that can be composed.
#[cfg(test)]
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
    for (&structure, exclude_by) in
        Structure::ALL.iter().flat_map(|of| ExcludeBy::ALL.map(|exclude_by| (of, exclude_by)))
    {
        for brick_pass in [BrickPass::First, BrickPass::Later] {
            kernels
                .extend(SCHEDULES.map(|by| extend_kernel(structure, exclude_by, brick_pass, by)));
        }
        let searches = [occlude_kernel, shadow_kernel, ambient_kernel];
        kernels.extend(searches.map(|of| of(structure, exclude_by)));
    }
    kernels.extend(SCHEDULES.map(surface_kernel));
    kernels
}
