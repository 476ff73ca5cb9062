//! The list `show`: which spheres of the data are drawn, as what, and how they look.

use serde::{Deserialize, Serialize};

use super::data_error::DataError;
use super::materials::{Materials, over};
use super::shapes::look_of;
use super::span::{KeyError, SceneFileError, positive};
use crate::color_by::{ColorBy, ColorKey, Coloring};
use crate::settings::places::Places;
use pinhole::image::color::LinearRgb;
use pinhole::internals::exact::Table;
use pinhole::internals::text::{listed, shortened};
use pinhole::scene::Appearance;
use pinhole::scene::material::SurfaceProperties;
use pinhole_data::css;
use pinhole_data::load::Dataset;
use pinhole_data::select::{NamedSelections, Selection};
use pinhole_data::show::{ShowRule, ShowStyle, Shown, ShownPart};

/// A rule that says how some spheres are drawn, and how they look.
#[derive(Clone, Debug, PartialEq)]
pub struct Show {
    /// The spheres, their style and its sizes.
    pub rule: ShowRule,
    /// The colour; if it is not given, the one that spheres have without the rule.
    pub color: Option<ShowColor>,
    /// The colour of carbon. Other atoms have those of their elements then, unless `color` is given.
    pub carbon: Option<ShowColor>,
    /// The surface properties in the place of those that spheres have without the rule.
    pub surface: Option<SurfaceProperties>,
    /// The opacity in the place of theirs.
    pub opacity: Option<f32>,
    /// A note for the user about the name of the style.
    note: Option<&'static str>,
}

/// The colours of a rule.
#[derive(Clone, Debug, PartialEq)]
pub enum ShowColor {
    /// One colour for all.
    One(LinearRgb),
    /// Those of elements.
    Elements,
    /// Those that a column gives, with the map and the range that suit it.
    Column(String),
}

/// A table of the list `show`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ShowTable {
    /// The spheres: an expression as for `select`, or `rest` for those that no other table is about; all by default.
    select: Option<String>,
    /// The style: `spacefill`, `balls`, `sticks`, `lines`, `points`, `trace`, `ghost` or `hidden`.
    #[serde(rename = "as")]
    style: String,
    /// Radius of the spheres, sticks or the tube in scene units, greater than 0.
    radius: Option<f64>,
    /// Factor of the radius that is given, or else of that of the style, greater than 0.
    scale: Option<f64>,
    /// Radius of sticks between balls in scene units, greater than 0.
    stick: Option<f64>,
    /// A colour, `element`, or the name of a column.
    color: Option<String>,
    /// The colour of carbon, or the name of a column.
    carbon: Option<String>,
    /// The name of a material.
    material: Option<String>,
    /// Opacity, from 0 (clear) to 1 (opaque).
    opacity: Option<f64>,
}

impl ShowColor {
    fn new(text: &str) -> Self {
        match text.to_lowercase().as_str() {
            "element" | "elements" | "species" => Self::Elements,
            _ => css::color(text).map_or_else(|_| Self::Column(text.to_owned()), Self::One),
        }
    }
}

/// Says in words why a name is that of no style.
pub(crate) fn unknown_style(name: &str) -> String {
    match name.to_lowercase().as_str() {
        "cpk" => "cpk is balls in VMD and spacefill in Jmol; write one of them".to_owned(),
        "surface" | "mesh" | "surf" | "quicksurf" | "isosurface" => {
            "there are no surfaces; spacefill is closest".to_owned()
        }
        _ => format!(
            "`{}` is no style; use {}",
            shortened(name),
            listed(ShowStyle::names().map(str::to_owned), ShowStyle::names().count())
        ),
    }
}

/// Reads the list.
pub(super) fn shows(
    tables: &[Table<ShowTable>],
    names: &NamedSelections,
    materials: &Materials,
    places: &Places<'_>,
) -> Result<Vec<Show>, SceneFileError> {
    let show = |(index, Table(table)): (usize, &Table<ShowTable>)| {
        let list = format!("show.{index}");
        let refused = |error: KeyError| places.refused(&list, error);
        let style = ShowStyle::of_name(&table.style)
            .ok_or_else(|| places.span(&format!("{list}.as")).error(unknown_style(&table.style)))?;
        let part = match table.select.as_deref() {
            None => ShownPart::All,
            Some("rest") => ShownPart::Rest,
            Some(text) => ShownPart::Selected(
                names.selection(text).map_err(|error| places.span(&format!("{list}.select")).error(error))?,
            ),
        };
        let mut rule = ShowRule::new(part, style);
        let number = |key, value| positive(key, value).map_err(|error| refused(error.into()));
        rule.radius = number("radius", table.radius)?;
        rule.scale = number("scale", table.scale)?.unwrap_or(rule.scale);
        rule.stick = number("stick", table.stick)?;
        let base = SurfaceProperties::default();
        let surface = over(materials, base, table.material.as_deref(), table.opacity).map_err(refused)?;
        let color = |text: &Option<String>| text.as_deref().map(ShowColor::new);
        let note = match table.style.to_lowercase().as_str() {
            "cartoon" | "newcartoon" | "ribbon" | "newribbons" => {
                Some("there are no ribbons; a trace is a tube through the same atoms")
            }
            "putty" => Some("the tube has one width; color = \"b_factor\" shows the B factors"),
            _ => None,
        };
        Ok(Show {
            rule,
            color: color(&table.color),
            carbon: color(&table.carbon),
            surface: table.material.is_some().then_some(surface),
            opacity: table.opacity.map(|_| surface.opacity),
            note,
        })
    };
    tables.iter().enumerate().map(show).collect()
}

