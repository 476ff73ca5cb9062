//! Brings parts of a scene to a device, and drops them when others need their place.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::accel::{AccelChoice, AccelPlan, BrickBounds, Structure};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::visible_bricks::space_of;
use crate::gpu::scene::brick_buffers::BrickBuffers;
use crate::gpu::scene::scene_buffers::{SceneBuffers, binding_limit};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::scene_upload::{BrickSource, BrickSpace, SceneUpload, UploadedBricks};
use crate::gpu::scene::shape_ids::{ExcludeBy, ShapeIds};
use crate::gpu::shader::records::SceneSpace;
use crate::image::color::LinearRgb;
use crate::scene::material::Material;
use crate::scene::{Appearance, PartExtent, SceneAppearance, ScenePart, SceneParts};

/// The parts of a scene, of which some are on a device.
pub(super) struct Loader<'a> {
    headless: &'a Headless,
    parts: &'a mut dyn SceneParts,
    extents: Vec<PartExtent>,
    /// The number, counted through all parts, of the first shape of each.
    firsts: Vec<u32>,
    /// What every part is built as.
    structure: Structure,
    exclude_by: ExcludeBy,
    layouts: Renderer,
    /// The box of the whole, in which all rays start.
    space: BrickSpace,
    /// What all spheres must be made of, in any colours.
    material: Arc<SceneAppearance>,
    /// What is on the device; the part that was used last is at the end.
    loaded: VecDeque<Loaded>,
    /// The bytes on the device that all of them may take together, apart from the last one.
    bytes_kept: u64,
}

/// A part on a device.
struct Loaded {
    part: usize,
    bricks: Vec<BrickBuffers>,
    bytes: u64,
}

impl<'a> Loader<'a> {
    /// Reads the largest part, and chooses the structure that suits it for all.
    pub(super) async fn open(
        headless: &'a Headless,
        parts: &'a mut dyn SceneParts,
        choice: AccelChoice,
        bytes_kept: u64,
    ) -> Result<Self, GpuError> {
        let extents = parts.extents();
        let largest = (0..extents.len()).max_by_key(|part| extents[*part].count).unwrap_or(0);
        let ScenePart { scene, .. } = read(parts, largest, extents.get(largest))?;
        // A brick without shapes, which shades what hits nothing, is the first, so shapes are counted from 1 on.
        let mut next = Some(1_u32);
        let mut first = |extent: &PartExtent| {
            let first = next?;
            next = first.checked_add(extent.count);
            next.and(Some(first))
        };
        let firsts: Option<Vec<u32>> = extents.iter().map(&mut first).collect();
        let firsts = firsts.ok_or_else(|| {
            let message = "all parts together have more spheres than ids of 32 bits".to_owned();
            GpuError::Part { part: largest, message }
        })?;
        let plan = headless.plan_accel(&scene, choice);
        // A part of several bricks may have equal spheres in different ones.
        let exclude_by = if plan.brick_count > 1 { ExcludeBy::Id } else { ExcludeBy::Index };
        let structure = plan.structure;
        let layouts = vec![structure, structure.with_nested(true), Structure::List];
        let layouts = headless.layouts_of(layouts).await?;
        let [surface] = scene.appearance().surfaces() else {
            return Err(GpuError::PartMaterials);
        };
        let material = Appearance::from(LinearRgb::WHITE).with_surface(*surface);
        let whole = parts.whole();
        let bounds = plan.within((whole.min, whole.max)).statistics.inflated_bounds();
        Ok(Self {
            headless,
            parts,
            extents,
            firsts,
            structure,
            exclude_by,
            layouts,
            space: BrickSpace { structure: structure.with_nested(true), bounds },
            material: Arc::new(SceneAppearance::new(material, 0)),
            loaded: VecDeque::new(),
            bytes_kept,
        })
    }

    pub(super) fn structure(&self) -> Structure {
        self.structure
    }

    /// The number of parts.
    pub(super) fn len(&self) -> usize {
        self.extents.len()
    }

    /// A scene with a single brick without shapes, and the space and the appearance of all parts.
    pub(super) async fn nothing(&self) -> Result<SceneBuffers, GpuError> {
        let (appearance, space) = (Arc::clone(&self.material), self.space);
        let (summary, ids) =
            (SceneSummary::of_part(self.parts.whole().origin(), appearance), ShapeIds::none());
        let (device, queue) = (self.headless.device(), self.headless.queue());
        let mut upload =
            SceneUpload::new(&self.layouts, device, queue, &summary, space, &ids).await?;
        upload.nothing().await?;
        let uploaded =
            UploadedBricks { bricks: upload.take_bricks(), ..UploadedBricks::none(space) };
        Ok(SceneBuffers::new_of(uploaded, summary, self.exclude_by, self.headless.shape()))
    }

    /// The box outside of which no ray hits a sphere of a part.
    pub(super) fn space_of(&self, scene: &SceneSpace, part: usize) -> Option<SceneSpace> {
        let PartExtent { min, max, .. } = self.extents[part];
        space_of(scene, &BrickBounds { center_min: min, center_max: max, min, max })
    }

