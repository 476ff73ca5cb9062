//! The place where a ray hits a cone. The WGSL twin is `shaders/path/cone_place.wgsl`.

use crate::geometry::cone::ConeInFrame;
use crate::verify::cone::{AnyRay, Crossing};
use crate::verify::lit::judge::Mismatch;
use crate::verify::lit::kernel::{Kernel, Output, Place};
use crate::verify::number::{Number, Vector};

impl Kernel<'_> {
    pub(super) fn place_on_cone(&mut self, cone: &ConeInFrame) -> Result<Place, Mismatch> {
        let hit = self.hit;
        let (line, origin, slack) = self.entered();
        let ray = AnyRay::new(&line, slack);
        let crossing = Crossing::new(&ray, cone, self.choices);
        let [near, far] = crossing.distances().map(|side| (side - hit.t).abs());
        let is_back = self.is_far_side() || !crossing.is_solid()[0] || self.choices.decide(far.is_less(near));
        let from_foot = if is_back { crossing.leaves } else { crossing.enters };

        let [start, end] = [cone.start, cone.end].map(Vector::recorded);
        let [first, second] = cone.radii().map(Number::known);
        let middle = (start + (end - start).fence() * Number::HALF).fence();
        let on_cone = middle + (crossing.foot + ray.direction * from_foot).fence();
        let size = crossing.half_length + first.max(second);
        let is_large = size.is_more(Number::known(64.0) * (hit.t + hit.distance));
        let on_ray = origin + ray.direction * hit.t;
        let is_on_ray = self.choices.decide(is_large);
        let position = if is_on_ray { on_ray } else { on_cone };
        let position = self.at(position.fence(), size.interval().high)?;
        let is_known = !is_on_ray && matches!(self.after, Output::Recorded(_));
        let point = is_known.then(|| position.ball().0);
        let (outward, _) = crossing.normal(!is_back, point, self.choices);
        Ok(Place { position, outward, is_back })
    }
}
