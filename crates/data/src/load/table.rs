//! Makes spheres from a table of points. Columns with positions, radii, colours, opacities and chemical elements are
//! recognised by their names. All formats with named columns share these rules, so that a name means the same in each.

use glam::DVec3;

use super::dataset::{Column, ColumnValues, Dataset, Labels, center};
use super::elements::{UnknownSpecies, appearance};
use super::error::{LoadError, LoadErrorKind, Place};
use super::format::Options;
use super::spacing::{self, NO_RADII};
use crate::css;
use pinhole::image::color::LinearRgb;
use pinhole::internals::parallel;
use pinhole::internals::text::{listed, shortened};
use pinhole::scene::sphere_array::SphereArray;

/// A table of points. All columns have the same number of values.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) columns: Vec<TableColumn>,
}

#[derive(Debug)]
pub(super) struct TableColumn {
    pub(super) name: String,
    pub(super) values: ColumnValues,
    /// The largest value of the numbers' type in the file if that is u8 or u16, so that colours are fractions of it.
    pub(super) full: Option<f64>,
}

/// Columns, and notes about what is none.
pub(super) type Columns = (Vec<TableColumn>, Vec<String>);

impl TableColumn {
    pub(super) fn numbers(name: impl Into<String>, numbers: Vec<f64>) -> Self {
        Self { name: name.into(), values: ColumnValues::Numbers(numbers), full: None }
    }

    pub(super) fn labels(name: impl Into<String>, labels: Labels) -> Self {
        Self { name: name.into(), values: ColumnValues::Labels(labels), full: None }
    }

    /// The name in lower case, with dots between words.
    fn plain_name(&self) -> String {
        plain(&self.name)
    }
}

impl Table {
    /// Makes spheres from the table. Columns that are not needed for them become columns of the result. Radii come from
    /// a column, or the options, or chemical elements, or else from the spacing of the points.
    pub(super) fn into_loaded(mut self, options: &Options) -> Result<Dataset, LoadError> {
        let positions = self.take_set(POSITIONS).ok_or_else(|| self.no_positions())?;
        let names = positions.each_ref().map(|column| column.name.clone());
        let [x, y, z] = positions.map(numbers_of);
        let (x, y, z) = (x?, y?, z?);
        for (name, values) in names.iter().zip([&x, &y, &z]) {
            if let Some(row) = values.iter().position(|value| !value.is_finite()) {
                let (column, found) = (shortened(name), values[row]);
                let message = format!("{column} is {found}; a position must be finite");
                return Err(LoadError::at(Place::Row(row), message));
            }
        }
        let centers = x.iter().zip(&y).zip(&z);
        let spheres = centers.map(|((x, y), z)| [*x, *y, *z, 0.0]).collect();
        drop((x, y, z));
        self.dress(SphereArray::F64(spheres), false, options)
    }

    /// Adds the table to spheres, one row to each. Spheres without radii get them as
    /// [`Table::into_loaded`] says.
    pub(super) fn dress(
        mut self,
        mut spheres: SphereArray,
        have_radii: bool,
        options: &Options,
    ) -> Result<Dataset, LoadError> {
        let mut notes = Vec::new();
        let (colors, opacities) = (self.colors(&mut notes), self.opacities(&mut notes));
        let found_radii = if have_radii { None } else { self.radii()? };
        let gives_radii = have_radii || found_radii.is_some();
        let species = self.species();
        let elements =
            species.as_ref().map(|labels| labels.names.iter().map(|name| appearance(name)).collect::<Vec<_>>());
        // Names such as A and B are not elements, and have neither radii nor colours of their own.
        let elements = elements.filter(|elements| elements.iter().any(|element| element.is_element));
        let element_of = species
            .as_ref()
            .zip(elements.as_ref())
            .map(|(labels, elements)| move |row: usize| elements[labels.indices[row] as usize]);
        match (found_radii, options.radius, &element_of) {
            (Some((column, _)), Some(_), _) => {
                let message = format!("the column {column} has radii; remove the radius that is given for all spheres");
                return Err(LoadError::new(message).of_kind(LoadErrorKind::TwoRadii));
            }
            (Some((_, radii)), None, _) => set_radii(&mut spheres, |row| radii[row]),
            (None, _, _) if have_radii => {}
            (None, Some(radius), _) => set_radii(&mut spheres, |_| radius),
            (None, None, Some(element_of)) => {
                set_radii(&mut spheres, |row| element_of(row).radius);
            }
            (None, None, None) => {
                let center = |row| center(&spheres, row);
                let radius = guessed_radius(spheres.len(), center, &mut notes);
                set_radii(&mut spheres, |_| radius);
            }
        }
        let by_element =
            element_of.as_ref().map(|element_of| parallel::map(spheres.len(), |row| element_of(row).color));
        let unknown = species.iter().zip(&elements).flat_map(|(labels, elements)| {
            let named = labels.names.iter().zip(elements);
            named.filter(|(_, element)| !element.is_element).map(|(name, _)| name.clone())
        });
        let lacks_radius = !gives_radii && options.radius.is_none();
        let unknown = UnknownSpecies::new(unknown.collect(), colors.is_none(), lacks_radius);
        notes.extend(unknown.as_ref().map(UnknownSpecies::note));
        let colors = colors.or(by_element);
        let mut loaded = Dataset::new(spheres);
        loaded.colors = colors;
        loaded.opacities = opacities;
        loaded.unknown = unknown;
        self.note_what_is_unused(&mut notes);
        loaded.notes = notes;
        let species = species.map(|labels| TableColumn::labels("species", labels));
        let columns = species.into_iter().chain(self.columns);
        let with_kinds = |TableColumn { name, values, .. }| match values {
            ColumnValues::Numbers(numbers) if name.eq_ignore_ascii_case("type") => {
                let values = kinds(&numbers).map_or(ColumnValues::Numbers(numbers), ColumnValues::Labels);
                Column { name, values }
            }
            values => Column { name, values },
        };
        loaded.columns = columns.map(with_kinds).collect();
        Ok(loaded)
    }

