//! Dispatches of lit pictures, gathered into submissions that are neither too short nor too long.

use std::time::Instant;

use wgpu::{BindGroup, CommandEncoder, ComputePassDescriptor, ComputePipeline};

use super::recording::Keeper;
use super::records::Stage;
use super::renderer::LitRenderer;
use super::tile::{FRAMES, MOST_STAGES, TileBuffers};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::records::Frame;
use crate::gpu::scene_buffers::SceneBuffers;
use crate::gpu::tiles::Groups;

/// One tile's dispatches.
pub(super) struct Run<'a> {
    pub(super) headless: &'a Headless,
    pub(super) renderer: &'a LitRenderer,
    pub(super) tile: &'a TileBuffers,
    pub(super) scene: &'a SceneBuffers,
    pub(super) occluders: &'a SceneBuffers,
    /// Of all of the tile; of where the scene may be seen; the same for what casts shadows.
    pub(super) frames: [Frame; FRAMES],
    encoder: Option<CommandEncoder>,
    stages: Vec<Stage>,
    /// Workgroups of searches in the encoder.
    gathered: u64,
    /// Told after every submission.
    pub(super) after: &'a mut dyn FnMut() -> Result<(), GpuError>,
    /// What keeps the paths, if they are recorded.
    pub(super) keeper: Option<&'a mut Keeper>,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        headless: &'a Headless,
        renderer: &'a LitRenderer,
        tile: &'a TileBuffers,
        [scene, occluders]: [&'a SceneBuffers; 2],
        frames: [Frame; FRAMES],
        after: &'a mut dyn FnMut() -> Result<(), GpuError>,
    ) -> Self {
        let (encoder, stages, gathered) = (None, Vec::new(), 0);
        Self {
            headless,
            renderer,
            tile,
            scene,
            occluders,
            frames,
            encoder,
            stages,
            gathered,
            after,
            keeper: None,
        }
    }

    /// All workgroups that a record has.
    fn groups(&self, frame: usize) -> Groups {
        Groups { first: [0, 0], size: self.frames[frame].traced_size }
    }

    pub(super) fn encoder(&mut self) -> &mut CommandEncoder {
        let headless = self.headless;
        self.encoder.get_or_insert_with(|| headless.encoder())
    }

    /// A dispatch for every pixel of the tile, or of where the scene may be seen, which searches nothing.
    pub(super) fn shade(
        &mut self,
        pipeline: &ComputePipeline,
        is_whole: bool,
        brick: &BindGroup,
        stage: Stage,
    ) -> Result<(), GpuError> {
        let frame = usize::from(!is_whole);
        let group = &self.tile.shade[frame];
        self.dispatch(pipeline, group, Some(brick), stage, self.groups(frame))?;
        self.run_if_full()
    }

    /// Adds the samples of all pixels.
    pub(super) fn deposit(&mut self, stage: Stage) -> Result<(), GpuError> {
        let (renderer, tile) = (self.renderer, self.tile);
        self.dispatch(&renderer.deposit, &tile.deposit, None, stage, self.groups(0))?;
        self.run_if_full()
    }

    fn run_if_full(&mut self) -> Result<(), GpuError> {
        if self.stages.len() == MOST_STAGES {
            self.run_gathered(&[])?;
        }
        Ok(())
    }

    /// A dispatch for every pixel that searches a brick, in slices if it takes long.
    pub(super) fn search(
        &mut self,
        pipeline: &ComputePipeline,
        group: &BindGroup,
        brick: &BindGroup,
        stage: Stage,
    ) -> Result<(), GpuError> {
        let whole = self.groups(1);
        let pace = self.scene.pace().groups();
        if whole.count() <= pace {
            self.dispatch(pipeline, group, Some(brick), stage, whole)?;
            self.gathered += whole.count();
            if self.gathered >= pace || self.stages.len() == MOST_STAGES {
                self.run_gathered(&[])?;
            }
            return Ok(());
        }
        self.run_gathered(&[])?;
        let mut left = vec![whole];
        while let Some(slice) = Groups::take(&mut left, self.scene.pace().groups()) {
            self.frames.iter_mut().for_each(|frame| frame.first_group = slice.first);
            self.dispatch(pipeline, group, Some(brick), stage, slice)?;
            self.gathered = slice.count();
            self.run_gathered(&[])?;
        }
        self.frames.iter_mut().for_each(|frame| frame.first_group = [0, 0]);
        Ok(())
    }

    fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        group: &BindGroup,
        brick: Option<&BindGroup>,
        stage: Stage,
        groups: Groups,
    ) -> Result<(), GpuError> {
        if groups.count() == 0 {
            return Ok(());
        }
        // No more than MOST_STAGES of them, so it fits.
        let offset = (self.stages.len() * self.tile.stage_stride) as u32;
        self.stages.push(stage);
        let tile = self.tile;
        let mut pass = self.encoder().begin_compute_pass(&ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[offset]);
        if let Some(brick) = brick {
            pass.set_bind_group(1, brick, &[]);
            pass.set_bind_group(2, &tile.look, &[]);
            if let Some(sky) = &tile.sky {
                pass.set_bind_group(3, sky, &[]);
            }
        }
        pass.dispatch_workgroups(groups.size[0], groups.size[1], 1);
        Ok(())
    }

    /// Submits what was gathered, waits until it is done and the buffers are mapped.
    pub(super) fn run_gathered(&mut self, mapped: &[&wgpu::Buffer]) -> Result<(), GpuError> {
        let Some(encoder) = self.encoder.take() else {
            return Ok(());
        };
        self.tile.queue_records(self.headless.queue(), &self.frames, &self.stages);
        self.stages.clear();
        let started = Instant::now();
        self.headless.run(encoder, mapped)?;
        let groups =
            Groups { first: [0, 0], size: [u32::try_from(self.gathered).unwrap_or(u32::MAX), 1] };
        self.scene.took(groups, started.elapsed());
        self.gathered = 0;
        (self.after)()
    }

    /// Whether any path goes on; asks the device.
    pub(super) fn is_alive(&mut self) -> Result<bool, GpuError> {
        let tile = self.tile;
        tile.record_copy_status(self.encoder());
        self.run_gathered(&[tile.status_back.buffer()])?;
        let [spent, alive] = tile.status_back.read(|words: &[u32]| [words[0], words[1]])?;
        if spent == 0 { Ok(alive != 0) } else { Err(GpuError::Steps) }
    }
}
