//! The sizes of what styles draw.

use glam::DVec3;

use super::rule::{ShowRule, ShowStyle};
use crate::added::{StickSize, radius_factor};
use crate::load::Dataset;

/// Radii in Å of sticks with joints, thin sticks and sticks between balls. That of sticks is `stick_radius` of `PyMOL`.
const ATOMS: [f64; 3] = [0.25, 0.07, 0.14];

/// Such radii for spheres that are not atoms of elements, as parts of the distance between neighbours.
const OTHERS: [f64; 3] = [0.17, 0.05, 0.12];

/// The radius of points, as a part of the longest side of the box of all centres.
const POINT: f64 = 1.0 / 400.0;

/// Lengths in data from which sizes follow.
pub(super) struct Measures {
    /// The median distance from a sphere to its nearest neighbour.
    spacing: f64,
    /// The longest side of the box of all centres.
    size: f64,
}

impl Measures {
    pub(super) fn of(data: &Dataset) -> Self {
        let centers = (0..data.spheres.len()).map(|index| data.center(index));
        let finite = centers.filter(|center| center.is_finite());
        let [low, high] = finite
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], center| [low.min(center), high.max(center)]);
        let spacing = data.spacing();
        Self { spacing, size: (high - low).max_element().max(spacing) }
    }

    fn size(&self, which: usize, is_element: bool) -> f64 {
        if is_element { ATOMS[which] } else { OTHERS[which] * self.spacing }
    }

    /// The radius of a sphere that has a rule. `own` is its radius without it.
    pub(super) fn radius(&self, rule: &ShowRule, own: f64, is_element: bool) -> f64 {
        let of_style = match rule.style {
            ShowStyle::Balls => own * radius_factor(is_element),
            ShowStyle::Sticks => self.size(0, is_element),
            ShowStyle::Lines => self.size(1, is_element),
            ShowStyle::Points => POINT * self.size,
            ShowStyle::Spacefill | ShowStyle::Trace | ShowStyle::Ghost | ShowStyle::Hidden => own,
        };
        rule.radius_or(of_style)
    }

    /// The stick at a sphere that has a rule.
    pub(super) fn stick(&self, rule: &ShowRule, is_element: bool) -> StickSize {
        match rule.style {
            ShowStyle::Balls => StickSize::Radius(rule.stick.unwrap_or_else(|| self.size(2, is_element))),
            ShowStyle::Sticks | ShowStyle::Lines => StickSize::Ball,
            _ => StickSize::None,
        }
    }
}
