//! The kernels of primary rays and of the self-test, as lists of parts.

use super::kernel::{Constant, Kernel};
use super::part::{Part, part};
use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::{CameraKind, camera_table};
use crate::gpu::shader::formats::ColorTarget;

/// Whether a brick is the first that is traced for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BrickPass {
    First,
    Later,
}

impl BrickPass {
    pub(in crate::gpu) fn constant(self) -> Constant {
        ("IS_LATER_BRICK", u32::from(self == Self::Later))
    }
}

/// The operations that a kernel of the self-test executes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gpu) enum Probe {
    /// Operations whose results may be rounded.
    Arithmetic,
    /// Operations whose results must be exact.
    Exact,
    /// Long loops.
    Loops,
}

/// The kernel that finds the nearest sphere of every ray, and may record the rays.
pub(in crate::gpu) fn trace_kernel(
    camera: CameraKind,
    kind: BrickKind,
    brick_pass: BrickPass,
    keeps_rays: bool,
) -> Kernel {
    let mut parts = walk_parts(kind);
    parts.push(match keeps_rays {
        false => part!("primary/entry.wgsl", "made"),
        true => part!("primary/entry.wgsl", "recorded"),
    });
    parts.push(part!("primary/trace.wgsl"));
    Kernel::new("trace", parts).with([camera_constant(camera), brick_pass.constant()])
}

/// The kernel that finds the nearest sphere of every ray and probes fences, which the self-test makes of the one that
/// records rays (`gpu/self_test/fence_probe.rs`).
pub(in crate::gpu) fn probe_kernel() -> Kernel {
    let kind = BrickKind { structure: Structure::Grid, primitive: Primitive::Sphere };
    let mut parts = walk_parts(kind);
    parts.extend([part!("primary/entry.wgsl", "probed"), part!("primary/trace.wgsl")]);
    let camera = camera_constant(CameraKind::Pinhole);
    Kernel::new("trace", parts).with([camera, BrickPass::First.constant()])
}

fn walk_parts(BrickKind { structure, primitive }: BrickKind) -> Vec<Part> {
    let mut parts = common_parts(primitive);
    parts.extend([
        part!("primary/schedule.wgsl"),
        part!("primary/status.wgsl"),
        part!("accel/spend.wgsl"),
        part!("accel/excluded.wgsl", "none"),
        part!("accel/brick.wgsl"),
        part!("primary/hit_before.wgsl"),
    ]);
    parts.extend(structure_parts(structure));
    parts
}

/// The parts that traverse a structure.
pub(in crate::gpu) fn structure_parts(structure: Structure) -> Vec<Part> {
    match structure {
        Structure::List => vec![part!("accel/list.wgsl")],
        Structure::RayQuery => vec![part!("accel/ray_query.wgsl")],
        Structure::WideTree => vec![
            part!("accel/slab.wgsl"),
            part!("accel/leaf.wgsl"),
            part!("accel/wide_group.wgsl"),
            part!("accel/wide_node.wgsl"),
            part!("accel/wide_tree.wgsl"),
        ],
        Structure::Grid => vec![
            part!("accel/grid_ray.wgsl"),
            part!("accel/cell_words.wgsl"),
            part!("accel/ball_grid.wgsl"),
            part!("accel/balls.wgsl"),
            part!("accel/ball_list.wgsl"),
        ],
        Structure::NestedGrid => vec![
            part!("accel/grid_ray.wgsl"),
            part!("accel/cell_words.wgsl"),
            part!("accel/nested_grid.wgsl"),
            part!("accel/nested_ball_cell.wgsl"),
            part!("accel/balls.wgsl"),
            part!("accel/ball_list.wgsl"),
        ],
    }
}

/// The part that writes data layers, if there are any.
pub(in crate::gpu) fn data_layers(are_written: bool) -> Part {
    if are_written {
        part!("primary/data_layers.wgsl", "all")
    } else {
        part!("primary/data_layers.wgsl", "none")
    }
}

/// The part that writes colours.
pub(in crate::gpu) fn color_target(color: ColorTarget) -> Part {
    match color {
        ColorTarget::Srgb8 => part!("primary/color_target.wgsl", "rgba8unorm"),
        ColorTarget::Linear16 => part!("primary/color_target.wgsl", "rgba16float"),
        ColorTarget::Linear32 => part!("primary/color_target.wgsl", "rgba32float"),
    }
}

/// The kernel that computes colours and, if requested, data layers from hits.
pub(in crate::gpu) fn shade_kernel(
    camera: CameraKind,
    primitive: Primitive,
    color: ColorTarget,
    data_layers: bool,
    keeps_rays: bool,
) -> Kernel {
    let mut parts = common_parts(primitive);
    parts.extend([
        part!("scene/appearance_words.wgsl", "alone"),
        part!("scene/appearance.wgsl"),
        match keeps_rays {
            true => part!("primary/shade_entry.wgsl", "recorded"),
            false => part!("primary/shade_entry.wgsl", "made"),
        },
        part!("primary/shade.wgsl"),
        part!("primary/shading.wgsl"),
        color_target(color),
        self::data_layers(data_layers),
    ]);
    Kernel::new("shade", parts).with([camera_constant(camera)])
}

/// The kernel of the self-test that executes some operations.
pub(in crate::gpu) fn self_test_kernel(probe: Probe) -> Kernel {
    let (entry_point, part) = match probe {
        Probe::Arithmetic => ("arithmetic", part!("self_test/arithmetic.wgsl")),
        Probe::Exact => ("exact", part!("self_test/exact.wgsl")),
        Probe::Loops => ("loops", part!("self_test/loops.wgsl")),
    };
    let parts = vec![part!("self_test/records.wgsl"), part!("math/fence.wgsl"), part];
    Kernel::new(entry_point, parts)
}

/// The part of a primitive, which provides `Shape`, `intersect` and `shape_normal`.
fn primitive_part(primitive: Primitive) -> Part {
    match primitive {
        Primitive::Sphere => part!("scene/sphere.wgsl"),
    }
}

fn common_parts(primitive: Primitive) -> Vec<Part> {
    let mut parts = vec![
        part!("scene/records.wgsl"),
        part!("scene/frame.wgsl"),
        part!("primary/hits.wgsl"),
        part!("math/fence.wgsl"),
        part!("camera/film.wgsl"),
        part!("camera/ray.wgsl"),
        part!("scene/enter.wgsl"),
        part!("camera/entry.wgsl"),
        primitive_part(primitive),
    ];
    parts.extend(camera_parts());
    parts
}

/// The parts of all cameras, including the functions that cameras use.
pub(in crate::gpu) fn camera_parts() -> Vec<Part> {
    let mut parts = vec![part!("math/trigonometry.wgsl"), part!("math/disk.wgsl")];
    parts.extend(camera_rays());
    parts
}

/// The constant that chooses a camera.
pub(in crate::gpu) fn camera_constant(camera: CameraKind) -> Constant {
    ("CAMERA", camera as u32)
}

macro_rules! define_camera_rays {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        /// The parts of all cameras, and that which chooses among them.
        pub(in crate::gpu) fn camera_rays() -> Vec<Part> {
            vec![part!("camera/camera_ray.wgsl"), $(Part::whole(
                concat!("camera/", $name, ".wgsl"),
                include_str!(concat!(
                    env!("CARGO_MANIFEST_DIR"),
                    "/shaders/camera/",
                    $name,
                    ".wgsl"
                )),
            ),)+]
        }
    };
}
camera_table!(define_camera_rays);
