//! The kernels of lit pictures. `shaders/README.md` lists them.

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::shaders::{Kernel, Part, Turn, camera_parts, part, structure_parts};

/// What of a lighting decides which kernels it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Mode {
    Studio,
    Path(Surfaces, Sources, SkyKind),
}

/// Whether all surfaces are matt or emissive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) enum Surfaces {
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

/// Makes the ray of a sample.
pub(super) fn start_kernel(camera: CameraKind, is_studio: bool) -> Kernel {
    let mut parts = base();
    parts.extend([
        part!("origin_none.wgsl"),
        part!("schedule.wgsl"),
        part!("look.wgsl"),
        part!("sampling.wgsl"),
        part!("filter.wgsl"),
        part!("film_sample.wgsl"),
    ]);
    parts.extend(camera_parts(camera));
    parts.push(if is_studio { part!("start_studio.wgsl") } else { part!("start_path.wgsl") });
    parts.push(part!("start.wgsl"));
    Kernel { entry_point: "start", parts }
}

/// Finds the nearest sphere of every path's ray.
pub(super) fn extend_kernel(structure: Structure, turn: Turn) -> Kernel {
    let mut parts = base();
    parts.extend([
        part!("origin_sphere.wgsl"),
        part!("schedule.wgsl"),
        part!("spend.wgsl"),
        part!("brick.wgsl"),
    ]);
    parts.push(match turn {
        Turn::First => part!("first_segment.wgsl"),
        Turn::Later => part!("later_brick.wgsl"),
    });
    parts.extend(structure_parts(structure));
    parts.extend([part!("entry_path.wgsl"), part!("trace.wgsl")]);
    Kernel { entry_point: "trace", parts }
}

/// Finds whether anything is between paths' surfaces and lights.
pub(super) fn occlude_kernel(structure: Structure) -> Kernel {
    let mut parts = base();
    parts.extend([
        part!("schedule.wgsl"),
        part!("spend.wgsl"),
        part!("brick.wgsl"),
        part!("origin_and_target.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    parts.push(part!("occlude.wgsl"));
    Kernel { entry_point: "occlude", parts }
}

/// In a studio, finds whether a light is hidden.
pub(super) fn shadow_kernel(structure: Structure) -> Kernel {
    let mut parts = hidden_light(structure);
    parts.extend([part!("lamp.wgsl"), part!("shadow.wgsl")]);
    Kernel { entry_point: "shadow", parts }
}

/// In a studio, finds whether something is near in a direction of ambient light.
pub(super) fn ambient_kernel(structure: Structure) -> Kernel {
    let mut parts = hidden_light(structure);
    parts.push(part!("ambient.wgsl"));
    Kernel { entry_point: "ambient", parts }
}

fn hidden_light(structure: Structure) -> Vec<Part> {
    let mut parts = base();
    parts.extend([
        part!("origin_sphere.wgsl"),
        part!("schedule.wgsl"),
        part!("spend.wgsl"),
        part!("brick.wgsl"),
        part!("trigonometry.wgsl"),
        part!("look.wgsl"),
        part!("sampling.wgsl"),
        part!("disk.wgsl"),
        part!("warp.wgsl"),
        part!("hidden_light.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    parts
}

/// In a studio, turns hits into surfaces.
pub(super) fn surface_kernel() -> Kernel {
    let mut parts = shading();
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
pub(super) fn scatter_kernel(surfaces: Surfaces, sources: Sources, sky: SkyKind) -> Kernel {
    let mut parts = shading();
    parts.extend([
        part!("sampling.wgsl"),
        part!("disk.wgsl"),
        part!("warp.wgsl"),
        part!("appearance.wgsl"),
        part!("vertex.wgsl"),
        part!("material.wgsl"),
        part!("surface_point.wgsl"),
        part!("emitters.wgsl"),
        part!("lamp.wgsl"),
        part!("by_chance.wgsl"),
        part!("bounce.wgsl"),
        part!("settle_path.wgsl"),
        part!("scatter.wgsl"),
    ]);
    match surfaces {
        Surfaces::Matt => {
            parts.extend([part!("medium_none.wgsl"), part!("scatter_matt.wgsl")]);
        }
        Surfaces::Any => parts.extend([
            part!("microfacet.wgsl"),
            part!("bsdf.wgsl"),
            part!("dielectric.wgsl"),
            part!("medium_glass.wgsl"),
            part!("scatter_any.wgsl"),
        ]),
    }
    match sources {
        Sources::None => parts.push(part!("direct_none.wgsl")),
        Sources::Any => parts.extend([part!("direct_light.wgsl"), part!("direct.wgsl")]),
    }
    match sky {
        SkyKind::Plain => parts.push(part!("sky_plain.wgsl")),
        SkyKind::Image => parts.extend(sky_image()),
    }
    Kernel { entry_point: "scatter", parts }
}

/// Adds samples to pixels.
pub(super) fn deposit_kernel(is_studio: bool) -> Kernel {
    let mut parts = base();
    parts.extend([part!("origin_none.wgsl"), part!("schedule.wgsl")]);
    parts.push(if is_studio { part!("settle_studio.wgsl") } else { part!("settle_path.wgsl") });
    parts.push(part!("deposit.wgsl"));
    Kernel { entry_point: "deposit", parts }
}

fn sky_image() -> Vec<Part> {
    vec![
        part!("turns.wgsl"),
        part!("trigonometry_inverse.wgsl"),
        part!("environment.wgsl"),
        part!("sky_image.wgsl"),
    ]
}

fn base() -> Vec<Part> {
    vec![
        part!("records.wgsl"),
        part!("light_records.wgsl"),
        part!("frame.wgsl"),
        part!("fence.wgsl"),
        part!("ray.wgsl"),
        part!("enter.wgsl"),
        part!("sphere.wgsl"),
        part!("path_state.wgsl"),
    ]
}

fn shading() -> Vec<Part> {
    let mut parts = base();
    parts.extend([
        part!("origin_none.wgsl"),
        part!("schedule.wgsl"),
        part!("trigonometry.wgsl"),
        part!("look.wgsl"),
    ]);
    parts
}

fn studio_light() -> Vec<Part> {
    let mut parts = shading();
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
    let mut kernels = Vec::new();
    for &camera in CameraKind::ALL {
        kernels.extend([true, false].map(|is_studio| start_kernel(camera, is_studio)));
    }
    for &structure in Structure::ALL {
        kernels.extend([Turn::First, Turn::Later].map(|turn| extend_kernel(structure, turn)));
        kernels.extend([occlude_kernel, shadow_kernel, ambient_kernel].map(|of| of(structure)));
    }
    for surfaces in [Surfaces::Matt, Surfaces::Any] {
        for sources in [Sources::None, Sources::Any] {
            for sky in [SkyKind::Plain, SkyKind::Image] {
                kernels.push(scatter_kernel(surfaces, sources, sky));
            }
        }
    }
    kernels.extend([surface_kernel(), illuminate_kernel(), gather_kernel()]);
    kernels.extend([true, false].map(deposit_kernel));
    kernels
}
