//! Colours and arrows with one meaning in several frames, and colours for data without colours by the kinds of their spheres.

use super::coloring::order;
use super::key::{ColorKey, KeyKind};
use super::{ColorBy, Limit, Limits};
use pinhole_data::added::{Additions, ArrowKey};
use pinhole_data::load::Dataset;

/// The meaning of colours and arrows in all frames of a trajectory, so that equal values look equal in each frame.
///
/// If the values of any frame are on a scale, the scale covers the range of all frames. It includes whole numbers that
/// are categories in other frames. Otherwise the categories of all frames are used, in the order of a single frame.
///
/// ```
/// use pinhole_figure::color_by::{ColorBy, JoinedKeys};
/// use pinhole::SphereArray;
///
/// let frames = [1.0, 5.0].map(|x| SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0, 1.0]]));
/// let mut by = ColorBy::column("x");
/// let mut joined = JoinedKeys::default();
/// for spheres in &frames {
///     joined.add(&by.apply(spheres, &[])?.key);
/// }
/// joined.apply_to(&mut by);
/// let first = by.apply(&frames[0], &[])?;
/// let last = by.apply(&frames[1], &[])?;
/// assert_eq!(first.key, last.key);
/// # Ok::<(), pinhole_figure::color_by::ColorByError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JoinedKeys {
    /// The lowest and the highest end of the scales.
    range: Option<[f64; 2]>,
    /// The names of the categories, without a particular order.
    names: Vec<String>,
    missing: Option<[u8; 3]>,
    /// The smallest scale of arrows.
    arrow_scale: Option<f64>,
}

impl JoinedKeys {
    /// Makes keys from the results of [`JoinedKeys::range`], [`JoinedKeys::names`] and [`JoinedKeys::missing`].
    #[must_use]
    pub fn new(range: Option<[f64; 2]>, names: Vec<String>, missing: Option<[u8; 3]>) -> Self {
        Self { range, names, missing, arrow_scale: None }
    }

    /// Adds the result of [`JoinedKeys::arrow_scale`].
    #[must_use]
    pub fn with_arrow_scale(self, arrow_scale: Option<f64>) -> Self {
        Self { arrow_scale, ..self }
    }

    /// The smallest scale of the arrows of all frames; `None` if no frame has arrows.
    #[must_use]
    pub fn arrow_scale(&self) -> Option<f64> {
        self.arrow_scale
    }

    /// Adds the scale of the arrows in a frame.
    pub fn add_arrows(&mut self, key: &ArrowKey) {
        self.arrow_scale = Some(self.arrow_scale.map_or(key.scale, |scale| scale.min(key.scale)));
    }

    /// Gives a frame's arrows the scale of all frames. If no frame with arrows was added, nothing changes.
    pub fn apply_to_arrows(&self, additions: &mut Additions) {
        if let Some(arrows) = &mut additions.arrows {
            arrows.scale = self.arrow_scale.or(arrows.scale);
        }
    }

    /// The lowest and the highest end of the scales of all frames; `None` if no frame has a scale.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        self.range
    }

    /// The names of the categories of all frames, without a particular order.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Adds the meaning of colours in a frame.
    pub fn add(&mut self, key: &ColorKey) {
        self.missing = self.missing.or(key.missing);
        match &key.kind {
            KeyKind::Scale(scale) => self.widen(scale.scale().range()),
            KeyKind::Categories(categories) => {
                for category in categories {
                    if !self.names.contains(&category.name) {
                        self.names.push(category.name.clone());
                    }
                }
            }
        }
    }

    fn widen(&mut self, [low, high]: [f64; 2]) {
        let [l, h] = self.range.unwrap_or([low, high]);
        self.range = Some([l.min(low), h.max(high)]);
    }

    /// Gives a frame's colours the range or the categories of all frames. If no frame was added, nothing changes.
    pub fn apply_to(&self, by: &mut ColorBy) {
        if self.range.is_some() {
            let mut all = self.clone();
            let numbers = self.names.iter().filter_map(|name| name.parse::<f64>().ok());
            numbers
                .filter(|number| number.is_finite() && (!by.is_log || *number > 0.0))
                .for_each(|number| all.widen([number; 2]));
            let [low, high] = all.range.unwrap_or_default();
            by.limits = Limits { low: Limit::Value(low), high: Limit::Value(high) };
        } else if !self.names.is_empty() {
            let mut names = self.names.clone();
            let order = order(names.iter().map(String::as_str));
            names.sort_by(|a, b| order(a, b));
            by.categories = Some(names);
        }
    }

    /// The colour of spheres without a value, in 8-bit sRGB; `None` if every sphere of every frame has a value.
    #[must_use]
    pub fn missing(&self) -> Option<[u8; 3]> {
        self.missing
    }
}

/// Names of the columns with the kinds of spheres. The first that is suitable is used.
const KINDS: [&str; 2] = ["species", "type"];

/// More kinds than this cannot be told apart by colour.
const MOST_KINDS: usize = 32;

impl ColorBy {
    /// Colours spheres by their kinds: by the column `species` or else `type`, if it is text with 2 to 32 different
    /// kinds. `None` if the data has colours, or no such column.
    #[must_use]
    pub fn of_kinds(loaded: &Dataset) -> Option<Self> {
        if loaded.colors.is_some() {
            return None;
        }
        let are_kinds =
            |name: &&str| loaded.labels(name).is_some_and(|labels| (2..=MOST_KINDS).contains(&labels.names.len()));
        KINDS.into_iter().find(are_kinds).map(Self::column)
    }

    /// The note about colours by kind that nobody asked for. `key` is a flag or keyword that gives all spheres one
    /// colour, with its value.
    #[must_use]
    pub fn note_of_kinds(&self, key: &str) -> String {
        let column = &self.column;
        format!("there are no colors; the spheres are colored by {column}; {key} gives all one color")
    }
}