/// The looks that rules give to spheres.
pub(super) struct RuleLooks<'a> {
    rules: Vec<RuleLook<'a>>,
    shown: &'a Shown<'a>,
    base: &'a Appearance,
}

/// The look of a rule.
struct RuleLook<'a> {
    show: &'a Show,
    color: Colors<'a>,
    carbon: Option<(Colors<'a>, Vec<bool>)>,
}

enum Colors<'a> {
    AsBefore,
    One(LinearRgb),
    Each(&'a [LinearRgb]),
    By(Coloring),
}

impl<'a> Colors<'a> {
    fn new(color: &ShowColor, data: &Dataset, elements: Option<&'a [LinearRgb]>) -> Result<Self, DataError> {
        Ok(match color {
            ShowColor::One(color) => Self::One(*color),
            ShowColor::Elements => {
                let has_elements = data.labels("species").is_some();
                let colors = elements.filter(|_| has_elements).ok_or_else(|| {
                    DataError::NoColumn("`show`: the data has no elements that give colors; name a color".to_owned())
                })?;
                Self::Each(colors)
            }
            ShowColor::Column(column) => Self::By(ColorBy::column(column).apply(&data.spheres, &data.columns)?),
        })
    }

    fn at(&self, index: usize) -> Option<LinearRgb> {
        match self {
            Self::AsBefore => None,
            Self::One(color) => Some(*color),
            Self::Each(colors) => colors.get(index).copied(),
            Self::By(coloring) => coloring.color(index),
        }
    }
}

/// Applies the rules to data; `None` if there are none.
pub(super) fn shown<'a>(rules: &'a [ShowRule], data: &Dataset) -> Result<Option<Shown<'a>>, DataError> {
    if rules.is_empty() { Ok(None) } else { Shown::new(rules, data).map(Some).map_err(DataError::Show) }
}

impl<'a> RuleLooks<'a> {
    /// The looks of rules for spheres that look so without rules. `elements` are the colours of their elements.
    pub(super) fn new(
        shows: &'a [Show],
        shown: &'a Shown<'a>,
        data: &Dataset,
        base: &'a Appearance,
        elements: Option<&'a [LinearRgb]>,
    ) -> Result<Self, DataError> {
        let rule = |show: &'a Show| {
            let (color, carbon) = (show.color.as_ref(), show.carbon.as_ref());
            let color = color.or(carbon.map(|_| &ShowColor::Elements));
            let color = color.map_or(Ok(Colors::AsBefore), |color| Colors::new(color, data, elements))?;
            let carbon = carbon.map(|carbon| {
                let is_carbon = "element C".parse::<Selection>().and_then(|carbon| carbon.matches(data));
                Ok::<_, DataError>((Colors::new(carbon, data, elements)?, is_carbon.map_err(DataError::Show)?.0))
            });
            Ok(RuleLook { show, color, carbon: carbon.transpose()? })
        };
        let rules = shows.iter().map(rule).collect::<Result<_, DataError>>()?;
        Ok(Self { rules, shown, base })
    }

    /// The meaning of the colours, if one rule has those of a column.
    pub(super) fn key(&self) -> Option<ColorKey> {
        let mut keys = self.rules.iter().flat_map(|rule| {
            let colors = [Some(&rule.color), rule.carbon.as_ref().map(|(carbon, _)| carbon)];
            colors.into_iter().flatten().filter_map(|colors| match colors {
                Colors::By(coloring) => Some(&coloring.key),
                _ => None,
            })
        });
        let first = keys.next()?;
        keys.all(|key| key == first).then(|| first.clone())
    }

    /// Notes for the user, one line each.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for rule in &self.rules {
            notes.extend(rule.show.note.map(str::to_owned));
            if let Colors::By(coloring) = &rule.color {
                notes.extend(coloring.notes.iter().cloned());
            }
        }
        notes
    }

    /// The look of a sphere, or of the tube there, with the rule of this number.
    pub(super) fn look(&self, rule: Option<usize>, index: usize) -> (LinearRgb, SurfaceProperties) {
        let rule = rule.and_then(|rule| self.rules.get(rule));
        let of_carbon = |rule: &RuleLook<'_>| {
            let (colors, is_carbon) = rule.carbon.as_ref()?;
            colors.at(index).filter(|_| is_carbon.get(index) == Some(&true))
        };
        let color = rule.and_then(|rule| of_carbon(rule).or_else(|| rule.color.at(index)));
        let (color_before, before) = look_of(self.base, index);
        let color = color.unwrap_or(color_before);
        let mut surface = rule.and_then(|rule| rule.show.surface).unwrap_or(before);
        surface.opacity = rule.and_then(|rule| rule.show.opacity).unwrap_or(surface.opacity);
        (color, surface)
    }

    /// The looks of all spheres.
    pub(super) fn appearance(&self, count: usize) -> Appearance {
        let looks: Vec<_> = (0..count).map(|index| self.look(self.shown.rule(index), index)).collect();
        Appearance::distinct(&looks)
    }
}
