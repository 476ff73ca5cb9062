//! What lit pictures need of a scene beside its buffers, so that the host's scene need not be at hand.

use std::sync::Arc;

use glam::DVec3;

use crate::image::color::LinearRgb;
use crate::light::emitters::Emitters;
use crate::scene::material::SurfaceProperties;
use crate::scene::{Scene, SceneAppearance};

/// Palette, surfaces and emissive spheres of a scene.
#[derive(Debug)]
pub(super) struct SceneSummary {
    /// Of the scene's frame, in the world.
    pub(super) origin: DVec3,
    pub(super) appearance: Arc<SceneAppearance>,
    pub(super) emitters: Emitters,
    /// The spheres of `emitters`, in the same order.
    pub(super) emissive: Vec<EmissiveSphere>,
}

/// A sphere that sends out light.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmissiveSphere {
    /// Centre in the scene's frame, and radius.
    pub(super) sphere: [f32; 4],
    pub(super) color: LinearRgb,
    pub(super) surface: SurfaceProperties,
}

impl SceneSummary {
    pub(super) fn of(scene: &Scene) -> Self {
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

    /// Of a structure for shadows: nothing of it is seen.
    pub(super) fn of_occluders(scene: &Scene) -> Self {
        Self {
            origin: scene.origin(),
            appearance: Arc::new(SceneAppearance::new(LinearRgb::WHITE.into(), 0)),
            emitters: Emitters::default(),
            emissive: Vec::new(),
        }
    }

    /// Whether every sphere is opaque.
    pub(super) fn is_opaque(&self) -> bool {
        self.appearance.is_opaque()
    }
}
