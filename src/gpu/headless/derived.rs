//! Layers that the host computes from the layers that kernels wrote.

use std::ops::Range;

use crate::camera::View;
use crate::gpu::shader::records::NO_HIT;
use crate::image::color::LinearRgb;
use crate::image::{NO_ID, RowMut};
use crate::scene::SceneAppearance;

/// The data, besides the pixels of a tile, that derived layers are computed from.
pub(in crate::gpu) struct Derived<'a> {
    pub(in crate::gpu) view: View<'a>,
    pub(in crate::gpu) appearance: &'a SceneAppearance,
}

impl Derived<'_> {
    /// Sets the positions of the hits in some columns of row `j`, which follow from the depths.
    pub(in crate::gpu) fn set_by_depths(
        &self,
        row: &mut RowMut<'_>,
        columns: Range<usize>,
        j: usize,
        depths: &[f32],
    ) {
        let Some(position) = &mut row.position else { return };
        let pixels = position[columns.clone()].iter_mut().zip(columns);
        for ((point, i), t) in pixels.zip(depths) {
            *point = if *t >= NO_HIT { [0.0; 3] } else { self.point([i, j], *t) };
        }
    }

    /// Sets the layers that follow from ids in some columns of a row: opacity, albedo, and the number of samples and
    /// the variance of pixels with a single ray each.
    pub(in crate::gpu) fn set_by_ids(
        &self,
        row: &mut RowMut<'_>,
        columns: Range<usize>,
        ids: &[u32],
    ) {
        if let Some(alpha) = &mut row.alpha {
            for (alpha, id) in alpha[columns.clone()].iter_mut().zip(ids) {
                *alpha = RowMut::coverage(*id);
            }
        }
        if let Some(albedo) = &mut row.albedo {
            for (albedo, id) in albedo[columns.clone()].iter_mut().zip(ids) {
                *albedo = self.albedo(*id);
            }
        }
        if let Some(samples) = &mut row.samples {
            samples[columns.clone()].fill(1);
        }
        if let Some(variance) = &mut row.variance {
            variance[columns].fill(0.0);
        }
    }

    /// The point in world space at a distance along the ray of a pixel.
    fn point(&self, [i, j]: [usize; 2], t: f32) -> [f32; 3] {
        let location = self.view.film.relative_location(i as f64 + 0.5, j as f64 + 0.5);
        self.view.camera.ray_in_world(location).at(f64::from(t)).as_vec3().to_array()
    }

    fn albedo(&self, id: u32) -> [f32; 3] {
        let color = if id == NO_ID { None } else { self.appearance.color(id) };
        color.map_or([0.0; 3], LinearRgb::to_array)
    }
}
