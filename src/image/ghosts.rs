//! Pictures of ghosts over those of other shapes.

use super::{Image, Layer, LayerSet};
use crate::image::color::LinearRgb;
use crate::render::{Integrator, RenderSettings};

/// The opacity of a ghost.
const OPACITY: f32 = 0.25;

impl RenderSettings {
    /// The settings for a picture of [ghosts](crate::scene::Scene::ghosts) with the layers [`LayerSet::OF_GHOSTS`]: without
    /// background, ground, shadows and outlines.
    #[must_use]
    pub fn for_ghosts(&self) -> Self {
        let mut settings = Self { background: LinearRgb::BLACK, is_transparent: true, ground: None, ..self.clone() };
        if let Integrator::Studio(studio) = &mut settings.integrator {
            (studio.outline, studio.shadows) = (None, false);
        }
        settings
    }
}

impl LayerSet {
    /// The layers of a picture of ghosts, which [`Image::with_ghosts`] takes.
    pub const OF_GHOSTS: Self = Self::COLOR.with(Layer::Alpha).with(Layer::Depth);
}

impl Image {
    /// The picture with that of ghosts over it, as if they had an opacity of 0.25: of all ghosts along a ray only the nearest
    /// is seen, and where the ray through the centre of a pixel hits a shape of this picture before that, none. Only
    /// `layers` are kept. A picture without depth, or of another size, stays as it is.
    #[must_use]
    pub fn with_ghosts(mut self, ghosts: &Self, layers: LayerSet) -> Self {
        let is_same_size = [self.width(), self.height()] == [ghosts.width(), ghosts.height()];
        if let (true, Some(depth), Some(alpha), Some(of_ghosts)) =
            (is_same_size, self.depth(), ghosts.alpha(), ghosts.depth())
        {
            // What is not hit has an infinite depth, and a pixel at the border of a ghost shows some of it.
            let is_seen = |(own, ghost): (&f32, &f32)| !own.is_finite() || (ghost.is_finite() && ghost < own);
            let is_seen: Vec<bool> = depth.iter().zip(of_ghosts).map(is_seen).collect();
            let shares = || alpha.iter().zip(&is_seen).map(|(alpha, is)| if *is { *alpha } else { 0.0 });
            for ((color, ghost), share) in self.color_mut().iter_mut().zip(ghosts.color()).zip(shares()) {
                let is_seen = f32::from(u8::from(share > 0.0));
                for (own, ghost) in color.iter_mut().zip(ghost) {
                    *own += OPACITY * (is_seen * ghost - share * *own);
                }
            }
            for (own, share) in self.alpha_mut().into_iter().flatten().zip(shares()) {
                *own += OPACITY * share * (1.0 - *own);
            }
        }
        self.keep(layers);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_surface_is_seen_through_ghosts_in_front_of_it() {
        let layers = LayerSet::OF_GHOSTS;
        let image = |pixels: [([f32; 3], f32, f32); 4]| {
            let mut image = Image::new(4, 1, layers).unwrap();
            for (index, (color, alpha, depth)) in pixels.into_iter().enumerate() {
                image.color_mut()[index] = color;
                image.alpha_mut().unwrap()[index] = alpha;
                image.plane_mut::<f32>(Layer::Depth).unwrap()[index] = depth;
            }
            image
        };
        let miss = f32::INFINITY;
        let own = image([([0.4; 3], 1.0, 5.0), ([0.4; 3], 1.0, 5.0), ([0.8; 3], 0.0, miss), ([0.8; 3], 0.0, miss)]);
        // The last pixel is covered by half.
        let ghosts = image([([1.0; 3], 1.0, 4.0), ([1.0; 3], 1.0, 6.0), ([1.0; 3], 1.0, 7.0), ([0.5; 3], 0.5, miss)]);
        let found = own.clone().with_ghosts(&ghosts, layers);
        let reds: Vec<f32> = found.color().iter().map(|color| color[0]).collect();
        let near = |found: &[f32], wanted: [f32; 4]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near(&reds, [0.55, 0.4, 0.85, 0.825]), "{reds:?}");
        assert!(near(found.alpha().unwrap(), [1.0, 1.0, 0.25, 0.125]), "{:?}", found.alpha());
        assert_eq!(found.depth(), own.depth());
        let colors = own.with_ghosts(&ghosts, LayerSet::COLOR);
        assert!(colors.depth().is_none() && colors.alpha().is_none());
    }
}
