//! Tubes along the chains of polymers.

use std::collections::HashSet;

use glam::DVec3;

use super::Shown;
use super::rule::ShowRule;
use super::sizes::Measures;
use crate::added::{AddError, AddedShapes, bonded_pairs};
use crate::load::{ColumnValues, Dataset};
use crate::select::Selection;
use pinhole::image::color::LinearRgb;
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::tube::Tube;

/// The atoms through which a tube goes, by name: the radius of the tube and the greatest distance of neighbours, both in Å.
const GUIDES: [(&str, f64, f64); 3] = [("CA", 0.4, 5.0), ("P", 0.6, 9.0), ("BB", 0.5, 6.0)];

/// The same for other spheres, as parts of the distance between neighbours.
const OTHERS: (f64, f64) = (0.3, 2.0);

/// The columns whose values are the same along a chain.
const CHAIN: [&str; 5] = ["chain", "segid", "mol", "molecule", "model"];

/// The spheres through which tubes go.
struct Guides {
    /// The spheres, in their order.
    spheres: Vec<usize>,
    /// For each, the radius and the greatest distance to the next.
    sizes: Vec<(f64, f64)>,
    /// The only pairs that follow each other, if bonds are known.
    bonds: Option<HashSet<[u32; 2]>>,
}

impl Shown<'_> {
    /// Adds the tubes. `look` is that of a rule at a sphere.
    ///
    /// # Errors
    /// Returns an error if a tube is out of range.
    pub fn add_tubes(
        &self,
        data: &Dataset,
        added: &mut AddedShapes,
        look: impl Fn(usize, usize) -> (LinearRgb, SurfaceProperties),
    ) -> Result<(), AddError> {
        let columns = data.columns.iter().filter(|column| CHAIN.contains(&column.name.as_str()));
        let columns: Vec<&ColumnValues> = columns.map(|column| &column.values).collect();
        let is_same = |a: usize, b: usize| {
            columns.iter().all(|values| match values {
                ColumnValues::Labels(labels) => labels.indices.get(a) == labels.indices.get(b),
                ColumnValues::Numbers(numbers) => numbers.get(a) == numbers.get(b),
            })
        };
        let place = |index: usize| DVec3::from_slice(&data.spheres.at(index)[..3]);
        for (number, rule, spheres) in self.traces() {
            let guides = Guides::new(data, spheres);
            let follows = |a: usize, b: usize| {
                let (from, to) = (guides.spheres[a], guides.spheres[b]);
                let pair = [from.min(to) as u32, from.max(to) as u32];
                is_same(from, to)
                    && guides.bonds.as_ref().is_none_or(|bonds| bonds.contains(&pair))
                    && place(from).distance(place(to)) <= guides.sizes[a].1.max(guides.sizes[b].1)
            };
            let mut has_tube = false;
            let mut start = 0;
            for end in 1..=guides.spheres.len() {
                if end < guides.spheres.len() && follows(end - 1, end) {
                    continue;
                }
                if end - start > 1 {
                    has_tube = true;
                    let run = &guides.spheres[start..end];
                    let point = |at: usize| {
                        let [x, y, z, _] = data.spheres.at(guides.spheres[at]);
                        [x, y, z, radius(rule, guides.sizes[at].0)]
                    };
                    let points: Vec<[f64; 4]> = (start..end).map(point).collect();
                    added.push_tube(&Tube::through(&points), &points, |at| look(number, run[at]))?;
                }
                start = end;
            }
            if !has_tube {
                added.note(
                    "`show`: no chain was found for a trace, which goes through atoms CA, P and BB, or along bonds"
                        .to_owned(),
                );
            }
        }
        Ok(())
    }
}

fn radius(rule: &ShowRule, of_style: f64) -> f64 {
    rule.scale * rule.radius.unwrap_or(of_style)
}

impl Guides {
    fn new(data: &Dataset, mut spheres: Vec<usize>) -> Self {
        let guides = "guide or (polymer and name BB)".parse::<Selection>().and_then(|guides| guides.matches(data));
        let names = data.labels("name");
        if let (Ok((is_guide, _)), Some(names)) = (guides, names)
            && spheres.iter().any(|index| is_guide[*index])
        {
            spheres.retain(|index| is_guide[*index]);
            let size = |index: &usize| {
                let name = names.indices.get(*index).and_then(|name| names.names.get(*name as usize));
                let guide = GUIDES.iter().find(|(known, ..)| name.is_some_and(|name| name == known));
                guide.map_or((GUIDES[0].1, GUIDES[0].2), |(_, radius, reach)| (*radius, *reach))
            };
            let sizes = spheres.iter().map(size).collect();
            return Self { spheres, sizes, bonds: None };
        }
        let spacing = Measures::of(data).spacing;
        let sizes = vec![(OTHERS.0 * spacing, OTHERS.1 * spacing); spheres.len()];
        let bonds = bonded_pairs(data).ok().map(|pairs| pairs.into_iter().collect());
        Self { spheres, sizes, bonds }
    }
}