    fn no_positions(&self) -> LoadError {
        let message = format!("there are no columns x, y and z; the columns are {}", self.names());
        LoadError::new(message).of_kind(LoadErrorKind::NoPositions)
    }

    pub(super) fn names(&self) -> String {
        listed(self.columns.iter().map(|column| shortened(&column.name)), 16)
    }

    pub(super) fn position(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|name| self.columns.iter().position(|column| column.plain_name() == *name))
    }

    /// Takes the first column with one of these names out of the table.
    pub(super) fn take(&mut self, names: &[&str]) -> Option<TableColumn> {
        self.position(names).map(|index| self.columns.remove(index))
    }

    /// Takes the first complete set of three columns out of the table.
    pub(super) fn take_set(&mut self, sets: Sets) -> Option<[TableColumn; 3]> {
        let set = sets.iter().find(|set| set.iter().all(|name| self.position(&[*name]).is_some()))?;
        let [first, second, third] = set.map(|name| self.take(&[name]));
        Some([first?, second?, third?])
    }

    /// Takes the radii, with the name of their column.
    pub(super) fn radii(&mut self) -> Result<Option<(String, Vec<f64>)>, LoadError> {
        let (column, factor) = match (self.take(RADII), self.position(DIAMETERS)) {
            (Some(column), _) => (column, 1.0),
            (None, Some(diameters)) => (self.columns.remove(diameters), 0.5),
            (None, None) => return Ok(None),
        };
        let name = shortened(&column.name);
        let mut radii = numbers_of(column)?;
        if let Some(row) = radii.iter().position(|radius| !(radius.is_finite() && *radius > 0.0)) {
            let found = radii[row];
            let message = format!("{name} is {found}; a radius must be finite and greater than 0");
            return Err(LoadError::at(Place::Row(row), message));
        }
        radii.iter_mut().for_each(|radius| *radius *= factor);
        Ok(Some((name, radii)))
    }

    /// Takes the colours: three columns of numbers, or one of CSS colours.
    pub(super) fn colors(&mut self, notes: &mut Vec<String>) -> Option<Vec<LinearRgb>> {
        if let Some(index) = self.position(COLOR_NAMES)
            && let ColumnValues::Labels(labels) = &self.columns[index].values
            && let Some(colors) = css_colors(labels)
        {
            self.columns.remove(index);
            return Some(colors);
        }
        let set = self.take_set(COLORS)?;
        let full = set.iter().map(|column| column.full).reduce(|a, b| a.zip(b).map(|(a, b)| a.max(b)))?;
        let numbers = set.each_ref().map(|column| match &column.values {
            ColumnValues::Numbers(numbers) => numbers.as_slice(),
            ColumnValues::Labels(_) => &[],
        });
        let all = || numbers.iter().copied().flatten().copied();
        let largest = all().fold(0.0, f64::max);
        let full = full.unwrap_or(if largest <= 1.0 {
            1.0
        } else if largest <= 255.0 {
            255.0
        } else {
            65535.0
        });
        let [red, green, blue] = numbers;
        let is_valid =
            red.len() == green.len() && green.len() == blue.len() && all().all(|value| (0.0..=full).contains(&value));
        if !is_valid || (red.is_empty() && !set[0].is_empty()) {
            let [red, green, blue] = set.each_ref().map(|column| &column.name);
            notes.push(format!(
                "the columns {}, {}, {} are not used as colors, because they have values that are not \
                 numbers from 0 to 1, 255 or 65535",
                shortened(red),
                shortened(green),
                shortened(blue)
            ));
            self.columns.extend(set);
            return None;
        }
        let byte = |value: f64| (value / full * 255.0).round() as u8;
        let rows = red.iter().zip(green).zip(blue);
        Some(rows.map(|((r, g), b)| LinearRgb::from_srgb8([byte(*r), byte(*g), byte(*b)])).collect())
    }

    fn opacities(&mut self, notes: &mut Vec<String>) -> Option<Vec<f32>> {
        let (index, is_inverse) = match (self.position(OPACITIES), self.position(TRANSPARENCIES)) {
            (Some(index), _) => (index, false),
            (None, Some(index)) => (index, true),
            (None, None) => return None,
        };
        let column = &self.columns[index];
        let ColumnValues::Numbers(numbers) = &column.values else { return None };
        let largest = numbers.iter().copied().fold(0.0, f64::max);
        let full = column.full.unwrap_or(if largest <= 1.0 { 1.0 } else { 255.0 });
        if !numbers.iter().all(|value| (0.0..=full).contains(value)) {
            notes.push(format!(
                "the column {} is not used as opacity, because it has values that are not numbers from 0 to 1 or 255",
                shortened(&column.name)
            ));
            return None;
        }
        let opacity = |value: &f64| {
            let value = (value / full) as f32;
            if is_inverse { 1.0 - value } else { value }
        };
        let opacities = numbers.iter().map(opacity).collect();
        self.columns.remove(index);
        Some(opacities)
    }

    /// Takes the column of chemical elements or other kinds, as text.
    fn species(&mut self) -> Option<Labels> {
        let index = self.position(ELEMENTS)?;
        let ColumnValues::Labels(_) = &self.columns[index].values else { return None };
        match self.columns.remove(index).values {
            ColumnValues::Labels(labels) => Some(labels),
            ColumnValues::Numbers(_) => None,
        }
    }

    /// Adds notes on columns whose names suggest a change of the picture, but that are not used.
    fn note_what_is_unused(&self, notes: &mut Vec<String>) {
        const SIGNS: [(&str, &str); 7] = [
            ("color", "color"),
            ("colour", "color"),
            ("rgb", "color"),
            ("radius", "radius"),
            ("diameter", "radius"),
            ("opacity", "opacity"),
            ("transparen", "opacity"),
        ];
        /// Maximum number of such notes. More would not help.
        const MOST: usize = 8;
        let mut found = 0;
        for column in &self.columns {
            let plain = column.plain_name();
            let sign = SIGNS.iter().find(|(sign, _)| plain.contains(sign));
            let Some((_, what)) = sign.filter(|_| found < MOST) else { continue };
            let name = shortened(&column.name);
            // Another note already says why the column is not used.
            if !notes.iter().any(|note| note.contains(&name)) {
                found += 1;
                notes.push(format!("the column {name} is not used; to use it, add --{what}-by {name}"));
            }
        }
    }
}

