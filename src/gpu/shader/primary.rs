//! The kernels of primary rays, and the choices that kernels have: structures, cameras and targets.

use super::kernel::{Constant, Kernel};
use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::shader::formats::ColorTarget;

/// Whether a brick is the first one that is traced for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum BrickPass {
    First,
    Later,
}

impl BrickPass {
    pub(crate) fn constant(self) -> Constant {
        ("IS_LATER_BRICK", u32::from(self == Self::Later))
    }
}

/// The kernel that finds the nearest sphere of every ray, and may record the rays.
pub(crate) fn trace_kernel(camera: CameraKind, kind: BrickKind, brick_pass: BrickPass, keeps_rays: bool) -> Kernel {
    let entry = if keeps_rays { "primary/entry.wgsl#recorded" } else { "primary/entry.wgsl#made" };
    entered_kernel(camera, kind, brick_pass, entry)
}

/// The kernel that finds the nearest sphere of every ray and probes fences. The self-test makes it from the kernel that
/// records rays (`gpu/self_test/fence_probe.rs`).
pub(crate) fn probe_kernel() -> Kernel {
    let kind = BrickKind { structure: Structure::Grid, primitive: Primitive::Sphere };
    entered_kernel(CameraKind::Pinhole, kind, BrickPass::First, "primary/entry.wgsl#probed")
}

fn entered_kernel(camera: CameraKind, kind: BrickKind, brick_pass: BrickPass, entry: &'static str) -> Kernel {
    let shape = ("$shape", primitive_part(kind.primitive));
    let kernel = match kind.structure {
        Structure::Tiles => Kernel::new("trace_tile", &[shape, ("$entry", entry)]),
        _ => Kernel::new("trace", &[shape, structure_choice(kind), ("$entry", entry)]),
    };
    kernel.with([camera_constant(camera), brick_pass.constant()])
}

/// The choice of the parts that traverse a structure of these shapes.
pub(crate) fn structure_choice(kind: BrickKind) -> (&'static str, &'static str) {
    let list = match (kind.structure, kind.primitive) {
        // Only camera rays are found by tiles.
        (Structure::List | Structure::Tiles, _) => "list",
        (Structure::RayQuery, _) => "ray-query",
        (Structure::WideTree, _) => "wide-tree",
        (Structure::Grid, Primitive::Sphere) => "grid",
        (Structure::NestedGrid, Primitive::Sphere) => "nested-grid",
        (Structure::Grid, Primitive::Cone) => "cone-grid",
        (Structure::NestedGrid, Primitive::Cone) => "nested-cone-grid",
    };
    ("$structure", list)
}

/// The choice of the part that writes data layers, if there are any.
pub(crate) fn data_layers_choice(are_written: bool) -> (&'static str, &'static str) {
    let all = "primary/data_layers.wgsl#all";
    ("$data", if are_written { all } else { "primary/data_layers.wgsl#none" })
}

/// The choice of the part that writes colours.
pub(crate) fn color_target_choice(color: ColorTarget) -> (&'static str, &'static str) {
    let part = match color {
        ColorTarget::Srgb8 => "primary/color_target.wgsl#rgba8unorm",
        ColorTarget::Linear16 => "primary/color_target.wgsl#rgba16float",
        ColorTarget::Linear32 => "primary/color_target.wgsl#rgba32float",
    };
    ("$color", part)
}

/// The kernel that computes colours and, if requested, data layers from hits.
pub(crate) fn shade_kernel(
    camera: CameraKind,
    primitive: Primitive,
    color: ColorTarget,
    has_data: bool,
    keeps_rays: bool,
) -> Kernel {
    let recorded = "primary/shade_entry.wgsl#recorded";
    let entry = if keeps_rays { recorded } else { "primary/shade_entry.wgsl#made" };
    let (shape, entry) = (("$shape", primitive_part(primitive)), ("$shade-entry", entry));
    Kernel::new("shade", &[shape, entry, color_target_choice(color), data_layers_choice(has_data)])
        .with([camera_constant(camera)])
}

/// The choices of kernels of lit pictures: the parts of these shapes, what rays exclude from their search, and the structure.
pub(crate) fn lit_choices(kind: BrickKind) -> [(&'static str, &'static str); 4] {
    let (place, excluded) = match kind.primitive {
        Primitive::Sphere => ("path/sphere_place.wgsl", "excluded-with-light"),
        Primitive::Cone => ("path/cone_place.wgsl", "excluded"),
    };
    [("$shape", primitive_part(kind.primitive)), ("$place", place), ("$excluded", excluded), structure_choice(kind)]
}

/// The part that provides `Shape`, `intersect` and `shape_normal` for a primitive.
fn primitive_part(primitive: Primitive) -> &'static str {
    match primitive {
        Primitive::Sphere => "scene/sphere.wgsl",
        Primitive::Cone => "cone",
    }
}

/// The constant that chooses a camera.
pub(crate) fn camera_constant(camera: CameraKind) -> Constant {
    ("CAMERA", camera as u32)
}
