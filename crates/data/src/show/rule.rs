//! Rules that say how spheres are drawn, and their styles.

use crate::select::Selection;

/// A rule that says how some spheres are drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShowRule {
    /// The spheres.
    pub part: ShownPart,
    /// Their style.
    pub style: ShowStyle,
    /// The radius of spheres, sticks or the tube in scene units; if it is not given, that of the style.
    pub radius: Option<f64>,
    /// Factor of that radius.
    pub scale: f64,
    /// The radius of the sticks between balls in scene units.
    pub stick: Option<f64>,
}

/// The spheres of a rule.
#[derive(Clone, Debug, PartialEq)]
pub enum ShownPart {
    /// All spheres.
    All,
    /// All spheres that no other rule is about.
    Rest,
    /// The spheres of a selection.
    Selected(Selection),
}

impl ShowRule {
    /// A rule without sizes of its own.
    #[must_use]
    pub fn new(part: ShownPart, style: ShowStyle) -> Self {
        Self { part, style, radius: None, scale: 1.0, stick: None }
    }

    /// The radius that the rule says, where its style has another one.
    pub(super) fn radius_or(&self, of_style: f64) -> f64 {
        self.scale * self.radius.unwrap_or(of_style)
    }
}

/// The style in which spheres are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShowStyle {
    /// Spheres with their own radii: van der Waals radii of atoms.
    Spacefill,
    /// Small balls, and sticks between those that are bonded.
    Balls,
    /// Sticks with joints of the same radius.
    Sticks,
    /// Thin sticks.
    Lines,
    /// Points: spheres whose radius is 1/400 of the longest side of the box of all centres.
    Points,
    /// A tube along the chain of a polymer.
    Trace,
    /// Faint, otherwise as they were.
    Ghost,
    /// Not drawn.
    Hidden,
}

/// The names of styles. The first of each is the one in lists.
const NAMES: [(ShowStyle, &[&str]); 8] = [
    (ShowStyle::Spacefill, &["spacefill", "vdw", "spheres"]),
    (ShowStyle::Balls, &["balls", "ball-and-stick", "ball+stick", "balls-and-sticks", "dynamicbonds"]),
    (ShowStyle::Sticks, &["sticks", "licorice", "stick"]),
    (ShowStyle::Lines, &["lines", "line", "wireframe"]),
    (ShowStyle::Points, &["points", "dots"]),
    (ShowStyle::Trace, &["trace", "tube", "putty", "cartoon", "newcartoon", "ribbon", "newribbons"]),
    (ShowStyle::Ghost, &["ghost", "faint", "context"]),
    (ShowStyle::Hidden, &["hidden", "hide", "none"]),
];

impl ShowStyle {
    /// The style of a name, in upper or lower case.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        let is = |other: &&str| other.eq_ignore_ascii_case(name);
        NAMES.iter().find(|(_, names)| names.iter().any(is)).map(|(style, _)| *style)
    }

    /// One name of each style.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|(_, names)| names[0])
    }

    /// Returns true if sticks join spheres of this style.
    pub(super) fn has_sticks(self) -> bool {
        matches!(self, Self::Balls | Self::Sticks | Self::Lines)
    }
}
