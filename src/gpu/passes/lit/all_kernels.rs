//! All kernels of lit pictures that can be composed.

use super::kernels::{
    Materials, Mode, Schedule, SkyKind, Sources, accumulate_kernel, advance_kernel, ambient_kernel,
    extend_kernel, gather_kernel, illuminate_kernel, noise_kernel, occlude_kernel, scatter_kernel,
    shadow_kernel, start_kernel, surface_kernel,
};
use super::live::live_kernels;
use super::one_pass::OnePass;
use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::scene::shape_ids::ExcludeBy;
use crate::gpu::shader::{BrickPass, Kernel};

/// Returns one kernel for every camera, structure, kind of lighting and schedule.
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
        kernels.extend(modes.iter().map(|mode| occlude_kernel(structure, exclude_by, *mode)));
        kernels.extend([shadow_kernel, ambient_kernel].map(|of| of(structure, exclude_by)));
    }
    kernels.extend(live_kernels());
    kernels.extend(SCHEDULES.map(surface_kernel));
    kernels
}
