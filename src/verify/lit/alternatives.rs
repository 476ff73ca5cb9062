//! What else is legal where a search of a lit picture is open, in words.

use crate::verify::candidates::Candidate;
use crate::verify::hit::{LegalHit, LegalHits};
use crate::verify::line::Line;

/// The largest number of alternatives that are named.
const MOST: usize = 4;

impl LegalHits {
    /// The legal answers, the nearest first; of more than four, the miss and the nearest.
    pub(in crate::verify) fn alternatives(&self) -> Vec<String> {
        let mut hits: Vec<&LegalHit> = self.spheres.iter().collect();
        hits.sort_by(|a, b| a.lowest().total_cmp(&b.lowest()));
        let place = |hit: &LegalHit| {
            // Written like the f32 next to them: a device gives no others.
            let crossing = [hit.near, hit.far].into_iter().flatten().next();
            let [low, high] = crossing.map_or([0.0; 2], |at| [at.low as f32, at.high as f32]);
            match low < high {
                true => format!("sphere {} at {low:?} to {high:?}", hit.id),
                false => format!("sphere {} at {low:?}", hit.id),
            }
        };
        let nearest = hits.iter().take(MOST - usize::from(self.miss));
        let mut all: Vec<String> = nearest.map(|hit| place(hit)).collect();
        if self.miss {
            all.push("a miss".to_owned());
        }
        all
    }
}

/// The spheres that may hide a light and need not.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::verify) struct Doubts(Vec<String>);

impl Doubts {
    pub(in crate::verify) const NONE: Self = Self(Vec::new());

    /// Adds a sphere that the ray may miss, or else whose surface may be behind the light.
    pub(in crate::verify) fn add(
        &mut self,
        Candidate { sphere, id }: &Candidate,
        line: &Line,
        may_miss: bool,
    ) {
        if self.0.len() < MOST {
            self.0.push(match may_miss {
                true => {
                    let beside = line.beside_silhouette(*sphere);
                    format!("sphere {id}, {beside:.1e} of its radius beside its silhouette")
                }
                false => format!("sphere {id}, which ends where the search does"),
            });
        }
    }

    /// Those of both.
    pub(in crate::verify) fn and(mut self, other: Self) -> Self {
        for doubt in other.0 {
            if self.0.len() < MOST && !self.0.contains(&doubt) {
                self.0.push(doubt);
            }
        }
        self
    }

    /// What is open, in words.
    pub(in crate::verify) fn alternatives(&self) -> Vec<String> {
        match self.0.is_empty() {
            true => vec![
                "hidden or not: the surface itself, a ground, or the box of the scene".to_owned(),
            ],
            false => self.0.iter().map(|doubt| format!("hidden or not: {doubt}")).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::candidates::Candidates;

    #[test]
    fn legal_hits_are_named_by_distance() {
        let ball = |z: f32, r: f32| [0.0, 0.0, z, r];
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let named = |spheres: &[[f32; 4]]| {
            let mut legal = LegalHits::default();
            legal.find(&Candidates::new(spheres).unwrap(), &line);
            legal.alternatives()
        };
        // Two spheres that begin where a third does, and one far behind.
        let equal = [ball(9.0, 1.0), ball(10.0, 2.0), ball(8.5, 0.5), ball(20.0, 1.0)];
        let found = named(&equal);
        assert_eq!(found.len(), 3, "{found:?}");
        for (id, words) in found.iter().enumerate() {
            assert!(found.iter().any(|w| w.starts_with(&format!("sphere {id} at "))), "{found:?}");
            let ends = words.split(" at ").nth(1).unwrap().split(" to ");
            let ends: Vec<f32> = ends.map(|end| end.parse().unwrap()).collect();
            // All surfaces are there, and the bounds of the sphere test are some 2⁻¹⁹ of the distance to centres.
            assert!(ends[0] <= 8.0 && 8.0 <= ends[1] && ends[1] - ends[0] < 1e-4, "{found:?}");
        }
        // The ray touches a sphere, so that it may miss it.
        let first_words = |spheres: &[[f32; 4]]| -> Vec<String> {
            let named = named(spheres).into_iter();
            named.map(|words| words.split(" at ").next().unwrap().to_owned()).collect()
        };
        let touched = [1.0, 0.0, 5.0, 1.0];
        assert_eq!(first_words(&[touched, ball(9.0, 1.0)]), ["sphere 0", "sphere 1"]);
        assert_eq!(first_words(&[ball(9.0, 1.0), touched]), ["sphere 1", "sphere 0"]);
        assert_eq!(first_words(&[touched]), ["sphere 0", "a miss"]);
        assert_eq!(named(&[]), ["a miss"]);
        // Of many, four are named, and the miss is one of them.
        let many: Vec<_> = (1..9).map(|i| [1.0, 0.0, i as f32, 1.0]).collect();
        assert_eq!(first_words(&many), ["sphere 0", "sphere 1", "sphere 2", "a miss"]);
    }

    #[test]
    fn doubts_say_how_near_a_silhouette_is() {
        let line = Line::new([0.0; 3], [0.0, 0.0, 1.0]);
        let touched = Candidate { sphere: [2.0, 0.0, 5.0, 2.0 + 1e-6], id: 77 };
        let mut doubts = Doubts::NONE;
        doubts.add(&touched, &line, true);
        doubts.add(&Candidate { id: 5, ..touched }, &line, false);
        let words = [
            "hidden or not: sphere 77, 4.8e-7 of its radius beside its silhouette",
            "hidden or not: sphere 5, which ends where the search does",
        ];
        assert_eq!(doubts.alternatives(), words);
        // The same doubt counts once, and not more than four do.
        assert_eq!(doubts.clone().and(doubts.clone()), doubts);
        let mut others = Doubts::NONE;
        (0..9).for_each(|id| others.add(&Candidate { id, ..touched }, &line, false));
        assert_eq!(others.alternatives().len(), 4);
        assert_eq!(doubts.and(others).alternatives().len(), 4);
        assert_eq!(Doubts::NONE.alternatives().len(), 1);
    }
}
