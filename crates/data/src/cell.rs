//! The images of points in a periodic cell.

use glam::{DMat3, DVec3};

use crate::load::Dataset;

/// A cell that repeats in some directions.
pub(crate) struct PeriodicCell {
    origin: DVec3,
    /// Its columns are the edges.
    pub(crate) edges: DMat3,
    /// The inverse matrix, of which the rows of other directions are 0.
    inverse: DMat3,
}

/// The most images of each sphere, on average.
const MOST_IMAGES: usize = 64;

/// The number of images in addition, so that few spheres never have too many.
const MORE_IMAGES: usize = 1 << 20;

impl PeriodicCell {
    /// The cell of data; `None` if there is none, or it does not repeat or has no volume.
    pub(crate) fn of(data: &Dataset) -> Option<Self> {
        let edges = DMat3::from_cols_array_2d(&data.cell?);
        let repeats = DVec3::from_array(data.is_periodic.map(|is| if is { 1.0 } else { 0.0 }));
        let inverse = DMat3::from_diagonal(repeats) * edges.inverse();
        let is_regular = edges.determinant().is_normal() && inverse.is_finite() && data.is_periodic.contains(&true);
        is_regular.then(|| Self { origin: data.cell_origin.into(), edges, inverse })
    }

    /// The place in the cell, as fractions of its edges. Fractions along an edge in whose direction nothing repeats are 0.
    fn fractions(&self, point: DVec3) -> DVec3 {
        self.inverse * (point - self.origin)
    }

    /// The whole edges between the cell and a point.
    pub(crate) fn turns(&self, point: DVec3) -> DVec3 {
        self.fractions(point).floor()
    }

    pub(crate) fn moved(&self, point: DVec3, turns: DVec3) -> DVec3 {
        if turns == DVec3::ZERO { point } else { point + self.edges * turns }
    }

    /// The whole edges by which `to` must move to be the image nearest to `from`.
    pub(crate) fn turns_to_nearest(&self, from: DVec3, to: DVec3) -> DVec3 {
        let between = to - from;
        let start = -(self.inverse * between).round();
        let rows = self.inverse.transpose();
        let steps = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| if row == DVec3::ZERO { 0..=0 } else { -1..=1 });
        let [x, y, z] = steps;
        let around = x.flat_map(|x| {
            let z = z.clone();
            y.clone().flat_map(move |y| z.clone().map(move |z| start + DVec3::from([x, y, z].map(f64::from))))
        });
        // Positions stay if no image is nearer.
        let length = |turns: DVec3| self.moved(between, turns).length_squared();
        let nearer = |best: DVec3, turns| if length(turns) < length(best) { turns } else { best };
        around.fold(DVec3::ZERO, nearer) + DVec3::ZERO
    }

    /// The images that are at most `reach` outside the cell, as indices of points in the cell and whole edges;
    /// `None` if they are too many.
    pub(crate) fn images(&self, points: &[DVec3], reach: f64) -> Option<Vec<(u32, DVec3)>> {
        let rows = self.inverse.transpose();
        // Wider by more than rounding.
        let reach = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| 1.000_001 * reach * row.length());
        let most = points.len().saturating_mul(MOST_IMAGES).saturating_add(MORE_IMAGES);
        let steps = reach.map(|reach| reach.ceil().min(1e6) as i32);
        let around = steps.iter().map(|steps| 2.0 * f64::from(*steps) + 1.0).product::<f64>();
        let is_too_small = |count: f64| count > most as f64;
        if is_too_small(around) {
            return None;
        }
        let mut images = Vec::new();
        for (index, point) in points.iter().enumerate().filter(|(_, point)| point.is_finite()) {
            let place = self.fractions(*point);
            let ends = |k: usize| {
                (-steps[k]..=steps[k]).filter(move |step| {
                    let place = place[k] + f64::from(*step);
                    *step == 0 || (-reach[k]..=1.0 + reach[k]).contains(&place)
                })
            };
            for x in ends(0) {
                for y in ends(1) {
                    for z in ends(2).filter(|z| [x, y, *z] != [0; 3]) {
                        images.push((index as u32, DVec3::from([x, y, z].map(f64::from))));
                    }
                }
            }
            if is_too_small(images.len() as f64) {
                return None;
            }
        }
        Some(images)
    }
}
