//! The kernels that take whole samples of scenes of one brick, each in one dispatch.

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::passes::lit::kernels::{
    Materials, Mode, SkyKind, Sources, base, excluded_with_light, light_search, sampled_search,
    scattering,
};
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::{Kernel, camera_constant, camera_rays, part};

/// The pictures of which one pass takes whole samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum OnePass {
    /// A studio of opaque spheres with lamps at the eye or infinitely far away, without a size and without shadows; all
    /// surfaces are matt, and there is no ground.
    Sharp,
    /// A studio of opaque spheres with any lamps without a ground.
    Lamps,
    /// A studio of opaque spheres with any lamps and a ground.
    Ground,
    /// Paths under a sky without an image.
    Paths(Materials, Sources),
}

impl OnePass {
    /// All of them.
    pub(crate) const ALL: [Self; 7] = [
        Self::Sharp,
        Self::Lamps,
        Self::Ground,
        Self::Paths(Materials::Matt, Sources::None),
        Self::Paths(Materials::Matt, Sources::Any),
        Self::Paths(Materials::Any, Sources::None),
        Self::Paths(Materials::Any, Sources::Any),
    ];

    /// Whether the samples are paths.
    pub(super) fn is_paths(self) -> bool {
        matches!(self, Self::Paths(..))
    }

    /// The kernel for a camera and a structure.
    pub(super) fn kernel(
        self,
        camera: CameraKind,
        structure: Structure,
        exclude_by: ExcludeBy,
    ) -> Kernel {
        match self {
            Self::Paths(materials, sources) => {
                paths_kernel(camera, structure, exclude_by, materials, sources)
            }
            studio => studio_kernel(camera, structure, exclude_by, studio),
        }
    }
}

/// Whether a kernel may have all buffers that one pass over whole samples needs: the status word, the sums, the tables,
/// two of the appearance, and those of the structure.
pub(super) fn one_pass_fits(structure: Structure, limits: &wgpu::Limits) -> bool {
    let of_structure = if structure == Structure::List { 2 } else { 3 };
    5 + of_structure <= limits.max_storage_buffers_per_shader_stage
}

/// The kernel of studios of opaque spheres in one brick.
fn studio_kernel(
    camera: CameraKind,
    structure: Structure,
    exclude_by: ExcludeBy,
    studio: OnePass,
) -> Kernel {
    let mut parts = base();
    parts.extend(light_search(structure));
    // The functions that cameras use are among the parts of lights.
    parts.extend(camera_rays());
    parts.extend([
        part!("camera/filter.wgsl"),
        part!("camera/film_sample.wgsl"),
        part!("scene/appearance_words.wgsl", "beside-structure"),
        part!("scene/appearance.wgsl"),
        part!("path/vertex.wgsl"),
        part!("scene/material.wgsl"),
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("scene/lamp.wgsl"),
        part!("studio/faded.wgsl"),
        part!("studio/seen.wgsl"),
        part!("studio/ambient_light.wgsl"),
        part!("studio/one_surface.wgsl"),
        part!("studio/one_pass.wgsl"),
        part!("path/microfacet.wgsl"),
        part!("studio/reflected.wgsl"),
        part!("studio/lamp_light.wgsl"),
        part!("studio/catcher.wgsl"),
        part!("studio/one_ground.wgsl"),
    ]);
    Kernel::new("one_pass", parts).with([
        camera_constant(camera),
        exclude_by.constant(),
        ("IS_SHARP", u32::from(studio == OnePass::Sharp)),
        ("HAS_GROUND", u32::from(studio == OnePass::Ground)),
    ])
}

/// The kernel of paths in one brick.
fn paths_kernel(
    camera: CameraKind,
    structure: Structure,
    exclude_by: ExcludeBy,
    materials: Materials,
    sources: Sources,
) -> Kernel {
    let mut parts = base();
    parts.extend(sampled_search(structure, excluded_with_light()));
    parts.extend([
        part!("scene/emitter.wgsl"),
        part!("camera/filter.wgsl"),
        part!("camera/film_sample.wgsl"),
        part!("scene/appearance_words.wgsl", "beside-structure"),
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        part!("path/first_hit.wgsl"),
        part!("path/seen_light.wgsl"),
        part!("path/begin_path.wgsl"),
        part!("path/whole_paths.wgsl"),
    ]);
    // The functions that cameras use are among the other parts.
    parts.extend(camera_rays());
    parts.extend(scattering(SkyKind::Plain));
    Kernel::new("whole_paths", parts)
        .with(Mode::Path(materials, sources, SkyKind::Plain).constants())
        .with([camera_constant(camera), exclude_by.constant()])
}
