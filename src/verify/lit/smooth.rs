//! The light that a conforming device may have for pixels of a smooth picture, which follows from the spheres that the
//! rays through the centres of a pixel and its neighbours hit. Rounding may change those, and nothing else, because the
//! same code draws every picture from them.

use std::iter;

use crate::image::NO_ID;
use crate::parallel;
use crate::recording::pixel_at;
use crate::smooth::SmoothPicture;
use crate::verify::camera::{AnyRay, CameraModel};
use crate::verify::hit::LegalHits;
use crate::verify::lit::check::LitCheck;
use crate::verify::rounding::Interval;

/// The most combinations of legal answers of the rays of a pixel that are drawn. Beyond that, nothing is said about a pixel.
const MOST: usize = 64;

impl LitCheck<'_> {
    /// The light of some pixels, by their indices, and their alpha, before lines are drawn; `None` for a pixel around which
    /// too many answers are legal.
    pub(crate) fn smooth_light(&self, smooth: &SmoothPicture<'_>, indices: &[usize]) -> Vec<Option<[Interval; 4]>> {
        let film = smooth.view_of_ids().film;
        let model = CameraModel::new(self.inputs.camera.kind, &self.inputs.uploaded, &film);
        let pixel = |index: usize| pixel_at(index, self.inputs.size[0]);
        let ways = parallel::map(indices.len(), |at| self.ways(&smooth.places(pixel(indices[at])), &model));
        let all = indices
            .iter()
            .zip(&ways)
            .flat_map(|(index, ways)| ways.iter().flatten().map(|ids| (pixel(*index), ids.clone())));
        let drawn = smooth.pixels(&all.collect::<Vec<_>>());
        let mut left = drawn.iter();
        let joined = ways.iter().map(|ways| {
            let light = left.by_ref().take(ways.as_ref()?.len()).map(|averages| {
                let [r, g, b] = averages.color;
                [r, g, b, averages.alpha].map(|c| Interval { low: c.into(), high: c.into() })
            });
            light.reduce(|a, b| [0, 1, 2, 3].map(|c| a[c].union(b[c])))
        });
        joined.collect()
    }

    /// The ids at some places in every legal combination. Places outside of the picture have the id of the middle.
    fn ways(&self, places: &[Option<[u32; 2]>], model: &CameraModel) -> Option<Vec<Vec<u32>>> {
        let middle = places.len() / 2;
        let mut hits = LegalHits::default();
        let mut ways = vec![vec![NO_ID; places.len()]];
        for at in iter::once(middle).chain((0..places.len()).filter(|at| *at != middle)) {
            let answers = places[at].map(|place| self.answers(model.ray(place).any(model), &mut hits));
            if answers.as_ref().is_some_and(|answers| answers.len() * ways.len() > MOST) {
                return None;
            }
            let with = |ids: Vec<u32>| {
                answers.clone().unwrap_or_else(|| vec![ids[middle]]).into_iter().map(move |id| {
                    let mut ids = ids.clone();
                    ids[at] = id;
                    ids
                })
            };
            ways = ways.into_iter().flat_map(with).collect();
        }
        Some(ways)
    }

    /// The ids that a ray of the camera may give.
    fn answers(&self, ray: AnyRay, hits: &mut LegalHits) -> Vec<u32> {
        let ray = ray.moved(self.moved(ray.line.origin));
        ray.find(&self.checker.candidates, hits);
        let missed = (hits.miss || hits.spheres.is_empty()).then_some(NO_ID);
        hits.spheres.iter().map(|hit| hit.id).chain(missed).collect()
    }
}
