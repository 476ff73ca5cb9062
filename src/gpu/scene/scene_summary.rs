//! The data of a scene, besides its buffers, that pictures need. With them the host's scene can be dropped after the
//! upload.

use std::sync::Arc;

use glam::DVec3;

use crate::image::color::LinearRgb;
use crate::light::emitters::Emitters;
use crate::scene::material::SurfaceProperties;
use crate::scene::{Scene, SceneAppearance};

/// Palette, surfaces and emissive spheres of a scene.
#[derive(Debug)]
pub(in crate::gpu) struct SceneSummary {
    /// Origin of the scene's frame, in world space.
    pub(in crate::gpu) origin: DVec3,
    pub(in crate::gpu) appearance: Arc<SceneAppearance>,
    pub(in crate::gpu) emitters: Emitters,
    /// The spheres of `emitters`, in the same order.
    pub(in crate::gpu) emissive: Vec<EmissiveSphere>,
}

/// A sphere that emits light.
#[derive(Clone, Copy, Debug)]
pub(in crate::gpu) struct EmissiveSphere {
    /// Centre in the scene's frame, and radius.
    pub(in crate::gpu) sphere: [f32; 4],
    pub(in crate::gpu) color: LinearRgb,
    pub(in crate::gpu) surface: SurfaceProperties,
}

impl SceneSummary {
    /// Bytes of an emissive sphere.
    pub(in crate::gpu) const BYTES_PER_EMITTER: u64 = 8 + size_of::<EmissiveSphere>() as u64;

    pub(in crate::gpu) fn of(scene: &Scene) -> Self {
        let emitters = Emitters::of(scene);
        let emissive = |id: &u32| EmissiveSphere {
            sphere: scene.spheres()[*id as usize],
            color: scene.color(*id),
            surface: scene.surface(*id),
        };
        Self {
            origin: scene.origin(),
            appearance: Arc::clone(scene.checked_appearance()),
            emissive: emitters.ids().iter().map(emissive).collect(),
            emitters,
        }
    }

    /// The summary for a structure of occluders, whose appearance is never used.
    pub(in crate::gpu) fn of_occluders(scene: &Scene) -> Self {
        Self {
            origin: scene.origin(),
            appearance: Arc::new(SceneAppearance::new(LinearRgb::WHITE.into(), 0)),
            emitters: Emitters::default(),
            emissive: Vec::new(),
        }
    }

    /// Whether every sphere is opaque.
    pub(in crate::gpu) fn is_opaque(&self) -> bool {
        self.appearance.is_opaque()
    }
}
