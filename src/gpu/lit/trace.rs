//! One sample of every pixel of a tile.

use std::ops::Range;

use super::look::Lit;
use super::recording::Moment;
use super::records::Stage;
use super::renderer::Shaders;
use super::run::Run;
use crate::gpu::error::GpuError;
use crate::gpu::tiles::Tile;
use crate::lighting::{Integrator, Lighting, Studio};

impl Run<'_> {
    /// Traces some samples of a tile, and reads their sums.
    pub(super) fn batch(
        &mut self,
        samples: Range<u32>,
        lit: &Lit,
        lighting: &Lighting,
        tile: Tile,
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let buffers = self.tile;
        buffers.record_clear(self.encoder());
        for sample in samples {
            self.sample(sample, lit, lighting)?;
        }
        buffers.record_copy_status(self.encoder());
        buffers.record_copy_film(self.encoder());
        self.submit(&[buffers.status_back.buffer(), buffers.film_back.buffer()])?;
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
        lighting: &Lighting,
    ) -> Result<(), GpuError> {
        let stage = Stage { sample, surface: 0, light: 0, is_last: 0 };
        let (renderer, tile) = (self.renderer, self.tile);
        let surface = &self.scene.bricks()[0].surface_group;
        self.shade(&renderer.start, &tile.shade, Some(surface), stage)?;
        self.keep(Moment::Started)?;
        match &lighting.integrator {
            Integrator::Studio(studio) => self.studio(stage, lit, studio)?,
            Integrator::Path(path) => self.path(stage, lit, path.max_depth)?,
        }
        self.shade(&renderer.deposit, &tile.deposit, None, stage)?;
        self.keep(Moment::Deposited)
    }

    fn studio(&mut self, stage: Stage, lit: &Lit, studio: &Studio) -> Result<(), GpuError> {
        let Shaders::Studio { surface, illuminate, ambient } = &self.renderer.shade else {
            return Err(GpuError::OtherRenderer);
        };
        let (tile, scene) = (self.tile, self.scene);
        let surfaces = if lit.is_opaque { 1 } else { studio.max_surfaces };
        let directions = studio.occlusion.map_or(0, |occlusion| occlusion.samples);
        let first = &scene.bricks()[0].surface_group;
        for number in 0..surfaces {
            let is_last = u32::from(number + 1 == surfaces);
            let stage = Stage { surface: number, is_last, ..stage };
            if !self.extend(stage)? {
                break;
            }
            for brick in scene.bricks() {
                self.shade(surface, &tile.shade, Some(&brick.surface_group), stage)?;
            }
            for (light, casts) in (0..).zip(&lit.casts_shadow) {
                let stage = Stage { light, ..stage };
                self.shade(illuminate, &tile.shade, Some(first), stage)?;
                if *casts && studio.has_shadows {
                    self.occlude(stage)?;
                }
            }
            for direction in 0..directions {
                let stage = Stage { light: lit.casts_shadow.len() as u32 + direction, ..stage };
                self.shade(ambient, &tile.shade, Some(first), stage)?;
                self.occlude(stage)?;
            }
        }
        Ok(())
    }

    fn path(&mut self, stage: Stage, lit: &Lit, max_depth: u32) -> Result<(), GpuError> {
        let Shaders::Path { scatter } = &self.renderer.shade else {
            return Err(GpuError::OtherRenderer);
        };
        let (tile, scene) = (self.tile, self.scene);
        for surface in 0..=max_depth {
            let stage = Stage { surface, is_last: u32::from(surface == max_depth), ..stage };
            if !self.extend(stage)? {
                break;
            }
            self.keep(Moment::Traced)?;
            for brick in scene.bricks() {
                self.shade(scatter, &tile.shade, Some(&brick.surface_group), stage)?;
            }
            self.keep(Moment::Scattered)?;
            if lit.look.source_count > 0 && surface < max_depth {
                self.occlude(stage)?;
                self.keep(Moment::Occluded)?;
            }
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

    fn occlude(&mut self, stage: Stage) -> Result<(), GpuError> {
        let (renderer, tile) = (self.renderer, self.tile);
        for brick in self.occluders.bricks() {
            self.search(&renderer.occlude, &tile.search[1], &brick.trace_group, stage)?;
        }
        Ok(())
    }
}
