//! One sample of every pixel of a tile.

use std::ops::Range;

use wgpu::ComputePipeline;

use super::look::Lit;
use super::recording::Moment;
use super::records::Stage;
use super::renderer::Shaders;
use super::run::Run;
use crate::gpu::error::GpuError;
use crate::gpu::tiles::Tile;
use crate::render::{Integrator, RenderSettings, Studio};

/// How many lights are searched before they are added: each has a bit.
const BITS: usize = 32;

impl Run<'_> {
    /// Traces some samples of a tile, and reads their sums.
    pub(super) fn batch(
        &mut self,
        samples: Range<u32>,
        lit: &Lit,
        lighting: &RenderSettings,
        tile: Tile,
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let buffers = self.tile;
        buffers.record_clear(self.encoder());
        for sample in samples {
            self.sample(sample, lit, lighting)?;
        }
        buffers.record_copy_status(self.encoder());
        buffers.record_copy_film(self.encoder());
        self.run_gathered(&[buffers.status_back.buffer(), buffers.film_back.buffer()])?;
        let spent = buffers.status_back.read(|words: &[u32]| words[0])?;
        let used = 2 * tile.size[0] as usize * tile.size[1] as usize;
        let sums = buffers.film_back.read(|sums: &[[f32; 4]]| sums[..used].to_vec())?;
        if spent == 0 { Ok(sums) } else { Err(GpuError::Steps) }
    }

    /// Traces a sample, and adds it to the tile's sums.
    pub(super) fn sample(
        &mut self,
        sample: u32,
        lit: &Lit,
        lighting: &RenderSettings,
    ) -> Result<(), GpuError> {
        let stage = Stage { sample, surface: 0, is_last: 0, light: 0, count: 0 };
        let renderer = self.renderer;
        let surface = &self.scene.bricks()[0].surface_group;
        self.shade(&renderer.start, true, surface, stage)?;
        self.keep(Moment::Started)?;
        match &lighting.integrator {
            // No sample of a lit picture.
            Integrator::Primary(_) => {}
            Integrator::Studio(studio) => self.studio(stage, lit, studio)?,
            Integrator::Path(path) => self.path(stage, lit, path.max_depth)?,
        }
        self.deposit(stage)?;
        self.keep(Moment::Deposited)
    }

    fn studio(&mut self, stage: Stage, lit: &Lit, studio: &Studio) -> Result<(), GpuError> {
        let Shaders::Studio { surface, shadow, illuminate, ambient, gather } = &self.renderer.shade
        else {
            return Err(GpuError::OtherRenderer);
        };
        let scene = self.scene;
        let surfaces = if lit.is_opaque { 1 } else { studio.max_surfaces };
        let lights = lit.casts_shadow.len() as u32;
        let directions = studio.occlusion.map_or(0, |occlusion| occlusion.samples);
        for number in 0..surfaces {
            let is_last = u32::from(number + 1 == surfaces);
            let stage = Stage { surface: number, is_last, ..stage };
            if !self.extend(stage)? {
                break;
            }
            self.shade_bricks(surface, stage)?;
            for light in (0..lights).step_by(BITS) {
                let count = (lights - light).min(BITS as u32);
                for light in
                    (light..light + count).filter(|light| lit.casts_shadow[*light as usize])
                {
                    if studio.has_shadows {
                        self.search_occluders(shadow, Stage { light, ..stage })?;
                    }
                }
                let first = &scene.bricks()[0].surface_group;
                let stage = Stage { light, count, ..stage };
                self.shade(illuminate, false, first, stage)?;
            }
            for light in (0..directions).step_by(BITS) {
                let count = (directions - light).min(BITS as u32);
                for light in light..light + count {
                    self.search_occluders(ambient, Stage { light, ..stage })?;
                }
                let first = &scene.bricks()[0].surface_group;
                let stage = Stage { light, count, ..stage };
                self.shade(gather, false, first, stage)?;
            }
        }
        Ok(())
    }

    fn path(&mut self, stage: Stage, lit: &Lit, max_depth: u32) -> Result<(), GpuError> {
        let Shaders::Path { scatter, occlude } = &self.renderer.shade else {
            return Err(GpuError::OtherRenderer);
        };
        for surface in 0..=max_depth {
            let stage = Stage { surface, is_last: u32::from(surface == max_depth), ..stage };
            if !self.extend(stage)? {
                break;
            }
            self.keep(Moment::Traced)?;
            self.shade_bricks(scatter, stage)?;
            self.keep(Moment::Scattered)?;
            if lit.look.source_count > 0 && surface < max_depth {
                self.search_occluders(occlude, stage)?;
                self.keep(Moment::Occluded)?;
            }
        }
        Ok(())
    }

    /// A dispatch for every brick: each shades what it holds.
    fn shade_bricks(&mut self, pipeline: &ComputePipeline, stage: Stage) -> Result<(), GpuError> {
        let scene = self.scene;
        for brick in scene.bricks() {
            // What the camera sees beside the scene is background.
            self.shade(pipeline, stage.surface == 0, &brick.surface_group, stage)?;
        }
        Ok(())
    }

    /// A dispatch for every brick of what casts shadows.
    fn search_occluders(
        &mut self,
        pipeline: &ComputePipeline,
        stage: Stage,
    ) -> Result<(), GpuError> {
        let (tile, occluders) = (self.tile, self.occluders);
        for brick in occluders.bricks() {
            self.search(pipeline, &tile.search[1], &brick.trace_group, stage)?;
        }
        Ok(())
    }

    /// Traces the rays of all paths. Whether there are any.
    fn extend(&mut self, stage: Stage) -> Result<bool, GpuError> {
        let tile = self.tile;
        if stage.surface > 0 {
            tile.record_clear_alive(self.encoder());
        }
        let [first, later] = &self.renderer.extend;
        for (turn, brick) in self.scene.bricks().iter().enumerate() {
            let pipeline = if turn == 0 { first } else { later };
            self.search(pipeline, &tile.search[0], &brick.trace_group, stage)?;
        }
        // The camera's rays are worth tracing without asking.
        Ok(stage.surface == 0 || self.is_alive()?)
    }
}
