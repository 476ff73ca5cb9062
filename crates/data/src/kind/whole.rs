//! The forms of matter that atoms make up: molecules, or a solid in which they are joined to their own images.

use glam::{DMat3, DVec3, I64Vec3};

use crate::added::contacts;
use crate::load::{Dataset, covalent};

/// Atoms are joined up to this part of the sum of their covalent radii, also two metals.
const JOINED: f64 = 1.2;

/// The forms of matter that atoms make up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Whole {
    /// Atoms that are not joined.
    Single,
    Molecules,
    /// A path of joined atoms leads from an atom to its own image in another cell.
    Solid,
}

/// Finds what atoms form.
pub(super) fn whole(data: &Dataset) -> Whole {
    let Some(labels) = data.labels("species") else { return Whole::Single };
    let radii: Vec<f64> =
        labels.names.iter().map(|name| covalent(name).map_or(0.0, |covalent| covalent.radius)).collect();
    let radius = |index: u32| labels.indices.get(index as usize).and_then(|label| radii.get(*label as usize));
    let radius = |index: u32| radius(index).copied().unwrap_or_default();
    let reach = 2.0 * JOINED * radii.iter().copied().fold(0.0, f64::max);
    let inverse = data.cell.map_or(DMat3::ZERO, |edges| DMat3::from_cols_array_2d(&edges).inverse());
    let are_joined = |a, b, squared: f64| {
        let most = JOINED * (radius(a) + radius(b));
        squared > 0.0 && squared <= most * most
    };
    let Some(pairs) = contacts(data, reach, are_joined) else { return Whole::Solid };
    if pairs.is_empty() {
        return Whole::Single;
    }
    let mut groups = Groups { above: (0..data.spheres.len() as u32).map(|index| (index, I64Vec3::ZERO)).collect() };
    let reaches_itself = pairs.into_iter().any(|(a, b, image)| {
        let turns = image.map_or(DVec3::ZERO, |image| inverse * (image - data.center(b as usize)));
        groups.join(a, b, turns.round().as_i64vec3())
    });
    if reaches_itself { Whole::Solid } else { Whole::Molecules }
}

/// Groups of joined atoms. Each atom has another of its group, and the cells between them.
struct Groups {
    above: Vec<(u32, I64Vec3)>,
}

impl Groups {
    /// The first atom of a group, and the cells between.
    fn first(&mut self, index: u32) -> (u32, I64Vec3) {
        let (mut at, mut turns, mut steps) = (index, I64Vec3::ZERO, Vec::new());
        while self.above[at as usize].0 != at {
            steps.push((at, turns));
            turns += self.above[at as usize].1;
            at = self.above[at as usize].0;
        }
        // Later searches are short.
        for (step, before) in steps {
            self.above[step as usize] = (at, turns - before);
        }
        (at, turns)
    }

    /// Joins an atom to another that is some cells away. Returns true if the first is then joined to its own image.
    fn join(&mut self, a: u32, b: u32, turns: I64Vec3) -> bool {
        let ((first_a, turns_a), (first_b, turns_b)) = (self.first(a), self.first(b));
        let between = turns + turns_b - turns_a;
        if first_a == first_b {
            return between != I64Vec3::ZERO;
        }
        self.above[first_a as usize] = (first_b, between);
        false
    }
}