impl TableColumn {
    /// The largest number; 0 if there is none.
    pub(super) fn largest(&self) -> f64 {
        match &self.values {
            ColumnValues::Numbers(numbers) => numbers.iter().copied().fold(0.0, f64::max),
            ColumnValues::Labels(_) => 0.0,
        }
    }

    fn is_empty(&self) -> bool {
        match &self.values {
            ColumnValues::Numbers(numbers) => numbers.is_empty(),
            ColumnValues::Labels(labels) => labels.indices.is_empty(),
        }
    }
}

/// The most types that are told apart.
const MOST_TYPES: usize = 32;

/// The types that whole numbers name; `None` for other numbers.
fn kinds(numbers: &[f64]) -> Option<Labels> {
    let mut names: Vec<f64> = Vec::new();
    let index = |number: &f64| {
        if number.fract() != 0.0 {
            return None;
        }
        let found = names.iter().position(|name| name.total_cmp(number).is_eq());
        let index = found.unwrap_or_else(|| {
            names.push(*number);
            names.len() - 1
        });
        (index < MOST_TYPES).then_some(index as u32)
    };
    let indices = numbers.iter().map(index).collect::<Option<_>>()?;
    Some(Labels { names: names.iter().map(f64::to_string).collect(), indices })
}

fn set_radii(spheres: &mut SphereArray, radius: impl Fn(usize) -> f64) {
    spheres.map_radii(|row, _| radius(row));
}

