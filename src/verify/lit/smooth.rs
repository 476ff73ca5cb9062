//! The light that a conforming device may have for pixels of a smooth picture, which follows from the spheres that the
//! rays through the centres of a pixel and its neighbours hit. Rounding may change those, and nothing else, because the
//! same code draws every picture from them.

use crate::image::NO_ID;
use crate::parallel;
use crate::recording::pixel_at;
use crate::smooth::SmoothPicture;
use crate::verify::hit::LegalHits;
use crate::verify::lit::check::LitCheck;
use crate::verify::rounding::Interval;

/// The most combinations of legal answers of nine rays that are drawn. Beyond that, nothing is said about a pixel.
const MOST: usize = 64;

impl LitCheck<'_> {
    /// The light of some pixels, by their indices, and their alpha, before lines are drawn; `None` for a pixel around which
    /// too many answers are legal.
    pub(crate) fn smooth_light(&self, smooth: &SmoothPicture<'_>, indices: &[usize]) -> Vec<Option<[Interval; 4]>> {
        let ways = parallel::map(indices.len(), |at| self.ways(pixel_at(indices[at], self.inputs.size[0])));
        let all = indices
            .iter()
            .zip(&ways)
            .flat_map(|(index, ways)| ways.iter().flatten().map(|ids| (pixel_at(*index, self.inputs.size[0]), *ids)));
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

    /// The ids that the pixels of three rows around a pixel may have, in every legal combination.
    fn ways(&self, pixel: [u32; 2]) -> Option<Vec<[u32; 9]>> {
        let [width, height] = self.inputs.size;
        let mut hits = LegalHits::default();
        let mut ways = vec![[NO_ID; 9]];
        // The middle is the first, because it stands for pixels outside of the picture.
        for place in [4, 0, 1, 2, 3, 5, 6, 7, 8] {
            let at = [0, 1].map(|axis| pixel[axis] as i64 + [place % 3, place / 3][axis] as i64 - 1);
            let is_inside = (0..i64::from(width)).contains(&at[0]) && (0..i64::from(height)).contains(&at[1]);
            let answers = is_inside.then(|| self.answers(at.map(|place| place as u32), &mut hits));
            if answers.as_ref().is_some_and(|answers| answers.len() * ways.len() > MOST) {
                return None;
            }
            let with = |ids: [u32; 9]| {
                answers.clone().unwrap_or_else(|| vec![ids[4]]).into_iter().map(move |id| {
                    let mut ids = ids;
                    ids[place] = id;
                    ids
                })
            };
            ways = ways.into_iter().flat_map(with).collect();
        }
        Some(ways)
    }

    /// The ids that the ray through the centre of a pixel may give.
    fn answers(&self, pixel: [u32; 2], hits: &mut LegalHits) -> Vec<u32> {
        let ray = self.model.ray(pixel).any(&self.model);
        let ray = ray.moved(self.moved(ray.line.origin));
        ray.find(&self.checker.candidates, hits);
        let missed = (hits.miss || hits.spheres.is_empty()).then_some(NO_ID);
        hits.spheres.iter().map(|hit| hit.id).chain(missed).collect()
    }
}
