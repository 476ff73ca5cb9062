//! The check of a pixel whose ray was not recorded: whether the pixel is legal for some ray that a device may compute
//! for it.

use super::camera::AnyRay;
use super::hit::LegalHits;
use super::pixel::{Layers, PixelCheck};
use super::recording::Rendered;
use super::rounding::{Interval, PAD, U};
use super::sphere::SphereTest;
use super::violation::ViolationKind;
use crate::image::NO_ID;

impl PixelCheck<'_> {
    /// Judges a pixel of the picture without recording; `None` if there is no such picture, or if the pixel equals the
    /// recorded one.
    pub(super) fn judge_rendered(
        &self,
        index: usize,
        pixel: [u32; 2],
        legal: &mut LegalHits,
    ) -> Option<Result<(), ViolationKind>> {
        let Rendered::Other(image) = &self.recording.rendered else {
            return None;
        };
        let layers = Layers::of(image, index);
        if layers == Layers::of(&self.recording.image, index) {
            return None;
        }
        let judged = self.judge_any(&layers, pixel, legal);
        Some(judged.map_err(|kind| ViolationKind::Rendered(Box::new(kind))))
    }

    fn judge_any(
        &self,
        layers: &Layers,
        pixel: [u32; 2],
        legal: &mut LegalHits,
    ) -> Result<(), ViolationKind> {
        let ray = self.model.ray(pixel).any(&self.model);
        legal.clear();
        if ray.may_hit_box {
            legal.find_nearer(self.candidates, &ray.line, ray.slack, |_| false);
            legal.miss |= ray.may_miss_box;
        }
        legal.start_from(&ray);
        let Layers { id, depth, .. } = *layers;
        if id == NO_ID && legal.miss {
            return self.check_layers_of_miss(layers);
        }
        if id == NO_ID || !legal.allows(id, depth.into()) {
            return Err(ViolationKind::Hit { id, t: depth, legal: legal.clone() });
        }
        if let Some(legal) = self.legal_depth(&ray, id)
            && !legal.contains(depth.into())
        {
            return Err(ViolationKind::Depth { found: depth, legal });
        }
        self.check_shading(layers, &ray.line, ray.slack, ray.direction).map(|_| ())
    }
}

impl PixelCheck<'_> {
    /// The legal depths of a sphere of which the ray certainly hits one side: a tighter bound, because they do not
    /// depend on where the ray enters the scene's box.
    fn legal_depth(&self, ray: &AnyRay, id: u32) -> Option<Interval> {
        let sphere = *self.scene.spheres().get(id as usize)?;
        let roots = SphereTest::new(&ray.line, sphere, ray.slack)?.roots();
        let test = SphereTest::new(&ray.line, sphere, ray.slack_of_distance)?.as_the_kernel();
        let closer = test.roots();
        let side = match ((roots.near, roots.far), (closer.near, closer.far)) {
            ((Some(_), None), (Some(side), None)) | ((None, Some(_)), (None, Some(side))) => side,
            _ => return None,
        };
        Some(ray.depths(side))
    }
}

impl AnyRay {
    /// Distances from the camera; the device computes them with one sum.
    fn depths(&self, Interval { low, high }: Interval) -> Interval {
        let (near, far) = (low + self.distance.low, high + self.distance.high);
        Interval { low: near - PAD * U * near.abs(), high: far + PAD * U * far.abs() }
    }
}

impl LegalHits {
    /// Converts distances along the line to distances from the camera.
    fn start_from(&mut self, ray: &AnyRay) {
        let moved = |side| ray.depths(side);
        for hit in &mut self.spheres {
            (hit.near, hit.far) = (hit.near.map(moved), hit.far.map(moved));
        }
        self.limit = moved(Interval { low: self.limit, high: self.limit }).high;
    }
}