    /// The part that has the shape with this number, counted through all parts; `None` if that is no shape.
    pub(super) fn part_of(&self, shape: u32) -> Option<usize> {
        self.firsts.partition_point(|first| *first <= shape).checked_sub(1)
    }

    /// Whether a part is on the device.
    pub(super) fn has(&self, part: usize) -> bool {
        self.loaded.iter().any(|loaded| loaded.part == part)
    }

    /// The bricks of a part. What was used the longest ago is dropped if there is not enough room, so the device must have
    /// finished with it.
    pub(super) async fn load(&mut self, part: usize) -> Result<&[BrickBuffers], GpuError> {
        let there = self.loaded.iter().position(|loaded| loaded.part == part);
        let loaded = match there.and_then(|at| self.loaded.remove(at)) {
            Some(loaded) => loaded,
            None => {
                self.make_room(part).await?;
                self.copied(part).await?
            }
        };
        self.loaded.push_back(loaded);
        Ok(self.loaded.back().map_or(&[], |loaded| &loaded.bricks))
    }

    /// Drops parts until there is room for another, which is expected to be as large as those that are there.
    async fn make_room(&mut self, part: usize) -> Result<(), GpuError> {
        let count = |part: usize| u64::from(self.extents[part].count);
        let per_sphere = |of: &Loaded| of.bytes.div_ceil(count(of.part).max(1));
        let most = self.loaded.iter().map(per_sphere).max().unwrap_or(0);
        let needed = count(part) * most;
        let mut kept: u64 = self.loaded.iter().map(|loaded| loaded.bytes).sum();
        while kept.saturating_add(needed) > self.bytes_kept
            && let Some(oldest) = self.loaded.pop_front()
        {
            kept -= oldest.bytes;
        }
        self.headless.flush().await
    }

    async fn copied(&mut self, part: usize) -> Result<Loaded, GpuError> {
        let Self { headless, exclude_by, structure, .. } = *self;
        let phase = headless.phase("read");
        let whole = self.parts.whole();
        let ScenePart { scene, ids } = read(self.parts, part, self.extents.get(part))?;
        drop(phase);
        let appearance = Arc::clone(scene.checked_appearance());
        check_material(&appearance, &self.material)?;
        let phase = headless.phase("build");
        let binding = binding_limit(&headless.device().limits());
        let plan =
            AccelPlan::of(scene.spheres(), structure, binding).within((whole.min, whole.max));
        let ids = ShapeIds::of_all(&scene, exclude_by == ExcludeBy::Id).of_part(ids);
        let BrickSource { space, bricks, .. } = BrickSource::from(plan.bricks(scene.spheres()));
        drop(phase);
        let summary = SceneSummary::of_part(scene.origin(), appearance);
        let (device, queue) = (headless.device(), headless.queue());
        let upload = SceneUpload::new(&self.layouts, device, queue, &summary, space, &ids).await?;
        let mut upload = upload.counted_from(self.firsts[part]);
        for brick in bricks {
            let _phase = headless.phase("upload");
            upload.brick(&brick).await?;
            drop(brick);
            for work in upload.take_work() {
                headless.start(work);
            }
            headless.flush().await?;
        }
        let (bricks, bytes) = (upload.take_bricks(), upload.bytes());
        Ok(Loaded { part, bricks, bytes })
    }
}

/// Reads a part and compares it with what is known of it.
fn read(
    parts: &mut dyn SceneParts,
    part: usize,
    extent: Option<&PartExtent>,
) -> Result<ScenePart, GpuError> {
    let failed = |message| GpuError::Part { part, message };
    let read = parts.read(part).map_err(failed)?;
    let count = read.scene.len();
    let bounds = BrickBounds::of_spheres(read.scene.spheres());
    let is_inside = |extent: &PartExtent| {
        bounds.min.cmpge(extent.min).all() && bounds.max.cmple(extent.max).all()
    };
    let has_count = |extent: &PartExtent| extent.count as usize == count && count > 0;
    let is_as_said = extent.is_some_and(|extent| has_count(extent) && is_inside(extent))
        && read.scene.whole() == Some(parts.whole())
        && read.ids.len() == count
        && read.ids.is_sorted_by(|a, b| a < b);
    let wrong = || failed("it is of another scene, or has other spheres than was said".to_owned());
    is_as_said.then_some(read).ok_or_else(wrong)
}

/// Refuses a part unless all its spheres are made of one material, which is opaque and does not shine.
fn check_material(part: &SceneAppearance, material: &SceneAppearance) -> Result<(), GpuError> {
    let shines = |of: &SceneAppearance| {
        of.surfaces().iter().any(|surface| matches!(surface.material, Material::Emissive { .. }))
    };
    let is_one = part.surfaces() == material.surfaces()
        && part.material_rows() == material.material_rows()
        && part.is_opaque()
        && !shines(part);
    is_one.then_some(()).ok_or(GpuError::PartMaterials)
}
