//! Tubes along the chains of polymers.

use std::collections::HashSet;

use glam::DVec3;

use super::Shown;
use crate::added::{AddError, AddedShapes, bonded_pairs};
use crate::kind::is_curve;
use crate::load::{ColumnValues, Dataset};
use crate::select::Selection;
use pinhole::image::color::LinearRgb;
use pinhole::scene::material::SurfaceProperties;
use pinhole::scene::tube::Tube;

/// The atoms through which a tube goes, by name: the radius of the tube and the greatest distance of neighbours, both in Å.
const GUIDES: [(&str, f64, f64); 3] = [("CA", 0.4, 5.0), ("P", 0.6, 9.0), ("BB", 0.5, 6.0)];

/// The radius and the greatest distance for other spheres, as parts of the distance between neighbours.
const OTHERS: (f64, f64) = (0.3, 2.0);

/// The columns whose values are the same along a chain.
const CHAIN: [&str; 5] = ["chain", "segid", "mol", "molecule", "model"];

/// A sphere through which a tube goes.
struct Guide {
    sphere: usize,
    radius: f64,
    /// The greatest distance to the next one.
    reach: f64,
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
        // The selection and the bonds are the same for all rules.
        let (mut is_guide, mut known) = (None, None);
        for (number, rule, spheres) in self.traces() {
            let is_empty = spheres.is_empty();
            let is_guide = is_guide.get_or_insert_with(|| guides(data));
            let (guides, bonds): (_, Option<&HashSet<[u32; 2]>>) = match named(data, is_guide, &spheres) {
                Some(named) => (named, None),
                None => {
                    let known = known.get_or_insert_with(|| bonded_pairs(data).ok().map(HashSet::from_iter));
                    (unnamed(data, spheres), known.as_ref())
                }
            };
            let follows = |a: &Guide, b: &Guide| {
                let (from, to) = (a.sphere, b.sphere);
                is_same(from, to)
                    && bonds.is_none_or(|bonds| bonds.contains(&[from.min(to) as u32, from.max(to) as u32]))
                    && data.center(from).distance(data.center(to)) <= a.reach.max(b.reach)
            };
            let mut has_tube = false;
            for run in guides.chunk_by(follows).filter(|run| run.len() > 1) {
                has_tube = true;
                let point = |guide: &Guide| {
                    let DVec3 { x, y, z } = data.center(guide.sphere);
                    [x, y, z, rule.radius_or(guide.radius)]
                };
                let points: Vec<[f64; 4]> = run.iter().map(point).collect();
                added.push_tube(&Tube::through(&points), &points, |at| look(number, run[at].sphere))?;
            }
            if !has_tube && !is_empty {
                added.note(
                    "`show`: no chain was found for a trace, which goes through atoms CA, P and BB, or along bonds"
                        .to_owned(),
                );
            }
        }
        Ok(())
    }
}

/// Tells which spheres are atoms through which tubes go; `None` if the data has no names of atoms and residues.
fn guides(data: &Dataset) -> Option<Vec<bool>> {
    let guides = "guide or (polymer and name BB)".parse::<Selection>().and_then(|guides| guides.matches(data));
    guides.ok().map(|(is_guide, _)| is_guide)
}

/// The atoms among these spheres through which a tube goes, by their names; `None` if there are none.
fn named(data: &Dataset, is_guide: &Option<Vec<bool>>, spheres: &[usize]) -> Option<Vec<Guide>> {
    let (is_guide, names) = is_guide.as_ref().zip(data.labels("name"))?;
    let guide = |index: &usize| {
        let name = names.indices.get(*index).and_then(|name| names.names.get(*name as usize));
        let guide = GUIDES.iter().find(|(known, ..)| name.is_some_and(|name| name == known));
        let (_, radius, reach) = *guide.unwrap_or(&GUIDES[0]);
        Guide { sphere: *index, radius, reach }
    };
    let guides: Vec<Guide> = spheres.iter().filter(|index| is_guide[**index]).map(guide).collect();
    (!guides.is_empty()).then_some(guides)
}

/// All of these spheres, without names.
fn unnamed(data: &Dataset, spheres: Vec<usize>) -> Vec<Guide> {
    let spacing = data.spacing();
    let reach = if is_curve(data) { f64::INFINITY } else { OTHERS.1 * spacing };
    let radius = OTHERS.0 * spacing;
    spheres.into_iter().map(|sphere| Guide { sphere, radius, reach }).collect()
}