/// The radius of spheres whose file has none, with a note.
pub(super) fn guessed_radius(count: usize, center: impl Fn(usize) -> DVec3, notes: &mut Vec<String>) -> f64 {
    // A single sphere, or spheres that are all in one place, may have any size: the camera comes as near as it must.
    let radius = spacing::radius(count, center).unwrap_or(1.0);
    // Three digits are enough to be pasted.
    let digits = format!("{radius:.2e}").parse().unwrap_or(radius);
    if count > 0 {
        notes.push(format!("{NO_RADII} {digits}, with which neighbors about touch; --radius sets it"));
    }
    digits
}

pub(super) fn numbers_of(column: TableColumn) -> Result<Vec<f64>, LoadError> {
    match column.values {
        ColumnValues::Numbers(numbers) => Ok(numbers),
        ColumnValues::Labels(labels) => {
            let found = labels.names.first().map(|name| shortened(name)).unwrap_or_default();
            let column = shortened(&column.name);
            Err(LoadError::new(format!("the column {column} has text, such as `{found}`, where numbers must be")))
        }
    }
}

/// The colours of a column of CSS colours, if every text is a colour.
fn css_colors(labels: &Labels) -> Option<Vec<LinearRgb>> {
    let colors: Option<Vec<_>> = labels.names.iter().map(|name| css::color(name).ok()).collect();
    let colors = colors?;
    Some(labels.indices.iter().map(|index| colors[*index as usize]).collect())
}

/// Sets of three column names for the components of a position, a colour and so on. Any of the sets will do.
type Sets = &'static [[&'static str; 3]];

const POSITIONS: Sets = &[
    ["x", "y", "z"],
    ["position.x", "position.y", "position.z"],
    ["positions.x", "positions.y", "positions.z"],
    ["pos.x", "pos.y", "pos.z"],
    ["points.x", "points.y", "points.z"],
    ["coordinates.x", "coordinates.y", "coordinates.z"],
    ["center.x", "center.y", "center.z"],
];

const COLORS: Sets = &[
    ["red", "green", "blue"],
    ["r", "g", "b"],
    ["diffuse.red", "diffuse.green", "diffuse.blue"],
    ["color.x", "color.y", "color.z"],
    ["colour.x", "colour.y", "colour.z"],
    ["colors.x", "colors.y", "colors.z"],
    ["rgb.x", "rgb.y", "rgb.z"],
    ["color.r", "color.g", "color.b"],
    ["colour.r", "colour.g", "colour.b"],
    ["color.0", "color.1", "color.2"],
    ["colors.0", "colors.1", "colors.2"],
    ["rgb.0", "rgb.1", "rgb.2"],
    ["rgba.0", "rgba.1", "rgba.2"],
];

const RADII: &[&str] = &["radius", "radii", "particle.radius", "sphere.radius"];
const DIAMETERS: &[&str] = &["diameter", "diameters", "particle.diameter"];
const OPACITIES: &[&str] = &["opacity", "alpha", "color.3", "colors.3", "rgba.3", "color.a"];
const TRANSPARENCIES: &[&str] = &["transparency"];
const ELEMENTS: &[&str] = &["species", "element", "elements", "symbol", "symbols", "type.symbol", "particle.type"];
const COLOR_NAMES: &[&str] = &["color", "colour", "colors"];

/// The name of a column in lower case, with dots between words.
fn plain(name: &str) -> String {
    let name = name.trim().to_lowercase();
    let dotted = name.replace([' ', '_', '-', '[', '(', ':'], ".");
    dotted.trim_end_matches([']', ')']).to_owned()
}

/// Whether a column with this name must have numbers, because positions or radii follow from it.
pub(super) fn must_be_numbers(name: &str) -> bool {
    let name = plain(name);
    let name = name.as_str();
    POSITIONS.as_flattened().contains(&name) || RADII.contains(&name) || DIAMETERS.contains(&name)
}

/// True if a column with this name has ends or radii of cylinders or cones.
pub(super) fn is_of_cones(name: &str) -> bool {
    let name = plain(name);
    ["start.", "end.", "radius", "radii", "diameter"].iter().any(|start| name.starts_with(start))
}

/// Whether a column with this name has chemical elements, which may be atomic numbers.
pub(super) fn is_element(name: &str) -> bool {
    ELEMENTS.contains(&plain(name).as_str())
}

pub(super) fn has_positions(names: &[String]) -> bool {
    let names: Vec<String> = names.iter().map(|name| plain(name)).collect();
    POSITIONS.iter().any(|set| set.iter().all(|wanted| names.iter().any(|name| name == wanted)))
}
